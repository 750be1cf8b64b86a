// Rays through a mesh: the nearest triangle, or whether there is any.
//
// Source:  the triangle test is that of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection"
// (2013), in
//          double: no ray slips between two triangles that share an edge.
// Limits:  coordinates are float32 about the middle of the mesh's box: 1e-7 of its size.
// Checked: tests/test_render.c
#ifndef MESH_RAYS_H
#define MESH_RAYS_H

#include "mesh/boxes.h"
#include <jali/mesh.h>

typedef struct ray_scene {
    double origin[3];       // the mesh's place that is 0 here
    double size;            // diagonal of the box; 1 when it has none
    double low[3], high[3]; // the box, about the origin
    box_tree tree;
    float (*corner)[3][3]; // [tree.item_count], in the order of the curve: triangle tree.item[place]
} ray_scene;

/// Prepare a mesh, a valid one (mesh_validate).
///   fails  JALI_BAD_INPUT (larger than 1000 km), JALI_NO_MEMORY
///   cost   that of box_tree_create; 80 bytes a triangle
jali_status ray_scene_create(jali_context *ctx, const jali_mesh *mesh, ray_scene *scene);
void ray_scene_free(jali_context *ctx, ray_scene *scene);

/// The points from + t * along, near < t < far; about the scene's origin.
typedef struct ray {
    double from[3], along[3];
    double near, far;
} ray;

typedef struct ray_hit {
    double t;
    int32_t place; // of the triangle on the curve
} ray_hit;

bool ray_nearest(const ray_scene *scene, const ray *r, ray_hit *hit);
bool ray_any(const ray_scene *scene, const ray *r);

/// The unit normal of the triangle at a place; 0 where it has no area.
void ray_scene_normal(const ray_scene *scene, int32_t place, double normal[3]);

#endif
