// How near the print's edges come to the picture's: the table of docs/nudge.md.
//
//     edges [DATA_FOLDER] [--threads N] [--only NAME]
//
// phi 0.1 / 0.3 / 0.5 mm. Predicted errors in %, of the picture connected only, as carved, nudged, and nudged
// on a working grid twice as fine; each against the picture's pixels, and against its smooth outline: the
// same picture blurred by one of its pixels and cut at one half, so that the stairs of slanting edges do not
// count. Bridges: the share of the picture that bridges cover, which no edge can make good.
#include "runs.h"

#include "raster/raster.h"
#include "scan/grey.h"
#include "base/base.h"

#include <jali/jali.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>

enum { WAYS = 3 };

static const struct way {
    const char *name;
    double pixel_mm; // 0 = as usual
    int32_t rounds;
} ways[WAYS] = {{"as carved", 0, 0}, {"nudged", 0, 3}, {"nudged, pixel 0.0125", 0.0125, 3}};

typedef struct errors {
    double connected[2], result[WAYS][2]; // against pixels, against the smooth outline
    double bridges;
} errors;

static jali_status smooth_outline(jali_context *ctx, const jali_bitmap *picture, int32_t pixel,
                                  jali_bitmap *smooth)
{
    jali_status status;
    grey level = {0};
    TRY(grey_of_bitmap(ctx, picture, 1, &level));
    TRY(grey_blur(ctx, &level, pixel));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, smooth));
    for (int32_t y = 0; y < smooth->height_px; y++)
        for (int32_t x = 0; x < smooth->width_px; x++)
            jali_bitmap_set(smooth, x, y,
                            (double)level.level[(size_t)y * (size_t)level.width + (size_t)x] > 0.5);
done:
    grey_free(ctx, &level);
    return status;
}

static double percent_apart(jali_context *ctx, const jali_bitmap *a, const jali_bitmap *b)
{
    return 100.0 * (double)count_combined(ctx, RULE_XOR, a, b) / ((double)a->width_px * a->height_px);
}

static jali_status measure(jali_context *ctx, const char *path, double width_mm, errors *e)
{
    jali_status status = JALI_OK;
    for (int way = 0; way < WAYS; way++) {
        jali_picture picture = {0};
        jali_result r = {0};
        jali_reference reference = {0};
        jali_bitmap smooth = {0};
        jali_options opt = jali_defaults();
        opt.place.width_mm = width_mm;
        opt.place.pixel_mm = ways[way].pixel_mm;
        opt.nudge_rounds = ways[way].rounds;
        opt.recall = opt.solid = false;
        opt.optimise.details = true;
        TRY(jali_read(ctx, path, NULL, &picture));
        TRY(jali_make(ctx, &picture, &opt, &r));
        jali_predict_options p = jali_prediction_options(&opt);
        p.chart = &r.chart;
        p.picture_mm = width_mm;
        TRY(jali_reference_create(ctx, &r.input, &p, &reference));
        TRY(smooth_outline(ctx, &reference.picture, reference.factor, &smooth));
        const jali_bitmap *wanted[] = {&reference.picture, &smooth};
        for (int k = 0; k < 2; k++) {
            e->connected[k] = percent_apart(ctx, wanted[k], &r.connected_print.printed);
            e->result[way][k] = percent_apart(ctx, wanted[k], &r.result_print.printed);
        }
        e->bridges = 100.0 * (double)count_white(ctx, &r.optimised.bridge_mask) /
                     ((double)r.optimised.mask.width_px * r.optimised.mask.height_px);
    done:
        jali_picture_free(ctx, &picture);
        jali_result_free(ctx, &r);
        jali_reference_free(ctx, &reference);
        jali_bitmap_free(ctx, &smooth);
        if (status != JALI_OK) break;
    }
    return status;
}

static void print_row(const bench_run *run, const errors *e)
{
    printf("| %s %.0f | %.2f", run->name, run->width_mm, e->bridges);
    for (int k = 0; k < 2; k++) {
        printf(" | %.2f", e->connected[k]);
        for (int way = 0; way < WAYS; way++)
            printf(" | %.2f (%.2f)", e->result[way][k], e->result[way][k] / e->connected[k]);
    }
    printf(" |\n");
    fflush(stdout);
}

int main(int argc, char **argv)
{
    mallopt(M_MMAP_THRESHOLD, 1 << 30); // as the command line does
    static const char *const NAMES[] = {"lion", "portrait", "calligraphy", "ornament", "monroe-like"};
    const char *folder = "../shared/data/images", *only = NULL;
    jali_context_options copt = jali_context_defaults();
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--threads") && i + 1 < argc)
            copt.threads = (int32_t)strtol(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "--only") && i + 1 < argc)
            only = argv[++i];
        else
            folder = argv[i];
    }
    jali_context *ctx;
    if (jali_context_create(&copt, &ctx) != JALI_OK) return 1;
    printf("| picture, width mm | bridges");
    for (int k = 0; k < 2; k++) {
        printf(" | %s: connected only", k ? "smooth outline" : "pixels");
        for (int way = 0; way < WAYS; way++) printf(" | %s", ways[way].name);
    }
    printf(" |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        for (int i = 0; i < BENCH_RUNS; i++) {
            if (strcmp(bench_runs[i].name, NAMES[n]) || (only && strcmp(only, NAMES[n]))) continue;
            char path[1024];
            errors e;
            snprintf(path, sizeof path, "%s/%s.png", folder, NAMES[n]);
            if (measure(ctx, path, bench_runs[i].width_mm, &e) != JALI_OK) {
                fprintf(stderr, "%s\n", jali_message(ctx));
                return 1;
            }
            print_row(&bench_runs[i], &e);
        }
    jali_context_free(ctx);
    return 0;
}
