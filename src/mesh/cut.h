// Triangles cut along what they share with others, each into triangles of its own plane.
#ifndef MESH_CUT_H
#define MESH_CUT_H

#include "mesh/crossings.h"

/// A piece of a segment, between points with none in between.
typedef struct cut_piece {
    int32_t from, to; // points, run as the segment
    int32_t segment;
} cut_piece;

/// {0} is valid and empty.
typedef struct cut_faces {
    int32_t triangle_count;
    int32_t (*triangle)[3]; // [triangle_count] points of the crossings, turning as their faces
    int32_t *parent;        // [triangle_count] the face; not ascending
    size_t triangle_capacity, parent_capacity;
    int32_t piece_count;
    cut_piece *piece; // [piece_count]
    size_t piece_capacity;
} cut_faces;

void cut_faces_free(jali_context *ctx, cut_faces *cut);

/// Cut the faces that have segments; the others stay.
///   inout  c    gets the points where three triangles meet; degenerate is set when those cannot be told
///   out    cut
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   O(n log n), and of the segments within one face the square
jali_status cut_along(jali_context *ctx, const exact_surface *s, crossings *c, cut_faces *cut);

#endif
