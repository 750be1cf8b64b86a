// What a run found, layer by layer: pictures and meshes that a program lays over one another.
//
// How:     bitmaps are PNGs of one bit on the working grid, without its margin, so that they lie pixel on
// pixel
//          over mask.png; whoever shows them chooses the colours. Meshes are plain arrays (append_mesh).
// Checked: tests/test_serve.c.
#include "layers.h"
#include "outputs.h"
#include "structure.h"
#include "base/bytes.h"

#include <jali/png.h>

enum { MOST_ERROR_PX = 1400 };

static jali_status input_png(jali_context *ctx, const made *m, jali_bytes *png)
{
    return jali_bitmap_png(ctx, &m->result[0].input, 0, png);
}

static jali_status on_grid_png(jali_context *ctx, const made *m, const jali_bitmap *found, jali_bytes *png)
{
    jali_status status;
    const jali_chart *chart = &m->result[0].chart;
    jali_bitmap picture = {0};
    if (found->width_px == 0) { // nothing was found
        TRY(jali_bitmap_create(ctx, chart->width_px - 2 * chart->margin_px,
                               chart->height_px - 2 * chart->margin_px, &picture));
    } else {
        TRY(without_margin(ctx, found, chart->margin_px, &picture));
    }
    TRY(jali_bitmap_png(ctx, &picture, jali_chart_pixel_mm(chart), png));
done:
    jali_bitmap_free(ctx, &picture);
    return status;
}

static jali_status bridges_png(jali_context *ctx, const made *m, jali_bytes *png)
{
    return on_grid_png(ctx, m, &m->result[0].optimised.bridge_mask, png);
}

static jali_status conflicts_png(jali_context *ctx, const made *m, jali_bytes *png)
{
    return on_grid_png(ctx, m, &m->result[0].optimised.conflict, png);
}

static jali_status no_prediction(jali_context *ctx)
{
    return fail(ctx, JALI_BAD_VALUE, "this file shows the predicted print, and no-predict leaves that out");
}

static jali_status print_png(jali_context *ctx, const made *m, jali_bytes *png)
{
    if (!m->set[0].make.predict) return no_prediction(ctx);
    return jali_bitmap_png(ctx, &m->result[0].result_print.printed, 0, png);
}

static jali_status lost_png(jali_context *ctx, const made *m, jali_bytes *png)
{
    if (!m->set[0].make.predict) return no_prediction(ctx);
    return jali_bitmap_png(ctx, &m->result[0].lost.where, 0, png);
}

static jali_status errors_png(jali_context *ctx, const made *m, jali_bytes *png)
{
    const jali_result *r = &m->result[0];
    if (!m->set[0].make.predict) return no_prediction(ctx);
    return jali_error_map(ctx, &r->input, &r->result_print.printed, MOST_ERROR_PX, png);
}

// "jalimesh"; how many vertices and triangles, and whether colours follow, as int32; then float32[3] a
// vertex, int32[3] a triangle, uint8[4] (red, green, blue, 255) a vertex. Little endian, like every machine
// we run on.
static jali_status append_mesh(jali_context *ctx, const jali_mesh *mesh, const uint8_t (*colour)[3],
                               jali_bytes *bytes)
{
    jali_status status;
    const int32_t head[] = {mesh->vertex_count, mesh->triangle_count, colour != NULL};
    TRY(bytes_reserve(ctx, bytes,
                      20 + (size_t)mesh->vertex_count * (colour ? 16 : 12) +
                          (size_t)mesh->triangle_count * 12));
    TRY(bytes_append(ctx, bytes, "jalimesh", 8));
    TRY(bytes_append(ctx, bytes, head, sizeof head));
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        const double *v = mesh->vertex[i];
        TRY(bytes_append(ctx, bytes, (float[3]){(float)v[0], (float)v[1], (float)v[2]}, 3 * sizeof(float)));
    }
    TRY(bytes_append(ctx, bytes, mesh->triangle, (size_t)mesh->triangle_count * sizeof *mesh->triangle));
    for (int32_t i = 0; colour && i < mesh->vertex_count; i++)
        TRY(bytes_append(ctx, bytes, (uint8_t[4]){colour[i][0], colour[i][1], colour[i][2], 255}, 4));
