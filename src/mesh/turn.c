// Turning a profile.
//
// A surface of revolution is a list of rings, from the middle of the floor outwards and then up the profile.
// The strip between two rings is sewn in the order of the angles, so that rings may differ in how many facets
// they have and a pole is a ring of one vertex.
//
// Checked: tests/test_surface.c: closed or with the right rims, sizes, sagitta, shapes of triangles, uv.
#include "mesh/turn.h"
#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>

enum { FACET_STEP = 16 };

typedef struct ring {
    double radius_mm, height_mm, along_mm; // along the profile, from the base; NaN within the floor
    int32_t facets;                        // vertices of the ring; 1 = a pole
    int32_t first;                         // its first vertex, at the back
} ring;

typedef struct lathe {
    const turned *t;
    double widest_mm;
    int32_t facets; // around the widest place
    bool floor;
    ring *ring; // [ring_count]
    int32_t ring_count;
} lathe;

double widest_mm(const profile *p)
{
    double widest = 0;
    for (int32_t i = 0; i < p->point_count; i++) widest = MAX(widest, p->point[i].radius_mm);
    return widest;
}

static int32_t facets_for(double radius_mm, double tolerance_mm)
{
    double half_angle = acos(MAX(1 - tolerance_mm / radius_mm, 0));
    double facets = MIN(ceil(M_PI / half_angle / FACET_STEP) * FACET_STEP, MOST_FACETS);
    return MAX((int32_t)facets, FACET_STEP);
}

// A ring of a quarter of the radius keeps the tolerance with half the facets.
static int32_t facets_at(const lathe *l, double radius_mm)
{
    int32_t facets = l->facets;
    for (double r = l->widest_mm / 4; radius_mm <= r && facets % 2 == 0 && facets > LEAST_FACETS; r /= 4)
        facets /= 2;
    return radius_mm > 0 ? facets : 1;
}

static void add_ring(lathe *l, double radius_mm, double height_mm, double along_mm, int32_t facets)
{
    l->ring[l->ring_count++] =
        (ring){.radius_mm = radius_mm, .height_mm = height_mm, .along_mm = along_mm, .facets = facets};
}

// Rings of a flat disc from its middle outwards. Facets are halved as the rings get smaller, and the rows
// with them; what is too small to halve again is a fan.
static void add_floor(lathe *l, int32_t facets)
{
    const profile_point *base = &l->t->curve.point[0];
    double widest = 2 * M_PI * base->radius_mm / facets, radius = base->radius_mm;
    while (facets > LEAST_FACETS && facets % 2 == 0) {
        double width = 2 * M_PI * radius / facets;
        radius -= longest_facets * width;
        if (radius < 2 * width) break;
        if (4 * M_PI * radius / facets <= 1.5 * widest) facets /= 2;
        add_ring(l, radius, base->height_mm, NAN, facets);
    }
    add_ring(l, 0, base->height_mm, NAN, 1);
    for (int32_t i = 0, j = l->ring_count - 1; i < j; i++, j--) {
        ring swap = l->ring[i];
        l->ring[i] = l->ring[j];
        l->ring[j] = swap;
    }
}

static jali_status make_rings(jali_context *ctx, lathe *l)
{
    jali_status status;
    int32_t *row = NULL, rows;
    double at[2];
    const profile_point *point = l->t->curve.point;
    double longest_mm = longest_facets * 2 * M_PI * l->widest_mm / l->facets;
    TRY(profile_rows(ctx, &l->t->curve, l->t->tolerance_mm, longest_mm, &row, &rows));
    if (profile_crosses(&l->t->curve, row, rows, l->floor, at))
        TRY(fail(ctx, JALI_BAD_VALUE, "%s: the profile crosses itself%s near radius %.4g, height %.4g mm",
                 l->t->name, l->floor ? " or its floor" : "", at[0], at[1]));
    // A floor has fewer rings than facets: each is 10 pi / facets closer to the middle, and at half of the
    // radius they are half as many.
    TRY(ALLOCATE(ctx, l->ring, (size_t)rows + (size_t)l->facets));
    if (l->floor) add_floor(l, facets_at(l, point[0].radius_mm));
    for (int32_t i = 0; i < rows; i++) {
        const profile_point *p = &point[row[i]];
        add_ring(l, p->radius_mm, p->height_mm, p->along_mm, facets_at(l, p->radius_mm));
    }
done:
    release(ctx, row);
    return status;
}

// ---- vertices ----

// The angle of a place that is `part` of the way around from the back, counted from the front.
static double angle_at(double part)
{
    return 2 * M_PI * (part - 0.5);
}

