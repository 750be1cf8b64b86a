// Reading a model file into a mesh: STL (binary, ASCII), 3MF, OBJ, PLY (binary, ASCII) and OFF.
#ifndef JALI_MODEL_H
#define JALI_MODEL_H

#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_model_options {
    uint64_t max_bytes;    // of the file, and of a 3MF model when unpacked; default 2^31
    int32_t max_triangles; // of the whole model, each instance counted; default 50 million
} jali_model_options;

JALI_API jali_model_options jali_model_defaults(void);

/// Read a model. What it is follows from its contents, not from its name.
///   in     path   "-" is stdin
///          opt    NULL means the defaults
///   out    mesh   mm, coordinates as float32 holds them, which is what slicers see. Only a 3MF has a unit,
///   the
///                 others count as mm. The equal vertices of an STL are welded; those of the others stay as
///                 they are numbered. A 3MF gives all objects of its build, placed. Polygons are split into
///                 triangles. Free with jali_mesh_free
///   fails  JALI_IO, JALI_BAD_INPUT (what is wrong and where; truncated, empty, not a number, another type),
///          JALI_LIMIT, JALI_NO_MEMORY, JALI_CANCELLED
JALI_API jali_status jali_read_model(jali_context *ctx, const char *path, const jali_model_options *opt,
                                     jali_mesh *mesh);

/// The same from memory.
///   in     name   what to call it in sentences
JALI_API jali_status jali_read_model_bytes(jali_context *ctx, const void *data, size_t size, const char *name,
                                           const jali_model_options *opt, jali_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
