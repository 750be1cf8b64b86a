// The inner skin.
//
// A first guess of the wall's thickness at each vertex (how far the next skin is behind it, how soon edges
// shrink to nothing); then test and thin where a test fails, until none does: prisms first, which is cheap,
// then intersections of both skins and the walls along rims. The thickness is graded: it changes by at most
// half a mm a mm along the surface.
//
// A prism is linear from skin to skin: at height s its cross-section is the triangle of the blended corners,
// and a point within moves along a blend of the corners' ways. It turns over nowhere when (normal of the
// cross-section) . way > 0 for all s and the three ways; the normal is quadratic in s, so three Bernstein
// coefficients by three ways decide.
//
// Limits:  vertices and triangles are those of the surface, so a corner where walls, slopes and slits meet
//          in more ways than one vertex can go is reported as unsolved. The hollow between two walls may be
//          narrow.
// Checked: tests/test_offset.c.
#include "mesh/offset.h"
#include "mesh/intersect.h"
#include "mesh/offset_fill.h"
#include "mesh/offset_ways.h"
#include "base/vector.h"

#include <math.h>

enum { FOLD_ROUNDS = 40, MEET_ROUNDS = 30, FULL_ROUNDS = 5, FULL_SWEEPS = 8, GRADE_SWEEPS = 200 };

static const double steepest = 0.5;    // change of the thickness along the surface
static const double less = 0.8;        // what a failed test leaves of it
static const double open_share = 0.45; // of the way to the next skin behind
static const double dimple = 0.125;    // of the least wall: in a point, over what is finer than the wall

typedef struct offsetting {
    jali_context *ctx;
    const jali_mesh *mesh;
    const offset_options *opt;
    topology_marks marks;
    double (*way)[3]; // [vertex_count] inwards is -way
    float *kept;      // [vertex_count] share of the thickness that the way keeps
    double *wall;     // [vertex_count] thickness
    bool *failed;     // [vertex_count]
    bool *frail;      // [vertex_count] corner of a frail triangle; NULL: there are none
    bool *met;        // [all triangles] of both skins and the rims' walls
    bool *full;       // [triangle_count] left full; NULL: none is
    int32_t sweeps;   // of the membrane
    bool *free;       // [vertex_count] within those: the membrane says where they are
    bool *own;        // [triangle_count] triangles of the surface that meet each other; NULL: none do
    double (*inner)[3];
    // Both skins and the walls along rims: inner vertices and triangles come behind the outer ones.
    double (*vertex)[3];    // [2 vertex_count]
    int32_t (*triangle)[3]; // [2 triangle_count + 2 rim sides]
    int32_t all_triangles;
} offsetting;

static void add_cross(const double u[3], const double v[3], double share, double sum[3])
{
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        sum[k] += share * (u[i] * v[j] - u[j] * v[i]);
    }
}

// ---- the first guess ----

static float below(double value)
{
    return nextafterf((float)value, -INFINITY);
}

static float above(double value)
{
    return nextafterf((float)value, INFINITY);
}

static jali_status create_boxes(offsetting *o, box_tree *tree)
{
    const jali_mesh *mesh = o->mesh;
    box *boxes;
    jali_status status = ALLOCATE(o->ctx, boxes, mesh->triangle_count);
    if (status != JALI_OK) return status;
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            double x = mesh->vertex[mesh->triangle[t][0]][k], y = mesh->vertex[mesh->triangle[t][1]][k];
            double z = mesh->vertex[mesh->triangle[t][2]][k];
            boxes[t].low[k] = below(MIN(x, MIN(y, z)));
            boxes[t].high[k] = above(MAX(x, MAX(y, z)));
        }
    status = box_tree_create(o->ctx, mesh->triangle_count, boxes, tree);
    release(o->ctx, boxes);
    return status;
}

// How far along `ray` does it leave through the triangle from inside? INFINITY when it does not.
static double leaves_through(const jali_mesh *mesh, int32_t t, const double from[3], const double ray[3])
{
    double corner[3][3], n[3] = {0}, u[3], v[3];
    for (int c = 0; c < 3; c++) subtract(mesh->vertex[mesh->triangle[t][c]], from, corner[c]);
    subtract(corner[1], corner[0], u);
    subtract(corner[2], corner[0], v);
    add_cross(u, v, 1, n);
    double along = dot(n, ray);
    if (along <= 0) return INFINITY;
    for (int c = 0; c < 3; c++) {
        double side[3] = {0};
        add_cross(corner[c], corner[(c + 1) % 3], 1, side);
        if (dot(side, ray) < 0) return INFINITY;
    }
    return dot(n, corner[0]) / along;
}

