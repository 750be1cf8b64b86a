// Which side of a mesh's triangles lies beside which. Sides are numbered as in a triangulation of the plane:
// triangle t has the sides 4t, 4t+1, 4t+2; side s lies opposite corner s and runs counter-clockwise.
#ifndef MESH_SIDES_H
#define MESH_SIDES_H

#include "base/base.h"

enum { NO_SIDE = -1 };

/// {0} is valid and empty.
typedef struct sides {
    int32_t cell_count; // the triangles, then a ghost on each border edge when closed by ghosts
    int32_t *corner;    // [4 * cell_count] vertex; ghosts have one corner -1
    int32_t *beside;    // [4 * cell_count] side; NO_SIDE at a border, at an edge of three triangles or more
                        // and at one that both triangles run the same way
    int32_t *star;      // [vertex_count] a cell at each vertex, or -1
} sides;

/// Link the sides of a mesh.
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(triangles) for vertices of bounded valence
jali_status sides_create(jali_context *ctx, int32_t vertex_count, int32_t triangle_count,
                         const int32_t (*triangle)[3], sides *s);

/// Put a ghost beyond each open side, so that the cells around every vertex close.
///   out    stuck   a vertex where two borders meet, which has no such closure, or -1
///   fails  JALI_NO_MEMORY, JALI_LIMIT
jali_status sides_close(jali_context *ctx, int32_t vertex_count, sides *s, int32_t *stuck);

void sides_free(jali_context *ctx, sides *s);

#endif
