// trace: from pixels to smooth contours that cannot touch.
//
// How: follow the cracks (follow.c); fit a polygon with few edges to each path (polygon.c); bend a smooth
// curve over it, note where it crosses each crack, and where a pixel centre holds it back ease it in
// (cross.c); keep few of these crossings (simplify.c). Only the last two steps' integers decide; the fit may
// be as bold as it likes, it can cost beauty but no promise.
//
// Why no two contours touch. Join the centres of 4-neighbours: they form square cells with a pixel centre at
// each corner. A contour crosses a side of a cell exactly where the side joins a solid centre to a void one,
// once, strictly between the two: each crack has its crossing, and a chord that skips crossings passes each
// of the skipped sides strictly between its centres too, because it has the solid centre strictly on its left
// and the void one strictly on its right. (A line that does so for two sides of one convex cell crosses the
// cell from the one to the other, so the chord meets the sides in the order of the cracks.) What happens
// inside a cell is then all there is to see:
//   - two sides crossed: one contour passes, by a straight piece or by two pieces through a corner point
//   inside
//     the cell. It touches neither itself nor a centre.
//   - four sides crossed (solid and void like a chequer): the cracks pair them so that each piece cuts off
//   one
//     solid centre; corner points are not allowed there. Let the cell be [0,1]^2 with solids at (0,0) and
//     (1,1): one piece runs from (0,a) to (b,0) with a, b < 1 and lies in x + y < 1, the other in x + y > 1.
// Sides are crossed once, cells share only sides, so the contours are disjoint simple polygons. Along each
// side the colour changes where it did in the bitmap, so every centre keeps its side, and every piece lies in
// the hull of the crossings of its cell, or ends at a corner point less than half a pixel from the turn: less
// than half a pixel from the cracks.
//
// Checked: tests/test_trace.c: all 4 x 4 bitmaps, random ones, exactly, with a sweep for contacts.
#include <jali/trace.h>

#include "trace/path.h"

#include <math.h>

enum { BATCH_CRACKS = 1 << 20, GROUP_CRACKS = 1 << 13 };

// A chord's distance from the curve is known along the cracks, and square to the curve to first order only:
// over 24 runs on real pictures it was up to 13 % more. With this share 23 keep to what was asked for and one
// passes it by 0.0002 mm (bench/contours.c).
static const double CHORD_SHARE = 0.85;

jali_trace_options jali_trace_defaults(void)
{
    return (jali_trace_options){.deviation_mm = 0.01};
}

// What the threads share: paths, their scratch and their points. Paths of a batch have scratch side by side.
typedef struct tracing {
    const crack_paths *paths;
    int32_t unit, slack;
    int32_t begin;         // first path of the batch
    const int32_t *group;  // [groups + 1] first path of each group
    bool *square, *corner; // scratch: a slot a turn and one more a path
    int32_t *from, *vertex;
    double *cost, (*line)[4], (*place)[2];
    crossing *fine; // cracks and corners
    int32_t (*point)[2];
    int64_t *first_fine; // [paths + 1] where a path's fine points begin, from the first path of all
    int32_t *points;     // [paths] points kept
} tracing;

static void trace_path(tracing *t, int32_t path)
{
    int64_t turns = t->paths->first[path], slot = turns - t->paths->first[t->begin] + path - t->begin;
    int64_t fine = t->first_fine[path] - t->first_fine[t->begin];
    outline o = {.turn = t->paths->turn + turns,
                 .n = (int32_t)(t->paths->first[path + 1] - turns),
                 .square = t->square + slot,
                 .cost = t->cost + slot,
                 .from = t->from + slot,
                 .vertex = t->vertex + slot,
                 .line = t->line + slot,
                 .place = t->place + slot,
                 .corner = t->corner + slot};
    best_polygon(&o);
    fit_vertices(&o);
    int32_t count = cross_cracks(&o, t->unit, t->slack, t->fine + fine);
    t->points[path] = simplify(t->fine + fine, count, t->point + fine);
}

static void trace_group(void *shared, int32_t index)
{
    tracing *t = shared;
    for (int32_t path = t->group[index]; path < t->group[index + 1]; path++) trace_path(t, path);
}

static jali_status take_scratch(jali_context *ctx, tracing *t, int64_t slots, int64_t fine)
{
    jali_status status;
    TRY(ARENA(ctx, t->square, slots));
    TRY(ARENA(ctx, t->cost, slots));
    TRY(ARENA(ctx, t->from, slots));
    TRY(ARENA(ctx, t->vertex, slots));
    TRY(ARENA(ctx, t->line, slots));
    TRY(ARENA(ctx, t->place, slots));
    TRY(ARENA(ctx, t->corner, slots));
    TRY(ARENA(ctx, t->fine, fine));
    TRY(ARENA(ctx, t->point, fine));
done:
    return status;
}

