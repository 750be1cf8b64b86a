// How thick the solid is behind each place of a surface, and how wide the void before it.
//
// A reading is the diameter of the largest ball that touches the surface at a point from one side and reaches
// through no part of it that faces the point. A ray along the normal gives a first ball, which is shrunk
// until it fits (Ma, Bae and Choi, "3D medial axis point approximation using nearest neighbors and the normal
// field", 2012, on triangles in place of points). What faces is what has its normal within 20 degrees of the
// opposite: the sides of a box do not count for its top, so a cube measures its side and no edge reads zero.
// Where two sides run together in a sharper edge, straight, the reading is dropped: it says only how far away
// the edge is.
//
// Points:  the middle of every triangle, and more by area.
// Limits:  a wall that is thinnest between the points reads too thick, by what it changes from one to the
//          next. Balls stop within 1 % of fitting and begin at most 10 mm wide: walls above that are as thick
//          as the ray is long, gaps above that are none.
// Checked: tests/test_walls.c
#include "check/walls.h"
#include "mesh/rays.h"
#include "base/vector.h"

#include <math.h>

enum { MOST_TRIANGLES = 400000, BY_AREA = 60000, BLOCK = 512, BATCH = 64 };
static const double widest_mm = 10, low_share = 0.01, facing_squared = 0.883, fit = 0.99, least_sine = 0.03;

typedef struct sample {
    int32_t place, index; // the point `index` of the triangle at a place
    float area;           // that it stands for
    float reading;        // mm; INFINITY: none
    int32_t opposite;     // place of the triangle that ends it; -1: nothing faces the point
} sample;

typedef struct survey {
    const ray_scene *scene;
    int32_t count, first; // first: of the batch
    sample *sample;       // [count]
    double side;          // -1 into the solid, 1 into the void
    double widest_mm;     // of the first ball
} survey;

static void edge(const float corner[3][3], int32_t from, int32_t to, double e[3])
{
    for (int k = 0; k < 3; k++) e[k] = (double)corner[to][k] - (double)corner[from][k];
}

// Twice the area long.
static void wide_normal(const float corner[3][3], double n[3])
{
    double u[3], v[3];
    edge(corner, 0, 1, u);
    edge(corner, 0, 2, v);
    cross(u, v, n);
}

static double area_of(const float corner[3][3])
{
    double n[3];
    wide_normal(corner, n);
    return 0.5 * sqrt(dot(n, n));
}

// Seen along the direction, from the solid (side -1) or the void (side 1).
static bool faces(const float corner[3][3], const double direction[3], double side)
{
    double n[3];
    wide_normal(corner, n);
    double along = -side * dot(n, direction);
    return along > 0 && along * along > facing_squared * dot(n, n);
}

// Point 0 is the middle, the others follow a low-discrepancy sequence (Roberts's R2).
static void point_of(const float corner[3][3], int32_t index, double at[3])
{
    double s = 1.0 / 3, t = 1.0 / 3;
    if (index > 0) {
        s = 0.7548776662466927 * index - floor(0.7548776662466927 * index);
        t = 0.5698402909980532 * index - floor(0.5698402909980532 * index);
        if (s + t > 1) {
            s = 1 - s;
            t = 1 - t;
        }
    }
    for (int k = 0; k < 3; k++)
        at[k] = (1 - s - t) * (double)corner[0][k] + s * (double)corner[1][k] + t * (double)corner[2][k];
}

// The point of a triangle that is nearest to c.
static void nearest_point(const float corner[3][3], const double c[3], double q[3])
{
    double n[3], best = INFINITY;
    bool inside = true;
    wide_normal(corner, n);
    for (int k = 0; k < 3; k++) q[k] = (double)corner[0][k];
    for (int i = 0; i < 3; i++) {
        double e[3], to[3], out[3], away = 0;
        edge(corner, i, (i + 1) % 3, e);
        for (int k = 0; k < 3; k++) to[k] = c[k] - (double)corner[i][k];
        cross(e, n, out);
        if (dot(out, to) <= 0) continue;
        inside = false;
        double t = MAX(0, MIN(dot(e, to) / dot(e, e), 1));
        for (int k = 0; k < 3; k++) away += (to[k] - t * e[k]) * (to[k] - t * e[k]);
        if (away >= best) continue;
        best = away;
        for (int k = 0; k < 3; k++) q[k] = (double)corner[i][k] + t * e[k];
    }
    if (!inside) return;
    double to[3], height;
    for (int k = 0; k < 3; k++) to[k] = c[k] - (double)corner[0][k];
    height = dot(to, n) / dot(n, n);
    for (int k = 0; k < 3; k++) q[k] = c[k] - height * n[k];
}

