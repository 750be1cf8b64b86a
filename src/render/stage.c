// Where everything stands: which way is up, where the eye is, where the lamp goes.
//
// The camera is as near as it can be with every vertex inside the picture's frame: of the planes through the
// frame's sides, each touches the mesh, so the eye follows from four maxima over the vertices.
//
// The lamp goes to the roomiest of 7 x 7 x 7 points of the object's box: the one farthest from any surface,
// of those that lie in no solid (no ray meets a triangle from behind) and see it in half of all directions.
// Where no point is like that (a plate, a solid), it stands behind the object.
#include "render/stage.h"

static const double fill = 0.84;            // of the picture's half width, by the object
static const double half_angle = 0.21;      // of the picture, rad: a mild perspective
static const double turn = 0.42, tip = 0.3; // of the view from the front: to the right, from above, rad

static vec vec_of(const double v[3])
{
    return (vec){v[0], v[1], v[2]};
}

static vec vertex_of(const stage *s, const jali_mesh *mesh, int32_t i)
{
    return subtract(vec_of(mesh->vertex[i]), vec_of(s->scene->origin));
}

// Is it a plate that lies on its back, its picture seen from above?
static bool lies_flat(const ray_scene *scene)
{
    const double *h = scene->high;
    return h[2] < 0.2 * MIN(h[0], h[1]);
}

// The room's axes; a view given sets which way is `towards`.
static jali_status set_axes(jali_context *ctx, const jali_render_options *opt, stage *s, vec *view)
{
    bool flat = lies_flat(s->scene), up_given = length(vec_of(opt->up)) > 0;
    vec up = unit(vec_of(opt->up)), front = {0, -1, 0};
    if (!up_given) up = flat ? (vec){0, 1, 0} : (vec){0, 0, 1};
    if (flat && !up_given) front = (vec){0, 0, 1};
    if (fabs(dot(front, up)) > 0.9) front = (vec){0, 0, dot(front, up) > 0 ? -1 : 1};
    *view = unit(vec_of(opt->view));
    s->up = up;
    if (length(vec_of(opt->view)) > 0) {
        s->towards = unit(along(scaled(*view, -1), up, dot(*view, up)));
        if (fabs(dot(*view, up)) > 0.9999) // straight from above or below
            s->towards = unit(along(front, up, -dot(front, up)));
    } else {
        front = unit(along(front, up, -dot(front, up)));
        vec aside = cross(up, front);
        s->towards = unit(add(scaled(front, cos(turn)), scaled(aside, sin(turn))));
        *view = scaled(add(scaled(s->towards, cos(tip)), scaled(up, sin(tip))), -1);
    }
    s->right = cross(up, s->towards);
    if (!(isfinite(length(vec_of(opt->view))) && isfinite(length(vec_of(opt->up))) && length(s->right) > 0.5))
        return fail(ctx, JALI_BAD_VALUE, "the picture's view and its up must be directions");
    return JALI_OK;
}

// Back off until all fits; the middle of what is seen is the middle of the picture.
static void set_camera(const jali_mesh *mesh, const jali_render_options *opt, vec view, stage *s)
{
    double shorter = MIN(opt->width_px, opt->height_px), most[4], nearest = -INFINITY, farthest = INFINITY;
    s->axis[2] = scaled(view, -1);
    s->axis[0] = s->right;
    s->axis[1] = cross(s->axis[2], s->axis[0]);
    s->slope[0] = tan(half_angle) * opt->width_px / shorter;
    s->slope[1] = tan(half_angle) * opt->height_px / shorter;
    for (int i = 0; i < 4; i++) most[i] = -INFINITY;
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        vec p = vertex_of(s, mesh, i);
        double at[3] = {dot(p, s->axis[0]), dot(p, s->axis[1]), dot(p, s->axis[2])};
        for (int k = 0; k < 4; k++) {
            double side = k & 1 ? -at[k / 2] : at[k / 2];
            most[k] = MAX(most[k], side + fill * s->slope[k / 2] * at[2]);
        }
        nearest = MAX(nearest, at[2]);
        farthest = MIN(farthest, at[2]);
    }
    if (mesh->vertex_count == 0) most[0] = most[1] = most[2] = most[3] = nearest = farthest = 0;
    double back =
        MAX((most[0] + most[1]) / (2 * fill * s->slope[0]), (most[2] + most[3]) / (2 * fill * s->slope[1]));
    back = MAX(back, nearest + 1e-3 * s->scene->size + 1e-6);
    s->eye =
        add(add(scaled(s->axis[0], 0.5 * (most[0] - most[1])), scaled(s->axis[1], 0.5 * (most[2] - most[3]))),
            scaled(s->axis[2], back));
    s->near_depth = back - nearest;
    s->depth = nearest - farthest;
}

