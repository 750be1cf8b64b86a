// Compensation filtering: an erosion of the solid, by what the printer adds; where it takes away, as a
// laser's kerf does, a dilation.
//
// Source:  Binary Image Carving for 3D Printing, section 4.2, Eq. 1.
#include <jali/compensate.h>
#include "raster/field.h"
#include "base/base.h"

#include <stdlib.h>

jali_status jali_compensate(jali_context *ctx, const jali_bitmap *picture, const jali_compensate_options *opt,
                            jali_bitmap *thinned)
{
    jali_status status;
    tiling tiles = {0};
    element square = {0};
    field e = {0};
    *thinned = (jali_bitmap){0};
    if (opt->size_px < -4095 || opt->size_px > 4096 || opt->size_px % 2 == 0)
        return fail(ctx, JALI_BAD_VALUE, "omega_c is %d px; an odd number from -4095 to 4095 is accepted",
                    opt->size_px);
    int32_t added_px = abs(opt->size_px - 1);
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, thinned));
    if (opt->shape == JALI_SHAPE_SQUARE) {
        TRY(element_square(ctx, added_px + 1, &square));
        TRY(field_of_element(ctx, &square, &e));
    } else {
        TRY(tiling_create(ctx, opt->chart, picture->width_px, picture->height_px, 0, 0, 1, &tiles));
        TRY(field_of_discs(ctx, &tiles, added_px, 0.5, true, false,
                           &e)); // half a pixel is the pixel's own
    }
    TRY(opt->size_px < 1 ? field_dilate(ctx, picture, &e, opt->outside_solid, thinned)
                         : field_erode(ctx, picture, &e, opt->outside_solid, thinned));
done:
    field_free(ctx, &e);
    tiling_free(ctx, &tiles);
    element_free(ctx, &square);
    if (status != JALI_OK) jali_bitmap_free(ctx, thinned);
    return status;
}
