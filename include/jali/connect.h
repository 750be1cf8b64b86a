// Connect: join all solid parts into one by the fewest pixels.
#ifndef JALI_CONNECT_H
#define JALI_CONNECT_H

#include <jali/bitmap.h>
#include <jali/bridges.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_metric {
    JALI_METRIC_CITY_BLOCK, // fewest pixels of a 4-connected path: the paper's
    JALI_METRIC_OCTAGON     // nearly Euclidean: bridges are short in mm whatever their direction
} jali_metric;

typedef struct jali_connect_options {
    jali_metric metric;         // default city block
    const jali_bitmap *blocked; // black pixels where no bridge may run: it bends around them, and what no way
                                // leads to stays apart. NULL (default): none
} jali_connect_options;

JALI_API jali_connect_options jali_connect_defaults(void);

/// Join the smallest white component to its nearest neighbour until one is left (Algorithm 2).
///
/// The order is exactly the greedy one: a laid path belongs to its component and can shorten later joins.
/// Ties: the component whose first pixel comes first in raster order; the target pixel, then the source
/// pixel, that comes first in raster order.
///   in     drawing   1 = solid, 4-connected
///   out    joined    may be drawing; one component (or none, when drawing has none), and with `blocked` as
///                    many more as bridges->stranded says
///          bridges   NULL when not wanted
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   a component is the smallest of a pair at most log2(pixels) times, so the searches together look
///   at
///          O(area log area) pixels, 64 at a time; a way around what is blocked is looked for pixel by pixel
JALI_API jali_status jali_connect(jali_context *ctx, const jali_bitmap *drawing,
                                  const jali_connect_options *opt, jali_bitmap *joined,
                                  jali_bridges *bridges);

#ifdef __cplusplus
}
#endif
#endif
