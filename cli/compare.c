// jali compare PICTURE: a print against the picture it came from. The witness is G-code, an SL1 file or a
// scan.
#include "outputs.h"
#include "base/bytes.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAP_PX = 4000 }; // longer side of the map: fine enough for a tenth of a bar of phi_s

// The picture on its fine grid, and where it lies on the plate: as a carving would place it.
static jali_status prepare(jali_context *ctx, const settings *set, jali_reference *reference,
                           jali_compare_options *opt)
{
    jali_status status;
    jali_picture picture = {0};
    jali_bitmap drawing = {0}, input = {0};
    jali_chart chart = {0};
    int32_t threshold;
    jali_place_options place = set->make.place;
    const jali_optimise_options *printer = &set->make.optimise;
    jali_predict_options predict = jali_predict_defaults();
    place.phi_e_mm = printer->phi_e_mm;
    place.phi_s_mm = predict.phi_s_mm = printer->phi_s_mm;
    place.phi_v_mm = printer->phi_v_mm;
    place.paper = printer->paper;
    TRY(load_picture(ctx, set, &picture));
    TRY(jali_threshold(ctx, &picture, &set->make.threshold, &threshold));
    TRY(jali_place(ctx, &picture, threshold, &place, &chart, &drawing));
    TRY(jali_binarise(ctx, &picture, threshold, &input));
    double pixel_mm = jali_chart_pixel_mm(&chart);
    opt->picture_mm[0] = predict.picture_mm = (chart.width_px - 2 * chart.margin_px) * pixel_mm;
    opt->picture_mm[1] = (chart.height_px - 2 * chart.margin_px) * pixel_mm;
    opt->frame_mm = place.frame_mm;
    opt->phi_s_mm = printer->phi_s_mm;
    TRY(jali_reference_create(ctx, &input, &predict, reference));
done:
    jali_picture_free(ctx, &picture);
    jali_bitmap_free(ctx, &drawing);
    jali_bitmap_free(ctx, &input);
    jali_chart_free(ctx, &chart);
    return status;
}

// Exactly one witness.
static jali_status check_witness(jali_context *ctx, const settings *set)
{
    int32_t count = (set->gcode != NULL) + (set->sl1 != NULL) + (set->scan != NULL);
    if (count == 1) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE, "%s; --gcode, --sl1 or --scan names the one print to compare with",
                count == 0 ? "there is no print" : "there are several prints");
}

static jali_status compare_scan(jali_context *ctx, const settings *set, const jali_reference *reference,
                                const jali_compare_options *opt, jali_comparison *c)
{
    jali_status status;
    jali_picture scan = {0};
    TRY(jali_read(ctx, set->scan, NULL, &scan));
    TRY(jali_compare_scan(ctx, reference, &scan, opt, c));
done:
    jali_picture_free(ctx, &scan);
    return status;
}

static jali_status compare_witness(jali_context *ctx, const settings *set, const jali_reference *reference,
                                   const jali_compare_options *opt, jali_print *print, jali_comparison *c)
{
    jali_status status;
    jali_print_options how = set->print;
    if (set->scan) return compare_scan(ctx, set, reference, opt, c);
    if (set->gcode) how.pixel_mm = opt->picture_mm[0] / reference->picture.width_px; // grids that meet
    TRY(set->gcode ? jali_print_gcode(ctx, set->gcode, &how, print)
                   : jali_print_sl1(ctx, set->sl1, &how, print));
    TRY(jali_compare(ctx, reference, print, opt, c));
done:
    return status;
}

