// Means over small discs of a sheet. Internal.
#ifndef STRUCTURE_AVERAGE_H
#define STRUCTURE_AVERAGE_H

#include "structure/fans.h"

/// Area, and first moments about the origin, of a counter-clockwise triangle's part within a circle of that
/// radius about the origin.
void circle_moments(const double node[3][2], double radius, double *area, double moment[2]);

/// Mean of a value, linear in each triangle, over the part of a ball around a node that can be reached from
/// the node through the triangles within the ball.
///   in     value      [fan_count] at each fan of each node
///          radius_mm  > 0
double mean_around(const jali_sheet *sheet, const fans *f, const double *value, int32_t node,
                   double radius_mm);

#endif
