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
    widths w;
    jali_bitmap smooth, damage, scratch;
} smoothing;

// What an opening of either tone removes from the smoothed print, single pixels aside, and its surroundings.
static jali_status find_damage(jali_context *ctx, smoothing *s, bool outside)
{
    jali_status status;
    jali_bitmap opened = {0};
    element speck = {0}, around = {0};
    TRY(element_square(ctx, 2, &speck));
    TRY(element_disc(ctx, 2 * MAX(s->w.solid.most, s->w.hollow.most) + 1, &around));
    TRY(jali_bitmap_create(ctx, s->smooth.width_px, s->smooth.height_px, &opened));
    TRY(field_open(ctx, &s->smooth, &s->w.solid, outside, &s->scratch, &opened));
    combine(ctx, RULE_XOR, &s->smooth, &opened, &s->damage);
    TRY(field_close(ctx, &s->smooth, &s->w.hollow, outside, &s->scratch, &opened));
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

// The longest row or the number of rows, whichever is less.
static int32_t shorter_side(const patch *p)
{
    int32_t longest = 0;
    for (int32_t k = 0; k < p->rows; k++) longest = MAX(longest, p->span[k][1] - p->span[k][0] + 1);
    return MIN(longest, p->rows);
}

// Tiles whose narrower width is too few pixels stay as they are.
static void keep_narrow_tiles(const widths *w, jali_bitmap *damage)
{
    const tiling *t = &w->tiles;
    for (int32_t j = 0; j < t->rows; j++)
        for (int32_t i = 0; i < t->columns; i++) {
            int64_t tile = (int64_t)j * t->columns + i;
            if (shorter_side(patch_of_tile(&w->solid, tile)) >= LEAST_WIDTH_PX &&
                shorter_side(patch_of_tile(&w->hollow, tile)) >= LEAST_WIDTH_PX)
                continue;
            int32_t x1 = MIN((i + 1) * t->tile_px, t->width_px), y1 = MIN((j + 1) * t->tile_px, t->height_px);
            for (int32_t y = j * t->tile_px; y < y1; y++) paint_run(damage, y, i * t->tile_px, x1, true);
        }
}

jali_status jali_adapt_smooth(jali_context *ctx, const jali_adapt_options *opt, jali_bitmap *print)
{
    jali_status status;
    smoothing s = {0};
    TRY(printed_widths(ctx, opt, print, 0, &s.w));
    if (MIN(s.w.solid.most, s.w.hollow.most) < LEAST_WIDTH_PX) goto done;
    TRY(jali_bitmap_create(ctx, print->width_px, print->height_px, &s.smooth));
    TRY(jali_bitmap_create(ctx, print->width_px, print->height_px, &s.damage));
    TRY(jali_bitmap_create(ctx, print->width_px, print->height_px, &s.scratch));
    TRY(majority(ctx, print, opt->outside_solid, &s.scratch));
    TRY(majority(ctx, &s.scratch, opt->outside_solid, &s.smooth));
    TRY(find_damage(ctx, &s, opt->outside_solid));
    keep_narrow_tiles(&s.w, &s.damage);
    combine(ctx, RULE_AND, print, &s.damage, print);
    combine(ctx, RULE_AND_NOT, &s.smooth, &s.damage, &s.smooth);
    combine(ctx, RULE_OR, print, &s.smooth, print);
done:
    jali_bitmap_free(ctx, &s.smooth);
    jali_bitmap_free(ctx, &s.damage);
    jali_bitmap_free(ctx, &s.scratch);
    widths_free(ctx, &s.w);
    return status;
}
