// Small files and true curves, for docs/results.md: how few points the contours have and how far they leave
// the smooth curve.
//
//     contours [DATA_FOLDER] [--only NAME]
//
// The same 24 runs as results.c, the default way, the picture without its plate. The smooth curve is the
// trace of the same mask with a deviation of one lattice unit (some nanometres): every crossing of the curve
// with a pixel's edge and every corner that a straight line does not replace. Its length counts the outline's
// pixels; its points' distances to the contour as written are the deviation.
#include <jali/jali.h>
#include "runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOOK_AHEAD = 8 };

typedef struct figures {
    int32_t points, input_width_px;
    double outline_px; // working pixels
    double pixel_mm, input_pixel_mm, deviation_mm;
} figures;

typedef struct polygon {
    int32_t (*point)[2];
    int32_t count;
} polygon;

static polygon polygon_of(const jali_contours *c, int32_t i)
{
    return (polygon){c->point + c->first[i], c->first[i + 1] - c->first[i]};
}

// Square of the distance from p to the polygon's side i, lattice units.
static double to_side(const polygon *g, int32_t i, const int32_t p[2])
{
    const int32_t *a = g->point[i % g->count], *b = g->point[(i + 1) % g->count];
    double dx = b[0] - a[0], dy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
    double along = fmin(fmax((px * dx + py * dy) / fmax(dx * dx + dy * dy, 1), 0), 1);
    return (px - along * dx) * (px - along * dx) + (py - along * dy) * (py - along * dy);
}

// The nearest of `count` sides from `first` on.
static int32_t nearest_side(const polygon *g, int32_t first, int32_t count, const int32_t p[2],
                            double *square)
{
    int32_t best = first;
    *square = INFINITY;
    for (int32_t i = first; i < first + count; i++) {
        double here = to_side(g, i, p);
        if (here >= *square) continue;
        *square = here;
        best = i;
    }
    return best % g->count;
}

// How far the curve's points lie from the contour. Both go the same way round, so the nearest side is seldom
// far ahead; where it seems to be off by more than `limit` all sides are looked at.
static double deviation_of(const polygon *curve, const polygon *contour, double limit)
{
    double most = 0, square;
    int32_t side = nearest_side(contour, 0, contour->count, curve->point[0], &square);
    for (int32_t k = 0; k < curve->count; k++) {
        int32_t ahead = contour->count < LOOK_AHEAD ? contour->count : LOOK_AHEAD;
        side = nearest_side(contour, side, ahead, curve->point[k], &square);
        if (square > limit * limit) side = nearest_side(contour, 0, contour->count, curve->point[k], &square);
        most = fmax(most, square);
    }
    return sqrt(most);
}

static double length_of(const polygon *g)
{
    double length = 0;
    for (int32_t i = 0; i < g->count; i++) {
        const int32_t *a = g->point[i], *b = g->point[(i + 1) % g->count];
        length += hypot((double)b[0] - a[0], (double)b[1] - a[1]);
    }
    return length;
}

static jali_status trace_twice(jali_context *ctx, const jali_bitmap *mask, const jali_chart *chart,
                               figures *f)
{
    jali_contours contour = {0}, curve = {0};
    jali_trace_options opt = jali_trace_defaults(), finest = {.deviation_mm = chart->unit_mm};
    jali_status status = jali_trace(ctx, mask, chart, &opt, &contour);
    if (status == JALI_OK) status = jali_trace(ctx, mask, chart, &finest, &curve);
    for (int32_t i = 0; status == JALI_OK && i < contour.contour_count; i++) {
        polygon coarse = polygon_of(&contour, i), fine = polygon_of(&curve, i);
        f->outline_px += length_of(&fine) / chart->pixel_units;
        f->deviation_mm =
            fmax(f->deviation_mm,
                 chart->unit_mm * deviation_of(&fine, &coarse, opt.deviation_mm / chart->unit_mm));
    }
    f->points = contour.point_count;
    f->pixel_mm = jali_chart_pixel_mm(chart);
    jali_contours_free(ctx, &contour);
    jali_contours_free(ctx, &curve);
    return status;
}

static jali_status measure_run(jali_context *ctx, const char *folder, const bench_run *run, figures *f)
{
    char path[1024];
    jali_picture picture = {0};
    jali_result result = {0};
    jali_options opt = jali_defaults();
    opt.place.width_mm = run->width_mm;
    opt.solid = opt.predict = false;
    snprintf(path, sizeof path, "%s/%s.png", folder, run->name);
    jali_status status = jali_read(ctx, path, NULL, &picture);
    if (status == JALI_OK) {
        f->input_pixel_mm = run->width_mm / picture.width_px;
        status = jali_make(ctx, &picture, &opt, &result);
    }
    if (status == JALI_OK) status = trace_twice(ctx, &result.optimised.mask, &result.chart, f);
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &picture);
    return status;
}

int main(int argc, char **argv)
{
    const char *folder = "../shared/data/images", *only = NULL;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--only") && i + 1 < argc)
            only = argv[++i];
        else
            folder = argv[i];
    }
    jali_context *ctx;
    if (jali_context_create(NULL, &ctx) != JALI_OK) return 1;
    double points = 0, working = 0, input = 0, most_mm = 0;
    printf("| picture, width mm | points | outline, working px | working px a point | input px a point | "
           "deviation, mm "
           "|\n|---|---|---|---|---|---|\n");
    for (int32_t i = 0; i < BENCH_RUNS; i++) {
        if (only && strcmp(only, bench_runs[i].name)) continue;
        figures f = {0};
        if (measure_run(ctx, folder, &bench_runs[i], &f) != JALI_OK) {
            fprintf(stderr, "%s\n", jali_message(ctx));
            return 1;
        }
        double outline_input_px = f.outline_px * f.pixel_mm / f.input_pixel_mm;
        printf("| %s %.0f | %d | %.0f | %.2f | %.2f | %.4f |\n", bench_runs[i].name, bench_runs[i].width_mm,
               f.points, f.outline_px, f.outline_px / f.points, outline_input_px / f.points, f.deviation_mm);
        fflush(stdout);
        points += f.points;
        working += f.outline_px;
        input += outline_input_px;
        most_mm = fmax(most_mm, f.deviation_mm);
    }
    printf("| all | %.0f | %.0f | %.2f | %.2f | %.4f |\n", points, working, working / points, input / points,
           most_mm);
    jali_context_free(ctx);
    return 0;
}
