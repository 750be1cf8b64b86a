// The image method: from a drawing to a mask that prints as one piece.
//
// Source:  Binary Image Carving for 3D Printing, section 4, Algorithms 1 and 3.
// Two ways through the same stages:
//   --paper  Algorithm 1 to the letter: connect, compensate, then Algorithm 3's rounds on the input's grid
//            with square elements. As written the rounds need not end (34 of 74 runs go round in circles), so
//            they stop after most_rounds or when a picture comes back, and the finish settles what is left.
//   default  the print is designed first, in the widths it will have (jali_adapt_print: the owner of each
//            conflict is whoever leaves the smaller predicted error), pieces that are not worth their bridges
//            go, then the mask is the print less what the printer adds, and the finish joins it.
// Ends:    rounds are counted; the finish only adds solid after its first round (finish.c).
// Checked: tests/test_optimise.c; docs/results.md on 24 runs over real pictures.
// By hand: drawn bridges are part of the drawing, bridges bend around what is forbidden or locked, and what
//          is locked or drawn is put back wherever a stage has changed it (hand.c).
#include "optimising.h"
#include "raster/raster.h"

#include <math.h>

jali_optimise_options jali_optimise_defaults(void)
{
    return (jali_optimise_options){
        .phi_e_mm = 0.1, .phi_s_mm = 0.3, .phi_v_mm = 0.5, .epsilon_mm = 4, .most_rounds = 8, .detail = 1};
}

void jali_optimised_free(jali_context *ctx, jali_optimised *result)
{
    jali_bitmap_free(ctx, &result->mask);
    jali_bitmap_free(ctx, &result->conflict);
    jali_bitmap_free(ctx, &result->bridge_mask);
    jali_details_free(ctx, &result->white);
    jali_details_free(ctx, &result->black);
    jali_bridges_free(ctx, &result->laid);
    release(ctx, result->round);
    *result = (jali_optimised){0};
}

// --- Ready

// From the print to the mask; the paper has one kernel for the whole picture.
static jali_compensate_options compensation(const optimising *o)
{
    return (jali_compensate_options){o->widths.shape, o->result->kernels_px[0], o->chart->outside_solid,
                                     o->opt.paper ? NULL : o->chart};
}

static jali_status prepare(jali_context *ctx, optimising *o)
{
    jali_status status;
    int32_t *kernels = o->result->kernels_px;
    TRY(choose_kernels(ctx, &o->opt, o->chart, kernels));
    if (o->opt.most_rounds < 1 || o->opt.most_rounds > 1000)
        return fail(ctx, JALI_BAD_VALUE, "at most %d rounds were asked for; 1 to 1000 is accepted",
                    o->opt.most_rounds);
    o->metric = o->opt.paper ? JALI_METRIC_CITY_BLOCK : JALI_METRIC_OCTAGON;
    o->widths = jali_adapt_defaults();
    o->widths.shape = o->opt.paper ? JALI_SHAPE_SQUARE : JALI_SHAPE_DISC;
    o->widths.solid_px = kernels[1];
    o->widths.void_px = kernels[2];
    o->widths.growth_px = o->opt.paper ? 1 : kernels[0];
    o->widths.epsilon_px = (int32_t)floor(o->opt.epsilon_mm / jali_chart_pixel_mm(o->chart));
    o->widths.isolated_matters = !o->opt.paper;
    o->widths.outside_solid = o->chart->outside_solid;
    o->widths.chart = o->opt.paper ? NULL : o->chart;
    o->widths.axis_worth_white *= o->opt.detail;
    o->widths.axis_worth_black *= o->opt.detail;
done:
    return status;
}

static jali_status draw_by_hand(jali_context *ctx, optimising *o, const jali_bitmap *tones)
{
    jali_compensate_options compensate = compensation(o);
    return hand_create(ctx, o->opt.edits, o->chart, &compensate, tones, &o->widths, &o->by_hand);
}

jali_status optimising_open(jali_context *ctx, const jali_bitmap *tones, optimising *o)
{
    jali_status status;
    TRY(prepare(ctx, o));
    TRY(jali_elements_create(ctx, &o->widths, tones->width_px, tones->height_px, &o->elements));
    o->widths.elements = o->elements;
    TRY(draw_by_hand(ctx, o, tones));
done:
    return status;
}

void optimising_close(jali_context *ctx, optimising *o)
{
    hand_free(ctx, &o->by_hand);
    jali_elements_free(ctx, o->elements);
    o->elements = NULL;
}

// --- Rounds

static jali_status record_round(jali_context *ctx, optimising *o, const jali_details *white,
                                const jali_details *black, int32_t conflicts)
{
    jali_optimised *r = o->result;
    jali_status status = GROW(ctx, r->round, o->round_capacity, r->round_count + 1);
    if (status != JALI_OK) return status;
    jali_round *round = &r->round[r->round_count++];
    memcpy(round->white, white->count, sizeof round->white);
    memcpy(round->black, black->count, sizeof round->black);
    round->conflicts = conflicts;
    return JALI_OK;
}

