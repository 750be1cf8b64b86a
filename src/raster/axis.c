// The medial axis of a tone, by Lantuejoul's formula on 3 x 3 squares.
//
// Cost:  two 3 x 3 operations a round, as many rounds as half the widest feature has pixels.
#include "raster/raster.h"
#include "base/base.h"

jali_status medial_axis(jali_context *ctx, const jali_bitmap *a, bool white, bool outside, int32_t rounds,
                        jali_bitmap *axis)
{
    jali_status status;
    jali_bitmap left = {0}, next = {0}, opened = {0};
    element square = {0};
    *axis = (jali_bitmap){0};
    TRY(jali_bitmap_copy(ctx, a, &left));
    TRY(jali_bitmap_create(ctx, a->width_px, a->height_px, &next));
    TRY(jali_bitmap_create(ctx, a->width_px, a->height_px, &opened));
    TRY(jali_bitmap_create(ctx, a->width_px, a->height_px, axis));
    TRY(element_square(ctx, 3, &square));
    if (!white) invert(ctx, &left, &left);
    for (int32_t k = 0; (rounds == 0 || k < rounds) && any_white(ctx, &left); k++) {
        TRY(step(ctx, "medial axis", 0));
        TRY(erode(ctx, &left, &square, outside, &next));
        if (count_combined(ctx, RULE_XOR, &left, &next) == 0) break; // all of one tone: no boundary, no axis
        TRY(dilate(ctx, &next, &square, false, &opened));
        combine(ctx, RULE_AND_NOT, &left, &opened, &opened);
        combine(ctx, RULE_OR, axis, &opened, axis);
        jali_bitmap swap = left;
        left = next;
        next = swap;
    }
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, axis);
    jali_bitmap_free(ctx, &left);
    jali_bitmap_free(ctx, &next);
    jali_bitmap_free(ctx, &opened);
    element_free(ctx, &square);
    return status;
}
