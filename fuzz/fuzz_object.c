// Any bytes as a surface, a placement and a bitmap, through jali_make_on: what comes out is a sound solid
// that reads back, or a sentence.
//
// Layout: 20 bytes of parameters (see surface_of, placement), then pixels as in drawn.h.
#include "drawn.h"
#include "plain.h"

#include <math.h>
#include <stdio.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { PARAMETERS = 20, MOST_SIDE_PX = 64 };

// A coarse shape of some 20 mm, dented by waves, sheared, with some triangles taken out.
static jali_status surface_of(jali_context *ctx, const uint8_t *p, jali_surface *surface)
{
    static const char *const shapes[] = {
        "sphere:r=10,facets=%d", "cylinder:r=9,h=24,facets=%d", "cone:r=12,top=5,h=24,floor=yes,facets=%d",
        "vase:h=30,facets=%d",   "vase:bottle,h=40,facets=%d",  "plate:w=24,h=24"};
    char words[80];
    snprintf(words, sizeof words, shapes[p[0] % 6], 8 + p[1] % 57);
    jali_status status = jali_surface_make(ctx, words, NULL, surface);
    if (status != JALI_OK) return status;
    double depth = p[2] % 4 ? 0.02 * (p[2] % 16) : 0, wave = 2 + p[3] % 16,
           shear = p[4] % 3 ? 0 : 0.05 * (p[4] % 10);
    jali_mesh *mesh = &surface->mesh;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        double *at = mesh->vertex[v], dent = 1 + depth * sin(6 * at[0] / wave + p[5]) * sin(6 * at[2] / wave);
        at[0] = at[0] * dent + shear * at[2];
        at[1] *= dent;
    }
    for (int32_t i = 0; i < p[6] % 4 && mesh->triangle_count > 8; i++) { // holes: each opens a rim
        int32_t gone = (p[7] * 31 + i * 17) % mesh->triangle_count, last = --mesh->triangle_count;
        memcpy(mesh->triangle[gone], mesh->triangle[last], sizeof *mesh->triangle);
        if (surface->uv) memcpy(surface->uv[gone], surface->uv[last], sizeof *surface->uv);
    }
    return JALI_OK;
}

static jali_options placement(const uint8_t *p, int32_t width_px)
{
    jali_options opt = jali_defaults();
    opt.optimise.phi_s_mm = opt.optimise.phi_v_mm = 0.2 + 0.1 * (p[8] % 8);
    opt.optimise.epsilon_mm = opt.optimise.phi_s_mm * (1 + p[9] % 8);
    opt.place.width_mm = 0.05 * (4 + p[10] % 60) * width_px / 4;
    opt.place.frame_mm = 0.1 * (p[11] % 30);
    opt.place.placing = (jali_placing)(p[12] % 3);
    opt.place.at_given = p[12] & 64;
    opt.place.camera.perspective = opt.place.at_given && p[12] & 32;
    for (int k = 0; k < 3; k++) {
        opt.place.at_mm[k] = (p[13 + k] - 128) / 8.0;
        opt.place.camera.direction[k] = p[16] % 4 ? 0 : (p[13 + (k + 1) % 3] - 128) / 64.0;
        opt.place.camera.from[k] = (p[16 + k % 3] - 128) / 2.0;
    }
    opt.repeat = p[17] % 8 == 0 ? 2 : 0;
    opt.backing_mm = p[18] % 4 == 0 ? 0.3 : 0;
    opt.predict = p[18] & 128;
    opt.recall = false;
    return opt;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < PARAMETERS) return -1;
    jali_context_options own = jali_context_defaults();
    own.threads = 1 + data[19] % 3;
    own.max_memory_bytes = (uint64_t)1 << 30;
    jali_context *ctx;
    REQUIRE(jali_context_create(&own, &ctx) == JALI_OK);
    int32_t width = 2 + data[19] / 3 % MOST_SIDE_PX, height = 2 + data[18] / 2 % MOST_SIDE_PX;
    jali_picture picture = {.width_px = width,
                            .height_px = height,
                            .grey = grey_of(data + PARAMETERS, size - PARAMETERS, width, height)};
    jali_options opt = placement(data, width);
    jali_shell_options wall = {0.2 + 0.1 * (data[9] / 8), 0.02};
    jali_surface surface = {0};
    jali_result result = {0};
    jali_object object = {0};
    REQUIRE(surface_of(ctx, data, &surface) == JALI_OK);
    jali_status status = jali_make_on(ctx, &surface, &wall, &picture, &opt, 1, &result, &object);
    REQUIRE(surface.mesh.vertex == NULL);
    if (status == JALI_OK) {
        REQUIRE(object.closed && object.check.solid);
        REQUIRE(result.printable || result.wall_mm < opt.optimise.phi_s_mm);
        require_sound(&object.mesh);
        require_read_back(ctx, &object.mesh, JALI_FORMAT_STL);
    } else {
        REQUIRE(status == JALI_BAD_INPUT || status == JALI_BAD_VALUE || status == JALI_NO_RESULT ||
                status == JALI_LIMIT);
        REQUIRE(strlen(jali_message(ctx)) > 0 && object.mesh.vertex == NULL);
    }
    jali_result_free(ctx, &result);
    jali_object_free(ctx, &object);
    free(picture.grey);
    jali_context_free(ctx);
    return 0;
}
