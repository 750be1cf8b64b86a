// The processes of jobs: started, fed, listened to, ended.
//
// How:     one loop over their pipes. As many run as --jobs says; two more wait ready, their libraries loaded
//          and their doors shut, so that a preview need not wait for that, nor a preview right after another.
// Checked: tests/test_serve.c: kill -9, crashes, lies, time, 50 at once.
#include "dispatch.h"
#include "child.h"
#include "jobs.h"
#include "patience.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_CHILDREN = 64, SPARE = 2, TICK_MS = 500 };

typedef struct crew {
    server *s;
    int32_t most;
    child each[MOST_CHILDREN + SPARE]; // [most + SPARE]
    bool renew;                        // jobs have begun or ended since processes were made ready
    char verdict[MOST_MESSAGE_BYTES];  // why the one looked at has to end
    int verdict_exit;
} crew;

/// One of them, while its frames are looked at.
typedef struct hearing {
    crew *c;
    child *of;
} hearing;

static bool sentence(crew *c, int exit, const char *words)
{
    c->verdict_exit = exit;
    snprintf(c->verdict, sizeof c->verdict, "%s", words);
    return false;
}

// The job of a process, by its name; NULL: it was cancelled. Under the lock.
static task *running_task(crew *c, const char *id)
{
    for (int32_t i = 0; *id && i < c->s->task_count; i++)
        if (strcmp(c->s->task[i]->id, id) == 0)
            return c->s->task[i]->state == JOB_RUNNING ? c->s->task[i] : NULL;
    return NULL;
}

static double number_of(const uint8_t *data, size_t size)
{
    char text[40] = "";
    memcpy(text, data, MIN(size, sizeof text - 1));
    double number = strtod(text, NULL);
    return number >= 0 && number <= 1 ? number : 0;
}

// False: there is nothing more to hear. The verdict then says how it went.
static bool on_frame(void *user, const frame_head *head, const char *name, const uint8_t *data)
{
    const hearing *h = user;
    crew *c = h->c;
    const char *why;
    char words[MOST_MESSAGE_BYTES];
    task *t = running_task(c, h->of->job);
    if (!t) return head->kind == FRAME_END ? sentence(c, EXIT_FAILED, "") : true;
    switch (head->kind) {
    case FRAME_PROGRESS: jobs_progress(c->s, t, name, number_of(data, head->size)); return true;
    case FRAME_PIECE:
        if (jobs_take(c->s, t, name, data, head->size, &why)) return true;
        return sentence(c, EXIT_LIMIT, why);
    case FRAME_COMPLETE:
        if (jobs_take(c->s, t, name, NULL, 0, &why)) return true;
        return sentence(c, EXIT_FAILED, why);
    default:
        snprintf(words, sizeof words, "%.*s", (int)MIN(head->size, sizeof words - 1), (const char *)data);
        return sentence(c, (int)strtol(name, NULL, 10) & 255, words);
    }
}

// Why a process ended that did not say so itself.
static void explain_end(crew *c, int state)
{
    char words[MOST_MESSAGE_BYTES];
    int number = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
    int code = number == SIGXCPU ? EXIT_LIMIT : EXIT_FAILED;
    if (number == SIGSYS)
        snprintf(words, sizeof words,
                 "the job tried what it may not, such as opening a file, and was ended; is the picture from "
                 "a source "
                 "you trust?");
    else if (number == SIGXCPU)
        snprintf(words, sizeof words, "the job took more processor time than it may (--job-time)");
    else if (number != 0)
        snprintf(words, sizeof words, "the job's process was ended by a signal (%s); the other jobs go on",
                 strsignal(number));
    else
        snprintf(words, sizeof words, "the job's process ended without a result");
    sentence(c, code, words);
}

// End a process; its job, if it still has one, ends with the verdict, or with how the process ended.
static void dismiss(crew *c, child *of)
{
    char id[TOKEN_BYTES];
    memcpy(id, of->job, TOKEN_BYTES);
    c->renew |= *id != 0;
    int state = child_end(of);
    if (c->verdict_exit < 0) explain_end(c, state);
    pthread_mutex_lock(&c->s->lock);
    task *t = running_task(c, id);
    if (t) jobs_end(c->s, t, c->verdict_exit, c->verdict);
    pthread_mutex_unlock(&c->s->lock);
    server_wake(c->s); // there is room for the next
}

// Processes whose job was cancelled, or has taken too long.
static void end_overdue(crew *c)
{
    for (int32_t i = 0; i < c->most + SPARE; i++) {
        child *of = &c->each[i];
        char words[MOST_MESSAGE_BYTES];
        if (of->pid == 0 || !*of->job) continue;
        pthread_mutex_lock(&c->s->lock);
        bool wanted = running_task(c, of->job) != NULL;
        pthread_mutex_unlock(&c->s->lock);
        if (wanted && seconds_now() < of->until) continue;
        snprintf(words, sizeof words, "the job was stopped after %g s, the longest it may take (--job-time)",
                 c->s->set->job_seconds);
        sentence(c, EXIT_LIMIT, words);
        dismiss(c, of);
    }
}

