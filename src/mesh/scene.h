// What a 3MF describes: objects of triangles, components that place objects in objects, a build that places
// them for good.
#ifndef MESH_SCENE_H
#define MESH_SCENE_H

#include "mesh/readers.h"

enum { MAX_OBJECTS = 20000, MAX_PLACED = 1000000, MAX_DEPTH = 32 };

typedef struct transform {
    double m[12]; // rows of a 4 x 3 matrix: a point is a row from the left
} transform;

// An object placed by a component or by the build.
typedef struct placed {
    int32_t object;
    transform at;
} placed;

typedef struct object {
    uint32_t id;
    int32_t first_vertex, vertex_count, first_triangle, triangle_count;
    int32_t first_part, part_count;                 // its components
    int64_t all_vertices, all_triangles, instances; // with those of its components
    int32_t depth;                                  // 1 without components
} object;

typedef struct scene {
    double unit_mm;
    double (*vertex)[3];    // [vertex_count], of all objects, in units
    int32_t (*triangle)[3]; // [triangle_count], indices within their object
    object *object;         // [object_count], components refer to earlier ones only
    placed *part, *item;    // [part_count], [item_count]: components of all objects; the build
    size_t vertex_count, triangle_count, object_count, part_count, item_count;
} scene;

/// Place everything the build asks for in one mesh.
///   fails  JALI_BAD_INPUT (nothing is placed, a coordinate leaves float32), JALI_LIMIT, JALI_NO_MEMORY
///   cost   O(triangles placed)
jali_status scene_mesh(jali_context *ctx, const scene *s, const model_file *file, jali_mesh *mesh);

#endif