// Look at a picture once: details of both tones and their conflicts, recorded, kept for overlays when first.
static jali_status look(jali_context *ctx, optimising *o, const jali_bitmap *picture,
                        const jali_adapt_options *widths, jali_details *white, jali_details *black,
                        jali_bitmap *conflict)
{
    jali_status status;
    int32_t regions = 0;
    TRY(jali_adapt_details(ctx, picture, true, widths, white));
    TRY(jali_adapt_details(ctx, picture, false, widths, black));
    TRY(jali_adapt_conflicts(ctx, white, black, widths, conflict, &regions));
    TRY(record_round(ctx, o, white, black, regions));
done:
    return status;
}

static bool anything_to_treat(const jali_details *details)
{
    return details->count[JALI_TYPE_A] + details->count[JALI_TYPE_B] > 0;
}

static uint64_t hash_of(const jali_bitmap *a)
{
    uint64_t hash = UINT64_C(14695981039346656037); // FNV-1a, a word at a time
    for (int64_t i = 0; i < a->stride * a->height_px; i++)
        hash = (hash ^ a->word[i]) * UINT64_C(1099511628211);
    return hash;
}

// The first round's findings stay for overlays; those of later rounds go.
static void keep_or_drop(jali_context *ctx, optimising *o, jali_details *white, jali_details *black,
                         jali_bitmap *conflict)
{
    jali_optimised *r = o->result;
    if (o->opt.details && r->round_count == 1 && !r->conflict.word) {
        r->white = *white;
        r->black = *black;
        r->conflict = *conflict;
        *white = *black = (jali_details){0};
        *conflict = (jali_bitmap){0};
    }
    jali_details_free(ctx, white);
    jali_details_free(ctx, black);
    jali_bitmap_free(ctx, conflict);
}

// Algorithm 3: connect, find details and conflicts, settle and grow them, until there is nothing to treat.
static jali_status adapt_in_rounds(jali_context *ctx, optimising *o, jali_bitmap *picture)
{
    jali_status status = JALI_OK;
    jali_details white = {0}, black = {0};
    jali_bitmap conflict = {0};
    uint64_t *seen = NULL;
    TRY(ALLOCATE(ctx, seen, o->opt.most_rounds));
    for (int32_t round = 0; round < o->opt.most_rounds; round++) {
        TRY(step(ctx, "adapt", (double)round / o->opt.most_rounds));
        TRY(join_parts(ctx, o, false, picture, picture, picture, NULL));
        seen[round] = hash_of(picture);
        for (int32_t i = 0; i < round; i++) o->result->cycled |= seen[i] == seen[round];
        if (o->result->cycled) break;
        TRY(look(ctx, o, picture, &o->widths, &white, &black, &conflict));
        if (!anything_to_treat(&white) && !anything_to_treat(&black)) break;
        TRY(jali_adapt_round(ctx, &white, &black, &conflict, picture));
        hand_keep(ctx, &o->by_hand, false, picture);
        keep_or_drop(ctx, o, &white, &black, &conflict);
    }
done:
    keep_or_drop(ctx, o, &white, &black, &conflict);
    release(ctx, seen);
    return status;
}

// --- The two ways

// Algorithm 1 as printed.
static jali_status by_the_paper(jali_context *ctx, optimising *o, const jali_bitmap *drawing,
                                jali_bitmap *mask)
{
    jali_status status;
    jali_bitmap joined = {0};
    jali_compensate_options compensate = compensation(o);
    TRY(join_parts(ctx, o, false, drawing, drawing, &joined, NULL));
    TRY(jali_compensate(ctx, &joined, &compensate, mask));
    hand_keep(ctx, &o->by_hand, false, mask);
    TRY(adapt_in_rounds(ctx, o, mask));
done:
    jali_bitmap_free(ctx, &joined);
    return status;
}

// Details of the drawing, as an overlay: widths are those of the print.
static jali_status look_at_drawing(jali_context *ctx, optimising *o, const jali_bitmap *drawing)
{
    jali_details white = {0}, black = {0};
    jali_bitmap conflict = {0};
    jali_adapt_options printed = o->widths;
    printed.growth_px = 1;
    printed.solid_px = MAX(o->widths.solid_px + o->widths.growth_px - 1, 1);
    printed.void_px = MAX(o->widths.void_px - o->widths.growth_px + 1, 1);
    jali_status status = look(ctx, o, drawing, &printed, &white, &black, &conflict);
    keep_or_drop(ctx, o, &white, &black, &conflict);
    return status;
}

