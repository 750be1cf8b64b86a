// Closed polygons on the integer lattice: the boundary between solid and void.
#ifndef JALI_CONTOURS_H
#define JALI_CONTOURS_H

#include <jali/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// {0} is valid and empty. Contours are counter-clockwise around solid and clockwise around voids; no two
/// touch, none touches itself. The first point is not repeated at the end.
typedef struct jali_contours {
    int32_t contour_count, point_count;
    int32_t *first;      // [contour_count + 1], contour i owns points first[i] .. first[i+1]-1
    int32_t (*point)[2]; // [point_count], lattice units, x right, y up
    double unit_mm;      // length of a lattice unit
} jali_contours;

JALI_API void jali_contours_free(jali_context *ctx, jali_contours *contours);

#ifdef __cplusplus
}
#endif
#endif
