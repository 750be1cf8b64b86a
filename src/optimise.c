// The image method: from a drawing to a mask that prints as one piece.
//
// Source:  Binary Image Carving for 3D Printing, section 4, Algorithms 1 and 3.
// Two ways through the same stages:
//   --paper  Algorithm 1 to the letter: connect, compensate, then Algorithm 3's rounds on the input's grid
//   with
//            square elements. As written the rounds need not end (34 of 74 runs go round in circles), so they
//            stop after most_rounds or when a picture comes back, and the finish settles what is left.
//   default  the print is designed first, in the widths it will have (jali_adapt_print: the owner of each
//            conflict is whoever leaves the smaller predicted error), pieces that are not worth their bridges
//            go, then the mask is the print less what the printer adds, and the finish joins it.
// Ends:    rounds are counted; the finish only adds solid after its first round (src/adapt/finish.c).
// Checked: tests/test_optimise.c; docs/results.md on 24 runs over real pictures.
// By hand: drawn bridges are part of the drawing, bridges bend around what is forbidden or locked, and what
// is
//          locked or drawn is put back wherever a stage has changed it (hand.c).
#include <jali/compensate.h>
#include <jali/connect.h>
#include <jali/optimise.h>
#include "hand.h"
#include "raster/raster.h"
#include "base/base.h"

#include <math.h>

// A width that misses a whole number of pixels by less is that number: 0.3 mm are 12 px of 0.02501 mm.
static const double WIDTH_TOLERANCE_PX = 0.01;

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

static int32_t odd(double n)
{
    return (int32_t)n | 1;
}

static double nearest_half_down(double x)
{
    return ceil(x - 0.5 - 1e-9);
}

// Eq. 1 and section 4.3, in the reading that gives all of Table 1: omega_c = max(3, odd(ceil(r / 2) + 2))
// with r = phi_e / pixel rounded, omega_w and omega_b = the rounded widths made odd.
void jali_paper_kernels(double phi_e_mm, double phi_s_mm, double phi_v_mm, double pixel_mm,
                        int32_t kernels_px[3])
{
    kernels_px[0] = MAX(3, odd(ceil(nearest_half_down(phi_e_mm / pixel_mm) / 2) + 2));
    kernels_px[1] = MAX(1, odd(nearest_half_down(phi_s_mm / pixel_mm)));
    kernels_px[2] = MAX(1, odd(nearest_half_down(phi_v_mm / pixel_mm)));
}

// On the working grid: the growth to the nearest pixel a side, the widths never less than asked for.
static void exact_kernels(const jali_optimise_options *opt, double pixel_mm, int32_t kernels_px[3])
{
    kernels_px[0] = 1 + 2 * (int32_t)floor(opt->phi_e_mm / 2 / pixel_mm + 0.5);
    kernels_px[1] = MAX(1, (int32_t)ceil(opt->phi_s_mm / pixel_mm - WIDTH_TOLERANCE_PX));
    kernels_px[2] = MAX(1, (int32_t)ceil(opt->phi_v_mm / pixel_mm - WIDTH_TOLERANCE_PX));
}

static jali_status check_positive(jali_context *ctx, const char *name, double mm, bool zero_allowed)
{
    if (mm > 0 && mm <= 1000) return JALI_OK;
    if (zero_allowed && mm == 0) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE, "%s is %g mm; %s 1000 mm is accepted", name, mm,
                zero_allowed ? "0 to" : "more than 0 and up to");
}

static jali_status choose_kernels(jali_context *ctx, const jali_optimise_options *opt,
                                  const jali_chart *chart, int32_t kernels_px[3])
{
    jali_status status;
    TRY(check_positive(ctx, "phi_e (or a kerf)", fabs(opt->phi_e_mm), true));
    if (opt->paper && opt->phi_e_mm < 0)
        return fail(ctx, JALI_BAD_VALUE,
                    "phi_e is %g mm, a kerf: the paper's method has none; leave --paper out", opt->phi_e_mm);
    TRY(check_positive(ctx, "phi_s", opt->phi_s_mm, false));
    TRY(check_positive(ctx, "phi_v", opt->phi_v_mm, false));
    TRY(check_positive(ctx, "epsilon", opt->epsilon_mm, true));
    double pixel_mm = jali_chart_pixel_mm(chart);
    if (opt->paper)
        jali_paper_kernels(opt->phi_e_mm, opt->phi_s_mm, opt->phi_v_mm, pixel_mm, kernels_px);
    else
        exact_kernels(opt, pixel_mm, kernels_px);
    for (int32_t i = 0; i < 3; i++)
        if (opt->kernels_px[i]) kernels_px[i] = opt->kernels_px[i];
    if (kernels_px[0] < -4000 || kernels_px[0] % 2 == 0 || kernels_px[1] < 1 || kernels_px[2] < 1 ||
        MAX(kernels_px[0], MAX(kernels_px[1], kernels_px[2])) > 4000)
        return fail(ctx, JALI_BAD_VALUE,
                    "kernels of %d, %d and %d px: omega_c must be odd, from -4000 px on, the others from 1; "
                    "up to 4000 "
                    "px",
                    kernels_px[0], kernels_px[1], kernels_px[2]);
done:
    return status;
}

// --- Rounds

