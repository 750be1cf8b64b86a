// A picture once around: the image stages and the contours on a closed strip.
//
// How:     the stages know pictures with a border, so each works on a strip that holds more than one turn and
//          what lies far from its ends is kept. Optimising is not local (which piece joins which), so the
//          kept part need not fit itself where it was cut; a mask that is good stays as it is when it is
//          mended, and so mending the strip with the cut elsewhere changes the seam alone. It has come to
//          rest when a strip cut at a third place is not changed, nowhere within half a part of the ends. A
//          void is bounded on the endless strip, since the solid that holds the upper border to the lower one
//          parts it from its next copy; so each void is taken once, and cut by the strip's edge as a polygon.
// Limits:  the number of bridges is that of one part between its neighbours.
// Checked: tests/test_around.c.
#include <jali/around.h>

#include "base/base.h"
#include "base/sets.h"
#include "raster/raster.h"

#include <math.h>

enum { MENDINGS = 8, MOST_TURNS = 5 };

// --- Strips

static int32_t wrapped(int64_t x, int32_t period)
{
    int64_t rest = x % period;
    return (int32_t)(rest < 0 ? rest + period : rest);
}

// The columns between the margins.
static int32_t inner_width(const jali_chart *chart)
{
    return chart->width_px - 2 * chart->margin_px;
}

// `part` again and again, its first column at column `origin`, within dst's columns from .. to - 1.
static jali_status lay_parts(jali_context *ctx, const jali_bitmap *part, int32_t origin, int32_t from,
                             int32_t to, jali_bitmap *dst)
{
    jali_status status = JALI_OK;
    jali_bitmap piece = {0};
    for (int32_t x = from; x < to;) {
        int32_t first = wrapped((int64_t)x - origin, part->width_px);
        int32_t width = MIN(part->width_px - first, to - x);
        TRY(jali_bitmap_create(ctx, width, part->height_px, &piece));
        cut_out(ctx, part, first, 0, &piece);
        paste(ctx, &piece, x, 0, dst);
        jali_bitmap_free(ctx, &piece);
        x += width;
    }
done:
    jali_bitmap_free(ctx, &piece);
    return status;
}

// A strip with its chart. Its margins left and right go on as the part does: solid ends would join what the
// circle does not.
typedef struct strip {
    jali_bitmap picture;
    jali_chart chart;
    int32_t first; // column of the part's own first one within
} strip;

static void strip_free(jali_context *ctx, strip *s)
{
    jali_bitmap_free(ctx, &s->picture);
    jali_chart_free(ctx, &s->chart);
    *s = (strip){0};
}

// The metric of a strip. What closes is a surface of revolution: along a row lengths are the same but for its
// facets, so a row takes its mean, and no cut is preferred.
static jali_status level_metric(jali_context *ctx, const jali_chart *chart, jali_chart *level)
{
    jali_status status = JALI_OK;
    if (!chart->metric) goto done;
    level->metric_columns = 1;
    TRY(ALLOCATE(ctx, level->metric, level->metric_rows));
    for (int32_t j = 0; j < level->metric_rows; j++)
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int32_t i = 0; i < chart->metric_columns; i++)
                sum += chart->metric[(size_t)j * (size_t)chart->metric_columns + (size_t)i][k];
            level->metric[j][k] = k == 1 ? 0 : (float)(sum / chart->metric_columns);
        }
done:
    return status;
}

// The part with `halo` columns more on both sides, begun at its column `shift`.
static jali_status strip_create(jali_context *ctx, const jali_bitmap *part, const jali_chart *chart,
                                int32_t shift, int32_t halo, strip *s)
{
    jali_status status;
    int32_t margin = chart->margin_px;
    *s = (strip){.chart = *chart, .first = margin + halo - shift};
    s->chart.metric = NULL;
    s->chart.width_px = part->width_px + 2 * halo + 2 * margin;
    TRY(level_metric(ctx, chart, &s->chart));
    TRY(jali_bitmap_create(ctx, s->chart.width_px, chart->height_px, &s->picture));
    TRY(lay_parts(ctx, part, s->first, 0, s->chart.width_px, &s->picture));
done:
    if (status != JALI_OK) strip_free(ctx, s);
    return status;
}

// The middle of a strip, with the part's first column first.
static jali_status take_part(jali_context *ctx, const strip *s, const jali_bitmap *mask, int32_t shift,
                             int32_t halo, jali_bitmap *part)
{
    jali_status status;
    jali_bitmap middle = {0};
    int32_t period = part->width_px;
    TRY(jali_bitmap_create(ctx, period, part->height_px, &middle));
    cut_out(ctx, mask, s->chart.margin_px + halo, 0, &middle);
    TRY(lay_parts(ctx, &middle, wrapped(shift, period), 0, period, part));
done:
    jali_bitmap_free(ctx, &middle);
    return status;
}

