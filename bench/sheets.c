// The analysis meshes of the test pictures as a table, or one of them as SVG.
//
//     sheets [DATA_FOLDER] [--only NAME] [--across N] [--svg FILE] [--whole]
//
// Widths as in docs/results.md, phi 0.1 / 0.3 / 0.5 mm. Time is that of the process. Columns: nodes,
// triangles, share of the triangles with an angle below 20 degrees, the smallest angle, ms and us a node.
#include "runs.h"

#include <jali/jali.h>
#include <jali/sheet.h>

#include "judge_sheet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct settings {
    const char *folder, *only, *svg;
    jali_sheet_options sheet;
} settings;

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void write_svg(const char *path, const jali_sheet *sheet)
{
    FILE *file = fopen(path, "w");
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (int32_t i = 0; i < sheet->node_count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = sheet->node[i][k] < low[k] ? sheet->node[i][k] : low[k];
            high[k] = sheet->node[i][k] > high[k] ? sheet->node[i][k] : high[k];
        }
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"%g %g %g %g\">\n<path fill=\"none\" "
            "stroke=\"#000\" stroke-width=\"0.01\" d=\"",
            low[0], -high[1], high[0] - low[0], high[1] - low[1]);
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const double *at = sheet->node[sheet->triangle[t][k]];
            fprintf(file, "%c%.4g %.4g", k ? 'L' : 'M', at[0], -at[1]);
        }
        fprintf(file, "Z\n");
    }
    fprintf(file, "\"/></svg>\n");
    fclose(file);
}

static jali_status measure(jali_context *ctx, const settings *set, const bench_run *run)
{
    char path[1024];
    jali_status status;
    jali_picture picture = {0};
    jali_result result = {0};
    jali_sheet sheet = {0};
    jali_options opt = jali_defaults();
    opt.place.width_mm = run->width_mm;
    opt.predict = false;
    snprintf(path, sizeof path, "%s/%s.png", set->folder, run->name);
    status = jali_read(ctx, path, NULL, &picture);
    if (status == JALI_OK) status = jali_make(ctx, &picture, &opt, &result);
    double begun = cpu_ms();
    if (status == JALI_OK)
        status = jali_sheet_plate(ctx, &result.contours, &result.chart, opt.carve.thickness_mm, &set->sheet,
                                  &sheet);
    double ms = cpu_ms() - begun;
    if (status == JALI_OK) {
        sheet_quality q = quality_of(&sheet);
        printf("| %s %.0f | %d | %d | %d | %.3f | %.1f | %.0f | %.2f |\n", run->name, run->width_mm,
               result.contours.point_count, sheet.node_count, sheet.triangle_count, 100 * q.share_below_20,
               q.least_degrees, ms, 1e3 * ms / sheet.node_count);
        for (int b = 0; b < 12; b++) printf(" %d-%d: %.2f%%", 5 * b, 5 * b + 5, 100 * q.bin[b]);
        printf(" mean %.1f\n", q.mean_degrees);
        fflush(stdout);
        if (set->svg) write_svg(set->svg, &sheet);
    } else
        fprintf(stderr, "%s: %s\n", run->name, jali_message(ctx));
    jali_sheet_free(ctx, &sheet);
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &picture);
    return status;
}

int main(int argc, char **argv)
{
    settings set = {"../shared/data/images", NULL, NULL, jali_sheet_defaults()};
    for (int i = 1; i < argc; i++) {
        bool more = i + 1 < argc;
        if (!strcmp(argv[i], "--only") && more)
            set.only = argv[++i];
        else if (!strcmp(argv[i], "--across") && more)
            set.sheet.across = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--svg") && more)
            set.svg = argv[++i];
        else if (!strcmp(argv[i], "--whole"))
            set.sheet.whole = true;
        else
            set.folder = argv[i];
    }
    jali_context *ctx;
    jali_context_options copt = jali_context_defaults();
    copt.threads = 1;
    if (jali_context_create(&copt, &ctx) != JALI_OK) return 1;
    jali_status status = JALI_OK;
    printf("| picture, mm | contour points | nodes | triangles | below 20 degrees, %% | smallest angle | ms "
           "| us a "
           "node |\n|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < BENCH_RUNS; i++)
        if ((!set.only || !strcmp(set.only, bench_runs[i].name)) &&
            measure(ctx, &set, &bench_runs[i]) != JALI_OK)
            status = JALI_BROKEN;
    jali_context_free(ctx);
    return status != JALI_OK;
}
