// Render: a picture of a mesh, by daylight or with a lamp inside.
#ifndef JALI_RENDER_H
#define JALI_RENDER_H

#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_render_options {
    int32_t width_px, height_px; // 16 .. 8192; default 800
    double view[3];              // from the eye to the object, any length; zeros (default): from the front, a
                                 // little from the right and from above
    double up[3]; // any length; zeros (default): z; of a plate that lies flat, y: it is stood up
    bool lamp;    // night, and a lamp inside (behind what has no inside); default false: day
    bool draft;   // about a fifth of the time: light from the sky falls everywhere, one sample
                  // a pixel away from edges; default false
    const uint8_t (*colour)[3]; // [vertex_count] of the mesh, sRGB, linear between vertices; NULL (default):
                                // stone
} jali_render_options;

JALI_API jali_render_options jali_render_defaults(void);

/// Draw a mesh, whole in the picture, in perspective, standing on the ground.
///   in     mesh   need not be a solid
///          opt    NULL means the defaults
///   out    rgb    [height_px][width_px][3], rows from the top, written whole; the same bytes for any number
///   of
///                 threads
///   fails  JALI_BAD_VALUE (an option; a view along `up`'s axis is none), JALI_BAD_INPUT (coordinates that
///   are not
///          finite or span more than 1000 km), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   O(triangles + pixels log triangles); about 150 bytes a triangle and 100 a pixel
JALI_API jali_status jali_render(jali_context *ctx, const jali_mesh *mesh, const jali_render_options *opt,
                                 uint8_t *rgb);

#ifdef __cplusplus
}
#endif
#endif
