// Self-intersections of a mesh, exactly.
//
// Two triangles may share a vertex, an edge, or nothing; anything beyond that is an intersection, also a mere
// touch and also an overlap of coplanar neighbours. Each case is decided by signs of determinants
// (mesh/exact.h):
//
//   an edge    they overlap only when coplanar and both on the same side of it;
//   a vertex   both are convex and contain it, so what they share is a segment or a sector from it: it ends
//              on the edge opposite to the vertex of one of them, inside the other. Coplanar: the sectors
//              overlap;
//   nothing    an edge of one meets the other, or, coplanar, no line through an edge separates them.
//
// Source:  the separating-line test is the separating-axis theorem in the plane; the rest follows from it.
// Checked: tests/test_check.c: drawn cases of each kind, random triangles against a plain rational search.
#include "mesh/intersect.h"

#include <math.h>

enum { BLOCK = 1024, BLOCK_CAP = 1000000, BATCH = 128 };

typedef const int64_t *point;

// Is the segment p, q in the plane of triangle t (of which `dropped` is a sound projection) touching t?
static bool segment_meets_in_plane(bool narrow, int dropped, point p, point q, const point t[3])
{
    int turn = turn_in_plane(narrow, dropped, t[0], t[1], t[2]);
    bool left = true, right = true;
    for (int k = 0; k < 3; k++) {
        point from = t[k], to = t[(k + 1) % 3];
        if (turn * turn_in_plane(narrow, dropped, from, to, p) < 0 &&
            turn * turn_in_plane(narrow, dropped, from, to, q) < 0)
            return false;
        int side = turn_in_plane(narrow, dropped, p, q, from);
        left &= side > 0;
        right &= side < 0;
    }
    return !left && !right;
}

// Does the closed segment p, q touch the closed triangle t? Its ends lie on the given sides of t's plane.
static bool segment_meets(bool narrow, point p, point q, int side_p, int side_q, const point t[3],
                          const normal *n)
{
    if (side_p * side_q > 0) return false;
    if (side_p == 0 && side_q == 0) return segment_meets_in_plane(narrow, axis_of(n), p, q, t);
    bool left = false, right = false;
    for (int k = 0; k < 3; k++) {
        int side = turn_in_space(narrow, p, q, t[k], t[(k + 1) % 3]);
        left |= side > 0;
        right |= side < 0;
    }
    return !(left && right);
}

static bool separated_by_an_edge_of(bool narrow, int dropped, const point a[3], const point b[3])
{
    int turn = turn_in_plane(narrow, dropped, a[0], a[1], a[2]);
    for (int k = 0; k < 3; k++) {
        bool outside = true;
        for (int i = 0; i < 3 && outside; i++)
            outside = turn * turn_in_plane(narrow, dropped, a[k], a[(k + 1) % 3], b[i]) < 0;
        if (outside) return true;
    }
    return false;
}

// No vertex shared.
static bool apart_meet(bool narrow, const point a[3], const point b[3])
{
    int side_b[3], side_a[3];
    normal na = normal_of(narrow, a[0], a[1], a[2]);
    for (int k = 0; k < 3; k++) side_b[k] = side_of(narrow, &na, a[0], b[k]);
    if (side_b[0] == side_b[1] && side_b[1] == side_b[2]) {
        if (side_b[0] != 0) return false;
        int dropped = axis_of(&na);
        return !separated_by_an_edge_of(narrow, dropped, a, b) &&
               !separated_by_an_edge_of(narrow, dropped, b, a);
    }
    normal nb = normal_of(narrow, b[0], b[1], b[2]);
    for (int k = 0; k < 3; k++) side_a[k] = side_of(narrow, &nb, b[0], a[k]);
    if (side_a[0] == side_a[1] && side_a[1] == side_a[2]) return false;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        if (segment_meets(narrow, b[k], b[next], side_b[k], side_b[next], a, &na)) return true;
        if (segment_meets(narrow, a[k], a[next], side_a[k], side_a[next], b, &nb)) return true;
    }
    return false;
}

