// Which request means what.
#ifndef SERVE_API_H
#define SERVE_API_H

#include "serve.h"

/// For MHD_start_daemon, and for MHD_OPTION_NOTIFY_COMPLETED.
enum MHD_Result api_answer(void *server, struct MHD_Connection *connection, const char *url,
                           const char *method, const char *version, const char *piece, size_t *piece_size,
                           void **exchange);
void api_completed(void *server, struct MHD_Connection *connection, void **exchange,
                   enum MHD_RequestTerminationCode how);

#endif
