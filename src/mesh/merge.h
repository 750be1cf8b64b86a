// Parts of a mesh that cross each other made one: the boundary of what they enclose together.
#ifndef MESH_MERGE_H
#define MESH_MERGE_H

#include "mesh/mesh.h"

/// What came of it.
typedef struct merging {
    bool done;
    jali_mesh mesh;     // when done; free with jali_mesh_free
    double (*uv)[3][2]; // [mesh.triangle_count] when there was one; release it
    bool *faulty;       // [mesh.triangle_count] along the lines where parts crossed; release it
} merging;

void merging_free(jali_context *ctx, merging *m);

/// Cut the triangles that meet others along what they share, and keep what has the outside in front of it and
/// the inside behind: the winding number in front of each part follows from its neighbours across the cuts.
///
/// The vertices of triangles that meet are first moved outwards by some thousandths of a mm, `round` deciding
/// by how many and how: touching parts then overlap and no vertex meets an edge. Not done when rounding
/// still decides, or when the surface's rims leave open what is inside. What is cut off along the lines is
/// rounded to the lattice and rid of slivers, and so may cross anew; the caller looks again.
///   in     mesh    as jali_surface_read leaves it: rounded by mesh_round, turned to agree and outwards
///          uv      [triangle_count] or NULL
///          marked  [triangle_count] faulty before, stays so
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   that of two counts of intersections, and a winding number over all triangles for each part that
///          hangs together
jali_status merge_crossings(jali_context *ctx, const jali_mesh *mesh, const double (*uv)[3][2],
                            const bool *marked, int32_t round, merging *result);

#endif