// a[0] and b[0] are one vertex; in one plane: does either sector hold an arm of the other?
static bool sectors_overlap(bool narrow, int dropped, const point a[3], const point b[3])
{
    point p = a[0];
    int turn_a = turn_in_plane(narrow, dropped, p, a[1], a[2]);
    int turn_b = turn_in_plane(narrow, dropped, p, b[1], b[2]);
    int s[2][2]; // from arm i of a to arm j of b
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) s[i][j] = turn_in_plane(narrow, dropped, p, a[1 + i], b[1 + j]);
    for (int j = 0; j < 2; j++)
        if (turn_a * s[0][j] >= 0 && turn_a * s[1][j] <= 0) return true;
    for (int i = 0; i < 2; i++)
        if (turn_b * s[i][0] <= 0 && turn_b * s[i][1] >= 0) return true;
    return false;
}

// Does the ray from a[0] to q, in the plane of a, run within a's sector?
static bool sector_holds(bool narrow, int dropped, const point a[3], point q)
{
    int turn = turn_in_plane(narrow, dropped, a[0], a[1], a[2]);
    return turn * turn_in_plane(narrow, dropped, a[0], a[1], q) >= 0 &&
           turn * turn_in_plane(narrow, dropped, a[0], a[2], q) <= 0;
}

// a[0] and b[0] are one vertex.
static bool at_vertex_meet(bool narrow, const point a[3], const point b[3])
{
    normal na = normal_of(narrow, a[0], a[1], a[2]);
    int b1 = side_of(narrow, &na, a[0], b[1]), b2 = side_of(narrow, &na, a[0], b[2]);
    if (b1 * b2 > 0) return false;
    if (b1 == 0 && b2 == 0) return sectors_overlap(narrow, axis_of(&na), a, b);
    if (b1 == 0) return sector_holds(narrow, axis_of(&na), a, b[1]); // only this arm of b is in a's plane
    if (b2 == 0) return sector_holds(narrow, axis_of(&na), a, b[2]);
    normal nb = normal_of(narrow, b[0], b[1], b[2]);
    int a1 = side_of(narrow, &nb, b[0], a[1]), a2 = side_of(narrow, &nb, b[0], a[2]);
    if (a1 * a2 > 0) return false;
    return segment_meets(narrow, b[1], b[2], b1, b2, a, &na) ||
           segment_meets(narrow, a[1], a[2], a1, a2, b, &nb);
}

// a[0], a[1] and b[0], b[1] are one edge, either way round.
static bool at_edge_meet(bool narrow, const point a[3], const point b[3])
{
    normal n = normal_of(narrow, a[0], a[1], a[2]);
    if (side_of(narrow, &n, a[0], b[2]) != 0) return false;
    int dropped = axis_of(&n);
    return turn_in_plane(narrow, dropped, a[0], a[1], a[2]) ==
           turn_in_plane(narrow, dropped, a[0], a[1], b[2]);
}

bool triangles_meet(const lattice *l, const int32_t a[3], const int32_t b[3])
{
    // Shared vertices first, in the order of a; then the rest.
    point pa[3], pb[3];
    int shared = 0;
    bool taken_a[3] = {false}, taken_b[3] = {false};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (a[i] == b[j]) {
                pa[shared] = pb[shared] = l->point[a[i]];
                shared++;
                taken_a[i] = taken_b[j] = true;
            }
    if (shared == 3) return false;
    for (int i = 0, na = shared, nb = shared; i < 3; i++) {
        if (!taken_a[i]) pa[na++] = l->point[a[i]];
        if (!taken_b[i]) pb[nb++] = l->point[b[i]];
    }
    if (shared == 2) return at_edge_meet(l->narrow, pa, pb);
    if (shared == 1) return at_vertex_meet(l->narrow, pa, pb);
    return apart_meet(l->narrow, pa, pb);
}

// ---- over the whole surface ----

static float float_below(int64_t value)
{
    float f = (float)value;
    return (int64_t)f > value ? nextafterf(f, -INFINITY) : f;
}

static float float_above(int64_t value)
{
    float f = (float)value;
    return (int64_t)f < value ? nextafterf(f, INFINITY) : f;
}

box box_of_triangle(const lattice *l, const int32_t t[3])
{
    box b;
    for (int k = 0; k < 3; k++) {
        int64_t x = l->point[t[0]][k], y = l->point[t[1]][k], z = l->point[t[2]][k];
        b.low[k] = float_below(MIN(x, MIN(y, z)));
        b.high[k] = float_above(MAX(x, MAX(y, z)));
    }
    return b;
}

