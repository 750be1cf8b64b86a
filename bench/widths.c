// The independent judge's table for docs/results.md: what discs of the printer's diameters leave uncovered.
//
//     widths [DATA_FOLDER] [--threads N] [--only NAME] [--paper] [--tolerance PX]
//
// The same 24 runs as results.c. Each mask is judged by exact distances (tests/judge_widths.h) with discs of
// diameter phi_s and phi_v, less the tolerance for rasterisation (1 working pixel). Exit 1 when a type A or B
// is left.
#include <jali/jali.h>
#include "judge_widths.h"
#include "runs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
    const char *folder, *only;
    bool paper;
    double tolerance_px;
} request;

static void print_verdict(const judge_verdict *v)
{
    printf(" | %lld | %d, %d, %d", (long long)v->uncovered_px, v->type[0], v->type[1], v->type[2]);
}

static int32_t broken(const judge_verdict *v)
{
    return v->type[0] + v->type[1];
}

// Make and judge one picture; the number of details of types A and B, or -1.
static int32_t judge_run(jali_context *ctx, const request *r, const bench_run *run)
{
    char path[1024];
    jali_picture picture;
    jali_result result;
    jali_options opt = jali_defaults();
    opt.place.width_mm = run->width_mm;
    opt.optimise.paper = r->paper;
    opt.solid = opt.predict = false;
    snprintf(path, sizeof path, "%s/%s.png", r->folder, run->name);
    if (jali_read(ctx, path, NULL, &picture) != JALI_OK ||
        jali_make(ctx, &picture, &opt, &result) != JALI_OK) {
        fprintf(stderr, "%s\n", jali_message(ctx));
        jali_picture_free(ctx, &picture);
        return -1;
    }
    judge_verdict white, black;
    judge_mask(&result.optimised.mask, &result.chart, &opt.optimise, result.optimised.kernels_px,
               r->tolerance_px, &white, &black);
    printf("| %s %.0f", run->name, run->width_mm);
    print_verdict(&white);
    print_verdict(&black);
    printf(" |\n");
    if (broken(&white)) fprintf(stderr, "%s: first white at (%d, %d)\n", run->name, white.at[0], white.at[1]);
    if (broken(&black)) fprintf(stderr, "%s: first black at (%d, %d)\n", run->name, black.at[0], black.at[1]);
    fflush(stdout);
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &picture);
    return broken(&white) + broken(&black);
}

int main(int argc, char **argv)
{
    request r = {.folder = "../shared/data/images", .tolerance_px = 1};
    jali_context_options copt = jali_context_defaults();
    copt.threads = 1;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--threads") && i + 1 < argc)
            copt.threads = (int32_t)strtol(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "--only") && i + 1 < argc)
            r.only = argv[++i];
        else if (!strcmp(argv[i], "--tolerance") && i + 1 < argc)
            r.tolerance_px = strtod(argv[++i], NULL);
        else if (!strcmp(argv[i], "--paper"))
            r.paper = true;
        else
            r.folder = argv[i];
    }
    jali_context *ctx;
    if (jali_context_create(&copt, &ctx) != JALI_OK) return 1;
    int32_t left = 0, count = 0;
    printf("| picture, width mm | solid: uncovered px | A, B, C | void: uncovered px | A, B, C "
           "|\n|---|---|---|---|---|\n");
    for (int32_t i = 0; i < BENCH_RUNS; i++) {
        if (r.only && strcmp(r.only, bench_runs[i].name)) continue;
        int32_t found = judge_run(ctx, &r, &bench_runs[i]);
        if (found < 0) return 1;
        left += found;
        count++;
    }
    printf("\ntypes A and B left in %d runs: %d\n", count, left);
    jali_context_free(ctx);
    return left > 0;
}
