// A mesh made one with itself.
//
// Just in front of a triangle the winding number is w, just behind it w + 1; where it passes from the front
// to the back of another one, w grows by 1. So one number decides for all that hangs together through edges
// and cuts, and that one is counted: the solid angles of all triangles, seen from the largest. What has w = 0
// is the boundary of the union; the rest lies within, or is turned inside out.
//
// Source:  Jacobson, Kavan, Sorkine-Hornung: "Robust inside-outside segmentation using generalized winding
//          numbers" (2013), for surfaces with small holes.
// Differs: no exact constructions: points are rounded, and who rounds looks again. General position comes
// from
//          moving vertices, not from symbols.
// Checked: tests/test_merge.c.
#include "mesh/merge.h"

#include "base/sets.h"
#include "base/vector.h"
#include "mesh/cut.h"
#include "mesh/sides.h"
#include "mesh/slivers.h"
#include "plane/triangulation.h"

#include <math.h>
#include <stdlib.h>

static const double thinnest_share = 1e-3; // of the mesh's size: thinner triangles along the lines go
static const double speck_heights = 30;    // of those: smaller surfaces that were cut off go

void merging_free(jali_context *ctx, merging *m)
{
    jali_mesh_free(ctx, &m->mesh);
    release(ctx, m->uv);
    release(ctx, m->faulty);
    *m = (merging){0};
}

// ---- general position ----

static uint32_t mixed(uint32_t a)
{
    a = (a ^ a >> 16) * 0x7feb352du;
    a = (a ^ a >> 15) * 0x846ca68bu;
    return a ^ a >> 16;
}

static double spread(int32_t vertex, int32_t round, int32_t which)
{
    uint32_t hash = mixed((uint32_t)vertex ^ mixed((uint32_t)(4 * round + which) + 0x9e3779b9u));
    return hash / 4294967296.0;
}

// Vertices of triangles that meet go outwards by 32 to 96 units, twice as far with each round.
static jali_status part(jali_context *ctx, jali_mesh *mesh, const bool *met, double unit_mm, int32_t round)
{
    jali_status status;
    double(*way)[3] = NULL;
    bool *moves = NULL;
    TRY(ALLOCATE_CLEARED(ctx, way, mesh->vertex_count));
    TRY(ALLOCATE_CLEARED(ctx, moves, mesh->vertex_count));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->triangle[t];
        double n[3];
        area_vector(mesh->vertex[v[0]], mesh->vertex[v[1]], mesh->vertex[v[2]], n);
        for (int c = 0; c < 3; c++) {
            moves[v[c]] |= met[t];
            for (int k = 0; k < 3; k++) way[v[c]][k] += n[k];
        }
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        double length = sqrt(dot(way[v], way[v])), far = ldexp(32 + 64 * spread(v, round, 3), round);
        for (int k = 0; k < 3 && moves[v]; k++) {
            double units = ldexp(16 * spread(v, round, k) - 8, round);
            if (length > 0) units += far * way[v][k] / length;
            mesh->vertex[v][k] += rint(units) * unit_mm;
        }
    }
done:
    release(ctx, way);
    release(ctx, moves);
    return status;
}

// ---- what lies in front ----

// A triangle's edge, from its lower to its higher point.
typedef struct edge_side {
    int32_t low, high;
    int32_t side; // 3 triangle + corner it runs from
} edge_side;

typedef struct labelling {
    jali_context *ctx;
    const jali_mesh *whole; // before it was cut
    const crossings *c;
    cut_faces *cut;
    int32_t triangle_count, uncut_count; // the uncut ones first
    int32_t (*triangle)[3];
    int32_t *parent;
    edge_side *side;    // [3 triangle_count] sorted
    int32_t *place;     // [3 triangle_count] of each side in the order
    int32_t *group;     // [3 triangle_count] first place of the same edge
    int32_t *group_end; // [3 triangle_count] by first place
    bool *through;      // by first place: the winding number is known across
    bool *is_cut;       // by first place: it is a piece of a segment
    bool *behind;       // [3 triangle_count] by side: behind the triangle that crosses there
    int32_t *front;     // [triangle_count] the winding number in front
    bool torn;          // the numbers contradict each other
} labelling;

