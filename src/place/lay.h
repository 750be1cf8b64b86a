// Where the faces of a surface lie in the plane of the picture. Internal to the stage place.
#ifndef PLACE_LAY_H
#define PLACE_LAY_H

#include "base/base.h"
#include <jali/place.h>

/// The plane of the picture: mm, x right, y up, the picture's centre at the origin.
typedef struct laid {
    const jali_surface *surface;
    double (*at)[3][2]; // [triangles] each corner's place; NaN: the face is not in the plane
    double *depth;      // [vertices] along the view, mm, projected; NULL when wrapped
    bool perspective;
    double around_mm; // x and x + around_mm are the same place; 0: not so
} laid;

/// A camera on the surface's side: place = ((p - centre) . right, (p - centre) . up), divided by the depth in
/// a perspective so that lengths are true at the centre's depth.
typedef struct camera {
    double right[3], up[3], forward[3];
    double centre[3], eye[3];
    double distance; // eye to centre along forward; 0: parallel
} camera;

/// Look along the options' direction at a centre.
///   fails  JALI_BAD_VALUE (up along the view, no direction)
jali_status aim(jali_context *ctx, const jali_camera *opt, const double centre[3], camera *c);

/// Lay all faces; free with laid_free.
jali_status lay_by_camera(jali_context *ctx, const jali_surface *surface, const camera *c, laid *l);

/// Lay the faces that have a place on the unrolled surface there.
///   in     at_mm   the origin is the place nearest to it; NULL: the middle of all
///                  A texture is scaled so that lengths are true there
jali_status lay_by_unrolling(jali_context *ctx, const jali_surface *surface, const double *at_mm, laid *l);

/// A picture to be laid on a surface that does not come unrolled.
typedef struct flat_window {
    double at_mm[3];               // its centre goes to the nearest place of the surface
    double up[3];                  // zeros: z; where the surface is level, y
    double size_mm[2], ring_mm[2]; // of the picture, and of the zone beside and above it
} flat_window;

/// Flatten the faces around a place until they hold the window.
///   fails  JALI_NO_RESULT (no flattening without folds, or one that is stretched too much: the message says
///          how much, where, and which width would do), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   O(faces of the surface + n^1.5) for n faces in the window; 20,000: about 0.2 s
jali_status lay_by_flattening(jali_context *ctx, const jali_surface *surface, const flat_window *window,
                              laid *l);

/// A new one with places to be filled.
jali_status laid_create(jali_context *ctx, const jali_surface *surface, laid *l);
void laid_free(jali_context *ctx, laid *l);

/// Which face is nearest to the viewer at samples of the plane: sample (i, j) at low + (i, j) * step.
typedef struct view {
    double low[2], step;
    int32_t columns, rows;
    int32_t *face;   // [columns * rows], -1: none. In an arena
    float *nearness; // [columns * rows] grows towards the viewer; NULL when wrapped
} view;

/// Draw faces into a view; a face turned away from the viewer hides what is behind it as any other.
///   in     only   [triangles] faces to draw; NULL: all
///          turns  how often around_mm each face's places are shifted; NULL: not at all
void draw_faces(const laid *l, const uint8_t *only, const int32_t *turns, view *v);
jali_status view_create(jali_context *ctx, const double low[2], const double high[2], double step, bool depth,
                        view *v);

/// Find the view and the centre of a projected picture that has no place of its own: the largest room in
/// which the surface is smooth and turned to the viewer. It depends on the picture's shape, not on its size.
///   in     half_mm   of the picture
///          wanted    the front is taken when the picture, scaled so, has room there
///   out    c         aimed
///          room      the largest scale of the picture that fits there
jali_status find_view(jali_context *ctx, const jali_surface *surface, const jali_place_options *opt,
                      const double half_mm[2], double wanted, camera *c, double *room);

/// The 2 x 2 metric of a face in its plane, y up: first fundamental form of the map from plane to surface.
bool face_metric(const laid *l, int32_t face, double g[3]);

#endif
