// Triangles too thin for the shell's lattice. Internal to carve.
#ifndef CARVE_SLIVERS_H
#define CARVE_SLIVERS_H

#include "base/base.h"
#include <jali/shell.h>

/// Flip the long edges of triangles whose height, on either skin, is a few lattice units: their three
/// vertices lie on one line but for rounding, so the surface keeps its shape. At a border the triangle goes.
///   inout  shell    triangles (with uv and solid); vertices stay
///   out    left     triangles that stay too thin
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(triangles)
jali_status mend_slivers(jali_context *ctx, jali_shell *shell, int32_t *left);

#endif