static int compare_sides(const void *left, const void *right)
{
    const edge_side *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return a->side < b->side ? -1 : a->side > b->side;
}

static int compare_pieces(const void *left, const void *right)
{
    const cut_piece *a = left, *b = right;
    int32_t low_a = MIN(a->from, a->to), low_b = MIN(b->from, b->to);
    int32_t high_a = MAX(a->from, a->to), high_b = MAX(b->from, b->to);
    if (low_a != low_b) return low_a < low_b ? -1 : 1;
    return high_a < high_b ? -1 : high_a > high_b;
}

static jali_status gather_triangles(labelling *l, const bool *has_segments)
{
    jali_status status;
    int64_t all = (int64_t)l->whole->triangle_count + l->cut->triangle_count;
    if (all > INT32_MAX / 3) return fail(l->ctx, JALI_LIMIT, "crossing parts have too many triangles");
    TRY(ARENA(l->ctx, l->triangle, all));
    TRY(ARENA(l->ctx, l->parent, all));
    for (int32_t t = 0; t < l->whole->triangle_count; t++) {
        if (has_segments[t]) continue;
        memcpy(l->triangle[l->triangle_count], l->whole->triangle[t], sizeof *l->triangle);
        l->parent[l->triangle_count++] = t;
    }
    l->uncut_count = l->triangle_count;
    for (int32_t t = 0; t < l->cut->triangle_count; t++) {
        memcpy(l->triangle[l->triangle_count], l->cut->triangle[t], sizeof *l->triangle);
        l->parent[l->triangle_count++] = l->cut->parent[t];
    }
done:
    return status;
}

// Of a side on a piece: does its triangle lie behind the other face of the piece's segment?
static bool lies_behind(const labelling *l, int32_t side, const cut_piece *piece)
{
    int32_t t = side / 3, from = l->triangle[t][side % 3];
    bool left = from == piece->from, first = l->c->segment[piece->segment].face[0] == l->parent[t];
    return left == first;
}

static jali_status link_sides(labelling *l)
{
    jali_status status;
    int32_t count = 3 * l->triangle_count;
    TRY(ARENA(l->ctx, l->side, count));
    TRY(ARENA(l->ctx, l->place, count));
    TRY(ARENA(l->ctx, l->group, count));
    TRY(ARENA(l->ctx, l->group_end, count));
    TRY(ARENA(l->ctx, l->through, count));
    TRY(ARENA(l->ctx, l->is_cut, count));
    TRY(ARENA(l->ctx, l->behind, count));
    memset(l->behind, 0, (size_t)count * sizeof *l->behind);
    for (int32_t s = 0; s < count; s++) {
        int32_t a = l->triangle[s / 3][s % 3], b = l->triangle[s / 3][(s + 1) % 3];
        l->side[s] = (edge_side){MIN(a, b), MAX(a, b), s};
    }
    qsort(l->side, (size_t)count, sizeof *l->side, compare_sides);
    if (l->cut->piece_count)
        qsort(l->cut->piece, (size_t)l->cut->piece_count, sizeof *l->cut->piece, compare_pieces);
    for (int32_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && l->side[end].low == l->side[first].low &&
                              l->side[end].high == l->side[first].high;)
            end++;
        cut_piece key = {l->side[first].low, l->side[first].high, 0};
        const cut_piece *piece =
            l->cut->piece_count == 0
                ? NULL
                : bsearch(&key, l->cut->piece, (size_t)l->cut->piece_count, sizeof key, compare_pieces);
        l->is_cut[first] = piece != NULL;
        l->through[first] = piece || end - first == 2;
        l->group_end[first] = end;
        for (int32_t i = first; i < end; i++) {
            l->place[l->side[i].side] = i;
            l->group[l->side[i].side] = first;
            if (piece) l->behind[l->side[i].side] = lies_behind(l, l->side[i].side, piece);
        }
        if (!piece && end - first == 2) { // sides that cannot be told apart tell nothing
            const int32_t s = l->side[first].side, o = l->side[first + 1].side;
            if (l->triangle[s / 3][s % 3] == l->triangle[o / 3][o % 3]) l->through[first] = false;
        }
    }
