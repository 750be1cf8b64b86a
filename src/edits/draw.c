// Edits drawn onto a working grid: strokes and regions as pixels, bridges as ways from pixel to pixel.
//
// A stroke is a disc set on each pixel of its way, a region all pixels whose centre it holds (even-odd, a
// scanline a row). What lies beyond the grid is cut off.
// Checked: tests/test_edits.c.
#include <jali/edits.h>
#include "raster/field.h"
#include "base/base.h"

#include <math.h>
#include <stdlib.h>

void jali_marks_free(jali_context *ctx, jali_marks *marks)
{
    jali_bridges_free(ctx, &marks->drawn);
    jali_bitmap_free(ctx, &marks->wide);
    jali_bitmap_free(ctx, &marks->closed);
    jali_bitmap_free(ctx, &marks->locked);
    *marks = (jali_marks){0};
}

typedef struct drawing {
    const jali_edits *edits;
    const jali_chart *chart;
    double scale[2];    // grid pixels a unit of the edits
    double (*point)[2]; // [point_count], on the grid
    double *crossing;   // [point_count], of one row
    size_t bridge_capacity, via_capacity;
    jali_marks *marks;
} drawing;

// The pixel that holds a point; far outside, one near the border does as well.
static void pixel_of(const drawing *d, int32_t point, int32_t pixel[2])
{
    int32_t most[2] = {d->chart->width_px, d->chart->height_px};
    for (int k = 0; k < 2; k++)
        pixel[k] = (int32_t)floor(fmin(fmax(d->point[point][k], -most[k]), 2.0 * most[k]));
}

static jali_status draw_stroke(jali_context *ctx, const drawing *d, const jali_edit *e, jali_bitmap *dst)
{
    jali_status status;
    element disc = {0};
    field brush = {0};
    tiling flat = {0};
    int32_t from[2], to[2];
    double diameter_px = fmin(e->width * (d->scale[0] + d->scale[1]) / 2, MAX(dst->width_px, dst->height_px));
    TRY(element_disc(ctx, fmax(diameter_px, 1), &disc));
    TRY(field_of_element(ctx, &disc, &brush));
    brush.tiles = &flat;
    for (int32_t i = 0; i < MAX(e->count - 1, 1); i++) {
        TRY(step(ctx, "edits", 0));
        pixel_of(d, e->first + i, from);
        pixel_of(d, e->first + MIN(i + 1, e->count - 1), to);
        paint_stroke(dst, from, to, &brush, true);
    }
done:
    field_free(ctx, &brush);
    element_free(ctx, &disc);
    return status;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Where a row's centres cross the region's outline.
static int32_t crossings(const drawing *d, const jali_edit *e, double y)
{
    int32_t count = 0;
    for (int32_t i = 0; i < e->count; i++) {
        const double *a = d->point[e->first + i], *b = d->point[e->first + (i + 1) % e->count];
        if ((a[1] <= y) == (b[1] <= y)) continue;
        d->crossing[count++] = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    }
    qsort(d->crossing, (size_t)count, sizeof *d->crossing, by_value);
    return count;
}

static void draw_region(const drawing *d, const jali_edit *e, jali_bitmap *dst)
{
    for (int32_t y = 0; y < dst->height_px; y++) {
        int32_t count = crossings(d, e, y + 0.5);
        for (int32_t i = 0; i + 1 < count; i += 2) {
            double x0 = fmax(ceil(d->crossing[i] - 0.5), 0),
                   x1 = fmin(ceil(d->crossing[i + 1] - 0.5), dst->width_px);
            if (x0 < x1) paint_run(dst, y, (int32_t)x0, (int32_t)x1, true);
        }
    }
}

static jali_status draw_bridge(jali_context *ctx, drawing *d, const jali_edit *e)
{
    jali_status status;
    jali_bridges *drawn = &d->marks->drawn;
    TRY(GROW(ctx, drawn->bridge, d->bridge_capacity, drawn->count + 1));
    TRY(GROW(ctx, drawn->via, d->via_capacity, drawn->via_count + e->count));
    jali_bridge *bridge = &drawn->bridge[drawn->count++];
    *bridge =
        (jali_bridge){.part = {-1, -1}, .via_first = drawn->via_count, .via_count = MAX(e->count - 2, 0)};
    pixel_of(d, e->first, bridge->from);
    pixel_of(d, e->first + e->count - 1, bridge->to);
    for (int32_t i = 1; i + 1 < e->count; i++) pixel_of(d, e->first + i, drawn->via[drawn->via_count++]);
    if (e->width > 0) TRY(draw_stroke(ctx, d, e, &d->marks->wide));
done:
    return status;
}

static jali_status draw_edit(jali_context *ctx, drawing *d, const jali_edit *e)
{
    jali_marks *m = d->marks;
    jali_bitmap *dst = e->kind == JALI_EDIT_LOCK ? &m->locked : &m->closed;
    m->count[e->kind]++;
    if (e->kind == JALI_EDIT_BRIDGE) return draw_bridge(ctx, d, e);
    if (e->width > 0) return draw_stroke(ctx, d, e, dst);
    draw_region(d, e, dst);
    return step(ctx, "edits", 0);
}

// The margin belongs to the frame, which is neither forbidden nor locked.
static void clear_margin(const jali_chart *chart, jali_bitmap *a)
{
    int32_t margin = chart->margin_px, right = a->width_px - margin;
    for (int32_t y = 0; margin > 0 && y < a->height_px; y++)
        if (y < margin || y >= a->height_px - margin) {
            paint_run(a, y, 0, a->width_px, false);
        } else {
            paint_run(a, y, 0, margin, false);
            paint_run(a, y, right, a->width_px, false);
        }
}

jali_status jali_edits_draw(jali_context *ctx, const jali_edits *edits, const jali_chart *chart,
                            jali_marks *marks)
{
    jali_status status;
    int32_t margin = chart->margin_px;
    drawing d = {.edits = edits, .chart = chart, .marks = marks};
    *marks = (jali_marks){0};
    d.scale[0] = (chart->width_px - 2 * margin) / edits->size[0];
    d.scale[1] = (chart->height_px - 2 * margin) / edits->size[1];
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, &marks->wide));
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, &marks->closed));
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, &marks->locked));
    TRY(ALLOCATE(ctx, d.point, edits->point_count));
    TRY(ALLOCATE(ctx, d.crossing, edits->point_count));
    for (int32_t i = 0; i < edits->point_count; i++)
        for (int k = 0; k < 2; k++) d.point[i][k] = edits->point[i][k] * d.scale[k] + margin;
    for (int32_t i = 0; i < edits->count; i++) TRY(draw_edit(ctx, &d, &edits->edit[i]));
    clear_margin(chart, &marks->closed);
    clear_margin(chart, &marks->locked);
    combine(ctx, RULE_OR, &marks->closed, &marks->locked, &marks->closed);
done:
    if (status != JALI_OK) jali_marks_free(ctx, marks);
    release(ctx, d.point);
    release(ctx, d.crossing);
    return status;
}
