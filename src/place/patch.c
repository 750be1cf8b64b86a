// Grow the patch of faces under a picture, and measure what it covers.
//
// Checked: tests/test_place_on.c.
#include "place/patch.h"

#include "plane/exact.h"

#include <math.h>

static const double MOST_STRETCH = 4; // a face more tilted to the view than that is turned away

// Points of the patch by vertex and place: a vertex on a seam has two.
typedef struct point_table {
    int32_t *slot; // [slots] point + 1, 0 = free
    size_t slots;
} point_table;

static int32_t find_point(point_table *table, jali_patch *patch, int32_t vertex, const int32_t at[2])
{
    uint64_t hash = ((uint64_t)(uint32_t)vertex << 32 ^ (uint64_t)(uint32_t)at[0] << 16 ^ (uint32_t)at[1]) *
                    UINT64_C(0x9e3779b97f4a7c15);
    size_t slot = (hash ^ hash >> 31) & (table->slots - 1);
    for (; table->slot[slot]; slot = (slot + 1) & (table->slots - 1)) {
        int32_t p = table->slot[slot] - 1;
        if (patch->vertex[p] == vertex && memcmp(patch->point[p], at, sizeof *patch->point) == 0) return p;
    }
    int32_t p = patch->point_count++;
    table->slot[slot] = p + 1;
    patch->vertex[p] = vertex;
    memcpy(patch->point[p], at, sizeof *patch->point);
    return p;
}

static bool is_steep(const laid *l, int32_t face)
{
    double g[3];
    if (!face_metric(l, face, g)) return true;
    return (g[0] + g[2]) / 2 + hypot((g[0] - g[2]) / 2, g[1]) > MOST_STRETCH * MOST_STRETCH;
}

// A face's corners on the lattice; false when it does not lie counter-clockwise there or stays `around_grid`
// units away from the grid.
static bool corners_on_lattice(const laid *l, const jali_chart *chart, int32_t face, int32_t turns,
                               double around_grid, int32_t at[3][2], bool *beyond)
{
    double per_mm = 1 / chart->unit_mm, half = chart->pixel_units / 2.0;
    double size[2] = {(double)chart->width_px * chart->pixel_units,
                      (double)chart->height_px * chart->pixel_units};
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, exact[3][2];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) {
            double mm = l->at[face][k][i] + (i == 0 ? turns * l->around_mm : 0);
            if (!isfinite(mm)) return false;
            exact[k][i] = mm * per_mm + (i ? chart->height_px : chart->width_px) * half;
            low[i] = MIN(low[i], exact[k][i]);
            high[i] = MAX(high[i], exact[k][i]);
        }
    // Of a surface that closes, the half turn on each side of the picture's middle.
    double middle = (exact[0][0] + exact[1][0] + exact[2][0]) / 3 - size[0] / 2;
    if (l->around_mm > 0 && fabs(middle) > l->around_mm * per_mm / 2) return false;
    if (MIN(high[0], high[1]) < -around_grid || low[0] > size[0] + around_grid ||
        low[1] > size[1] + around_grid)
        return false;
    *beyond = MIN(low[0], low[1]) < -COORDINATE_LIMIT || MAX(high[0], high[1]) > COORDINATE_LIMIT;
    if (*beyond) return false;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) at[k][i] = (int32_t)floor(exact[k][i] + 0.5);
    return orientation(at[0], at[1], at[2]) > 0 && !(l->depth && is_steep(l, face));
}

// Across a side, the neighbour's places may have made turns around the surface: how many, by the side's own
// ends; NaN when the two sides do not fit (a cut of the unrolled surface).
static double turns_across(const laid *l, const sides *linked, int32_t s, int32_t turns)
{
    int32_t o = linked->beside[s];
    double mine = l->at[s >> 2][((s & 3) + 1) % 3][0], other = l->at[o >> 2][((o & 3) + 2) % 3][0];
    double mine_y = l->at[s >> 2][((s & 3) + 1) % 3][1], other_y = l->at[o >> 2][((o & 3) + 2) % 3][1];
    double apart = mine - other, tolerance = 1e-6 * (1 + fabs(mine));
    if (fabs(mine_y - other_y) > 1e-6 * (1 + fabs(mine_y))) return NAN;
    if (fabs(apart) <= tolerance) return turns;
    if (l->around_mm > 0 && fabs(fabs(apart) - l->around_mm) <= 1e-6 * l->around_mm)
        return turns + (apart > 0 ? 1 : -1);
    return NAN;
}

static void take_face(const laid *l, growth *g, point_table *table, int32_t face, int32_t turns,
                      const int32_t at[3][2])
{
    int32_t into = g->patch.face_count++;
    g->taken[face] = 1;
    g->turns[face] = turns;
    g->patch.face[into] = face;
    for (int k = 0; k < 3; k++) {
        int32_t vertex = l->surface->mesh.triangle[face][k], p = find_point(table, &g->patch, vertex, at[k]);
        g->patch.corner[into][k] = p;
        if (g->patch.weight) g->patch.weight[p] = 1 / l->depth[vertex];
    }
}