done:
    return status;
}

// How often does the surface enclose what lies just in front of a triangle? Solid angles over 4 pi; on the
// triangle itself it is half more than in front. A rim makes it less: up to three quarters are put up with.
static int32_t winding_before(const labelling *l, int32_t t)
{
    double at[3] = {0}, sum = 0;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) at[k] += l->c->point[l->triangle[t][c]][k] / 3;
    for (int32_t i = 0; i < l->whole->triangle_count; i++) {
        if (i == l->parent[t]) continue;
        double p[3][3], length[3], n[3];
        for (int c = 0; c < 3; c++) {
            subtract(l->c->point[l->whole->triangle[i][c]], at, p[c]);
            length[c] = sqrt(dot(p[c], p[c]));
        }
        cross(p[1], p[2], n);
        double below = length[0] * length[1] * length[2] + dot(p[0], p[1]) * length[2] +
                       dot(p[1], p[2]) * length[0] + dot(p[2], p[0]) * length[1];
        sum += 2 * atan2(dot(p[0], n), below);
    }
    return (int32_t)lrint(sum / (4 * M_PI) - 0.25);
}

static double area_of(const labelling *l, int32_t t)
{
    const int32_t *v = l->triangle[t];
    double n[3];
    area_vector(l->c->point[v[0]], l->c->point[v[1]], l->c->point[v[2]], n);
    return sqrt(dot(n, n));
}

// From one triangle over all that hangs together with it; returns how many there are in the queue.
static int32_t spread_from(labelling *l, int32_t seed, int32_t *queue)
{
    int32_t count = 0;
    l->front[seed] = 0;
    queue[count++] = seed;
    for (int32_t next = 0; next < count; next++)
        for (int k = 0; k < 3; k++) {
            int32_t s = 3 * queue[next] + k, first = l->group[s];
            if (!l->through[first]) continue;
            int32_t base = l->front[queue[next]] - l->behind[s];
            for (int32_t i = first; i < l->group_end[first]; i++) {
                int32_t o = l->side[i].side, here = base + l->behind[o];
                if (l->front[o / 3] == INT32_MIN) {
                    l->front[o / 3] = here;
                    queue[count++] = o / 3;
                } else if (l->front[o / 3] != here) {
                    l->torn = true;
                }
            }
        }
    return count;
}

static jali_status label_fronts(labelling *l)
{
    jali_status status;
    int32_t *queue;
    TRY(ARENA(l->ctx, l->front, l->triangle_count));
    TRY(ARENA(l->ctx, queue, l->triangle_count));
    for (int32_t t = 0; t < l->triangle_count; t++) l->front[t] = INT32_MIN;
    for (int32_t t = 0; t < l->triangle_count && !l->torn; t++) {
        if (l->front[t] != INT32_MIN) continue;
        int32_t count = spread_from(l, t, queue), largest = -1;
        bool cut = false;
        for (int32_t i = 0; i < count; i++) {
            cut |= queue[i] >= l->uncut_count;
            if (largest < 0 || area_of(l, queue[i]) > area_of(l, largest)) largest = queue[i];
        }
        TRY(step(l->ctx, "merge", 0.8));
        int32_t more = cut ? winding_before(l, largest) - l->front[largest] : 0; // untouched parts stay
        for (int32_t i = 0; i < count; i++) l->front[queue[i]] += more;
    }
done:
    return status;
}