static double next_skin(const offsetting *o, const box_tree *tree, int32_t vertex, double reach)
{
    const jali_mesh *mesh = o->mesh;
    const double *from = mesh->vertex[vertex];
    double ray[3], nearest = reach;
    box b;
    for (int k = 0; k < 3; k++) {
        ray[k] = -o->way[vertex][k];
        b.low[k] = below(MIN(from[k], from[k] + reach * ray[k]));
        b.high[k] = above(MAX(from[k], from[k] + reach * ray[k]));
    }
    box_walk walk = box_walk_start(tree, &b, 0);
    for (int32_t place; (place = box_walk_next(&walk)) >= 0;) {
        int32_t t = tree->item[place];
        const int32_t *c = mesh->triangle[t];
        if (c[0] == vertex || c[1] == vertex || c[2] == vertex) continue;
        double far = leaves_through(mesh, t, from, ray);
        if (far > 0) nearest = MIN(nearest, far);
    }
    return nearest;
}

// Edges of the inner skin are to keep their direction.
static void limit_by_edges(offsetting *o)
{
    static const double shrink = 0.95;
    const jali_mesh *mesh = o->mesh;
    for (int32_t side = 0; side < 3 * mesh->triangle_count; side++) {
        int32_t a = mesh->triangle[side / 3][side % 3], b = mesh->triangle[side / 3][(side + 1) % 3];
        double edge[3], parting[3];
        subtract(mesh->vertex[b], mesh->vertex[a], edge);
        subtract(o->way[b], o->way[a], parting);
        double closing = dot(edge, parting);
        if (closing <= 0) continue;
        double most = MAX(shrink * dot(edge, edge) / closing, o->opt->least_mm);
        o->wall[a] = MIN(o->wall[a], most);
        o->wall[b] = MIN(o->wall[b], most);
    }
}

static jali_status first_guess(offsetting *o)
{
    jali_status status;
    const jali_mesh *mesh = o->mesh;
    double reach = o->opt->thickness_mm / open_share;
    box_tree tree = {0};
    TRY(create_boxes(o, &tree));
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (v % 4096 == 0) TRY(step(o->ctx, "offset", 0.2 * v / mesh->vertex_count));
        double wall = open_share * next_skin(o, &tree, v, reach);
        o->wall[v] = MAX(MIN(wall, o->opt->thickness_mm), o->opt->least_mm);
    }
    limit_by_edges(o);
done:
    box_tree_free(o->ctx, &tree);
    return status;
}

// ---- thinning ----

// No vertex is thicker than its neighbours allow. Sweeps alternate, so that most of it is done by the first
// two.
static void grade(offsetting *o)
{
    const jali_mesh *mesh = o->mesh;
    int32_t last = 3 * mesh->triangle_count - 1;
    bool changed = true;
    for (int32_t sweep = 0; sweep < GRADE_SWEEPS && changed; sweep++) {
        changed = false;
        for (int32_t i = 0; i <= last; i++) {
            int32_t side = sweep % 2 ? last - i : i;
            int32_t a = mesh->triangle[side / 3][side % 3], b = mesh->triangle[side / 3][(side + 1) % 3];
            if (fabs(o->wall[a] - o->wall[b]) < 1e-3 * o->opt->least_mm) continue;
            double edge[3];
            subtract(mesh->vertex[b], mesh->vertex[a], edge);
            double rise = steepest * sqrt(dot(edge, edge)) + 1e-3 * o->opt->least_mm;
            if (o->wall[a] > o->wall[b] + rise) {
                o->wall[a] = o->wall[b] + rise;
                changed = true;
            } else if (o->wall[b] > o->wall[a] + rise) {
                o->wall[b] = o->wall[a] + rise;
                changed = true;
            }
        }
    }
}

