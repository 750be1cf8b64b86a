// What was written, read again: the file must hold the mesh it was made from.
#include <jali/check.h>
#include <jali/model.h>

#include "mesh/mesh.h"

static bool same_float32(const double a[3], const double b[3])
{
    for (int k = 0; k < 3; k++)
        if ((float)a[k] != (float)b[k]) return false;
    return true;
}

// The corners of both meshes, in order, must name vertices by a one-to-one renumbering.
static jali_status compare(jali_context *ctx, const jali_mesh *mesh, const jali_mesh *read, int32_t *renamed,
                           int32_t *original)
{
    for (int32_t i = 0; i < mesh->vertex_count; i++) renamed[i] = -1;
    for (int32_t i = 0; i < read->vertex_count; i++) original[i] = -1;
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            int32_t a = mesh->triangle[t][k], b = read->triangle[t][k];
            if (renamed[a] == -1 && original[b] == -1) {
                renamed[a] = b;
                original[b] = a;
            }
            if (renamed[a] != b || original[b] != a)
                return fail(ctx, JALI_BROKEN,
                            "read back, triangle %d joins other vertices: two fell on one place, or "
                            "one on two",
                            t);
            if (!same_float32(mesh->vertex[a], read->vertex[b]))
                return fail(ctx, JALI_BROKEN,
                            "read back, vertex %d lies at (%.9g, %.9g, %.9g) mm, not at (%.9g, %.9g, "
                            "%.9g)",
                            a, read->vertex[b][0], read->vertex[b][1], read->vertex[b][2], mesh->vertex[a][0],
                            mesh->vertex[a][1], mesh->vertex[a][2]);
        }
    return JALI_OK;
}

jali_status jali_check_readback(jali_context *ctx, const void *data, size_t size, const jali_mesh *mesh)
{
    jali_status status;
    jali_mesh read = {0};
    int32_t *renamed = NULL, *original = NULL;
    TRY(jali_read_model_bytes(ctx, data, size, "the written model", NULL, &read));
    if (read.triangle_count != mesh->triangle_count)
        TRY(fail(ctx, JALI_BROKEN, "read back, the model has %d triangles, not %d", read.triangle_count,
                 mesh->triangle_count));
    TRY(ALLOCATE(ctx, renamed, mesh->vertex_count));
    TRY(ALLOCATE(ctx, original, read.vertex_count));
    TRY(compare(ctx, mesh, &read, renamed, original));
done:
    release(ctx, renamed);
    release(ctx, original);
    jali_mesh_free(ctx, &read);
    return status;
}
