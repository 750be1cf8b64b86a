// Faces in the plane of the picture, through a camera.
//
// Source:  Binary Image Carving for 3D Printing, section 3: the picture is carved along the rays of an
// inverse
//          perspective, so that it looks right from the eye.
// Checked: tests/test_place_on.c.
#include "place/lay.h"
#include "base/vector.h"

#include <math.h>

static bool normalise(double a[3])
{
    double length = sqrt(dot(a, a));
    if (!(length > 0) || !isfinite(length)) return false;
    for (int k = 0; k < 3; k++) a[k] /= length;
    return true;
}

jali_status aim(jali_context *ctx, const jali_camera *opt, const double centre[3], camera *c)
{
    double up[3];
    *c = (camera){0};
    memcpy(c->centre, centre, sizeof c->centre);
    memcpy(c->forward, opt->direction, sizeof c->forward);
    memcpy(up, opt->up, sizeof up);
    if (opt->perspective)
        for (int k = 0; k < 3; k++) c->forward[k] = centre[k] - opt->from[k];
    if (!normalise(c->forward))
        return fail(ctx, JALI_BAD_VALUE, "the camera has no direction of view: it stands where it looks at");
    if (up[0] == 0 && up[1] == 0 && up[2] == 0) up[fabs(c->forward[2]) > 0.99 ? 1 : 2] = 1;
    cross(c->forward, up, c->right);
    if (!normalise(up) || !normalise(c->right) || fabs(dot(up, c->forward)) > 0.9999)
        return fail(ctx, JALI_BAD_VALUE, "the camera's up (%g, %g, %g) is its direction of view", opt->up[0],
                    opt->up[1], opt->up[2]);
    cross(c->right, c->forward, c->up);
    if (opt->perspective) {
        double away[3];
        memcpy(c->eye, opt->from, sizeof c->eye);
        for (int k = 0; k < 3; k++) away[k] = centre[k] - opt->from[k];
        c->distance = sqrt(dot(away, away));
    }
    return JALI_OK;
}

// The place of one vertex; NaN behind the eye.
static double project(const camera *c, const double p[3], double at[2])
{
    double from_centre[3], scale = 1;
    for (int k = 0; k < 3; k++) from_centre[k] = p[k] - c->centre[k];
    double depth = dot(from_centre, c->forward) + c->distance;
    if (c->distance > 0) scale = depth > 1e-3 * c->distance ? c->distance / depth : NAN;
    at[0] = scale * dot(from_centre, c->right);
    at[1] = scale * dot(from_centre, c->up);
    return depth;
}

jali_status laid_create(jali_context *ctx, const jali_surface *surface, laid *l)
{
    *l = (laid){.surface = surface};
    return ALLOCATE(ctx, l->at, surface->mesh.triangle_count + 1);
}

void laid_free(jali_context *ctx, laid *l)
{
    release(ctx, l->at);
    release(ctx, l->depth);
    *l = (laid){0};
}

jali_status lay_by_camera(jali_context *ctx, const jali_surface *surface, const camera *c, laid *l)
{
    jali_status status;
    const jali_mesh *mesh = &surface->mesh;
    arena_mark mark = arena_here(ctx);
    double(*at)[2];
    TRY(laid_create(ctx, surface, l));
    TRY(ALLOCATE(ctx, l->depth, mesh->vertex_count + 1));
    TRY(ARENA(ctx, at, mesh->vertex_count + 1));
    l->perspective = c->distance > 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) l->depth[v] = project(c, mesh->vertex[v], at[v]);
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) memcpy(l->at[t][k], at[mesh->triangle[t][k]], sizeof *at);
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) laid_free(ctx, l);
    return status;
}

// Solve the two edges of the plane for the derivatives of the map, then take their products.
bool face_metric(const laid *l, int32_t face, double g[3])
{
    const double(*p)[2] = (const double(*)[2])l->at[face];
    const int32_t *corner = l->surface->mesh.triangle[face];
    double a[2] = {p[1][0] - p[0][0], p[1][1] - p[0][1]}, b[2] = {p[2][0] - p[0][0], p[2][1] - p[0][1]};
    double area = a[0] * b[1] - a[1] * b[0], dx[3], dy[3];
    if (!(area > 0)) return false;
    for (int k = 0; k < 3; k++) {
        double u = l->surface->mesh.vertex[corner[1]][k] - l->surface->mesh.vertex[corner[0]][k];
        double v = l->surface->mesh.vertex[corner[2]][k] - l->surface->mesh.vertex[corner[0]][k];
        dx[k] = (u * b[1] - v * a[1]) / area;
        dy[k] = (v * a[0] - u * b[0]) / area;
    }
    g[0] = dot(dx, dx);
    g[1] = dot(dx, dy);
    g[2] = dot(dy, dy);
    return true;
}
