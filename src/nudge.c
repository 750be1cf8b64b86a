// The inverse of the forward model: where must the mask's edges lie so that the print's lie on the picture's?
//
// Each round measures how far the print's edge is off the picture's, place by place, as the difference of
// their signed distances, and moves the mask's edge by as much. What is off by more than half a width is no
// matter of edges (a bridge, a feature that was given up) and stays. The model may be any: it is only asked.
//
// The moved mask is mended by the finish's rules, so widths hold; where the print came out worse than before
// about a place the earlier mask is taken there, and the seams are mended again. The best mask met is kept.
//
// Source:  edge placement error as the step, as in optical proximity correction: N. B. Cobb, Fast optical and
//          process proximity correction algorithms for integrated circuit manufacturing, 1998, chapter 5.
// Limits:  one step of the working grid is the least that an edge can move.
// Checked: tests/test_nudge.c.
#include <jali/nudge.h>
#include "raster/raster.h"
#include "scan/grey.h"
#include "base/base.h"

#include <math.h>

enum { BAND_ROWS = 128, BLOCKS_A_WIDTH = 3 };

static const double REACH = 0.5;     // of the narrower width: edges that are off by more stay
static const double ALONG_MM = 0.05; // edges move together over such a length
static const double ABOUT = 0.7;     // of the narrower width: about a place
static const double LEAST_GAIN = 1e-4;

typedef struct nudging {
    const jali_reference *reference;
    const jali_predict_options *printer;
    const jali_chart *chart;
    const jali_optimise_options *opt;
    double fine_px_a_px; // of the reference's grid, a mask's
    double reach_fine_px, along_fine_px, about_fine_px;
    jali_bitmap locked; // by hand; not owned
} nudging;

// A mask and what comes of it.
typedef struct state {
    jali_bitmap mask;
    jali_round residual;
    jali_prediction print;
} state;

static void state_free(jali_context *ctx, state *s)
{
    jali_bitmap_free(ctx, &s->mask);
    jali_prediction_free(ctx, &s->print);
    *s = (state){0};
}

// --- How far edges are off

// Distance to the edge in pixels, inside solid above 0, at most `most` either way.
static jali_status signed_distances(jali_context *ctx, const jali_bitmap *a, int32_t from, int32_t rows,
                                    double most, grey *out)
{
    jali_status status;
    jali_bitmap band = {0};
    int32_t *to_white = NULL, *to_black = NULL;
    size_t size = (size_t)rows * (size_t)a->width_px;
    *out = (grey){0};
    TRY(jali_bitmap_create(ctx, a->width_px, rows, &band));
    cut_out(ctx, a, 0, from, &band);
    TRY(ALLOCATE(ctx, to_white, size));
    TRY(ALLOCATE(ctx, to_black, size));
    TRY(grey_create(ctx, a->width_px, rows, 1, out));
    TRY(squared_distances(ctx, &band, true, 0, rows, to_white));
    TRY(squared_distances(ctx, &band, false, 0, rows, to_black));
    for (size_t i = 0; i < size; i++) {
        bool white = to_white[i] == 0;
        double d = fmin(sqrt(white ? to_black[i] : to_white[i]) - 0.5, most);
        out->level[i] = (float)(white ? d : -d);
    }
done:
    jali_bitmap_free(ctx, &band);
    release(ctx, to_white);
    release(ctx, to_black);
    return status;
}

// How far the print's edges should move outwards, in fine pixels, on some rows of the fine grid.
static jali_status shift_of(jali_context *ctx, const nudging *n, const jali_bitmap *printed, int32_t from,
                            int32_t rows, grey *shift)
{
    jali_status status;
    grey print = {0};
    double reach = n->reach_fine_px;
    TRY(signed_distances(ctx, &n->reference->picture, from, rows, 2 * reach, shift));
    TRY(signed_distances(ctx, printed, from, rows, 2 * reach, &print));
    for (size_t i = 0; i < (size_t)rows * (size_t)shift->width; i++) {
        shift->level[i] -= print.level[i];
        if (fabs((double)shift->level[i]) > reach) shift->level[i] = 0;
    }
    TRY(grey_blur(ctx, shift, n->along_fine_px));
done:
    grey_free(ctx, &print);
    return status;
}

