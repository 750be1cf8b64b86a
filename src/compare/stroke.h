// Strokes with round ends: what a nozzle lays along a straight line. Internal to compare.
#ifndef COMPARE_STROKE_H
#define COMPARE_STROKE_H

#include <jali/bitmap.h>

/// Whiten the pixels whose centres lie within width_px / 2 of the straight line between two points.
///   in     from, to   in pixels, x right, y down; pixel (i, j) covers i .. i+1, j .. j+1
void draw_stroke(jali_bitmap *bitmap, const double from[2], const double to[2], double width_px);

#endif
