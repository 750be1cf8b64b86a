// The sheet of a plate that is given as a model: its outline is read off the mesh.
//
// A plate is what lies between two parallel planes z = low and z = high with walls square to them. The border
// of the triangles in the upper plane, followed from corner to corner, is its outline; on a lattice as fine
// as coordinates of 2^24 allow, which holds what jali itself writes exactly. Checked: tests/test_sheet.c: a
// carved plate's mesh gives the sheet of its contours.
#include <jali/sheet.h>

#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>

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

// Sides of the triangles in the upper plane that no other such triangle has: from[i] leads to to[i].
typedef struct side {
    int32_t from, to;
} side;

static int by_ends(const void *a, const void *b)
{
    const side *x = a, *y = b;
    int32_t xl = MIN(x->from, x->to), yl = MIN(y->from, y->to), xh = MAX(x->from, x->to),
            yh = MAX(y->from, y->to);
    if (xl != yl) return xl < yl ? -1 : 1;
    return xh < yh ? -1 : xh > yh;
}

static int by_start(const void *a, const void *b)
{
    const side *x = a, *y = b;
    return x->from < y->from ? -1 : x->from > y->from;
}

static jali_status upper_border(jali_context *ctx, const jali_mesh *mesh, const levels *l, side **border,
                                int32_t *count)
{
    jali_status status;
    size_t sides = 0, kept = 0;
    double middle = (l->low[2] + l->high[2]) / 2;
    TRY(ALLOCATE(ctx, *border, 3 * (size_t)mesh->triangle_count));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *c = mesh->triangle[t];
        bool upper = true;
        for (int i = 0; i < 3; i++) upper &= mesh->vertex[c[i]][2] > middle;
        for (int i = 0; i < 3 && upper; i++) (*border)[sides++] = (side){c[i], c[(i + 1) % 3]};
    }
    qsort(*border, sides, sizeof **border, by_ends);
    for (size_t i = 0; i < sides; i++) {
        if (i + 1 < sides && by_ends(&(*border)[i], &(*border)[i + 1]) == 0)
            i++;
        else
            (*border)[kept++] = (*border)[i];
    }
    qsort(*border, kept, sizeof **border, by_start);
    for (size_t i = 1; i < kept; i++)
        if ((*border)[i].from == (*border)[i - 1].from)
            return fail(ctx, JALI_BAD_INPUT, "two outlines of the plate meet at (%.4g, %.4g) mm",
                        mesh->vertex[(*border)[i].from][0], mesh->vertex[(*border)[i].from][1]);
    *count = (int32_t)kept;
done:
    return status;
}

static int32_t side_from(const side *border, int32_t count, int32_t vertex)
{
    side wanted = {vertex, vertex};
    const side *found = bsearch(&wanted, border, (size_t)count, sizeof *border, by_start);
    return found ? (int32_t)(found - border) : -1;
}

// Follow the sides from corner to corner.
static jali_status trace_border(jali_context *ctx, const jali_mesh *mesh, const levels *l, side *border,
                                int32_t count, jali_contours *c)
{
    jali_status status;
    size_t room = 0;
    TRY(ALLOCATE(ctx, c->point, count));
    for (int32_t begin = 0; begin < count; begin++) {
        if (border[begin].to < 0) continue;
        TRY(GROW(ctx, c->first, room, (size_t)c->contour_count + 2));
        c->first[c->contour_count++] = c->point_count;
        for (int32_t i = begin; i >= 0 && border[i].to >= 0;) {
            const double *v = mesh->vertex[border[i].from];
            int32_t *p = c->point[c->point_count++], next = border[i].to;
            for (int k = 0; k < 2; k++) p[k] = (int32_t)lround((v[k] - l->low[k]) / c->unit_mm);
            border[i].to = -1;
            i = side_from(border, count, next);
            if (i < 0)
                TRY(fail(ctx, JALI_BAD_INPUT, "the plate's outline ends at (%.4g, %.4g) mm",
                         mesh->vertex[next][0], mesh->vertex[next][1]));
        }
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
    side *border = NULL;
    jali_contours outline = {0};
    jali_sheet_options whole = opt ? *opt : jali_sheet_defaults();
    int32_t count = 0;
    *sheet = (jali_sheet){0};
    TRY(mesh_validate(ctx, mesh));
    TRY(find_levels(ctx, mesh, &l));
    double size = fmax(l.high[0] - l.low[0], l.high[1] - l.low[1]);
    if (!(size > 0)) TRY(fail(ctx, JALI_BAD_INPUT, "the model has no extent across z"));
    outline.unit_mm = exp2(ceil(log2(size / MOST_UNITS)));
    TRY(upper_border(ctx, mesh, &l, &border, &count));
    TRY(trace_border(ctx, mesh, &l, border, count, &outline));
    *chart = (jali_chart){.pixel_units = PIXEL_UNITS, .unit_mm = outline.unit_mm};
    while (size / outline.unit_mm / chart->pixel_units > MOST_PIXELS) chart->pixel_units *= 2;
    chart->width_px = (int32_t)ceil((l.high[0] - l.low[0]) / outline.unit_mm / chart->pixel_units);
    chart->height_px = (int32_t)ceil((l.high[1] - l.low[1]) / outline.unit_mm / chart->pixel_units);
    *thickness_mm = l.high[2] - l.low[2];
    whole.whole = true;
    TRY(jali_sheet_plate(ctx, &outline, chart, *thickness_mm, &whole, sheet));
done:
    release(ctx, border);
    jali_contours_free(ctx, &outline);
    return status;
}