done:
    return status;
}

static jali_status mesh_bin(jali_context *ctx, const made *m, jali_bytes *bytes)
{
    if (!m->set[0].make.solid)
        return fail(ctx, JALI_BAD_VALUE, "there is a mesh only of what is carved, and this run adapts alone");
    return append_mesh(ctx, &m->object.mesh, NULL, bytes);
}

static jali_status map_bin(jali_context *ctx, const made *m, jali_quantity quantity, jali_bytes *bytes)
{
    jali_status status;
    const jali_strength *s = &m->result[0].strength;
    jali_mesh mesh = {0};
    uint8_t(*colour)[3] = NULL;
    if (!s->round_count)
        return fail(ctx, JALI_BAD_VALUE, "there is a map only under a load, such as force or pinch");
    jali_map_options opt = map_of(s, quantity); // the scale ends where figures.json says the largest value is
    opt.top = quantity == JALI_STRESS ? MAX(s->analysis.stress.value, opt.limit) : s->analysis.moved.value;
    TRY(jali_map_solid(ctx, &s->sheet, &s->analysis, &opt, 0, &mesh, &colour));
    TRY(append_mesh(ctx, &mesh, (const uint8_t(*)[3])colour, bytes));
done:
    jali_map_release(ctx, colour);
    jali_mesh_free(ctx, &mesh);
    return status;
}

static jali_status stress_bin(jali_context *ctx, const made *m, jali_bytes *bytes)
{
    return map_bin(ctx, m, JALI_STRESS, bytes);
}

static jali_status displacement_bin(jali_context *ctx, const made *m, jali_bytes *bytes)
{
    return map_bin(ctx, m, JALI_DISPLACEMENT, bytes);
}

// The surface before it is carved, which a run uses up: it is opened again. What follows 2 in place of
// colours: float32[3][2] a triangle, where its corners lie on the unrolled surface, and how long that is
// around.
static jali_status surface_bin(jali_context *ctx, const made *m, jali_bytes *bytes)
{
    jali_status status;
    jali_surface s = {0};
    const char *name = m->set[0].surface;
    if (!name)
        return fail(ctx, JALI_BAD_VALUE, "a plate has no surface to lay a picture on: surface says another");
    TRY(jali_surface_open(ctx, name, NULL, &s, NULL));
    TRY(append_mesh(ctx, &s.mesh, NULL, bytes));
    if (!s.uv || s.textured) goto done;
    bytes->data[16] = 2;
    TRY(bytes_reserve(ctx, bytes, (size_t)s.mesh.triangle_count * 24 + 4));
    for (int32_t t = 0; t < s.mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const double *at = s.uv[t][k];
            TRY(bytes_append(ctx, bytes, (float[2]){(float)at[0], (float)at[1]}, 2 * sizeof(float)));
        }
    TRY(bytes_append(ctx, bytes, (float[1]){(float)s.around_mm}, sizeof(float)));
done:
    jali_surface_free(ctx, &s);
    return status;
}

static const layer layers[] = {
    {"input.png", false, input_png},
    {"bridges.png", false, bridges_png},
    {"conflicts.png", true, conflicts_png},
    {"print.png", false, print_png},
    {"errors.png", false, errors_png},
    {"mesh.bin", false, mesh_bin},
    {"lost.png", true, lost_png},
    {"stress.bin", false, stress_bin},
    {"displacement.bin", false, displacement_bin},
    {"surface.bin", false, surface_bin},
};

const layer *layer_list(int32_t *count)
{
    *count = sizeof layers / sizeof *layers;
    return layers;
}

bool layers_need_details(uint32_t chosen)
{
    int32_t count;
    layer_list(&count);
    for (int32_t i = 0; i < count; i++)
        if (chosen >> i & 1 && layers[i].details) return true;
    return false;
}

int32_t layer_named(const char *name)
{
    int32_t count;
    layer_list(&count);
    for (int32_t i = 0; i < count; i++)
        if (strcmp(layers[i].name, name) == 0) return i;
    return -1;
}
