// Which request means what: a table of paths, and what is asked of a request before its body is read.
//
// How:     a path is compared piece by piece with those of the table; nothing of it ever becomes a file's
// name. Checked: tests/test_serve.c, bench/hostile.c.
#include "api.h"
#include "events.h"
#include "guard.h"
#include "jobs.h"
#include "lists.h"
#include "page.h"
#include "patience.h"
#include "reply.h"
#include "request.h"
#include "store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PARTS_OF_PATH = 2, PART_BYTES = 64, IDLE_SECONDS = 60 };

typedef struct exchange exchange;

typedef struct route {
    const char *method, *path; // * is one part of a path
    size_t most_bytes;         // of the body; 0 = it takes none
    enum MHD_Result (*answer)(server *s, struct MHD_Connection *connection, exchange *e);
} route;

/// One request, from its head to its answer.
struct exchange {
    const route *route;
    char part[MOST_PARTS_OF_PATH][PART_BYTES]; // what the stars stood for
    blob *body;
    size_t wanted; // bytes of it
};

static enum MHD_Result answer_version(server *s, struct MHD_Connection *connection, exchange *e)
{
    (void)s, (void)e;
    return reply_json(connection, MHD_HTTP_OK, json_pack("{s:s, s:i}", "jali", jali_version(), "api", 1));
}

static enum MHD_Result answer_lists(server *s, struct MHD_Connection *connection, exchange *e)
{
    (void)e;
    return lists_reply(s, connection);
}

static enum MHD_Result answer_sample(server *s, struct MHD_Connection *connection, exchange *e)
{
    (void)s;
    return sample_reply(connection, e->part[0],
                        MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "size"));
}

static enum MHD_Result answer_upload(server *s, struct MHD_Connection *connection, exchange *e)
{
    char id[TOKEN_BYTES];
    char name[3 * MOST_NAME_BYTES + 1] = "";
    const char *given = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "name");
    snprintf(name, sizeof name, "%s", given ? given : "");
    MHD_http_unescape(name);
    if (!store_keep(s, e->body, name, id))
        return reply_error(connection, MHD_HTTP_INTERNAL_SERVER_ERROR, "the system has no random numbers");
    e->body = NULL;
    return reply_json(connection, MHD_HTTP_CREATED,
                      json_pack("{s:s, s:I}", "id", id, "bytes", (json_int_t)e->wanted));
}

static enum MHD_Result answer_kept(server *s, struct MHD_Connection *connection, exchange *e)
{
    char name[MOST_NAME_BYTES + 1];
    blob *bytes = store_find(s, e->part[0], name);
    if (bytes) return reply_blob(connection, bytes, "application/octet-stream");
    return reply_error(connection, MHD_HTTP_NOT_FOUND, "there is no upload of that id; send it again");
}

static enum MHD_Result answer_job(server *s, struct MHD_Connection *connection, exchange *e)
{
    char why[MOST_MESSAGE_BYTES], id[TOKEN_BYTES];
    unsigned status;
    task *t = task_from_json(s, e->body, why, &status);
    if (!t) return reply_error(connection, status, "%s", why);
    memcpy(id, t->id, TOKEN_BYTES);
    if (!jobs_add(s, t)) {
        task_free(t);
        return reply_error(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "%d jobs wait already; ask again later",
                           MOST_JOBS);
    }
    return reply_json(connection, MHD_HTTP_CREATED, json_pack("{s:s}", "id", id));
}

static enum MHD_Result no_job(struct MHD_Connection *connection)
{
    return reply_error(connection, MHD_HTTP_NOT_FOUND,
                       "there is no such job; what was done earliest is forgotten when room is needed");
}

static enum MHD_Result answer_state(server *s, struct MHD_Connection *connection, exchange *e)
{
    pthread_mutex_lock(&s->lock);
    const task *t = jobs_find(s, e->part[0]);
    json_t *state = t ? job_json(s, t) : NULL;
    pthread_mutex_unlock(&s->lock);
    return t ? reply_json(connection, MHD_HTTP_OK, state) : no_job(connection);
}

