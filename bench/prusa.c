// PrusaSlicer as a witness. FDM: nozzle 0.4 mm, layers of 0.2 mm, all filled, Arachne (the default of 2.5) or
// the classic perimeters. SLA: an SL1's pixels of 47 um, no supports, no pad; layers of 0.25 mm, since each
// of a plate shows the same and each costs the same.
//
// Left out is what PrusaSlicer looks for in plates whose layers differ: walls over nothing (--overhangs) and
// walls under slopes (--extra-perimeters). Ours have neither; the search for the first clips the whole layer
// below by the box of every wall, quadratic in the picture: 91 s instead of 10 for the tree 56 mm wide. The
// errors stay within 0.01 points (docs/compare.md).
#include "prusa.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

enum { MOST_WORDS = 40 };

const char *prusa_name(prusa_process process)
{
    static const char *const name[PRUSA_PROCESSES] = {"FDM 0.4", "FDM 0.4 classic", "SLA"};
    return name[process];
}

static const char *const fdm[] = {"--export-gcode",
                                  "--nozzle-diameter",
                                  "0.4",
                                  "--layer-height",
                                  "0.2",
                                  "--first-layer-height",
                                  "0.2",
                                  "--fill-pattern",
                                  "rectilinear",
                                  "--fill-density",
                                  "100%",
                                  "--skirts",
                                  "0",
                                  "--elefant-foot-compensation",
                                  "0",
                                  "--gcode-comments",
                                  "--overhangs=0",
                                  "--extra-perimeters=0",
                                  "--bed-shape",
                                  "0x0,400x0,400x400,0x400",
                                  NULL};
static const char *const sla[] = {"--export-sla", "--printer-technology", "SLA", "--layer-height", "0.25",
                                  "--initial-layer-height", "0.25", "--supports-enable=0", "--pad-enable=0",
                                  // Larger plates than an SL1's stay on one display of the same pixels.
                                  "--display-width", "240", "--display-height", "136", "--display-pixels-x",
                                  "5120", "--display-pixels-y", "2880", "--bed-shape",
                                  "0x0,240x0,240x136,0x136", NULL};

// Wait for a child, but not for ever. False when it was ended or failed.
static bool wait_for(pid_t child, double seconds, double *took)
{
    int ended;
    struct rusage used;
    struct timespec pause = {0, 50000000}, now, begun;
    clock_gettime(CLOCK_MONOTONIC, &begun);
    while (wait4(child, &ended, WNOHANG, &used) == 0) {
        clock_gettime(CLOCK_MONOTONIC, &now);
        if ((double)(now.tv_sec - begun.tv_sec) > seconds) {
            kill(child, SIGKILL);
            wait4(child, &ended, 0, &used);
            fprintf(stderr, "prusa-slicer took more than %.0f s and was ended\n", seconds);
            return false;
        }
        nanosleep(&pause, NULL);
    }
    *took = (double)used.ru_utime.tv_sec + 1e-6 * (double)used.ru_utime.tv_usec;
    bool fine = WIFEXITED(ended) && WEXITSTATUS(ended) == 0;
    if (!fine) fprintf(stderr, "prusa-slicer refused\n");
    return fine;
}

static bool run(const char *const *options, const char *more, const char *const from[], int parts,
                const char *to, double seconds, double *took)
{
    const char *word[MOST_WORDS] = {"prusa-slicer"};
    int count = 1;
    pid_t child;
    posix_spawn_file_actions_t files;
    while (*options) word[count++] = *options++;
    if (more) word[count++] = more;
    word[count++] = "-o";
    word[count++] = to;
    if (parts > 1) {
        word[count++] = "--merge";
        word[count++] = "--dont-arrange";
    }
    for (int i = 0; i < parts; i++) word[count++] = from[i];
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    int failed = posix_spawnp(&child, word[0], &files, NULL, (char **)(uintptr_t)word, environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed) {
        fprintf(stderr, "there is no prusa-slicer\n");
        return false;
    }
    return wait_for(child, seconds, took);
}

bool prusa_print(jali_context *ctx, prusa_process process, const jali_mesh *plate, int parts,
                 const char *folder, double pixel_mm, double seconds, jali_print *print, double *took)
{
    static const char *const file[] = {"plate.stl", "plate-2.stl"};
    char path[2][1024], to[1024];
    const char *const from[2] = {path[0], path[1]};
    bool resin = process == PRUSA_SLA;
    jali_print_options opt = jali_print_defaults();
    opt.pixel_mm = pixel_mm;
    snprintf(to, sizeof to, "%s/plate.%s", folder, resin ? "sl1" : "gcode");
    remove(to);
    for (int i = 0; i < parts; i++) {
        jali_product product = {.mesh = &plate[i]};
        snprintf(path[i], sizeof path[i], "%s/%s", folder, file[i]);
        if (jali_write(ctx, path[i], &product, NULL) != JALI_OK) {
            fprintf(stderr, "%s\n", jali_message(ctx));
            return false;
        }
    }
    const char *walls = process == PRUSA_CLASSIC ? "--perimeter-generator=classic" : NULL;
    if (!run(resin ? sla : fdm, walls, from, parts, to, seconds, took)) return false;
    jali_status status =
        resin ? jali_print_sl1(ctx, to, NULL, print) : jali_print_gcode(ctx, to, &opt, print);
    if (status != JALI_OK) fprintf(stderr, "%s\n", jali_message(ctx));
    return status == JALI_OK;
}
