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

bool looks_like_stl(const model_file *file);
jali_status read_stl(jali_context *ctx, const model_file *file, jali_mesh *mesh);

bool looks_like_3mf(const model_file *file);
jali_status read_3mf(jali_context *ctx, const model_file *file, jali_mesh *mesh);

#endif
