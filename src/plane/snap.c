// Snap rounding by a grid of cells: crossings are found and hot pixels are met within a cell.
//
// Source:  Hobby: Practical segment intersection with finite precision output (1999); Guibas and Marimont:
//          Rounding arrangements dynamically (1998), for the theorem that nothing crosses afterwards and no
//          edge passes over a point.
// Limits:  |coordinate| <= 2^24. An edge may come arbitrarily near a point whose hot pixel it misses.
// Checked: tests/test_plane.c: random edges against the definition; the triangulation takes every piece.
#include "plane/snap.h"

#include "plane/exact.h"

#include <math.h>
#include <stdlib.h>

enum { CELLS_A_STEP = 1 << 14, EDGES_A_CELL = 2 };

// A grid over all points. Cell (column, row) begins at low + (column, row) << shift.
typedef struct grid {
    int32_t low[2], columns, rows;
    int shift;
} grid;

// What lies in each cell: cell c owns item[first[c]] .. item[first[c + 1]] - 1.
typedef struct bins {
    int64_t *first;
    int32_t *item;
} bins;

typedef struct snapping {
    const int32_t (*point)[2];
    const int32_t (*edge)[2];
    int32_t edge_count, disjoint;
    grid grid;
    bins edges, places;
} snapping;

void snapped_free(jali_context *ctx, snapped *s)
{
    release(ctx, s->point);
    release(ctx, s->home);
    release(ctx, s->piece);
    release(ctx, s->edge);
    *s = (snapped){0};
}

// --- The grid

static jali_status lay_grid(jali_context *ctx, snapping *w, int32_t point_count)
{
    int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
    for (int32_t i = 0; i < point_count; i++)
        for (int k = 0; k < 2; k++) {
            if (abs(w->point[i][k]) > COORDINATE_LIMIT)
                return fail(ctx, JALI_LIMIT, "point (%d, %d) lies outside the lattice of +-%d units",
                            w->point[i][0], w->point[i][1], COORDINATE_LIMIT);
            low[k] = MIN(low[k], w->point[i][k]);
            high[k] = MAX(high[k], w->point[i][k]);
        }
    grid *g = &w->grid;
    double cells_wanted = MAX(1.0, (double)w->edge_count / EDGES_A_CELL);
    for (g->shift = 2;; g->shift++) {
        for (int k = 0; k < 2; k++) g->low[k] = low[k] - 2;
        int64_t columns = (((int64_t)high[0] - low[0] + 4) >> g->shift) + 1;
        int64_t rows = (((int64_t)high[1] - low[1] + 4) >> g->shift) + 1;
        if ((double)columns * (double)rows > cells_wanted && columns + rows > 2) continue;
        g->columns = (int32_t)columns;
        g->rows = (int32_t)rows;
        return JALI_OK;
    }
}

static int32_t column_of(const grid *g, int64_t x)
{
    int64_t column = (x - g->low[0]) >> g->shift;
    return (int32_t)MIN(MAX(column, 0), g->columns - 1);
}
static int32_t row_of(const grid *g, int64_t y)
{
    int64_t row = (y - g->low[1]) >> g->shift;
    return (int32_t)MIN(MAX(row, 0), g->rows - 1);
}
static int64_t cell_of(const grid *g, const int32_t p[2])
{
    return (int64_t)row_of(g, p[1]) * g->columns + column_of(g, p[0]);
}

// The columns that the segment, made a unit wider on all sides, may touch in one row of cells.
static void columns_in_row(const grid *g, const int32_t a[2], const int32_t b[2], int32_t row, int32_t *first,
                           int32_t *last)
{
    double low = (double)g->low[1] + ((double)row * (double)(1 << g->shift)) - 2;
    double high = low + (double)(1 << g->shift) + 4;
    double x0 = MIN(a[0], b[0]), x1 = MAX(a[0], b[0]), dy = (double)b[1] - a[1];
    if (fabs(dy) >= 1) {
        double slope = ((double)b[0] - a[0]) / dy;
        double u = a[0] + (low - a[1]) * slope, v = a[0] + (high - a[1]) * slope;
        x0 = MAX(x0, MIN(u, v));
        x1 = MIN(x1, MAX(u, v));
    }
    *first = column_of(g, (int64_t)floor(x0) - 2);
    *last = column_of(g, (int64_t)ceil(x1) + 2);
}

