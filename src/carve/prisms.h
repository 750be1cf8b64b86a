// The solid over triangular cells, of a plane or of a surface. Internal to carve.
#ifndef CARVE_PRISMS_H
#define CARVE_PRISMS_H

#include "plane/triangulation.h"
#include <jali/mesh.h>

/// Cells side by side, numbered as in a triangulation: cell c has the sides 4c, 4c+1, 4c+2. Beyond a border
/// lie ghosts, so that every side has a neighbour and the cells around each point close.
typedef struct cells {
    int32_t point_count, cell_count;
    const int32_t *corner; // [4 * cell_count] point, or GHOST
    const int32_t *beside; // [4 * cell_count] the same edge as a side of the neighbour
    const int32_t *star;   // [point_count] a cell at each point that has one
    // Of walls, [4 * cell_count], or NULL:
    const uint8_t *leans;  // the wall on this side has diagonals that rise along it, rather than fall
    const uint8_t *slices; // it is cut at the multiples of 2^slices levels; 0: it is not cut
} cells;

/// The part of the height that is solid in a cell, in levels; empty when top == bottom.
typedef struct interval {
    int32_t bottom, top;
} interval;

/// A mesh whose vertices are levels above points. {0} is valid and empty.
typedef struct prisms {
    int32_t vertex_count, triangle_count;
    int32_t (*vertex)[2];   // [vertex_count] point, level
    int32_t (*triangle)[3]; // [triangle_count]
    int32_t contact;        // a point where parts of the solid would meet in no more than an edge or a point:
                            // nothing is built then; -1: there is none
} prisms;

void prisms_free(jali_context *ctx, prisms *p);

/// The boundary of the union of the prisms over the cells: floors, ceilings, and walls where the intervals of
/// neighbours differ. Closed, without T-junctions, outward, 2-manifold at edges and vertices.
///   in     solid   [cell_count], ghosts empty
///   fails  JALI_LIMIT, JALI_NO_MEMORY
///   cost   O(triangles + levels)
jali_status build_prisms(jali_context *ctx, const cells *plane, const interval *solid, prisms *built);

/// The same over a plane, in mm.
///   in     solid     [plane->triangle_count], lattice units
///          unit_mm   of the lattice, in all three directions
///   fails  JALI_BAD_INPUT (a contact; where is in the message), JALI_LIMIT, JALI_NO_MEMORY
jali_status build_plate(jali_context *ctx, const triangulation *plane, const interval *solid, double unit_mm,
                        jali_mesh *mesh);

#endif
