// A way around what is blocked. Internal to connect.
#ifndef CONNECT_DETOUR_H
#define CONNECT_DETOUR_H

#include "connect/parts.h"
#include <jali/connect.h>

enum { DETOUR_QUEUES = 8 };

/// A pixel of the window that the search comes to, and by which step.
typedef struct detour_step {
    int32_t pixel;
    uint8_t by;
} detour_step;

/// Scratch of the search, and the way it found. {0} is valid and empty.
typedef struct detour {
    uint8_t *seen; // [seen_capacity], a byte a pixel of the window
    detour_step *queue[DETOUR_QUEUES];
    int32_t (*path)[2]; // from the part to the other, pixel by pixel
    size_t seen_capacity, queue_capacity[DETOUR_QUEUES], path_capacity, corner_capacity;
    int32_t corner_count;
    int32_t (*corner)[2]; // [corner_count], where the way bends
} detour;

/// Whether the walk from one pixel to another meets no black pixel that is blocked.
bool line_is_free(const jali_bitmap *solid, const jali_bitmap *blocked, const int32_t from[2],
                  const int32_t to[2]);

/// The shortest way from the part `root` to any other through pixels that are not blocked.
///   out    bridge   its ends
///          d        corners in between
///          found    false: there is no way
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
///   cost   a byte a pixel of a window around the part, and O(pixels within the way's length)
jali_status find_detour(jali_context *ctx, const jali_bitmap *solid, const jali_bitmap *blocked, parts *p,
                        int32_t root, jali_metric metric, detour *d, jali_bridge *bridge, bool *found);
void detour_free(jali_context *ctx, detour *d);

#endif