static void place_ring(const ring *r, jali_mesh *mesh)
{
    for (int32_t i = 0; i < r->facets; i++) {
        // Quarters by reflection, so that left and right, front and back are the same.
        int32_t twice = 2 * i - r->facets, n = r->facets; // angle = pi twice / n, -pi .. pi
        int32_t folded = abs(twice), sign = twice < 0 ? -1 : 1;
        bool behind = 2 * folded > n;
        if (behind) folded = n - folded;
        double angle = M_PI * folded / n;
        double *v = mesh->vertex[r->first + i];
        v[0] = sign * r->radius_mm * sin(angle);
        v[1] = (behind ? 1 : -1) * r->radius_mm * cos(angle);
        v[2] = r->height_mm;
        if (2 * folded == n) v[1] = 0;
    }
}

static void unroll(const lathe *l, const ring *r, double part, double uv[2])
{
    double angle = angle_at(part);
    if (isnan(r->along_mm)) {
        uv[0] = uv[1] = NAN;
    } else if (l->t->sector == 0) {
        uv[0] = angle * l->widest_mm;
        uv[1] = r->along_mm;
    } else {
        // From the apex; upright on the front's line, whichever end the apex is at.
        double apex = l->t->cone_base_mm - r->along_mm, half = sin(0.5 * angle * l->t->sector);
        uv[0] = fabs(apex) * sin(angle * l->t->sector);
        uv[1] = r->along_mm + apex * 2 * half * half;
    }
}

// ---- strips ----

typedef struct sewing {
    const lathe *l;
    jali_surface *surface;
    int32_t next; // triangle
} sewing;

// Corner: `step` of ring r, and how far around it is.
typedef struct stitch {
    const ring *r;
    int32_t step;
    double part;
} stitch;

static stitch stitch_at(const ring *r, int32_t step, double pole_part)
{
    return (stitch){r, step, r->facets == 1 ? pole_part : (double)step / r->facets};
}

static void sew(sewing *s, const stitch corner[3])
{
    int32_t n = s->next++;
    bool outside = true;
    for (int k = 0; k < 3; k++) {
        const ring *r = corner[k].r;
        s->surface->mesh.triangle[n][k] = r->first + corner[k].step % r->facets;
        outside &= !isnan(r->along_mm);
    }
    for (int k = 0; k < 3; k++) {
        double *uv = s->surface->uv[n][k];
        unroll(s->l, corner[k].r, corner[k].part, uv);
        if (!outside) uv[0] = uv[1] = NAN;
    }
}

// From the back to the right, the next triangle stands on the ring whose next facet has its middle first.
static void sew_strip(sewing *s, const ring *low, const ring *high)
{
    int32_t i = 0, j = 0, n = low->facets, m = high->facets;
    int32_t end_i = n > 1 ? n : 0, end_j = m > 1 ? m : 0;
    while (i < end_i || j < end_j) {
        bool on_low = j == end_j || (i < end_i && (int64_t)(2 * i + 1) * m <= (int64_t)(2 * j + 1) * n);
        double middle = on_low ? (i + 0.5) / n : (j + 0.5) / m;
        stitch a = stitch_at(low, i, middle), b = stitch_at(high, j, middle);
        if (on_low)
            sew(s, (stitch[3]){a, stitch_at(low, ++i, middle), b});
        else
            sew(s, (stitch[3]){a, stitch_at(high, ++j, middle), b});
    }
}

static int32_t facets_or_none(const ring *r)
{
    return r->facets > 1 ? r->facets : 0;
}

jali_status surface_allocate(jali_context *ctx, int64_t vertices, int64_t triangles, jali_surface *surface)
{
    jali_status status;
    if (triangles > MOST_TRIANGLES)
        TRY(fail(ctx, JALI_LIMIT,
                 "the surface would have %lld triangles, more than %d; give a larger tolerance",
                 (long long)triangles, MOST_TRIANGLES));
    TRY(mesh_create(ctx, (int32_t)vertices, (int32_t)triangles, &surface->mesh));
    TRY(ALLOCATE(ctx, surface->uv, triangles));
done:
    return status;
}

jali_status turn_profile(jali_context *ctx, const turned *t, jali_surface *surface)
{
    jali_status status;
    int64_t vertices = 0, triangles = 0;
    lathe l = {.t = t, .widest_mm = widest_mm(&t->curve), .facets = t->facets};
    if (l.facets == 0) l.facets = facets_for(l.widest_mm, t->tolerance_mm);
    l.floor = t->floor && t->curve.point[0].radius_mm > 0;
    TRY(make_rings(ctx, &l));
    for (int32_t i = 0; i < l.ring_count; i++) {
        l.ring[i].first = (int32_t)vertices;
        vertices += l.ring[i].facets;
        if (i > 0) triangles += facets_or_none(&l.ring[i - 1]) + facets_or_none(&l.ring[i]);
    }
    TRY(surface_allocate(ctx, vertices, triangles, surface));
    sewing s = {.l = &l, .surface = surface};
    for (int32_t i = 0; i < l.ring_count; i++) {
        place_ring(&l.ring[i], &surface->mesh);
        if (i > 0) sew_strip(&s, &l.ring[i - 1], &l.ring[i]);
    }
    if (t->sector == 0) surface->around_mm = 2 * M_PI * l.widest_mm;
done:
    release(ctx, l.ring);
    return status;
}
