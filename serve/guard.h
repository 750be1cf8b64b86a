// Who may ask: this machine's own page, and nobody who only knows the port.
#ifndef SERVE_GUARD_H
#define SERVE_GUARD_H

#include "serve.h"

/// NULL: the request may go on. Else a sentence, for status 403.
///   in     api   it needs the token, too
const char *guard_refusal(const server *s, struct MHD_Connection *connection, bool api);

/// What every answer carries: no scripts but our own, no frames, no guesses at types.
void guard_headers(struct MHD_Response *response);

#endif
