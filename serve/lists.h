// What there is to choose from.
#ifndef SERVE_LISTS_H
#define SERVE_LISTS_H

#include "serve.h"

enum MHD_Result lists_reply(server *s, struct MHD_Connection *connection);

/// A sample as a PNG of so many pixels a side.
///   in     file   NAME.png
enum MHD_Result sample_reply(struct MHD_Connection *connection, const char *file, const char *size);

#endif
