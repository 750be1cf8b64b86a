// Edges, fans and shells of a mesh.
//
// Every side of a triangle goes into the bucket of its lower vertex; a sorted bucket shows each edge as a run
// of equal higher vertices. Triangles that share an edge are united (shells), and so are their corners at
// both ends (fans): a vertex whose corners do not end as one set is shared by two fans.
//
// Checked: tests/test_check.c: cubes that share an edge or a vertex, open boxes, a flipped face, a torus.
#include "mesh/topology.h"
#include "base/sets.h"

// One side of one triangle, in the bucket of its lower vertex.
typedef struct side {
    int32_t high;     // the edge's higher vertex
    int32_t opposite; // the triangle's third vertex
    int32_t half;     // 3 triangle + k: the side from its corner k to the next
} side;

typedef struct edge_pass {
    const int32_t (*triangle)[3];
    int32_t *start;              // [vertex_count + 1], the bucket of each vertex
    side *side;                  // [3 triangle_count]
    int32_t *above;              // [triangle_count], union-find over triangles
    int32_t *fan;                // [3 triangle_count], union-find over corners
    bool *flawed;                // [triangle_count]
    const topology_marks *marks; // or NULL
    topology *t;
} edge_pass;

static bool names_a_vertex_twice(const int32_t triangle[3])
{
    return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

static void note(finding *f, int32_t a, int32_t b)
{
    if (f->count++ == 0) {
        f->a = a;
        f->b = b;
    }
}

static bool side_before(const side *a, const side *b)
{
    if (a->high != b->high) return a->high < b->high;
    if (a->opposite != b->opposite) return a->opposite < b->opposite;
    return a->half < b->half;
}

// Shell sort: an insertion sort for the usual six sides, bearable for the hub of a fan of thousands.
static void sort_sides(side *s, int32_t count)
{
    static const int32_t gaps[] = {8858370, 3937053, 1749801, 777690, 345640, 153618, 68275,
                                   30345,   13487,   5994,    2664,   1184,   526,    234,
                                   104,     46,      20,      9,      4,      1}; // ratio 9 / 4, after Tokuda
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
        for (int32_t i = gaps[g]; i < count; i++) {
            side moving = s[i];
            int32_t j = i;
            for (; j >= gaps[g] && side_before(&moving, &s[j - gaps[g]]); j -= gaps[g]) s[j] = s[j - gaps[g]];
            s[j] = moving;
        }
}

static void fill_buckets(edge_pass *p, int32_t vertex_count, int32_t triangle_count)
{
    for (int32_t t = 0; t < triangle_count; t++) {
        const int32_t *v = p->triangle[t];
        if (names_a_vertex_twice(v)) continue;
        for (int k = 0; k < 3; k++) p->start[MIN(v[k], v[(k + 1) % 3])]++;
    }
    int32_t sum = 0;
    for (int32_t v = 0; v <= vertex_count; v++) {
        sum += v < vertex_count ? p->start[v] : 0;
        p->start[v] = sum; // the end for now; filling backwards makes it the start
    }
    for (int32_t t = triangle_count - 1; t >= 0; t--) {
        const int32_t *v = p->triangle[t];
        if (names_a_vertex_twice(v)) continue;
        for (int k = 2; k >= 0; k--) {
            int32_t from = v[k], to = v[(k + 1) % 3];
            p->side[--p->start[MIN(from, to)]] = (side){MAX(from, to), v[(k + 2) % 3], 3 * t + k};
        }
    }
}

static bool runs_upwards(const edge_pass *p, const side *s)
{
    return p->triangle[s->half / 3][s->half % 3] != s->high;
}

static int32_t corner_at_low(const edge_pass *p, const side *s)
{
    return runs_upwards(p, s) ? s->half : s->half / 3 * 3 + (s->half + 1) % 3;
}

static int32_t corner_at_high(const edge_pass *p, const side *s)
{
    return runs_upwards(p, s) ? s->half / 3 * 3 + (s->half + 1) % 3 : s->half;
}

// One edge, given as the run of its sides.
static void take_edge(edge_pass *p, int32_t low, const side *s, int32_t count)
{
    topology *t = p->t;
    int32_t high = s->high;
    t->edge_count++;
    bool flawed = true;
    if (count == 1)
        note(&t->open_edges, low, high);
    else if (count > 2)
        note(&t->crowded_edges, low, high);
    else if (runs_upwards(p, &s[0]) == runs_upwards(p, &s[1]))
        note(&t->misdirected_edges, low, high);
    else
        flawed = false;
    for (int32_t i = 0; i < count; i++) {
        p->flawed[s[i].half / 3] |= flawed;
        if (p->marks)
            p->marks->twin[s[i].half] = count == 1 ? TWIN_OPEN : count == 2 ? s[1 - i].half : TWIN_CROWDED;
        if (i == 0) continue;
        unite(p->above, s[i - 1].half / 3, s[i].half / 3);
        unite(p->fan, corner_at_low(p, &s[i - 1]), corner_at_low(p, &s[i]));
        unite(p->fan, corner_at_high(p, &s[i - 1]), corner_at_high(p, &s[i]));
        // Each triangle is seen from its two lowest vertices once.
        if (s[i].opposite == s[i - 1].opposite && s[i].opposite > high)
            note(&t->repeated_triangles, s[i - 1].half / 3, s[i].half / 3);
    }
}

static void take_edges_of(edge_pass *p, int32_t vertex)
{
    side *s = p->side + p->start[vertex];
    int32_t count = p->start[vertex + 1] - p->start[vertex];
    sort_sides(s, count);
    for (int32_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && s[end].high == s[i].high; end++) {
        }
        take_edge(p, vertex, s + i, end - i);
    }
}