// Pixels in which a strip differs from the part repeated, ends aside.
static jali_status count_misfit(jali_context *ctx, const strip *s, const jali_bitmap *part, int32_t halo,
                                int64_t *misfit)
{
    jali_status status;
    jali_bitmap same = {0};
    int32_t ends = s->chart.margin_px + halo / 2;
    TRY(jali_bitmap_copy(ctx, &s->picture, &same));
    TRY(lay_parts(ctx, part, s->first, ends, s->chart.width_px - ends, &same));
    *misfit = count_combined(ctx, RULE_XOR, &s->picture, &same);
done:
    jali_bitmap_free(ctx, &same);
    return status;
}

// --- Optimising

// What a mending made solid anywhere on the strip, in the part as well: a bridge that it laid near an end.
static jali_status fold_added(jali_context *ctx, const strip *s, const jali_bitmap *before, jali_bitmap *part)
{
    jali_status status;
    jali_bitmap added = {0}, piece = {0}, all = {0};
    int32_t period = part->width_px, end = s->chart.width_px - s->chart.margin_px;
    TRY(jali_bitmap_copy(ctx, &s->picture, &added));
    combine(ctx, RULE_AND_NOT, &added, before, &added);
    for (int32_t x = s->chart.margin_px; x < end;) {
        int32_t first = wrapped((int64_t)x - s->first, period), width = MIN(period - first, end - x);
        TRY(jali_bitmap_create(ctx, width, part->height_px, &piece));
        TRY(jali_bitmap_create(ctx, period, part->height_px, &all));
        cut_out(ctx, &added, x, 0, &piece);
        paste(ctx, &piece, first, 0, &all);
        combine(ctx, RULE_OR, part, &all, part);
        jali_bitmap_free(ctx, &piece);
        jali_bitmap_free(ctx, &all);
        x += width;
    }
done:
    jali_bitmap_free(ctx, &added);
    jali_bitmap_free(ctx, &piece);
    jali_bitmap_free(ctx, &all);
    return status;
}

// Pieces of a part repeated around: those of the part, joined where both its ends are solid.
static jali_status count_pieces(jali_context *ctx, const jali_bitmap *part, int32_t *pieces)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    components c = {0};
    int32_t *set, last = part->width_px - 1;
    TRY(label_components(ctx, part, true, 4, &c));
    TRY(ARENA(ctx, set, c.count + 1));
    for (int32_t i = 0; i < c.count; i++) set[i] = i;
    for (int32_t y = 0; y < part->height_px; y++)
        if (jali_bitmap_get(part, 0, y) && jali_bitmap_get(part, last, y))
            unite(set, c.label[run_at(&c, 0, y)], c.label[run_at(&c, last, y)]);
    *pieces = 0;
    for (int32_t i = 0; i < c.count; i++) *pieces += set[i] == i;
done:
    components_free(ctx, &c);
    arena_rewind(ctx, mark);
    return status;
}

// Mend with the cut at one place after the other.
static jali_status settle(jali_context *ctx, const jali_chart *chart, const jali_optimise_options *opt,
                          int32_t halo, jali_bitmap *part, jali_round *residual, int32_t *pieces)
{
    jali_status status = JALI_OK;
    strip s = {0};
    jali_bitmap before = {0}, unmended = {0};
    int32_t quiet = 0;
    for (int32_t round = 0; quiet < 2; round++) {
        int32_t shift = (int32_t)((int64_t)part->width_px * (round % 2 ? 3 : 2) / 4);
        int64_t misfit;
        if (round == MENDINGS)
            TRY(fail(
                ctx, JALI_NO_RESULT,
                "the picture does not come to rest where its ends meet; another size or pixel would help"));
        TRY(jali_bitmap_copy(ctx, part, &before));
        TRY(strip_create(ctx, part, chart, shift, halo, &s));
        TRY(jali_bitmap_copy(ctx, &s.picture, &unmended));
        TRY(jali_optimise_mend(ctx, &s.chart, opt, &s.picture, residual));
        TRY(take_part(ctx, &s, &s.picture, shift, halo, part));
        TRY(count_pieces(ctx, part, pieces));
        if (*pieces > 1) TRY(fold_added(ctx, &s, &unmended, part));
        jali_bitmap_free(ctx, &unmended);
        TRY(count_misfit(ctx, &s, part, halo, &misfit));
        bool still = misfit == 0 && count_combined(ctx, RULE_XOR, part, &before) == 0;
        quiet = still ? quiet + 1 : 0;
        jali_bitmap_free(ctx, &before);
        strip_free(ctx, &s);
    }
done:
    jali_bitmap_free(ctx, &before);
    jali_bitmap_free(ctx, &unmended);
    strip_free(ctx, &s);
    return status;
}

