// One process that does one job, as the server sees it.
//
// How:     posix_spawn of our own program (never fork: the server has threads), with its pipes, an empty
//          environment but for what libraries take from it, and in a process group of its own, so that the
//          terminal's Ctrl-C reaches the server alone.
// Checked: tests/test_serve.c.
#include "child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CPU_SLACK_SECONDS = 10 };

static int spawn(pid_t *pid, int in, int out, char *const *argv)
{
    // Sanitizers tell what they find; without them nothing a job says reaches the terminal.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    static char blas[] = "OPENBLAS_NUM_THREADS=1", asan[] = "ASAN_OPTIONS=detect_leaks=0";
    char *const environment[] = {blas, asan, NULL};
    const bool silent = false;
#else
    static char blas[] = "OPENBLAS_NUM_THREADS=1";
    char *const environment[] = {blas, NULL};
    const bool silent = true;
#endif
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_init(&how);
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
    if (silent) posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setsigmask(&how, &none);
    posix_spawnattr_setsigdefault(&how, &all);
    int reason = posix_spawn(pid, "/proc/self/exe", &files, &how, argv, environment);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&how);
    return reason;
}

static void close_pipes(int in[2], int out[2])
{
    for (int i = 0; i < 2; i++) {
        if (in[i] >= 0) close(in[i]);
        if (out[i] >= 0) close(out[i]);
    }
}

bool child_start(child *c, const settings *set)
{
    char memory[32], seconds[32], threads[16];
    int in[2] = {-1, -1}, out[2] = {-1, -1}, processors = (int)sysconf(_SC_NPROCESSORS_ONLN);
    int32_t each = set->context.threads ? set->context.threads : MAX(processors, 1);
    *c = (child){0};
    snprintf(memory, sizeof memory, "%.0f", set->job_memory_mb);
    snprintf(seconds, sizeof seconds, "%.0f", set->job_seconds * each + CPU_SLACK_SECONDS);
    snprintf(threads, sizeof threads, "%d", each);
    char name[] = "jali", word[] = "work";
    char *argv[] = {name, word, memory, seconds, threads, NULL};
    bool piped = pipe2(in, O_CLOEXEC) == 0 && pipe2(out, O_CLOEXEC) == 0;
    int reason = piped ? spawn(&c->pid, in[0], out[1], argv) : errno;
    if (reason != 0) {
        c->pid = 0;
        close_pipes(in, out);
        errno = reason;
        return false;
    }
    c->to = in[1];
    c->from = out[0];
    in[1] = out[0] = -1;
    close_pipes(in, out);
    fcntl(c->to, F_SETFL, O_NONBLOCK);
    fcntl(c->from, F_SETFL, O_NONBLOCK);
    return true;
}

static void add_frame(child *c, int32_t index, frame_kind kind, const char *name, const void *data,
                      size_t size)
{
    c->head[index] = (frame_head){.kind = kind, .name_size = (uint32_t)strlen(name), .size = size};
    c->part[c->part_count++] = (part){&c->head[index], sizeof c->head[index]};
    c->part[c->part_count++] = (part){name, strlen(name)};
    c->part[c->part_count++] = (part){data, size};
}

void child_give(child *c, task *t, double most_seconds)
{
    static const char *const names[] = {NULL, "model.mesh", "printer.json", "edits.json"};
    blob *const files[] = {t->picture, t->mesh, t->printer, t->edits};
    memcpy(c->job, t->id, TOKEN_BYTES);
    c->until = seconds_now() + most_seconds;
    c->request = t->request; // it is ours now: the job may be forgotten
    t->request = NULL;
    add_frame(c, 0, FRAME_JOB, "", c->request, strlen(c->request));
    for (int32_t i = 0; i < CHILD_INPUTS; i++)
        if (files[i]) {
            c->held[i] = blob_hold(files[i]);
            add_frame(c, 1 + i, FRAME_FILE, i == 0 ? t->picture_name : names[i], files[i]->data,
                      files[i]->size);
        }
    add_frame(c, 1 + CHILD_INPUTS, FRAME_RUN, "", NULL, 0);
}

static void stop_feeding(child *c)
{
    if (c->to >= 0) close(c->to);
    c->to = -1;
    for (int32_t i = 0; i < CHILD_INPUTS; i++) {
        blob_let_go(c->held[i]);
        c->held[i] = NULL;
    }
    free(c->request);
    c->request = NULL;
}

bool child_feed(child *c)
{
    while (c->written < c->part_count) {
        const part *p = &c->part[c->written];
        size_t left = p->size - c->written_of_part;
        ssize_t written = left ? write(c->to, (const char *)p->data + c->written_of_part, left) : 0;
        if (written < 0) return errno == EAGAIN || errno == EINTR;
        c->written_of_part += (size_t)written;
        if (c->written_of_part < p->size) continue;
        c->written++;
        c->written_of_part = 0;
    }
    stop_feeding(c);
    return true;
}

// How much more is needed to have a whole head, then the whole frame; SIZE_MAX: what is there is not sound.
static size_t missing(const child *c)
{
    frame_head head;
    if (c->frame_size < sizeof head) return sizeof head - c->frame_size;
    memcpy(&head, c->frame, sizeof head);
    if (!frame_is_sound(&head, true)) return SIZE_MAX;
    return sizeof head + head.name_size + head.size - c->frame_size;
}

static bool make_room(child *c, size_t more)
{
    if (c->frame_size + more <= c->frame_capacity) return true;
    uint8_t *larger = realloc(c->frame, c->frame_size + more + FRAME_NAME_BYTES);
    if (!larger) return false;
    c->frame = larger;
    c->frame_capacity = c->frame_size + more + FRAME_NAME_BYTES;
    return true;
}

bool child_listen(child *c,
                  bool (*frame)(void *user, const frame_head *head, const char *name, const uint8_t *data),
                  void *user)
{
    for (;;) {
        size_t more = missing(c);
        if (more == SIZE_MAX || !make_room(c, more)) return false;
        if (more == 0) {
            frame_head head;
            char name[FRAME_NAME_BYTES] = "";
            memcpy(&head, c->frame, sizeof head);
            memcpy(name, c->frame + sizeof head, head.name_size);
            c->frame_size = 0;
            if (!frame(user, &head, name, c->frame + sizeof head + head.name_size)) return false;
            continue;
        }
        ssize_t got = read(c->from, c->frame + c->frame_size, more);
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
        if (got <= 0) return false;
        c->frame_size += (size_t)got;
    }
}

int child_end(child *c)
{
    int state = 0;
    stop_feeding(c);
    close(c->from);
    // One that has ended already keeps its own state: a signal to what waits to be collected does nothing.
    kill(c->pid, SIGKILL);
    while (waitpid(c->pid, &state, 0) < 0 && errno == EINTR) {
    }
    free(c->frame);
    *c = (child){0};
    return state;
}
