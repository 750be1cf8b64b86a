// The solid over the cells of a plane or a surface: each cell is a triangle with a height interval.
//
// How:     above each point of the plane stands a column with the levels at which a cell around it begins or
//          ends. Floors and ceilings are the cells' own triangles. A wall stands on each edge where one cell
//          is solid and its neighbour is not; it is cut at every level of its two columns, so that all walls
//          on a column share its pieces: no T-junctions.
// Manifold: an edge or vertex of the surface can only fail where solid sectors meet across it. Around a
// column
//          the solid must be one sector at every height; across an edge no cell may end where its neighbour
//          begins; at a level the sectors above and below must overlap, and so must the void ones. Then the
//          solid and the void around each point of the surface are both connected: one fan.
// Checked: tests/test_carve.c: random cells against an edge and fan count of the whole mesh.
#include "carve/prisms.h"

// The columns over the points: column p has the levels level[first[p]] .. level[first[p] + count[p] - 1],
// increasing, and the mesh vertices vertex[p] and on.
typedef struct columns {
    int64_t *first;
    int32_t *count, *vertex, *level;
    int32_t vertex_count;
} columns;

static bool is_solid(interval i)
{
    return i.top > i.bottom;
}
static bool holds(interval i, int32_t low, int32_t high)
{
    return i.bottom <= low && i.top >= high;
}

static void add_level(columns *c, int32_t p, int32_t z)
{
    int32_t *level = c->level + c->first[p], n = c->count[p], at = n;
    while (at > 0 && level[at - 1] >= z) at--;
    if (at < n && level[at] == z) return;
    for (int32_t i = n; i > at; i--) level[i] = level[i - 1];
    level[at] = z;
    c->count[p]++;
}

// Call for each part of the interval that the neighbour's leaves free: at most two.
static int free_parts(interval mine, interval other, interval part[2])
{
    int count = 0;
    if (!is_solid(mine)) return 0;
    if (!is_solid(other) || other.bottom >= mine.top || other.top <= mine.bottom) {
        part[count++] = mine;
        return count;
    }
    if (other.bottom > mine.bottom) part[count++] = (interval){mine.bottom, other.bottom};
    if (other.top < mine.top) part[count++] = (interval){other.top, mine.top};
    return count;
}

// The levels at which the walls on side s are cut; returns how many, adds them to both columns when asked to.
static int32_t cut_walls(const cells *plane, const interval *solid, int32_t s, bool add, columns *c)
{
    interval part[2];
    int32_t cuts = 0, between = plane->slices && plane->slices[s] ? 1 << plane->slices[s] : 0;
    int parts = between ? free_parts(solid[s >> 2], solid[plane->beside[s] >> 2], part) : 0;
    for (int i = 0; i < parts; i++)
        for (int32_t z = (part[i].bottom / between + 1) * between; z < part[i].top; z += between, cuts++)
            if (add) {
                add_level(c, plane->corner[next_side(s)], z);
                add_level(c, plane->corner[last_side(s)], z);
            }
    return cuts;
}

static jali_status raise_columns(jali_context *ctx, const cells *plane, const interval *solid, columns *c)
{
    jali_status status;
    TRY(ARENA(ctx, c->first, plane->point_count + 1));
    TRY(ARENA(ctx, c->count, plane->point_count));
    TRY(ARENA(ctx, c->vertex, plane->point_count));
    memset(c->count, 0, (size_t)plane->point_count * sizeof *c->count);
    for (int32_t t = 0; t < plane->cell_count; t++)
        for (int k = 0; k < 3 && is_solid(solid[t]); k++) {
            int32_t s = 4 * t + k, cuts = cut_walls(plane, solid, s, false, c);
            c->count[plane->corner[s]] += 2;
            c->count[plane->corner[next_side(s)]] += cuts;
            c->count[plane->corner[last_side(s)]] += cuts;
        }
    c->first[0] = 0;
    for (int32_t p = 0; p < plane->point_count; p++) c->first[p + 1] = c->first[p] + c->count[p];
    TRY(ARENA(ctx, c->level, c->first[plane->point_count]));
    memset(c->count, 0, (size_t)plane->point_count * sizeof *c->count);
    for (int32_t t = 0; t < plane->cell_count; t++)
        for (int k = 0; k < 3 && is_solid(solid[t]); k++) {
            add_level(c, plane->corner[4 * t + k], solid[t].bottom);
            add_level(c, plane->corner[4 * t + k], solid[t].top);
            cut_walls(plane, solid, 4 * t + k, true, c);
        }
    int64_t vertices = 0;
    for (int32_t p = 0; p < plane->point_count; p++) {
        c->vertex[p] = (int32_t)vertices;
        vertices += c->count[p];
        if (vertices > INT32_MAX) return fail(ctx, JALI_LIMIT, "the solid has more than 2^31 vertices");
    }
    c->vertex_count = (int32_t)vertices;
done:
    return status;
}

