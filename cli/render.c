// jali render MODEL: a picture of a model, and how carve and the report get theirs.
#include "outputs.h"

#include <jali/png.h>

jali_status render_png(jali_context *ctx, const jali_mesh *mesh, const jali_render_options *view,
                       int32_t size_px, jali_bytes *png)
{
    jali_status status;
    uint8_t *rgb = NULL;
    jali_render_options opt = *view;
    opt.width_px = opt.height_px = size_px;
    TRY(ALLOCATE(ctx, rgb, (size_t)size_px * (size_t)size_px * 3));
    TRY(jali_render(ctx, mesh, &opt, rgb));
    TRY(jali_rgb_png(ctx, size_px, size_px, rgb, png));
done:
    release(ctx, rgb);
    return status;
}

jali_status run_render(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_mesh mesh = {0};
    jali_bytes png = {0};
    output out[MOST_OUTPUTS];
    TRY(jali_read_model(ctx, set->operand, NULL, &mesh));
    TRY(render_png(ctx, &mesh, &set->view, set->size_px, &png));
    for (int32_t i = 0; i < set->output_count; i++) out[i] = (output){set->output[i], &png};
    TRY(write_outputs(ctx, out, set->output_count));
done:
    jali_bytes_free(ctx, &png);
    jali_mesh_free(ctx, &mesh);
    return status;
}
