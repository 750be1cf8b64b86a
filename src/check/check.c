// Check: is a mesh a solid?
//
// Weld equal places, count on whole numbers what the triangles share (mesh/topology), put the vertices on an
// exact lattice and test every pair of triangles whose boxes touch (mesh/intersect), see how the shells lie
// in each other (mesh/nesting). No tolerance: a mesh passes when it is right, not when it is nearly so.
//
// Limits:  coordinates that span more than 60 bits are rounded to 60 (the report says so).
// Checked: tests/test_check.c; admesh and PrusaSlicer agree on the meshes of the test data.
#include <jali/check.h>

#include "check/walls.h"
#include "mesh/nesting.h"

#include <math.h>

jali_check_options jali_check_defaults(void)
{
    return (jali_check_options){0};
}

static void midpoint_mm(const jali_mesh *mesh, const int32_t *vertex, int32_t count, double at_mm[3])
{
    for (int k = 0; k < 3; k++) {
        at_mm[k] = 0;
        for (int32_t i = 0; i < count; i++) at_mm[k] += mesh->vertex[vertex[i]][k] / count;
    }
}

static jali_finding found_at_vertices(const jali_mesh *mesh, const finding *f)
{
    jali_finding result = {.count = f->count};
    if (f->count) midpoint_mm(mesh, (const int32_t[2]){f->a, f->b}, 2, result.at_mm);
    return result;
}

static jali_finding found_at_triangle(const jali_mesh *mesh, const finding *f)
{
    jali_finding result = {.count = f->count};
    if (f->count) midpoint_mm(mesh, mesh->triangle[f->a], 3, result.at_mm);
    return result;
}

// The middle of what the boxes of both triangles share: within a triangle's size of where they meet.
static jali_finding found_at_pair(const jali_mesh *mesh, const finding *f)
{
    jali_finding result = {.count = f->count};
    for (int k = 0; k < 3 && f->count; k++) {
        double low = -INFINITY, high = INFINITY;
        for (int i = 0; i < 2; i++) {
            const int32_t *t = mesh->triangle[i ? f->b : f->a];
            double x = mesh->vertex[t[0]][k], y = mesh->vertex[t[1]][k], z = mesh->vertex[t[2]][k];
            low = MAX(low, MIN(x, MIN(y, z)));
            high = MIN(high, MAX(x, MAX(y, z)));
        }
        result.at_mm[k] = 0.5 * (low + high);
    }
    return result;
}

static void measure_bounds(const jali_mesh *mesh, jali_check_report *r)
{
    for (int k = 0; k < 3 && mesh->vertex_count; k++) {
        r->low_mm[k] = r->high_mm[k] = mesh->vertex[0][k];
        for (int32_t i = 1; i < mesh->vertex_count; i++) {
            r->low_mm[k] = MIN(r->low_mm[k], mesh->vertex[i][k]);
            r->high_mm[k] = MAX(r->high_mm[k], mesh->vertex[i][k]);
        }
    }
}

// Areas and volumes about the corner of the bounding box, so that a far-away model loses no digits.
static void measure(const jali_mesh *mesh, const topology *t, double *shell_volume_mm3, jali_check_report *r)
{
    measure_bounds(mesh, r);
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        double p[3][3], u[3], v[3], n[3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) p[c][k] = mesh->vertex[mesh->triangle[i][c]][k] - r->low_mm[k];
        for (int k = 0; k < 3; k++) {
            u[k] = p[1][k] - p[0][k];
            v[k] = p[2][k] - p[0][k];
        }
        for (int k = 0; k < 3; k++) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        double volume =
            n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]; // six times; exact on small lattices
        r->area_mm2 += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        r->volume_mm3 += volume;
        if (t->shell[i] >= 0) shell_volume_mm3[t->shell[i]] += volume / 6;
    }
    r->area_mm2 /= 2;
    r->volume_mm3 /= 6;
}

// A body faces outwards where nothing encloses it; a void faces inwards where one body does.
static void judge_shells(const jali_mesh *mesh, const topology *t, const double *volume_mm3,
                         const int32_t *winding, jali_check_report *r)
{
    r->shells = t->shell_count;
    int32_t seen = 0;
    for (int32_t i = 0; i < mesh->triangle_count && seen < t->shell_count; i++) {
        if (t->shell[i] < seen) continue;
        int32_t shell = seen++;
        if (t->flawed[shell]) continue;
        bool body = volume_mm3[shell] > 0 && winding[shell] == 0;
        bool hollow = volume_mm3[shell] < 0 && winding[shell] == 1;
        r->voids += hollow;
        if (!body && !hollow && r->misplaced_shells.count++ == 0)
            midpoint_mm(mesh, mesh->triangle[i], 3, r->misplaced_shells.at_mm);
    }
    r->pieces = r->shells - r->voids;
}

