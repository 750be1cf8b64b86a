// What stands before the eye: the object, the ground, the light, the camera; about the scene's origin, mm.
#ifndef RENDER_STAGE_H
#define RENDER_STAGE_H

#include "mesh/rays.h"
#include "render/vec.h"

#include <jali/render.h>

typedef struct stage {
    const ray_scene *scene;
    bool lamp, draft;
    const jali_mesh *mesh;      // with `colour`, to find the corners of what is seen
    const uint8_t (*colour)[3]; // of its vertices, or NULL
    vec up, right, towards;     // upright axes of the room; `towards` the eye, level
    double ground;              // height of the ground, along up
    double wall;                // how far behind the origin the wall stands; INFINITY: there is none
    vec eye, axis[3];           // of the camera: right, up, towards the eye
    double slope[2];            // of the edges of the picture against its axis, across and up
    double near_depth, depth;   // of the object from the eye: where it begins, how deep it is
    vec key;                    // unit, towards the sun
    vec bulb;                   // where the lamp is
    double bulb_radius, power;  // of the lamp: a surface at 1 mm, facing it, gets this much
} stage;

/// Set everything up.
///   fails  JALI_BAD_VALUE
jali_status stage_create(jali_context *ctx, const ray_scene *scene, const jali_mesh *mesh,
                         const jali_render_options *opt, stage *s);

/// The unit direction in which the eye sees the point (x, y) of the picture, -1 .. 1 each, y up.
vec stage_direction(const stage *s, double x, double y);

#endif
