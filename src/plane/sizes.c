// The wished size of triangles: a share of the local width.
//
// How:     the borders are split until no edge is longer than what lies across is far; then the Delaunay
// circles
//          are near the largest discs of the inside, and where such a disc meets the borders on opposite
//          sides, its diameter is the local width. In corners discs meet the borders at less than a half
//          turn: they tell no width, else every corner would be infinitely narrow.
// Source:  Amenta and Bern: Surface reconstruction by Voronoi filtering (1999), for the discs; the separation
// angle
//          is that of Foskey, Lin, Manocha: Efficient computation of a simplified medial axis (2003).
// Checked: tests/test_sheet.c: strips, wedges, discs.
#include "plane/refine.h"

#include <math.h>

enum { EDGES_A_STEP = 1 << 14 };

// The largest angle whose triangle tells a width, 110 degrees: its circle meets borders 140 degrees apart.
static const double LEAST_COSINE = -0.34;
// The sides of an ear differ by no more than that before the longer one is split.
static const double EAR_RATIO = 1.5;

static int constrained_sides(const triangulation *plane, int32_t t)
{
    return (plane->kind[4 * t] != 0) + (plane->kind[4 * t + 1] != 0) + (plane->kind[4 * t + 2] != 0);
}

// How far the corner opposite side s is from that side; in an ear, what the side may measure against the
// other.
static double distance_across(const refinement *r, int32_t s)
{
    const triangulation *plane = r->plane;
    int32_t apex = plane->corner[s], a = plane->corner[next_side(s)], b = plane->corner[last_side(s)];
    double to_a = squared_length(r, apex, a), to_b = squared_length(r, apex, b),
           edge = squared_length(r, a, b);
    if (plane->kind[next_side(s)] || plane->kind[last_side(s)])
        return EAR_RATIO * sqrt(plane->kind[next_side(s)] ? to_b : to_a);
    double along = 0.5 * (edge + to_a - to_b);
    if (along <= 0 || along >= edge) return sqrt(MIN(to_a, to_b));
    return sqrt(MAX(to_a - along * along / edge, 0));
}

static void wait_around(refinement *r, int32_t p)
{
    int32_t s = 4 * r->plane->star[p];
    while (r->plane->corner[s] != p) s++;
    int32_t first = s;
    do {
        if (r->inside[s >> 2]) wait_in(&r->waiting, s >> 2, 0);
        s = next_side(r->plane->beside[next_side(s)]);
    } while (s != first);
}

static jali_status split_to_gaps(jali_context *ctx, refinement *r, double finest)
{
    jali_status status = JALI_OK;
    triangulation *plane = r->plane;
    int32_t t;
    for (t = 0; t < plane->triangle_count; t++)
        if (r->inside[t] && constrained_sides(plane, t) > 0) wait_in(&r->waiting, t, 0);
    while ((t = next_waiting(&r->waiting)) != NONE_WAITING)
        for (int32_t s = 4 * t; s < 4 * t + 3; s++) {
            if (!plane->kind[s]) continue;
            double edge = sqrt(squared_length(r, plane->corner[next_side(s)], plane->corner[last_side(s)]));
            int32_t p = -1;
            if (edge > finest && edge > distance_across(r, s)) TRY(split_border(ctx, r, s, 0.5, &p));
            if (p < 0) continue;
            wait_around(r, p);
            break;
        }
done:
    return status;
}

// The width that triangle t tells, or infinity.
static double width_at(const refinement *r, int32_t t)
{
    const triangulation *plane = r->plane;
    int borders = constrained_sides(plane, t);
    form f = form_of(r, t);
    double longest = f.x < 0.5 * f.length ? hypot(f.x - f.length, f.y) : hypot(f.x, f.y);
    double middle = f.x < 0.5 * f.length ? hypot(f.x, f.y) : hypot(f.x - f.length, f.y);
    double dot = f.length * f.length + middle * middle - longest * longest;
    if (dot < 2 * LEAST_COSINE * f.length * middle) return INFINITY;
    if (borders == 2) { // an ear tells a width when what it is cut from is one, too
        for (int32_t s = 4 * t; s < 4 * t + 3; s++)
            if (!plane->kind[s] && constrained_sides(plane, plane->beside[s] >> 2) < 2) return INFINITY;
    }
    double width = 2 * f.radius;
    for (int32_t s = 4 * t; s < 4 * t + 3 && borders == 1; s++)
        if (plane->kind[s]) width = MIN(width, distance_across(r, s));
    return width;
}

// Let sizes grow no faster than `growth` a length, along edges inside.
static void grade(refinement *r, double finest, double growth)
{
    triangulation *plane = r->plane;
    int32_t p;
    for (p = 0; p < plane->point_count; p++)
        if (plane->twin[p] == p) wait_in(&r->waiting, p, (int)(4 * log2(r->size[p] / finest)));
    while ((p = next_waiting(&r->waiting)) != NONE_WAITING) {
        int32_t s = 4 * plane->star[p];
        while (plane->corner[s] != p) s++;
        int32_t first = s;
        do {
            int32_t q = plane->corner[next_side(s)];
            bool inner = r->inside[s >> 2] || r->inside[plane->beside[last_side(s)] >> 2];
            if (inner) {
                double most = r->size[p] + growth * sqrt(squared_length(r, p, q));
                if (r->size[q] > most) {
                    r->size[q] = most;
                    wait_in(&r->waiting, q, (int)(4 * log2(most / finest)));
                }
            }
            s = next_side(plane->beside[next_side(s)]);
        } while (s != first);
    }
}

jali_status refine_sizes(jali_context *ctx, refinement *r, double across, double finest, double coarsest,
                         double growth)
{
    jali_status status;
    const triangulation *plane = r->plane;
    TRY(split_to_gaps(ctx, r, across * finest));
    TRY(step(ctx, "mesh", 0.2));
    for (int32_t p = 0; p < plane->point_count; p++) r->size[p] = MIN(MAX(r->size[p], finest), coarsest);
    for (int32_t t = 0; t < plane->triangle_count; t++) {
        if (!r->inside[t]) continue;
        double size = MIN(MAX(width_at(r, t) / across, finest), coarsest);
        for (int k = 0; k < 3; k++) {
            double *at = &r->size[plane->corner[4 * t + k]];
            *at = MIN(*at, size);
        }
    }
    grade(r, finest, growth);
done:
    return status;
}
