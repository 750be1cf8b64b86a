// Faces in the plane of the picture where the surface comes unrolled: a shape by its formula, a model by its
// texture.
//
// Checked: tests/test_place_on.c, tests/test_flatten.c (textures).
#include "place/lay.h"
#include "place/nearest.h"
#include "base/vector.h"

#include <math.h>

static const double REACH = 4; // radii of the triangle in the middle over which a texture's scale is taken

// The middle of the unrolled surface.
static void middle_unrolled(const jali_surface *s, double uv[2])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int32_t t = 0; t < s->mesh.triangle_count; t++)
        for (int k = 0; k < 3 && !isnan(s->uv[t][0][0]); k++)
            for (int i = 0; i < 2; i++) {
                low[i] = MIN(low[i], s->uv[t][k][i]);
                high[i] = MAX(high[i], s->uv[t][k][i]);
            }
    for (int i = 0; i < 2; i++) uv[i] = (low[i] + high[i]) / 2;
}

// Where a place on a face lies on the unrolled surface.
static void unrolled_at(const jali_surface *s, int32_t face, const double at[3], double uv[2])
{
    const double *corner[3];
    double part[3], whole = 0;
    for (int k = 0; k < 3; k++) corner[k] = s->mesh.vertex[s->mesh.triangle[face][k]];
    for (int k = 0; k < 3; k++) {
        double n[3];
        area_vector(at, corner[(k + 1) % 3], corner[(k + 2) % 3], n);
        part[k] = sqrt(dot(n, n));
        whole += part[k];
    }
    for (int i = 0; i < 2; i++) {
        uv[i] = 0;
        for (int k = 0; k < 3; k++) uv[i] += part[k] / whole * s->uv[face][k][i];
    }
}

// A texture has its own scale from place to place, and pieces that lie mirrored: make lengths true on the
// mean over a middling part of the picture, and the picture the right way round.
static void scale_texture(const jali_surface *s, int32_t face, const double uv[2], double scale[2])
{
    double space = 0, flat = 0, own = 0, reach = 0;
    for (int k = 0; k < 3; k++)
        reach = MAX(reach, REACH * hypot(s->uv[face][k][0] - uv[0], s->uv[face][k][1] - uv[1]));
    for (int32_t t = 0; t < s->mesh.triangle_count; t++) {
        const double(*p)[2] = (const double(*)[2])s->uv[t];
        double a[3], b[3], x = (p[0][0] + p[1][0] + p[2][0]) / 3 - uv[0],
                           y = (p[0][1] + p[1][1] + p[2][1]) / 3 - uv[1];
        if (t != face && !(hypot(x, y) < reach)) continue;
        double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        for (int k = 0; k < 3; k++) {
            a[k] = s->mesh.vertex[s->mesh.triangle[t][1]][k] - s->mesh.vertex[s->mesh.triangle[t][0]][k];
            b[k] = s->mesh.vertex[s->mesh.triangle[t][2]][k] - s->mesh.vertex[s->mesh.triangle[t][0]][k];
        }
        space +=
            hypot(hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2]), a[0] * b[1] - a[1] * b[0]);
        flat += fabs(area);
        if (t == face) own = area;
    }
    if (!(flat > 0)) return;
    scale[1] = sqrt(space / flat);
    scale[0] = own < 0 ? -scale[1] : scale[1];
}

jali_status lay_by_unrolling(jali_context *ctx, const jali_surface *surface, const double *at_mm, laid *l)
{
    jali_status status;
    double uv[2] = {0, 0}, scale[2] = {1, 1};
    TRY(laid_create(ctx, surface, l));
    l->around_mm = surface->around_mm;
    if (at_mm) {
        double on[3];
        int32_t face = nearest_face(surface, at_mm, on);
        unrolled_at(surface, face, on, uv);
        if (surface->textured) scale_texture(surface, face, uv, scale);
    } else
        middle_unrolled(surface, uv);
    for (int32_t t = 0; t < surface->mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++) l->at[t][k][i] = scale[i] * (surface->uv[t][k][i] - uv[i]);
done:
    if (status != JALI_OK) laid_free(ctx, l);
    return status;
}
