// How thick the solid is behind each place of a surface, and how wide the void before it.
#ifndef CHECK_WALLS_H
#define CHECK_WALLS_H

#include "base/base.h"
#include <jali/check.h>

/// Measure both sides of a closed mesh that faces outwards.
///   in     mesh   valid; of another kind the figures mean little
///   fails  JALI_BAD_INPUT (larger than 1000 km), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   about 4 us a triangle, up to half a million of them
jali_status measure_walls(jali_context *ctx, const jali_mesh *mesh, jali_thickness *walls,
                          jali_thickness *gaps);

#endif