static jali_status keep_points(jali_context *ctx, const tracing *t, int32_t end, size_t *capacity,
                               jali_contours *contours)
{
    for (int32_t path = t->begin; path < end; path++) {
        int64_t from = t->first_fine[path] - t->first_fine[t->begin];
        int64_t total = (int64_t)contours->point_count + t->points[path];
        if (total > INT32_MAX) return fail(ctx, JALI_LIMIT, "the contours have more than 2^31 points");
        jali_status status = GROW(ctx, contours->point, *capacity, total);
        if (status != JALI_OK) return status;
        memcpy(contours->point + contours->point_count, t->point + from,
               (size_t)t->points[path] * sizeof *contours->point);
        contours->first[path] = contours->point_count;
        contours->point_count = (int32_t)total;
        contours->first[path + 1] = contours->point_count;
    }
    return JALI_OK;
}

// Paths [t->begin, end) as groups of similar length for the threads.
static jali_status trace_batch(jali_context *ctx, tracing *t, int32_t end, size_t *capacity,
                               jali_contours *contours)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *group, groups = 0;
    const crack_paths *paths = t->paths;
    TRY(ARENA(ctx, group, end - t->begin + 1));
    int64_t cracks = GROUP_CRACKS;
    for (int32_t path = t->begin; path < end; path++) {
        if (cracks >= GROUP_CRACKS) group[groups++] = path, cracks = 0;
        cracks += paths->length_px[path];
    }
    group[groups] = end;
    t->group = group;
    TRY(take_scratch(ctx, t, paths->first[end] - paths->first[t->begin] + end - t->begin,
                     t->first_fine[end] - t->first_fine[t->begin]));
    parallel(ctx, groups, trace_group, t);
    TRY(keep_points(ctx, t, end, capacity, contours));
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status check(jali_context *ctx, const jali_bitmap *solid, const jali_chart *chart,
                         const jali_trace_options *opt)
{
    if (solid->width_px != chart->width_px || solid->height_px != chart->height_px)
        return fail(ctx, JALI_BAD_VALUE, "the bitmap is %d x %d px, its chart %d x %d", solid->width_px,
                    solid->height_px, chart->width_px, chart->height_px);
    if (chart->pixel_units < 16 || chart->pixel_units % 2 != 0 || !(chart->unit_mm > 0))
        return fail(ctx, JALI_BAD_VALUE, "a pixel of %d units of %g mm: even and at least 16 are accepted",
                    chart->pixel_units, chart->unit_mm);
    if ((int64_t)MAX(solid->width_px, solid->height_px) * chart->pixel_units > 1 << 24)
        return fail(ctx, JALI_LIMIT, "%d x %d px of %d units pass the lattice's 2^24 units a side",
                    solid->width_px, solid->height_px, chart->pixel_units);
    if (!(opt->deviation_mm > 0))
        return fail(ctx, JALI_BAD_VALUE, "a deviation of %g mm: more than 0 is accepted", opt->deviation_mm);
    return JALI_OK;
}

jali_status jali_trace(jali_context *ctx, const jali_bitmap *solid, const jali_chart *chart,
                       const jali_trace_options *given, jali_contours *contours)
{
    jali_status status;
    jali_trace_options opt = given ? *given : jali_trace_defaults();
    arena_mark mark = arena_here(ctx);
    crack_paths paths = {0};
    size_t capacity = 0;
    *contours = (jali_contours){.unit_mm = chart->unit_mm};
    TRY(check(ctx, solid, chart, &opt));
    TRY(follow_cracks(ctx, solid, chart->outside_solid, &paths));
    tracing t = {.paths = &paths, .unit = chart->pixel_units};
    t.slack = (int32_t)MIN(MAX(CHORD_SHARE * opt.deviation_mm / chart->unit_mm, 1), chart->pixel_units);
    TRY(ALLOCATE_CLEARED(ctx, contours->first, paths.path_count + 1));
    contours->contour_count = paths.path_count;
    TRY(ARENA(ctx, t.points, paths.path_count));
    TRY(ARENA(ctx, t.first_fine, paths.path_count + 1));
    t.first_fine[0] = 0;
    for (int32_t i = 0; i < paths.path_count; i++) // at most one corner a turn
        t.first_fine[i + 1] = t.first_fine[i] + paths.length_px[i] + paths.first[i + 1] - paths.first[i];
    for (int32_t end; t.begin < paths.path_count; t.begin = end) {
        TRY(step(ctx, "trace", 0.3 + 0.7 * t.begin / paths.path_count));
        for (end = t.begin + 1; end < paths.path_count; end++)
            if (t.first_fine[end + 1] - t.first_fine[t.begin] > BATCH_CRACKS) break;
        TRY(trace_batch(ctx, &t, end, &capacity, contours));
    }
done:
    crack_paths_free(ctx, &paths);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) jali_contours_free(ctx, contours);
    return status;
}