static jali_status spread(jali_context *ctx, const laid *l, const jali_chart *chart, double around_grid,
                          const sides *linked, growth *g, point_table *table)
{
    for (int32_t next = 0; next < g->patch.face_count; next++) {
        int32_t face = g->patch.face[next];
        for (int k = 0; k < 3; k++) {
            int32_t o = linked->beside[4 * face + k], at[3][2];
            bool beyond = false;
            if (o == NO_SIDE || g->taken[o >> 2]) continue;
            double turns = turns_across(l, linked, 4 * face + k, g->turns[face]);
            if (isnan(turns)) continue;
            if (corners_on_lattice(l, chart, o >> 2, (int32_t)turns, around_grid, at, &beyond))
                take_face(l, g, table, o >> 2, (int32_t)turns, (const int32_t(*)[2])at);
            if (beyond)
                return fail(ctx, JALI_LIMIT,
                            "triangle %d of the surface is too large for a pixel of %.3g mm: "
                            "make the pixel coarser (--pixel) or split the triangle",
                            o >> 2, jali_chart_pixel_mm(chart));
        }
    }
    return JALI_OK;
}

jali_status grow_patch(jali_context *ctx, const laid *l, const jali_chart *chart, double around_grid_mm,
                       int32_t first, int32_t turns, growth *g)
{
    jali_status status;
    const jali_mesh *mesh = &l->surface->mesh;
    sides linked = {0};
    point_table table = {.slots = 64};
    double around_grid = around_grid_mm / chart->unit_mm;
    int32_t at[3][2];
    bool beyond;
    *g = (growth){0};
    TRY(sides_create(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                     &linked));
    size_t most = 3 * (size_t)mesh->triangle_count;
    while (table.slots < 2 * most) table.slots *= 2;
    TRY(ARENA(ctx, table.slot, table.slots));
    memset(table.slot, 0, table.slots * sizeof *table.slot);
    TRY(ARENA(ctx, g->taken, mesh->triangle_count + 1));
    TRY(ARENA(ctx, g->turns, mesh->triangle_count + 1));
    memset(g->taken, 0, (size_t)mesh->triangle_count);
    TRY(ALLOCATE(ctx, g->patch.point, most + 1));
    TRY(ALLOCATE(ctx, g->patch.vertex, most + 1));
    if (l->perspective) TRY(ALLOCATE(ctx, g->patch.weight, most + 1));
    TRY(ALLOCATE(ctx, g->patch.face, mesh->triangle_count + 1));
    TRY(ALLOCATE(ctx, g->patch.corner, mesh->triangle_count + 1));
    if (corners_on_lattice(l, chart, first, turns, around_grid, at, &beyond)) {
        take_face(l, g, &table, first, turns, (const int32_t(*)[2])at);
        TRY(spread(ctx, l, chart, around_grid, &linked, g, &table));
    }
done:
    sides_free(ctx, &linked);
    if (status != JALI_OK) jali_patch_free(ctx, &g->patch);
    return status;
}

// --- Coverage

// Cut off what lies beyond one side of the rectangle (Sutherland and Hodgman).
static int clip(const double (*from)[2], int count, int axis, double limit, bool keep_above, double (*to)[2])
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const double *a = from[i], *b = from[(i + 1) % count];
        bool a_in = keep_above ? a[axis] >= limit : a[axis] <= limit;
        bool b_in = keep_above ? b[axis] >= limit : b[axis] <= limit;
        if (a_in) memcpy(to[kept++], a, sizeof *to);
        if (a_in == b_in) continue;
        double share = (limit - a[axis]) / (b[axis] - a[axis]);
        to[kept][axis] = limit;
        to[kept][!axis] = a[!axis] + share * (b[!axis] - a[!axis]);
        kept++;
    }
    return kept;
}

double covered_area(const jali_patch *patch, const double low[2], const double high[2])
{
    double twice = 0;
    for (int32_t f = 0; f < patch->face_count; f++) {
        double a[8][2], b[8][2];
        int count = 3;
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++) a[k][i] = patch->point[patch->corner[f][k]][i];
        count = clip((const double(*)[2])a, count, 0, low[0], true, b);
        count = clip((const double(*)[2])b, count, 0, high[0], false, a);
        count = clip((const double(*)[2])a, count, 1, low[1], true, b);
        count = clip((const double(*)[2])b, count, 1, high[1], false, a);
        for (int i = 1; i + 1 < count; i++)
            twice +=
                (a[i][0] - a[0][0]) * (a[i + 1][1] - a[0][1]) - (a[i + 1][0] - a[0][0]) * (a[i][1] - a[0][1]);
    }
    return twice / 2;
}