static void place_inner(offsetting *o)
{
    double unit = o->opt->unit_mm;
    for (int32_t v = 0; v < o->mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++)
            o->inner[v][k] = rint((o->mesh->vertex[v][k] - o->wall[v] * o->way[v][k]) / unit) * unit + 0.0;
}

// Thin the walls of vertices that failed, down to `least_mm`; false when none of them can be thinner.
static bool thin(offsetting *o, double least_mm)
{
    bool thinner = false;
    for (int32_t v = 0; v < o->mesh->vertex_count; v++) {
        if (!o->failed[v]) continue;
        double least = o->frail && o->frail[v] ? MIN(least_mm, dimple * o->opt->least_mm) : least_mm;
        o->failed[v] = false;
        if (o->wall[v] <= least || (o->free && o->free[v])) continue;
        o->wall[v] = MAX(less * o->wall[v], least);
        thinner = true;
    }
    if (thinner) grade(o);
    place_inner(o);
    return thinner;
}

// ---- prisms ----

static bool prism_stands(const offsetting *o, int32_t t)
{
    static const double margin = 1e-4; // of the outer triangle's area times the way's length
    const int32_t *v = o->mesh->triangle[t];
    double outer[2][3], inner[2][3], across[3][3] = {{0}};
    for (int k = 0; k < 2; k++) {
        subtract(o->mesh->vertex[v[k + 1]], o->mesh->vertex[v[0]], outer[k]);
        subtract(o->inner[v[k + 1]], o->inner[v[0]], inner[k]);
    }
    add_cross(outer[0], outer[1], 1, across[0]);
    add_cross(outer[0], inner[1], 0.5, across[1]);
    add_cross(inner[0], outer[1], 0.5, across[1]);
    add_cross(inner[0], inner[1], 1, across[2]);
    double area = sqrt(dot(across[0], across[0]));
    for (int c = 0; c < 3; c++) {
        double way[3];
        subtract(o->mesh->vertex[v[c]], o->inner[v[c]], way);
        double least = margin * area * sqrt(dot(way, way));
        for (int k = 0; k < 3; k++)
            if (dot(across[k], way) <= least) return false;
    }
    return true;
}

static bool is_own(const offsetting *o, int32_t t)
{
    return o->own && o->own[t];
}

static bool is_full(const offsetting *o, int32_t t)
{
    return o->full && o->full[t];
}

// Mark the corners of prisms that turn over; how many do.
static int32_t find_folds(offsetting *o, int32_t *one)
{
    int32_t count = 0;
    for (int32_t t = 0; t < o->mesh->triangle_count; t++) {
        if (is_own(o, t) || is_full(o, t) || prism_stands(o, t)) continue;
        if (count++ == 0) *one = t;
        for (int c = 0; c < 3; c++) o->failed[o->mesh->triangle[t][c]] = true;
    }
    return count;
}

static jali_status unfold(offsetting *o, int32_t *folds, int32_t *one)
{
    jali_status status = JALI_OK;
    for (int32_t round = 0;; round++) {
        TRY(step(o->ctx, "offset", 0.2 + 0.2 * round / FOLD_ROUNDS));
        *folds = find_folds(o, one);
        if (*folds == 0 || round == FOLD_ROUNDS || !thin(o, dimple * o->opt->least_mm)) break;
    }
    memset(o->failed, 0, (size_t)o->mesh->vertex_count * sizeof *o->failed);
done:
    return status;
}

// ---- skins and walls ----

