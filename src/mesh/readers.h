// One reader a model format; each takes the whole file in memory.
#ifndef MESH_READERS_H
#define MESH_READERS_H

#include "mesh/mesh.h"
#include <jali/model.h>

typedef struct model_file {
    const char *data;
    size_t size;
    const char *name; // in sentences
    jali_model_options opt;
} model_file;

/// The length is exactly what the number of triangles asks for; the first bytes may then be any.
bool is_binary_stl(const model_file *file);
bool looks_like_stl(const model_file *file);
jali_status read_stl(jali_context *ctx, const model_file *file, jali_mesh *mesh);

/// With uv: the texture points of each corner, or NULL when some corner has none; uv itself may be NULL.
bool looks_like_obj(const model_file *file);
jali_status read_obj(jali_context *ctx, const model_file *file, jali_mesh *mesh, double (**uv)[3][2]);

bool looks_like_ply(const model_file *file);
jali_status read_ply(jali_context *ctx, const model_file *file, jali_mesh *mesh);

bool looks_like_off(const model_file *file);
jali_status read_off(jali_context *ctx, const model_file *file, jali_mesh *mesh);

bool looks_like_3mf(const model_file *file);
jali_status read_3mf(jali_context *ctx, const model_file *file, jali_mesh *mesh);

/// jali_read_model_bytes, and the texture points of an OBJ.
jali_status read_any_model(jali_context *ctx, const model_file *file, jali_mesh *mesh, double (**uv)[3][2]);

#endif
