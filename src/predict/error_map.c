// The error map: what of a picture is missing in a print, and what is too much.
//
// Source:  Binary Image Carving for 3D Printing, Figs. 6 and 11: red is missing, yellow is excess.
#include <jali/png.h>
#include <jali/predict.h>
#include "base/base.h"

// As wanted and printed: void and solid. The same two tones as in the other maps of a report.
static const uint8_t right_colour[2][3] = {{38, 40, 46}, {238, 234, 224}};
static const uint8_t missing_colour[3] = {214, 48, 40}, excess_colour[3] = {250, 204, 40};

static const uint8_t *colour_at(const jali_bitmap *wanted, const jali_bitmap *printed, int32_t x, int32_t y)
{
    int32_t u = (int32_t)((int64_t)x * wanted->width_px / printed->width_px),
            v = (int32_t)((int64_t)y * wanted->height_px / printed->height_px);
    bool want = jali_bitmap_get(wanted, u, v), have = jali_bitmap_get(printed, x, y);
    return want == have ? right_colour[want] : want ? missing_colour : excess_colour;
}

// The mean colour of a block, so that no thin line vanishes.
static void mean_of_block(const jali_bitmap *wanted, const jali_bitmap *printed, int32_t left, int32_t top,
                          int32_t side, uint8_t mean[3])
{
    int32_t sum[3] = {0}, count = 0;
    for (int32_t y = top; y < MIN(top + side, printed->height_px); y++)
        for (int32_t x = left; x < MIN(left + side, printed->width_px); x++, count++) {
            const uint8_t *colour = colour_at(wanted, printed, x, y);
            for (int32_t k = 0; k < 3; k++) sum[k] += colour[k];
        }
    for (int32_t k = 0; k < 3; k++) mean[k] = (uint8_t)(sum[k] / count);
}

jali_status jali_error_map(jali_context *ctx, const jali_bitmap *wanted, const jali_bitmap *printed,
                           int32_t most_px, jali_bytes *png)
{
    jali_status status;
    uint8_t *rgb = NULL;
    if (wanted->width_px < 1 || wanted->height_px < 1 || printed->width_px < 1 || printed->height_px < 1 ||
        most_px < 1)
        return fail(ctx, JALI_BAD_VALUE, "an error map needs a picture, a print and room of at least 1 px");
    int32_t side = (MAX(printed->width_px, printed->height_px) - 1) / most_px + 1;
    int32_t columns = (printed->width_px - 1) / side + 1, rows = (printed->height_px - 1) / side + 1;
    TRY(ALLOCATE(ctx, rgb, (size_t)columns * (size_t)rows * 3));
    for (int32_t row = 0; row < rows; row++) {
        TRY(step(ctx, "error map", (double)row / rows));
        for (int32_t column = 0; column < columns; column++)
            mean_of_block(wanted, printed, column * side, row * side, side,
                          rgb + 3 * ((size_t)row * (size_t)columns + (size_t)column));
    }
    TRY(jali_rgb_png(ctx, columns, rows, rgb, png));
done:
    release(ctx, rgb);
    return status;
}