static int32_t rank_of(const columns *c, int32_t p, int32_t z)
{
    const int32_t *level = c->level + c->first[p];
    int32_t rank = 0;
    while (level[rank] != z) rank++;
    return rank;
}

typedef struct writer {
    int32_t (*triangle)[3];
    int64_t count;
} writer; // triangle NULL: count only

static inline void put(writer *w, int32_t a, int32_t b, int32_t c)
{
    if (w->triangle) {
        int32_t *t = w->triangle[w->count];
        t[0] = a, t[1] = b, t[2] = c;
    }
    w->count++;
}

// The wall on the edge from a to b, solid on its left: a strip between the two columns. Where both go up by
// the same, `leans` says which goes first.
static void put_wall(writer *w, const columns *c, int32_t a, int32_t b, interval part, bool leans)
{
    int32_t i = rank_of(c, a, part.bottom), i_end = rank_of(c, a, part.top);
    int32_t j = rank_of(c, b, part.bottom), j_end = rank_of(c, b, part.top);
    const int32_t *level_a = c->level + c->first[a], *level_b = c->level + c->first[b];
    while (i < i_end || j < j_end) {
        bool up_a =
            j == j_end ||
            (i < i_end && (leans ? level_a[i + 1] < level_b[j + 1] : level_a[i + 1] <= level_b[j + 1]));
        int32_t from = c->vertex[a] + i, across = c->vertex[b] + j;
        if (up_a)
            put(w, from, across, c->vertex[a] + ++i);
        else
            put(w, from, across, c->vertex[b] + ++j);
    }
}

static void put_cell(writer *w, const columns *c, const cells *plane, const interval *solid, int32_t t)
{
    interval mine = solid[t];
    int32_t top[3], bottom[3];
    for (int k = 0; k < 3; k++) {
        int32_t p = plane->corner[4 * t + k];
        top[k] = c->vertex[p] + rank_of(c, p, mine.top);
        bottom[k] = c->vertex[p] + rank_of(c, p, mine.bottom);
    }
    put(w, top[0], top[1], top[2]);
    put(w, bottom[0], bottom[2], bottom[1]);
    for (int k = 0; k < 3; k++) {
        int32_t s = 4 * t + k;
        interval part[2];
        int parts = free_parts(mine, solid[plane->beside[s] >> 2], part);
        for (int i = 0; i < parts; i++)
            put_wall(w, c, plane->corner[next_side(s)], plane->corner[last_side(s)], part[i],
                     plane->leans && plane->leans[s]);
    }
}

// Between two levels of column p: how often solid and void change around it, and which of the two occur both
// here and in the slab above.
typedef struct around {
    int changes;
    bool solid, empty, solid_above, empty_above, both_solid, both_empty;
} around;

static around look_around(const cells *plane, const interval *solid, int32_t p, int32_t low, int32_t level,
                          int32_t high)
{
    around a = {0};
    int32_t first = 4 * plane->star[p];
    while (plane->corner[first] != p) first++;
    int32_t s = first;
    bool before = holds(solid[plane->beside[last_side(s)] >> 2], low, level);
    do {
        bool below = holds(solid[s >> 2], low, level), above = holds(solid[s >> 2], level, high);
        a.changes += below != before;
        before = below;
        a.solid |= below, a.empty |= !below, a.solid_above |= above, a.empty_above |= !above;
        a.both_solid |= below && above, a.both_empty |= !below && !above;
        s = next_side(plane->beside[next_side(s)]);
    } while (s != first);
    return a;
}

