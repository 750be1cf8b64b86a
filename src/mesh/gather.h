// A mesh in the making while a file is read: vertices one by one, polygons corner by corner.
#ifndef MESH_GATHER_H
#define MESH_GATHER_H

#include "mesh/readers.h"

typedef struct gathered_corner {
    int32_t vertex, texture; // texture -1: none
} gathered_corner;

/// {0} is valid and empty.
typedef struct gathering {
    const model_file *file;
    double (*vertex)[3];            // [vertex_count], finite float32 values
    double (*texture)[2];           // [texture_count]
    gathered_corner (*triangle)[3]; // [triangle_count]
    gathered_corner *corner;        // [corner_count], of the polygon in hand
    int32_t *left;                  // [corner_count], scratch of its splitting
    size_t vertex_count, texture_count, triangle_count, corner_count;
    size_t vertex_capacity, texture_capacity, triangle_capacity, corner_capacity, left_capacity;
} gathering;

void gather_free(jali_context *ctx, gathering *g);

/// Vertices and texture points are numbered as they come.
///   fails  JALI_LIMIT (more than three for each triangle that is allowed), JALI_NO_MEMORY
jali_status gather_vertex(jali_context *ctx, gathering *g, const double point[3]);
jali_status gather_texture(jali_context *ctx, gathering *g, const double point[2]);

/// Add a corner to the polygon in hand.
///   in     texture  -1: none
///   fails  JALI_NO_MEMORY
jali_status gather_corner(jali_context *ctx, gathering *g, int32_t vertex, int32_t texture);

/// Make triangles of the polygon in hand: a fan when that fits, else ears cut off one by one, seen along its
/// normal. Fewer than three corners make none.
///   in     line   for the sentence; 0: `number` counts the polygon instead
///   fails  JALI_BAD_INPUT (it crosses itself, or is concave with more than 500 corners), JALI_LIMIT,
///          JALI_NO_MEMORY
jali_status gather_polygon(jali_context *ctx, gathering *g, int64_t line, int64_t number);

/// The mesh, and the texture points of its corners when all have one.
///   out    uv     NULL is accepted; *uv is NULL when there are none
///   fails  JALI_BAD_INPUT (no triangles), JALI_NO_MEMORY
jali_status gather_finish(jali_context *ctx, const gathering *g, jali_mesh *mesh, double (**uv)[3][2]);

#endif
