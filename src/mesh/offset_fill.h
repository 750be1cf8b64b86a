// Where no wall can be offset it is left full: the inner skin spans the place like a membrane.
#ifndef MESH_OFFSET_FILL_H
#define MESH_OFFSET_FILL_H

#include "base/base.h"
#include <jali/mesh.h>

/// Make a set of triangles larger by those that share a vertex with it, `rings` times.
///   inout  full  [triangle_count]
///   fails  JALI_NO_MEMORY
jali_status grow_full(jali_context *ctx, const jali_mesh *mesh, int32_t rings, bool *full);

/// Put each inner vertex all of whose triangles are full, rims aside, in the middle of its neighbours: the
/// border of the set stays, what it encloses is drawn smooth across.
///   in     twin   [3 triangle_count] of topology_mark
///          free   [vertex_count] out: the vertices that were placed
///   inout  inner  [vertex_count], multiples of unit_mm
///   fails  JALI_NO_MEMORY
///   cost   O(sweeps x sides of the set), at most 2000 sweeps
jali_status span_full(jali_context *ctx, const jali_mesh *mesh, const int32_t *twin, const bool *full,
                      double unit_mm, int32_t sweeps, bool *free, double (*inner)[3]);

#endif