// An overlay of the strip, as one of the grid.
static jali_status lay_overlay(jali_context *ctx, const strip *s, const jali_chart *chart, int32_t halo,
                               int32_t period, jali_bitmap *overlay)
{
    jali_status status = JALI_OK;
    jali_bitmap part = {0};
    if (overlay->width_px == 0) goto done;
    TRY(jali_bitmap_create(ctx, period, overlay->height_px, &part));
    TRY(take_part(ctx, s, overlay, 0, halo, &part));
    jali_bitmap_free(ctx, overlay);
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, overlay));
    TRY(lay_parts(ctx, &part, chart->margin_px, 0, chart->width_px, overlay));
done:
    jali_bitmap_free(ctx, &part);
    return status;
}

static jali_status lay_overlays(jali_context *ctx, const strip *s, const jali_chart *chart, int32_t halo,
                                int32_t period, jali_optimised *r)
{
    jali_status status;
    TRY(lay_overlay(ctx, s, chart, halo, period, &r->conflict));
    TRY(lay_overlay(ctx, s, chart, halo, period, &r->bridge_mask));
    for (int32_t t = 0; t < JALI_TYPES; t++) {
        TRY(lay_overlay(ctx, s, chart, halo, period, &r->white.type[t]));
        TRY(lay_overlay(ctx, s, chart, halo, period, &r->black.type[t]));
    }
done:
    return status;
}

jali_status jali_optimise_around(jali_context *ctx, const jali_bitmap *drawing, const jali_chart *chart,
                                 int32_t parts, const jali_optimise_options *given, jali_optimised *result,
                                 int32_t *pieces)
{
    jali_status status;
    jali_optimise_options opt = given ? *given : jali_optimise_defaults();
    jali_bitmap part = {0};
    strip s = {0};
    int32_t inner = inner_width(chart);
    *result = (jali_optimised){0};
    if (parts < 1 || inner % parts != 0)
        TRY(fail(ctx, JALI_BAD_VALUE, "%d columns cannot go around in %d equal parts", inner, parts));
    int32_t period = inner / parts, halo = parts > 1 ? period : (period + 1) / 2;
    TRY(jali_bitmap_create(ctx, period, drawing->height_px, &part));
    cut_out(ctx, drawing, chart->margin_px + parts / 2 * period, 0, &part);
    TRY(strip_create(ctx, &part, chart, 0, halo, &s));
    TRY(jali_optimise(ctx, &s.picture, &s.chart, &opt, result));
    TRY(take_part(ctx, &s, &result->mask, 0, halo, &part));
    TRY(lay_overlays(ctx, &s, chart, halo, period, result));
    TRY(settle(ctx, chart, &opt, halo, &part, &result->residual, pieces));
    jali_bitmap_free(ctx, &result->mask);
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, &result->mask));
    TRY(lay_parts(ctx, &part, chart->margin_px, 0, chart->width_px, &result->mask));
done:
    jali_bitmap_free(ctx, &part);
    strip_free(ctx, &s);
    if (status != JALI_OK) jali_optimised_free(ctx, result);
    return status;
}

// --- Contours

typedef struct cutting {
    jali_contours *out;
    size_t point_capacity, contour_capacity;
    int32_t (*here)[2], (*next)[2]; // a polygon being cut
} cutting;

// Where an edge crosses an upright line; the same for both directions and both sides.
static int32_t height_at(const int32_t a[2], const int32_t b[2], int32_t x)
{
    const int32_t *left = a[0] < b[0] ? a : b, *right = a[0] < b[0] ? b : a;
    double share = ((double)x - left[0]) / ((double)right[0] - left[0]);
    return (int32_t)lrint(left[1] + share * ((double)right[1] - left[1]));
}

// Sutherland and Hodgman, at an upright line.
static int32_t keep_side(const int32_t (*from)[2], int32_t count, int32_t x, bool right, int32_t (*to)[2])
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        const int32_t *a = from[i], *b = from[(i + 1) % count];
        bool a_in = right ? a[0] >= x : a[0] <= x, b_in = right ? b[0] >= x : b[0] <= x;
        if (a_in) memcpy(to[kept++], a, sizeof *to);
        if (a_in == b_in || a[0] == x || b[0] == x) continue;
        to[kept][0] = x;
        to[kept++][1] = height_at(a, b, x);
    }
    return kept;
}

