// Strokes with round ends, row by row.
//
// A stroke is convex: in each row it is one interval, the hull of those of its two end discs and of the
// rectangle between them.
//
// Checked: tests/test_gcode.c: every pixel against its distance from the line.
#include "compare/stroke.h"
#include "raster/raster.h"
#include "base/base.h"

#include <math.h>

typedef struct interval {
    double low, high; // empty when low > high
} interval;

static const interval nothing = {INFINITY, -INFINITY};

static interval hull(interval a, interval b)
{
    return (interval){fmin(a.low, b.low), fmax(a.high, b.high)};
}

// The x with low <= slope x + offset <= high.
static interval between(double slope, double offset, double low, double high)
{
    if (slope == 0) return offset >= low && offset <= high ? (interval){-INFINITY, INFINITY} : nothing;
    double a = (low - offset) / slope, b = (high - offset) / slope;
    return (interval){fmin(a, b), fmax(a, b)};
}

static interval disc_row(const double centre[2], double radius, double y)
{
    double square = radius * radius - (y - centre[1]) * (y - centre[1]);
    if (square < 0) return nothing;
    return (interval){centre[0] - sqrt(square), centre[0] + sqrt(square)};
}

// x' = along x + ..: the place along the line, and beside it.
static interval rectangle_row(const double from[2], const double unit[2], double length, double radius,
                              double y)
{
    double dy = y - from[1];
    interval along = between(unit[0], dy * unit[1] - from[0] * unit[0], 0, length);
    interval beside = between(-unit[1], dy * unit[0] + from[0] * unit[1], -radius, radius);
    interval both = {fmax(along.low, beside.low), fmin(along.high, beside.high)};
    return both.low <= both.high ? both : nothing;
}

// The first column or row whose centre is at or beyond x, held within the bitmap.
static int32_t first_centre(double x, int32_t most)
{
    double first = ceil(x - 0.5);
    return first <= 0 ? 0 : first >= most ? most : (int32_t)first;
}

void draw_stroke(jali_bitmap *bitmap, const double from[2], const double to[2], double width_px)
{
    double radius = width_px / 2, length = hypot(to[0] - from[0], to[1] - from[1]);
    double unit[2] = {1, 0};
    if (length > 0)
        for (int k = 0; k < 2; k++) unit[k] = (to[k] - from[k]) / length;
    int32_t y0 = first_centre(fmin(from[1], to[1]) - radius, bitmap->height_px);
    int32_t y1 = first_centre(fmax(from[1], to[1]) + radius, bitmap->height_px);
    for (int32_t row = y0; row < y1; row++) {
        double y = row + 0.5;
        interval x = hull(disc_row(from, radius, y), disc_row(to, radius, y));
        x = hull(x, rectangle_row(from, unit, length, radius, y));
        if (x.low > x.high) continue;
        int32_t x0 = first_centre(x.low, bitmap->width_px), x1 = first_centre(x.high, bitmap->width_px);
        if (x0 < x1) paint_run(bitmap, row, x0, x1, true);
    }
}