static jali_status comparison_json(jali_context *ctx, const settings *set, const jali_print *print,
                                   const jali_compare_options *opt, const jali_comparison *c,
                                   jali_bytes *json)
{
    const jali_prediction *p = &c->print;
    const char *kind = set->gcode ? "gcode" : set->sl1 ? "sl1" : "scan";
    json_t *compare = json_pack(
        "{s:s, s:s, s:f, s:f, s:f, s:f, s:f, s:f, s:i, s:f, s:i, s:b, s:[f, f]}", "witness", kind, "file",
        name_of(set->gcode ? set->gcode
                : set->sl1 ? set->sl1
                           : set->scan),
        "error_rate", p->error_rate, "missing", p->missing, "excess", p->excess, "precision_rate",
        1 - p->error_rate, "recall_white", p->recall_white, "recall_black", p->recall_black, "pieces",
        p->pieces, "agreement", c->agreement, "quarter_turns", c->quarter_turns, "mirrored", c->mirrored,
        "shift_mm", c->shift_mm[0], c->shift_mm[1]);
    if (compare && !set->scan)
        json_object_set_new(compare, "layers",
                            json_pack("{s:i, s:i, s:i, s:i}", "count", print->layers, "first", print->first,
                                      "last", print->last, "looked_at", print->looked_at));
    json_t *figures =
        json_pack("{s:i, s:s, s:[f, f], s:f, s:[f, f], s:o}", "version", 1, "picture", name_of(set->operand),
                  "size_mm", opt->picture_mm[0], opt->picture_mm[1], "frame_mm", opt->frame_mm,
                  "print_pixel_mm", print->pixel_mm[0], print->pixel_mm[1], "compare", compare);
    char *text = figures ? json_dumps(figures, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    jali_status status =
        text ? bytes_print(ctx, json, "%s\n", text) : fail(ctx, JALI_NO_MEMORY, "no memory for the figures");
    free(text);
    json_decref(figures);
    return status;
}

// The figures on stdout, unless something else is written there; what is unusual on stderr.
static void tell(const settings *set, const jali_print *print, const jali_comparison *c)
{
    const jali_prediction *p = &c->print;
    bool taken = set->json && strcmp(set->json, "-") == 0;
    for (int32_t i = 0; i < set->output_count; i++) taken |= strcmp(set->output[i], "-") == 0;
    if (!set->sl1 && (c->quarter_turns != 0 || c->mirrored)) { // screens show their layers mirrored
        const char *const turn[4] = {"", "a quarter turn clockwise", "half a turn",
                                     "a quarter turn counter-clockwise"};
        say(set, "the print lies as the picture does after %s%s%s", c->mirrored ? "mirroring" : "",
            c->mirrored && c->quarter_turns ? " and " : "", turn[c->quarter_turns]);
    }
    if (!set->scan)
        say(set, "layers %d to %d of %d looked at, %.1f x %.1f mm", print->first + 1, print->last + 1,
            print->layers, print->size_mm[0], print->size_mm[1]);
    if (taken || set->quiet) return;
    printf("error %.2f %% (missing %.2f, excess %.2f); precision %.2f %%; recall %.1f %% of white, %.1f %% "
           "of black; "
           "%d piece%s\n",
           100 * p->error_rate, 100 * p->missing, 100 * p->excess, 100 * (1 - p->error_rate),
           100 * p->recall_white, 100 * p->recall_black, p->pieces, p->pieces == 1 ? "" : "s");
}

jali_status run_compare(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_reference reference = {0};
    jali_compare_options opt;
    jali_print print = {0};
    jali_comparison c = {0};
    jali_bytes json = {0}, map = {0};
    output out[MOST_OUTPUTS + 1];
    int32_t count = 0;
    TRY(check_witness(ctx, set));
    TRY(prepare(ctx, set, &reference, &opt));
    TRY(compare_witness(ctx, set, &reference, &opt, &print, &c));
    if (set->output_count > 0) TRY(jali_error_map(ctx, &reference.picture, &c.print.printed, MAP_PX, &map));
    for (int32_t i = 0; i < set->output_count; i++) out[count++] = (output){set->output[i], &map};
    if (set->json) TRY(comparison_json(ctx, set, &print, &opt, &c, &json));
    if (set->json) out[count++] = (output){set->json, &json};
    TRY(write_outputs(ctx, out, count));
    tell(set, &print, &c);
done:
    jali_reference_free(ctx, &reference);
    jali_print_free(ctx, &print);
    jali_comparison_free(ctx, &c);
    jali_bytes_free(ctx, &json);
    jali_bytes_free(ctx, &map);
    return status;
}