static jali_status bin_edges(jali_context *ctx, snapping *w)
{
    jali_status status;
    const grid *g = &w->grid;
    int64_t cells = (int64_t)g->columns * g->rows;
    TRY(ARENA(ctx, w->edges.first, cells + 2));
    memset(w->edges.first, 0, (size_t)(cells + 2) * sizeof *w->edges.first);
    for (int fill = 0; fill < 2; fill++) {
        for (int32_t i = 0; i < w->edge_count; i++) {
            const int32_t *a = w->point[w->edge[i][0]], *b = w->point[w->edge[i][1]];
            int32_t last_row = row_of(g, (int64_t)MAX(a[1], b[1]) + 1);
            for (int32_t row = row_of(g, (int64_t)MIN(a[1], b[1]) - 1); row <= last_row; row++) {
                int32_t first, last;
                columns_in_row(g, a, b, row, &first, &last);
                for (int64_t c = (int64_t)row * g->columns + first; first <= last; first++, c++)
                    if (fill)
                        w->edges.item[w->edges.first[c + 1]++] = i;
                    else
                        w->edges.first[c + 2]++;
            }
        }
        if (fill) break;
        for (int64_t c = 0; c <= cells; c++) w->edges.first[c + 1] += w->edges.first[c];
        TRY(ARENA(ctx, w->edges.item, w->edges.first[cells + 1] + 1));
    }
done:
    return status;
}

static jali_status bin_places(jali_context *ctx, snapping *w, const snapped *s)
{
    jali_status status;
    int64_t cells = (int64_t)w->grid.columns * w->grid.rows, *first;
    TRY(ARENA(ctx, w->places.first, cells + 2));
    TRY(ARENA(ctx, w->places.item, s->point_count + 1));
    first = w->places.first;
    memset(first, 0, (size_t)(cells + 2) * sizeof *first);
    for (int32_t p = 0; p < s->point_count; p++) first[cell_of(&w->grid, s->point[p]) + 2]++;
    for (int64_t c = 0; c <= cells; c++) first[c + 1] += first[c];
    for (int32_t p = 0; p < s->point_count; p++)
        w->places.item[first[cell_of(&w->grid, s->point[p]) + 1]++] = p;
done:
    return status;
}

// --- Crossings

// n / d to the nearest whole number, halves up; d > 0.
static int64_t rounded(__int128 n, __int128 d)
{
    __int128 twice = 2 * n + d, quotient = twice / (2 * d);
    if (twice % (2 * d) < 0) quotient--;
    return (int64_t)quotient;
}

// Do the inner parts of two segments cross in one point? That point, rounded.
static bool cross_inside(const int32_t a[2], const int32_t b[2], const int32_t c[2], const int32_t d[2],
                         int32_t at[2])
{
    int64_t side_c = orientation(a, b, c), side_d = orientation(a, b, d);
    if (side_c == 0 || side_d == 0 || (side_c < 0) == (side_d < 0)) return false;
    int64_t side_a = orientation(c, d, a), side_b = orientation(c, d, b);
    if (side_a == 0 || side_b == 0 || (side_a < 0) == (side_b < 0)) return false;
    __int128 part = side_a, whole = (__int128)side_a - side_b; // a + part / whole (b - a)
    if (whole < 0) part = -part, whole = -whole;
    for (int k = 0; k < 2; k++) at[k] = (int32_t)(a[k] + rounded(part * (b[k] - a[k]), whole));
    return true;
}

typedef struct found {
    int32_t (*point)[2];
    size_t count, capacity;
} found;

// The crossings of the edges of one cell that fall into it.
static jali_status cross_in_cell(jali_context *ctx, const snapping *w, int64_t cell, found *crossings,
                                 int32_t crossed[2])
{
    const int32_t *item = w->edges.item;
    for (int64_t i = w->edges.first[cell]; i < w->edges.first[cell + 1]; i++) {
        const int32_t *e = w->edge[item[i]], *a = w->point[e[0]], *b = w->point[e[1]];
        if (item[i] >= w->disjoint) break; // items ascend: only disjoint edges follow
        int32_t low = MIN(a[0], b[0]), high = MAX(a[0], b[0]);
        for (int64_t j = i + 1; j < w->edges.first[cell + 1]; j++) {
            const int32_t *f = w->edge[item[j]], *c = w->point[f[0]], *d = w->point[f[1]];
            int32_t at[2];
            if (MAX(c[0], d[0]) < low || MIN(c[0], d[0]) > high || !cross_inside(a, b, c, d, at)) continue;
            if (cell_of(&w->grid, at) != cell) continue;
            if (item[j] < w->disjoint && (crossed[0] < 0 || item[j] < crossed[1]))
                crossed[0] = item[i], crossed[1] = item[j];
            jali_status status = GROW(ctx, crossings->point, crossings->capacity, crossings->count + 1);
            if (status != JALI_OK) return status;
            memcpy(crossings->point[crossings->count++], at, sizeof at);
        }
    }
    return JALI_OK;
}

