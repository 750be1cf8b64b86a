// Where the triangles of a mesh cross each other: segments, and the points they run between.
#ifndef MESH_CROSSINGS_H
#define MESH_CROSSINGS_H

#include "mesh/intersect.h"

/// Where an edge of the mesh runs through a triangle.
typedef struct edge_point {
    int32_t low, high; // vertices of the edge
    int32_t face;      // the triangle
    int32_t point;     // its number
    double along;      // share of the edge from low to high
} edge_point;

/// What two triangles share, run along the cross product of their normals: in the first one's plane, seen
/// from its front, what lies on the left of it is behind the second; in the second one's plane what lies on
/// the right is behind the first.
typedef struct segment {
    int32_t face[2]; // ascending
    int32_t end[2];  // points
} segment;

/// {0} is valid and empty.
typedef struct crossings {
    int32_t point_count; // the vertices of the mesh, then the others
    double (*point)[3];  // [point_count] lattice units
    size_t point_capacity;
    int32_t edge_point_count;
    edge_point *edge_point; // [edge_point_count] ascending by low, high, along
    int32_t segment_count;
    segment *segment; // [segment_count] ascending by faces
    bool degenerate;  // an edge meets an edge, or a vertex a triangle: the rest says nothing then
} crossings;

void crossings_free(jali_context *ctx, crossings *c);

/// Find all of them, in general position: where triangles meet, an edge of one runs through the inside of the
/// other.
///   in     s    on a narrow lattice
///          met  [triangles] those that meet another one (count_intersections)
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   O(pairs log pairs)
jali_status find_crossings(jali_context *ctx, const exact_surface *s, const bool *met, crossings *c);

#endif
