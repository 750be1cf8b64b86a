// Pieces that are not worth their bridges.
//
// A speck of 0.4 mm in a wide void needs a bridge as broad as itself and several times as long: the picture
// is truer without it. The bridges that connect would lay make a tree with a piece at each node, a prize at
// each piece (wrong pixels and lost axes that it saves) and a cost at each bridge (wrong pixels that it
// makes). Source:  prize-collecting Steiner tree; on a tree the best part follows from the leaves inwards.
#include "adapt/widths.h"
#include "base/base.h"

#include <stdatomic.h>

// A piece is worth three times the wrong pixels it saves: it is a feature of the picture, its bridge is not.
// At 1 the sky of islands.png loses two thirds of its stars, and the recall of white over 24 runs two points.
enum { PRIZE = 3 };

enum { BAND_ROWS = 64, BAND_BRIDGES = 64 }; // at a time

// More than all the pixels of a picture, and a million times that is a number yet.
static const int64_t BEYOND_PRICE = INT64_C(1) << 42;

typedef struct piece_tree {
    components c;
    _Atomic int64_t *value; // [c.count], the piece's prize, then its subtree's
    int64_t *cost;          // [bridges], of a bridge
    int32_t *first;         // [c.count + 1], bridges at a piece
    int32_t *at;            // [2 * bridges], their numbers
    int32_t *above;         // [c.count], bridge towards the root or -1
    int32_t *order;         // [c.count], from the root outwards
    bool *kept;             // [c.count]
} piece_tree;

static int32_t other_end(const jali_bridge *bridge, int32_t piece)
{
    return bridge->part[0] == piece ? bridge->part[1] : bridge->part[0];
}

static jali_status build_tree(jali_context *ctx, const jali_bitmap *print, const jali_bridges *bridges,
                              piece_tree *t)
{
    jali_status status;
    TRY(label_components(ctx, print, true, 4, &t->c));
    TRY(ALLOCATE_CLEARED(ctx, t->value, t->c.count));
    TRY(ALLOCATE_CLEARED(ctx, t->cost, bridges->count));
    TRY(ALLOCATE_CLEARED(ctx, t->first, (size_t)t->c.count + 2));
    TRY(ALLOCATE(ctx, t->at, 2 * (size_t)bridges->count));
    TRY(ALLOCATE(ctx, t->above, t->c.count));
    TRY(ALLOCATE(ctx, t->order, t->c.count));
    TRY(ALLOCATE_CLEARED(ctx, t->kept, t->c.count));
    for (int32_t i = 0; i < bridges->count; i++)
        for (int32_t end = 0; end < 2; end++) t->first[bridges->bridge[i].part[end] + 2]++;
    for (int32_t i = 0; i < t->c.count; i++) t->first[i + 2] += t->first[i + 1];
    for (int32_t i = 0; i < bridges->count; i++)
        for (int32_t end = 0; end < 2; end++) t->at[t->first[bridges->bridge[i].part[end] + 1]++] = i;
done:
    return status;
}

/// What pieces and bridges are weighed by, and what stays of the print.
typedef struct weighing {
    const jali_bitmap *drawing, *axis;
    jali_bitmap *print;
    const jali_bridges *bridges;
    const jali_adapt_options *opt;
    const widths *w;
    piece_tree *t;
} weighing;

// Wrong pixels and axes that a run saves.
static int64_t saved_by_run(const weighing *job, int32_t y, int32_t x0, int32_t x1)
{
    const widths *w = job->w;
    int64_t worth =
        axis_worth_units(job->opt, true, patch_at(&w->solid, x0, y)->size, patch_at(&w->hollow, x0, y)->size);
    return WRONG_UNITS * (2 * count_run(job->drawing, y, x0, x1) - (x1 - x0)) +
           worth * count_run(job->axis, y, x0, x1);
}

static void weigh_band(void *shared, int32_t band)
{
    const weighing *job = shared;
    const components *c = &job->t->c;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, c->height_px); y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            atomic_fetch_add_explicit(&job->t->value[c->label[i]],
                                      PRIZE * saved_by_run(job, y, c->span[i][0], c->span[i][1]),
                                      memory_order_relaxed);
}

// Wrong pixels that a bridge makes: its width for each pixel of its way that should be black, less those it
// rights.
static int64_t cost_of_bridge(const weighing *job, int32_t bridge)
{
    int64_t cost = 0;
    int32_t from[2], to[2];
    for (int32_t leg = 0; jali_bridge_leg(job->bridges, bridge, leg, from, to); leg++) {
        line_walk walk = walk_line(from, to);
        while (walk_on(&walk)) {
            if (jali_bitmap_get(job->print, walk.x, walk.y)) continue;
            int32_t width_px = patch_at(&job->w->solid, walk.x, walk.y)->size;
            cost += WRONG_UNITS * (jali_bitmap_get(job->drawing, walk.x, walk.y) ? -width_px : width_px);
        }
    }
    return MAX(cost, 0);
}

