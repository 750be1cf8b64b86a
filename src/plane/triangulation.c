// Delaunay triangulation of lattice points, one point at a time.
//
// Source:  Lawson's flips (1977) in the order of order.c. The hull is closed by ghost triangles that share
// one
//          corner at infinity (Guibas and Stolfi 1985), so a point outside needs no case of its own.
// Limits:  |coordinate| <= 2^24; fewer than 2^27 points. Points at the same place are stored once (twin).
// Checked: tests/test_plane.c: every side against the in-circle definition; grids, circles, lines, random.
#include "plane/triangulation.h"

#include "plane/exact.h"
#include "plane/order.h"

#include <stdlib.h>

enum { POINT_LIMIT = 1 << 27, POINTS_A_STEP = 1 << 14 };

void triangulation_free(jali_context *ctx, triangulation *plane)
{
    release(ctx, plane->point);
    release(ctx, plane->twin);
    release(ctx, plane->star);
    release(ctx, plane->corner);
    release(ctx, plane->beside);
    release(ctx, plane->kind);
    release(ctx, plane->stack);
    *plane = (triangulation){0};
}

// A triangulation of n points, closed by ghosts, has 2 n - 2 triangles.
jali_status reserve_points(jali_context *ctx, triangulation *plane, int32_t points)
{
    jali_status status;
    if (points > POINT_LIMIT)
        return fail(ctx, JALI_LIMIT, "%d points are more than the %d a triangulation holds", points,
                    POINT_LIMIT);
    size_t sides = 8 * (size_t)points, capacity;
    // Arrays of one length grow alike, so each starts from the length they all have.
    TRY((capacity = plane->point_capacity, GROW(ctx, plane->point, capacity, points)));
    TRY((capacity = plane->point_capacity, GROW(ctx, plane->twin, capacity, points)));
    TRY((capacity = plane->point_capacity, GROW(ctx, plane->star, capacity, points)));
    plane->point_capacity = capacity;
    TRY((capacity = plane->side_capacity, GROW(ctx, plane->corner, capacity, sides)));
    TRY((capacity = plane->side_capacity, GROW(ctx, plane->beside, capacity, sides)));
    TRY((capacity = plane->side_capacity, GROW(ctx, plane->kind, capacity, sides)));
    plane->side_capacity = capacity;
    // The sides opposite a new point that wait for their test are edges around it: fewer than points + 2.
    TRY(GROW(ctx, plane->stack, plane->stack_capacity, (size_t)points + 8));
done:
    return status;
}

bool in_disc(const triangulation *plane, int32_t t, int32_t p)
{
    const int32_t *corner = plane->corner + 4 * t, (*point)[2] = (const int32_t(*)[2])plane->point;
    for (int k = 0; k < 3; k++) {
        if (corner[k] != GHOST) continue;
        const int32_t *from = point[corner[(k + 1) % 3]], *to = point[corner[(k + 2) % 3]];
        int64_t beyond = orientation(from, to, point[p]);
        return beyond > 0 || (beyond == 0 && strictly_between(from, to, point[p]));
    }
    return in_circle(point[corner[0]], point[corner[1]], point[corner[2]], point[p]);
}

static void move_side(triangulation *plane, int32_t from, int32_t to)
{
    join_sides(plane, to, plane->beside[from]);
    plane->kind[to] = plane->kind[from];
}

void flip_side(triangulation *plane, int32_t s)
{
    int32_t o = plane->beside[s], sn = next_side(s), sl = last_side(s), on = next_side(o), ol = last_side(o);
    int32_t a = plane->corner[sn], b = plane->corner[sl];
    plane->corner[sl] = plane->corner[o];
    plane->corner[ol] = plane->corner[s];
    move_side(plane, on, s);
    move_side(plane, sn, o);
    join_sides(plane, sn, on);
    plane->kind[sn] = plane->kind[on] = 0;
    if (a != GHOST) plane->star[a] = s >> 2;
    if (b != GHOST) plane->star[b] = o >> 2;
}

// Flip away the edges opposite p whose other triangle has p in its circle. The sides to test are on the
// stack.
static void settle(triangulation *plane, int32_t p, int32_t *stack, int32_t depth)
{
    while (depth > 0) {
        int32_t s = stack[--depth];
        if (plane->kind[s] != 0 || !in_disc(plane, plane->beside[s] >> 2, p)) continue;
        int32_t other = last_side(plane->beside[s]);
        flip_side(plane, s);
        stack[depth++] = s;
        stack[depth++] = other;
    }
}