// A direction of a set that covers the sphere evenly (a Fibonacci spiral).
static vec direction_of(int32_t i, int32_t count)
{
    double z = 1 - (2 * i + 1.0) / count, r = sqrt(1 - z * z), angle = 2.399963229728653 * i;
    return (vec){r * cos(angle), r * sin(angle), z};
}

// How far a point is from the surface as a hollow's inside sees it; 0 when it is not inside a hollow.
static double room_at(const ray_scene *scene, vec p)
{
    enum { DIRECTIONS = 96 };
    double least = scene->size;
    int32_t hits = 0;
    for (int32_t i = 0; i < DIRECTIONS; i++) {
        vec d = direction_of(i, DIRECTIONS);
        double n[3];
        ray r = {{p.x, p.y, p.z}, {d.x, d.y, d.z}, 0, INFINITY};
        ray_hit hit;
        if (!ray_nearest(scene, &r, &hit)) continue;
        ray_scene_normal(scene, hit.place, n);
        if (dot(vec_of(n), d) > 0) return 0; // from within the solid
        least = MIN(least, hit.t);
        hits++;
    }
    return hits >= DIRECTIONS / 2 ? least : 0;
}

static void set_lamp(stage *s)
{
    enum { STEPS = 7 };
    const ray_scene *scene = s->scene;
    double best = 0;
    vec low = vec_of(scene->low), extent = subtract(vec_of(scene->high), low);
    for (int32_t i = 0; i < STEPS * STEPS * STEPS; i++) {
        int32_t x = i % STEPS, y = i / STEPS % STEPS, z = i / STEPS / STEPS;
        vec share = {(x + 0.5) / STEPS, (y + 0.5) / STEPS, (z + 0.5) / STEPS};
        vec p = add(low, times(extent, share));
        double room = room_at(scene, p);
        if (room <= best * 1.0001) continue;
        best = room;
        s->bulb = p;
    }
    if (best < 0.02 * scene->size) {
        s->bulb = add(scaled(s->towards, -0.55 * scene->size), scaled(s->up, 0.18 * scene->size));
        best = 0.1 * scene->size;
    }
    s->bulb_radius = MIN(0.022 * scene->size, 0.4 * best);
}

jali_status stage_create(jali_context *ctx, const ray_scene *scene, const jali_mesh *mesh,
                         const jali_render_options *opt, stage *s)
{
    jali_status status;
    vec view;
    double deepest = 0;
    *s = (stage){.scene = scene, .lamp = opt->lamp, .draft = opt->draft, .wall = INFINITY};
    TRY(set_axes(ctx, opt, s, &view));
    set_camera(mesh, opt, view, s);
    s->ground = mesh->vertex_count ? INFINITY : 0;
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        vec p = vertex_of(s, mesh, i);
        s->ground = MIN(s->ground, dot(p, s->up));
        deepest = MAX(deepest, -dot(p, s->towards));
    }
    s->key = unit(add(add(scaled(s->right, -0.55), scaled(s->towards, 0.55)), scaled(s->up, 0.95)));
    if (opt->lamp) {
        set_lamp(s);
        s->wall = MAX(deepest, -dot(s->bulb, s->towards)) + 0.28 * scene->size;
        s->power = pow(0.5 * scene->size, 2);
    }
done:
    return status;
}

vec stage_direction(const stage *s, double x, double y)
{
    return unit(
        subtract(add(scaled(s->axis[0], x * s->slope[0]), scaled(s->axis[1], y * s->slope[1])), s->axis[2]));
}
