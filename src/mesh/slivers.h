// Triangles too thin for what comes after them.
#ifndef MESH_SLIVERS_H
#define MESH_SLIVERS_H

#include "base/base.h"
#include <jali/shell.h>

/// Of height, for the lattice of a shell: rounding moves each vertex by up to 0.9 units.
static const double SLIVER_UNITS = 4;

/// Flip the long edges of triangles whose height, on either skin, is below the least, and join the ends of
/// short edges: three vertices so near to one line leave the surface its shape. At a border the triangle
/// goes.
///   inout  shell    triangles (with uv, faulty and solid); vertices stay. Without an inner skin its outer
///                   one alone counts
///   in     least_mm of height, > 0
///          from     begin with the triangles that have a vertex of this number or above; 0 = with all
///   out    left     triangles that stay too thin
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(triangles)
jali_status mend_slivers(jali_context *ctx, jali_shell *shell, double least_mm, int32_t from, int32_t *left);

#endif