static jali_status create_skins(offsetting *o)
{
    jali_status status;
    const jali_mesh *mesh = o->mesh;
    int32_t count = mesh->vertex_count, triangles = mesh->triangle_count, next = 2 * triangles;
    size_t rims = 0;
    for (int32_t side = 0; side < 3 * triangles; side++) rims += o->marks.twin[side] == TWIN_OPEN;
    if (2 * (size_t)triangles + 2 * rims > INT32_MAX / 3 || 2 * (int64_t)count > INT32_MAX)
        TRY(fail(o->ctx, JALI_LIMIT, "the surface has too many triangles for an inner skin"));
    TRY(ALLOCATE(o->ctx, o->vertex, 2 * (size_t)count));
    TRY(ALLOCATE(o->ctx, o->triangle, 2 * (size_t)triangles + 2 * rims));
    memcpy(o->vertex, mesh->vertex, (size_t)count * sizeof *o->vertex);
    o->inner = o->vertex + count;
    for (int32_t side = 0; side < 3 * triangles; side++) {
        int32_t t = side / 3, a = mesh->triangle[t][side % 3], b = mesh->triangle[t][(side + 1) % 3];
        o->triangle[t][side % 3] = a;
        o->triangle[triangles + t][2 - side % 3] = a + count;
        if (o->marks.twin[side] != TWIN_OPEN) continue;
        // From the outer a to the inner b, as the stage carve cuts its walls.
        memcpy(o->triangle[next++], (int32_t[3]){a + count, b + count, a}, sizeof *o->triangle);
        memcpy(o->triangle[next++], (int32_t[3]){a, b + count, b}, sizeof *o->triangle);
    }
    o->all_triangles = next;
    TRY(ALLOCATE(o->ctx, o->met, next));
done:
    return status;
}

// Set `met` for the triangles among the first `count` that meet another of them.
static jali_status find_meetings(offsetting *o, int32_t vertices, int32_t triangles, bool *met)
{
    jali_status status;
    lattice l = {0};
    exact_surface s = {0};
    finding found;
    bool capped;
    memset(met, 0, (size_t)triangles * sizeof *met);
    TRY(lattice_create(o->ctx, vertices, (const double(*)[3])o->vertex, &l));
    TRY(exact_surface_create(o->ctx, &l, triangles, (const int32_t(*)[3])o->triangle, &s));
    TRY(count_intersections(o->ctx, &s, met, &found, &capped));
done:
    exact_surface_free(o->ctx, &s);
    lattice_free(o->ctx, &l);
    return status;
}

// What meets among the triangles of the surface itself is not for the wall to mend.
static jali_status find_own(offsetting *o)
{
    jali_status status = JALI_OK;
    bool any = false;
    for (int32_t t = 0; t < o->mesh->triangle_count; t++) any |= o->met[t];
    if (!any || o->own) goto done;
    TRY(ALLOCATE(o->ctx, o->own, o->mesh->triangle_count));
    TRY(find_meetings(o, o->mesh->vertex_count, o->mesh->triangle_count, o->own));
done:
    return status;
}

// Mark the vertices of inner triangles and walls that meet something; how many such triangles there are.
static int32_t mark_meetings(offsetting *o, int32_t *one)
{
    int32_t count = 0, triangles = o->mesh->triangle_count, vertices = o->mesh->vertex_count;
    for (int32_t i = triangles; i < o->all_triangles; i++) {
        if (!o->met[i] || (i < 2 * triangles && is_own(o, i - triangles))) continue;
        if (count++ == 0 && i < 2 * triangles) *one = i - triangles;
        for (int c = 0; c < 3; c++) o->failed[o->triangle[i][c] % vertices] = true;
    }
    return count;
}

static jali_status part_skins(offsetting *o, offset_report *report)
{
    jali_status status = JALI_OK;
    for (int32_t round = 0;; round++) {
        int32_t folds = 0, one = -1;
        TRY(unfold(o, &folds, &one));
        TRY(step(o->ctx, "offset", 0.4 + 0.6 * round / MEET_ROUNDS));
        if (o->full)
            TRY(span_full(o->ctx, o->mesh, o->marks.twin, o->full, o->opt->unit_mm, o->sweeps, o->free,
                          o->inner));
        TRY(find_meetings(o, 2 * o->mesh->vertex_count, o->all_triangles, o->met));
        if (round == 0) TRY(find_own(o));
        int32_t meetings = mark_meetings(o, &one);
        report->rounds = round + 1;
        report->unsolved_triangles = folds + meetings;
        report->unsolved = one;
        if (meetings == 0 || round == MEET_ROUNDS || !thin(o, o->opt->least_mm)) break;
    }
done:
    return status;
}

// The triangles that are still in the way, and those around them.
static jali_status add_full(offsetting *o, int32_t rings)
{
    int32_t count = o->mesh->triangle_count;
    for (int32_t t = 0; t < count; t++) {
        bool bad = !is_full(o, t) && !prism_stands(o, t);
        o->full[t] |= !is_own(o, t) && (bad || o->met[count + t]);
    }
    return grow_full(o->ctx, o->mesh, rings, o->full);
}

