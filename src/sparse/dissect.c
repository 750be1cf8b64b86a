// Nested dissection of a structure's nodes, by their places.
//
// Source:  A. George, Nested dissection of a regular finite element mesh, 1973; the separators as in A.
// Schild
//          and C. Sommer, On balanced separators in road networks, 2015 (inertial flow).
// How:     Nodes are put into slices along a few directions; one sweep over their edges tells how many nodes
// a
//          straight cut between any two slices needs. Around the best cut lies a band, in which the least
//          separator is found (separate.c). Parts of a level are split side by side, each in its own share of
//          the arrays. The graph of the nodes is an order of magnitude smaller than that of the unknowns, and
//          keeps those of a node together.
// Figures: factors of carved plates and shells are as large as with METIS's order, to 3 %.
// Checked: tests/test_solver.c.
#include "sparse/elimination.h"
#include "sparse/separate.h"

#include <math.h>

enum {
    DIRECTIONS = 9,
    TRIED = 2,          // directions in which a part reaches furthest
    MOST_SLICES = 1024, // about two to a row of nodes
    LEAST_SLICES = 16,
    SMALL = 4,   // parts of so many nodes stay as they are
    FEW = 400,   // to so many a straight cut will do
    SMOOTHED = 4 // passes
};
static const double LEAST_SHARE = 0.25; // of a part's nodes on either side of a cut
static const double BAND_SHARE = 0.08;  // of them on either side of a straight cut that a better one may use
static const double ROOT_HALF = 0.70710678118654752;

/// A run of the order that is not split yet.
typedef struct part {
    int32_t first, count;
} part;

typedef struct dissection {
    const node_graph *g;
    const double (*place)[3]; // [node_count] of the structure's nodes
    int32_t *item;            // [count] the order
    int32_t *side;            // [count] of a node: its slice, or its side of a cut
    int32_t *other;           // [count] of a node: where it stands in its part's band
    separate_desk desk;       // a part uses what begins at its first, twice that for states
    int32_t *band;            // [count] nodes of a part, from its first on
    const part *whole;        // [parts] to be split
    part *half;               // [2 parts] what comes of it
} dissection;

/// A cut square to a direction, between slices.
typedef struct cut {
    double along[3], low, slices_a_mm, cost;
    int32_t slices, at; // after which slice
    int32_t held;       // the side whose nodes at the cut are fewer
} cut;

static double along(const dissection *d, const double direction[3], int32_t i)
{
    const double *p = d->place[d->g->node[i]];
    return p[0] * direction[0] + p[1] * direction[1] + p[2] * direction[2];
}

static void slice_up(const dissection *d, part p, const cut *c)
{
    for (int32_t k = p.first; k < p.first + p.count; k++) {
        int32_t s = (int32_t)((along(d, c->along, d->item[k]) - c->low) * c->slices_a_mm);
        d->side[d->item[k]] = MAX(0, MIN(s, c->slices - 1));
    }
}

// A node touches the far side of all cuts between its own slice and the furthest of its neighbours'.
static void count_touching(const dissection *d, part p, int32_t *held, int32_t *touch_high,
                           int32_t *touch_low)
{
    for (int32_t k = p.first; k < p.first + p.count; k++) {
        int32_t i = d->item[k], own = d->side[i], least = own, most = own;
        for (int32_t e = d->g->first[i]; e < d->g->first[i + 1]; e++) {
            int32_t s = d->side[d->g->beside[e]];
            if (s == PARTED) continue;
            least = MIN(least, s);
            most = MAX(most, s);
        }
        held[own]++;
        touch_high[own]++;
        touch_high[most]--;
        touch_low[least]++;
        touch_low[own]--;
    }
}

