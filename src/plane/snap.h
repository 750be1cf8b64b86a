// Snap rounding: edges that cross become edges that meet only in lattice points.
#ifndef PLANE_SNAP_H
#define PLANE_SNAP_H

#include "base/base.h"

/// {0} is valid and empty.
typedef struct snapped {
    int32_t point_count;
    int32_t (*point)[2]; // [point_count] distinct: the points given, then the crossings
    int32_t *home;       // [points given] where each of them is
    int32_t piece_count;
    int32_t (*piece)[2]; // [piece_count] from, to; in the order of the edges, along each edge
    int32_t *edge;       // [piece_count] the edge given that it is a piece of
} snapped;

void snapped_free(jali_context *ctx, snapped *s);

/// Snap rounding. Every point given and every crossing, rounded to the lattice, is the centre of a hot pixel;
/// an edge becomes the chain of the hot pixels that it meets. It moves by less than a unit; no two pieces
/// cross, no point lies inside a piece, and no edge moves across a point: what lay left of an edge is still
/// there, or on it.
///   in     point     [point_count], |coordinate| <= 2^24
///          edge      [edge_count] pairs of points
///          disjoint  edges from this number on are known not to cross each other and are not tested
///   out    s         free with snapped_free
///          crossed   two edges below `disjoint` that cross, the later one as low as can be, or -1, -1
///   fails  JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   near O(edges + crossings) when edges are spread evenly
jali_status snap_round(jali_context *ctx, const int32_t (*point)[2], int32_t point_count,
                       const int32_t (*edge)[2], int32_t edge_count, int32_t disjoint, snapped *s,
                       int32_t crossed[2]);

/// The pieces that lie there an odd number of times: where snapping laid a closed chain back on itself,
/// around a corner that another edge cuts within a unit, the spike goes.
///   out    odd   [count] room for all; the first of each, in their order
///   fails  JALI_NO_MEMORY
jali_status odd_pieces(jali_context *ctx, const int32_t (*piece)[2], int32_t count, int32_t (*odd)[2],
                       int32_t *odd_count);

#endif
