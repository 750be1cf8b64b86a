// Compensation filtering: an erosion of the solid.
//
// Source:  Binary Image Carving for 3D Printing, section 4.2, Eq. 1.
#include <jali/compensate.h>
#include "raster/raster.h"
#include "base/base.h"

jali_status jali_compensate(jali_context *ctx, const jali_bitmap *picture, const jali_compensate_options *opt,
                            jali_bitmap *thinned)
{
    jali_status status;
    element e = {0};
    *thinned = (jali_bitmap){0};
    if (opt->size_px < 1 || opt->size_px % 2 == 0)
        return fail(ctx, JALI_BAD_VALUE, "omega_c is %d px; an odd number from 1 on is accepted",
                    opt->size_px);
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, thinned));
    TRY(opt->shape == JALI_SHAPE_SQUARE ? element_square(ctx, opt->size_px, &e)
                                        : element_disc(ctx, opt->size_px, &e));
    TRY(erode(ctx, picture, &e, opt->outside_solid, thinned));
done:
    element_free(ctx, &e);
    if (status != JALI_OK) jali_bitmap_free(ctx, thinned);
    return status;
}