jali_status exact_surface_create(jali_context *ctx, const lattice *l, int32_t triangle_count,
                                 const int32_t (*triangle)[3], exact_surface *s)
{
    jali_status status;
    box *boxes = NULL;
    *s = (exact_surface){.l = l, .triangle = triangle};
    TRY(ALLOCATE(ctx, s->face, triangle_count));
    TRY(ALLOCATE(ctx, boxes, triangle_count));
    for (int32_t t = 0; t < triangle_count; t++) {
        const int32_t *v = triangle[t];
        normal n = normal_of(l->narrow, l->point[v[0]], l->point[v[1]], l->point[v[2]]);
        if (axis_of(&n) >= 0) {
            boxes[s->face_count] = box_of_triangle(l, v);
            s->face[s->face_count++] = t;
        } else if (s->flat_triangles.count++ == 0) {
            s->flat_triangles.a = s->flat_triangles.b = t;
        }
    }
    TRY(step(ctx, "check", 0.4));
    TRY(box_tree_create(ctx, s->face_count, boxes, &s->tree));
done:
    release(ctx, boxes);
    if (status != JALI_OK) exact_surface_free(ctx, s);
    return status;
}

void exact_surface_free(jali_context *ctx, exact_surface *s)
{
    box_tree_free(ctx, &s->tree);
    release(ctx, s->face);
    *s = (exact_surface){0};
}

typedef struct search {
    jali_context *ctx;
    const exact_surface *s;
    int32_t first_block; // of this batch
    finding *block;      // [blocks]
    bool *met;           // [triangles] or NULL; several threads may set one
} search;

static void note_pair(finding *f, int32_t a, int32_t b)
{
    int32_t low = MIN(a, b), high = MAX(a, b);
    if (f->count++ == 0 || low < f->a || (low == f->a && high < f->b)) {
        f->a = low;
        f->b = high;
    }
}

// Each pair is found from the one that comes first on the curve.
static void search_block(void *shared, int32_t index)
{
    search *job = shared;
    const exact_surface *s = job->s;
    int32_t block = job->first_block + index, first = block * BLOCK;
    int32_t end = first + MIN(BLOCK, s->face_count - first);
    finding *f = &job->block[block];
    for (int32_t place = first; place < end && !stopping(job->ctx); place++) {
        int32_t a = s->face[s->tree.item[place]];
        box b = box_of_triangle(s->l, s->triangle[a]);
        box_walk walk = box_walk_start(&s->tree, &b, place + 1);
        for (int32_t other; (other = box_walk_next(&walk)) >= 0;) {
            int32_t c = s->face[s->tree.item[other]];
            if (!triangles_meet(s->l, s->triangle[a], s->triangle[c])) continue;
            note_pair(f, a, c);
            if (job->met) {
                __atomic_store_n(&job->met[a], true, __ATOMIC_RELAXED);
                __atomic_store_n(&job->met[c], true, __ATOMIC_RELAXED);
            }
            if (f->count > BLOCK_CAP) return;
        }
    }
}

jali_status count_intersections(jali_context *ctx, const exact_surface *s, bool *met, finding *found,
                                bool *capped)
{
    jali_status status = JALI_OK;
    int32_t blocks = s->face_count / BLOCK + (s->face_count % BLOCK != 0);
    search job = {.ctx = ctx, .s = s, .met = met};
    *found = (finding){0};
    *capped = false;
    TRY(ALLOCATE_CLEARED(ctx, job.block, blocks));
    for (job.first_block = 0; job.first_block < blocks; job.first_block += BATCH) {
        TRY(step(ctx, "check", 0.5 + 0.5 * job.first_block / blocks));
        parallel(ctx, MIN((int32_t)BATCH, blocks - job.first_block), search_block, &job);
    }
    TRY(step(ctx, "check", 1)); // a block that was stopped has not counted all
    for (int32_t i = 0; i < blocks; i++) {
        finding *f = &job.block[i];
        if (f->count > BLOCK_CAP) *capped = true;
        if (f->count == 0) continue;
        int64_t count = found->count + f->count;
        if (found->count == 0 || f->a < found->a || (f->a == found->a && f->b < found->b)) *found = *f;
        found->count = count;
    }
done:
    release(ctx, job.block);
    return status;
}
