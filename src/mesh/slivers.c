// Slivers: three vertices that lie on one line in space although they do not on the chart's lattice.
//
// Why:     an edge of the surface that a contour crosses is bent by up to half a unit of the chart's lattice
//          there, while the crossing is lifted onto the straight edge: what triangulates the bend has no
//          area. Rounded to the lattice of the file it may even be turned over.
// How:     an edge shorter than that loses one of its ends; else a flip of the longest edge, where the
// quadrilateral around it stays upright on both skins and the
//          lower of the two heights grows. Heights grow with each flip, so it ends; a cap makes sure.
// Checked: tests/test_shell.c.
#include "mesh/slivers.h"

#include "mesh/sides.h"
#include "plane/triangulation.h"
#include "base/vector.h"

#include <math.h>

enum { FLIPS_A_SLIVER = 8, MOST_RING = 64 };

typedef struct mending {
    jali_shell *shell;
    sides linked;
    int skins;
    double least;
    uint8_t *gone; // [triangles]
} mending;

static const double *place(const mending *m, int skin, int32_t vertex)
{
    return skin ? m->shell->inner[vertex] : m->shell->outer.mesh.vertex[vertex];
}

static void normal(const mending *m, int skin, int32_t a, int32_t b, int32_t c, double n[3])
{
    const double *p = place(m, skin, a), *q = place(m, skin, b), *r = place(m, skin, c);
    double u[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, v[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    for (int k = 0; k < 3; k++) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
}

static double length2(const mending *m, int skin, int32_t a, int32_t b)
{
    const double *p = place(m, skin, a), *q = place(m, skin, b);
    double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    return dot(d, d);
}

// The lower of a triangle's heights on the two skins, seen along `up` when given: negative when turned over.
static double height(const mending *m, int32_t a, int32_t b, int32_t c, const double up[2][3])
{
    double least = INFINITY;
    for (int skin = 0; skin < m->skins; skin++) {
        double n[3], longest;
        normal(m, skin, a, b, c, n);
        longest = MAX(length2(m, skin, a, b), MAX(length2(m, skin, b, c), length2(m, skin, c, a)));
        double h = longest > 0 ? sqrt(dot(n, n) / longest) : 0;
        if (up && dot(n, up[skin]) <= 0) h = -h;
        least = MIN(least, h);
    }
    return least;
}

static int32_t corner(const mending *m, int32_t s)
{
    return m->linked.corner[s];
}

static double height_of(const mending *m, int32_t t)
{
    return height(m, corner(m, 4 * t), corner(m, 4 * t + 1), corner(m, 4 * t + 2), NULL);
}

static int32_t longest_side(const mending *m, int32_t t)
{
    int32_t longest = 4 * t;
    double most = -1;
    for (int32_t s = 4 * t; s < 4 * t + 3; s++) {
        double here = length2(m, 0, corner(m, next_side(s)), corner(m, last_side(s)));
        if (here > most) most = here, longest = s;
    }
    return longest;
}

static bool same_interval(const mending *m, int32_t t, int32_t u)
{
    const float(*solid)[2] = (const float(*)[2])m->shell->solid;
    return !solid || (solid[t][0] == solid[u][0] && solid[t][1] == solid[u][1]);
}

static void join(mending *m, int32_t s, int32_t o)
{
    m->linked.beside[s] = o;
    if (o != NO_SIDE) m->linked.beside[o] = s;
}

static void swap_uv(const mending *m, int32_t t, int into, int32_t u, int from)
{
    double(*uv)[3][2] = m->shell->outer.uv;
    if (uv) memcpy(uv[t][into], uv[u][from], sizeof uv[t][into]);
}

// Side s of triangle (p, a, b) and side o of (q, b, a) beside it: they become (p, a, q) and (q, b, p).
static void flip(mending *m, int32_t s)
{
    int32_t o = m->linked.beside[s], p = corner(m, s), q = corner(m, o);
    int32_t after_s = m->linked.beside[next_side(s)], after_o = m->linked.beside[next_side(o)];
    int32_t t = s >> 2, u = o >> 2;
    m->linked.corner[last_side(s)] = q;
    m->linked.corner[last_side(o)] = p;
    double kept[2] = {0, 0};
    if (m->shell->outer.uv) memcpy(kept, m->shell->outer.uv[t][s & 3], sizeof kept);
    swap_uv(m, t, last_side(s) & 3, u, o & 3);
    if (m->shell->outer.uv) memcpy(m->shell->outer.uv[u][last_side(o) & 3], kept, sizeof kept);
    join(m, s, after_o); // a -> q
    join(m, o, after_s); // b -> p
    join(m, next_side(s), next_side(o));
}

// --- Short edges: the two ends become one

// The sides that leave a vertex's triangles opposite it, and whether it lies on a border.
typedef struct ring {
    int32_t count, corner[MOST_RING]; // corner[i]: the side of a triangle that lies opposite the vertex
    bool border, whole;               // whole: the ring has room for all of them
} ring;

static ring ring_of(const mending *m, int32_t s) // corner(m, s) is the vertex
{
    ring r = {.whole = true};
    int32_t at = s;
    do { // counter-clockwise
        if (r.count == MOST_RING) r.whole = false;
        if (!r.whole) return r;
        r.corner[r.count++] = at;
        int32_t across = m->linked.beside[next_side(at)];
        if (across == NO_SIDE) r.border = true;
        at = across == NO_SIDE ? -1 : next_side(across);
    } while (at >= 0 && at != s);
    for (at = s; r.border;) { // and the other way from the start
        int32_t across = m->linked.beside[last_side(at)];
        if (across == NO_SIDE) break;
        at = last_side(across);
        if (r.count == MOST_RING) r.whole = false;
        if (!r.whole) return r;
        r.corner[r.count++] = at;
    }
    return r;
}

static bool is_around(const mending *m, const ring *r, int32_t vertex)
{
    for (int32_t i = 0; i < r->count; i++)
        if (corner(m, next_side(r->corner[i])) == vertex || corner(m, last_side(r->corner[i])) == vertex)
            return true;
    return false;
}

// Would the triangles around a vertex, but for the two beside the edge, stay upright with it moved to `to`?
static bool stay_upright(const mending *m, const ring *r, int32_t to, int32_t t, int32_t u)
{
    for (int32_t i = 0; i < r->count; i++) {
        int32_t here = r->corner[i], a = corner(m, next_side(here)), b = corner(m, last_side(here));
        if (here >> 2 == t || here >> 2 == u || height_of(m, here >> 2) < m->least) continue;
        double up[2][3];
        for (int skin = 0; skin < m->skins; skin++) normal(m, skin, corner(m, here), a, b, up[skin]);
        if (height(m, to, a, b, (const double(*)[3])up) <= 0) return false;
    }
    return true;
}

static void drop_beside(mending *m, int32_t s)
{
    int32_t x = m->linked.beside[next_side(s)], y = m->linked.beside[last_side(s)];
    if (x != NO_SIDE) m->linked.beside[x] = y;
    if (y != NO_SIDE) m->linked.beside[y] = x;
    m->gone[s >> 2] = 1;
}

// Make the ends of side s one vertex, if nothing but its own triangles is lost by that (the link condition).
static bool collapse(mending *m, int32_t s)
{
    int32_t o = m->linked.beside[s], t = s >> 2, u = o == NO_SIDE ? -1 : o >> 2;
    if (u >= 0 && !same_interval(m, t, u)) return false;
    // The end at corner(last_side(s)) goes; the other one stays.
    ring stays = ring_of(m, next_side(s)), goes = ring_of(m, last_side(s));
    if (!stays.whole || !goes.whole || (stays.border && goes.border && o != NO_SIDE)) return false;
    if (goes.border && !stays.border) return false; // the other way round, when the neighbour is looked at
    int32_t common = 0, vertex = corner(m, next_side(s));
    for (int32_t i = 0; i < goes.count; i++) {
        int32_t here = goes.corner[i], ends[2] = {next_side(here), last_side(here)};
        bool last = m->linked.beside[ends[0]] == NO_SIDE; // of a border: its end counts as well
        common += is_around(m, &stays, corner(m, ends[0]));
        common += last && is_around(m, &stays, corner(m, ends[1]));
    }
    if (common != (o == NO_SIDE ? 1 : 2) || !stay_upright(m, &goes, vertex, t, u)) return false;
    for (int32_t i = 0; i < goes.count; i++) m->linked.corner[goes.corner[i]] = vertex;
    drop_beside(m, s);
    if (o != NO_SIDE) drop_beside(m, o);
    return true;
}

static bool collapse_short(mending *m, int32_t t)
{
    for (int32_t s = 4 * t; s < 4 * t + 3; s++) {
        int32_t a = corner(m, next_side(s)), b = corner(m, last_side(s));
        double shortest2 = MIN(length2(m, 0, a, b), length2(m, m->skins - 1, a, b));
        if (shortest2 >= 4 * m->least * m->least) continue;
        if (collapse(m, s)) return true;
        if (m->linked.beside[s] != NO_SIDE && collapse(m, m->linked.beside[s])) return true; // the other end
    }
    return false;
}

// Try to get rid of the sliver t; *other is the triangle that was changed with it.
static bool mend(mending *m, int32_t t, int32_t *other)
{
    *other = -1;
    if (collapse_short(m, t)) return true;
    int32_t s = longest_side(m, t), o = m->linked.beside[s];
    if (o == NO_SIDE || !same_interval(m, t, o >> 2)) {
        if (o != NO_SIDE) { // the border between two heights moves by the sliver's width
            memcpy(m->shell->solid[t], m->shell->solid[o >> 2], sizeof *m->shell->solid);
        } else {
            for (int32_t k = 4 * t; k < 4 * t + 3; k++)
                if (m->linked.beside[k] != NO_SIDE) m->linked.beside[m->linked.beside[k]] = NO_SIDE;
            m->gone[t] = 1;
            return true;
        }
    }
    int32_t p = corner(m, s), q = corner(m, o), a = corner(m, next_side(s)), b = corner(m, last_side(s));
    ring around = ring_of(m, s);
    if (!around.whole || is_around(m, &around, q)) return false; // an edge between them is there
    double up[2][3];
    for (int skin = 0; skin < m->skins; skin++) normal(m, skin, q, b, a, up[skin]);
    double before = MIN(height(m, p, a, b, NULL), height(m, q, b, a, NULL));
    double after =
        MIN(height(m, p, a, q, (const double(*)[3])up), height(m, q, b, p, (const double(*)[3])up));
    if (after <= before) return false;
    flip(m, s);
    *other = o >> 2;
    return true;
}

// Write the triangles back without those that went.
static void gather(const mending *m)
{
    jali_shell *shell = m->shell;
    int32_t kept = 0;
    for (int32_t t = 0; t < shell->outer.mesh.triangle_count; t++) {
        if (m->gone[t]) continue;
        for (int k = 0; k < 3; k++) shell->outer.mesh.triangle[kept][k] = m->linked.corner[4 * t + k];
        if (shell->outer.uv) memmove(shell->outer.uv[kept], shell->outer.uv[t], sizeof *shell->outer.uv);
        if (shell->outer.faulty) shell->outer.faulty[kept] = shell->outer.faulty[t];
        if (shell->solid) memmove(shell->solid[kept], shell->solid[t], sizeof *shell->solid);
        kept++;
    }
    shell->outer.mesh.triangle_count = kept;
}

static bool is_thin(const mending *m, int32_t t, int32_t from)
{
    bool chosen = from == 0;
    for (int k = 0; k < 3; k++) chosen |= corner(m, 4 * t + k) >= from;
    return chosen && height_of(m, t) < m->least;
}

jali_status mend_slivers(jali_context *ctx, jali_shell *shell, double least_mm, int32_t from, int32_t *left)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t triangles = shell->outer.mesh.triangle_count, thin = 0, waiting = 0, *stack;
    mending m = {.shell = shell, .skins = shell->inner ? 2 : 1, .least = least_mm};
    *left = 0;
    TRY(sides_create(ctx, shell->outer.mesh.vertex_count, triangles,
                     (const int32_t(*)[3])shell->outer.mesh.triangle, &m.linked));
    TRY(ARENA(ctx, m.gone, triangles + 1));
    memset(m.gone, 0, (size_t)triangles);
    for (int32_t t = 0; t < triangles; t++) thin += is_thin(&m, t, from);
    size_t room = (size_t)thin * (FLIPS_A_SLIVER + 1) * 2 + 1;
    TRY(ARENA(ctx, stack, room));
    for (int32_t t = triangles - 1; t >= 0; t--)
        if (is_thin(&m, t, from)) stack[waiting++] = t;
    for (int64_t budget = (int64_t)thin * FLIPS_A_SLIVER; waiting > 0 && budget > 0; budget--) {
        int32_t t = stack[--waiting], other;
        if (m.gone[t] || height_of(&m, t) >= m.least || !mend(&m, t, &other)) continue;
        if (!m.gone[t]) stack[waiting++] = t;
        if (other >= 0) stack[waiting++] = other;
    }
    for (int32_t t = 0; t < triangles; t++) *left += !m.gone[t] && is_thin(&m, t, from);
    gather(&m);
done:
    sides_free(ctx, &m.linked);
    arena_rewind(ctx, mark);
    return status;
}
