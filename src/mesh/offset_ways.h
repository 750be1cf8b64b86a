// Where to: the way each vertex of an offset goes.
#ifndef MESH_OFFSET_WAYS_H
#define MESH_OFFSET_WAYS_H

#include "mesh/topology.h"
#include "mesh/mesh.h"

/// The way inwards of each vertex by a thickness of 1, negative: the inner place is the outer one minus
/// thickness times way.
///   in     twin  the other side of each side (mesh/topology)
///   out    way   [vertex_count]; way . normal is 1 on every face around the vertex as nearly as can be,
///                |way| <= 2
///          kept  [vertex_count] the mean of that over the faces, <= 1
///   fails  JALI_NO_MEMORY
jali_status offset_ways(jali_context *ctx, const jali_mesh *mesh, const int32_t *twin, double (*way)[3],
                        float *kept);

#endif