// Crumpled places enclose pockets and leave specks, each a surface of its own: what is smaller than can be
// printed is taken for solid or for nothing.
static jali_status drop_specks(labelling *l, double speck)
{
    jali_status status;
    int32_t *queue;
    bool *seen;
    TRY(ARENA(l->ctx, queue, l->triangle_count));
    TRY(ARENA(l->ctx, seen, l->triangle_count));
    memset(seen, 0, (size_t)l->triangle_count * sizeof *seen);
    for (int32_t seed = l->uncut_count; seed < l->triangle_count; seed++) {
        if (seen[seed] || l->front[seed] != 0) continue;
        int32_t count = 0;
        double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
        seen[seed] = true;
        queue[count++] = seed;
        for (int32_t next = 0; next < count; next++)
            for (int k = 0; k < 3; k++) {
                int32_t s = 3 * queue[next] + k, first = l->group[s];
                const double *p = l->c->point[l->triangle[queue[next]][k]];
                for (int axis = 0; axis < 3; axis++) {
                    low[axis] = MIN(low[axis], p[axis]);
                    high[axis] = MAX(high[axis], p[axis]);
                }
                for (int32_t i = first; i < l->group_end[first]; i++) {
                    int32_t other = l->side[i].side / 3;
                    if (seen[other] || l->front[other] != 0) continue;
                    seen[other] = true;
                    queue[count++] = other;
                }
            }
        if (distance(low, high) >= speck) continue;
        for (int32_t i = 0; i < count; i++) l->front[queue[i]] = INT32_MAX;
    }
done:
    return status;
}

// ---- the boundary ----

static void texture_at(const labelling *l, const double (*uv)[3][2], int32_t t, double result[3][2])
{
    const int32_t *v = l->whole->triangle[l->parent[t]];
    const double *a = l->c->point[v[0]], *b = l->c->point[v[1]], *c = l->c->point[v[2]];
    double n[3];
    area_vector(a, b, c, n);
    for (int i = 0; i < 3; i++) {
        const double *p = l->c->point[l->triangle[t][i]];
        double part[3], share[3];
        area_vector(p, b, c, part);
        share[0] = dot(part, n) / dot(n, n);
        area_vector(a, p, c, part);
        share[1] = dot(part, n) / dot(n, n);
        share[2] = 1 - share[0] - share[1];
        for (int k = 0; k < 2; k++) {
            result[i][k] = 0;
            for (int c2 = 0; c2 < 3; c2++) result[i][k] += share[c2] * uv[l->parent[t]][c2][k];
        }
    }
}

// Triangles on a cut are faulty: no picture may lie there. The box around the mesh stays as it was.
static jali_status build(labelling *l, const jali_mesh *before, const double (*uv)[3][2], const bool *marked,
                         double point_mm, double unit_mm, merging *result)
{
    jali_status status;
    double low[3], high[3];
    jali_mesh *mesh = &result->mesh;
    TRY(mesh_create(l->ctx, l->c->point_count, l->triangle_count, mesh));
    TRY(ALLOCATE(l->ctx, result->faulty, l->triangle_count));
    if (uv) TRY(ALLOCATE(l->ctx, result->uv, l->triangle_count));
    mesh->triangle_count = 0;
    for (int32_t t = 0; t < l->triangle_count; t++) {
        if (l->front[t] != 0) continue;
        int32_t into = mesh->triangle_count++;
        bool on_cut = false;
        for (int k = 0; k < 3; k++) on_cut |= l->is_cut[l->group[3 * t + k]];
        memcpy(mesh->triangle[into], l->triangle[t], sizeof *mesh->triangle);
        result->faulty[into] = on_cut || marked[l->parent[t]];
        if (uv) texture_at(l, uv, t, result->uv[into]);
    }
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY, high[k] = -INFINITY;
        for (int32_t v = 0; v < before->vertex_count; v++) {
            low[k] = MIN(low[k], before->vertex[v][k]);
            high[k] = MAX(high[k], before->vertex[v][k]);
        }
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++) {
            double at = rint(l->c->point[v][k] * point_mm / unit_mm) * unit_mm;
            mesh->vertex[v][k] = MIN(MAX(at, low[k]), high[k]) + 0.0;
        }
