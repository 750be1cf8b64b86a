// The metric of a chart: what a pixel step is long on the surface, knot by knot.
//
// How:     faces are drawn at 4 x 4 samples a knot; a knot is the mean of its samples. Knots that no face
//          reaches (the margin beyond the surface) take after their neighbours.
// Checked: tests/test_place_on.c: cylinder, sphere and cone against their formulas.
#include "place/patch.h"

#include <math.h>

static const float FLATNESS = 0.005F; // of lengths: 0.06 px of a width of 12
enum { STEP_PX = 16, SAMPLES = 4 };

// Eigenvalues of the metric are the squared stretches.
static void widen(const double g[3], double stretch[2])
{
    double mean = (g[0] + g[2]) / 2, apart = hypot((g[0] - g[2]) / 2, g[1]);
    stretch[0] = MIN(stretch[0], sqrt(MAX(mean - apart, 0)));
    stretch[1] = MAX(stretch[1], sqrt(mean + apart));
}

// Means of the samples; the number of knots that have none.
static int32_t average(const laid *l, const view *v, jali_chart *chart, double stretch[2])
{
    int32_t empty = 0;
    for (int32_t j = 0; j < chart->metric_rows; j++)
        for (int32_t i = 0; i < chart->metric_columns; i++) {
            double sum[3] = {0}, count = 0;
            for (int32_t y = j * SAMPLES; y < MIN((j + 1) * SAMPLES, v->rows); y++)
                for (int32_t x = i * SAMPLES; x < MIN((i + 1) * SAMPLES, v->columns); x++) {
                    // Rows of the view run upwards, those of the metric downwards.
                    int32_t face = v->face[(size_t)(v->rows - 1 - y) * (size_t)v->columns + (size_t)x];
                    double g[3];
                    if (face < 0 || !face_metric(l, face, g)) continue;
                    for (int k = 0; k < 3; k++) sum[k] += g[k];
                    count++;
                }
            float *knot = chart->metric[(size_t)j * (size_t)chart->metric_columns + (size_t)i];
            if (count == 0) {
                knot[0] = -1;
                empty++;
                continue;
            }
            for (int k = 0; k < 3; k++) sum[k] /= count;
            int32_t x = i * STEP_PX, y = j * STEP_PX, margin = chart->margin_px;
            if (x >= margin && y >= margin && x < chart->width_px - margin && y < chart->height_px - margin)
                widen(sum, stretch);
            knot[0] = (float)sum[0];
            knot[1] = (float)-sum[1]; // y down
            knot[2] = (float)sum[2];
        }
    return empty;
}

// Spread known knots to empty neighbours, forth and back until none is empty; all are when no face is there.
static void fill_empty(jali_chart *chart, int32_t empty)
{
    int32_t columns = chart->metric_columns, count = columns * chart->metric_rows;
    if (empty == count) {
        for (int32_t i = 0; i < count; i++)
            memcpy(chart->metric[i], (float[3]){1, 0, 1}, sizeof *chart->metric);
        return;
    }
    for (bool any = empty > 0; any;) {
        any = false;
        for (int back = 0; back < 2; back++)
            for (int32_t n = 0; n < count; n++) {
                int32_t i = back ? count - 1 - n : n, side = back ? 1 : -1;
                bool beside = back ? i % columns + 1 < columns : i % columns > 0;
                bool above = i + side * columns >= 0 && i + side * columns < count;
                if (chart->metric[i][0] >= 0) continue;
                const float *from = beside && chart->metric[i + side][0] >= 0 ? chart->metric[i + side]
                                    : above && chart->metric[i + side * columns][0] >= 0
                                        ? chart->metric[i + side * columns]
                                        : NULL;
                if (from)
                    memcpy(chart->metric[i], from, sizeof *chart->metric);
                else
                    any = true;
            }
    }
}

// True when every length is as in the plane, but for FLATNESS: unrolled cylinders and cones.
static bool is_flat(const jali_chart *chart)
{
    for (int32_t i = 0; i < chart->metric_columns * chart->metric_rows; i++) {
        const float *g = chart->metric[i];
        if (fabsf(g[0] - 1) > 2 * FLATNESS || fabsf(g[1]) > FLATNESS || fabsf(g[2] - 1) > 2 * FLATNESS)
            return false;
    }
    return true;
}

jali_status fill_metric(jali_context *ctx, const laid *l, const growth *g, jali_chart *chart,
                        double stretch[2])
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    view v;
    double step_mm = jali_chart_pixel_mm(chart) * STEP_PX / SAMPLES;
    chart->metric_step_px = STEP_PX;
    chart->metric_columns = (chart->width_px + STEP_PX - 1) / STEP_PX;
    chart->metric_rows = (chart->height_px + STEP_PX - 1) / STEP_PX;
    TRY(ALLOCATE(ctx, chart->metric, (size_t)chart->metric_columns * (size_t)chart->metric_rows));
    // Samples in the middle of their cells, the first row of the view at the bottom of the last knot row.
    double half[2] = {chart->width_px * jali_chart_pixel_mm(chart) / 2,
                      chart->height_px * jali_chart_pixel_mm(chart) / 2};
    double low[2] = {-half[0] + step_mm / 2, half[1] - (chart->metric_rows * SAMPLES - 0.5) * step_mm};
    double high[2] = {low[0] + (chart->metric_columns * SAMPLES - 0.75) * step_mm, half[1] - 0.25 * step_mm};
    TRY(view_create(ctx, low, high, step_mm, false, &v));
    draw_faces(l, g->taken, g->turns, &v);
    stretch[0] = INFINITY;
    stretch[1] = 0;
    fill_empty(chart, average(l, &v, chart, stretch));
    if (is_flat(chart)) { // then the image stages need not look at each place
        release(ctx, chart->metric);
        chart->metric = NULL;
        chart->metric_columns = chart->metric_rows = chart->metric_step_px = 0;
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
