// The solid over the cells of a triangulation. Internal to carve.
#ifndef CARVE_PRISMS_H
#define CARVE_PRISMS_H

#include "plane/triangulation.h"
#include <jali/mesh.h>

/// The part of the height that is solid in a cell, lattice units; empty when top == bottom.
typedef struct interval {
    int32_t bottom, top;
} interval;

/// The boundary of the union of the prisms over the cells: floors, ceilings, and walls where the intervals of
/// neighbours differ. Closed, without T-junctions, outward.
///   in     solid     [plane->triangle_count], ghosts empty
///          unit_mm   of the lattice, in all three directions
///   out    mesh      2-manifold at edges and vertices
///   fails  JALI_BAD_INPUT when parts of the solid would meet in no more than an edge or a point (where is in
///          the message), JALI_LIMIT, JALI_NO_MEMORY
///   cost   O(triangles + levels)
jali_status build_prisms(jali_context *ctx, const triangulation *plane, const interval *solid, double unit_mm,
                         jali_mesh *mesh);

#endif
