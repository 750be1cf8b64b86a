// Algorithm 2 joins one part after the other, but where each goes can be found before its turn.
//
// Method:  the searches of the next parts in the queue run side by side. One still holds when its turn comes
//          if the part is as it was and no bridge laid since comes as near to it as it has looked; what has
//          found nothing near then goes on from there. Others are made again, so the bridges are those of the
//          plain algorithm.
// Checked: tests/test_connect.c: greedy bridges and equal bytes with any number of threads.
#include "connect/ahead.h"
#include "base/base.h"

void ahead_create(jali_context *ctx, const jali_bitmap *solid, parts *p, jali_metric metric, ahead *a)
{
    *a = (ahead){.ctx = ctx, .solid = solid, .p = p, .metric = metric};
    for (int32_t i = 0; i < AHEAD; i++) a->each[i].root = -1;
}

void ahead_free(ahead *a)
{
    for (int32_t i = 0; i < AHEAD; i++) search_free(a->ctx, &a->each[i].s);
    search_free(a->ctx, &a->own);
    slices_free(a->ctx, &a->large);
}

static bool is_current(const foresight *f, const parts *p)
{
    return f->root >= 0 && p->parent[f->root] == f->root && p->area[f->root] == f->area;
}

// Whether the bridge lies, in part, within `reach` rows and columns of the box.
static bool comes_near(const jali_bridges *laid, int32_t bridge, const int32_t box[4], int32_t reach)
{
    int32_t from[2], to[2];
    for (int32_t leg = 0; jali_bridge_leg(laid, bridge, leg, from, to); leg++)
        if (MIN(from[0], to[0]) < box[2] + reach && MAX(from[0], to[0]) >= box[0] - reach &&
            MIN(from[1], to[1]) < box[3] + reach && MAX(from[1], to[1]) >= box[1] - reach)
            return true;
    return false;
}

static bool still_holds(const foresight *f, const parts *p, int32_t root, const jali_bridges *laid)
{
    for (int32_t i = f->laid; i < laid->count; i++)
        if (comes_near(laid, i, p->box[root], f->s.g.steps)) return false;
    return true;
}

static foresight *foresight_of(ahead *a, int32_t root)
{
    for (int32_t i = 0; i < AHEAD; i++)
        if (a->each[i].root == root && is_current(&a->each[i], a->p)) return &a->each[i];
    return NULL;
}

static void search_one(void *shared, int32_t index)
{
    ahead *a = shared;
    foresight *f = &a->each[a->asked[a->asked_count - 1 - index]];
    f->found = nearest_near(a->ctx, a->solid, a->p, f->root, a->metric, &f->s, &f->bridge);
}

// Put the part into a place that is free.
static jali_status ask_for(ahead *a, int32_t root, int32_t laid, int32_t *place)
{
    if (slices_of(a->ctx, a->p, root) > 1) return JALI_OK; // work for all threads
    while (is_current(&a->each[*place], a->p)) ++*place;
    foresight *f = &a->each[*place];
    jali_status status = make_room_near(a->ctx, a->solid, a->p, root, &f->s);
    if (status != JALI_OK || f->s.near_rim == 0) return status;
    *f = (foresight){.root = root, .laid = laid, .area = a->p->area[root], .s = f->s};
    a->asked[a->asked_count++] = (*place)++;
    return JALI_OK;
}

// The part whose turn it is and, in the free places, the next ones in the queue, which stay there.
static jali_status ask_for_next(ahead *a, int32_t root, int32_t laid, int32_t free_places)
{
    jali_status status;
    int32_t next[AHEAD], place = 0;
    a->asked_count = 0;
    TRY(ask_for(a, root, laid, &place));
    int32_t count = next_parts(a->p, free_places - 1, next);
    for (int32_t i = 0; i < count; i++)
        if (!foresight_of(a, next[i])) TRY(ask_for(a, next[i], laid, &place));
done:
    return status;
}

static jali_status search_side_by_side(ahead *a, int32_t root, int32_t laid)
{
    int32_t free_places = 0;
    for (int32_t i = 0; i < AHEAD; i++) free_places += !is_current(&a->each[i], a->p);
    if (free_places < AHEAD / 2) return JALI_OK; // one search is no work for several threads
    jali_status status = ask_for_next(a, root, laid, free_places);
    if (status == JALI_OK) parallel(a->ctx, a->asked_count, search_one, a);
    return status;
}

jali_status nearest_in_turn(ahead *a, int32_t root, const jali_bridges *laid, jali_bridge *bridge)
{
    jali_status status = JALI_OK;
    if (slices_of(a->ctx, a->p, root) > 1)
        return nearest_by_slices(a->ctx, a->solid, a->p, root, a->metric, &a->large, bridge);
    if (threads_of(a->ctx) > 1 && !foresight_of(a, root)) TRY(search_side_by_side(a, root, laid->count));
    foresight *f = foresight_of(a, root);
    if (f) f->root = -1;
    if (!f || !still_holds(f, a->p, root, laid))
        TRY(nearest_other(a->ctx, a->solid, a->p, root, a->metric, &a->own, bridge));
    else if (f->found)
        *bridge = f->bridge;
    else
        TRY(nearest_further(a->ctx, a->solid, a->p, root, a->metric, &f->s, bridge));
done:
    return status;
}
