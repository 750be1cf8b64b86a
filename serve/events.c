// A job's events as they happen (server-sent events, of the WHATWG's HTML standard).
//
// How:     the thread of the connection sleeps until the job has another version, then says how it stands;
// what
//          happened in between is left out, so a slow reader holds nothing up.
#include "events.h"
#include "jobs.h"
#include "reply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { BLOCK_BYTES = 16384 };

typedef struct stream {
    server *s;
    char job[TOKEN_BYTES];
    uint32_t seen; // version
    bool last;     // nothing follows what is pending
    char *pending; // [size] of which `sent` are sent
    size_t size, sent;
} stream;

static const char *event_name(job_state state)
{
    static const char *const names[] = {"queued", "progress", "done", "failed"};
    return names[state];
}

static void set_pending(stream *e, char *text)
{
    free(e->pending);
    e->pending = text;
    e->size = text ? strlen(text) : 0;
    e->sent = 0;
}

static char *event_text(const server *s, const task *t)
{
    char *text = NULL;
    json_t *state = job_json(s, t);
    char *data = state ? json_dumps(state, JSON_COMPACT | JSON_REAL_PRECISION(6)) : NULL;
    if (data && asprintf(&text, "event: %s\ndata: %s\n\n", event_name(t->state), data) < 0) text = NULL;
    free(data);
    json_decref(state);
    return text;
}

// Sleep until there is something to say, if only that we are still there. False: nothing more will be.
static bool next_event(stream *e)
{
    server *s = e->s;
    struct timespec until;
    if (e->last) return false;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += HEARTBEAT_SECONDS;
    pthread_mutex_lock(&s->lock);
    for (bool waiting = true; waiting;) {
        const task *t = s->closing ? NULL : jobs_find(s, e->job);
        waiting = false;
        if (!t) {
            e->last = true;
            set_pending(e, NULL);
        } else if (t->version != e->seen) {
            e->seen = t->version;
            e->last = t->state == JOB_DONE || t->state == JOB_FAILED;
            set_pending(e, event_text(s, t));
        } else if (pthread_cond_timedwait(&s->changed, &s->lock, &until) != 0) {
            set_pending(e, strdup(":\n\n"));
        } else {
            waiting = true;
        }
    }
    pthread_mutex_unlock(&s->lock);
    return e->pending != NULL;
}

static ssize_t read_stream(void *user, uint64_t position, char *to, size_t most)
{
    stream *e = user;
    (void)position;
    if (e->sent == e->size && !next_event(e)) return MHD_CONTENT_READER_END_OF_STREAM;
    size_t piece = MIN(e->size - e->sent, most);
    memcpy(to, e->pending + e->sent, piece);
    e->sent += piece;
    return (ssize_t)piece;
}

static void free_stream(void *user)
{
    stream *e = user;
    free(e->pending);
    free(e);
}

enum MHD_Result events_reply(server *s, struct MHD_Connection *connection, const char *id)
{
    stream *e = calloc(1, sizeof *e);
    if (!e) return MHD_NO;
    e->s = s;
    e->seen = UINT32_MAX;
    snprintf(e->job, sizeof e->job, "%s", id);
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, BLOCK_BYTES, read_stream, e, free_stream);
    if (!response) free_stream(e);
    return reply_with(connection, MHD_HTTP_OK, response, "text/event-stream");
}