static jali_status by_design_of_the_print(jali_context *ctx, optimising *o, const jali_bitmap *drawing,
                                          jali_bitmap *mask)
{
    jali_status status;
    jali_bitmap print = {0}, joined = {0};
    jali_bridges bridges = {0};
    jali_stamp_report report;
    jali_compensate_options compensate = compensation(o);
    if (o->opt.details) TRY(look_at_drawing(ctx, o, drawing));
    TRY(jali_adapt_print(ctx, drawing, &o->widths, &print, &report));
    TRY(jali_adapt_smooth(ctx, &o->widths, &print));
    hand_keep(ctx, &o->by_hand, true, &print);
    TRY(join_parts(ctx, o, true, &print, &print, &joined, &bridges));
    TRY(jali_adapt_prune(ctx, drawing, &bridges, &o->widths, &print, &o->result->pieces_dropped));
    TRY(jali_compensate(ctx, &print, &compensate, mask));
    hand_keep(ctx, &o->by_hand, false, mask);
done:
    jali_bridges_free(ctx, &bridges);
    jali_bitmap_free(ctx, &print);
    jali_bitmap_free(ctx, &joined);
    return status;
}

// White pixels of the picture itself, the margin left out.
static int64_t count_in_picture(const optimising *o, const jali_bitmap *a)
{
    int32_t margin = o->chart->margin_px;
    int64_t count = 0;
    for (int32_t y = margin; y < a->height_px - margin; y++)
        count += count_run(a, y, margin, a->width_px - margin);
    return count;
}

static jali_status check_something_left(jali_context *ctx, const optimising *o, const jali_bitmap *drawing,
                                        const jali_bitmap *mask)
{
    int32_t margin = o->chart->margin_px;
    int64_t all = (int64_t)(mask->width_px - 2 * margin) * (mask->height_px - 2 * margin);
    int64_t drawn = count_in_picture(o, drawing), left = count_in_picture(o, mask);
    if (any_white(ctx, mask) && ((left > 0 && left < all) || drawn == 0 || drawn == all)) return JALI_OK;
    return fail(
        ctx, JALI_NO_RESULT,
        "nothing of the picture is wide enough to print: no %s of %.3g mm is left; a larger size or a finer "
        "printer would help",
        left == all ? "void" : "solid", left == all ? o->opt.phi_v_mm : o->opt.phi_s_mm);
}

// Drawn bridges count as bridges.
static void count_drawn(jali_context *ctx, optimising *o, const jali_bitmap *drawing)
{
    jali_optimised *r = o->result;
    hand *h = &o->by_hand;
    if (!h->any) return;
    memcpy(r->edited.count, h->marks.count, sizeof r->edited.count);
    r->bridges += h->marks.drawn.count;
    r->bridge_pixels += count_combined(ctx, RULE_AND_NOT, &h->drawn, drawing);
    if (!r->bridge_mask.word) return;
    combine(ctx, RULE_AND_NOT, &h->drawn, drawing, &h->drawn);
    combine(ctx, RULE_OR, &r->bridge_mask, &h->drawn, &r->bridge_mask);
}

jali_status jali_optimise(jali_context *ctx, const jali_bitmap *drawing, const jali_chart *chart,
                          const jali_optimise_options *given, jali_optimised *result)
{
    jali_status status;
    optimising o = {.chart = chart, .opt = given ? *given : jali_optimise_defaults(), .result = result};
    *result = (jali_optimised){0};
    TRY(optimising_open(ctx, drawing, &o));
    const jali_bitmap *picture = o.by_hand.any ? &o.by_hand.picture : drawing;
    TRY(o.opt.paper ? by_the_paper(ctx, &o, picture, &result->mask)
                    : by_design_of_the_print(ctx, &o, picture, &result->mask));
    TRY(finish(ctx, &o, &result->mask));
    count_drawn(ctx, &o, drawing);
    TRY(check_something_left(ctx, &o, drawing, &result->mask));
    TRY(count_residual(ctx, &o, &result->mask));
done:
    if (status != JALI_OK) jali_optimised_free(ctx, result);
    optimising_close(ctx, &o);
    return status;
}

jali_status jali_optimise_blocked(jali_context *ctx, const jali_chart *chart,
                                  const jali_optimise_options *given, const jali_optimised *result,
                                  jali_bitmap *blocked)
{
    jali_status status;
    optimising o = {.chart = chart, .opt = given ? *given : jali_optimise_defaults()};
    jali_optimised kernels = {0};
    o.result = &kernels;
    *blocked = (jali_bitmap){0};
    TRY(prepare(ctx, &o));
    TRY(draw_by_hand(ctx, &o, &result->mask));
    if (o.by_hand.any) TRY(jali_adapt_blocked(ctx, &o.widths, false, &result->mask, blocked));
done:
    hand_free(ctx, &o.by_hand);
    return status;
}
