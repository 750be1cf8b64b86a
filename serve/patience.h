// How long a connection may keep us waiting.
#ifndef SERVE_PATIENCE_H
#define SERVE_PATIENCE_H

#include "serve.h"

/// For MHD_OPTION_NOTIFY_CONNECTION: a connection begins and ends.
void patience_notify(void *server, struct MHD_Connection *connection, void **record,
                     enum MHD_ConnectionNotificationCode code);

/// From here on the other side has so many seconds; 0: it is we who keep it waiting.
void patience_set(server *s, struct MHD_Connection *connection, double seconds);

/// Cut off those that have taken too long.
void patience_tick(server *s);

#endif
