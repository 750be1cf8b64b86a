// The regions of low bridges.
//
// How:     bridges and the picture's own solid grow into the void side by side, a ring of pixels at a time,
// so
//          that they meet where they are equally far: the region leaves the outline at a slant, which makes
//          each of the two cut the other in one point rather than run along it.
// Checked: tests/test_lower.c.
#include <jali/around.h>
#include <jali/lower.h>

#include "base/base.h"
#include "raster/raster.h"

enum { RINGS = 6 };

// One more ring of pixels around a, where `taken` is not set.
static jali_status grow(jali_context *ctx, const element *ring, const jali_bitmap *taken, jali_bitmap *a)
{
    jali_status status;
    jali_bitmap more = {0};
    TRY(jali_bitmap_create(ctx, a->width_px, a->height_px, &more));
    TRY(dilate(ctx, a, ring, false, &more));
    combine(ctx, RULE_AND_NOT, &more, taken, &more);
    combine(ctx, RULE_OR, a, &more, a);
done:
    jali_bitmap_free(ctx, &more);
    return status;
}

// Specks that the finish filled in, less than half a disc of phi_s, are no bridges.
static jali_status drop_specks(jali_context *ctx, int32_t solid_px, jali_bitmap *bridge)
{
    jali_status status;
    components c = {0};
    int64_t *area = NULL, least = (int64_t)solid_px * solid_px * 2 / 5;
    TRY(label_components(ctx, bridge, true, 8, &c));
    TRY(component_areas(ctx, &c, &area));
    for (int32_t y = 0; y < c.height_px; y++)
        for (int32_t run = c.first[y]; run < c.first[y + 1]; run++)
            if (area[c.label[run]] < least) paint_run(bridge, y, c.span[run][0], c.span[run][1], false);
done:
    release(ctx, area);
    components_free(ctx, &c);
    return status;
}

jali_status jali_trace_bridges(jali_context *ctx, const jali_optimised *result, const jali_chart *chart,
                               bool around, const jali_trace_options *opt, jali_contours *low)
{
    jali_status status;
    element ring = {0};
    jali_bitmap bridge = {0}, own = {0};
    jali_chart alone = *chart;
    *low = (jali_contours){.unit_mm = chart->unit_mm};
    if (result->bridge_mask.width_px != result->mask.width_px)
        TRY(fail(ctx, JALI_BAD_VALUE, "which solid are bridges was not kept"));
    alone.outside_solid = false; // beyond the grid there are no bridges
    TRY(jali_bitmap_copy(ctx, &result->mask, &bridge));
    TRY(jali_bitmap_copy(ctx, &result->mask, &own));
    combine(ctx, RULE_AND, &bridge, &result->bridge_mask, &bridge);
    TRY(drop_specks(ctx, result->kernels_px[1], &bridge));
    combine(ctx, RULE_AND_NOT, &own, &bridge, &own);
    TRY(element_square(ctx, 3, &ring));
    for (int32_t i = 0; i < RINGS; i++) {
        TRY(grow(ctx, &ring, &own, &bridge));
        TRY(grow(ctx, &ring, &bridge, &own));
    }
    if (around) {
        invert(ctx, &bridge, &bridge); // the regions are what is traced around: voids
        TRY(jali_trace_around(ctx, &bridge, chart, opt, low));
    } else {
        TRY(jali_trace(ctx, &bridge, &alone, opt, low));
    }
done:
    element_free(ctx, &ring);
    jali_bitmap_free(ctx, &bridge);
    jali_bitmap_free(ctx, &own);
    if (status != JALI_OK) jali_contours_free(ctx, low);
    return status;
}