static jali_status find_crossings(jali_context *ctx, const snapping *w, found *crossings, int32_t crossed[2])
{
    jali_status status = JALI_OK;
    int64_t cells = (int64_t)w->grid.columns * w->grid.rows;
    for (int64_t c = 0; c < cells; c++) {
        if (c % CELLS_A_STEP == 0) TRY(step(ctx, "carve", 0.1));
        TRY(cross_in_cell(ctx, w, c, crossings, crossed));
    }
done:
    return status;
}

// --- Hot pixels

static uint64_t place_hash(const int32_t p[2])
{
    uint64_t hash = ((uint64_t)(uint32_t)p[0] << 32 | (uint32_t)p[1]) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ hash >> 29;
}

// All points once: those given in their order, then the crossings in theirs.
static jali_status gather(jali_context *ctx, const int32_t (*point)[2], int32_t count, const found *crossings,
                          snapped *s)
{
    jali_status status;
    size_t all = (size_t)count + crossings->count, slots = 16;
    if (all > INT32_MAX / 2) return fail(ctx, JALI_LIMIT, "the edges cross in more than 2^30 points");
    while (slots < 2 * all) slots *= 2;
    int32_t *table; // [slots], place + 1, 0 = free
    TRY(ARENA(ctx, table, slots));
    memset(table, 0, slots * sizeof *table);
    TRY(ALLOCATE(ctx, s->point, all + 1));
    TRY(ALLOCATE(ctx, s->home, count + 1));
    for (size_t i = 0; i < all; i++) {
        const int32_t *p = i < (size_t)count ? point[i] : crossings->point[i - (size_t)count];
        size_t slot = place_hash(p) & (slots - 1);
        while (table[slot] && memcmp(s->point[table[slot] - 1], p, sizeof *s->point))
            slot = (slot + 1) & (slots - 1);
        if (!table[slot]) {
            memcpy(s->point[s->point_count], p, sizeof *s->point);
            table[slot] = ++s->point_count;
        }
        if (i < (size_t)count) s->home[i] = table[slot] - 1;
    }
done:
    return status;
}

// Does the segment meet the half-open square of a unit around p? By separating axes; the line touches the
// square in a corner or side alone only where that belongs to it: at the lower left.
static bool meets_pixel(const int32_t a[2], const int32_t b[2], const int32_t p[2])
{
    if (p[0] < MIN(a[0], b[0]) || p[0] > MAX(a[0], b[0]) || p[1] < MIN(a[1], b[1]) || p[1] > MAX(a[1], b[1]))
        return false;
    int64_t dx = (int64_t)b[0] - a[0], dy = (int64_t)b[1] - a[1];
    int64_t reach = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy), twice = 2 * orientation(a, b, p);
    if (twice == -reach) return dx <= 0 && dy >= 0;
    if (twice == reach) return dx >= 0 && dy <= 0;
    return -reach < twice && twice < reach;
}

typedef struct hit {
    int64_t along;
    int32_t place;
} hit;

// The hot pixels of each edge: edge i owns hit[first[i]] .. hit[first[i + 1]] - 1.
static jali_status find_hits(jali_context *ctx, const snapping *w, const snapped *s, int64_t **first,
                             hit **all)
{
    jali_status status;
    int64_t cells = (int64_t)w->grid.columns * w->grid.rows, *next;
    TRY(ARENA(ctx, *first, w->edge_count + 2));
    memset(*first, 0, (size_t)(w->edge_count + 2) * sizeof **first);
    next = *first + 1;
    for (int fill = 0; fill < 2; fill++) {
        for (int64_t c = 0; c < cells; c++) {
            if (c % CELLS_A_STEP == 0) TRY(step(ctx, "carve", 0.2));
            for (int64_t i = w->edges.first[c]; i < w->edges.first[c + 1]; i++) {
                int32_t e = w->edges.item[i];
                const int32_t *a = w->point[w->edge[e][0]], *b = w->point[w->edge[e][1]];
                for (int64_t j = w->places.first[c]; j < w->places.first[c + 1]; j++) {
                    int32_t place = w->places.item[j];
                    const int32_t *p = s->point[place];
                    if (!meets_pixel(a, b, p)) continue;
                    if (!fill) {
                        next[e + 1]++;
                        continue;
                    }
                    int64_t along = ((int64_t)b[0] - a[0]) * ((int64_t)p[0] - a[0]) +
                                    ((int64_t)b[1] - a[1]) * ((int64_t)p[1] - a[1]);
                    (*all)[next[e]++] = (hit){along, place};
                }
            }
        }
        if (fill) break;
        for (int32_t e = 0; e < w->edge_count; e++) next[e + 1] += next[e];
        TRY(ARENA(ctx, *all, next[w->edge_count] + 1));
    }
done:
    return status;
}