static enum MHD_Result answer_events(server *s, struct MHD_Connection *connection, exchange *e)
{
    pthread_mutex_lock(&s->lock);
    bool known = jobs_find(s, e->part[0]) != NULL;
    pthread_mutex_unlock(&s->lock);
    return known ? events_reply(s, connection, e->part[0]) : no_job(connection);
}

static blob *made_file(const task *t, const job_file *file)
{
    for (int32_t i = 0; i < t->file_count; i++)
        if (t->file[i].file == file && t->file[i].complete) return t->file[i].bytes;
    return NULL;
}

// Sleep until the file is there, the job has ended or is gone, or the time is up. Under the lock.
static const task *wait_for_file(server *s, const char *id, const job_file *file)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += WAIT_SECONDS;
    for (bool late = false;;) {
        const task *t = s->closing ? NULL : jobs_find(s, id); // anew each time: it may be forgotten meanwhile
        bool over = !t || t->state == JOB_DONE || t->state == JOB_FAILED || made_file(t, file);
        if (over || late) return t;
        late = pthread_cond_timedwait(&s->changed, &s->lock, &until) != 0;
    }
}

static enum MHD_Result answer_file(server *s, struct MHD_Connection *connection, exchange *e)
{
    const job_file *file = job_file_named(e->part[1]);
    bool wait = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "wait") != NULL;
    pthread_mutex_lock(&s->lock);
    const task *t = wait ? wait_for_file(s, e->part[0], file) : jobs_find(s, e->part[0]);
    blob *bytes = t ? made_file(t, file) : NULL;
    json_t *state = wait && t && !bytes && t->state != JOB_DONE ? job_json(s, t) : NULL;
    if (bytes) blob_hold(bytes);
    pthread_mutex_unlock(&s->lock);
    if (!t) return no_job(connection);
    if (state) return reply_json(connection, MHD_HTTP_ACCEPTED, state);
    if (!bytes) return reply_error(connection, MHD_HTTP_NOT_FOUND, "this job has made no file of that name");
    return reply_blob(connection, bytes, file->type);
}

static enum MHD_Result answer_delete(server *s, struct MHD_Connection *connection, exchange *e)
{
    pthread_mutex_lock(&s->lock);
    bool known = jobs_forget(s, e->part[0]);
    pthread_mutex_unlock(&s->lock);
    return known ? reply_json(connection, MHD_HTTP_OK, json_object()) : no_job(connection);
}

static const route routes[] = {
    {"GET", "/api/v1/version", 0, answer_version},
    {"GET", "/api/v1/lists", 0, answer_lists},
    {"GET", "/api/v1/samples/*", 0, answer_sample},
    {"POST", "/api/v1/uploads", MOST_UPLOAD_BYTES, answer_upload},
    {"GET", "/api/v1/uploads/*", 0, answer_kept},
    {"POST", "/api/v1/jobs", MOST_JSON_BYTES, answer_job},
    {"GET", "/api/v1/jobs/*", 0, answer_state},
    {"DELETE", "/api/v1/jobs/*", 0, answer_delete},
    {"GET", "/api/v1/jobs/*/events", 0, answer_events},
    {"GET", "/api/v1/jobs/*/files/*", 0, answer_file},
};

static bool fits(const char *path, const char *url, exchange *e)
{
    for (int32_t star = 0; *path; path++) {
        if (*path != '*') {
            if (*url++ != *path) return false;
            continue;
        }
        size_t length = strcspn(url, "/");
        if (length == 0 || length >= PART_BYTES) return false;
        memcpy(e->part[star], url, length);
        e->part[star++][length] = 0;
        url += length;
    }
    return *url == 0;
}

