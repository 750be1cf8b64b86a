// From contours back to pixels: each edge toggles, in every row of centres it crosses, the first pixel to its
// right; a running parity along the row then fills it.
//
// Checked: tests/test_trace.c: rasterise(trace(b)) == b; tests of the fill rule there.
#include "plane/rasterise.h"

static int64_t floor_divide(int64_t a, int64_t b)
{
    int64_t quotient = a / b;
    return quotient - (a % b != 0 && (a < 0) != (b < 0));
}

// Rows are counted upwards here: row r has its centres at (2 r + 1) * half units.
static void toggle_edge(const int32_t from[2], const int32_t to[2], int64_t half, jali_bitmap *bitmap)
{
    if (from[1] == to[1]) return;
    const int32_t *low = from[1] < to[1] ? from : to, *high = from[1] < to[1] ? to : from;
    // Rows with low <= centre < high.
    int64_t first = floor_divide(low[1] - half + 2 * half - 1, 2 * half);
    int64_t last = floor_divide(high[1] - half - 1, 2 * half);
    first = MAX(first, 0);
    last = MIN(last, bitmap->height_px - 1);
    int64_t dx = high[0] - low[0], dy = high[1] - low[1];
    for (int64_t r = first; r <= last; r++) {
        // Column c is right of the edge when its centre (2 c + 1) * half > crossing = low.x + along * dx /
        // dy.
        int64_t along = (2 * r + 1) * half - low[1];
        int64_t column = floor_divide((low[0] - half) * dy + along * dx, 2 * half * dy) + 1;
        if (column >= bitmap->width_px) continue;
        column = MAX(column, 0);
        bitmap->word[(bitmap->height_px - 1 - r) * bitmap->stride + (column >> 6)] ^= (uint64_t)1
                                                                                      << (column & 63);
    }
}

static void fill_row(uint64_t *row, int32_t width_px, bool inside)
{
    for (int32_t w = 0; 64 * w < width_px; w++) {
        uint64_t bits = row[w];
        for (int shift = 1; shift < 64; shift <<= 1) bits ^= bits << shift;
        if (inside) bits = ~bits;
        inside = bits >> 63;
        int32_t used = width_px - 64 * w;
        row[w] = used < 64 ? bits & ((UINT64_C(1) << used) - 1) : bits;
    }
}

jali_status rasterise(jali_context *ctx, const jali_contours *contours, const jali_chart *chart,
                      jali_bitmap *bitmap)
{
    jali_status status = jali_bitmap_create(ctx, chart->width_px, chart->height_px, bitmap);
    if (status != JALI_OK) return status;
    for (int32_t c = 0; c < contours->contour_count; c++) {
        int32_t first = contours->first[c], end = contours->first[c + 1];
        for (int32_t i = first, before = end - 1; i < end; before = i++)
            toggle_edge(contours->point[before], contours->point[i], chart->pixel_units / 2, bitmap);
    }
    for (int32_t y = 0; y < bitmap->height_px; y++)
        fill_row(bitmap->word + y * bitmap->stride, bitmap->width_px, chart->outside_solid);
    return JALI_OK;
}
