// The printer's widths as elements that fit together.
//
// A print painted with `printed` elements must survive as a mask under the `mask` ones: with G the growth,
//     printed solid = mask solid (+) G        a solid disc of the print, eroded by G, holds the mask's
//     mask void = printed void (+) G          a void disc of the print, widened by G, holds the mask's
// Separate digital discs of the right sizes do not do that: their corners differ, and half the details die.
#include "adapt/widths.h"
#include "base/base.h"

#include <math.h>

jali_adapt_options jali_adapt_defaults(void)
{
    return (jali_adapt_options){.shape = JALI_SHAPE_DISC,
                                .solid_px = 12,
                                .void_px = 20,
                                .epsilon_px = 40,
                                .isolated_matters = true,
                                .outside_solid = true,
                                .growth_px = 1,
                                .axis_worth_white = 0.22,
                                .axis_worth_black = 0.27};
}

static jali_status check_widths(jali_context *ctx, const jali_adapt_options *opt)
{
    if (opt->solid_px < 1 || opt->void_px < 1 || opt->solid_px > 4096 || opt->void_px > 4096)
        return fail(ctx, JALI_BAD_VALUE, "widths of %d px (solid) and %d px (void) are outside 1 .. 4096 px",
                    opt->solid_px, opt->void_px);
    if (opt->growth_px < 1 || opt->growth_px % 2 == 0)
        return fail(ctx, JALI_BAD_VALUE, "omega_c is %d px; an odd number from 1 on is accepted",
                    opt->growth_px);
    return JALI_OK;
}

// A void that the growth would close altogether is one pixel in the print.
static int32_t printed_void_px(const jali_adapt_options *opt)
{
    return MAX(opt->void_px - (opt->growth_px - 1), 1);
}

jali_status mask_elements(jali_context *ctx, const jali_adapt_options *opt, element *solid, element *hollow)
{
    jali_status status;
    element growth = {0}, printed = {0};
    *solid = *hollow = (element){0};
    TRY(check_widths(ctx, opt));
    if (opt->shape == JALI_SHAPE_SQUARE) {
        TRY(element_square(ctx, opt->solid_px, solid));
        TRY(element_square(ctx, opt->void_px, hollow));
    } else {
        TRY(element_wide_disc(ctx, opt->solid_px, solid));
        TRY(element_disc(ctx, opt->growth_px, &growth));
        TRY(element_disc(ctx, printed_void_px(opt), &printed));
        TRY(element_sum(ctx, &printed, &growth, hollow));
    }
done:
    element_free(ctx, &growth);
    element_free(ctx, &printed);
    if (status != JALI_OK) {
        element_free(ctx, solid);
        element_free(ctx, hollow);
    }
    return status;
}

jali_status printed_elements(jali_context *ctx, const jali_adapt_options *opt, element *solid,
                             element *hollow)
{
    jali_status status;
    element growth = {0}, mask = {0};
    *solid = *hollow = (element){0};
    TRY(check_widths(ctx, opt));
    TRY(element_wide_disc(ctx, opt->solid_px, &mask));
    TRY(element_disc(ctx, opt->growth_px, &growth));
    TRY(element_sum(ctx, &mask, &growth, solid));
    TRY(element_disc(ctx, printed_void_px(opt), hollow));
done:
    element_free(ctx, &growth);
    element_free(ctx, &mask);
    if (status != JALI_OK) {
        element_free(ctx, solid);
        element_free(ctx, hollow);
    }
    return status;
}

int64_t axis_worth_units(const jali_adapt_options *opt, bool white, const element *solid,
                         const element *hollow)
{
    double worth = white ? opt->axis_worth_white : opt->axis_worth_black;
    return (int64_t)floor(WRONG_UNITS * worth * MIN(solid->size, hollow->size) + 0.5);
}
