// Faces in the plane of the picture where the surface comes unrolled: a shape by its formula, a model by its
// texture.
//
// Checked: tests/test_place_on.c, tests/test_flatten.c (textures).
#include "place/lay.h"

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

// The triangle of which the middle is nearest to a place, and where that lies on the unrolled surface.
static int32_t nearest_unrolled(const jali_surface *s, const double at[3], double uv[2])
{
    double nearest = INFINITY;
    int32_t found = -1;
    for (int32_t t = 0; t < s->mesh.triangle_count; t++) {
        double away = 0;
        if (isnan(s->uv[t][0][0])) continue;
        for (int k = 0; k < 3; k++) {
            double middle = 0;
            for (int i = 0; i < 3; i++) middle += s->mesh.vertex[s->mesh.triangle[t][i]][k] / 3;
            away += (middle - at[k]) * (middle - at[k]);
        }
        if (away >= nearest) continue;
        nearest = away;
        found = t;
    }
    for (int i = 0; i < 2 && found >= 0; i++)
        uv[i] = (s->uv[found][0][i] + s->uv[found][1][i] + s->uv[found][2][i]) / 3;
    return found;
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
        int32_t face = nearest_unrolled(surface, at_mm, uv);
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
