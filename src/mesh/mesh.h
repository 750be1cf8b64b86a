// Meshes as values, and what the mesh tools share.
#ifndef MESH_MESH_H
#define MESH_MESH_H

#include "base/base.h"
#include <jali/mesh.h>

/// Allocate both arrays, not cleared.
jali_status mesh_create(jali_context *ctx, int32_t vertex_count, int32_t triangle_count, jali_mesh *mesh);

/// Refuse a mesh that no tool can work on: an index outside the vertices, a coordinate that is not finite.
///   fails  JALI_BAD_INPUT
jali_status mesh_validate(jali_context *ctx, const jali_mesh *mesh);

/// Move vertices to the nearest multiple of a power of two of a mm, the smallest of which the farthest
/// coordinate holds fewer than 2^24: float32 (STL) and the exact tests then hold each one
/// (docs/decisions/0001). Returns the power's exponent; half a unit is below 4e-6 mm up to 128 mm,
/// below 1.6e-5 mm up to 512 mm.
int32_t mesh_round(jali_mesh *mesh);

/// Vertices at exactly the same place: first[i] is the lowest index whose coordinates equal those of i
/// (0 and -0 are equal).
///   out    first     [count], may be used at once as a renumbering
///          distinct  how many places there are; may be NULL
///   fails  JALI_NO_MEMORY
///   cost   O(count) expected
jali_status weld_points(jali_context *ctx, int32_t count, const double (*point)[3], int32_t *first,
                        int32_t *distinct);

#endif