// Shrink the ball that touches p and reaches in direction n until the triangle does not cut into it.
static double shrunk(const float corner[3][3], const double p[3], const double n[3], double radius)
{
    enum { MOST_STEPS = 20 };
    for (int32_t i = 0; i < MOST_STEPS; i++) {
        double c[3], q[3], away = 0, squared = 0, height = 0;
        for (int k = 0; k < 3; k++) c[k] = p[k] + radius * n[k];
        nearest_point(corner, c, q);
        for (int k = 0; k < 3; k++) {
            away += (q[k] - c[k]) * (q[k] - c[k]);
            squared += (q[k] - p[k]) * (q[k] - p[k]);
            height += (q[k] - p[k]) * n[k];
        }
        if (away >= fit * fit * radius * radius || height <= 0) break;
        radius = squared / (2 * height);
    }
    return radius;
}

static box box_of_ball(const double p[3], const double n[3], double radius)
{
    box b;
    for (int k = 0; k < 3; k++) {
        b.low[k] = (float)(p[k] + radius * n[k] - fit * radius);
        b.high[k] = (float)(p[k] + radius * n[k] + fit * radius);
    }
    return b;
}

static void start_of(const survey *s, const sample *one, double p[3], double n[3])
{
    point_of((const float(*)[3])s->scene->corner[one->place], one->index, p);
    ray_scene_normal(s->scene, one->place, n);
    for (int k = 0; k < 3; k++) n[k] *= s->side;
}

// Is there any surface close to the point, along its normal?
static bool surface_at(const survey *s, const double p[3], const double n[3], const double aside[3], double t,
                       double reading)
{
    ray r = {.near = -0.2 * reading, .far = 0.3 * reading};
    for (int k = 0; k < 3; k++) {
        r.from[k] = p[k] + t * aside[k];
        r.along[k] = n[k];
    }
    return ray_any(s->scene, &r);
}

// Do the two sides run together in a sharp edge, straight from here? There every reading is small, down to
// zero at the edge itself, and says only how far away that is.
static bool at_sharp_edge(const survey *s, const double p[3], const double n[3], const sample *one)
{
    double m[3], aside[3], sine = 0, cosine;
    ray_scene_normal(s->scene, one->opposite, m);
    for (int k = 0; k < 3; k++) m[k] *= -s->side; // as n where the sides are parallel
    cosine = dot(m, n);
    for (int k = 0; k < 3; k++) {
        aside[k] = m[k] - cosine * n[k];
        sine += aside[k] * aside[k];
    }
    sine = sqrt(sine);
    if (sine < least_sine) return false;
    for (int k = 0; k < 3; k++) aside[k] /= sine;
    double edge_mm = one->reading * (1 + cosine) / (2 * sine); // reading / (2 tan(half the angle))
    return surface_at(s, p, n, aside, 0.9 * edge_mm, one->reading) &&
           !surface_at(s, p, n, aside, 1.1 * edge_mm, one->reading);
}

// The first reading is the ray's length; nothing may face the point where it ends.
static void shoot(const survey *s, sample *one)
{
    ray r = {.near = 1e-9 * s->scene->size, .far = s->side > 0 ? widest_mm : INFINITY};
    ray_hit hit;
    start_of(s, one, r.from, r.along);
    one->reading = INFINITY;
    one->opposite = -1;
    if (one->area == 0 || !ray_nearest(s->scene, &r, &hit)) return;
    one->reading = (float)hit.t;
    if (!faces((const float(*)[3])s->scene->corner[hit.place], r.along, s->side)) return;
    one->opposite = hit.place;
    if (at_sharp_edge(s, r.from, r.along, one)) one->reading = INFINITY;
}

// Smaller balls lie inside larger ones, so the box to look in shrinks on the way and one walk is enough.
static double fitting_radius(const survey *s, const double p[3], const double n[3], double radius,
                             int32_t *opposite)
{
    box b = box_of_ball(p, n, radius);
    box_walk walk = box_walk_start(&s->scene->tree, &b, 0);
    for (int32_t place; (place = box_walk_next(&walk)) >= 0;) {
        const float(*corner)[3] = (const float(*)[3])s->scene->corner[place];
        if (!faces(corner, n, s->side)) continue;
        double smaller = shrunk(corner, p, n, radius);
        if (smaller >= radius) continue;
        radius = smaller;
        *opposite = place;
        b = box_of_ball(p, n, radius);
    }
    return radius;
}

static void fit_ball(const survey *s, sample *one)
{
    double p[3], n[3], widest = MIN((double)one->reading, s->widest_mm);
    if (one->reading == INFINITY) return;
    start_of(s, one, p, n);
    double diameter = 2 * fitting_radius(s, p, n, widest / 2, &one->opposite);
    if (diameter < widest) {
        one->reading = (float)diameter;
        if (at_sharp_edge(s, p, n, one)) one->reading = INFINITY;
    } else if (one->opposite < 0) {
        one->reading = INFINITY; // nothing faces the point at all
    }
}

