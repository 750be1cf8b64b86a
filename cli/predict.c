// jali predict PICTURE: what a printer would make of a picture, or of a mask, as it is.
#include "figures.h"
#include "outputs.h"

// Of the map; a larger print is shrunk.
enum { MOST_MAP_PX = 4000 };

static jali_status predict_json(jali_context *ctx, const settings *set, const jali_picture *picture,
                                const jali_result *r, jali_bytes *json)
{
    double width_mm = set->make.place.width_mm > 0
                          ? set->make.place.width_mm
                          : set->make.place.height_mm * picture->width_px / picture->height_px;
    json_t *figures = json_pack("{s:i, s:{s:i, s:i, s:i, s:i}, s:[f, f], s:o, s:o, s:f}", "version", 1,
                                "input", "width_px", picture->width_px, "height_px", picture->height_px,
                                "white_components", r->input_pieces, "threshold", r->threshold, "size_mm",
                                width_mm, width_mm * picture->height_px / picture->width_px, "printer",
                                printer_of(set), "predict", print_of(&r->input_print, set->make.recall),
                                "peak_memory_mb", (double)jali_peak_memory_bytes(ctx) / 1e6);
    return append_json(ctx, figures, json);
}

static void tell(const settings *set, const jali_result *r)
{
    const jali_prediction *p = &r->input_print;
    say(set, "%.2f %% of it would come out wrong, in %d piece%s (%d in the picture)", 100 * p->error_rate,
        p->pieces, p->pieces == 1 ? "" : "s", r->input_pieces);
    if (set->make.recall)
        say(set, "of its fine detail %.0f %% of the solid and %.0f %% of the void would be there",
            100 * p->recall_white, 100 * p->recall_black);
}

jali_status run_predict(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_picture picture = {0};
    jali_result r = {0};
    jali_bytes map = {0}, json = {0};
    output out[MOST_OUTPUTS + 1];
    int32_t count = 0;
    TRY(load_picture(ctx, set, &picture));
    TRY(jali_predict_picture(ctx, &picture, &set->make, &r));
    if (set->output_count > 0) TRY(jali_error_map(ctx, &r.input, &r.input_print.printed, MOST_MAP_PX, &map));
    for (int32_t i = 0; i < set->output_count; i++) out[count++] = (output){set->output[i], &map};
    if (set->json) {
        TRY(predict_json(ctx, set, &picture, &r, &json));
        out[count++] = (output){set->json, &json};
    }
    TRY(write_outputs(ctx, out, count));
    tell(set, &r);
done:
    jali_picture_free(ctx, &picture);
    jali_result_free(ctx, &r);
    jali_bytes_free(ctx, &map);
    jali_bytes_free(ctx, &json);
    return status;
}
