// What can be put right in a mesh without guessing, and what cannot.
#ifndef MESH_MEND_H
#define MESH_MEND_H

#include <jali/surface.h>
#include "mesh/mesh.h"

/// Leave one vertex a place, no degenerate or repeated triangle, neighbours that agree, shells that face
/// outwards; see jali_surface_read. Find what is left.
///   in/out  mesh    rounded by mesh_round; gets smaller
///           uv      [mesh->triangle_count] or NULL; follows the triangles
///           marked  [mesh->triangle_count] or NULL; follows them too: faulty whatever is found
///   out     report  all but the count of vertices and triangles; on failure the caller frees it
///   fails   JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
jali_status mend(jali_context *ctx, jali_mesh *mesh, double (*uv)[3][2], bool *marked,
                 jali_surface_report *report);

#endif
