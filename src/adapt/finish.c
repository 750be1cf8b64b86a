// The finish: nothing in the mask is thinner than the widths, and no neck either.
//
// Why cores: an opening keeps two discs that barely touch; the neck between them is thinner than any width
// and parts in the print. Where the discs' centres are joined by a stroke there is no neck. Ends: the first
// round takes thin solid off; from then on every step adds solid (strokes, filled voids, discs on details of
// types A and B), so the number of black pixels falls until nothing changes. What is left is type C. Dead
// ends: taking off in every round does not end, for a filled void can be too thin for the solid's element and
// the two undo each other for ever; thickening the tips too floods (recall of black 80 -> 76 %, 20 rounds).
#include "adapt/widths.h"
#include "base/base.h"

#include <stdlib.h>

enum { NECK_SHARE = 6 };

// Where to set the element so that it covers (x, y): the fewest black pixels made white, less the thin ones
// covered.
static void cheapest_cover(const jali_bitmap *mask, const jali_bitmap *thin, const element *e, int32_t x,
                           int32_t y, int32_t at[2])
{
    int32_t best = INT32_MAX, even = e->size % 2 == 0;
    for (int32_t row = 0; row < e->size; row++) {
        int32_t dy = row - e->size / 2, half = e->half[abs(2 * dy + even) / 2];
        for (int32_t dx = -half; dx <= half - even; dx++) {
            int32_t cost =
                count_element(mask, x - dx, y - dy, e, false) - count_element(thin, x - dx, y - dy, e, true);
            if (cost >= best) continue;
            best = cost;
            at[0] = x - dx;
            at[1] = y - dy;
        }
    }
}

// A plate without a frame ends at the bitmap's border, and so must the element.
static void move_inside(const jali_bitmap *mask, const element *e, int32_t at[2])
{
    int32_t before = e->size / 2, after = e->size - before;
    at[0] = MAX(MIN(at[0], mask->width_px - after), MIN(before, mask->width_px / 2));
    at[1] = MAX(MIN(at[1], mask->height_px - after), MIN(before, mask->height_px / 2));
}

// Cover the details of types A and B: an element at each. What it leaves of a long one comes next round.
static jali_status thicken_details(jali_context *ctx, const jali_adapt_options *opt, const element *e,
                                   jali_bitmap *mask)
{
    jali_details thin = {0};
    components c = {0};
    jali_status status;
    TRY(jali_adapt_details(ctx, mask, true, opt, &thin));
    for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++) {
        TRY(label_components(ctx, &thin.type[type], true, 8, &c));
        for (int32_t y = 0, next = 0; y < c.height_px; y++)
            for (int32_t i = c.first[y]; i < c.first[y + 1]; i++) {
                if (c.label[i] != next) continue;
                next++;
                int32_t at[2] = {0};
                cheapest_cover(mask, &thin.type[type], e, c.span[i][0], y, at);
                if (!opt->outside_solid) move_inside(mask, e, at);
                paint_element(mask, at[0], at[1], e, true);
            }
        components_free(ctx, &c);
    }
done:
    jali_details_free(ctx, &thin);
    components_free(ctx, &c);
    return status;
}

// Cores up to `gap` px apart count as one: the neck between two discs of 12 px whose centres are 3 px apart
// is still 11.6 px wide. (At 5 px, 10.9 wide, one of 24 real pictures came apart in the prediction.)
static jali_status merge_near(jali_context *ctx, int32_t gap, jali_bitmap *cores)
{
    element disc = {0};
    jali_bitmap merged = {0};
    jali_status status;
    if (gap < 2) return JALI_OK;
    TRY(element_disc(ctx, gap | 1, &disc));
    TRY(jali_bitmap_create(ctx, cores->width_px, cores->height_px, &merged));
    TRY(dilate(ctx, cores, &disc, false, &merged));
    jali_bitmap swap = *cores;
    *cores = merged;
    merged = swap;
done:
    element_free(ctx, &disc);
    jali_bitmap_free(ctx, &merged);
    return status;
}

jali_status jali_adapt_cores(jali_context *ctx, const jali_adapt_options *opt, bool thicken,
                             jali_bitmap *mask, jali_bitmap *cores)
{
    jali_status status;
    element solid = {0}, hollow = {0};
    *cores = (jali_bitmap){0};
    TRY(mask_elements(ctx, opt, &solid, &hollow));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, cores));
    if (thicken) TRY(thicken_details(ctx, opt, &solid, mask));
    TRY(erode(ctx, mask, &solid, opt->outside_solid, cores));
    if (!thicken) TRY(dilate(ctx, cores, &solid, false, mask));
    TRY(merge_near(ctx, opt->solid_px / NECK_SHARE, cores));
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, cores);
    element_free(ctx, &solid);
    element_free(ctx, &hollow);
    return status;
}

jali_status jali_adapt_lay(jali_context *ctx, const jali_bridges *bridges, const jali_adapt_options *opt,
                           jali_bitmap *mask)
{
    jali_status status;
    element solid = {0}, hollow = {0};
    jali_bitmap scratch = {0};
    TRY(mask_elements(ctx, opt, &solid, &hollow));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, &scratch));
    for (int32_t i = 0; i < bridges->count; i++)
        paint_stroke(mask, bridges->bridge[i].from, bridges->bridge[i].to, &solid, true);
    TRY(close_by(ctx, mask, &hollow, opt->outside_solid, &scratch, mask));
done:
    jali_bitmap_free(ctx, &scratch);
    element_free(ctx, &solid);
    element_free(ctx, &hollow);
    return status;
}
