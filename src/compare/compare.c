// A print laid on the picture it came from, and measured.
//
//     plate from the picture -> which way up, on small copies -> to the pixel, on the fine grid -> measure
//
// Checked: tests/test_compare.c.
#include <jali/compare.h>
#include "compare/lay.h"
#include "compare/plate.h"
#include "raster/raster.h"

#include <math.h>

// Two pictures that have only their frames in common reach about 0.2.
static const double LEAST_AGREEMENT = 0.3;
enum {
    SMALL_PX = 200, // longer side of the small copies
    ROW_STEP = 7    // no power of two: a picture pixel is that many rows, all alike
};

// A copy on square pixels of pixel_mm, with room for all of it.
static jali_status small_copy(jali_context *ctx, const jali_bitmap *a, const double a_pixel_mm[2],
                              double pixel_mm, jali_bitmap *small)
{
    jali_bitmap size = {0};
    plate_grid grid = {&size, {pixel_mm, pixel_mm}};
    laying l = {a, {a_pixel_mm[0], a_pixel_mm[1]}, {0, 0}, 1};
    size.width_px = 2 * (int32_t)ceil(a->width_px * a_pixel_mm[0] / pixel_mm / 2);
    size.height_px = 2 * (int32_t)ceil(a->height_px * a_pixel_mm[1] / pixel_mm / 2);
    return sample_print(ctx, &grid, &l, small);
}

// Which way up, and nearly where: every way on small copies; an upright print wins a tie.
static jali_status find_way_up(jali_context *ctx, const plate_grid *plate, const jali_print *print,
                               double pixel_mm, jali_comparison *c)
{
    jali_status status;
    jali_bitmap small_plate = {0}, small_print = {0}, turned = {0};
    double best = -2;
    TRY(small_copy(ctx, plate->bitmap, plate->pixel_mm, pixel_mm, &small_plate));
    TRY(small_copy(ctx, &print->solid, print->pixel_mm, pixel_mm, &small_print));
    plate_grid grid = {&small_plate, {pixel_mm, pixel_mm}};
    for (int32_t way = 0; way < 8; way++) {
        double agreement;
        laying l = {&turned, {pixel_mm, pixel_mm}, {0, 0}, 1};
        TRY(turn_bitmap(ctx, &small_print, way % 4, way >= 4, &turned));
        TRY(shift_print(ctx, &grid, 16 * pixel_mm, pixel_mm, &l, &agreement));
        jali_bitmap_free(ctx, &turned);
        if (agreement <= best + 1e-6) continue;
        best = agreement;
        c->quarter_turns = way % 4;
        c->mirrored = way >= 4;
        for (int k = 0; k < 2; k++) // whole pixels of the plate: none stays none
            c->shift_mm[k] = round(l.shift_mm[k] / plate->pixel_mm[k]) * plate->pixel_mm[k];
    }
done:
    jali_bitmap_free(ctx, &small_plate);
    jali_bitmap_free(ctx, &small_print);
    jali_bitmap_free(ctx, &turned);
    return status;
}

static jali_status check_fit(jali_context *ctx, const jali_print *print, const jali_compare_options *opt,
                             double agreement)
{
    if (agreement >= LEAST_AGREEMENT) return JALI_OK;
    return fail(
        ctx, JALI_NO_RESULT,
        "the print does not fit the picture: it is %.1f x %.1f mm large, the plate %.1f x %.1f mm, and they "
        "agree by %.2f of 1 at best; is it the same picture at the same size and frame?",
        print->size_mm[0], print->size_mm[1], opt->picture_mm[0] + 2 * opt->frame_mm,
        opt->picture_mm[1] + 2 * opt->frame_mm, agreement);
}

jali_status jali_compare(jali_context *ctx, const jali_reference *reference, const jali_print *print,
                         const jali_compare_options *opt, jali_comparison *c)
{
    jali_status status;
    jali_bitmap plate = {0}, turned = {0};
    plate_frame frame;
    *c = (jali_comparison){0};
    if (!print->solid.word || !(print->pixel_mm[0] > 0 && print->pixel_mm[1] > 0))
        TRY(fail(ctx, JALI_BAD_VALUE, "a comparison needs a print"));
    TRY(draw_wanted(ctx, reference, opt, &frame, &plate));
    plate_grid grid = {&plate, {frame.pixel_mm[0], frame.pixel_mm[1]}};
    double small_mm = MAX(plate.width_px * grid.pixel_mm[0], plate.height_px * grid.pixel_mm[1]) / SMALL_PX;
    small_mm = fmax(small_mm, MAX(print->solid.width_px * print->pixel_mm[0],
                                  print->solid.height_px * print->pixel_mm[1]) /
                                  (4 * SMALL_PX)); // far too large
    TRY(find_way_up(ctx, &grid, print, small_mm, c));
    const int across = c->quarter_turns % 2;
    laying l = {&print->solid,
                {print->pixel_mm[across], print->pixel_mm[1 - across]},
                {c->shift_mm[0], c->shift_mm[1]},
                1};
    // Grown edges agree as well a little to either side: only a look at every row sees that, and stays.
    // Unequal pixels are slower to look at, and larger than what matters here.
    if (fabs(l.pixel_mm[0] - grid.pixel_mm[0]) > 1e-3 * grid.pixel_mm[0]) l.row_step = ROW_STEP;
    if (c->quarter_turns != 0 || c->mirrored) {
        TRY(turn_bitmap(ctx, &print->solid, c->quarter_turns, c->mirrored, &turned));
        l.print = &turned;
    }
    // Halves of this end at a pixel.
    double first_mm = grid.pixel_mm[0] * exp2(ceil(log2(fmax(small_mm / grid.pixel_mm[0], 1))));
    TRY(shift_print(ctx, &grid, first_mm, grid.pixel_mm[0], &l, &c->agreement));
    l.row_step = 1;
    TRY(agreement_of(ctx, &grid, &l, &c->agreement));
    TRY(check_fit(ctx, print, opt, c->agreement));
    memcpy(c->shift_mm, l.shift_mm, sizeof c->shift_mm);
    TRY(sample_print(ctx, &grid, &l, &c->plate));
    TRY(measure_plate(ctx, reference, opt, &frame, c));
done:
    if (status != JALI_OK) jali_comparison_free(ctx, c);
    jali_bitmap_free(ctx, &plate);
    jali_bitmap_free(ctx, &turned);
    return status;
}
