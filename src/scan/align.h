// Where a flat thing lies in a scan of it. Internal.
#ifndef SCAN_ALIGN_H
#define SCAN_ALIGN_H

#include "scan/grey.h"
#include "scan/homography.h"

/// How a picture of what should be there lies in a scan. Both in their own pixels as they came.
typedef struct alignment {
    homography map;   // from the reference to the scan
    bool negative;    // the scan is dark where the reference is white
    double agreement; // correlation of the two with light and contrast evened out: 1 = the same, 0 = nothing
} alignment;

/// Make a map better, from coarse copies to fine ones: the eight ratios that bring the evened scan nearest to
/// the evened reference, places that do not fit at all counting less.
///   in     reference   white where solid; with a margin of what lies around it, so that its outline counts
///          finest_px   longer side of the finest copy of the reference; 800 settles to about a tenth of
///                      its pixel
///   inout  a           the map to begin with, off by a twentieth of the reference at most; negative as it is
///   fails  JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   a second and a half for 800 px on one thread
jali_status align(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                  int32_t finest_px, alignment *a);

/// Find the reference in a scan: any size, turn and tilt, seen from either side, light or dark.
///   in     reference   with a margin, as for align
///   out    a           its agreement says whether it is there at all: below about 0.5 it is not
///   fails  as align
jali_status find_in_scan(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                         int32_t finest_px, alignment *a);

/// The scan as it lies on the reference.
///   in     shrink   pixels of the reference a pixel of the result
///   out    out      as large as the reference shrunk; NAN where the scan does not reach
jali_status straighten(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                       const homography *map, int32_t shrink, grey *out);

/// Make of a straightened scan the share of solid: 0 in voids, 1 in solid, in between at edges. The levels of
/// both tones are those that fit a neighbourhood best, so uneven light and either polarity are accounted for;
/// what was printed otherwise than drawn counts less the second time.
///   in     drawn          the reference, in the same pixels
///          deviation_px   of the neighbourhood, in pixels of the scan; several times the widest feature
///   inout  straight       NAN stays
jali_status share_of_solid(jali_context *ctx, const grey *drawn, double deviation_px, grey *straight);

#endif
