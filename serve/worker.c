// The process that does one job: shuts itself in, reads the job, runs the verb, hands out what it makes.
//
// How:     the verb is the command line's own, in a context that opens no files (jali_files): what it reads
// came
//          as frames, what it writes goes out as frames. Threads and what libraries load late come first.
// Limits:  SVG is not read here: librsvg loads fonts as it draws. The page draws it and sends its pixels.
// Checked: tests/test_serve.c.
#include "worker.h"
#include "files.h"
#include "frames.h"
#include "sandbox.h"
#include "serve.h"
#include "base/bytes.h"
#include "sparse/blas.h"

#include <malloc.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <unistd.h>

enum { MOST_INPUTS = 4, LIBRARY_MB = 1500, MOST_VALUE_BYTES = 512 };

static const double STEP_SECONDS = 0.04; // between two words on progress: as often as an eye can tell

typedef struct worker {
    jali_context *ctx;
    jali_files files;
    jali_file input[MOST_INPUTS];
    uint8_t *job; // the request
    size_t job_size;
    double told_at; // seconds
} worker;

static bool take(void *user, const char *name, const void *data, size_t size)
{
    (void)user;
    if (!data) return frame_write(STDOUT_FILENO, FRAME_COMPLETE, name, "", 0);
    for (size_t i = 0; i < size; i += PIECE_BYTES) {
        size_t piece = MIN(size - i, (size_t)PIECE_BYTES);
        if (!frame_write(STDOUT_FILENO, FRAME_PIECE, name, (const char *)data + i, piece)) return false;
    }
    return true;
}

// Now and then. Nobody listening is no reason to stop: the server then kills.
static void tell_progress(void *user, const char *stage, double fraction)
{
    worker *w = user;
    char text[16];
    double now = seconds_now();
    if (now < w->told_at + STEP_SECONDS) return;
    w->told_at = now;
    snprintf(text, sizeof text, "%.2f", MIN(MAX(fraction, 0), 1));
    frame_write(STDOUT_FILENO, FRAME_PROGRESS, stage, text, strlen(text));
}

static int end(exit_code code, const char *sentence)
{
    char number[16];
    snprintf(number, sizeof number, "%d", (int)code);
    frame_write(STDOUT_FILENO, FRAME_END, number, sentence, strlen(sentence));
    return (int)code;
}

// A frame's data, with an end mark that does not count.
static uint8_t *read_data(const frame_head *head)
{
    uint8_t *data = malloc(head->size + 1);
    if (data && read_whole(STDIN_FILENO, data, head->size)) {
        data[head->size] = 0;
        return data;
    }
    free(data);
    return NULL;
}

// The request, up to RUN. Our own server writes it: a frame that is not sound is a bug or its end.
static bool read_request(worker *w)
{
    for (;;) {
        frame_head head;
        char name[FRAME_NAME_BYTES] = "";
        if (!read_whole(STDIN_FILENO, &head, sizeof head) || !frame_is_sound(&head, false)) return false;
        if (!read_whole(STDIN_FILENO, name, head.name_size)) return false;
        if (head.kind == FRAME_RUN) return w->job != NULL;
        if (head.kind == FRAME_FILE && w->files.count == MOST_INPUTS) return false;
        uint8_t *data = read_data(&head);
        char *kept = strdup(name);
        if (!data || !kept) return false;
        if (head.kind == FRAME_JOB) {
            w->job = data;
            w->job_size = head.size;
        } else {
            w->input[w->files.count++] = (jali_file){kept, data, head.size};
        }
    }
}

static const verb *verb_named(const char *name)
{
    int32_t count;
    const verb *list = verb_list(&count);
    for (int32_t i = 0; i < count; i++)
        if (name && strcmp(list[i].name, name) == 0) return &list[i];
    return NULL;
}

// A value as it stands on the command line; kept in `text` unless it is text already.
static const char *value_of(json_t *value, char text[MOST_VALUE_BYTES])
{
    if (json_is_string(value)) return json_string_value(value);
    if (json_is_boolean(value)) return json_is_true(value) ? "true" : "false";
    if (!json_is_number(value)) return NULL;
    snprintf(text, MOST_VALUE_BYTES, "%.17g", json_number_value(value));
    return text;
}

