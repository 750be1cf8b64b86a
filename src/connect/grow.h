// Steps of a part that grows, over the words of a window. Internal to connect.
#ifndef CONNECT_GROW_H
#define CONNECT_GROW_H

#include "connect/window.h"

#include <stdatomic.h>

/// What grows, before and after a step, and the picture that it may meet. {0} is valid and empty.
typedef struct growing {
    plane picture, grown, next, spare;
    int32_t steps; // so far
} growing;

/// Planes for a window, `grown` as it is where there is room for it.
jali_status make_planes(jali_context *ctx, const window *w, growing *g);
/// The same, and a black border for what is to grow.
jali_status make_room(jali_context *ctx, const window *w, growing *g);
void growing_free(jali_context *ctx, growing *g);

/// Step on until pixels of the picture are met that the part did not have.
///   in   limit   steps at most, in all; the planes' borders are black
///        least   NULL or a limit that others lower meanwhile
///   out  w       where something is met, less of it
///        false: nothing is met, or the run was cancelled
bool grow_until_met(jali_context *ctx, window *w, int32_t limit, const atomic_int *least, jali_metric metric,
                    growing *g);
/// The first pixel in raster order that the last step met.
void first_met_pixel(const window *w, const growing *g, int32_t pixel[2]);
/// What has grown goes on in a wider window around the same part.
jali_status widen(jali_context *ctx, const window *narrow, const window *wide, growing *g);

#endif
