// Painting runs, elements and strokes.
#include "raster/raster.h"
#include "base/base.h"

#include <stdlib.h>

void paint_run(jali_bitmap *dst, int32_t y, int32_t x0, int32_t x1, bool white)
{
    uint64_t *row = dst->word + (int64_t)y * dst->stride;
    for (int32_t i = x0 >> 6; i <= (x1 - 1) >> 6; i++) {
        uint64_t mask = ~UINT64_C(0);
        if (i == x0 >> 6) mask &= ~UINT64_C(0) << (x0 & 63);
        if (i == (x1 - 1) >> 6) mask &= ~UINT64_C(0) >> (63 - ((x1 - 1) & 63));
        row[i] = white ? row[i] | mask : row[i] & ~mask;
    }
}

void paint_element(jali_bitmap *dst, int32_t x, int32_t y, const element *brush, bool white)
{
    int32_t even = brush->size % 2 == 0;
    for (int32_t k = 0; k < brush->size; k++) {
        int32_t dy = k - brush->size / 2;
        int32_t half = brush->half[abs(2 * dy + even) / 2];
        int32_t x0 = MAX(x - half, 0), x1 = MIN(x + half + 1 - even, dst->width_px);
        if (y + dy >= 0 && y + dy < dst->height_px && x0 < x1) paint_run(dst, y + dy, x0, x1, white);
    }
}

void paint_stroke(jali_bitmap *dst, const int32_t from[2], const int32_t to[2], const element *brush, bool white)
{
    int64_t dx = to[0] - from[0], dy = to[1] - from[1], count = MAX(llabs(dx), llabs(dy));
    paint_element(dst, from[0], from[1], brush, white);
    for (int64_t i = 1; i <= count; i++) {
        int64_t half_x = dx < 0 ? -count : count, half_y = dy < 0 ? -count : count; // round half away from `from`
        paint_element(dst, from[0] + (int32_t)((2 * i * dx + half_x) / (2 * count)),
                      from[1] + (int32_t)((2 * i * dy + half_y) / (2 * count)), brush, white);
    }
}