// One band of the mask with its edges moved.
//   in     share   of the way
static jali_status move_band(jali_context *ctx, const nudging *n, const state *now, double share, int32_t y0,
                             int32_t y1, jali_bitmap *moved)
{
    jali_status status = JALI_OK;
    grey shift = {0}, here = {0};
    const jali_bitmap *fine = &n->reference->picture;
    double scale = n->fine_px_a_px, reach = n->reach_fine_px / scale;
    int32_t margin = n->chart->margin_px, halo = (int32_t)ceil(2 * n->reach_fine_px + 4 * n->along_fine_px),
            halo_px = (int32_t)ceil(2 * reach);
    int32_t fine_from = MAX((int32_t)floor((y0 - margin) * scale) - halo, 0),
            fine_to = MIN((int32_t)ceil((y1 - margin) * scale) + halo, fine->height_px),
            from = MAX(y0 - halo_px, 0), to = MIN(y1 + halo_px, now->mask.height_px);
    if (fine_from >= fine_to) goto done;
    TRY(shift_of(ctx, n, &now->print.printed, fine_from, fine_to - fine_from, &shift));
    TRY(signed_distances(ctx, &now->mask, from, to - from, 2 * reach, &here));
    for (int32_t y = MAX(y0, margin); y < MIN(y1, now->mask.height_px - margin); y++)
        for (int32_t x = margin; x < now->mask.width_px - margin; x++) {
            double d = (double)here.level[(size_t)(y - from) * (size_t)here.width + (size_t)x];
            if (fabs(d) > reach) continue;
            double by =
                (double)grey_at(&shift, (x + 0.5 - margin) * scale, (y + 0.5 - margin) * scale - fine_from);
            jali_bitmap_set(moved, x, y, d + share * by / scale > 0);
        }
done:
    grey_free(ctx, &shift);
    grey_free(ctx, &here);
    return status;
}

// --- What a move brought

// How many fine pixels fewer are wrong about each place, in blocks.
static jali_status gain_of(jali_context *ctx, const nudging *n, const jali_bitmap *before,
                           const jali_bitmap *after, grey *gain)
{
    jali_status status;
    jali_bitmap wrong = {0};
    grey left = {0};
    const jali_bitmap *wanted = &n->reference->picture;
    int32_t block = MAX(1, (int32_t)(n->about_fine_px / BLOCKS_A_WIDTH));
    *gain = (grey){0};
    TRY(jali_bitmap_create(ctx, wanted->width_px, wanted->height_px, &wrong));
    combine(ctx, RULE_XOR, wanted, before, &wrong);
    TRY(grey_of_bitmap(ctx, &wrong, block, gain));
    combine(ctx, RULE_XOR, wanted, after, &wrong);
    TRY(grey_of_bitmap(ctx, &wrong, block, &left));
    for (size_t i = 0; i < (size_t)gain->width * (size_t)gain->height; i++) gain->level[i] -= left.level[i];
    TRY(grey_blur(ctx, gain, n->about_fine_px / block));
done:
    jali_bitmap_free(ctx, &wrong);
    grey_free(ctx, &left);
    return status;
}

// Where the print came no nearer, the earlier mask.
static void take_back(const nudging *n, const grey *gain, const jali_bitmap *before, jali_bitmap *mask)
{
    int32_t margin = n->chart->margin_px;
    for (int32_t y = 0; y < mask->height_px; y++)
        for (int64_t k = 0; k < mask->stride; k++) {
            uint64_t *word = &mask->word[y * mask->stride + k],
                     differ = *word ^ before->word[y * before->stride + k];
            for (; differ; differ &= differ - 1) {
                int32_t bit = __builtin_ctzll(differ), x = (int32_t)(64 * k) + bit;
                double at_x = (x + 0.5 - margin) * n->fine_px_a_px,
                       at_y = (y + 0.5 - margin) * n->fine_px_a_px;
                if ((double)grey_at(gain, at_x, at_y) <= LEAST_GAIN) *word ^= UINT64_C(1) << bit;
            }
        }
}

// Mend the mask's widths and see what it prints as.
static jali_status look(jali_context *ctx, const nudging *n, state *s)
{
    jali_status status;
    TRY(jali_optimise_mend(ctx, n->chart, n->opt, &s->mask, &s->residual));
    TRY(jali_predict(ctx, n->reference, &s->mask, n->chart->margin_px, n->chart->outside_solid, n->printer,
                     &s->print));
done:
    return status;
}