static void weigh_bridges(void *shared, int32_t band)
{
    const weighing *job = shared;
    for (int32_t i = band * BAND_BRIDGES; i < MIN((band + 1) * BAND_BRIDGES, job->bridges->count); i++)
        job->t->cost[i] = cost_of_bridge(job, i);
}

static void drop_band(void *shared, int32_t band)
{
    const weighing *job = shared;
    const components *c = &job->t->c;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, c->height_px); y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            if (!job->t->kept[c->label[i]]) paint_run(job->print, y, c->span[i][0], c->span[i][1], false);
}

// A piece with a white pixel that is fixed is worth any bridge.
static void prize_fixed(const jali_bitmap *fixed, piece_tree *t)
{
    for (int32_t y = 0; y < t->c.height_px; y++)
        for (int32_t i = t->c.first[y]; i < t->c.first[y + 1]; i++)
            if (count_run(fixed, y, t->c.span[i][0], t->c.span[i][1]) > 0)
                t->value[t->c.label[i]] = BEYOND_PRICE;
}

static int32_t largest_piece(const components *c, const int64_t *area)
{
    int32_t largest = 0;
    for (int32_t i = 1; i < c->count; i++)
        if (area[i] > area[largest]) largest = i;
    return largest;
}

// The order outwards from the root, then values inwards, then who stays outwards again. Pieces that no bridge
// reaches touch a neighbour's bridge and stay.
static void prune_tree(const jali_bridges *bridges, int32_t root, piece_tree *t)
{
    int32_t count = 0;
    for (int32_t i = 0; i < t->c.count; i++) t->above[i] = -2; // not reached yet
    t->above[root] = -1;
    t->order[count++] = root;
    for (int32_t k = 0; k < count; k++)
        for (int32_t i = t->first[t->order[k]]; i < t->first[t->order[k] + 1]; i++) {
            int32_t next = other_end(&bridges->bridge[t->at[i]], t->order[k]);
            if (t->above[next] != -2) continue;
            t->above[next] = t->at[i];
            t->order[count++] = next;
        }
    for (int32_t k = count - 1; k > 0; k--) {
        int32_t piece = t->order[k], bridge = t->above[piece];
        int64_t gain = t->value[piece] - t->cost[bridge];
        if (gain > 0) t->value[other_end(&bridges->bridge[bridge], piece)] += gain;
    }
    for (int32_t i = 0; i < t->c.count; i++) t->kept[i] = t->above[i] < 0;
    for (int32_t k = 1; k < count; k++) {
        int32_t piece = t->order[k], bridge = t->above[piece];
        t->kept[piece] =
            t->value[piece] > t->cost[bridge] && t->kept[other_end(&bridges->bridge[bridge], piece)];
    }
}

jali_status jali_adapt_prune(jali_context *ctx, const jali_bitmap *drawing, const jali_bridges *bridges,
                             const jali_adapt_options *opt, jali_bitmap *print, int32_t *dropped)
{
    jali_status status;
    piece_tree t = {0};
    jali_bitmap axis = {0};
    widths w = {0};
    int64_t *area = NULL;
    *dropped = 0;
    if (bridges->count == 0) return JALI_OK;
    TRY(printed_widths(ctx, opt, print, 0, &w));
    TRY(medial_axis(ctx, drawing, true, true, w.solid.most / 2 + 1, &axis));
    TRY(build_tree(ctx, print, bridges, &t));
    TRY(component_areas(ctx, &t.c, &area));
    weighing job = {drawing, &axis, print, bridges, opt, &w, &t};
    int32_t bands = (t.c.height_px + BAND_ROWS - 1) / BAND_ROWS;
    parallel(ctx, bands, weigh_band, &job);
    if (opt->fixed) prize_fixed(opt->fixed, &t);
    parallel(ctx, (bridges->count + BAND_BRIDGES - 1) / BAND_BRIDGES, weigh_bridges, &job);
    prune_tree(bridges, largest_piece(&t.c, area), &t);
    for (int32_t i = 0; i < t.c.count; i++) *dropped += !t.kept[i];
    if (*dropped > 0) parallel(ctx, bands, drop_band, &job);
done:
    components_free(ctx, &t.c);
    release(ctx, t.value);
    release(ctx, t.cost);
    release(ctx, t.first);
    release(ctx, t.at);
    release(ctx, t.above);
    release(ctx, t.order);
    release(ctx, t.kept);
    release(ctx, area);
    jali_bitmap_free(ctx, &axis);
    widths_free(ctx, &w);
    return status;
}
