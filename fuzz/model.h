// What a model that was read must satisfy, whatever the bytes were.
#ifndef FUZZ_MODEL_H
#define FUZZ_MODEL_H

#include <jali/check.h>
#include <jali/model.h>
#include <jali/write.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REQUIRE(condition)                                                                                   \
    do {                                                                                                     \
        if (!(condition)) abort();                                                                           \
    } while (0)

static inline void require_sound(const jali_mesh *mesh)
{
    REQUIRE(mesh->triangle_count > 0 && mesh->vertex_count > 0);
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) REQUIRE(isfinite(mesh->vertex[i][k]));
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            REQUIRE(mesh->triangle[t][k] >= 0 && mesh->triangle[t][k] < mesh->vertex_count);
}

// Every edge is in some triangle, and the counts of the report fit each other.
static inline void require_sound_report(const jali_mesh *mesh, const jali_check_report *r)
{
    REQUIRE(r->triangles == mesh->triangle_count);
    REQUIRE(r->edges <= 3 * (int64_t)r->triangles && r->shells <= r->triangles && r->voids <= r->shells);
    REQUIRE(r->open_edges.count + r->crowded_edges.count + r->misdirected_edges.count <= r->edges);
    REQUIRE(r->solid == (r->closed && r->manifold && r->oriented && r->clean && r->apart));
    REQUIRE(!r->solid || (r->pieces >= 1 && r->genus >= 0 && r->euler % 2 == 0));
}

/// Read, check, write in a format, read again: the same corners.
static inline int fuzz_model(const uint8_t *data, size_t size, jali_format format)
{
    jali_context_options opt = jali_context_defaults();
    opt.threads = 1;
    opt.max_memory_bytes = (uint64_t)1 << 30;
    jali_model_options limits = jali_model_defaults();
    limits.max_bytes = 1 << 26;
    limits.max_triangles = 2000;
    jali_context *ctx;
    jali_mesh mesh;
    jali_check_report report;
    jali_bytes bytes = {0};
    REQUIRE(jali_context_create(&opt, &ctx) == JALI_OK);
    jali_status status = jali_read_model_bytes(ctx, data, size, "model", &limits, &mesh);
    if (status == JALI_OK) {
        require_sound(&mesh);
        REQUIRE(jali_check(ctx, &mesh, NULL, &report) == JALI_OK);
        require_sound_report(&mesh, &report);
        jali_write_options plain = {.no_thumbnail = true};
        REQUIRE(jali_write_bytes(ctx, format, &(jali_product){.mesh = &mesh}, &plain, &bytes) == JALI_OK);
        status = jali_check_readback(ctx, bytes.data, bytes.size, &mesh);
        // A 3MF may hold what float32 cannot: coordinates beyond it, vertices at one place.
        REQUIRE(status == JALI_OK ||
                (format == JALI_FORMAT_STL && (status == JALI_BROKEN || status == JALI_BAD_INPUT)));
    } else {
        REQUIRE(mesh.vertex == NULL && strlen(jali_message(ctx)) > 0);
    }
    jali_bytes_free(ctx, &bytes);
    jali_mesh_free(ctx, &mesh);
    jali_context_free(ctx);
    return 0;
}

#endif
