// jali read PICTURE: the picture in grey as the other verbs see it before the threshold, and its grey levels.
#include "figures.h"
#include "outputs.h"

static jali_status levels_json(jali_context *ctx, const jali_picture *picture, const jali_levels *levels,
                               jali_bytes *json)
{
    json_t *counts = json_array();
    for (int32_t v = 0; v < 256; v++)
        json_array_append_new(counts, json_integer((json_int_t)levels->count[v]));
    json_t *automatic = levels->automatic ? json_integer(levels->automatic) : json_null();
    return append_json(ctx,
                       json_pack("{s:i, s:{s:i, s:i}, s:o, s:o}", "version", 1, "input", "width_px",
                                 picture->width_px, "height_px", picture->height_px, "threshold_auto",
                                 automatic, "levels", counts),
                       json);
}

jali_status run_read(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_picture picture = {0};
    jali_levels levels;
    jali_bytes png = {0}, json = {0};
    output out[MOST_OUTPUTS + 1];
    int32_t count = 0;
    TRY(load_picture(ctx, set, &picture));
    TRY(jali_count_levels(ctx, &picture, &levels));
    if (set->output_count > 0)
        TRY(jali_grey_png(ctx, picture.width_px, picture.height_px, picture.grey, &png));
    for (int32_t i = 0; i < set->output_count; i++) out[count++] = (output){set->output[i], &png};
    if (set->json) {
        TRY(levels_json(ctx, &picture, &levels, &json));
        out[count++] = (output){set->json, &json};
    }
    TRY(write_outputs(ctx, out, count));
    if (levels.automatic)
        say(set, "%d x %d px; --threshold auto is %d", picture.width_px, picture.height_px, levels.automatic);
    else
        say(set, "%d x %d px, all of one grey level", picture.width_px, picture.height_px);
done:
    jali_picture_free(ctx, &picture);
    jali_bytes_free(ctx, &png);
    jali_bytes_free(ctx, &json);
    return status;
}
