// Grow a disc of faces from a point of a surface.
//
// How:     first walk outwards along edges, shortest way first, and give each vertex a place in the plane and
//          a direction to the right: the mean of what its neighbours nearer to the seed say (they see it in
//          their tangent planes; directions turn with the normals). Then take faces, nearest first, as long
//          as what was taken stays a disc.
// Source:  R. Schmidt, C. Grimm, B. Wyvill, Interactive Decal Compositing with Discrete Exponential Maps,
//          2006; R. Schmidt, Stroke Parameterization, 2013 (the means).
// Limits:  where ways around a bump meet the places disagree; flattening mends that.
// Checked: tests/test_flatten.c.
#include "place/disc.h"
#include "base/vector.h"

#include <math.h>

typedef struct waiting {
    double key;
    int32_t item;
} waiting;

typedef struct queue {
    waiting *heap;
    int32_t count;
    size_t capacity;
} queue;

typedef struct growing {
    const jali_mesh *mesh;
    const sides *linked;
    double half_mm[2];
    double (*normal)[3], (*right)[3]; // [vertices]
    double (*at)[2];                  // [vertices]
    double *distance;                 // [vertices] along edges, INFINITY: not reached
    uint8_t *settled;                 // [vertices]
    int32_t *number;                  // [vertices] in the disc, or -1
    uint8_t *taken;                   // [triangles]
    queue next;
    disc *d;
} growing;

static void scale_to_one(double a[3])
{
    double length = sqrt(dot(a, a));
    for (int k = 0; k < 3 && length > 0; k++) a[k] /= length;
}

// --- A queue, the smallest key first; items break ties

static bool sooner(const waiting *a, const waiting *b)
{
    return a->key < b->key || (a->key == b->key && a->item < b->item);
}

static jali_status push(jali_context *ctx, queue *q, double key, int32_t item)
{
    jali_status status;
    TRY(GROW(ctx, q->heap, q->capacity, q->count + 1));
    int32_t i = q->count++;
    waiting here = {key, item};
    for (; i > 0 && sooner(&here, &q->heap[(i - 1) / 2]); i = (i - 1) / 2) q->heap[i] = q->heap[(i - 1) / 2];
    q->heap[i] = here;
done:
    return status;
}

static waiting pop(queue *q)
{
    waiting first = q->heap[0], here = q->heap[--q->count];
    int32_t i = 0;
    for (int32_t child; (child = 2 * i + 1) < q->count; i = child) {
        if (child + 1 < q->count && sooner(&q->heap[child + 1], &q->heap[child])) child++;
        if (!sooner(&q->heap[child], &here)) break;
        q->heap[i] = q->heap[child];
    }
    q->heap[i] = here;
    return first;
}

// --- The corners at a vertex, counter-clockwise, then from the first one clockwise at a border

typedef struct ring {
    const sides *linked;
    int32_t first, here; // corners, 4 * triangle + k; here -1: at the end
    bool back;
} ring;

static ring ring_around(const sides *linked, int32_t vertex)
{
    int32_t corner = 4 * linked->star[vertex];
    if (corner < 0) return (ring){linked, -1, -1, false};
    while (linked->corner[corner] != vertex) corner++;
    return (ring){linked, corner, corner, false};
}

static int32_t ring_next(ring *r)
{
    int32_t now = r->here, face = now & ~3, o;
    if (now < 0) return now;
    if (!r->back) {
        o = r->linked->beside[face + ((now & 3) + 1) % 3];
        r->here = o == NO_SIDE ? -1 : (o & ~3) + ((o & 3) + 1) % 3;
        if (r->here == r->first) r->here = -1;
        if (o != NO_SIDE) return now;
        r->back = true;
        face = r->first & ~3;
        o = r->linked->beside[face + ((r->first & 3) + 2) % 3];
    } else
        o = r->linked->beside[face + ((now & 3) + 2) % 3];
    r->here = o == NO_SIDE ? -1 : (o & ~3) + ((o & 3) + 2) % 3;
    return now;
}

// --- Places

static void vertex_normals(growing *g)
{
    const jali_mesh *m = g->mesh;
    memset(g->normal, 0, (size_t)m->vertex_count * sizeof *g->normal);
    for (int32_t t = 0; t < m->triangle_count; t++) {
        double a[3], b[3], n[3];
        for (int k = 0; k < 3; k++) {
            a[k] = m->vertex[m->triangle[t][1]][k] - m->vertex[m->triangle[t][0]][k];
            b[k] = m->vertex[m->triangle[t][2]][k] - m->vertex[m->triangle[t][0]][k];
        }
        cross(a, b, n);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) g->normal[m->triangle[t][i]][k] += n[k];
    }
    for (int32_t v = 0; v < m->vertex_count; v++) scale_to_one(g->normal[v]);
}

