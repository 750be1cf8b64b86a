// A picture once around a surface that closes: its left edge is beside its right one.
#ifndef JALI_AROUND_H
#define JALI_AROUND_H

#include <jali/optimise.h>
#include <jali/trace.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Optimise a drawing whose columns, without the margins left and right, go round in a circle of so many
/// equal parts. One part is optimised between its neighbours; what of it no longer fits across its own edge
/// is mended with that edge in the middle, until nothing changes wherever the circle is cut.
///   in     drawing   on the chart's working grid; one part is taken, the others are equal to it
///          parts     >= 1, divides the columns between the margins
///          opt       NULL means the defaults
///   out    result    mask: the parts side by side, and in the margins left and right what lies beyond.
///                    Bridges, pieces dropped and counts of details are those of one part and its neighbours'
///          pieces    of the solid on the closed strip, 4-connected
///   fails  as jali_optimise, and JALI_NO_RESULT (it does not come to rest)
///   cost   that of jali_optimise on two parts (three when there are several) and of three jali_optimise_mend
JALI_API jali_status jali_optimise_around(jali_context *ctx, const jali_bitmap *drawing,
                                          const jali_chart *chart, int32_t parts,
                                          const jali_optimise_options *opt, jali_optimised *result,
                                          int32_t *pieces);

/// Follow the boundary of a mask from jali_optimise_around, and cut what crosses the strip's edge there: with
/// edges along it on both sides, at the same heights.
///   in     mask, chart   as above
///   out    contours      clockwise around voids, closed; those that were cut share their edge with the
///   strip's fails  JALI_NO_RESULT (a void that winds around more than four times), what jali_trace says
JALI_API jali_status jali_trace_around(jali_context *ctx, const jali_bitmap *mask, const jali_chart *chart,
                                       const jali_trace_options *opt, jali_contours *contours);

#ifdef __cplusplus
}
#endif
#endif
