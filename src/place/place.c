// Where the picture lies on a plate: the working grid, its lattice and its margin.
//
// Limits:  a pixel is at least 16 lattice units.
// Checked: tests/test_place.c.
#include <jali/place.h>
#include "place/grid.h"
#include "place/resample.h"

#include <math.h>

static const double lattice_units = 16777216; // 2^24: below it float32 holds every whole number
static const double tab_mm = 20;              // room for what stands beyond the frame, such as a hanging hole
enum { FEWEST_UNITS = 16 };

jali_place_options jali_place_defaults(void)
{
    return (jali_place_options){.width_mm = 70, .phi_e_mm = 0.1, .phi_s_mm = 0.3, .phi_v_mm = 0.5};
}

static double pixel_size(const jali_picture *picture, const jali_place_options *opt, double width_mm)
{
    if (opt->paper) return width_mm / picture->width_px;
    return opt->pixel_mm > 0 ? opt->pixel_mm : automatic_pixel(opt, 1);
}

// The smallest power of two at which the extent stays below 2^24 units.
static double finest_unit(double extent_mm)
{
    double unit_mm = 1;
    while (extent_mm >= unit_mm * lattice_units) unit_mm *= 2;
    while (extent_mm < unit_mm / 2 * lattice_units) unit_mm /= 2;
    return unit_mm;
}

static double round_to_even(double value)
{
    return 2 * floor(value / 2 + 0.5);
}

static jali_status choose_grid(jali_context *ctx, const jali_picture *picture, const jali_place_options *opt,
                               const double size_mm[2], jali_chart *chart)
{
    jali_status status;
    double pixel_mm = pixel_size(picture, opt, size_mm[0]);
    double margin = opt->frame_mm > 0 ? ceil(margin_mm(opt) / pixel_mm) + 2 : 0;
    double columns = opt->paper ? picture->width_px : MAX(floor(size_mm[0] / pixel_mm + 1e-9), 1);
    double rows = opt->paper ? picture->height_px
                             : MAX(floor(columns * picture->height_px / picture->width_px + 0.5), 1);
    TRY(check_grid(ctx, columns + 2 * margin, rows + 2 * margin, pixel_mm));
    double extent_mm = MAX(size_mm[0], size_mm[1]) + 2 * MAX(opt->frame_mm, (margin + 1) * pixel_mm) + tab_mm;
    double unit_mm = finest_unit(extent_mm);
    double units = round_to_even(size_mm[0] / (columns * unit_mm));
    if (units < FEWEST_UNITS)
        return fail(
            ctx, JALI_NO_RESULT,
            "a working pixel of %.3g mm is too fine for a plate of %.4g mm: %.3g mm or more is needed "
            "(--pixel)",
            pixel_mm, extent_mm, FEWEST_UNITS * unit_mm);
    *chart = (jali_chart){
        .width_px = (int32_t)(columns + 2 * margin),
        .height_px = (int32_t)(rows + 2 * margin),
        .margin_px = (int32_t)margin,
        .outside_solid = opt->frame_mm > 0,
        .pixel_units = (int32_t)units,
        .unit_mm = unit_mm,
    };
done:
    return status;
}

jali_status jali_place(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                       const jali_place_options *given, jali_chart *chart, jali_bitmap *drawing)
{
    jali_status status;
    jali_place_options opt = given ? *given : jali_place_defaults();
    double size_mm[2];
    *chart = (jali_chart){0};
    *drawing = (jali_bitmap){0};
    TRY(check_picture(ctx, picture, threshold, &opt));
    TRY(picture_size(ctx, picture, &opt, size_mm));
    TRY(choose_grid(ctx, picture, &opt, size_mm, chart));
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, drawing));
    TRY(resample(ctx, picture, threshold, chart->margin_px, drawing));
    whiten_margin(chart, drawing);
    return JALI_OK;
done:
    jali_bitmap_free(ctx, drawing);
    *chart = (jali_chart){0};
    return status;
}