static int32_t add_triangle(triangulation *plane, int32_t a, int32_t b, int32_t c)
{
    int32_t t = plane->triangle_count++, corners[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        plane->corner[4 * t + k] = corners[k];
        plane->kind[4 * t + k] = 0;
        if (corners[k] != GHOST) plane->star[corners[k]] = t;
    }
    return t;
}

// Triangle (a, b, c) becomes (a, b, p); (b, c, p) and (c, a, p) are new.
int32_t split_triangle(triangulation *plane, int32_t t, int32_t p)
{
    int32_t a = plane->corner[4 * t], b = plane->corner[4 * t + 1], c = plane->corner[4 * t + 2];
    int32_t u = add_triangle(plane, b, c, p), v = add_triangle(plane, c, a, p);
    move_side(plane, 4 * t, 4 * u + 2);
    move_side(plane, 4 * t + 1, 4 * v + 2);
    plane->corner[4 * t + 2] = p;
    plane->kind[4 * t] = plane->kind[4 * t + 1] = 0;
    join_sides(plane, 4 * t, 4 * u + 1);
    join_sides(plane, 4 * u, 4 * v + 1);
    join_sides(plane, 4 * v, 4 * t + 1);
    if (a != GHOST) plane->star[a] = t;
    int32_t *stack = plane->stack;
    stack[0] = 4 * t + 2;
    stack[1] = 4 * u + 2;
    stack[2] = 4 * v + 2;
    return 3;
}

// Point p on side s: the triangles (c, a, b) and (d, b, a) beside it become four. Both halves keep its kind.
int32_t split_side(triangulation *plane, int32_t s, int32_t p)
{
    int32_t o = plane->beside[s], sn = next_side(s), on = next_side(o);
    int32_t a = plane->corner[sn], b = plane->corner[on];
    int32_t u = add_triangle(plane, plane->corner[s], p, b), v = add_triangle(plane, plane->corner[o], p, a);
    uint8_t kind = plane->kind[s];
    move_side(plane, sn, 4 * u + 1); // b -> c
    move_side(plane, on, 4 * v + 1); // a -> d
    plane->corner[last_side(s)] = p; // (c, a, p)
    plane->corner[last_side(o)] = p; // (d, b, p)
    join_sides(plane, sn, 4 * u + 2);
    join_sides(plane, on, 4 * v + 2);
    join_sides(plane, s, 4 * v);
    join_sides(plane, o, 4 * u);
    plane->kind[sn] = plane->kind[on] = 0;
    plane->kind[4 * u] = plane->kind[4 * v] = plane->kind[o] = kind;
    if (a != GHOST) plane->star[a] = s >> 2;
    if (b != GHOST) plane->star[b] = o >> 2;
    int32_t *stack = plane->stack;
    stack[0] = last_side(s);
    stack[1] = last_side(o);
    stack[2] = 4 * u + 1;
    stack[3] = 4 * v + 1;
    return 4;
}

bool can_split_side(const triangulation *plane, int32_t s, const int32_t at[2])
{
    const int32_t *corner = plane->corner, (*point)[2] = (const int32_t(*)[2])plane->point;
    for (int k = 0; k < 2; k++, s = plane->beside[s]) {
        int32_t apex = corner[s], from = corner[next_side(s)], to = corner[last_side(s)];
        if (apex == GHOST || from == GHOST || to == GHOST) continue;
        if (orientation(point[apex], point[from], at) <= 0 || orientation(point[to], point[apex], at) <= 0)
            return false;
    }
    return true;
}

// The triangle that holds p, or a ghost beyond whose hull edge p lies. On constrained triangulations a walk
// with a fixed first side could circle; a hash of the step picks it.
static int32_t walk(const triangulation *plane, int32_t t, const int32_t p[2])
{
    for (uint32_t steps = 1;; steps++) {
        int first = (int)((steps * 2654435769u) >> 30) % 3, k;
        for (k = 0; k < 3; k++) {
            int32_t s = 4 * t + (first + k) % 3;
            int32_t from = plane->corner[next_side(s)], to = plane->corner[last_side(s)];
            if (from == GHOST || to == GHOST) continue;
            if (orientation(plane->point[from], plane->point[to], p) < 0) {
                t = plane->beside[s] >> 2;
                break;
            }
        }
        if (k == 3 || is_ghost(plane, t)) return t;
    }
}

