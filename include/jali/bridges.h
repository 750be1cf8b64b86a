// Bridges: what joins loose solid parts.
#ifndef JALI_BRIDGES_H
#define JALI_BRIDGES_H

#include <jali/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_bridge {
    int32_t from[2], to[2]; // the two solid pixels (x, y) that it joins
    int32_t part[2]; // their components in the drawing, numbered by first pixel in raster order; where an
                     // end lies on an earlier bridge, the component that one was laid from
    int32_t via_first, via_count; // corners on its way; none: it is straight
    int32_t pixels; // black pixels that its stroke made white; 0 before it is laid in full width
} jali_bridge;

/// {0} is valid and empty.
typedef struct jali_bridges {
    int32_t count;
    jali_bridge *bridge; // [count], in the order they were laid
    int64_t pixels;      // black pixels that became white
    int32_t via_count;
    int32_t (*via)[2]; // [via_count], the corners of all bridges
    int32_t stranded;  // parts that no way leads to but through what is blocked
} jali_bridges;

/// The ends of bridge i's straight leg, counted from 0; false when it has fewer.
static inline bool jali_bridge_leg(const jali_bridges *b, int32_t i, int32_t leg, int32_t from[2],
                                   int32_t to[2])
{
    const jali_bridge *all = &b->bridge[i];
    if (leg > all->via_count) return false;
    const int32_t *begin = leg == 0 ? all->from : b->via[all->via_first + leg - 1];
    const int32_t *end = leg == all->via_count ? all->to : b->via[all->via_first + leg];
    for (int32_t k = 0; k < 2; k++) {
        from[k] = begin[k];
        to[k] = end[k];
    }
    return true;
}

JALI_API void jali_bridges_free(jali_context *ctx, jali_bridges *bridges);

#ifdef __cplusplus
}
#endif
#endif
