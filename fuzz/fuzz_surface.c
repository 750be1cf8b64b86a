// Surfaces from descriptions, and dented, pierced and flipped balls from any bytes: mended, then hollowed
// out.
#include <jali/check.h>
#include <jali/shell.h>

#include "mesh/mend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REQUIRE(condition)                                                                                   \
    do {                                                                                                     \
        if (!(condition)) abort();                                                                           \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct bytes_left {
    const uint8_t *at, *end;
} bytes_left;

static uint8_t next_byte(bytes_left *in)
{
    return in->at < in->end ? *in->at++ : 0;
}

// Any text as a description; files are out of reach, so that nothing outside is read.
static void try_description(jali_context *ctx, const uint8_t *data, size_t size)
{
    char text[128];
    jali_surface s;
    jali_check_report r;
    if (size >= sizeof text || memchr(data, 0, size)) return;
    memcpy(text, data, size);
    text[size] = 0;
    if (strstr(text, "profile")) return;
    if (jali_surface_make(ctx, text, NULL, &s) != JALI_OK) {
        REQUIRE(s.mesh.vertex == NULL && s.uv == NULL && strlen(jali_message(ctx)) > 0);
        return;
    }
    if (s.mesh.triangle_count < 20000) {
        REQUIRE(jali_check(ctx, &s.mesh, NULL, &r) == JALI_OK);
        REQUIRE(r.manifold && r.clean && r.misdirected_edges.count == 0 && r.low_mm[2] == 0 &&
                r.coordinates_exact);
    }
    jali_surface_free(ctx, &s);
}

// A ball of a few facets: each byte moves a vertex, later ones turn triangles over, take them out, or make
// two of one.
static void dent(jali_mesh *mesh, bytes_left *in)
{
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++) mesh->vertex[v][k] += (next_byte(in) - 128) / 32.0;
    for (int edits = next_byte(in) % 8; edits > 0; edits--) {
        int32_t *t = mesh->triangle[next_byte(in) % mesh->triangle_count], kind = next_byte(in) % 4,
                swap = t[0];
        const int32_t *other = mesh->triangle[next_byte(in) % mesh->triangle_count];
        if (kind == 0) t[0] = t[1];
        if (kind == 0 || kind == 1) t[1] = swap;
        if (kind == 1) t[0] = other[0];
        if (kind == 2) memmove(t, other, sizeof *mesh->triangle);
        if (kind == 3) memcpy(t, mesh->triangle[--mesh->triangle_count], sizeof *mesh->triangle);
    }
}

static void require_mended(jali_context *ctx, const jali_mesh *mesh, const jali_surface_report *found)
{
    jali_check_report r;
    REQUIRE(jali_check(ctx, mesh, NULL, &r) == JALI_OK);
    REQUIRE(r.repeated_vertices == 0 && r.clean && r.repeated_triangles.count == 0);
    REQUIRE(r.open_edges.count == found->open_edges.count &&
            r.crowded_edges.count == found->crowded_edges.count);
    REQUIRE(r.crowded_vertices.count == found->crowded_vertices.count);
    REQUIRE(r.misdirected_edges.count == found->misdirected_edges.count);
    REQUIRE(r.intersections.count == found->intersections.count);
    REQUIRE(found->faulty_triangles > 0 || r.misplaced_shells.count == 0);
}

static void try_ball(jali_context *ctx, bytes_left in)
{
    jali_surface s;
    jali_surface_report found = {0};
    jali_shell shell;
    jali_mesh solid;
    jali_check_report r;
    jali_shell_options wall = {.thickness_mm = 0.1 + next_byte(&in) / 32.0, .least_mm = 0.05};
    REQUIRE(jali_surface_make(ctx, "sphere:r=10,facets=8,tolerance=2", NULL, &s) == JALI_OK);
    dent(&s.mesh, &in);
    mesh_round(&s.mesh);
    REQUIRE(mend(ctx, &s.mesh, s.uv, &found) == JALI_OK);
    require_mended(ctx, &s.mesh, &found);
    jali_status status = JALI_NO_RESULT;
    bool sound = found.faulty_triangles == 0 && s.mesh.triangle_count > 0;
    if (sound) status = jali_shell_create(ctx, &s, &wall, &shell, NULL);
    REQUIRE(status == JALI_OK || status == JALI_NO_RESULT);
    if (status == JALI_OK) {
        REQUIRE(jali_shell_solid(ctx, &shell, &solid) == JALI_OK);
        REQUIRE(jali_check(ctx, &solid, NULL, &r) == JALI_OK);
        REQUIRE(r.solid);
        jali_mesh_free(ctx, &solid);
        jali_shell_free(ctx, &shell);
    }
    jali_surface_free(ctx, &s);
    jali_surface_report_free(ctx, &found);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    jali_context_options opt = jali_context_defaults();
    jali_context *ctx;
    opt.threads = 1;
    if (size == 0) return -1;
    REQUIRE(jali_context_create(&opt, &ctx) == JALI_OK);
    if (data[0] < 128)
        try_description(ctx, data, size);
    else
        try_ball(ctx, (bytes_left){data + 1, data + size});
    jali_context_free(ctx);
    return 0;
}
