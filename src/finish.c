// The finish: a mask becomes one piece with nothing thinner than the widths, and masks that were finished
// once are finished again: with connectors added, with edges moved.
//
// Ends:    after the first round solid is only added, but for a few strandings (src/adapt/finish.c).
// Checked: tests/test_optimise.c, tests/test_edits.c.
#include "optimising.h"
#include "raster/raster.h"

jali_status join_parts(jali_context *ctx, optimising *o, bool in_print, const jali_bitmap *picture,
                       const jali_bitmap *parts, jali_bitmap *joined, jali_bridges *bridges)
{
    jali_status status;
    jali_bitmap blocked = {0};
    jali_connect_options opt = {.metric = o->metric};
    if (o->by_hand.any) {
        TRY(jali_adapt_blocked(ctx, &o->widths, in_print, picture, &blocked));
        opt.blocked = &blocked;
    }
    TRY(jali_connect(ctx, parts, &opt, joined, bridges));
done:
    jali_bitmap_free(ctx, &blocked);
    return status;
}

// Keep the bridges that made pixels white.
static jali_status record_bridges(jali_context *ctx, optimising *o, const jali_bridges *bridges)
{
    jali_status status = JALI_OK;
    jali_bridges *laid = &o->result->laid;
    for (int32_t i = 0; i < bridges->count; i++) {
        const jali_bridge *one = &bridges->bridge[i];
        if (one->pixels == 0) continue;
        TRY(GROW(ctx, laid->bridge, o->laid_capacity, laid->count + 1));
        TRY(GROW(ctx, laid->via, o->via_capacity, laid->via_count + one->via_count));
        laid->bridge[laid->count] = *one;
        laid->bridge[laid->count++].via_first = laid->via_count;
        for (int32_t k = 0; k < one->via_count; k++, laid->via_count++)
            memcpy(laid->via[laid->via_count], bridges->via[one->via_first + k], sizeof *laid->via);
        laid->pixels += one->pixels;
    }
done:
    return status;
}

// Parts that no bridge may reach go, and the bridges between them.
static jali_status take_off_stranded(jali_context *ctx, optimising *o, jali_bitmap *cores,
                                     jali_bridges *bridges, jali_bitmap *mask)
{
    jali_status status;
    jali_bitmap off = {0};
    int32_t kept = 0;
    TRY(hand_find_loose(ctx, &o->by_hand, cores, o->widths.outside_solid, false, &off, &o->result->edited));
    if (!off.word) goto done;
    combine(ctx, RULE_AND_NOT, cores, &off, cores);
    TRY(jali_adapt_take_off(ctx, &off, cores, &o->widths, mask));
    for (int32_t i = 0; i < bridges->count; i++) {
        const int32_t *from = bridges->bridge[i].from;
        if (!jali_bitmap_get(&off, from[0], from[1])) bridges->bridge[kept++] = bridges->bridge[i];
    }
    bridges->count = kept;
done:
    jali_bitmap_free(ctx, &off);
    return status;
}

// One round: cores, bridges between them, voids that became too narrow. Only the first may take solid off,
// and parts that nothing may join.
static jali_status finish_round(jali_context *ctx, optimising *o, bool first, bool may_strand,
                                jali_bitmap *mask)
{
    jali_status status;
    jali_bitmap cores = {0};
    jali_bridges bridges = {0};
    jali_optimised *r = o->result;
    TRY(step(ctx, "finish", 0));
    TRY(jali_adapt_cores(ctx, &o->widths, !first, mask, &cores));
    if (first) {
        r->bridge_pixels = -count_white(ctx, mask);
        if (o->opt.details || o->opt.mark_bridges) TRY(jali_bitmap_copy(ctx, mask, &r->bridge_mask));
    }
    TRY(join_parts(ctx, o, false, mask, &cores, &cores, &bridges));
    if (bridges.stranded && may_strand) TRY(take_off_stranded(ctx, o, &cores, &bridges, mask));
    TRY(jali_adapt_lay(ctx, &bridges, &o->widths, mask));
    TRY(record_bridges(ctx, o, &bridges));
    r->bridges += bridges.count;
done:
    jali_bridges_free(ctx, &bridges);
    jali_bitmap_free(ctx, &cores);
    return status;
}

