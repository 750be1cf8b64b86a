// Painting and counting runs; straight walks.
#include "raster/raster.h"
#include "base/base.h"

#include <stdlib.h>

void paint_run(jali_bitmap *dst, int32_t y, int32_t x0, int32_t x1, bool white)
{
    uint64_t *row = dst->word + (int64_t)y * dst->stride;
    for (int32_t i = x0 >> 6; i <= (x1 - 1) >> 6; i++) {
        uint64_t columns = columns_of_word(i, x0, x1);
        row[i] = white ? row[i] | columns : row[i] & ~columns;
    }
}

VECTORISED static int32_t count_bits(const uint64_t *row, int32_t x0, int32_t x1)
{
    int32_t first = x0 >> 6, last = (x1 - 1) >> 6, count = 0;
    uint64_t head = ~UINT64_C(0) << (x0 & 63), tail = ~UINT64_C(0) >> (63 - ((x1 - 1) & 63));
    if (first == last) return __builtin_popcountll(row[first] & head & tail);
    for (int32_t i = first + 1; i < last; i++) count += __builtin_popcountll(row[i]);
    return count + __builtin_popcountll(row[first] & head) + __builtin_popcountll(row[last] & tail);
}

int32_t count_run(const jali_bitmap *a, int32_t y, int32_t x0, int32_t x1)
{
    return count_bits(a->word + (int64_t)y * a->stride, x0, x1);
}

uint64_t window_word(const jali_bitmap *a, int32_t x, int32_t y, bool outside)
{
    uint64_t beyond = outside ? ~UINT64_C(0) : 0;
    if (y < 0 || y >= a->height_px || x < 0 || x >= a->width_px) return beyond;
    uint64_t word = a->word[(int64_t)y * a->stride + (x >> 6)];
    return a->width_px - x >= 64 ? word : word | (beyond & ~UINT64_C(0) << (a->width_px - x));
}

line_walk walk_line(const int32_t from[2], const int32_t to[2])
{
    return (line_walk){.x = from[0],
                       .y = from[1],
                       .step_x = to[0] < from[0] ? -1 : 1,
                       .step_y = to[1] < from[1] ? -1 : 1,
                       .wide = llabs((int64_t)to[0] - from[0]),
                       .high = llabs((int64_t)to[1] - from[1])};
}

bool walk_on(line_walk *w)
{
    if (w->gone_x == w->wide && w->gone_y == w->high) return false;
    // Of the two next pixels the one nearer to the line: compare (gone_x + 1/2) / wide with (gone_y + 1/2) /
    // high.
    if (w->gone_y == w->high ||
        (w->gone_x < w->wide && (2 * w->gone_x + 1) * w->high < (2 * w->gone_y + 1) * w->wide)) {
        w->x += w->step_x;
        w->gone_x++;
    } else {
        w->y += w->step_y;
        w->gone_y++;
    }
    return true;
}
