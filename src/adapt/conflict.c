// Conflicts between details of the two tones, and one round of treatment.
//
// Source:  Binary Image Carving for 3D Printing, section 4.4, Eqs. 4 and 5, Algorithm 3 lines 5 to 7.
// Differs: the neighbourhood "within omega" is a window omega wide: with omega to each side 34 of 74 runs
// over
//          real pictures go round in circles, with the window none of 32 did. Ties go to white, not to
//          chance.
// Checked: tests/test_adapt.c.
#include <jali/adapt.h>
#include "raster/field.h"
#include "base/base.h"

// The details that are treated: types A and B.
static void treated(jali_context *ctx, const jali_details *details, jali_bitmap *mask)
{
    combine(ctx, RULE_OR, &details->type[JALI_TYPE_A], &details->type[JALI_TYPE_B], mask);
}

// hits = the pixels of `details` with a pixel of `others` in a window of `size` px around them, added to
// conflict.
static jali_status add_conflicts(jali_context *ctx, const jali_bitmap *details, const jali_bitmap *others,
                                 int32_t size, const jali_adapt_options *opt, jali_bitmap *scratch,
                                 jali_bitmap *conflict)
{
    jali_status status;
    tiling tiles = {0};
    element square = {0};
    field window = {0};
    int32_t odd = size | 1; // the window is centred on a pixel
    if (opt->shape == JALI_SHAPE_SQUARE) {
        TRY(element_square(ctx, odd, &square));
        TRY(field_of_element(ctx, &square, &window));
    } else {
        TRY(tiling_create(ctx, opt->chart, details->width_px, details->height_px, 0, 0, 1, &tiles));
        TRY(field_of_discs(ctx, &tiles, odd - 1, 0.5, true, false, &window));
    }
    TRY(field_dilate(ctx, others, &window, false, scratch));
    combine(ctx, RULE_AND, details, scratch, scratch);
    combine(ctx, RULE_OR, conflict, scratch, conflict);
done:
    field_free(ctx, &window);
    tiling_free(ctx, &tiles);
    element_free(ctx, &square);
    return status;
}

jali_status jali_adapt_conflicts(jali_context *ctx, const jali_details *white, const jali_details *black,
                                 const jali_adapt_options *opt, jali_bitmap *conflict, int32_t *regions)
{
    jali_status status;
    jali_bitmap w = {0}, b = {0}, scratch = {0};
    components c = {0};
    int32_t width = white->type[0].width_px, height = white->type[0].height_px;
    *conflict = (jali_bitmap){0};
    TRY(jali_bitmap_create(ctx, width, height, conflict));
    TRY(jali_bitmap_create(ctx, width, height, &w));
    TRY(jali_bitmap_create(ctx, width, height, &b));
    TRY(jali_bitmap_create(ctx, width, height, &scratch));
    treated(ctx, white, &w);
    treated(ctx, black, &b);
    TRY(add_conflicts(ctx, &w, &b, opt->solid_px, opt, &scratch, conflict));
    TRY(add_conflicts(ctx, &b, &w, opt->void_px, opt, &scratch, conflict));
    TRY(label_components(ctx, conflict, true, 8, &c));
    *regions = c.count;
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, conflict);
    jali_bitmap_free(ctx, &w);
    jali_bitmap_free(ctx, &b);
    jali_bitmap_free(ctx, &scratch);
    components_free(ctx, &c);
    return status;
}

// Eq. 5: each region becomes the tone that most of its pixels have.
static jali_status settle_conflicts(jali_context *ctx, const jali_bitmap *conflict, jali_bitmap *picture)
{
    jali_status status;
    components c = {0};
    int64_t *area = NULL, *white_area = NULL;
    TRY(label_components(ctx, conflict, true, 8, &c));
    TRY(component_areas(ctx, &c, &area));
    TRY(ALLOCATE_CLEARED(ctx, white_area, c.count));
    for (int32_t y = 0; y < c.height_px; y++)
        for (int32_t i = c.first[y]; i < c.first[y + 1]; i++)
            white_area[c.label[i]] += count_run(picture, y, c.span[i][0], c.span[i][1]);
    for (int32_t y = 0; y < c.height_px; y++)
        for (int32_t i = c.first[y]; i < c.first[y + 1]; i++)
            paint_run(picture, y, c.span[i][0], c.span[i][1], 2 * white_area[c.label[i]] >= area[c.label[i]]);
done:
    components_free(ctx, &c);
    release(ctx, area);
    release(ctx, white_area);
    return status;
}

// Details outside conflicts grow by 3 x 3.
static jali_status grow_details(jali_context *ctx, const jali_details *details, const jali_bitmap *conflict,
                                bool white, jali_bitmap *picture)
{
    jali_status status;
    jali_bitmap mask = {0}, grown = {0};
    element square = {0};
    TRY(element_square(ctx, 3, &square));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &mask));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &grown));
    treated(ctx, details, &mask);
    combine(ctx, RULE_AND_NOT, &mask, conflict, &mask);
    TRY(dilate(ctx, &mask, &square, false, &grown));
    combine(ctx, white ? RULE_OR : RULE_AND_NOT, picture, &grown, picture);
done:
    jali_bitmap_free(ctx, &mask);
    jali_bitmap_free(ctx, &grown);
    element_free(ctx, &square);
    return status;
}

jali_status jali_adapt_round(jali_context *ctx, const jali_details *white, const jali_details *black,
                             const jali_bitmap *conflict, jali_bitmap *picture)
{
    jali_status status;
    TRY(settle_conflicts(ctx, conflict, picture));
    TRY(grow_details(ctx, white, conflict, true, picture));
    TRY(grow_details(ctx, black, conflict, false, picture));
done:
    return status;
}
