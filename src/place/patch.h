// The faces under a picture, on its lattice. Internal to the stage place.
#ifndef PLACE_PATCH_H
#define PLACE_PATCH_H

#include "mesh/sides.h"
#include "place/lay.h"

/// A patch being grown, and how its faces came to lie where they do.
typedef struct growth {
    jali_patch patch;
    uint8_t *taken; // [triangles] the face is in the patch. In an arena, as turns
    int32_t *turns; // [triangles] how often around_mm was added to its places
} growth;

/// The faces that are reached from a first one through faces that lie counter-clockwise on the lattice and
/// come near the chart's grid.
///   in     around_grid_mm   how far beyond the grid the patch is wanted
///          first            a face under the picture's centre
///          turns            of the first face
///   fails  JALI_LIMIT (a face that leaves the lattice), JALI_NO_MEMORY
jali_status grow_patch(jali_context *ctx, const laid *l, const jali_chart *chart, double around_grid_mm,
                       int32_t first, int32_t turns, growth *g);

/// The area of the rectangle that the patch covers, lattice units squared. Exact but for double rounding.
double covered_area(const jali_patch *patch, const double low[2], const double high[2]);

/// Does the patch cover a place of the plane twice? Decided by its borders, exactly.
///   out    point   of the patch, where a border crosses another one or itself; -1: it does not
///   fails  JALI_LIMIT, JALI_NO_MEMORY, JALI_CANCELLED
///   cost   O(faces)
jali_status find_overlap(jali_context *ctx, const jali_patch *patch, int32_t *point);

/// Fill the chart's metric from the faces of the patch.
///   out    stretch   least and largest stretch of a length inside the picture
jali_status fill_metric(jali_context *ctx, const laid *l, const growth *g, jali_chart *chart,
                        double stretch[2]);

#endif