// Taking off stranded parts in every round need not end: what thickens a detail may bring one back.
enum { MOST_STRANDINGS = 4 };

// Rounds until nothing changes; at least `least` of them.
static jali_status finish_rounds(jali_context *ctx, optimising *o, bool take_off, int32_t least,
                                 jali_bitmap *mask)
{
    jali_status status = JALI_OK;
    jali_bitmap before = {0};
    bool changed = true;
    for (int32_t round = 0; changed || round < least; round++) {
        TRY(jali_bitmap_copy(ctx, mask, &before));
        TRY(finish_round(ctx, o, take_off && round == 0, take_off && round < MOST_STRANDINGS, mask));
        changed = count_combined(ctx, RULE_XOR, mask, &before) > 0;
        jali_bitmap_free(ctx, &before);
    }
done:
    jali_bitmap_free(ctx, &before);
    return status;
}

// What the rounds could not join goes too, unless it is fixed.
static jali_status take_off_loose(jali_context *ctx, optimising *o, jali_bitmap *mask)
{
    jali_bitmap off = {0};
    if (!o->by_hand.any) return JALI_OK;
    jali_status status =
        hand_find_loose(ctx, &o->by_hand, mask, o->widths.outside_solid, true, &off, &o->result->edited);
    if (off.word) combine(ctx, RULE_AND_NOT, mask, &off, mask);
    jali_bitmap_free(ctx, &off);
    return status;
}

// Necks over which no bridge may lie are thickened where they are, as other details are there.
static jali_status thicken_necks(jali_context *ctx, optimising *o, jali_bitmap *mask, bool *any)
{
    jali_status status;
    jali_details white = {0};
    jali_bitmap thick = {0};
    element disc = {0};
    jali_bitmap *necks = &white.type[JALI_TYPE_A];
    *any = false;
    TRY(jali_adapt_details(ctx, mask, true, &o->widths, &white));
    combine(ctx, RULE_AND_NOT, necks, &o->by_hand.fixed, necks);
    *any = any_white(ctx, necks);
    if (!*any) goto done;
    TRY(element_disc(ctx, o->widths.solid_px, &disc));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, &thick));
    TRY(dilate(ctx, necks, &disc, false, &thick));
    combine(ctx, RULE_OR, mask, &thick, mask);
    hand_keep(ctx, &o->by_hand, false, mask);
done:
    element_free(ctx, &disc);
    jali_bitmap_free(ctx, &thick);
    jali_details_free(ctx, &white);
    return status;
}

static jali_status mend_necks(jali_context *ctx, optimising *o, jali_bitmap *mask)
{
    enum { MOST_TIMES = 4 };
    jali_status status = JALI_OK;
    bool any = o->by_hand.any;
    for (int32_t i = 0; any && i < MOST_TIMES; i++) {
        TRY(thicken_necks(ctx, o, mask, &any));
        if (any) TRY(finish_rounds(ctx, o, false, 1, mask));
    }
done:
    return status;
}

jali_status finish(jali_context *ctx, optimising *o, jali_bitmap *mask)
{
    jali_status status;
    jali_optimised *r = o->result;
    TRY(finish_rounds(ctx, o, true, 2, mask)); // the first only takes off, the second mends
    TRY(mend_necks(ctx, o, mask));
    TRY(take_off_loose(ctx, o, mask));
    r->bridge_pixels += count_white(ctx, mask);
    if (r->bridge_mask.width_px > 0) combine(ctx, RULE_XOR, &r->bridge_mask, mask, &r->bridge_mask);
done:
    return status;
}

jali_status count_residual(jali_context *ctx, optimising *o, const jali_bitmap *mask)
{
    jali_status status;
    jali_details white = {0}, black = {0};
    TRY(jali_adapt_details(ctx, mask, true, &o->widths, &white));
    TRY(jali_adapt_details(ctx, mask, false, &o->widths, &black));
    memcpy(o->result->residual.white, white.count, sizeof white.count);
    memcpy(o->result->residual.black, black.count, sizeof black.count);
    o->result->edited.locked_details = 0;
    if (o->by_hand.marks.count[JALI_EDIT_LOCK] > 0) {
        int32_t reach_px = MAX(o->widths.solid_px, o->widths.void_px),
                *count = &o->result->edited.locked_details;
        TRY(hand_count_locked(ctx, &o->by_hand, &white, true, reach_px, count));
        TRY(hand_count_locked(ctx, &o->by_hand, &black, false, reach_px, count));
    }
done:
    jali_details_free(ctx, &white);
    jali_details_free(ctx, &black);
    return status;
}

