// trace: from pixels to contours.
#ifndef JALI_TRACE_H
#define JALI_TRACE_H

#include <jali/base.h>
#include <jali/bitmap.h>
#include <jali/chart.h>
#include <jali/contours.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_trace_options {
    double deviation_mm; // how far the contour may leave the smooth curve it approximates; 0.01 (default), >
                         // 0; larger: fewer points
} jali_trace_options;

JALI_API jali_trace_options jali_trace_defaults(void);

/// Follow the boundary between solid and void: smooth, with its corners, in few points. Pixel centres keep
/// their side (rasterising the contours gives the bitmap back), no two contours touch, and no point lies half
/// a pixel or more from the pixels' own edges. Solid is 4-connected, void 8-connected.
///   in     solid     1 = solid; chart->outside_solid says what lies beyond
///          chart     width_px, height_px, pixel_units, unit_mm, outside_solid
///          opt       NULL means the defaults
///   out    contours  counter-clockwise around solid, clockwise around voids; in order of their topmost rows
///   fails  JALI_BAD_VALUE, JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
///   cost   O(words + boundary) time, O(boundary) memory
JALI_API jali_status jali_trace(jali_context *ctx, const jali_bitmap *solid, const jali_chart *chart,
                                const jali_trace_options *opt, jali_contours *contours);

#ifdef __cplusplus
}
#endif
#endif