done:
    return status;
}

// ---- tidying ----

// The corners of triangles around one vertex that hang together through edges are one fan.
static jali_status find_fans(jali_context *ctx, const jali_mesh *mesh, int32_t *fan)
{
    jali_status status;
    sides linked = {0};
    TRY(sides_create(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                     &linked));
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) fan[i] = i;
    for (int32_t s = 0; s < 4 * mesh->triangle_count; s++) {
        if ((s & 3) == 3 || linked.beside[s] < s) continue;
        int32_t o = linked.beside[s],
                end[2][2] = {{next_side(s), last_side(s)}, {last_side(o), next_side(o)}};
        for (int k = 0; k < 2; k++)
            unite(fan, 3 * (end[0][k] >> 2) + (end[0][k] & 3), 3 * (end[1][k] >> 2) + (end[1][k] & 3));
    }
done:
    sides_free(ctx, &linked);
    return status;
}

// Where parts of the boundary touch in no more than a vertex, each fan gets one of its own and draws back by
// a quarter of its triangles, at most by `back_mm`.
static jali_status part_fans(jali_context *ctx, double back_mm, double unit_mm, jali_mesh *mesh)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t count = 3 * mesh->triangle_count, *fan, *owner, *given, more = 0;
    double(*middle)[4], (*vertex)[3] = NULL;
    TRY(ARENA(ctx, fan, count + 1));
    TRY(ARENA(ctx, given, count + 1));
    TRY(ARENA(ctx, owner, mesh->vertex_count + 1));
    TRY(ARENA(ctx, middle, count + 1));
    TRY(find_fans(ctx, mesh, fan));
    memset(middle, 0, (size_t)count * sizeof *middle);
    for (int32_t v = 0; v < mesh->vertex_count; v++) owner[v] = -1;
    for (int32_t i = 0; i < count; i++) {
        int32_t root = root_of(fan, i), v = mesh->triangle[i / 3][i % 3];
        for (int other = 1; other < 3; other++)
            for (int k = 0; k < 3; k++)
                middle[root][k] += mesh->vertex[mesh->triangle[i / 3][(i + other) % 3]][k];
        middle[root][3] += 2;
        if (root != i) continue;
        given[i] = owner[v] < 0 ? v : mesh->vertex_count + more++;
        if (owner[v] < 0)
            owner[v] = i;
        else
            owner[v] = INT32_MAX;
    }
    if (more == 0) goto done;
    TRY(ALLOCATE(ctx, vertex, (size_t)mesh->vertex_count + (size_t)more));
    memcpy(vertex, mesh->vertex, (size_t)mesh->vertex_count * sizeof *vertex);
    for (int32_t i = 0; i < count; i++) {
        int32_t v = mesh->triangle[i / 3][i % 3];
        if (fan[i] != i || owner[v] != INT32_MAX) continue;
        double back[3], length = 0;
        for (int k = 0; k < 3; k++) {
            back[k] = (middle[i][k] / middle[i][3] - mesh->vertex[v][k]) / 4;
            length += back[k] * back[k];
        }
        double share = length > back_mm * back_mm ? back_mm / sqrt(length) : 1;
        for (int k = 0; k < 3; k++)
            vertex[given[i]][k] = rint((mesh->vertex[v][k] + share * back[k]) / unit_mm) * unit_mm;
    }
    for (int32_t i = 0; i < count; i++) mesh->triangle[i / 3][i % 3] = given[root_of(fan, i)];
    release(ctx, mesh->vertex);
    mesh->vertex = vertex;
    mesh->vertex_count += more;
done:
    arena_rewind(ctx, mark);
    return status;
}

