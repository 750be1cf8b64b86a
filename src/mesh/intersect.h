// Triangles that meet where they must not: exact, every pair counted.
#ifndef MESH_INTERSECT_H
#define MESH_INTERSECT_H

#include "mesh/boxes.h"
#include "mesh/exact.h"
#include "mesh/topology.h"

/// Triangles in exact coordinates, with the box hierarchy over them. Triangles without area are left out.
typedef struct exact_surface {
    const lattice *l;
    const int32_t (*triangle)[3]; // welded
    box_tree tree;                // its items number `face`
    int32_t face_count;
    int32_t *face;          // [face_count], the triangles that have an area, ascending
    finding flat_triangles; // without area: on one line or one point; a is a triangle
} exact_surface;

jali_status exact_surface_create(jali_context *ctx, const lattice *l, int32_t triangle_count,
                                 const int32_t (*triangle)[3], exact_surface *s);
void exact_surface_free(jali_context *ctx, exact_surface *s);

/// The box around a triangle, float32 rounded outwards.
box box_of_triangle(const lattice *l, const int32_t t[3]);

/// Do two triangles, given by welded vertices and each with an area, meet anywhere but in the vertex or edge
/// they share? Triangles with the same three vertices are left to topology's repeated_triangles and do not
/// count.
bool triangles_meet(const lattice *l, const int32_t a[3], const int32_t b[3]);

/// Count the pairs that do.
///   out    met     [triangles], set for those of a pair; NULL is accepted. What was set before stays so
///          found   a, b are triangles: of all pairs the one with the lowest a, then b
///          capped  some block of 1024 triangles had more than a million pairs: the count is at least so,
///                  and not every triangle of a pair may be set
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   O(pairs of touching boxes); the same for any number of threads
jali_status count_intersections(jali_context *ctx, const exact_surface *s, bool *met, finding *found,
                                bool *capped);

#endif