// The cheapest place along a direction: few nodes at the cut, both sides alike.
static void place_cut(const dissection *d, part p, cut *c)
{
    int32_t held[MOST_SLICES] = {0}, touch_high[MOST_SLICES] = {0}, touch_low[MOST_SLICES] = {0};
    int32_t below = 0, of_low = 0, of_high = 0;
    slice_up(d, p, c);
    count_touching(d, p, held, touch_high, touch_low);
    c->cost = INFINITY;
    for (int32_t s = 0; s + 1 < c->slices; s++) {
        below += held[s];
        of_low += touch_high[s];
        of_high += touch_low[s];
        double share = (double)below / p.count;
        if (share < LEAST_SHARE || share > 1 - LEAST_SHARE) continue;
        double cost = (MIN(of_low, of_high) + 0.5) / (share * (1 - share));
        if (cost >= c->cost) continue;
        c->cost = cost;
        c->at = s;
        c->held = of_high < of_low ? HIGH : LOW;
    }
}

static bool choose_cut(const dissection *d, part p, cut *best)
{
    static const double direction[DIRECTIONS][3] = {{1, 0, 0},
                                                    {0, 1, 0},
                                                    {0, 0, 1},
                                                    {ROOT_HALF, ROOT_HALF, 0},
                                                    {ROOT_HALF, -ROOT_HALF, 0},
                                                    {ROOT_HALF, 0, ROOT_HALF},
                                                    {ROOT_HALF, 0, -ROOT_HALF},
                                                    {0, ROOT_HALF, ROOT_HALF},
                                                    {0, ROOT_HALF, -ROOT_HALF}};
    double low[DIRECTIONS], extent[DIRECTIONS];
    for (int q = 0; q < DIRECTIONS; q++) {
        double high = -INFINITY;
        low[q] = INFINITY;
        for (int32_t k = p.first; k < p.first + p.count; k++) {
            double x = along(d, direction[q], d->item[k]);
            low[q] = MIN(low[q], x);
            high = MAX(high, x);
        }
        extent[q] = high - low[q];
    }
    best->cost = INFINITY;
    for (int tries = 0; tries < TRIED; tries++) {
        int q = 0;
        for (int k = 1; k < DIRECTIONS; k++)
            if (extent[k] > extent[q]) q = k;
        if (!(extent[q] > 0)) break;
        int32_t slices = MAX(LEAST_SLICES, MIN((int32_t)(2 * sqrt(p.count)), MOST_SLICES));
        cut c = {.low = low[q], .slices_a_mm = slices / extent[q], .slices = slices};
        memcpy(c.along, direction[q], sizeof c.along);
        place_cut(d, p, &c);
        if (c.cost < best->cost) *best = c;
        extent[q] = 0;
    }
    return best->cost < INFINITY;
}

static bool touches(const dissection *d, int32_t i, int32_t side)
{
    for (int32_t e = d->g->first[i]; e < d->g->first[i + 1]; e++)
        if (d->side[d->g->beside[e]] == side) return true;
    return false;
}

// Nodes of one side that touch the other become the middle.
static void hold_border(const dissection *d, part p, int32_t side)
{
    int32_t count = 0;
    for (int32_t k = p.first; k < p.first + p.count; k++)
        if (d->side[d->item[k]] == side && touches(d, d->item[k], LOW + HIGH - side))
            d->band[p.first + count++] = d->item[k];
    for (int32_t k = 0; k < count; k++) d->side[d->band[p.first + k]] = MIDDLE;
}

// How far from a cut slices are taken in, `step` by step, until they have enough nodes.
static int32_t reach_from(const int32_t *held, int32_t slices, int32_t from, int32_t step, double enough)
{
    double sum = 0;
    for (; from >= 0 && from < slices && sum < enough; from += step) sum += held[from];
    return from;
}

