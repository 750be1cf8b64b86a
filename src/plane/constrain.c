// Constrained edges: flip what crosses them, then restore the Delaunay property beside them.
//
// Source:  Sloan: A fast algorithm for generating constrained Delaunay triangulations (1993).
// Limits:  an edge that crosses k others takes O(k) flips in the mean, O(k^2) in the worst case. Edges that
//          cross are reported, not cut: their crossing is in general no lattice point.
// Checked: tests/test_plane.c: every free side against the in-circle definition, every edge present.
#include "plane/triangulation.h"

#include "plane/exact.h"

enum { EDGES_A_STEP = 1 << 14 };

typedef struct crossing {
    int32_t right, left;
} crossing; // ends of an edge, seen along the constraint

// Pending edges of one constraint: those still crossing it (a ring), and those made by flips.
typedef struct pending {
    crossing *cross, *made;
    size_t cross_capacity, made_capacity, made_count;
} pending;

// Turns around both ends in step.
int32_t side_between(const triangulation *plane, int32_t u, int32_t v)
{
    const int32_t *corner = plane->corner, *beside = plane->beside;
    int32_t first_u = 4 * plane->star[u], first_v = 4 * plane->star[v];
    while (corner[first_u] != u) first_u++;
    while (corner[first_v] != v) first_v++;
    int32_t s = first_u, o = first_v;
    do { // s and o are sides opposite u and v
        if (corner[next_side(s)] == v) return last_side(s);
        if (corner[next_side(o)] == u) return beside[last_side(o)];
        s = next_side(beside[next_side(s)]);
        o = next_side(beside[next_side(o)]);
    } while (s != first_u && o != first_v);
    return -1;
}

static void mark(triangulation *plane, int32_t s, uint8_t kind)
{
    plane->kind[s] |= kind;
    plane->kind[plane->beside[s]] |= kind;
}

// What the segment from a to b meets first: *side = the side opposite a that it crosses, or -1 and *end = the
// point it reaches (b, or a point on the way).
static void leave_point(const triangulation *plane, int32_t a, int32_t b, int32_t *side, int32_t *end)
{
    const int32_t *from = plane->point[a], *to = plane->point[b];
    int32_t s = 4 * plane->star[a];
    while (plane->corner[s] != a) s++;
    for (;; s = next_side(plane->beside[next_side(s)])) {
        int32_t x = plane->corner[next_side(s)], y = plane->corner[last_side(s)];
        if (x == GHOST) continue;
        int64_t turn_x = orientation(from, to, plane->point[x]);
        if (turn_x == 0 && (x == b || strictly_between(from, to, plane->point[x]))) {
            *side = -1;
            *end = x;
            return;
        }
        if (y != GHOST && turn_x < 0 && orientation(from, to, plane->point[y]) > 0) {
            *side = s;
            return;
        }
    }
}

// Collect the edges that the segment from a crosses on its way to b; *end is the point where that ends (a
// itself when an edge that may not be crossed is met at once).
static jali_status collect(jali_context *ctx, const triangulation *plane, int32_t a, int32_t b,
                           pending *edges, size_t *count, int32_t *end, contact *met)
{
    int32_t s;
    *count = 0;
    *end = a;
    leave_point(plane, a, b, &s, end);
    while (s >= 0) {
        crossing c = {plane->corner[next_side(s)], plane->corner[last_side(s)]};
        if (plane->kind[s] != 0) {
            *met = (contact){EDGES_CROSS, a, b, {c.right, c.left}};
            return JALI_OK;
        }
        jali_status status = GROW(ctx, edges->cross, edges->cross_capacity, *count + 1);
        if (status != JALI_OK) return status;
        edges->cross[(*count)++] = c;
        int32_t o = plane->beside[s], apex = plane->corner[o];
        int64_t turn = orientation(plane->point[a], plane->point[b], plane->point[apex]);
        *end = apex;
        // In the next triangle (apex, left, right) the segment leaves between the apex and one of the two.
        s = turn == 0 ? -1 : turn > 0 ? next_side(o) : last_side(o);
    }
    return JALI_OK;
}

bool is_convex(const triangulation *plane, int32_t s)
{
    int32_t o = plane->beside[s];
    const int32_t *p = plane->point[plane->corner[s]], *q = plane->point[plane->corner[o]];
    return orientation(p, plane->point[plane->corner[next_side(s)]], q) > 0 &&
           orientation(q, plane->point[plane->corner[next_side(o)]], p) > 0;
}

