// The outline of a plate and its hanging hole. Internal to carve.
#ifndef CARVE_PLATE_H
#define CARVE_PLATE_H

#include "base/base.h"
#include <jali/carve.h>

/// Where the plate and its hole lie, lattice units.
typedef struct plate {
    int32_t left, right, bottom, top;   // of the rectangle
    double corner;                      // radius
    double hole_x, hole_y, hole_radius; // radius 0 = no hole
    double ear_radius, fillet_radius;   // 0 = no ear: the hole lies in the frame
} plate;

/// Check the options and lay out the plate.
///   fails  JALI_BAD_VALUE, JALI_NO_RESULT (no room for the hole), JALI_LIMIT
jali_status lay_out_plate(jali_context *ctx, const jali_chart *chart, const jali_carve_options *opt,
                          plate *p);

/// The outline, counter-clockwise, and the hole, clockwise; arcs within ARC_DEVIATION_MM.
///   out    contours  one or two
///   fails  JALI_NO_MEMORY
jali_status draw_plate(jali_context *ctx, const plate *p, double unit_mm, jali_contours *contours);

#endif
