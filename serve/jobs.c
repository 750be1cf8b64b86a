// Jobs: asked for, waiting, running, done; what they made is kept until there is no room.
//
// Processes know their job by its name, so that a job may be cancelled and forgotten at any time: who looks
// after the process (dispatch.c) finds none of that name that runs, and ends it.
#include "jobs.h"
#include "cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool finished(const task *t)
{
    return t->state == JOB_DONE || t->state == JOB_FAILED;
}

// What it read is of no use once it is done.
static void drop_request(task *t)
{
    blob_let_go(t->picture);
    blob_let_go(t->mesh);
    blob_let_go(t->printer);
    blob_let_go(t->edits);
    free(t->request);
    t->picture = t->mesh = t->printer = t->edits = NULL;
    t->request = NULL;
}

void task_free(task *t)
{
    if (!t) return;
    drop_request(t);
    for (int32_t i = 0; i < t->file_count; i++) blob_let_go(t->file[i].bytes);
    free(t);
}

static void forget_at(server *s, int32_t i)
{
    task_free(s->task[i]);
    s->task_count--;
    for (; i < s->task_count; i++) s->task[i] = s->task[i + 1];
}

// The job done whose results were not asked for longest; `but` is kept. False: there is none.
static bool forget_oldest(server *s, const task *but)
{
    int32_t found = -1;
    for (int32_t i = 0; i < s->task_count; i++)
        if (finished(s->task[i]) && s->task[i] != but &&
            (found < 0 || s->task[i]->used < s->task[found]->used))
            found = i;
    if (found >= 0) forget_at(s, found);
    return found >= 0;
}

bool jobs_add(server *s, task *t)
{
    pthread_mutex_lock(&s->lock);
    for (int32_t i = 0; i < s->task_count && *t->client; i++)
        if (!finished(s->task[i]) && strcmp(s->task[i]->client, t->client) == 0)
            jobs_cancel(s, s->task[i], "a newer request took its place");
    bool room = s->task_count < MOST_JOBS || forget_oldest(s, NULL);
    if (room) {
        t->asked_at = seconds_now();
        t->used = ++s->clock;
        s->task[s->task_count++] = t;
    }
    server_changed(s);
    pthread_mutex_unlock(&s->lock);
    server_wake(s);
    return room;
}

task *jobs_find(server *s, const char *id)
{
    for (int32_t i = 0; i < s->task_count; i++)
        if (strcmp(s->task[i]->id, id) == 0) {
            s->task[i]->used = ++s->clock;
            return s->task[i];
        }
    return NULL;
}

task *jobs_next(server *s)
{
    for (int32_t i = 0; i < s->task_count; i++)
        if (s->task[i]->state == JOB_QUEUED) return s->task[i];
    return NULL;
}

// A worker that was taken over may say anything: one line of UTF-8 is left, or of ASCII.
static void make_plain(char *text)
{
    json_t *valid = json_string(text);
    for (unsigned char *c = (unsigned char *)text; *c; c++)
        if (*c < 32 || *c == 127 || (!valid && *c > 127)) *c = '?';
    json_decref(valid);
}

void jobs_end(server *s, task *t, int exit, const char *message)
{
    t->state = exit == EXIT_DONE || exit == EXIT_BROKEN ? JOB_DONE : JOB_FAILED;
    t->exit = exit;
    t->ended_at = seconds_now();
    snprintf(t->message, sizeof t->message, "%s", message);
    make_plain(t->message);
    for (int32_t i = 0; i < t->file_count; i++) {
        result_file *f = &t->file[i];
        if (t->state == JOB_DONE && f->complete) continue;
        blob_let_go(f->bytes);
        f->bytes = NULL;
    }
    drop_request(t);
    t->version++;
    server_changed(s);
}

void jobs_progress(server *s, task *t, const char *stage, double fraction)
{
    snprintf(t->stage, sizeof t->stage, "%s", stage);
    make_plain(t->stage);
    t->fraction = fraction;
    t->version++;
    server_changed(s);
}

static result_file *asked_file(task *t, const char *name)
{
    for (int32_t i = 0; i < t->file_count; i++)
        if (strcmp(t->file[i].file->name, name) == 0) return &t->file[i];
    return NULL;
}

static bool append(server *s, task *t, result_file *f, const void *data, size_t size)
{
    for (;;) {
        if (!f->bytes) f->bytes = blob_create(&s->result_budget, size);
        if (f->bytes && blob_append(f->bytes, data, size)) return true;
        if (!forget_oldest(s, t)) return false;
    }
}

bool jobs_take(server *s, task *t, const char *name, const void *data, size_t size, const char **why)
{
    result_file *f = asked_file(t, name);
    *why = "it made a file that was not asked for";
    if (!f || f->complete) return false;
    *why = "there is no room for what it made";
    if (data) return append(s, t, f, data, size);
    if (!f->bytes) return false;
    blob_fit(f->bytes);
    f->complete = true;
    server_changed(s);
    return true;
}

void jobs_cancel(server *s, task *t, const char *why)
{
    if (finished(t)) return;
    jobs_end(s, t, EXIT_INTERRUPTED, why);
    server_wake(s);
}

bool jobs_forget(server *s, const char *id)
{
    task *t = jobs_find(s, id);
    if (!t) return false;
    jobs_cancel(s, t, "cancelled");
    for (int32_t i = 0; i < s->task_count; i++)
        if (s->task[i] == t) forget_at(s, i);
    return true;
}

int32_t jobs_ahead(const server *s, const task *t)
{
    int32_t ahead = 0;
    for (int32_t i = 0; i < s->task_count && s->task[i] != t; i++) ahead += s->task[i]->state == JOB_QUEUED;
    return ahead;
}

const char *job_state_name(job_state state)
{
    static const char *const names[] = {"queued", "running", "done", "failed"};
    return names[state];
}

static json_t *files_of_task(const task *t)
{
    json_t *files = json_object();
    for (int32_t i = 0; i < t->file_count; i++)
        if (t->file[i].bytes)
            json_object_set_new(files, t->file[i].file->name,
                                json_integer((json_int_t)t->file[i].bytes->size));
    return files;
}

json_t *job_json(const server *s, const task *t)
{
    json_t *state = json_pack("{s:s, s:s, s:f}", "id", t->id, "state", job_state_name(t->state), "seconds",
                              (finished(t) ? t->ended_at : seconds_now()) - t->asked_at);
    if (!state) return NULL;
    if (t->state == JOB_QUEUED) json_object_set_new(state, "ahead", json_integer(jobs_ahead(s, t)));
    if (t->state == JOB_RUNNING) {
        json_object_set_new(state, "stage", json_string(t->stage));
        json_object_set_new(state, "fraction", json_real(t->fraction));
    }
    if (finished(t)) {
        json_object_set_new(state, "exit", json_integer(t->exit));
        json_object_set_new(state, "message", json_string(t->message));
        json_object_set_new(state, "files", files_of_task(t));
    }
    return state;
}

void jobs_free(server *s)
{
    while (s->task_count > 0) forget_at(s, s->task_count - 1);
}