// Flip the crossing edges until none is left. What a flip makes either crosses still or is kept in `made`.
static jali_status clear_way(jali_context *ctx, triangulation *plane, int32_t a, int32_t b, pending *edges,
                             size_t count)
{
    size_t ring = count, head = 0, left = count;
    edges->made_count = 0;
    while (left > 0) {
        crossing c = edges->cross[head];
        int32_t s = side_between(plane, c.right, c.left);
        size_t tail = (head + left) % ring;
        head = (head + 1) % ring;
        if (!is_convex(plane, s)) {
            edges->cross[tail] = c;
            continue;
        }
        int32_t p = plane->corner[s], q = plane->corner[plane->beside[s]];
        flip_side(plane, s);
        int64_t side_p = orientation(plane->point[a], plane->point[b], plane->point[p]);
        int64_t side_q = orientation(plane->point[a], plane->point[b], plane->point[q]);
        if ((side_p < 0 && side_q > 0) || (side_p > 0 && side_q < 0)) {
            edges->cross[tail] = side_p < 0 ? (crossing){p, q} : (crossing){q, p};
            continue;
        }
        left--;
        jali_status status = GROW(ctx, edges->made, edges->made_capacity, edges->made_count + 1);
        if (status != JALI_OK) return status;
        edges->made[edges->made_count++] = (crossing){p, q};
    }
    return JALI_OK;
}

// Lawson's flips from the made edges outwards. A flip moves edges to other sides, but it also puts the four
// around it on the stack, so none is forgotten.
static jali_status restore_delaunay(jali_context *ctx, triangulation *plane, const pending *edges)
{
    for (size_t i = 0; i < edges->made_count; i++) {
        int32_t made = side_between(plane, edges->made[i].right, edges->made[i].left);
        if (made < 0) continue; // flipped away meanwhile
        size_t depth = 0;
        plane->stack[depth++] = made;
        while (depth > 0) {
            int32_t s = plane->stack[--depth], o = plane->beside[s];
            if (plane->kind[s] != 0 || is_ghost(plane, s >> 2) || is_ghost(plane, o >> 2)) continue;
            if (!in_disc(plane, o >> 2, plane->corner[s])) continue;
            flip_side(plane, s);
            jali_status status = GROW(ctx, plane->stack, plane->stack_capacity, depth + 4);
            if (status != JALI_OK) return status;
            plane->stack[depth++] = s;
            plane->stack[depth++] = last_side(s);
            plane->stack[depth++] = o;
            plane->stack[depth++] = last_side(o);
        }
    }
    return JALI_OK;
}

static jali_status insert_edge(jali_context *ctx, triangulation *plane, int32_t from, int32_t to,
                               uint8_t kind, bool through, pending *edges, contact *met)
{
    jali_status status = JALI_OK;
    int32_t a = plane->twin[from], b = plane->twin[to], end;
    while (a != b) {
        size_t count;
        TRY(collect(ctx, plane, a, b, edges, &count, &end, met));
        if (met->found == NO_CONTACT && end != b && !through)
            *met = (contact){EDGE_MEETS_POINT, a, b, {end, end}};
        if (met->found != NO_CONTACT) {
            met->from = from;
            met->to = to;
            return JALI_OK;
        }
        TRY(clear_way(ctx, plane, a, end, edges, count));
        mark(plane, side_between(plane, a, end), kind);
        TRY(restore_delaunay(ctx, plane, edges));
        a = end;
    }
done:
    return status;
}

jali_status insert_edges(jali_context *ctx, triangulation *plane, const int32_t (*edge)[2], int32_t count,
                         uint8_t kind, bool through, contact *met)
{
    jali_status status = JALI_OK;
    pending edges = {0};
    *met = (contact){0};
    for (int32_t i = 0; i < count && plane->triangle_count > 0 && met->found == NO_CONTACT; i++) {
        if (i % EDGES_A_STEP == 0) TRY(step(ctx, "triangulate", (double)i / count));
        TRY(insert_edge(ctx, plane, edge[i][0], edge[i][1], kind, through, &edges, met));
    }
done:
    release(ctx, edges.cross);
    release(ctx, edges.made);
    return status;
}