static bool is_one_fan(const cells *plane, const interval *solid, const columns *c, int32_t p)
{
    const int32_t *level = c->level + c->first[p];
    for (int32_t i = 0; i < c->count[p]; i++) { // the slab that ends at level i, and the one above
        int32_t low = i == 0 ? INT32_MIN : level[i - 1],
                high = i + 1 == c->count[p] ? INT32_MAX : level[i + 1];
        around a = look_around(plane, solid, p, low, level[i], high);
        if (a.changes > 2 || (a.solid && a.solid_above && !a.both_solid) ||
            (a.empty && a.empty_above && !a.both_empty))
            return false;
    }
    return true;
}

static bool is_stepped(const cells *plane, const interval *solid, int32_t s)
{
    interval mine = solid[s >> 2], other = solid[plane->beside[s] >> 2];
    return is_solid(mine) && is_solid(other) && mine.top == other.bottom;
}

// A point where the solid would hang together by no more than an edge or that point, or -1.
static int32_t find_contact(const cells *plane, const interval *solid, const columns *c)
{
    for (int32_t s = 0; s < 4 * plane->cell_count; s++)
        if ((s & 3) != 3 && is_stepped(plane, solid, s)) return plane->corner[next_side(s)];
    for (int32_t p = 0; p < plane->point_count; p++)
        if (c->count[p] > 0 && !is_one_fan(plane, solid, c, p)) return p;
    return -1;
}

void prisms_free(jali_context *ctx, prisms *p)
{
    release(ctx, p->vertex);
    release(ctx, p->triangle);
    *p = (prisms){0};
}

jali_status build_prisms(jali_context *ctx, const cells *plane, const interval *solid, prisms *built)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    columns c;
    writer w = {0};
    *built = (prisms){.contact = -1};
    TRY(raise_columns(ctx, plane, solid, &c));
    built->contact = find_contact(plane, solid, &c);
    if (built->contact >= 0) goto done;
    for (int32_t t = 0; t < plane->cell_count; t++)
        if (is_solid(solid[t])) put_cell(&w, &c, plane, solid, t);
    if (w.count > INT32_MAX) {
        status = fail(ctx, JALI_LIMIT, "the solid has %lld triangles, more than 2^31", (long long)w.count);
        goto done;
    }
    TRY(ALLOCATE(ctx, built->vertex, c.vertex_count));
    TRY(ALLOCATE(ctx, built->triangle, w.count));
    built->vertex_count = c.vertex_count;
    built->triangle_count = (int32_t)w.count;
    for (int32_t p = 0; p < plane->point_count; p++)
        for (int32_t i = 0; i < c.count[p]; i++) {
            built->vertex[c.vertex[p] + i][0] = p;
            built->vertex[c.vertex[p] + i][1] = c.level[c.first[p] + i];
        }
    w = (writer){.triangle = built->triangle};
    for (int32_t t = 0; t < plane->cell_count; t++)
        if (is_solid(solid[t])) put_cell(&w, &c, plane, solid, t);
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) prisms_free(ctx, built);
    return status;
}

jali_status build_plate(jali_context *ctx, const triangulation *plane, const interval *solid, double unit_mm,
                        jali_mesh *mesh)
{
    jali_status status;
    prisms built = {0};
    cells all = {
        plane->point_count, plane->triangle_count, plane->corner, plane->beside, plane->star, NULL, NULL};
    *mesh = (jali_mesh){0};
    TRY(build_prisms(ctx, &all, solid, &built));
    if (built.contact >= 0) {
        const int32_t *at = plane->point[built.contact];
        status = fail(ctx, JALI_BAD_INPUT,
                      "parts of the solid meet in no more than an edge or a point at (%.3f, %.3f) mm",
                      at[0] * unit_mm, at[1] * unit_mm);
        goto done;
    }
    TRY(ALLOCATE(ctx, mesh->vertex, built.vertex_count));
    mesh->vertex_count = built.vertex_count;
    for (int32_t i = 0; i < built.vertex_count; i++) {
        const int32_t *at = plane->point[built.vertex[i][0]];
        mesh->vertex[i][0] = at[0] * unit_mm;
        mesh->vertex[i][1] = at[1] * unit_mm;
        mesh->vertex[i][2] = built.vertex[i][1] * unit_mm;
    }
    mesh->triangle_count = built.triangle_count;
    mesh->triangle = built.triangle;
    built.triangle = NULL;
done:
    prisms_free(ctx, &built);
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    return status;
}