// Turn a tangent with the least rotation that takes normal n to m (Rodrigues).
static void turn_along(const double n[3], const double m[3], const double tangent[3], double out[3])
{
    double axis[3], across[3], c = dot(n, m);
    cross(n, m, axis);
    cross(axis, tangent, across);
    double share = dot(axis, tangent) / (1 + MAX(c, -0.999));
    for (int k = 0; k < 3; k++) out[k] = c * tangent[k] + across[k] + share * axis[k];
}

// Where a vertex lies as its neighbour sees it.
static void seen_from(const growing *g, int32_t from, const double p[3], double at[2])
{
    double e[3], up[3];
    for (int k = 0; k < 3; k++) e[k] = p[k] - g->mesh->vertex[from][k];
    cross(g->normal[from], g->right[from], up);
    double x = dot(e, g->right[from]), y = dot(e, up), flat = hypot(x, y);
    double scale = flat > 0 ? sqrt(dot(e, e)) / flat : 0; // edges keep their length
    at[0] = g->at[from][0] + scale * x;
    at[1] = g->at[from][1] + scale * y;
}

// The mean of what the settled neighbours say, near ones more.
static void settle(growing *g, int32_t v)
{
    double at[2] = {0}, right[3] = {0}, sum = 0;
    ring r = ring_around(g->linked, v);
    for (int32_t c; (c = ring_next(&r)) >= 0;)
        for (int k = 1; k < 3; k++) {
            int32_t from = g->linked->corner[(c & ~3) + ((c & 3) + k) % 3];
            double here[2], turned[3], away = 0;
            if (!g->settled[from]) continue;
            for (int i = 0; i < 3; i++) {
                double e = g->mesh->vertex[v][i] - g->mesh->vertex[from][i];
                away += e * e;
            }
            double weight = 1 / away;
            seen_from(g, from, g->mesh->vertex[v], here);
            turn_along(g->normal[from], g->normal[v], g->right[from], turned);
            for (int i = 0; i < 2; i++) at[i] += weight * here[i];
            for (int i = 0; i < 3; i++) right[i] += weight * turned[i];
            sum += weight;
        }
    if (sum > 0) {
        for (int i = 0; i < 2; i++) g->at[v][i] = at[i] / sum;
        memcpy(g->right[v], right, sizeof right);
    }
    double off = dot(g->right[v], g->normal[v]);
    for (int i = 0; i < 3; i++) g->right[v][i] -= off * g->normal[v][i];
    scale_to_one(g->right[v]);
    g->settled[v] = 1;
}

// A vertex further from the window than its longest edge has no face there.
static bool leads_on(const growing *g, int32_t v)
{
    double beyond = MAX(fabs(g->at[v][0]) - g->half_mm[0], fabs(g->at[v][1]) - g->half_mm[1]), longest = 0;
    if (beyond <= 0) return true;
    ring r = ring_around(g->linked, v);
    for (int32_t c; (c = ring_next(&r)) >= 0;)
        for (int k = 1; k < 3; k++) {
            const double *p = g->mesh->vertex[g->linked->corner[(c & ~3) + ((c & 3) + k) % 3]];
            double e[3] = {p[0] - g->mesh->vertex[v][0], p[1] - g->mesh->vertex[v][1],
                           p[2] - g->mesh->vertex[v][2]};
            longest = MAX(longest, dot(e, e));
        }
    return beyond <= sqrt(longest);
}

static void begin(growing *g, const disc_seed *seed)
{
    double up[3];
    cross(seed->normal, seed->right, up);
    for (int k = 0; k < 3; k++) {
        int32_t v = g->mesh->triangle[seed->face][k];
        double e[3];
        for (int i = 0; i < 3; i++) e[i] = g->mesh->vertex[v][i] - seed->at[i];
        double x = dot(e, seed->right), y = dot(e, up), flat = hypot(x, y);
        g->distance[v] = sqrt(dot(e, e));
        g->at[v][0] = flat > 0 ? x / flat * g->distance[v] : 0;
        g->at[v][1] = flat > 0 ? y / flat * g->distance[v] : 0;
        turn_along(seed->normal, g->normal[v], seed->right, g->right[v]);
    }
}

static jali_status walk(jali_context *ctx, growing *g, const disc_seed *seed)
{
    jali_status status;
    begin(g, seed);
    for (int k = 0; k < 3; k++) {
        int32_t v = g->mesh->triangle[seed->face][k];
        TRY(push(ctx, &g->next, g->distance[v], v));
    }
    while (g->next.count > 0) {
        waiting here = pop(&g->next);
        int32_t v = here.item;
        if (g->settled[v]) continue;
        settle(g, v);
        if (!leads_on(g, v)) continue;
        ring r = ring_around(g->linked, v);
        for (int32_t c; (c = ring_next(&r)) >= 0;)
            for (int k = 1; k < 3; k++) {
                int32_t to = g->linked->corner[(c & ~3) + ((c & 3) + k) % 3];
                double e[3];
                for (int i = 0; i < 3; i++) e[i] = g->mesh->vertex[to][i] - g->mesh->vertex[v][i];
                double away = here.key + sqrt(dot(e, e));
                if (g->settled[to] || away >= g->distance[to]) continue;
                g->distance[to] = away;
                TRY(push(ctx, &g->next, away, to));
            }
    }
done:
    return status;
}