static void insert_point(triangulation *plane, int32_t p)
{
    const int32_t *at = plane->point[p];
    int32_t t = plane->recent;
    for (int k = 0; k < 3; k++)
        if (plane->corner[4 * t + k] == GHOST) t = plane->beside[4 * t + k] >> 2;
    t = walk(plane, t, at);
    plane->recent = t;
    int32_t on_side = -1;
    for (int k = 0; k < 3 && !is_ghost(plane, t); k++) {
        int32_t s = 4 * t + k, corner = plane->corner[s];
        if (plane->point[corner][0] == at[0] && plane->point[corner][1] == at[1]) {
            plane->twin[p] = corner;
            return;
        }
        if (orientation(plane->point[plane->corner[next_side(s)]], plane->point[plane->corner[last_side(s)]],
                        at) == 0)
            on_side = s;
    }
    settle(plane, p, plane->stack,
           on_side >= 0 ? split_side(plane, on_side, p) : split_triangle(plane, t, p));
}

// The first triangle and its three ghosts: the first point of the order, the next elsewhere, and the next off
// their line. Returns false while all points lie on one line.
static bool begin(triangulation *plane, const int32_t *order, int32_t count)
{
    const int32_t(*point)[2] = (const int32_t(*)[2])plane->point;
    int32_t a = order[0], b = a, c = a;
    for (int32_t i = 1; i < count && c == a; i++) {
        int32_t p = order[i];
        if (b == a && (point[p][0] != point[a][0] || point[p][1] != point[a][1]))
            b = p;
        else if (b != a && orientation(point[a], point[b], point[p]) != 0)
            c = p;
    }
    if (c == a) return false;
    if (orientation(point[a], point[b], point[c]) < 0) {
        int32_t swapped = b;
        b = c;
        c = swapped;
    }
    int32_t corners[3] = {a, b, c}, inner = add_triangle(plane, a, b, c);
    for (int k = 0; k < 3; k++) {
        int32_t from = corners[(k + 2) % 3], to = corners[(k + 1) % 3];
        int32_t ghost = add_triangle(plane, from, to, GHOST);
        join_sides(plane, 4 * inner + k, 4 * ghost + 2);
    }
    for (int32_t k = 0; k < 3; k++) // ghost k + 1 ends where ghost k begins ... around the hull
        join_sides(plane, 4 * (inner + 1 + k), 4 * (inner + 1 + (k + 2) % 3) + 1);
    plane->recent = inner;
    return true;
}

jali_status insert_points(jali_context *ctx, triangulation *plane, const int32_t (*point)[2], int32_t count)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t first = plane->point_count, *order;
    if (count == 0) return JALI_OK;
    if ((int64_t)first + count > POINT_LIMIT)
        return fail(ctx, JALI_LIMIT, "%lld points are more than the %d a triangulation holds",
                    (long long)first + count, POINT_LIMIT);
    for (int32_t i = 0; i < count; i++)
        if (abs(point[i][0]) > COORDINATE_LIMIT || abs(point[i][1]) > COORDINATE_LIMIT)
            return fail(ctx, JALI_BAD_INPUT, "point (%d, %d) lies outside the lattice of +-%d units",
                        point[i][0], point[i][1], COORDINATE_LIMIT);
    if (plane->triangle_count == 0) first = 0; // all on one line so far: begin again
    int32_t end = plane->point_count + count;
    TRY(reserve_points(ctx, plane, end));
    memcpy(plane->point + plane->point_count, point, (size_t)count * sizeof *point);
    plane->point_count = end;
    for (int32_t i = first; i < end; i++) plane->twin[i] = i;
    TRY(ARENA(ctx, order, end - first));
    TRY(insertion_order(ctx, (const int32_t(*)[2])plane->point + first, end - first, order));
    for (int32_t i = first; i < end; i++) order[i - first] += first;
    bool begun = plane->triangle_count == 0;
    if (begun && !begin(plane, order, end)) goto done;
    for (int32_t i = 0; i < end - first; i++) {
        if (i % POINTS_A_STEP == 0) TRY(step(ctx, "triangulate", (double)i / (end - first)));
        insert_point(plane, order[i]);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