static void shoot_block(void *shared, int32_t index)
{
    const survey *s = shared;
    for (int32_t i = s->first + index * BLOCK; i < MIN(s->first + (index + 1) * BLOCK, s->count); i++)
        shoot(s, &s->sample[i]);
}

static void fit_block(void *shared, int32_t index)
{
    const survey *s = shared;
    for (int32_t i = s->first + index * BLOCK; i < MIN(s->first + (index + 1) * BLOCK, s->count); i++)
        fit_ball(s, &s->sample[i]);
}

static jali_status each_block(jali_context *ctx, survey *s, void (*work)(void *, int32_t), double from,
                              double to)
{
    for (s->first = 0; s->first < s->count; s->first += BATCH * BLOCK) {
        jali_status status = step(ctx, "check", from + (to - from) * s->first / s->count);
        if (status != JALI_OK) return status;
        parallel(ctx, MIN(BATCH, (s->count - s->first - 1) / BLOCK + 1), work, s);
    }
    return JALI_OK;
}

// The reading that a share of the area, of what is read, does not exceed; INFINITY when nothing is read.
// Floats that are not negative are in the order of their bits.
static double percentile(const survey *s, bool faced_only, double share)
{
    double whole = 0;
    uint32_t low = 0, high = 0x7f800000;
    for (int32_t i = 0; i < s->count; i++)
        if (s->sample[i].reading < INFINITY && (!faced_only || s->sample[i].opposite >= 0))
            whole += s->sample[i].area;
    if (whole == 0) return INFINITY;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        float limit;
        double below = 0;
        memcpy(&limit, &middle, sizeof limit);
        for (int32_t i = 0; i < s->count; i++)
            if (s->sample[i].reading <= limit && (!faced_only || s->sample[i].opposite >= 0))
                below += s->sample[i].area;
        if (below >= share * whole)
            high = middle;
        else
            low = middle + 1;
    }
    float result;
    memcpy(&result, &low, sizeof result);
    return (double)result;
}

static void conclude(const survey *s, jali_thickness *result)
{
    const sample *thinnest = NULL;
    *result = (jali_thickness){.measured = true, .thinnest_mm = INFINITY};
    result->percentile1_mm = percentile(s, false, low_share);
    for (int32_t i = 0; i < s->count; i++)
        if (s->sample[i].reading < result->thinnest_mm) {
            thinnest = &s->sample[i];
            result->thinnest_mm = (double)thinnest->reading;
        }
    if (!thinnest) return;
    double p[3], n[3];
    start_of(s, thinnest, p, n);
    for (int k = 0; k < 3; k++)
        result->at_mm[k] = s->scene->origin[k] + p[k] + 0.5 * result->thinnest_mm * n[k];
}

// The balls need be no wider than the low percentile by rays alone: balls are smaller than their rays, so
// neither it nor the smallest changes.
static jali_status survey_side(jali_context *ctx, survey *s, double side, double progress,
                               jali_thickness *result)
{
    jali_status status;
    s->side = side;
    TRY(each_block(ctx, s, shoot_block, progress, progress + 0.03));
    s->widest_mm = MIN(percentile(s, true, low_share), widest_mm);
    TRY(each_block(ctx, s, fit_block, progress + 0.03, progress + 0.05));
    conclude(s, result);
done:
    return status;
}

// Spread the points: `each` a triangle (one, unless there are too many triangles) and the others by area.
// Returns how many there are; they are put in `point` unless it is NULL.
static int32_t spread_points(const ray_scene *scene, double whole, sample *point)
{
    double each = MIN(1, (double)MOST_TRIANGLES / MAX(1, scene->tree.item_count)), due = 0;
    int32_t count = 0;
    for (int32_t place = 0; place < scene->tree.item_count; place++) {
        double area = area_of((const float(*)[3])scene->corner[place]);
        double share = each + (whole > 0 ? BY_AREA * area / whole : 0);
        due += share;
        for (int32_t i = 0; count < (int32_t)due; i++, count++)
            if (point) point[count] = (sample){place, i, (float)(area / share), 0, -1};
    }
    return count;
}

jali_status measure_walls(jali_context *ctx, const jali_mesh *mesh, jali_thickness *walls,
                          jali_thickness *gaps)
{
    jali_status status;
    ray_scene scene = {0};
    survey s = {.scene = &scene};
    double whole = 0;
    TRY(ray_scene_create(ctx, mesh, &scene));
    for (int32_t i = 0; i < mesh->triangle_count; i++) whole += area_of((const float(*)[3])scene.corner[i]);
    s.count = spread_points(&scene, whole, NULL);
    TRY(ALLOCATE(ctx, s.sample, s.count));
    spread_points(&scene, whole, s.sample);
    TRY(survey_side(ctx, &s, -1, 0.9, walls));
    TRY(survey_side(ctx, &s, 1, 0.95, gaps));
done:
    release(ctx, s.sample);
    ray_scene_free(ctx, &scene);
    return status;
}