// The least separator in a band around the cut.
static void part_in_band(const dissection *d, part p, const cut *c)
{
    int32_t held[MOST_SLICES] = {0}, count = 0;
    for (int32_t k = p.first; k < p.first + p.count; k++) held[d->side[d->item[k]]]++;
    int32_t low = reach_from(held, c->slices, c->at, -1, BAND_SHARE * p.count),
            high = reach_from(held, c->slices, c->at + 1, 1, BAND_SHARE * p.count);
    for (int32_t k = p.first; k < p.first + p.count; k++) {
        int32_t *side = &d->side[d->item[k]];
        *side = *side <= low ? LOW : *side >= high ? HIGH : MIDDLE;
    }
    hold_border(d, p, LOW); // where a side reaches across the band
    int32_t *band = d->band + p.first;
    for (int32_t k = p.first; k < p.first + p.count; k++) {
        if (d->side[d->item[k]] != MIDDLE) continue;
        d->other[d->item[k]] = count;
        band[count++] = d->item[k];
    }
    separate_desk desk = {.last = d->desk.last + p.first,
                          .next = d->desk.next + p.first,
                          .distance = d->desk.distance + p.first,
                          .edge = d->desk.edge + p.first,
                          .state = d->desk.state + 2 * (size_t)p.first,
                          .seen = d->desk.seen + 2 * (size_t)p.first};
    separate(d->g, count, band, d->other, d->side, &desk);
}

// Nodes of the middle that need not be there go to a side; those that would take only one neighbour's place
// there give it to that one, to make both sides alike.
static void smooth(const dissection *d, part p, int32_t held[3])
{
    bool moved = true;
    for (int32_t pass = 0; pass < SMOOTHED && moved; pass++) {
        moved = false;
        for (int32_t k = p.first; k < p.first + p.count; k++) {
            int32_t i = d->item[k], joined[2] = {0, 0}, one[2] = {-1, -1}, to;
            if (d->side[i] != MIDDLE) continue;
            for (int32_t e = d->g->first[i]; e < d->g->first[i + 1]; e++) {
                int32_t s = d->side[d->g->beside[e]];
                if (s != LOW && s != HIGH) continue;
                joined[s]++;
                one[s] = d->g->beside[e];
            }
            int32_t smaller = held[LOW] <= held[HIGH] ? LOW : HIGH, larger = LOW + HIGH - smaller;
            if (joined[larger] <= 1)
                to = smaller;
            else if (joined[smaller] == 0)
                to = larger;
            else
                continue;
            d->side[i] = to;
            held[to]++;
            if (joined[LOW + HIGH - to] > 0) {
                d->side[one[LOW + HIGH - to]] = MIDDLE;
                held[LOW + HIGH - to]--;
            }
            moved = true;
        }
    }
}

static void count_sides(const dissection *d, part p, int32_t held[3])
{
    held[LOW] = held[HIGH] = held[MIDDLE] = 0;
    for (int32_t k = p.first; k < p.first + p.count; k++) held[d->side[d->item[k]]]++;
}

// Low side, high side, and last the separator, each in the order that was.
static void sort_sides(const dissection *d, part p, const int32_t held[3])
{
    int32_t at[3] = {p.first, p.first + held[LOW], p.first + held[LOW] + held[HIGH]};
    for (int32_t k = p.first; k < p.first + p.count; k++) d->band[k] = d->item[k];
    for (int32_t k = p.first; k < p.first + p.count; k++) {
        int32_t i = d->band[k], side = d->side[i];
        d->item[at[side]++] = i;
        if (side == MIDDLE) d->side[i] = PARTED;
    }
}

static void split(void *shared, int32_t index)
{
    const dissection *d = shared;
    part p = d->whole[index];
    int32_t held[3];
    cut c;
    d->half[2 * index] = d->half[2 * index + 1] = (part){0};
    if (!choose_cut(d, p, &c)) return; // all in one place, or nearly
    slice_up(d, p, &c);
    if (p.count > FEW) {
        part_in_band(d, p, &c);
        count_sides(d, p, held);
    }
    if (p.count <= FEW || held[LOW] == 0 || held[HIGH] == 0) {
        if (p.count > FEW) slice_up(d, p, &c);
        for (int32_t k = p.first; k < p.first + p.count; k++)
            d->side[d->item[k]] = d->side[d->item[k]] > c.at ? HIGH : LOW;
        hold_border(d, p, c.held);
        count_sides(d, p, held);
    }
    smooth(d, p, held);
    count_sides(d, p, held);
    if (held[LOW] == p.count || held[HIGH] == p.count) return;
    sort_sides(d, p, held);
    d->half[2 * index] = (part){p.first, held[LOW]};
    d->half[2 * index + 1] = (part){p.first + held[LOW], held[HIGH]};
}

