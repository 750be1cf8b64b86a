// The sheet of a plate that is given as a model: its outline is read off the mesh.
//
// A plate is what lies between two parallel planes z = low and z = high with walls square to them. The border
// of the triangles in the upper plane, followed from corner to corner, is its outline; on a lattice as fine
// as coordinates of 2^24 allow, which holds what jali itself writes exactly. Checked: tests/test_sheet.c: a
// carved plate's mesh gives the sheet of its contours.
#include <jali/sheet.h>

#include "mesh/mesh.h"
#include "mesh/sides.h"

#include <math.h>

static const double LEVEL = 1e-4; // of the thickness: as far a vertex may lie off its plane

enum { MOST_UNITS = 1 << 23, PIXEL_UNITS = 64, MOST_PIXELS = 1 << 14 };

typedef struct levels {
    double low[3], high[3];
} levels;

static jali_status find_levels(jali_context *ctx, const jali_mesh *mesh, levels *l)
{
    int64_t between = 0;
    for (int k = 0; k < 3; k++) l->low[k] = INFINITY, l->high[k] = -INFINITY;
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            l->low[k] = fmin(l->low[k], mesh->vertex[i][k]);
            l->high[k] = fmax(l->high[k], mesh->vertex[i][k]);
        }
    double thickness = l->high[2] - l->low[2];
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        double z = mesh->vertex[i][2];
        between += fmin(z - l->low[2], l->high[2] - z) > LEVEL * thickness;
    }
    if (!(thickness > 0) || between > 0)
        return fail(ctx, JALI_NO_RESULT,
                    "the model is no plate: %lld of its %d corners lie between z = %.4g and %.4g mm; give "
                    "the picture "
                    "with --surface instead",
                    (long long)between, mesh->vertex_count, l->low[2], l->high[2]);
    return JALI_OK;
}

// The border of the triangles in the upper plane: the vertex that follows each vertex on it, else -1.
static jali_status upper_border(jali_context *ctx, const jali_mesh *mesh, const levels *l, int32_t *next)
{
    jali_status status;
    sides linked = {0};
    int32_t(*upper)[3] = NULL, count = 0;
    double middle = (l->low[2] + l->high[2]) / 2;
    TRY(ALLOCATE(ctx, upper, mesh->triangle_count));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *c = mesh->triangle[t];
        if (mesh->vertex[c[0]][2] > middle && mesh->vertex[c[1]][2] > middle &&
            mesh->vertex[c[2]][2] > middle)
            memcpy(upper[count++], c, sizeof *upper);
    }
    TRY(sides_create(ctx, mesh->vertex_count, count, (const int32_t(*)[3])upper, &linked));
    memset(next, -1, (size_t)mesh->vertex_count * sizeof *next);
    for (int32_t t = 0; t < count; t++)
        for (int i = 0; i < 3; i++) {
            int32_t from = upper[t][(i + 1) % 3];
            if (linked.beside[4 * t + i] != NO_SIDE) continue;
            if (next[from] >= 0)
                TRY(fail(ctx, JALI_BAD_INPUT, "two outlines of the plate meet at (%.4g, %.4g) mm",
                         mesh->vertex[from][0], mesh->vertex[from][1]));
            next[from] = upper[t][(i + 2) % 3];
        }
done:
    sides_free(ctx, &linked);
    release(ctx, upper);
    return status;
}

// Follow the border from corner to corner; what has been followed is taken out of `next`.
static jali_status trace_border(jali_context *ctx, const jali_mesh *mesh, const levels *l, int32_t *next,
                                jali_contours *c)
{
    jali_status status;
    size_t room = 0;
    TRY(ALLOCATE(ctx, c->point, mesh->vertex_count));
    for (int32_t begin = 0; begin < mesh->vertex_count; begin++) {
        int32_t i = begin;
        if (next[begin] < 0) continue;
        TRY(GROW(ctx, c->first, room, (size_t)c->contour_count + 2));
        c->first[c->contour_count++] = c->point_count;
        while (next[i] >= 0) {
            int32_t *p = c->point[c->point_count++], then = next[i];
            for (int k = 0; k < 2; k++) p[k] = (int32_t)lround((mesh->vertex[i][k] - l->low[k]) / c->unit_mm);
            next[i] = -1;
            i = then;
        }
        if (i != begin)
            TRY(fail(ctx, JALI_BAD_INPUT, "the plate's outline ends at (%.4g, %.4g) mm", mesh->vertex[i][0],
                     mesh->vertex[i][1]));
        c->first[c->contour_count] = c->point_count;
    }
    if (c->contour_count == 0) return fail(ctx, JALI_BAD_INPUT, "the model has no upper side");
done:
    return status;
}

jali_status jali_sheet_plate_model(jali_context *ctx, const jali_mesh *mesh, const jali_sheet_options *opt,
                                   jali_chart *chart, double *thickness_mm, jali_sheet *sheet)
{
    jali_status status;
    levels l;
    int32_t *next = NULL;
    jali_contours outline = {0};
    jali_sheet_options whole = opt ? *opt : jali_sheet_defaults();
    *sheet = (jali_sheet){0};
    TRY(mesh_validate(ctx, mesh));
    TRY(find_levels(ctx, mesh, &l));
    double size = fmax(l.high[0] - l.low[0], l.high[1] - l.low[1]);
    if (!(size > 0)) TRY(fail(ctx, JALI_BAD_INPUT, "the model has no extent across z"));
    outline.unit_mm = exp2(ceil(log2(size / MOST_UNITS)));
    TRY(ALLOCATE(ctx, next, mesh->vertex_count));
    TRY(upper_border(ctx, mesh, &l, next));
    TRY(trace_border(ctx, mesh, &l, next, &outline));
    *chart = (jali_chart){.pixel_units = PIXEL_UNITS, .unit_mm = outline.unit_mm};
    while (size / outline.unit_mm / chart->pixel_units > MOST_PIXELS) chart->pixel_units *= 2;
    chart->width_px = (int32_t)ceil((l.high[0] - l.low[0]) / outline.unit_mm / chart->pixel_units);
    chart->height_px = (int32_t)ceil((l.high[1] - l.low[1]) / outline.unit_mm / chart->pixel_units);
    *thickness_mm = l.high[2] - l.low[2];
    whole.whole = true;
    TRY(jali_sheet_plate(ctx, &outline, chart, *thickness_mm, &whole, sheet));
done:
    release(ctx, next);
    jali_contours_free(ctx, &outline);
    return status;
}
