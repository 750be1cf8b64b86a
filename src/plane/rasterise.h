// From contours back to pixels.
#ifndef PLANE_RASTERISE_H
#define PLANE_RASTERISE_H

#include "base/base.h"
#include <jali/bitmap.h>
#include <jali/chart.h>
#include <jali/contours.h>

/// The pixels whose centres lie inside: exact, by parity, beginning from what lies outside the chart. A
/// centre on a contour belongs to the side on its left (smaller x).
///   in     contours   in the frame of the chart
///   out    bitmap     chart->width_px x chart->height_px
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(words + rows crossed by edges)
jali_status rasterise(jali_context *ctx, const jali_contours *contours, const jali_chart *chart,
                      jali_bitmap *bitmap);

#endif
