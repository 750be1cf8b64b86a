// Indexed triangle meshes.
#ifndef JALI_MESH_H
#define JALI_MESH_H

#include <jali/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// {0} is valid and empty.
typedef struct jali_mesh {
    int32_t vertex_count, triangle_count;
    double (*vertex)[3];    // [vertex_count], mm
    int32_t (*triangle)[3]; // [triangle_count], counter-clockwise seen from outside
} jali_mesh;

/// How often a flaw was found, and where first (mm; zeros when it was not found).
typedef struct jali_finding {
    int64_t count;
    double at_mm[3];
} jali_finding;

JALI_API void jali_mesh_free(jali_context *ctx, jali_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