// --- Again

static bool is_free(const jali_bridges *bridges, int32_t i, const jali_bitmap *mask,
                    const jali_bitmap *blocked)
{
    int32_t from[2], to[2];
    for (int32_t leg = 0; jali_bridge_leg(bridges, i, leg, from, to); leg++) {
        line_walk walk = walk_line(from, to);
        while (walk_on(&walk))
            if (jali_bitmap_get(blocked, walk.x, walk.y) && !jali_bitmap_get(mask, walk.x, walk.y))
                return false;
    }
    return true;
}

// Those straight bridges that cross nothing that is forbidden or locked.
static jali_status take_free_ones(jali_context *ctx, optimising *o, const jali_bridges *bridges,
                                  jali_bridges *free_ones)
{
    jali_status status;
    jali_bitmap blocked = {0};
    const jali_bitmap *mask = &o->result->mask;
    if (o->by_hand.any) TRY(jali_adapt_blocked(ctx, &o->widths, false, mask, &blocked));
    TRY(ALLOCATE(ctx, free_ones->bridge, bridges->count));
    for (int32_t i = 0; i < bridges->count; i++)
        if (!o->by_hand.any || is_free(bridges, i, mask, &blocked))
            free_ones->bridge[free_ones->count++] = bridges->bridge[i];
done:
    jali_bitmap_free(ctx, &blocked);
    return status;
}

jali_status jali_optimise_add(jali_context *ctx, const jali_bridges *bridges, const jali_chart *chart,
                              const jali_optimise_options *given, jali_optimised *result)
{
    jali_status status;
    optimising o = {.chart = chart, .opt = given ? *given : jali_optimise_defaults(), .result = result};
    jali_bitmap before = {0};
    jali_bridges free_ones = {0};
    o.laid_capacity = (size_t)result->laid.count;
    o.via_capacity = (size_t)result->laid.via_count;
    TRY(optimising_open(ctx, &result->mask, &o));
    TRY(jali_bitmap_copy(ctx, &result->mask, &before));
    TRY(take_free_ones(ctx, &o, bridges, &free_ones));
    TRY(jali_adapt_lay(ctx, &free_ones, &o.widths, &result->mask));
    TRY(record_bridges(ctx, &o, &free_ones));
    result->bridges += free_ones.count;
    TRY(finish_rounds(ctx, &o, false, 1, &result->mask));
    result->bridge_pixels += count_combined(ctx, RULE_AND_NOT, &result->mask, &before);
    if (result->bridge_mask.width_px > 0) {
        combine(ctx, RULE_AND_NOT, &result->mask, &before, &before);
        combine(ctx, RULE_OR, &result->bridge_mask, &before, &result->bridge_mask);
    }
    TRY(count_residual(ctx, &o, &result->mask));
done:
    jali_bitmap_free(ctx, &before);
    jali_bridges_free(ctx, &free_ones);
    optimising_close(ctx, &o);
    return status;
}

jali_status jali_optimise_mend(jali_context *ctx, const jali_chart *chart, const jali_optimise_options *given,
                               jali_bitmap *mask, jali_round *residual)
{
    jali_status status;
    jali_optimised found = {0};
    optimising o = {.chart = chart, .opt = given ? *given : jali_optimise_defaults(), .result = &found};
    o.opt.details = o.opt.mark_bridges = false;
    *residual = (jali_round){0};
    TRY(optimising_open(ctx, mask, &o));
    TRY(finish(ctx, &o, mask));
    TRY(count_residual(ctx, &o, mask));
    *residual = found.residual;
done:
    jali_optimised_free(ctx, &found);
    optimising_close(ctx, &o);
    return status;
}