// Where the least wall folds or meets a skin too, the wall is left full, farther around with each round; the
// rest begins again with the first guess.
static jali_status leave_full(offsetting *o, offset_report *report)
{
    jali_status status = JALI_OK;
    if (report->unsolved_triangles == 0) goto done;
    TRY(ALLOCATE_CLEARED(o->ctx, o->full, o->mesh->triangle_count));
    TRY(ALLOCATE_CLEARED(o->ctx, o->free, o->mesh->vertex_count));
    for (int32_t round = 0; round < FULL_ROUNDS && report->unsolved_triangles > 0; round++) {
        TRY(add_full(o, round + 1));
        o->sweeps = FULL_SWEEPS << 2 * round;
        TRY(first_guess(o));
        grade(o);
        place_inner(o);
        TRY(part_skins(o, report));
    }
    for (int32_t t = 0; t < o->mesh->triangle_count; t++)
        if (o->full[t] && report->full_triangles++ == 0) report->full = t;
done:
    return status;
}

static jali_status find_frail(offsetting *o)
{
    if (!o->opt->frail) return JALI_OK;
    jali_status status = ALLOCATE_CLEARED(o->ctx, o->frail, o->mesh->vertex_count);
    for (int32_t i = 0; status == JALI_OK && i < 3 * o->mesh->triangle_count; i++)
        o->frail[o->mesh->triangle[i / 3][i % 3]] |= o->opt->frail[i / 3];
    return status;
}

static void measure(const offsetting *o, float *thickness, offset_report *report)
{
    report->thinnest = -1;
    for (int32_t v = 0; v < o->mesh->vertex_count; v++) {
        double wall = o->wall[v] * o->kept[v];
        if (o->free && o->free[v]) continue; // thicker than anything
        if (thickness) thickness[v] = (float)wall;
        report->thinned += o->wall[v] < o->opt->thickness_mm;
        if (report->thinnest >= 0 && wall >= report->thinnest_mm) continue;
        report->thinnest = v;
        report->thinnest_mm = wall;
    }
}

jali_status offset_inward(jali_context *ctx, const jali_mesh *mesh, const offset_options *opt,
                          double (*inner)[3], float *thickness, bool *full, offset_report *report)
{
    jali_status status;
    offsetting o = {.ctx = ctx, .mesh = mesh, .opt = opt};
    topology t = {0};
    *report = (offset_report){.thinnest = -1, .unsolved = -1, .full = -1};
    TRY(ALLOCATE(ctx, o.marks.twin, 3 * (size_t)mesh->triangle_count));
    TRY(ALLOCATE(ctx, o.marks.crowded, mesh->vertex_count));
    TRY(ALLOCATE(ctx, o.way, mesh->vertex_count));
    TRY(ALLOCATE(ctx, o.kept, mesh->vertex_count));
    TRY(ALLOCATE(ctx, o.wall, mesh->vertex_count));
    TRY(ALLOCATE_CLEARED(ctx, o.failed, mesh->vertex_count));
    TRY(topology_mark(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                      &o.marks, &t));
    TRY(find_frail(&o));
    TRY(create_skins(&o));
    TRY(offset_ways(ctx, mesh, o.marks.twin, o.way, o.kept));
    TRY(first_guess(&o));
    grade(&o);
    place_inner(&o);
    TRY(part_skins(&o, report));
    TRY(leave_full(&o, report));
    if (full) memset(full, 0, (size_t)mesh->triangle_count * sizeof *full);
    if (full && o.full) memcpy(full, o.full, (size_t)mesh->triangle_count * sizeof *full);
    memcpy(inner, o.inner, (size_t)mesh->vertex_count * sizeof *inner);
    measure(&o, thickness, report);
done:
    topology_free(ctx, &t);
    release(ctx, o.marks.twin);
    release(ctx, o.marks.crowded);
    release(ctx, o.way);
    release(ctx, o.kept);
    release(ctx, o.wall);
    release(ctx, o.failed);
    release(ctx, o.frail);
    release(ctx, o.full);
    release(ctx, o.free);
    release(ctx, o.met);
    release(ctx, o.own);
    release(ctx, o.vertex);
    release(ctx, o.triangle);
    return status;
}