static jali_status add_contour(jali_context *ctx, cutting *c, const int32_t (*point)[2], int32_t count,
                               int32_t back)
{
    jali_status status;
    jali_contours *out = c->out;
    if ((int64_t)out->point_count + count > INT32_MAX / 2)
        return fail(ctx, JALI_LIMIT, "the contours have too many points");
    TRY(GROW(ctx, out->point, c->point_capacity, (size_t)out->point_count + (size_t)count + 1));
    TRY(GROW(ctx, out->first, c->contour_capacity, (size_t)out->contour_count + 2));
    int32_t begin = out->point_count;
    for (int32_t i = 0; i < count; i++) {
        int32_t *at = out->point[out->point_count];
        at[0] = point[i][0] - back;
        at[1] = point[i][1];
        bool again =
            out->point_count > begin && memcmp(at, out->point[out->point_count - 1], sizeof *out->point) == 0;
        out->point_count += !again;
    }
    if (out->point_count - begin > 2)
        out->first[++out->contour_count] = out->point_count;
    else
        out->point_count = begin;
done:
    return status;
}

// One contour of the long strip, in the turns it reaches into.
static jali_status cut_contour(jali_context *ctx, cutting *c, const int32_t (*point)[2], int32_t count,
                               int32_t edge, int32_t period, int32_t low, int32_t high)
{
    jali_status status = JALI_OK;
    for (int32_t turn = 0; edge + (int64_t)turn * period < high; turn++) {
        int32_t left = edge + turn * period, right = left + period;
        if (right <= low) continue;
        int32_t kept = keep_side(point, count, left, true, c->here);
        kept = keep_side((const int32_t(*)[2])c->here, kept, right, false, c->next);
        if (kept > 2) TRY(add_contour(ctx, c, (const int32_t(*)[2])c->next, kept, turn * period));
    }
done:
    return status;
}

// All contours whose leftmost pixel lies in the second turn of a strip of several; false when one of them
// reaches the strip's end.
static jali_status cut_contours(jali_context *ctx, const jali_contours *all, const jali_chart *chart,
                                int32_t turns, cutting *c, bool *whole)
{
    jali_status status = JALI_OK;
    int32_t period = inner_width(chart), units = chart->pixel_units, edge = chart->margin_px * units;
    *whole = true;
    for (int32_t i = 0; i < all->contour_count; i++) {
        const int32_t(*point)[2] = (const int32_t(*)[2])all->point + all->first[i];
        int32_t count = all->first[i + 1] - all->first[i], low = INT32_MAX, high = INT32_MIN;
        for (int32_t k = 0; k < count; k++) {
            low = MIN(low, point[k][0]);
            high = MAX(high, point[k][0]);
        }
        int32_t column = (int32_t)lrint((double)low / units) - chart->margin_px;
        if (column < period || column >= 2 * period) continue;
        if (high >= edge + (turns * period - 1) * units) {
            *whole = false;
            return JALI_OK;
        }
        TRY(cut_contour(ctx, c, point, count, edge, period * units, low, high));
    }
done:
    return status;
}

static jali_status trace_turns(jali_context *ctx, const jali_bitmap *mask, const jali_chart *chart,
                               const jali_trace_options *opt, int32_t turns, jali_contours *contours,
                               bool *whole)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    jali_bitmap part = {0}, longer = {0};
    jali_contours all = {0};
    jali_chart long_chart = *chart;
    int32_t period = inner_width(chart), margin = chart->margin_px;
    cutting c = {.out = contours};
    *contours = (jali_contours){.unit_mm = chart->unit_mm};
    long_chart.width_px = turns * period + 2 * margin;
    TRY(jali_bitmap_create(ctx, period, mask->height_px, &part));
    cut_out(ctx, mask, margin, 0, &part);
    TRY(jali_bitmap_create(ctx, long_chart.width_px, mask->height_px, &longer));
    fill(ctx, &longer, true);
    TRY(lay_parts(ctx, &part, margin, margin, margin + turns * period, &longer));
    TRY(jali_trace(ctx, &longer, &long_chart, opt, &all));
    TRY(GROW(ctx, contours->first, c.contour_capacity, 1));
    contours->first[0] = 0;
    TRY(ARENA(ctx, c.here, 2 * (size_t)all.point_count + 4));
    TRY(ARENA(ctx, c.next, 2 * (size_t)all.point_count + 4));
    TRY(cut_contours(ctx, &all, chart, turns, &c, whole));
done:
    if (status != JALI_OK) jali_contours_free(ctx, contours);
    jali_contours_free(ctx, &all);
    jali_bitmap_free(ctx, &part);
    jali_bitmap_free(ctx, &longer);
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_trace_around(jali_context *ctx, const jali_bitmap *mask, const jali_chart *chart,
                              const jali_trace_options *opt, jali_contours *contours)
{
    bool whole = false;
    for (int32_t turns = 3; turns <= MOST_TURNS + 1; turns++) {
        jali_status status = trace_turns(ctx, mask, chart, opt, turns, contours, &whole);
        if (status != JALI_OK || whole) return status;
        jali_contours_free(ctx, contours);
    }
    return fail(ctx, JALI_NO_RESULT,
                "a void goes right around the surface, or winds around it more than %d times",
                MOST_TURNS - 1);
}
