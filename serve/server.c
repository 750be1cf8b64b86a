// jali serve [PICTURE]: a page for all of this, in the browser of this machine.
//
// How:     libmicrohttpd on the loopback address, a thread a connection; pictures are never read in this
// process
//          but in those of jobs (worker.c), which the main thread looks after (dispatch.c).
// Checked: tests/test_serve.c, bench/hostile.c.
#include "serve.h"
#include "api.h"
#include "dispatch.h"
#include "jobs.h"
#include "patience.h"
#include "store.h"
#include "base/file.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { BACKLOG = 128, STACK_BYTES = 1 << 20, HEAD_BYTES = 1 << 15, STALLED_SECONDS = 60 };

double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bool random_id(char id[TOKEN_BYTES])
{
    unsigned char random[TOKEN_BYTES / 2];
    if (getrandom(random, sizeof random, 0) != sizeof random) return false;
    for (size_t i = 0; i < sizeof random; i++) snprintf(id + 2 * i, 3, "%02x", random[i]);
    return true;
}

void server_changed(server *s)
{
    pthread_cond_broadcast(&s->changed);
}

void server_wake(server *s)
{
    uint64_t one = 1;
    (void)!write(s->wake, &one, sizeof one);
}

// A socket on the loopback address; the port is then known.
static jali_status open_socket(jali_context *ctx, server *s, int *out)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)s->port)};
    socklen_t size = sizeof address;
    int yes = 1, opened = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    *out = opened;
    if (opened < 0) return fail(ctx, JALI_IO, "cannot open a socket: %s", strerror(errno));
    setsockopt(opened, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(opened, (struct sockaddr *)&address, size) != 0 || listen(opened, BACKLOG) != 0) {
        if (errno == EADDRINUSE)
            return fail(ctx, JALI_IO,
                        "port %d is taken, perhaps by another jali serve; --port 0 takes one that is free",
                        s->port);
        return fail(ctx, JALI_IO, "cannot listen on port %d: %s; --port 0 takes one that is free", s->port,
                    strerror(errno));
    }
    getsockname(opened, (struct sockaddr *)&address, &size);
    s->port = ntohs(address.sin_port);
    return JALI_OK;
}

// The picture of the command line, as if the page had sent it.
static jali_status keep_picture(jali_context *ctx, server *s)
{
    jali_status status = JALI_OK;
    jali_bytes file = {0};
    blob *room;
    if (!s->set->operand) return JALI_OK;
    TRY(file_read(ctx, s->set->operand, MOST_UPLOAD_BYTES, &file));
    room = store_room(s, file.size);
    if (!room || !blob_append(room, file.data, file.size) ||
        !store_keep(s, room, name_of(s->set->operand), s->picture)) {
        blob_let_go(room);
        status = fail(ctx, JALI_NO_MEMORY, "no room for %s", s->set->operand);
    }
done:
    jali_bytes_free(ctx, &file);
    return status;
}

static void print_address(const server *s)
{
    printf("http://127.0.0.1:%d/#token=%s", s->port, s->token);
    if (*s->picture) {
        printf("&picture=%s&name=", s->picture);
        for (const char *c = name_of(s->set->operand); *c; c++)
            printf(isalnum((unsigned char)*c) ? "%c" : "%%%02X", (unsigned char)*c);
    }
    printf("\n");
    fflush(stdout);
    say(s->set, "open this address in a browser of this machine; Ctrl-C ends it");
}

// Paths are compared as they came: no name here needs a % to be said.
static size_t keep_escaped(void *user, struct MHD_Connection *connection, char *text)
{
    (void)user, (void)connection;
    return strlen(text);
}

static void log_nothing(void *user, const char *format, va_list arguments)
{
    (void)user, (void)format, (void)arguments;
}

// Its threads take no signals: an interrupt must reach the main thread.
static struct MHD_Daemon *start_daemon(server *s, int opened)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    struct MHD_Daemon *daemon = MHD_start_daemon(
        MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_POLL | MHD_USE_ITC |
            MHD_USE_ERROR_LOG,
        0, NULL, NULL, api_answer, s, MHD_OPTION_EXTERNAL_LOGGER, log_nothing, NULL, MHD_OPTION_LISTEN_SOCKET,
        opened, MHD_OPTION_CONNECTION_LIMIT, (unsigned)MOST_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)STALLED_SECONDS, MHD_OPTION_THREAD_STACK_SIZE, (size_t)STACK_BYTES,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)HEAD_BYTES, MHD_OPTION_NOTIFY_COMPLETED, api_completed, s,
        MHD_OPTION_NOTIFY_CONNECTION, patience_notify, s, MHD_OPTION_UNESCAPE_CALLBACK, keep_escaped, NULL,
        MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_END);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return daemon;
}

static void stop_daemon(server *s, struct MHD_Daemon *daemon)
{
    pthread_mutex_lock(&s->lock);
    s->closing = true;
    server_changed(s);
    pthread_mutex_unlock(&s->lock);
    MHD_stop_daemon(daemon);
}

static server *server_create(const settings *set)
{
    server *s = calloc(1, sizeof *s);
    pthread_condattr_t monotonic;
    if (!s) return NULL;
    s->set = set;
    s->port = set->port;
    s->upload_budget.most = s->result_budget.most = MOST_KEPT_BYTES;
    s->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    pthread_mutex_init(&s->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&s->changed, &monotonic);
    pthread_condattr_destroy(&monotonic);
    return s;
}

static void server_free(server *s)
{
    store_free(s);
    jobs_free(s);
    pthread_cond_destroy(&s->changed);
    pthread_mutex_destroy(&s->lock);
    if (s->wake >= 0) close(s->wake);
    free(s);
}

jali_status run_serve(jali_context *ctx, const settings *set)
{
    jali_status status;
    struct MHD_Daemon *daemon = NULL;
    int opened = -1;
    server *s = server_create(set);
    if (!s || s->wake < 0 || !random_id(s->token)) {
        if (s) server_free(s);
        return fail(ctx, JALI_IO, "cannot begin to serve: %s", strerror(errno));
    }
    json_object_seed(0); // before there are threads
    TRY(keep_picture(ctx, s));
    TRY(open_socket(ctx, s, &opened));
    daemon = start_daemon(s, opened);
    if (!daemon) TRY(fail(ctx, JALI_IO, "cannot start to serve port %d", s->port));
    print_address(s);
    TRY(dispatch(ctx, s));
done:
    if (daemon) stop_daemon(s, daemon); // which closes the socket
    if (!daemon && opened >= 0) close(opened);
    server_free(s);
    return status;
}