static void sort_hits(hit *h, int64_t count)
{
    for (int64_t gap = count > 40 ? count / 2 : 1; gap > 0; gap /= 2) // Shell's: few, and often in order
        for (int64_t i = gap; i < count; i++) {
            hit moved = h[i];
            int64_t j = i;
            for (; j >= gap && (h[j - gap].along > moved.along ||
                                (h[j - gap].along == moved.along && h[j - gap].place > moved.place));
                 j -= gap)
                h[j] = h[j - gap];
            h[j] = moved;
        }
}

static jali_status chain_hits(jali_context *ctx, const snapping *w, const int64_t *first, hit *all,
                              snapped *s)
{
    jali_status status;
    int64_t hits = first[w->edge_count];
    if (hits > INT32_MAX) return fail(ctx, JALI_LIMIT, "the edges have more than 2^31 pieces");
    TRY(ALLOCATE(ctx, s->piece, hits + 1));
    TRY(ALLOCATE(ctx, s->edge, hits + 1));
    for (int32_t e = 0; e < w->edge_count; e++) {
        sort_hits(all + first[e], first[e + 1] - first[e]);
        for (int64_t i = first[e] + 1; i < first[e + 1]; i++) {
            s->piece[s->piece_count][0] = all[i - 1].place;
            s->piece[s->piece_count][1] = all[i].place;
            s->edge[s->piece_count++] = e;
        }
    }
done:
    return status;
}

jali_status snap_round(jali_context *ctx, const int32_t (*point)[2], int32_t point_count,
                       const int32_t (*edge)[2], int32_t edge_count, int32_t disjoint, snapped *s,
                       int32_t crossed[2])
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    snapping w = {.point = point, .edge = edge, .edge_count = edge_count, .disjoint = disjoint};
    found crossings = {0};
    int64_t *first;
    hit *all;
    *s = (snapped){0};
    crossed[0] = crossed[1] = -1;
    if (point_count == 0) return JALI_OK;
    TRY(lay_grid(ctx, &w, point_count));
    TRY(bin_edges(ctx, &w));
    TRY(find_crossings(ctx, &w, &crossings, crossed));
    TRY(gather(ctx, point, point_count, &crossings, s));
    TRY(bin_places(ctx, &w, s));
    TRY(find_hits(ctx, &w, s, &first, &all));
    TRY(chain_hits(ctx, &w, first, all, s));
done:
    release(ctx, crossings.point);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) snapped_free(ctx, s);
    return status;
}

jali_status odd_pieces(jali_context *ctx, const int32_t (*piece)[2], int32_t count, int32_t (*odd)[2],
                       int32_t *odd_count)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *table; // [slots], number + 1 of the last such piece, 0 = free
    size_t slots = 16;
    uint8_t *often;
    while (slots < 2 * (size_t)count) slots *= 2;
    *odd_count = 0;
    TRY(ARENA(ctx, table, slots));
    TRY(ARENA(ctx, often, count + 1));
    memset(table, 0, slots * sizeof *table);
    for (int32_t i = 0; i < count; i++) {
        int32_t low = MIN(piece[i][0], piece[i][1]), high = MAX(piece[i][0], piece[i][1]);
        uint64_t hash = ((uint64_t)(uint32_t)low << 32 | (uint32_t)high) * UINT64_C(0x9e3779b97f4a7c15);
        size_t slot = (hash ^ hash >> 31) & (slots - 1);
        for (; table[slot]; slot = (slot + 1) & (slots - 1)) {
            const int32_t *other = piece[table[slot] - 1];
            if (MIN(other[0], other[1]) == low && MAX(other[0], other[1]) == high) break;
        }
        if (!table[slot]) {
            table[slot] = i + 1;
            often[i] = 0;
        }
        often[table[slot] - 1] ^= 1;
        if (table[slot] - 1 != i) often[i] = 0;
    }
    for (int32_t i = 0; i < count; i++)
        if (often[i]) memcpy(odd[(*odd_count)++], piece[i], sizeof *odd);
done:
    arena_rewind(ctx, mark);
    return status;
}