// The one that waits, else a free place; NULL: all are at work.
static child *ready_child(crew *c)
{
    child *place = NULL;
    int32_t working = 0;
    for (int32_t i = 0; i < c->most + SPARE; i++) {
        child *of = &c->each[i];
        if (of->pid != 0 && *of->job)
            working++;
        else if (!place || of->pid != 0)
            place = of;
    }
    return working < c->most ? place : NULL;
}

// One that has ended while it waited is no use.
static bool has_gone(const child *of)
{
    struct pollfd watched = {.fd = of->from, .events = POLLIN};
    return of->pid != 0 && poll(&watched, 1, 0) > 0;
}

static void give_jobs(crew *c)
{
    for (child *of; (of = ready_child(c));) {
        char words[MOST_MESSAGE_BYTES];
        if (has_gone(of)) child_end(of);
        pthread_mutex_lock(&c->s->lock);
        task *t = jobs_next(c->s);
        if (t && of->pid == 0 && !child_start(of, c->s->set)) {
            snprintf(words, sizeof words, "the system starts no process for the job: %s", strerror(errno));
            jobs_end(c->s, t, EXIT_FAILED, words);
        } else if (t) {
            child_give(of, t, c->s->set->job_seconds);
            t->state = JOB_RUNNING;
            t->started_at = seconds_now();
            jobs_progress(c->s, t, "start", 0);
            c->renew = true;
        }
        pthread_mutex_unlock(&c->s->lock);
        if (!t) break;
    }
}

// Those that wait ready anew, after jobs have begun or ended: never in a loop on ones that end at once. One
// while jobs run, which need the processors themselves, the rest when there is peace.
static void renew_ready(crew *c)
{
    int32_t working = 0, ready = 0;
    if (!c->renew) return;
    for (int32_t i = 0; i < c->most + SPARE; i++) {
        working += c->each[i].pid != 0 && *c->each[i].job;
        ready += c->each[i].pid != 0 && !*c->each[i].job;
    }
    int32_t wanted = working > 0 ? 1 : SPARE;
    for (int32_t i = 0; i < c->most + SPARE && ready < wanted; i++)
        if (c->each[i].pid == 0) ready += child_start(&c->each[i], c->s->set);
    c->renew = false;
}

static void hear(crew *c, child *of, short events)
{
    hearing h = {c, of};
    bool goes_on = true;
    c->verdict_exit = -1;
    if (events & (POLLIN | POLLHUP | POLLERR)) {
        pthread_mutex_lock(&c->s->lock);
        goes_on = child_listen(of, on_frame, &h);
        pthread_mutex_unlock(&c->s->lock);
    }
    if (!goes_on) dismiss(c, of);
}

static void wait_and_hear(crew *c)
{
    struct pollfd watched[2 * (MOST_CHILDREN + SPARE) + 1];
    child *whose[2 * (MOST_CHILDREN + SPARE) + 1];
    nfds_t count = 0;
    uint64_t woken;
    watched[count++] = (struct pollfd){.fd = c->s->wake, .events = POLLIN};
    for (int32_t i = 0; i < c->most + SPARE; i++) {
        child *of = &c->each[i];
        if (of->pid == 0) continue;
        whose[count] = of;
        watched[count++] = (struct pollfd){.fd = of->from, .events = POLLIN};
        if (!*of->job || of->to < 0) continue;
        whose[count] = of;
        watched[count++] = (struct pollfd){.fd = of->to, .events = POLLOUT};
    }
    if (poll(watched, count, TICK_MS) <= 0) return;
    if (watched[0].revents) (void)!read(c->s->wake, &woken, sizeof woken);
    for (nfds_t i = 1; i < count; i++) {
        child *of = whose[i];
        if (watched[i].revents == 0 || of->pid == 0) continue;
        // What a process has said before it went is heard first, so a pipe that takes no more is no matter
        // here.
        if (watched[i].events == POLLOUT)
            (void)!child_feed(of);
        else
            hear(c, of, watched[i].revents);
    }
}

jali_status dispatch(jali_context *ctx, server *s)
{
    jali_status status;
    crew c = {.s = s, .most = s->set->jobs};
    if (c.most == 0) c.most = (int32_t)MIN(MAX(sysconf(_SC_NPROCESSORS_ONLN), 1), MOST_CHILDREN);
    for (int32_t i = 0; i < SPARE; i++) (void)!child_start(&c.each[i], s->set);
    while (!stopping(ctx)) {
        end_overdue(&c);
        give_jobs(&c);
        renew_ready(&c);
        wait_and_hear(&c);
        patience_tick(s);
    }
    for (int32_t i = 0; i < c.most + SPARE; i++)
        if (c.each[i].pid != 0) child_end(&c.each[i]);
    status = step(ctx, "serve", 1);
    return status == JALI_CANCELLED ? JALI_OK : status;
}