// The route, or the answer that there is none.
static bool find_route(struct MHD_Connection *connection, const char *url, const char *method, exchange *e,
                       enum MHD_Result *replied)
{
    bool known = false;
    for (size_t i = 0; i < sizeof routes / sizeof *routes; i++) {
        if (!fits(routes[i].path, url, e)) continue;
        known = true;
        e->route = &routes[i];
        if (strcmp(method, routes[i].method) == 0) return true;
    }
    *replied = known
                   ? reply_error(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "this does not take %.20s", method)
                   : reply_error(connection, MHD_HTTP_NOT_FOUND, "there is nothing here of that name");
    return false;
}

// Make room for the body, or answer why not. What is refused here is never read.
static bool expect_body(server *s, struct MHD_Connection *connection, exchange *e, enum MHD_Result *replied)
{
    const char *length = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Content-Length");
    bool chunked = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Transfer-Encoding") != NULL;
    unsigned long long bytes = length ? strtoull(length, NULL, 10) : 0;
    size_t most = e->route->most_bytes;
    if (most == 0 && bytes == 0 && !chunked) return true;
    if (most == 0)
        *replied = reply_error(connection, MHD_HTTP_BAD_REQUEST, "this takes no body");
    else if (!length || chunked)
        *replied = reply_error(connection, MHD_HTTP_LENGTH_REQUIRED, "a body needs a Content-Length");
    else if (bytes == 0)
        *replied = reply_error(connection, MHD_HTTP_BAD_REQUEST, "the body is empty");
    else if (bytes > most)
        *replied = reply_error(connection, MHD_HTTP_CONTENT_TOO_LARGE,
                               "the body has %llu bytes; %zu are accepted", bytes, most);
    else if (!(e->body = store_room(s, (size_t)bytes)))
        *replied = reply_error(connection, MHD_HTTP_SERVICE_UNAVAILABLE,
                               "there is no room for %llu bytes now", bytes);
    else {
        e->wanted = (size_t)bytes;
        patience_set(s, connection, BODY_SECONDS + (double)bytes / BODY_BYTES_A_SECOND);
        return true;
    }
    return false;
}

static enum MHD_Result begin(server *s, struct MHD_Connection *connection, const char *url,
                             const char *method, exchange *e)
{
    enum MHD_Result replied = MHD_YES;
    bool api = strncmp(url, "/api/", 5) == 0;
    const char *refusal = guard_refusal(s, connection, api);
    patience_set(s, connection, IDLE_SECONDS); // whatever is refused has little time to take note of it
    if (refusal) return reply_error(connection, MHD_HTTP_FORBIDDEN, "%s", refusal);
    if (!api && strcmp(method, "GET") != 0 && strcmp(method, "HEAD") != 0)
        return reply_error(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "this does not take %.20s", method);
    if (!api) return MHD_YES;
    if (!find_route(connection, url, method, e, &replied)) return replied;
    if (!expect_body(s, connection, e, &replied)) return replied;
    return MHD_YES;
}

enum MHD_Result api_answer(void *user, struct MHD_Connection *connection, const char *url, const char *method,
                           const char *version, const char *piece, size_t *piece_size, void **record)
{
    server *s = user;
    exchange *e = *record;
    (void)version;
    if (!e) {
        *record = e = calloc(1, sizeof *e);
        return e ? begin(s, connection, url, method, e) : MHD_NO;
    }
    if (*piece_size > 0) {
        bool room = e->body && e->wanted - e->body->size >= *piece_size;
        if (!room || !blob_append(e->body, piece, *piece_size)) return MHD_NO;
        *piece_size = 0;
        return MHD_YES;
    }
    if (e->body && e->body->size != e->wanted) return MHD_NO;
    patience_set(s, connection, 0);
    return e->route ? e->route->answer(s, connection, e) : page_reply(connection, url);
}

void api_completed(void *user, struct MHD_Connection *connection, void **record,
                   enum MHD_RequestTerminationCode how)
{
    exchange *e = *record;
    (void)how;
    if (!e) return;
    blob_let_go(e->body);
    free(e);
    *record = NULL;
    patience_set(user, connection, IDLE_SECONDS);
}