static jali_status set_options(jali_context *ctx, json_t *options, const verb *v, settings *set)
{
    const char *key;
    json_t *value;
    json_object_foreach(options, key, value)
    {
        char sentence[SENTENCE_BYTES], text[MOST_VALUE_BYTES];
        const char *given = value_of(value, text);
        if (!given) return fail(ctx, JALI_BAD_VALUE, "\"%.40s\" is no text, number, true or false", key);
        if (given == text) given = strdup(text); // the settings point to it; it lives as long as the process
        if (!given) return fail(ctx, JALI_NO_MEMORY, "no memory for the options");
        if (!set_option_named(key, given, JOB_OPTIONS & v->groups, set, sentence))
            return fail(ctx, JALI_BAD_VALUE, "%s", sentence);
    }
    if (set->map || set->moved_map)
        return fail(ctx, JALI_BAD_VALUE, "maps are files of the job: ask for stress.png or displacement.png");
    return JALI_OK;
}

static jali_status set_files(jali_context *ctx, json_t *names, const verb *v, settings *set)
{
    size_t i;
    json_t *name;
    json_array_foreach(names, i, name)
    {
        char sentence[SENTENCE_BYTES];
        const job_file *file = job_file_named(json_string_value(name));
        if (!file) return fail(ctx, JALI_BAD_VALUE, "there is no such file to ask for");
        if (!ask_for_file(file, v, set, sentence)) return fail(ctx, JALI_BAD_VALUE, "%s", sentence);
    }
    return JALI_OK;
}

static jali_status run_job(worker *w, json_t *asked)
{
    jali_status status;
    const verb *v = verb_named(json_string_value(json_object_get(asked, "verb")));
    settings set = default_settings();
    if (!v) return fail(w->ctx, JALI_BAD_VALUE, "there is no such verb");
    set.quiet = true;
    set.operand = w->input[0].name;
    TRY(set_options(w->ctx, json_object_get(asked, "options"), v, &set));
    if (json_string_value(json_object_get(asked, "printer")))
        set.printer = json_string_value(json_object_get(asked, "printer"));
    if (json_string_value(json_object_get(asked, "edits")))
        set.edits = json_string_value(json_object_get(asked, "edits"));
    TRY(set_files(w->ctx, json_object_get(asked, "files"), v, &set));
    settle_options(&set);
    TRY(settle_printer(w->ctx, &set));
    TRY(v->run(w->ctx, &set));
done:
    return status;
}

// What must not happen once the doors are shut.
static void warm_up(void)
{
    double one = 4;
    int n = 1, info;
    json_object_seed(0);               // else read from /dev/urandom
    dpotrf_("L", &n, &one, &n, &info); // OpenBLAS takes its buffers
}

#ifdef JALI_HOOKS
#include "hooks.h"
#else
#define run_hook(job) ((void)0)
#endif

static int do_job(worker *w)
{
    json_error_t error;
    json_t *asked = json_loadb((const char *)w->job, w->job_size, JSON_REJECT_DUPLICATES, &error);
    if (!json_is_object(asked) || w->files.count == 0) return end(EXIT_USAGE, "the job is no JSON object");
    run_hook(asked);
    jali_status status = run_job(w, asked);
    return end(exit_code_of(status), status == JALI_OK ? "" : jali_message(w->ctx));
}

int run_worker(int argc, char **argv)
{
    static worker w; // its inputs and settings live as long as the process
    if (argc != 5 || isatty(STDIN_FILENO)) {
        fprintf(stderr, "jali: \"jali work\" is for \"jali serve\" alone\n");
        return EXIT_USAGE;
    }
    uint64_t memory_mb = strtoull(argv[2], NULL, 10), cpu_seconds = strtoull(argv[3], NULL, 10);
    jali_context_options opt = jali_context_defaults();
    prctl(PR_SET_PDEATHSIG, SIGKILL); // nothing is left when the server is killed
    signal(SIGPIPE, SIG_IGN);
    mallopt(M_ARENA_MAX, 1); // further arenas look into /proc as they shrink
    opt.threads = (int32_t)strtol(argv[4], NULL, 10);
    opt.max_memory_bytes = memory_mb * 1000000;
    opt.progress = tell_progress;
    opt.user = &w;
    w.files = (jali_files){.file = w.input, .take = take};
    opt.files = &w.files;
    warm_up();
    if (jali_context_create(&opt, &w.ctx) != JALI_OK) return end(EXIT_FAILED, "no memory to begin with");
    if (!enter_sandbox((memory_mb + LIBRARY_MB) * 1000000, cpu_seconds))
        return end(EXIT_FAILED, "this system refuses to shut a job in (seccomp), so none is run");
    _exit(read_request(&w) ? do_job(&w) : EXIT_FAILED);
}
