// The inner skin: every vertex of a surface moved inwards by the thickness of a wall.
#ifndef MESH_OFFSET_H
#define MESH_OFFSET_H

#include "mesh/mesh.h"

typedef struct offset_options {
    double thickness_mm; // of the wall, > 0
    // Where it must be thinner to meet nothing, at least this, > 0. Over dents and spikes finer than the wall
    // it may come down to an eighth of it in a point, to turn over nowhere.
    double least_mm;
    const bool *frail; // [triangle_count] or NULL: at their corners too it may come down to that
    double unit_mm;    // a power of two of which every coordinate is a multiple, inner ones too
} offset_options;

typedef struct offset_report {
    int32_t thinned;            // vertices whose wall is thinner than asked for
    int32_t thinnest;           // the vertex where it is thinnest, -1: no vertex
    double thinnest_mm;         // there
    int32_t unsolved_triangles; // that fold, or whose inner skin meets a skin, whatever was tried
    int32_t unsolved;           // one of them, -1: none
    int32_t rounds;             // of testing and thinning, the last time
    int32_t full_triangles;     // over which the wall is left full, because none would do
    int32_t full;               // one of them, -1: none
} offset_report;

/// Give each vertex its place on the inner skin. Inner triangles have the corners of the outer ones and lie
/// thickness_mm behind them: at a crease or corner the vertex goes where the moved planes meet, at most twice
/// as far; a vertex of a flat rim stays in the rim's plane.
///
/// Between a triangle and its inner one lies a prism, linear from skin to skin. Where prisms would turn over,
/// or a skin or a wall along a rim would meet another, the wall is made thinner, by at most half a mm a mm
/// along the surface, until no prism turns over and nothing meets (exact, on the rounded places). Triangles
/// of the surface that meet each other are left out of that. Where the least wall folds or meets something
/// too, it is left full: the inner skin spans the place like a membrane (mesh/offset_fill.h), with prisms
/// that may turn over, and nothing meets there either.
///   in     mesh       manifold, no degenerate triangle, multiples of unit_mm
///   out    inner      [vertex_count], multiples of unit_mm
///          thickness  [vertex_count] mm reached, the mean over the faces around each vertex; may be NULL
///          full       [triangle_count] where the wall is left full; may be NULL
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   O(triangles) and up to 30 searches for intersections, 7 times that where it is left full; the
///   same for any number of threads
jali_status offset_inward(jali_context *ctx, const jali_mesh *mesh, const offset_options *opt,
                          double (*inner)[3], float *thickness, bool *full, offset_report *report);

#endif
