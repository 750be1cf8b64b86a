// What every placement needs: checked options, the picture's size, the working pixel, the margin.
//
// Limits:  2^20 px a side and 2^32 px in all on the working grid.
// Checked: tests/test_place.c.
#include "place/grid.h"

#include <math.h>

static const int32_t px_a_feature = 8; // and half of it where the surface is stretched most (docs/metric.md)
static const double largest_mm = 10000;
enum { MOST_SIDE_PX = 1 << 20 };
static const int64_t most_px = INT64_C(1) << 32;

static jali_status check_mm(jali_context *ctx, const char *what, double mm, bool may_be_zero)
{
    if (mm > 0 && mm <= largest_mm) return JALI_OK;
    if (mm == 0 && may_be_zero) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE, "%s must be %s .. %g mm, not %g", what, may_be_zero ? "0" : "above 0",
                largest_mm, mm);
}

static jali_status check_options(jali_context *ctx, const jali_place_options *opt)
{
    jali_status status;
    TRY(check_mm(ctx, "the picture's width", opt->width_mm, true));
    TRY(check_mm(ctx, "the picture's height", opt->height_mm, true));
    TRY(check_mm(ctx, "the working pixel", opt->pixel_mm, true));
    TRY(check_mm(ctx, "phi_e", fabs(opt->phi_e_mm), true));
    TRY(check_mm(ctx, "phi_s", opt->phi_s_mm, false));
    TRY(check_mm(ctx, "phi_v", opt->phi_v_mm, false));
    TRY(check_mm(ctx, "the frame", opt->frame_mm, true));
    if (opt->grid != 0 && (opt->grid < 2 || opt->grid > 64))
        TRY(fail(ctx, JALI_BAD_VALUE, "the pixels across the narrowest feature must be 2 .. 64, not %d",
                 opt->grid));
    if (opt->width_mm == 0 && opt->height_mm == 0)
        status = fail(ctx, JALI_BAD_VALUE, "the picture needs a width or a height in mm");
done:
    return status;
}

jali_status check_picture(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                          const jali_place_options *opt)
{
    if (picture->width_px < 1 || picture->height_px < 1)
        return fail(ctx, JALI_BAD_VALUE, "the picture has no pixels");
    if (threshold < 1 || threshold > 255)
        return fail(ctx, JALI_BAD_VALUE, "the threshold must be 1 .. 255, not %d", threshold);
    return check_options(ctx, opt);
}

// Both sizes in mm, from one of them or from two that agree.
jali_status picture_size(jali_context *ctx, const jali_picture *picture, const jali_place_options *opt,
                         double size_mm[2])
{
    double shape = (double)picture->height_px / picture->width_px;
    size_mm[0] = opt->width_mm > 0 ? opt->width_mm : opt->height_mm / shape;
    size_mm[1] = size_mm[0] * shape;
    if (opt->height_mm > 0 && fabs(size_mm[1] - opt->height_mm) > 0.01 * opt->height_mm)
        return fail(
            ctx, JALI_BAD_VALUE,
            "%g x %g mm do not have the shape of the picture (%d x %d px): %g mm wide makes it %.4g mm "
            "high; give one of the two",
            opt->width_mm, opt->height_mm, picture->width_px, picture->height_px, opt->width_mm, size_mm[1]);
    double largest_phi = MAX(opt->phi_s_mm, opt->phi_v_mm);
    if (MIN(size_mm[0], size_mm[1]) <= largest_phi)
        return fail(ctx, JALI_NO_RESULT,
                    "a picture of %.3g x %.3g mm is not larger than the narrowest feature that prints, %g "
                    "mm; make it "
                    "larger",
                    size_mm[0], size_mm[1], largest_phi);
    if (MAX(size_mm[0], size_mm[1]) > largest_mm)
        return fail(ctx, JALI_BAD_VALUE, "the picture would be %.4g x %.4g mm; at most %g mm are accepted",
                    size_mm[0], size_mm[1], largest_mm);
    return JALI_OK;
}

// The coarsest pixel of which the smaller width holds enough and the growth of an edge, phi_e / 2, a
// whole number: then the compensation is exact. A growth so small that this needs more than twice as many is
// rounded.
double automatic_pixel(const jali_place_options *opt, double most_stretch)
{
    double width_mm = MIN(opt->phi_s_mm, opt->phi_v_mm), growth_mm = fabs(opt->phi_e_mm) / 2;
    double across = opt->grid > 0 ? opt->grid : px_a_feature;
    double coarsest = width_mm / MAX(across, across / 2 * most_stretch);
    double fitting = growth_mm > 0 ? growth_mm / ceil(growth_mm / coarsest - 1e-9) : 0;
    return fitting >= coarsest / 2 ? fitting : coarsest;
}

// Morphology near the border reaches twice the wider element and what the compensation takes.
double margin_mm(const jali_place_options *opt)
{
    return opt->frame_mm > 0 ? 2 * MAX(opt->phi_s_mm, opt->phi_v_mm) + fabs(opt->phi_e_mm) : 0;
}

jali_status check_grid(jali_context *ctx, double columns, double rows, double pixel_mm)
{
    double side = MAX(columns, rows), most = (double)most_px;
    if (side > MOST_SIDE_PX || columns * rows > most)
        return fail(
            ctx, JALI_NO_RESULT,
            "a working pixel of %.3g mm makes a grid of %.0f x %.0f px; at most %d a side and %.0f in all "
            "are possible; make the pixel coarser (--pixel) or the picture smaller",
            pixel_mm, columns, rows, MOST_SIDE_PX, most);
    return JALI_OK;
}

static void set_run(uint64_t *row, int32_t first, int32_t end)
{
    for (int32_t x = first; x < end;) {
        int32_t count = MIN(64 - (x & 63), end - x);
        row[x >> 6] |= (~UINT64_C(0) >> (64 - count)) << (x & 63);
        x += count;
    }
}

void whiten_margin(const jali_chart *chart, jali_bitmap *drawing)
{
    int32_t margin = chart->margin_px, width = drawing->width_px, height = drawing->height_px;
    for (int32_t y = 0; y < height; y++) {
        uint64_t *row = drawing->word + (int64_t)y * drawing->stride;
        bool inside = y >= margin && y < height - margin;
        set_run(row, 0, inside ? margin : width);
        set_run(row, inside ? width - margin : width, width);
    }
}