// The roots among a vertex's corners are its fans; the buckets' starts are no longer needed and count them.
static void count_fans(edge_pass *p, int32_t vertex_count)
{
    topology *t = p->t;
    memset(p->start, 0, ((size_t)vertex_count + 1) * sizeof *p->start);
    for (int32_t i = 0; i < t->triangle_count; i++) {
        if (names_a_vertex_twice(p->triangle[i])) continue;
        t->used_triangle_count++;
        for (int k = 0; k < 3; k++)
            if (p->fan[3 * i + k] == 3 * i + k) p->start[p->triangle[i][k]]++;
    }
    for (int32_t v = 0; v < vertex_count; v++) {
        if (p->start[v] > 0) t->used_vertex_count++;
        if (p->start[v] > 1) note(&t->crowded_vertices, v, v);
        if (p->marks) p->marks->crowded[v] = p->start[v] > 1;
    }
}

// A root is its shell's first triangle, so numbers are given before they are asked for.
static void number_shells(edge_pass *p)
{
    topology *t = p->t;
    for (int32_t i = 0; i < t->triangle_count; i++) {
        int32_t root = root_of(p->above, i);
        if (names_a_vertex_twice(p->triangle[i]))
            t->shell[i] = -1;
        else if (root == i)
            t->shell[i] = t->shell_count++;
        else
            t->shell[i] = t->shell[root];
    }
}

jali_status topology_create(jali_context *ctx, int32_t vertex_count, int32_t triangle_count,
                            const int32_t (*triangle)[3], topology *t)
{
    return topology_mark(ctx, vertex_count, triangle_count, triangle, NULL, t);
}

jali_status topology_mark(jali_context *ctx, int32_t vertex_count, int32_t triangle_count,
                          const int32_t (*triangle)[3], const topology_marks *marks, topology *t)
{
    jali_status status = JALI_OK;
    edge_pass p = {.triangle = triangle, .marks = marks, .t = t};
    *t = (topology){.triangle_count = triangle_count};
    TRY(ALLOCATE_CLEARED(ctx, p.start, (size_t)vertex_count + 1));
    TRY(ALLOCATE(ctx, p.side, 3 * (size_t)triangle_count));
    TRY(ALLOCATE(ctx, p.above, triangle_count));
    TRY(ALLOCATE(ctx, p.fan, 3 * (size_t)triangle_count));
    TRY(ALLOCATE_CLEARED(ctx, p.flawed, triangle_count));
    TRY(ALLOCATE(ctx, t->shell, triangle_count));
    for (int32_t i = 0; i < triangle_count; i++) p.above[i] = i;
    for (int32_t i = 0; i < 3 * triangle_count; i++) {
        p.fan[i] = i;
        if (marks) marks->twin[i] = TWIN_NONE;
    }
    fill_buckets(&p, vertex_count, triangle_count);
    for (int32_t v = 0; v < vertex_count; v++) {
        if (v % 65536 == 0) TRY(step(ctx, "check", 0.3 * v / vertex_count));
        take_edges_of(&p, v);
    }
    count_fans(&p, vertex_count);
    number_shells(&p);
    TRY(ALLOCATE_CLEARED(ctx, t->flawed, t->shell_count));
    for (int32_t i = 0; i < triangle_count; i++)
        if (t->shell[i] >= 0) t->flawed[t->shell[i]] |= p.flawed[i];
done:
    release(ctx, p.flawed);
    release(ctx, p.fan);
    release(ctx, p.above);
    release(ctx, p.side);
    release(ctx, p.start);
    if (status != JALI_OK) topology_free(ctx, t);
    return status;
}

void topology_free(jali_context *ctx, topology *t)
{
    release(ctx, t->shell);
    release(ctx, t->flawed);
    *t = (topology){0};
}
