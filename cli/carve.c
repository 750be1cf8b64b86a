// jali carve PICTURE and jali adapt PICTURE: the whole pipeline, or its image stages alone.
#include "outputs.h"
#include "base/bytes.h"

#include <stdio.h>

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strcmp(path, "-") == 0 ? "stdin" : slash ? slash + 1 : path;
}

// The parameters that make the object again, for those who find it later.
static jali_status describe(jali_context *ctx, const settings *set, const jali_result *r, jali_bytes *text)
{
    const jali_optimise_options *printer = &set->make.optimise;
    double pixel_mm = jali_chart_pixel_mm(&r->chart);
    char words[256];
    snprintf(words, sizeof words,
             "jali %s: %.4g x %.4g mm, phi %g / %g / %g mm, frame %g mm, thickness %g mm%s", jali_version(),
             (r->chart.width_px - 2 * r->chart.margin_px) * pixel_mm,
             (r->chart.height_px - 2 * r->chart.margin_px) * pixel_mm, printer->phi_e_mm, printer->phi_s_mm,
             printer->phi_v_mm, set->make.place.frame_mm, set->make.carve.thickness_mm,
             printer->paper ? ", the paper's method" : "");
    return bytes_append(ctx, text, words, strlen(words) + 1);
}

static jali_status without_margin(jali_context *ctx, const jali_bitmap *mask, int32_t margin,
                                  jali_bitmap *picture)
{
    jali_status status =
        jali_bitmap_create(ctx, mask->width_px - 2 * margin, mask->height_px - 2 * margin, picture);
    if (status != JALI_OK) return status;
    for (int32_t y = 0; y < picture->height_px; y++)
        for (int32_t x = 0; x < picture->width_px; x++)
            if (jali_bitmap_get(mask, x + margin, y + margin)) jali_bitmap_set(picture, x, y, true);
    return JALI_OK;
}

static jali_status make_bytes(jali_context *ctx, const settings *set, const jali_result *r, const char *path,
                              jali_bytes *bytes)
{
    jali_status status;
    jali_bytes parameters = {0};
    jali_bitmap picture = {0};
    jali_format format = strcmp(path, "-") != 0 ? jali_format_of(path)
                         : set->make.solid      ? JALI_FORMAT_3MF
                                                : JALI_FORMAT_PNG;
    jali_product product = {.pixel_mm = jali_chart_pixel_mm(&r->chart)};
    jali_write_options opt = jali_write_defaults();
    TRY(describe(ctx, set, r, &parameters));
    if (format == JALI_FORMAT_PNG) TRY(without_margin(ctx, &r->optimised.mask, r->chart.margin_px, &picture));
    opt.title = name_of(set->operand);
    opt.parameters = (const char *)parameters.data;
    product.mesh = &r->mesh;
    product.contours = &r->contours;
    product.bitmap = &picture;
    TRY(jali_write_bytes(ctx, format, &product, &opt, bytes));
done:
    jali_bitmap_free(ctx, &picture);
    jali_bytes_free(ctx, &parameters);
    return status;
}

static jali_status write_everything(jali_context *ctx, const settings *set, const jali_picture *picture,
                                    const jali_result *r)
{
    jali_status status = JALI_OK;
    jali_bytes bytes[MOST_OUTPUTS + 2] = {0};
    output out[MOST_OUTPUTS + 2];
    int32_t count = 0;
    for (int32_t i = 0; i < set->output_count; i++) {
        TRY(make_bytes(ctx, set, r, set->output[i], &bytes[count]));
        out[count] = (output){set->output[i], &bytes[count]};
        count++;
    }
    if (set->json) {
        TRY(figures_json(ctx, set, picture, r, &bytes[count]));
        out[count] = (output){set->json, &bytes[count]};
        count++;
    }
    if (set->report) {
        TRY(report_html(ctx, set, picture, r, &bytes[count]));
        out[count] = (output){set->report, &bytes[count]};
        count++;
    }
    TRY(write_outputs(ctx, out, count));
done:
    for (int32_t i = 0; i < MOST_OUTPUTS + 2; i++) jali_bytes_free(ctx, &bytes[i]);
    return status;
}

static void tell(jali_context *ctx, const settings *set, const jali_picture *picture, const jali_result *r)
{
    double seconds = 0;
    for (int32_t i = 0; i < JALI_STAGES; i++) seconds += r->seconds[i];
    say(set, "%d x %d px in %d white piece%s; %d bridge%s laid", picture->width_px, picture->height_px,
        r->input_pieces, r->input_pieces == 1 ? "" : "s", r->optimised.bridges,
        r->optimised.bridges == 1 ? "" : "s");
    if (set->make.predict)
        say(set, "predicted print: %.2f %% of it wrong (%.2f %% when only connected), %d piece%s",
            100 * r->result_print.error_rate, 100 * r->connected_print.error_rate, r->result_print.pieces,
            r->result_print.pieces == 1 ? "" : "s");
    if (set->make.solid)
        say(set, "%d triangles, %.4g cm3, %s", r->mesh.triangle_count, r->check.volume_mm3 / 1000,
            r->closed ? "closed and manifold" : "not a solid");
    say(set, "%.2f s, %.0f MB", seconds, (double)jali_peak_memory_bytes(ctx) / 1e6);
}

static jali_status keep_promises(jali_context *ctx, const settings *set, const jali_result *r)
{
    bool closed = !set->make.solid || r->closed;
    if (r->one_piece && r->printable && closed) return JALI_OK;
    return fail(ctx, JALI_BROKEN, "done, but a promise is not kept:%s%s%s",
                r->one_piece ? "" : " it is not one piece;",
                r->printable ? "" : " some details are below the printer's widths;",
                closed ? "" : " the mesh is not a solid;");
}

static jali_status make(jali_context *ctx, const settings *set, bool solid)
{
    jali_status status;
    jali_picture picture = {0};
    jali_result result = {0};
    settings own = *set;
    own.make.solid = solid;
    own.make.optimise.details = set->report || set->json;
    TRY(load_picture(ctx, &own, &picture));
    TRY(jali_make(ctx, &picture, &own.make, &result));
    TRY(write_everything(ctx, &own, &picture, &result));
    tell(ctx, &own, &picture, &result);
    status = keep_promises(ctx, &own, &result);
done:
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &picture);
    return status;
}

jali_status run_carve(jali_context *ctx, const settings *set)
{
    return make(ctx, set, true);
}

jali_status run_adapt(jali_context *ctx, const settings *set)
{
    return make(ctx, set, false);
}
