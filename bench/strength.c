// The table of strength in docs/reinforce.md: the structural stage on the pictures of the paper's Table 1.
//
//     strength DATA_FOLDER [--threads N] [--newtons N]... [--only PICTURE]
//
// phi 0.1 / 0.3 / 0.5 mm, walls of 4 mm on plates and 2 mm elsewhere, PLA (limit 10 MPa), the picture's
// boundary held, at most 8 rounds. Each picture bears 10 and 100 N, and the pressure of Figure 10 (15 kN on
// 10 x 7.2 cm). Seconds are those of the whole stage, what would do included; the CPU's are those of the
// whole run, of all threads and of the first one alone: that is what the run takes when nothing else keeps
// the processors busy. Exit 1 when a run fails; a wall that does not hold is no failure.
#include "bench.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static const double FIGURE_10_MPA = 15000 / (100.0 * 72);

typedef struct strength_run {
    const char *name, *picture;
    double width_mm, height_mm; // for the area that FIGURE_10_MPA acts on
    bool invert;
    const char *surface; // %s is the data folder; NULL: a plate
    jali_placing placing;
    double paper_s;
} strength_run;

static const strength_run RUNS[] = {
    {"Tree1", "tree", 80, 120, false, NULL, 0, 117},
    {"Tree2", "tree", 67, 100, false, NULL, 0, 108},
    {"Tree3", "tree", 56, 84, false, NULL, 0, 114},
    {"Lion1", "lion", 70, 70, false, NULL, 0, 95},
    {"Lion2", "lion", 40, 40, false, NULL, 0, 93},
    {"Scenery1", "scenery", 120, 120, false, NULL, 0, 1203},
    {"Scenery2", "scenery", 85, 85, false, NULL, 0, 870},
    {"Scenery3", "scenery", 120, 120, true, NULL, 0, 607},
    {"Hepburn", "portrait", 124, 124, false, "vase:h=326,r=105", JALI_PLACE_WRAP, 528},
    {"Plum", "plum", 85, 85, false, "%s/meshes/bunny.obj:up=y,scale=145.2", JALI_PLACE_PROJECT, 384},
    {"Monroe", "monroe-like", 70, 49, false, "cylinder:r=35.5,h=74", JALI_PLACE_WRAP, 154},
};
enum { RUN_COUNT = sizeof RUNS / sizeof *RUNS };

static double cpu_s(int whose)
{
    struct rusage used;
    getrusage(whose, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static void print_row(const strength_run *r, double force, const jali_result *result, double stage_s,
                      const double cpu[2])
{
    const jali_strength *s = &result->strength;
    const jali_strength_round *first = &s->round[0], *last = &s->round[s->round_count - 1];
    char told[160], thicker[32] = "no thickness";
    if (s->advice.thickness_mm > 0) snprintf(thicker, sizeof thicker, "%.3g mm", s->advice.thickness_mm);
    if (s->sound)
        snprintf(told, sizeof told, "sound");
    else
        snprintf(told, sizeof told, "bears %.2g %%; %s would do; unpierced %.3g MPa",
                 100 * s->advice.load_share, thicker, s->advice.unpierced_mpa);
    printf("| %s, %.0f mm | %.0f | %d k | %d | %d | %.3g | %.3g | %s | %.1f | %.1f | %.1f | %.0f | %.0f |\n",
           r->name, r->width_mm, force, (last->nodes + 500) / 1000, s->round_count, s->connectors,
           first->stress_mpa, last->stress_mpa, told, stage_s, cpu[0], cpu[1], r->paper_s,
           r->paper_s / cpu[1]);
    fflush(stdout);
}

static bool run_once(const char *data, const strength_run *r, int32_t threads, double force)
{
    char path[1024], words[1024];
    jali_context *ctx;
    jali_context_options own = jali_context_defaults();
    jali_picture picture = {0};
    jali_surface surface = {0};
    jali_surface_report report = {0};
    jali_result result = {0};
    jali_object object = {0};
    jali_options opt = jali_defaults();
    jali_read_options read = jali_read_defaults();
    own.threads = threads;
    if (jali_context_create(&own, &ctx) != JALI_OK) return false;
    opt.place.width_mm = r->width_mm;
    opt.place.placing = r->placing;
    read.invert = r->invert;
    opt.predict = false;
    opt.structure = true;
    opt.strengthen.analyse.load.force_n = force;
    opt.strengthen.reinforce.most_rounds = 8;
    snprintf(path, sizeof path, "%s/images/%s.png", data, r->picture);
    bool done = jali_read(ctx, path, &read, &picture) == JALI_OK;
    double begun = cpu_s(RUSAGE_SELF), begun_here = cpu_s(RUSAGE_THREAD);
    if (!r->surface) {
        done = done && jali_make(ctx, &picture, &opt, &result) == JALI_OK;
    } else {
        bool file = strncmp(r->surface, "%s", 2) == 0;
        snprintf(words, sizeof words, "%s%s", file ? data : "", r->surface + (file ? 2 : 0));
        done = done && jali_surface_open(ctx, words, NULL, &surface, &report) == JALI_OK &&
               jali_make_on(ctx, &surface, NULL, &picture, &opt, 1, &result, &object) == JALI_OK;
    }
    if (done)
        print_row(r, force, &result, result.seconds[JALI_STAGE_STRENGTHEN],
                  (double[]){cpu_s(RUSAGE_SELF) - begun, cpu_s(RUSAGE_THREAD) - begun_here});
    else
        fprintf(stderr, "%s at %g N: %s\n", r->name, force, jali_message(ctx));
    jali_result_free(ctx, &result);
    jali_object_free(ctx, &object);
    jali_surface_report_free(ctx, &report);
    jali_surface_free(ctx, &surface);
    jali_picture_free(ctx, &picture);
    jali_context_free(ctx);
    return done;
}

int main(int argc, char **argv)
{
    enum { MOST_FORCES = 8 };
    const char *data = "../shared/data", *only = NULL;
    double force[MOST_FORCES];
    int32_t threads = 2, forces = 0;
    bool done = true;
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--threads") == 0 && i + 1 < argc)
            threads = atoi(argv[++i]);
        else if (strcmp(argv[i], "--newtons") == 0 && i + 1 < argc && forces < MOST_FORCES)
            force[forces++] = atof(argv[++i]);
        else if (strcmp(argv[i], "--only") == 0 && i + 1 < argc)
            only = argv[++i];
        else
            data = argv[i];
    }
    if (forces == 0) { // 0: the pressure of Figure 10
        force[forces++] = 10;
        force[forces++] = 100;
        force[forces++] = 0;
    }
    printf(
        "| picture, width | N | nodes | rounds | connectors | MPa before | after | what is told | stage, s | "
        "run, "
        "CPU s | first thread | paper, s | times |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int32_t k = 0; k < RUN_COUNT; k++)
        for (int32_t f = 0; f < forces; f++) {
            const strength_run *r = &RUNS[k];
            if (only && strcmp(only, r->name) != 0) continue;
            double newtons = force[f] > 0 ? force[f] : FIGURE_10_MPA * r->width_mm * r->height_mm;
            done &= run_once(data, r, threads, newtons);
        }
    return done ? 0 : 1;
}