// Thin triangles along the lines go, before anything is dropped for having no area, which would leave cracks.
static jali_status tidy(jali_context *ctx, int32_t from, double thinnest_mm, merging *result)
{
    int32_t left;
    jali_shell shell = {.outer = {.mesh = result->mesh, .uv = result->uv, .faulty = result->faulty}};
    jali_status status = mend_slivers(ctx, &shell, thinnest_mm, from, &left);
    result->mesh = shell.outer.mesh;
    return status;
}

static double reach_of(const jali_mesh *mesh)
{
    double reach = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++) reach = MAX(reach, fabs(mesh->vertex[v][k]));
    return reach;
}

jali_status merge_crossings(jali_context *ctx, const jali_mesh *mesh, const double (*uv)[3][2],
                            const bool *marked, int32_t round, merging *result)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    jali_mesh apart = {0};
    lattice l = {0};
    exact_surface s = {0};
    crossings c = {0};
    cut_faces cut = {0};
    bool *met, *has_segments, capped;
    finding found;
    const int32_t(*triangle)[3] = (const int32_t(*)[3])mesh->triangle;
    *result = (merging){0};
    TRY(mesh_create(ctx, mesh->vertex_count, mesh->triangle_count, &apart));
    memcpy(apart.vertex, mesh->vertex, (size_t)mesh->vertex_count * sizeof *apart.vertex);
    memcpy(apart.triangle, triangle, (size_t)mesh->triangle_count * sizeof *apart.triangle);
    double unit_mm = ldexp(1, mesh_round(&apart));
    TRY(ARENA(ctx, met, mesh->triangle_count));
    TRY(ARENA(ctx, has_segments, mesh->triangle_count));
    memset(met, 0, (size_t)mesh->triangle_count);
    memset(has_segments, 0, (size_t)mesh->triangle_count);
    for (int pass = 0; pass < 2; pass++) { // where it is, then where it is moved
        TRY(lattice_create(ctx, apart.vertex_count, (const double(*)[3])apart.vertex, &l));
        TRY(exact_surface_create(ctx, &l, apart.triangle_count, triangle, &s));
        TRY(count_intersections(ctx, &s, met, &found, &capped));
        if (pass == 1 || capped) break;
        TRY(part(ctx, &apart, met, unit_mm, round));
        exact_surface_free(ctx, &s);
        lattice_free(ctx, &l);
    }
    if (capped || s.face_count < apart.triangle_count) goto done;
    TRY(find_crossings(ctx, &s, met, &c));
    if (!c.degenerate) TRY(cut_along(ctx, &s, &c, &cut));
    if (c.degenerate) goto done;
    for (int32_t i = 0; i < c.segment_count; i++)
        has_segments[c.segment[i].face[0]] = has_segments[c.segment[i].face[1]] = true;
    labelling labels = {.ctx = ctx, .whole = &apart, .c = &c, .cut = &cut};
    TRY(gather_triangles(&labels, has_segments));
    TRY(link_sides(&labels));
    TRY(label_fronts(&labels));
    if (labels.torn) goto done;
    double point_mm = ldexp(1, l.unit_log2), thinnest = thinnest_share * reach_of(&apart) / point_mm;
    TRY(drop_specks(&labels, speck_heights * thinnest));
    TRY(build(&labels, mesh, uv, marked, point_mm, unit_mm, result));
    TRY(part_fans(ctx, thinnest * point_mm, unit_mm, &result->mesh));
    TRY(tidy(ctx, apart.vertex_count, thinnest * point_mm, result));
    result->done = true;
done:
    if (status != JALI_OK) merging_free(ctx, result);
    cut_faces_free(ctx, &cut);
    crossings_free(ctx, &c);
    exact_surface_free(ctx, &s);
    lattice_free(ctx, &l);
    jali_mesh_free(ctx, &apart);
    arena_rewind(ctx, mark);
    return status;
}