// Those of the halves that are worth splitting; the next level.
static int32_t keep_large(int32_t count, const part *half, part *whole)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++)
        if (half[i].count > SMALL) whole[kept++] = half[i];
    return kept;
}

static jali_status order_graph(jali_context *ctx, const node_graph *g, const double (*place)[3],
                               int32_t *item)
{
    jali_status status;
    int32_t n = g->count, parts;
    part *whole, *half;
    dissection d = {.g = g, .place = place, .item = item};
    TRY(ARENA(ctx, d.side, n + 1));
    TRY(ARENA(ctx, d.other, n + 1));
    TRY(ARENA(ctx, d.band, n + 1));
    TRY(ARENA(ctx, d.desk.last, n + 1));
    TRY(ARENA(ctx, d.desk.next, n + 1));
    TRY(ARENA(ctx, d.desk.edge, n + 1));
    TRY(ARENA(ctx, d.desk.distance, n + 1));
    TRY(ARENA(ctx, d.desk.state, 2 * (size_t)n + 2));
    TRY(ARENA(ctx, d.desk.seen, 2 * (size_t)n + 2));
    TRY(ARENA(ctx, whole, n / SMALL + 1));
    TRY(ARENA(ctx, half, 2 * (size_t)(n / SMALL) + 2));
    for (int32_t i = 0; i < n; i++) item[i] = i;
    d.whole = whole;
    d.half = half;
    half[0] = (part){0, n};
    parts = keep_large(1, half, whole);
    while (parts > 0) {
        TRY(step(ctx, "order", 0));
        parallel(ctx, parts, split, &d);
        parts = keep_large(2 * parts, half, whole);
    }
done:
    return status;
}

// Neighbours of each node; then the lonely ones, first in the order.
static void name_nodes(const block_matrix *a, int32_t *degree, node_graph *g, int32_t *order)
{
    int32_t lonely = 0;
    memset(degree, 0, (size_t)a->node_count * sizeof *degree);
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            degree[i] += joins(a, i, a->column[b]);
            degree[a->column[b]] += joins(a, i, a->column[b]);
        }
    g->count = 0;
    for (int32_t i = 0; i < a->node_count; i++) {
        if (degree[i] > 0)
            g->node[g->count++] = i;
        else
            order[lonely++] = i;
    }
}

static jali_status make_graph(jali_context *ctx, const block_matrix *a, int32_t *order, node_graph *g)
{
    jali_status status;
    int64_t edges = 2 * (a->row[a->node_count] - a->node_count);
    int32_t *degree;
    if (edges >= INT32_MAX)
        return fail(ctx, JALI_LIMIT, "a structure of %d nodes is larger than its ordering can index",
                    a->node_count);
    TRY(ARENA(ctx, degree, a->node_count + 1));
    TRY(ARENA(ctx, g->node, a->node_count + 1));
    TRY(ARENA(ctx, g->first, a->node_count + 1));
    TRY(ARENA(ctx, g->beside, edges + 1));
    name_nodes(a, degree, g, order);
    g->first[0] = 0;
    for (int32_t i = 0; i < g->count; i++) {
        g->first[i + 1] = g->first[i] + degree[g->node[i]];
        degree[g->node[i]] = i; // from here on: its number
    }
    int32_t *number = degree, *next = g->first;
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            int32_t k = a->column[b];
            if (!joins(a, i, k)) continue;
            g->beside[next[number[i]]++] = number[k];
            g->beside[next[number[k]]++] = number[i];
        }
    memmove(next + 1, next, (size_t)g->count * sizeof *next);
    next[0] = 0;
done:
    return status;
}

jali_status dissect(jali_context *ctx, const block_matrix *a, const double (*place)[3], int32_t *node)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    node_graph g;
    int32_t *item;
    TRY(make_graph(ctx, a, node, &g));
    TRY(ARENA(ctx, item, g.count + 1));
    TRY(order_graph(ctx, &g, place, item));
    for (int32_t i = 0; i < g.count; i++) node[a->node_count - g.count + i] = g.node[item[i]];
done:
    arena_rewind(ctx, mark);
    return status;
}
