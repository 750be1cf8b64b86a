// What the triangles of a mesh share: edges, fans around vertices, shells. No coordinates.
#ifndef MESH_TOPOLOGY_H
#define MESH_TOPOLOGY_H

#include "base/base.h"

/// How often a flaw was found and where first: vertices or triangles, as the name says.
typedef struct finding {
    int64_t count;
    int32_t a, b;
} finding;

/// {0} is valid and empty. A triangle that names a vertex twice is no surface and is left out of everything.
typedef struct topology {
    int32_t triangle_count; // as given
    int32_t used_triangle_count, used_vertex_count, edge_count;
    finding open_edges;         // in one triangle; a, b are vertices
    finding crowded_edges;      // in three triangles or more; a, b are vertices
    finding misdirected_edges;  // in two triangles that run it the same way; a, b are vertices
    finding crowded_vertices;   // more than one fan of triangles meets there; a is the vertex
    finding repeated_triangles; // the same three vertices as another, either way round; a, b are triangles
    int32_t shell_count;        // parts connected through edges, in the order of their first triangles
    int32_t *shell;             // [triangle_count], -1 for triangles left out
    bool *flawed;               // [shell_count], has an open, crowded or misdirected edge
} topology;

/// Find all of it.
///   in     triangle  [triangle_count], indices within 0 .. vertex_count-1, welded (one index a place)
///   out    t         free with topology_free
///   fails  JALI_NO_MEMORY, JALI_CANCELLED
///   cost   O(triangles) for vertices of bounded valence, else a sort of each vertex's edges
jali_status topology_create(jali_context *ctx, int32_t vertex_count, int32_t triangle_count,
                            const int32_t (*triangle)[3], topology *t);

/// What lies across each side: the side it shares its edge with, or why there is none.
enum {
    TWIN_OPEN = -1,
    TWIN_CROWDED = -2,
    TWIN_NONE = -3
}; // no other; more than one; its triangle names a vertex twice

typedef struct topology_marks {
    int32_t *twin; // [3 triangle_count], side 3 t + k runs from corner k of triangle t to the next
    bool *crowded; // [vertex_count], more than one fan of triangles meets there
} topology_marks;

/// The same, with marks; the arrays are the caller's.
jali_status topology_mark(jali_context *ctx, int32_t vertex_count, int32_t triangle_count,
                          const int32_t (*triangle)[3], const topology_marks *marks, topology *t);

void topology_free(jali_context *ctx, topology *t);

#endif
