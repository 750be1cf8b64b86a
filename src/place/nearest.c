// The place of a surface that is nearest to a point.
//
// Checked: tests/test_place_on.c, tests/test_flatten.c.
#include "place/nearest.h"
#include "base/base.h"
#include "base/vector.h"

// The point of a segment nearest to p; its squared distance.
static double nearest_on_side(const double a[3], const double b[3], const double p[3], double at[3])
{
    double e[3], r[3], away = 0;
    subtract(b, a, e);
    subtract(p, a, r);
    double share = MIN(MAX(dot(r, e) / dot(e, e), 0), 1);
    for (int k = 0; k < 3; k++) {
        at[k] = a[k] + share * e[k];
        away += (p[k] - at[k]) * (p[k] - at[k]);
    }
    return away;
}

static double nearest_on_face(const jali_mesh *m, int32_t face, const double p[3], double at[3])
{
    const double *corner[3];
    double a[3], b[3], r[3], n[3], side[3], least = INFINITY;
    for (int k = 0; k < 3; k++) corner[k] = m->vertex[m->triangle[face][k]];
    subtract(corner[1], corner[0], a);
    subtract(corner[2], corner[0], b);
    subtract(p, corner[0], r);
    cross(a, b, n);
    double nn = dot(n, n), inside[3];
    cross(a, r, side);
    inside[2] = dot(side, n) / nn;
    cross(r, b, side);
    inside[1] = dot(side, n) / nn;
    inside[0] = 1 - inside[1] - inside[2];
    if (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) {
        double off = dot(r, n) / nn;
        for (int k = 0; k < 3; k++) at[k] = p[k] - off * n[k];
        return off * off * nn;
    }
    for (int k = 0; k < 3; k++) {
        double here[3], away = nearest_on_side(corner[k], corner[(k + 1) % 3], p, here);
        if (away >= least) continue;
        least = away;
        memcpy(at, here, sizeof here);
    }
    return least;
}

int32_t nearest_face(const jali_surface *surface, const double point[3], double at[3])
{
    double least = INFINITY;
    int32_t nearest = -1;
    for (int32_t t = 0; t < surface->mesh.triangle_count; t++) {
        double here[3];
        if (surface->uv && isnan(surface->uv[t][0][0])) continue;
        double away = nearest_on_face(&surface->mesh, t, point, here);
        if (away >= least) continue;
        least = away;
        nearest = t;
        memcpy(at, here, sizeof here);
    }
    return nearest;
}
