// Surfaces to carve: shapes made by formula, or meshes from files.
#ifndef JALI_SURFACE_H
#define JALI_SURFACE_H

#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The outer skin of an object. {0} is valid and empty.
typedef struct jali_surface {
    jali_mesh mesh;     // one index a place, counter-clockwise seen from outside; z is up, -y is the front
    double (*uv)[3][2]; // [mesh.triangle_count] where each corner lies on the unrolled surface, mm, u right,
                        // v up; NULL: it cannot be unrolled without a cut of its own
    double around_mm;   // u and u + around_mm are the same place; 0 = the unrolled surface does not close
} jali_surface;

JALI_API void jali_surface_free(jali_context *ctx, jali_surface *surface);

#ifdef __cplusplus
}
#endif
#endif