static void report_topology(const jali_mesh *mesh, const topology *t, jali_check_report *r)
{
    r->edges = t->edge_count;
    r->euler = (int64_t)t->used_vertex_count - t->edge_count + t->used_triangle_count;
    r->open_edges = found_at_vertices(mesh, &t->open_edges);
    r->crowded_edges = found_at_vertices(mesh, &t->crowded_edges);
    r->crowded_vertices = found_at_vertices(mesh, &t->crowded_vertices);
    r->misdirected_edges = found_at_vertices(mesh, &t->misdirected_edges);
    r->repeated_triangles = found_at_triangle(mesh, &t->repeated_triangles);
}

static void conclude(jali_check_report *r)
{
    r->closed = r->open_edges.count == 0;
    r->manifold = !r->crowded_edges.count && !r->crowded_vertices.count && !r->repeated_triangles.count;
    r->oriented = !r->misdirected_edges.count && !r->misplaced_shells.count;
    r->clean = r->degenerate_triangles.count == 0;
    r->apart = r->intersections.count == 0;
    r->solid = r->closed && r->manifold && r->oriented && r->clean && r->apart && r->triangles > 0;
    r->genus = r->closed && r->manifold ? r->shells - r->euler / 2 : -1;
}

static jali_status weld(jali_context *ctx, const jali_mesh *mesh, int32_t (*triangle)[3],
                        jali_check_report *r)
{
    jali_status status;
    int32_t *first = NULL, places;
    TRY(ALLOCATE(ctx, first, mesh->vertex_count));
    TRY(weld_points(ctx, mesh->vertex_count, (const double(*)[3])mesh->vertex, first, &places));
    r->repeated_vertices = mesh->vertex_count - places;
    for (int32_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) triangle[i][k] = first[mesh->triangle[i][k]];
done:
    release(ctx, first);
    return status;
}

jali_status jali_check(jali_context *ctx, const jali_mesh *mesh, const jali_check_options *given,
                       jali_check_report *report)
{
    jali_status status;
    jali_check_options opt = given ? *given : jali_check_defaults();
    jali_check_report r = {.vertices = mesh->vertex_count, .triangles = mesh->triangle_count};
    int32_t(*triangle)[3] = NULL, *winding = NULL;
    double *volume_mm3 = NULL;
    topology t = {0};
    lattice l = {0};
    exact_surface s = {0};
    finding crossings = {0};
    *report = (jali_check_report){0};

    TRY(step(ctx, "check", 0));
    TRY(mesh_validate(ctx, mesh));
    TRY(ALLOCATE(ctx, triangle, mesh->triangle_count));
    TRY(weld(ctx, mesh, triangle, &r));
    const int32_t(*welded)[3] = (const int32_t(*)[3])triangle;
    TRY(topology_create(ctx, mesh->vertex_count, mesh->triangle_count, welded, &t));
    report_topology(mesh, &t, &r);

    TRY(ALLOCATE_CLEARED(ctx, volume_mm3, t.shell_count));
    TRY(ALLOCATE(ctx, winding, t.shell_count));
    measure(mesh, &t, volume_mm3, &r);

    TRY(lattice_create(ctx, mesh->vertex_count, (const double(*)[3])mesh->vertex, &l));
    r.unit_log2 = l.unit_log2;
    r.coordinates_exact = l.exact;
    TRY(exact_surface_create(ctx, &l, mesh->triangle_count, welded, &s));
    r.degenerate_triangles = found_at_triangle(mesh, &s.flat_triangles);
    shell_windings(&s, &t, winding);
    judge_shells(mesh, &t, volume_mm3, winding, &r);

    r.intersections_skipped = opt.skip_intersections;
    if (!opt.skip_intersections) TRY(count_intersections(ctx, &s, NULL, &crossings, &r.intersections_capped));
    r.intersections = found_at_pair(mesh, &crossings);
    conclude(&r);
    if (opt.walls && r.closed && r.oriented && r.triangles > 0)
        TRY(measure_walls(ctx, mesh, &r.walls, &r.gaps));
    *report = r;
done:
    exact_surface_free(ctx, &s);
    lattice_free(ctx, &l);
    topology_free(ctx, &t);
    release(ctx, volume_mm3);
    release(ctx, winding);
    release(ctx, triangle);
    return status;
}
