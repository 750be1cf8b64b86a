// The finish: nothing in the mask is thinner than the widths, and no neck either.
//
// Why cores: an opening keeps two discs that barely touch; the neck between them is thinner than any width
// and parts in the print. Where the discs' centres are joined by a stroke there is no neck. Ends: the first
// round takes thin solid off; from then on every step adds solid (strokes, filled voids, discs on details of
// types A and B), so the number of black pixels falls until nothing changes. What is left is type C. Dead
// ends: taking off in every round does not end, for a filled void can be too thin for the solid's element and
// the two undo each other for ever; thickening the tips too floods (recall of black 80 -> 76 %, 20 rounds).
#include "adapt/hand.h"
#include "base/base.h"

// Whether the patch, set on (0, 0), covers (dx, dy).
static bool covers(const patch *p, int32_t dx, int32_t dy)
{
    int32_t k = dy - p->top;
    return k >= 0 && k < p->rows && dx >= p->span[k][0] && dx <= p->span[k][1];
}

// Where to set the element so that it covers (x, y): the fewest black pixels made white, less the thin ones
// covered.
static void cheapest_cover(const jali_bitmap *mask, const jali_bitmap *thin, const field *e, int32_t x,
                           int32_t y, int32_t at[2])
{
    int32_t best = INT32_MAX;
    for (int32_t dy = -e->above; dy <= e->below; dy++)
        for (int32_t dx = -e->left; dx <= e->right; dx++) {
            const patch *p = patch_at(e, x - dx, y - dy);
            if (!covers(p, dx, dy)) continue;
            int32_t cost =
                count_patch(mask, x - dx, y - dy, p, false) - count_patch(thin, x - dx, y - dy, p, true);
            if (cost >= best) continue;
            best = cost;
            at[0] = x - dx;
            at[1] = y - dy;
        }
}

// A plate without a frame ends at the bitmap's border, and so must the element.
static void move_inside(const jali_bitmap *mask, const field *e, int32_t at[2])
{
    at[0] = MAX(MIN(at[0], mask->width_px - e->right - 1), MIN(e->left, mask->width_px / 2));
    at[1] = MAX(MIN(at[1], mask->height_px - e->below - 1), MIN(e->above, mask->height_px / 2));
}

// Cover the details of types A and B: an element at each. What it leaves of a long one comes next round. What
// is fixed is left as it is.
static jali_status thicken_details(jali_context *ctx, const jali_adapt_options *opt, const field *e,
                                   jali_bitmap *mask)
{
    jali_details thin = {0};
    components c = {0};
    jali_status status;
    TRY(jali_adapt_details(ctx, mask, true, opt, &thin));
    for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++) {
        if (opt->fixed) combine(ctx, RULE_AND_NOT, &thin.type[type], opt->fixed, &thin.type[type]);
        TRY(label_components(ctx, &thin.type[type], true, 8, &c));
        for (int32_t y = 0, next = 0; y < c.height_px; y++)
            for (int32_t i = c.first[y]; i < c.first[y + 1]; i++) {
                if (c.label[i] != next) continue;
                next++;
                int32_t at[2] = {0};
                cheapest_cover(mask, &thin.type[type], e, c.span[i][0], y, at);
                if (!opt->outside_solid) move_inside(mask, e, at);
                paint_patch(mask, at[0], at[1], patch_at(e, at[0], at[1]), true);
            }
        components_free(ctx, &c);
    }
    put_back(opt, mask);
done:
    jali_details_free(ctx, &thin);
    components_free(ctx, &c);
    return status;
}

// Cores that lie near each other count as one.
static jali_status merge_near(jali_context *ctx, const field *near, jali_bitmap *cores)
{
    jali_status status;
    jali_bitmap merged = {0};
    if (!near->patches) return JALI_OK;
    TRY(jali_bitmap_create(ctx, cores->width_px, cores->height_px, &merged));
    TRY(field_dilate(ctx, cores, near, false, &merged));
    jali_bitmap swap = *cores;
    *cores = merged;
    merged = swap;
done:
    jali_bitmap_free(ctx, &merged);
    return status;
}

jali_status jali_adapt_cores(jali_context *ctx, const jali_adapt_options *opt, bool thicken,
                             jali_bitmap *mask, jali_bitmap *cores)
{
    jali_status status;
    widths w = {0};
    *cores = (jali_bitmap){0};
    TRY(mask_widths(ctx, opt, mask, 0, &w));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, cores));
    if (thicken) TRY(thicken_details(ctx, opt, &w.solid, mask));
    TRY(field_erode(ctx, mask, &w.solid, opt->outside_solid, cores));
    if (!thicken) TRY(field_dilate(ctx, cores, &w.solid, false, mask));
    put_back(opt, mask);
    TRY(merge_near(ctx, &w.near, cores));
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, cores);
    widths_free(ctx, &w);
    return status;
}

// What was black and is closed is black again.
static void clear_closed(const jali_adapt_options *opt, const jali_bitmap *before, jali_bitmap *mask)
{
    for (int64_t i = 0; i < mask->stride * mask->height_px; i++)
        mask->word[i] &= ~opt->closed->word[i] | before->word[i];
}

jali_status jali_adapt_lay(jali_context *ctx, jali_bridges *bridges, const jali_adapt_options *opt,
                           jali_bitmap *mask)
{
    jali_status status;
    widths w = {0};
    jali_bitmap scratch = {0};
    TRY(mask_widths(ctx, opt, mask, 0, &w));
    TRY(jali_bitmap_copy(ctx, mask, &scratch));
    TRY(jali_adapt_strokes(ctx, bridges, opt, false, mask));
    if (opt->closed) clear_closed(opt, &scratch, mask);
    TRY(field_close(ctx, mask, &w.hollow, opt->outside_solid, &scratch, mask));
    put_back(opt, mask);
done:
    jali_bitmap_free(ctx, &scratch);
    widths_free(ctx, &w);
    return status;
}
