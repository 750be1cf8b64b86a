// The place of a surface that is nearest to a point. Internal to the stage place.
#ifndef PLACE_NEAREST_H
#define PLACE_NEAREST_H

#include <jali/surface.h>

/// The nearest face; where the surface comes unrolled, of those alone that are part of it.
///   out    at     the place on it that is nearest
///   cost   O(faces)
int32_t nearest_face(const jali_surface *surface, const double point[3], double at[3]);

#endif