// --- Faces

static bool in_window(const growing *g, int32_t face)
{
    for (int i = 0; i < 2; i++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < 3; k++) {
            int32_t v = g->mesh->triangle[face][k];
            if (!g->settled[v]) return false;
            low = MIN(low, g->at[v][i]);
            high = MAX(high, g->at[v][i]);
        }
        if (low > g->half_mm[i] || high < -g->half_mm[i]) return false;
    }
    return true;
}

// With the face the disc stays a disc: it shares one side and its third corner is new, or two sides. Three
// sides would close a sphere; one side and a corner, a ring.
static bool keeps_disc(const growing *g, int32_t face)
{
    int shared = 0, opposite = 0;
    for (int k = 0; k < 3; k++) {
        int32_t o = g->linked->beside[4 * face + k];
        if (o == NO_SIDE || !g->taken[o >> 2]) continue;
        shared++;
        opposite = k;
    }
    return shared == 2 || (shared == 1 && g->number[g->mesh->triangle[face][opposite]] < 0);
}

static jali_status take(jali_context *ctx, growing *g, int32_t face)
{
    jali_status status = JALI_OK;
    disc *d = g->d;
    g->taken[face] = 1;
    d->face[d->face_count] = face;
    for (int k = 0; k < 3; k++) {
        int32_t v = g->mesh->triangle[face][k], o = g->linked->beside[4 * face + k];
        if (g->number[v] < 0) {
            memcpy(d->at[d->vertex_count], g->at[v], sizeof *d->at);
            d->vertex[d->vertex_count] = v;
            g->number[v] = d->vertex_count++;
        }
        d->corner[d->face_count][k] = g->number[v];
        if (o == NO_SIDE || g->taken[o >> 2] || !in_window(g, o >> 2)) continue;
        double away = 0;
        for (int i = 0; i < 3; i++) away += g->distance[g->mesh->triangle[o >> 2][i]];
        TRY(push(ctx, &g->next, away, o >> 2));
    }
    d->face_count++;
done:
    return status;
}

static jali_status take_faces(jali_context *ctx, growing *g, int32_t first)
{
    jali_status status;
    disc *d = g->d;
    TRY(take(ctx, g, first));
    while (g->next.count > 0) {
        int32_t face = pop(&g->next).item;
        if (!g->taken[face] && keeps_disc(g, face)) TRY(take(ctx, g, face));
    }
    for (int32_t f = 0; f < d->face_count; f++) {
        d->border[f] = 0;
        for (int k = 0; k < 3; k++) {
            int32_t o = g->linked->beside[4 * d->face[f] + k];
            if (o == NO_SIDE || !g->taken[o >> 2]) d->border[f] |= (uint8_t)(1 << k);
            if (o != NO_SIDE && !g->taken[o >> 2] && !in_window(g, o >> 2))
                d->border[f] |= (uint8_t)(16 << k);
        }
    }
done:
    return status;
}

jali_status grow_disc(jali_context *ctx, const jali_mesh *mesh, const sides *linked, const disc_seed *seed,
                      const double half_mm[2], disc *d)
{
    jali_status status;
    growing g = {.mesh = mesh, .linked = linked, .half_mm = {half_mm[0], half_mm[1]}, .d = d};
    size_t vertices = (size_t)mesh->vertex_count + 1, faces = (size_t)mesh->triangle_count + 1;
    *d = (disc){.mesh = mesh};
    TRY(ARENA(ctx, d->vertex, vertices));
    TRY(ARENA(ctx, d->at, vertices));
    TRY(ARENA(ctx, d->face, faces));
    TRY(ARENA(ctx, d->corner, faces));
    TRY(ARENA(ctx, d->border, faces));
    arena_mark mark = arena_here(ctx);
    TRY(ARENA(ctx, g.normal, vertices));
    TRY(ARENA(ctx, g.right, vertices));
    TRY(ARENA(ctx, g.at, vertices));
    TRY(ARENA(ctx, g.distance, vertices));
    TRY(ARENA(ctx, g.settled, vertices));
    TRY(ARENA(ctx, g.number, vertices));
    TRY(ARENA(ctx, g.taken, faces));
    memset(g.settled, 0, vertices);
    memset(g.taken, 0, faces);
    for (size_t v = 0; v < vertices; v++) {
        g.distance[v] = INFINITY;
        g.number[v] = -1;
    }
    vertex_normals(&g);
    TRY(walk(ctx, &g, seed));
    TRY(take_faces(ctx, &g, seed->face));
    arena_rewind(ctx, mark);
done:
    release(ctx, g.next.heap);
    return status;
}
