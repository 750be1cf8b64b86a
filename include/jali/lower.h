// Lower bridges: what joins the picture's parts need not show at its front.
#ifndef JALI_LOWER_H
#define JALI_LOWER_H

#include <jali/optimise.h>
#include <jali/trace.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Where the solid that bridges added may be lower than the rest: the pixels of the bridges and the void
/// beside them, as far as it is nearer to them than to the picture's own solid, so that the border of the
/// region crosses the mask's outline at the bridges' ends alone.
///   in     result   with its bridge_mask (jali_optimise_options.mark_bridges)
///          around   the picture goes around (jali/around.h): regions are cut at the seam
///   out    low      as contours on the chart's lattice, closed, around the regions; they may cross the
///   mask's fails  JALI_BAD_VALUE (no bridge_mask), what jali_trace says
JALI_API jali_status jali_trace_bridges(jali_context *ctx, const jali_optimised *result,
                                        const jali_chart *chart, bool around, const jali_trace_options *opt,
                                        jali_contours *low);

#ifdef __cplusplus
}
#endif
#endif
