// Smooth edges of a print: the input's pixels show as stairs and the search's discs as beads; both are
// shorter than half a feature.
//
// Method:  twice the majority of 7 x 7, kept wherever the discs of both tones still fit; around places where
// they do
//          not (tips, dots, corners of strokes) the print stays as it is.
// Limits:  prints whose narrower width is below 10 px stay as they are: 7 x 7 would eat them.
#include "adapt/widths.h"
#include "base/base.h"

enum { LEAST_WIDTH_PX = 10 };

typedef struct smoothing {
    element solid, hollow;
    jali_bitmap smooth, damage, scratch;
} smoothing;

// What an opening of either tone removes from the smoothed print, single pixels aside, and its surroundings.
static jali_status find_damage(jali_context *ctx, smoothing *s, bool outside)
{
    jali_status status;
    jali_bitmap opened = {0};
    element speck = {0}, around = {0};
    TRY(element_square(ctx, 2, &speck));
    TRY(element_disc(ctx, 2 * MAX(s->solid.size, s->hollow.size) + 1, &around));
    TRY(jali_bitmap_create(ctx, s->smooth.width_px, s->smooth.height_px, &opened));
    TRY(open_by(ctx, &s->smooth, &s->solid, outside, &s->scratch, &opened));
    combine(ctx, RULE_XOR, &s->smooth, &opened, &s->damage);
    TRY(close_by(ctx, &s->smooth, &s->hollow, outside, &s->scratch, &opened));
    combine(ctx, RULE_XOR, &s->smooth, &opened, &opened);
    combine(ctx, RULE_OR, &s->damage, &opened, &opened);
    TRY(open_by(ctx, &opened, &speck, false, &s->scratch, &opened));
    TRY(dilate(ctx, &opened, &around, false, &s->damage));
done:
    jali_bitmap_free(ctx, &opened);
    element_free(ctx, &speck);
    element_free(ctx, &around);
    return status;
}

jali_status jali_adapt_smooth(jali_context *ctx, const jali_adapt_options *opt, jali_bitmap *print)
{
    jali_status status;
    smoothing s = {0};
    TRY(printed_elements(ctx, opt, &s.solid, &s.hollow));
    if (MIN(s.solid.size, s.hollow.size) < LEAST_WIDTH_PX) goto done;
    TRY(jali_bitmap_create(ctx, print->width_px, print->height_px, &s.smooth));
    TRY(jali_bitmap_create(ctx, print->width_px, print->height_px, &s.damage));
    TRY(jali_bitmap_create(ctx, print->width_px, print->height_px, &s.scratch));
    TRY(majority(ctx, print, opt->outside_solid, &s.scratch));
    TRY(majority(ctx, &s.scratch, opt->outside_solid, &s.smooth));
    TRY(find_damage(ctx, &s, opt->outside_solid));
    combine(ctx, RULE_AND, print, &s.damage, print);
    combine(ctx, RULE_AND_NOT, &s.smooth, &s.damage, &s.smooth);
    combine(ctx, RULE_OR, print, &s.smooth, print);
done:
    jali_bitmap_free(ctx, &s.smooth);
    jali_bitmap_free(ctx, &s.damage);
    jali_bitmap_free(ctx, &s.scratch);
    element_free(ctx, &s.solid);
    element_free(ctx, &s.hollow);
    return status;
}
