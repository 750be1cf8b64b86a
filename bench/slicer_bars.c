// How wide a slicer lays bars that are drawn 0.05 to 1 mm wide, solid and void: what it adds and leaves out
// by itself. slicer --bars (docs/compare.md).
#include "slicer.h"
#include "prusa.h"

#include "base/base.h"
#include "raster/raster.h"

#include <math.h>
#include <stdio.h>

enum { BARS = 20, BAR_PX = 5, PITCH_PX = 200, BAR_LONG_PX = 800, MARGIN_PX = 100, BARS_PER_MM = 100 };

// Solid bars across a window, void bars in solid, 0.05 to 1 mm wide; a pixel is 0.01 mm.
static jali_status draw_bars(jali_context *ctx, bool white, jali_bitmap *a)
{
    jali_status status =
        jali_bitmap_create(ctx, BARS * PITCH_PX + 2 * MARGIN_PX, BAR_LONG_PX + 2 * MARGIN_PX, a);
    if (status != JALI_OK) return status;
    fill(ctx, a, true);
    for (int32_t y = MARGIN_PX; y < MARGIN_PX + BAR_LONG_PX; y++) {
        if (white) paint_run(a, y, MARGIN_PX, a->width_px - MARGIN_PX, false);
        for (int32_t i = 0; i < BARS; i++) {
            int32_t wide = BAR_PX * (i + 1), x = MARGIN_PX + PITCH_PX * i + (PITCH_PX - wide) / 2;
            paint_run(a, y, x, x + wide, white);
        }
    }
    return JALI_OK;
}

// How wide each bar came out: the mean over its middle half.
static void measure_bars(const jali_bitmap *printed, double pixel_mm, bool white, double wide_mm[BARS])
{
    double px = 0.01 / pixel_mm;
    for (int32_t i = 0; i < BARS; i++) {
        int64_t count = 0;
        int32_t x0 = (int32_t)lround((MARGIN_PX + PITCH_PX * i) * px),
                x1 = (int32_t)lround(x0 + PITCH_PX * px);
        int32_t y0 = (int32_t)lround((MARGIN_PX + BAR_LONG_PX / 4) * px),
                y1 = (int32_t)lround((MARGIN_PX + 3 * BAR_LONG_PX / 4) * px);
        for (int32_t y = y0; y < y1; y++)
            count += white ? count_run(printed, y, x0, x1) : x1 - x0 - count_run(printed, y, x0, x1);
        wide_mm[i] = (double)count / (y1 - y0) * pixel_mm;
    }
}

static bool bars_of(jali_context *ctx, const witness *w, prusa_process process, bool white,
                    double wide_mm[BARS])
{
    jali_status status;
    jali_bitmap bars = {0}, drawing = {0};
    jali_picture grey = {0};
    jali_chart chart = {0};
    jali_mesh mesh = {0};
    jali_reference reference = {0};
    jali_print print = {0};
    jali_comparison c = {0};
    double took;
    jali_place_options place = jali_place_defaults();
    TRY(draw_bars(ctx, white, &bars));
    place.width_mm = bars.width_px * 0.01;
    place.pixel_mm = 0.01;
    place.frame_mm = FRAME_MM;
    jali_compare_options compare = {{bars.width_px * 0.01, bars.height_px * 0.01}, FRAME_MM, 0.3};
    jali_predict_options predict = jali_predict_defaults();
    predict.picture_mm = compare.picture_mm[0];
    TRY(grey_of(ctx, &bars, 0, &grey));
    TRY(jali_place(ctx, &grey, 128, &place, &chart, &drawing));
    TRY(carve_mask(ctx, &drawing, &chart, &mesh));
    TRY(jali_reference_create(ctx, &bars, &predict, &reference));
    double pixel_mm = compare.picture_mm[0] / reference.picture.width_px;
    status = JALI_IO;
    if (!prusa_print(ctx, process, &mesh, 1, w->folder, pixel_mm, w->seconds, &print, &took)) goto done;
    TRY(jali_compare(ctx, &reference, &print, &compare, &c));
    measure_bars(&c.print.printed, pixel_mm, white, wide_mm);
done:
    tell(ctx, status);
    jali_bitmap_free(ctx, &bars);
    jali_bitmap_free(ctx, &drawing);
    jali_picture_free(ctx, &grey);
    jali_mesh_free(ctx, &mesh);
    jali_reference_free(ctx, &reference);
    jali_print_free(ctx, &print);
    jali_comparison_free(ctx, &c);
    return status == JALI_OK;
}

int run_bars(jali_context *ctx, const witness *w)
{
    double wide_mm[PRUSA_PROCESSES][2][BARS];
    printf("| drawn mm |");
    for (int p = 0; p < PRUSA_PROCESSES; p++) printf(" %s: solid | void |", prusa_name(p));
    printf("\n|---|---|---|---|---|---|---|\n");
    for (int p = 0; p < PRUSA_PROCESSES; p++)
        for (int white = 0; white < 2; white++)
            if (!bars_of(ctx, w, p, white, wide_mm[p][white])) return 1;
    for (int32_t i = 0; i < BARS; i++) {
        printf("| %.2f |", 0.05 * (i + 1));
        for (int p = 0; p < PRUSA_PROCESSES; p++)
            printf(" %.3f | %.3f |", wide_mm[p][1][i], wide_mm[p][0][i]);
        printf("\n");
    }
    return 0;
}
