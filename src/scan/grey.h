// Pictures of grey levels with fractions: what scans and photographs of prints are worked on in. Internal.
//
// Coordinates are those of the picture as it came: x right, y down, pixel (i, j) covers i .. i+1, j .. j+1.
// A smaller copy keeps them; its pixels are just larger.
#ifndef SCAN_GREY_H
#define SCAN_GREY_H

#include "base/base.h"
#include <jali/bitmap.h>
#include <jali/read.h>

/// {0} is valid and empty. Row 0 is the top row.
typedef struct grey {
    int32_t width, height;
    double pixel; // side of a pixel in the coordinates
    float *level; // [height * width], usually 0 .. 1
} grey;

jali_status grey_create(jali_context *ctx, int32_t width, int32_t height, double pixel, grey *g);
void grey_free(jali_context *ctx, grey *g);

/// Levels 0 .. 1, each the mean of shrink x shrink pixels (fewer at the right and lower border).
jali_status grey_of_picture(jali_context *ctx, const jali_picture *picture, int32_t shrink, grey *g);
/// White is 1, black is 0.
jali_status grey_of_bitmap(jali_context *ctx, const jali_bitmap *bitmap, int32_t shrink, grey *g);

/// The level at a place, between the four nearest pixel centres; beyond the border the border's.
float grey_at(const grey *g, double x, double y);

/// Three means over windows, near to a Gaussian of that standard deviation; only what lies inside counts.
///   in     deviation_px   in pixels of g, >= 0
///   cost   O(pixels), any deviation
jali_status grey_blur(jali_context *ctx, grey *g, double deviation_px);

/// Take off the local mean and divide by the local spread: uneven light and contrast go. Where the picture is
/// flat (a spread well below the whole picture's) it comes out as nearly zero, not as noise.
///   in     deviation_px   of the neighbourhood, in pixels of g, > 0
jali_status grey_normalise(jali_context *ctx, grey *g, double deviation_px);

#endif
