// A job's events as they happen.
#ifndef SERVE_EVENTS_H
#define SERVE_EVENTS_H

#include "serve.h"

/// Answer with a stream of server-sent events that ends with the job: `queued`, `progress`, then `done` or
/// `failed`. Each says all there is to say at that time, so that one who comes late misses nothing.
enum MHD_Result events_reply(server *s, struct MHD_Connection *connection, const char *id);

#endif
