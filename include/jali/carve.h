// carve: from contours to a closed solid.
#ifndef JALI_CARVE_H
#define JALI_CARVE_H

#include <jali/base.h>
#include <jali/chart.h>
#include <jali/contours.h>
#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_carve_options {
    double thickness_mm;     // of the plate, along z; 4 (default), > 0
    double frame_mm;         // solid frame around the picture; 0 (default) = none, larger: a wider frame
    double corner_radius_mm; // of the plate's corners; 0 (default) = sharp, up to half its shorter side
    double hole_diameter_mm; // a hole to hang the plate by, at the middle of its top; 0 (default) = none. In
                             // the frame when it is wide enough, else in a rounded ear above it
    double hole_web_mm;      // least solid around the hole; 2 (default), > 0
} jali_carve_options;

JALI_API jali_carve_options jali_carve_defaults(void);

/// The contours of a plate: those of the picture with the plate's outline and the hanging hole. A picture
/// that ends in void (chart->outside_solid false) is its own outline and can have neither frame nor hole.
///   in     picture   from jali_trace with the same chart
///          opt       NULL means the defaults; thickness_mm plays no part
///   out    plate     outline and hole first, then the picture's; same orientation rules
///   fails  JALI_BAD_VALUE, JALI_NO_RESULT (no room for the hole), JALI_LIMIT, JALI_NO_MEMORY
///   cost   O(points)
JALI_API jali_status jali_plate(jali_context *ctx, const jali_contours *picture, const jali_chart *chart,
                                const jali_carve_options *opt, jali_contours *plate);

/// Carve a plate: the solid between z = 0 and the thickness inside jali_plate's contours. Closed, 2-manifold
/// at edges and vertices, outward, vertices shared; coordinates are lattice points times unit_mm.
///   in     picture   as for jali_plate; checked: contours may not touch, cross or run the wrong way
///          opt       NULL means the defaults
///   out    mesh      the lower left corner of the chart is at (0, 0)
///   fails  as jali_plate, and JALI_BAD_INPUT (contours that touch, or nothing solid)
///   cost   O(points log points) time
JALI_API jali_status jali_carve(jali_context *ctx, const jali_contours *picture, const jali_chart *chart,
                                const jali_carve_options *opt, jali_mesh *mesh);

/// The same with regions in which the solid reaches from z = 0 to low_mm alone.
///   in     low   closed contours of the regions on the same lattice; they may cross the picture's
JALI_API jali_status jali_carve_stepped(jali_context *ctx, const jali_contours *picture,
                                        const jali_contours *low, double low_mm, const jali_chart *chart,
                                        const jali_carve_options *opt, jali_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