typedef struct optimising {
    const jali_chart *chart;
    jali_optimise_options opt;
    jali_adapt_options widths; // of the mask
    jali_metric metric;
    hand by_hand;
    size_t round_capacity, laid_capacity, via_capacity;
    jali_optimised *result;
} optimising;

// Join parts, around what is blocked: by the strokes' width in the mask or in the print.
static jali_status connect(jali_context *ctx, optimising *o, bool in_print, const jali_bitmap *picture,
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
        TRY(connect(ctx, o, false, picture, picture, picture, NULL));
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

// --- The finish: one piece, nothing thinner than the widths, no neck either

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
    TRY(connect(ctx, o, false, mask, &cores, &cores, &bridges));
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

static jali_status finish(jali_context *ctx, optimising *o, jali_bitmap *mask)
{
    jali_status status;
    jali_optimised *r = o->result;
    TRY(finish_rounds(ctx, o, true, 2, mask)); // the first only takes off, the second mends
    TRY(take_off_loose(ctx, o, mask));
    r->bridge_pixels += count_white(ctx, mask);
    if (r->bridge_mask.width_px > 0) combine(ctx, RULE_XOR, &r->bridge_mask, mask, &r->bridge_mask);
done:
    return status;
}

// What the finish left: types A and B must be none.
static jali_status count_residual(jali_context *ctx, optimising *o, const jali_bitmap *mask)
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

// --- The two ways

// From the print to the mask; the paper has one kernel for the whole picture.
static jali_compensate_options compensation(const optimising *o)
{
    return (jali_compensate_options){o->widths.shape, o->result->kernels_px[0], o->chart->outside_solid,
                                     o->opt.paper ? NULL : o->chart};
}

// Algorithm 1 as printed.
static jali_status by_the_paper(jali_context *ctx, optimising *o, const jali_bitmap *drawing,
                                jali_bitmap *mask)
{
    jali_status status;
    jali_bitmap joined = {0};
    jali_compensate_options compensate = compensation(o);
    TRY(connect(ctx, o, false, drawing, drawing, &joined, NULL));
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
    TRY(connect(ctx, o, true, &print, &print, &joined, &bridges));
    TRY(jali_adapt_prune(ctx, drawing, &bridges, &o->widths, &print, &o->result->pieces_dropped));
    TRY(jali_compensate(ctx, &print, &compensate, mask));
    hand_keep(ctx, &o->by_hand, false, mask);
done:
    jali_bridges_free(ctx, &bridges);
    jali_bitmap_free(ctx, &print);
    jali_bitmap_free(ctx, &joined);
    return status;
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

static jali_status draw_by_hand(jali_context *ctx, optimising *o, const jali_bitmap *tones)
{
    jali_compensate_options compensate = compensation(o);
    return hand_create(ctx, o->opt.edits, o->chart, &compensate, tones, &o->widths, &o->by_hand);
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
    jali_elements *elements = NULL;
    *result = (jali_optimised){0};
    TRY(prepare(ctx, &o));
    TRY(jali_elements_create(ctx, &o.widths, drawing->width_px, drawing->height_px, &elements));
    o.widths.elements = elements;
    TRY(draw_by_hand(ctx, &o, drawing));
    const jali_bitmap *picture = o.by_hand.any ? &o.by_hand.picture : drawing;
    TRY(o.opt.paper ? by_the_paper(ctx, &o, picture, &result->mask)
                    : by_design_of_the_print(ctx, &o, picture, &result->mask));
    TRY(finish(ctx, &o, &result->mask));
    count_drawn(ctx, &o, drawing);
    TRY(check_something_left(ctx, &o, drawing, &result->mask));
    TRY(count_residual(ctx, &o, &result->mask));
done:
    if (status != JALI_OK) jali_optimised_free(ctx, result);
    hand_free(ctx, &o.by_hand);
    jali_elements_free(ctx, elements);
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
    jali_elements *elements = NULL;
    jali_bitmap before = {0};
    jali_bridges free_ones = {0};
    o.laid_capacity = (size_t)result->laid.count;
    o.via_capacity = (size_t)result->laid.via_count;
    TRY(prepare(ctx, &o));
    TRY(jali_elements_create(ctx, &o.widths, result->mask.width_px, result->mask.height_px, &elements));
    o.widths.elements = elements;
    TRY(draw_by_hand(ctx, &o, &result->mask));
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
    hand_free(ctx, &o.by_hand);
    jali_elements_free(ctx, elements);
    return status;
}

jali_status jali_optimise_mend(jali_context *ctx, const jali_chart *chart, const jali_optimise_options *given,
                               jali_bitmap *mask, jali_round *residual)
{
    jali_status status;
    jali_optimised found = {0};
    optimising o = {.chart = chart, .opt = given ? *given : jali_optimise_defaults(), .result = &found};
    jali_elements *elements = NULL;
    o.opt.details = o.opt.mark_bridges = false;
    *residual = (jali_round){0};
    TRY(prepare(ctx, &o));
    TRY(jali_elements_create(ctx, &o.widths, mask->width_px, mask->height_px, &elements));
    o.widths.elements = elements;
    TRY(draw_by_hand(ctx, &o, mask));
    TRY(finish(ctx, &o, mask));
    TRY(count_residual(ctx, &o, mask));
    *residual = found.residual;
done:
    jali_optimised_free(ctx, &found);
    hand_free(ctx, &o.by_hand);
    jali_elements_free(ctx, elements);
    return status;
}
