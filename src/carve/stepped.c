// A plate with low regions: two sets of contours in one arrangement.
//
// The picture's contours keep clear of each other, and so do those of the regions; between the two sets snap
// rounding makes pieces that meet only in lattice points (plane/snap.h). The tone of each set changes at its
// own pieces alone.
//
// Checked: tests/test_lower.c.
#include <jali/carve.h>

#include "carve/prisms.h"
#include "plane/snap.h"

#include <math.h>

enum { EDGE_LOW = EDGE_WINDOW };

typedef struct arrangement {
    snapped s;
    triangulation plane;
    int32_t low_count; // edges of the regions come first
} arrangement;

static void add_edges(const jali_contours *c, int32_t first, int32_t (*edge)[2], int32_t *count)
{
    for (int32_t k = 0; k < c->contour_count; k++)
        for (int32_t begin = c->first[k], end = c->first[k + 1], i = begin; i < end; i++, (*count)++) {
            edge[*count][0] = first + i;
            edge[*count][1] = first + (i + 1 < end ? i + 1 : begin);
        }
}

static jali_status arrange(jali_context *ctx, const jali_contours *low, const jali_contours *plate,
                           arrangement *a)
{
    jali_status status;
    int32_t(*point)[2], (*edge)[2], crossed[2], edges = 0;
    size_t points = (size_t)low->point_count + (size_t)plate->point_count;
    if (points > INT32_MAX / 4)
        return fail(ctx, JALI_LIMIT, "the contours have too many points: %zu", points);
    TRY(ARENA(ctx, point, points + 1));
    TRY(ARENA(ctx, edge, points + 1));
    if (low->point_count > 0) memcpy(point, low->point, (size_t)low->point_count * sizeof *point);
    if (plate->point_count > 0)
        memcpy(point + low->point_count, plate->point, (size_t)plate->point_count * sizeof *point);
    add_edges(low, 0, edge, &edges);
    a->low_count = edges;
    add_edges(plate, low->point_count, edge, &edges);
    TRY(snap_round(ctx, (const int32_t(*)[2])point, (int32_t)points, (const int32_t(*)[2])edge, edges,
                   a->low_count, &a->s, crossed));
done:
    return status;
}

static jali_status insert_set(jali_context *ctx, arrangement *a, int32_t from, int32_t to, uint8_t kind)
{
    jali_status status;
    contact met;
    int32_t(*odd)[2], count;
    TRY(ARENA(ctx, odd, to - from + 1));
    TRY(odd_pieces(ctx, (const int32_t(*)[2])a->s.piece + from, to - from, odd, &count));
    TRY(insert_edges(ctx, &a->plane, (const int32_t(*)[2])odd, count, kind, false, &met));
    if (met.found != NO_CONTACT) TRY(fail(ctx, JALI_BROKEN, "contours still cross after snap rounding"));
done:
    return status;
}

static jali_status triangulate(jali_context *ctx, arrangement *a)
{
    jali_status status;
    int32_t split = 0;
    while (split < a->s.piece_count && a->s.edge[split] < a->low_count) split++;
    TRY(insert_points(ctx, &a->plane, (const int32_t(*)[2])a->s.point, a->s.point_count));
    if (a->plane.triangle_count == 0) TRY(fail(ctx, JALI_BAD_INPUT, "there is nothing solid to carve"));
    TRY(insert_set(ctx, a, 0, split, EDGE_LOW));
    TRY(insert_set(ctx, a, split, a->s.piece_count, EDGE_CONTOUR));
done:
    return status;
}

jali_status jali_carve_stepped(jali_context *ctx, const jali_contours *picture, const jali_contours *low,
                               double low_mm, const jali_chart *chart, const jali_carve_options *given,
                               jali_mesh *mesh)
{
    jali_status status;
    jali_carve_options opt = given ? *given : jali_carve_defaults();
    arena_mark mark = arena_here(ctx);
    jali_contours plate = {0};
    arrangement a = {0};
    interval *solid;
    uint8_t *tone, *is_low;
    *mesh = (jali_mesh){0};
    TRY(step(ctx, "carve", 0));
    if (!(low_mm > 0) || !(low_mm < opt.thickness_mm))
        TRY(fail(ctx, JALI_BAD_VALUE,
                 "low parts of %g mm: more than 0 and less than the thickness, %g mm, is accepted", low_mm,
                 opt.thickness_mm));
    TRY(jali_plate(ctx, picture, chart, &opt, &plate));
    TRY(arrange(ctx, low, &plate, &a));
    TRY(triangulate(ctx, &a));
    TRY(step(ctx, "carve", 0.6));
    TRY(ARENA(ctx, solid, a.plane.triangle_count));
    TRY(ARENA(ctx, tone, a.plane.triangle_count));
    TRY(ARENA(ctx, is_low, a.plane.triangle_count));
    TRY(label_tones(ctx, &a.plane, EDGE_CONTOUR, tone));
    TRY(label_tones(ctx, &a.plane, EDGE_LOW, is_low));
    int32_t full = (int32_t)lround(opt.thickness_mm / chart->unit_mm),
            part = (int32_t)lround(low_mm / chart->unit_mm);
    for (int32_t t = 0; t < a.plane.triangle_count; t++)
        solid[t] = (interval){0, !tone[t] ? 0 : is_low[t] ? part : full};
    TRY(build_plate(ctx, &a.plane, solid, chart->unit_mm, mesh));
    TRY(step(ctx, "carve", 1));
done:
    triangulation_free(ctx, &a.plane);
    snapped_free(ctx, &a.s);
    jali_contours_free(ctx, &plate);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    return status;
}
