// carve: contours, outline and hole -> triangulation -> cells -> closed solid.
//
// A plate's cells are full or empty; the cells and the mesh builder take any height interval (prisms.h).
// Checked: tests/test_carve.c.
#include <jali/carve.h>

#include "carve/plate.h"
#include "carve/prisms.h"

#include <math.h>

jali_carve_options jali_carve_defaults(void)
{
    return (jali_carve_options){.thickness_mm = 4, .hole_web_mm = 2};
}

static jali_status join_contours(jali_context *ctx, const jali_contours *a, const jali_contours *b,
                                 jali_contours *both)
{
    jali_status status;
    *both = (jali_contours){.unit_mm = a->unit_mm};
    if ((int64_t)a->point_count + b->point_count > INT32_MAX ||
        (int64_t)a->contour_count + b->contour_count >= INT32_MAX)
        return fail(ctx, JALI_LIMIT, "the contours have more than 2^31 points");
    TRY(ALLOCATE_CLEARED(ctx, both->first, (size_t)a->contour_count + (size_t)b->contour_count + 1));
    TRY(ALLOCATE(ctx, both->point, (size_t)a->point_count + (size_t)b->point_count));
    const jali_contours *part[2] = {a, b};
    for (int k = 0; k < 2; k++) {
        for (int32_t i = 0; i < part[k]->contour_count; i++)
            both->first[both->contour_count++ + 1] = both->point_count + part[k]->first[i + 1];
        if (part[k]->point_count > 0)
            memcpy(both->point + both->point_count, part[k]->point,
                   (size_t)part[k]->point_count * sizeof *both->point);
        both->point_count += part[k]->point_count;
    }
done:
    if (status != JALI_OK) jali_contours_free(ctx, both);
    return status;
}

jali_status jali_plate(jali_context *ctx, const jali_contours *picture, const jali_chart *chart,
                       const jali_carve_options *given, jali_contours *result)
{
    jali_status status;
    jali_carve_options opt = given ? *given : jali_carve_defaults();
    jali_contours drawn = {.unit_mm = chart->unit_mm};
    plate p;
    *result = (jali_contours){0};
    TRY(lay_out_plate(ctx, chart, &opt, &p));
    if (chart->outside_solid) TRY(draw_plate(ctx, &p, chart->unit_mm, &drawn));
    TRY(join_contours(ctx, &drawn, picture, result));
done:
    jali_contours_free(ctx, &drawn);
    return status;
}

// The point after each point, around its contour.
static void link_points(const jali_contours *contours, int32_t (*edge)[2])
{
    for (int32_t c = 0; c < contours->contour_count; c++)
        for (int32_t first = contours->first[c], end = contours->first[c + 1], i = first; i < end; i++)
            edge[i][0] = i, edge[i][1] = i + 1 < end ? i + 1 : first;
}

static jali_status report_touch(jali_context *ctx, const jali_contours *contours, int32_t p)
{
    return fail(
        ctx, JALI_BAD_INPUT,
        "contours touch or cross near (%.3f, %.3f) mm: the outline must keep clear of the picture's voids",
        contours->point[p][0] * contours->unit_mm, contours->point[p][1] * contours->unit_mm);
}

static jali_status triangulate(jali_context *ctx, const jali_contours *contours, const int32_t (*edge)[2],
                               triangulation *plane)
{
    jali_status status;
    contact met;
    TRY(insert_points(ctx, plane, (const int32_t(*)[2])contours->point, contours->point_count));
    for (int32_t p = 0; p < plane->point_count; p++)
        if (plane->twin[p] != p) TRY(report_touch(ctx, contours, p));
    if (plane->triangle_count == 0) return fail(ctx, JALI_BAD_INPUT, "there is nothing solid to carve");
    TRY(insert_edges(ctx, plane, edge, contours->point_count, EDGE_CONTOUR, false, &met));
    if (met.found != NO_CONTACT) TRY(report_touch(ctx, contours, met.from));
done:
    return status;
}

// Every contour edge has its solid on the left.
static jali_status check_sides(jali_context *ctx, const triangulation *plane, const int32_t (*edge)[2],
                               const uint8_t *tone, double unit_mm)
{
    for (int32_t s = 0; s < 4 * plane->triangle_count; s++) {
        if ((s & 3) == 3 || plane->kind[s] == 0 || !tone[s >> 2]) continue;
        int32_t from = plane->corner[next_side(s)], to = plane->corner[last_side(s)];
        if (edge[from][1] != to)
            return fail(ctx, JALI_BAD_INPUT, "the contour at (%.3f, %.3f) mm has its solid on the wrong side",
                        plane->point[from][0] * unit_mm, plane->point[from][1] * unit_mm);
    }
    return JALI_OK;
}

// Full where the plane is solid, empty elsewhere.
static jali_status fill_cells(jali_context *ctx, const triangulation *plane, const int32_t (*edge)[2],
                              int32_t thickness, double unit_mm, interval *solid)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    uint8_t *tone;
    TRY(ARENA(ctx, tone, plane->triangle_count));
    TRY(label_tones(ctx, plane, EDGE_CONTOUR, tone));
    TRY(check_sides(ctx, plane, edge, tone, unit_mm));
    for (int32_t t = 0; t < plane->triangle_count; t++) solid[t] = (interval){0, tone[t] ? thickness : 0};
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_carve(jali_context *ctx, const jali_contours *picture, const jali_chart *chart,
                       const jali_carve_options *given, jali_mesh *mesh)
{
    jali_status status;
    jali_carve_options opt = given ? *given : jali_carve_defaults();
    arena_mark mark = arena_here(ctx);
    jali_contours all = {0};
    triangulation plane = {0};
    int32_t(*edge)[2];
    interval *solid;
    *mesh = (jali_mesh){0};
    TRY(step(ctx, "carve", 0));
    TRY(jali_plate(ctx, picture, chart, &opt, &all));
    TRY(ARENA(ctx, edge, all.point_count));
    link_points(&all, edge);
    TRY(triangulate(ctx, &all, (const int32_t(*)[2])edge, &plane));
    TRY(ARENA(ctx, solid, plane.triangle_count));
    TRY(step(ctx, "carve", 0.6));
    int32_t thickness = (int32_t)lround(opt.thickness_mm / chart->unit_mm);
    TRY(fill_cells(ctx, &plane, (const int32_t(*)[2])edge, thickness, chart->unit_mm, solid));
    TRY(build_plate(ctx, &plane, solid, chart->unit_mm, mesh));
    TRY(step(ctx, "carve", 1));
done:
    triangulation_free(ctx, &plane);
    jali_contours_free(ctx, &all);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    return status;
}
