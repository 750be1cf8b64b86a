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
} jali_bridge;

/// {0} is valid and empty.
typedef struct jali_bridges {
    int32_t count;
    jali_bridge *bridge; // [count], in the order they were laid
    int64_t pixels;      // black pixels that became white
} jali_bridges;

JALI_API void jali_bridges_free(jali_context *ctx, jali_bridges *bridges);

#ifdef __cplusplus
}
#endif
#endif
