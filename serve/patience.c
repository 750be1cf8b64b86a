// How long a connection may keep us waiting.
//
// Why:     MHD's own limit counts from the last byte, so that one byte now and then holds a connection for
// ever.
//          Here the whole head, and then the whole body, has its time.
#include "patience.h"

#include <sys/socket.h>

static patience *record_of(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

void patience_notify(void *user, struct MHD_Connection *connection, void **record,
                     enum MHD_ConnectionNotificationCode code)
{
    server *s = user;
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    pthread_mutex_lock(&s->lock);
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
        if (*record) ((patience *)*record)->open = false;
    } else {
        for (int32_t i = 0; i <= MOST_CONNECTIONS && !*record; i++)
            if (!s->patience[i].open) *record = &s->patience[i];
        if (*record)
            *(patience *)*record = (patience){info->connect_fd, seconds_now() + HEADER_SECONDS, true};
    }
    pthread_mutex_unlock(&s->lock);
}

void patience_set(server *s, struct MHD_Connection *connection, double seconds)
{
    patience *p = record_of(connection);
    pthread_mutex_lock(&s->lock);
    if (p) p->until = seconds > 0 ? seconds_now() + seconds : 0;
    pthread_mutex_unlock(&s->lock);
}

void patience_tick(server *s)
{
    double now = seconds_now();
    pthread_mutex_lock(&s->lock);
    for (int32_t i = 0; i <= MOST_CONNECTIONS; i++) {
        patience *p = &s->patience[i];
        if (!p->open || p->until == 0 || now < p->until) continue;
        shutdown(p->socket, SHUT_RDWR); // MHD then closes it
        p->until = 0;
    }
    pthread_mutex_unlock(&s->lock);
}
