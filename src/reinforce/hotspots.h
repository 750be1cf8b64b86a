// Hot spots: where the stress is largest, and how it depends on the displacements. Internal to reinforce.
#ifndef REINFORCE_HOTSPOTS_H
#define REINFORCE_HOTSPOTS_H

#include <jali/reinforce.h>
#include "base/base.h"

enum { MOST_HOTSPOTS = 12 };

/// The places of the largest mean stress: from the highest down to 0.7 of it, each at least `apart_mm` from
/// those before.
int32_t find_hotspots(const jali_sheet *sheet, const float *mean_mpa, double apart_mm,
                      int32_t node[MOST_HOTSPOTS]);

/// The derivative of the stress around a node by the displacements: the mean of von Mises at the worse face
/// over the triangles whose middle lies within `radius_mm`, at least the node's own.
///   out    gradient   [node_count] MPa a mm or rad; written whole
void stress_gradient(const jali_sheet *sheet, const jali_material *material, const double (*u)[6],
                     int32_t node, double radius_mm, double (*gradient)[6]);

#endif