// What is locked by hand is as it was: a mask is mended with what it has there.
static void leave_locked(const nudging *n, const jali_bitmap *before, jali_bitmap *mask)
{
    for (int64_t i = 0; n->locked.word && i < mask->stride * mask->height_px; i++)
        mask->word[i] ^= (mask->word[i] ^ before->word[i]) & n->locked.word[i];
}

static bool better(const state *a, const state *b)
{
    const jali_round *p = &a->residual, *q = &b->residual;
    bool keeps = a->print.pieces <= b->print.pieces;
    for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++)
        keeps = keeps && p->white[type] <= q->white[type] && p->black[type] <= q->black[type];
    return keeps && a->print.error_rate < b->print.error_rate;
}

static void keep_better(jali_context *ctx, state *best, state *other)
{
    if (better(other, best)) {
        state_free(ctx, best);
        *best = *other;
        *other = (state){0};
    }
    state_free(ctx, other);
}

// One round; `now` becomes better or stays.
static jali_status nudge_round(jali_context *ctx, const nudging *n, double share, state *now)
{
    jali_status status;
    state moved = {0}, mixed = {0};
    grey gain = {0};
    TRY(jali_bitmap_copy(ctx, &now->mask, &moved.mask));
    for (int32_t y = 0; y < now->mask.height_px; y += BAND_ROWS) {
        TRY(step(ctx, "nudge", (double)y / now->mask.height_px));
        TRY(move_band(ctx, n, now, share, y, MIN(y + BAND_ROWS, now->mask.height_px), &moved.mask));
    }
    leave_locked(n, &now->mask, &moved.mask);
    TRY(look(ctx, n, &moved));
    TRY(gain_of(ctx, n, &now->print.printed, &moved.print.printed, &gain));
    TRY(jali_bitmap_copy(ctx, &moved.mask, &mixed.mask));
    take_back(n, &gain, &now->mask, &mixed.mask);
    TRY(look(ctx, n, &mixed));
    keep_better(ctx, now, &moved);
    keep_better(ctx, now, &mixed);
done:
    grey_free(ctx, &gain);
    state_free(ctx, &moved);
    state_free(ctx, &mixed);
    return status;
}

jali_status jali_nudge(jali_context *ctx, const jali_reference *reference,
                       const jali_predict_options *printer, const jali_chart *chart,
                       const jali_optimise_options *opt, int32_t rounds, jali_optimised *result,
                       jali_nudge_report *report)
{
    static const double SHARES[] = {1, 0.5}; // of the way; half of it where the whole brings nothing
    jali_status status;
    jali_predict_options quick = *printer;
    double width_mm = MIN(opt->phi_s_mm, opt->phi_v_mm),
           fine_mm = printer->picture_mm / reference->picture.width_px;
    nudging n = {reference,
                 &quick,
                 chart,
                 opt,
                 jali_chart_pixel_mm(chart) / fine_mm,
                 REACH * width_mm / fine_mm,
                 ALONG_MM / fine_mm,
                 ABOUT * width_mm / fine_mm,
                 {0}};
    jali_marks marks = {0};
    state now = {.residual = result->residual};
    quick.recall = false;
    *report = (jali_nudge_report){0};
    if (rounds < 0 || rounds > 100)
        return fail(ctx, JALI_BAD_VALUE, "%d rounds of nudging were asked for; 0 to 100 is accepted", rounds);
    if (opt->edits && opt->edits->count > 0) TRY(jali_edits_draw(ctx, opt->edits, chart, &marks));
    n.locked = marks.locked;
    TRY(jali_bitmap_copy(ctx, &result->mask, &now.mask));
    TRY(jali_predict(ctx, reference, &now.mask, chart->margin_px, chart->outside_solid, &quick, &now.print));
    report->error_before = now.print.error_rate;
    for (int32_t round = 0, kind = 0; round < rounds && kind < 2; round++) {
        double before = now.print.error_rate;
        TRY(nudge_round(ctx, &n, SHARES[kind], &now));
        if (now.print.error_rate < before)
            report->rounds++;
        else
            kind++;
    }
    report->error_after = now.print.error_rate;
    report->changed_px = count_combined(ctx, RULE_XOR, &now.mask, &result->mask);
    jali_bitmap_free(ctx, &result->mask);
    result->mask = now.mask;
    result->residual = now.residual;
    now.mask = (jali_bitmap){0};
    if (result->bridge_mask.word)
        combine(ctx, RULE_AND, &result->bridge_mask, &result->mask, &result->bridge_mask);
done:
    jali_marks_free(ctx, &marks);
    state_free(ctx, &now);
    return status;
}
