// The analysis meshes of the test pictures as a table, or one of them as SVG (plates) or OFF (surfaces).
//
//     sheets [DATA_FOLDER] [--only NAME] [--across N] [--whole] [--svg FILE | --off FILE]
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
    const char *folder, *only, *svg, *off;
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
            fprintf(file, "%c%.7g %.7g", k ? 'L' : 'M', at[0], -at[1]);
        }
        fprintf(file, "Z\n");
    }
    fprintf(file, "\"/></svg>\n");
    fclose(file);
}

static void print_row(const char *picture, double width_mm, const char *surface, int32_t points,
                      const jali_sheet *sheet, double ms)
{
    sheet_quality q = quality_of(sheet);
    printf("| %s %.0f | %.*s | %d | %d | %d | %.4f | %.1f | %.1f | %.0f | %.2f |%s\n", picture, width_mm,
           (int)strcspn(surface, ":,"), surface, points, sheet->node_count, sheet->triangle_count,
           100 * q.share_below_20, q.least_degrees, q.mean_degrees, ms, 1e3 * ms / sheet->node_count,
           is_manifold(sheet) ? "" : " NOT A MANIFOLD");
    fflush(stdout);
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
    snprintf(path, sizeof path, "%s/images/%s.png", set->folder, run->name);
    status = jali_read(ctx, path, NULL, &picture);
    if (status == JALI_OK) status = jali_make(ctx, &picture, &opt, &result);
    double begun = cpu_ms();
    if (status == JALI_OK)
        status = jali_sheet_plate(ctx, &result.contours, &result.chart, opt.carve.thickness_mm, &set->sheet,
                                  &sheet);
    double ms = cpu_ms() - begun;
    if (status == JALI_OK) {
        print_row(run->name, run->width_mm, "plate", result.contours.point_count, &sheet, ms);
        if (set->svg) write_svg(set->svg, &sheet);
    } else
        fprintf(stderr, "%s: %s\n", run->name, jali_message(ctx));
    jali_sheet_free(ctx, &sheet);
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &picture);
    return status;
}

// --- Surfaces

static void write_off(const char *path, const jali_sheet *sheet)
{
    FILE *file = fopen(path, "w");
    fprintf(file, "OFF\n%d %d 0\n", sheet->node_count, sheet->triangle_count);
    for (int32_t i = 0; i < sheet->node_count; i++)
        fprintf(file, "%.9g %.9g %.9g\n", sheet->node[i][0], sheet->node[i][1], sheet->node[i][2]);
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        fprintf(file, "3 %d %d %d\n", sheet->triangle[t][0], sheet->triangle[t][1], sheet->triangle[t][2]);
    fclose(file);
}

// What is laid on a surface: contours, chart, patch and the shell they are on.
typedef struct laid {
    jali_shell shell;
    jali_chart chart;
    jali_patch patch;
    jali_contours contours;
} laid;

static jali_status lay(jali_context *ctx, const settings *set, const surface_run *run, laid *out)
{
    jali_status status;
    char path[1024], words[1024];
    jali_picture picture = {0};
    jali_surface surface = {0};
    jali_bitmap drawing = {0};
    jali_optimised optimised = {0};
    jali_options opt = jali_defaults();
    opt.place.width_mm = run->width_mm;
    opt.place.placing = run->placing;
    snprintf(path, sizeof path, "%s/images/%s.png", set->folder, run->picture);
    snprintf(words, sizeof words, "%s%s", run->surface[0] == '%' ? set->folder : "",
             run->surface + (run->surface[0] == '%' ? 2 : 0));
    if ((status = jali_read(ctx, path, NULL, &picture)) == JALI_OK &&
        (status = jali_surface_open(ctx, words, NULL, &surface, NULL)) == JALI_OK &&
        (status = jali_shell_create(ctx, &surface, NULL, &out->shell, NULL)) == JALI_OK &&
        (status = jali_place_on(ctx, &picture, 128, &opt.place, &out->shell.outer, &out->chart, &out->patch,
                                &drawing, NULL)) == JALI_OK &&
        (status = jali_optimise(ctx, &drawing, &out->chart, &opt.optimise, &optimised)) == JALI_OK)
        status = jali_trace(ctx, &optimised.mask, &out->chart, &opt.trace, &out->contours);
    jali_optimised_free(ctx, &optimised);
    jali_bitmap_free(ctx, &drawing);
    jali_surface_free(ctx, &surface);
    jali_picture_free(ctx, &picture);
    return status;
}

static jali_status measure_surface(jali_context *ctx, const settings *set, const surface_run *run)
{
    laid on = {0};
    jali_sheet sheet = {0};
    jali_status status = lay(ctx, set, run, &on);
    double begun = cpu_ms();
    if (status == JALI_OK)
        status = jali_sheet_shell(ctx, &on.contours, &on.chart, &on.patch, &on.shell, &set->sheet, &sheet);
    double ms = cpu_ms() - begun;
    if (status == JALI_OK) {
        const char *name = strrchr(run->surface, '/') ? strrchr(run->surface, '/') + 1 : run->surface;
        print_row(run->picture, run->width_mm, name, on.contours.point_count, &sheet, ms);
        if (set->off) write_off(set->off, &sheet);
    } else
        fprintf(stderr, "%s on %s: %s\n", run->picture, run->surface, jali_message(ctx));
    jali_sheet_free(ctx, &sheet);
    jali_contours_free(ctx, &on.contours);
    jali_patch_free(ctx, &on.patch);
    jali_chart_free(ctx, &on.chart);
    jali_shell_free(ctx, &on.shell);
    return status;
}

int main(int argc, char **argv)
{
    settings set = {"../shared/data", NULL, NULL, NULL, jali_sheet_defaults()};
    for (int i = 1; i < argc; i++) {
        bool more = i + 1 < argc;
        if (!strcmp(argv[i], "--only") && more)
            set.only = argv[++i];
        else if (!strcmp(argv[i], "--across") && more)
            set.sheet.across = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--svg") && more)
            set.svg = argv[++i];
        else if (!strcmp(argv[i], "--off") && more)
            set.off = argv[++i];
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
    printf("| picture, mm | on | contour points | nodes | triangles | below 20 degrees, %% | smallest angle "
           "| mean "
           "of smallest | ms | us a node |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < BENCH_RUNS && !set.off; i++)
        if ((!set.only || !strcmp(set.only, bench_runs[i].name)) &&
            measure(ctx, &set, &bench_runs[i]) != JALI_OK)
            status = JALI_BROKEN;
    for (int i = 0; i < SURFACE_RUNS && !set.svg; i++)
        if ((!set.only || !strcmp(set.only, surface_runs[i].picture)) &&
            measure_surface(ctx, &set, &surface_runs[i]) != JALI_OK)
            status = JALI_BROKEN;
    jali_context_free(ctx);
    return status != JALI_OK;
}
