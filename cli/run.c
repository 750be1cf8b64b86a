// A verb's run: its context, what a signal does to it, what the user sees of it, and how it ends.
#include "cli.h"
#include "sparse/solver.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

// A signal handler reaches nothing but a global.
static jali_context *volatile running;

typedef struct progress_line {
    bool on_terminal, plain;
    char stage[32]; // the one shown last
    int percent;
} progress_line;

static void on_signal(int number)
{
    (void)number;
    if (running) jali_cancel(running);
}

// The first signal asks the run to stop, the second ends the program; a closed pipe and a full file come back
// as errors of the write.
static void catch_signals(void)
{
    struct sigaction ask = {.sa_handler = on_signal, .sa_flags = SA_RESETHAND},
                     ignore = {.sa_handler = SIG_IGN};
    sigaction(SIGINT, &ask, NULL);
    sigaction(SIGTERM, &ask, NULL);
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGXFSZ, &ignore, NULL);
}

static void on_progress(void *user, const char *stage, double fraction)
{
    progress_line *line = user;
    int percent = (int)(100 * fraction);
    bool same = strncmp(line->stage, stage, sizeof line->stage - 1) == 0;
    if (same && (line->plain || percent == line->percent)) return;
    snprintf(line->stage, sizeof line->stage, "%s", stage);
    line->percent = percent;
    if (line->plain)
        fprintf(stderr, "jali: %s\n", stage);
    else if (line->on_terminal)
        fprintf(stderr, "\r\033[K%s %d %%", stage, percent);
}

static void clear_line(const progress_line *line)
{
    if (line->on_terminal && line->stage[0]) fprintf(stderr, "\r\033[K");
}

void say(const settings *set, const char *format, ...)
{
    if (set->quiet) return;
    va_list arguments;
    va_start(arguments, format);
    if (isatty(STDERR_FILENO)) fprintf(stderr, "\r\033[K");
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

exit_code exit_code_of(jali_status status)
{
    switch (status) {
    case JALI_OK: return EXIT_DONE;
    case JALI_BAD_VALUE: return EXIT_USAGE;
    case JALI_BAD_INPUT: return EXIT_REJECTED;
    case JALI_LIMIT: return EXIT_LIMIT;
    case JALI_CANCELLED: return EXIT_INTERRUPTED;
    case JALI_BROKEN: return EXIT_BROKEN;
    default: return EXIT_FAILED;
    }
}

exit_code run_verb(const verb *v, settings *set, const char *refusal)
{
    jali_context *ctx;
    progress_line line = {.plain = set->progress == PROGRESS_PLAIN};
    line.on_terminal = set->progress == PROGRESS_AUTO && isatty(STDERR_FILENO);
    if (!set->quiet && (line.plain || line.on_terminal)) set->context.progress = on_progress;
    set->context.user = &line;
    if (jali_context_create(&set->context, &ctx) != JALI_OK) {
        fprintf(stderr, "jali: no memory to begin with\n");
        return EXIT_FAILED;
    }
    running = ctx;
    catch_signals();
    jali_status status = refusal ? fail(ctx, JALI_BAD_VALUE, "%s", refusal) : settle_printer(ctx, set);
    if (status == JALI_OK) status = v->run(ctx, set);
    status = solver_agree(ctx, status);
    running = NULL;
    clear_line(&line);
    if (status != JALI_OK) fprintf(stderr, "jali: %s\n", jali_message(ctx));
    jali_context_free(ctx);
    if (fflush(stdout) != 0 && status == JALI_OK) {
        fprintf(stderr, "jali: cannot write stdout\n");
        return EXIT_FAILED;
    }
    return exit_code_of(status);
}
