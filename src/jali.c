// The whole pipeline. Read this first.
//
//     picture -> threshold -> place -> optimise -> trace -> carve -> check
//                                 \___ predict ___/
#include <jali/jali.h>
#include "raster/raster.h"
#include "base/base.h"

#include <time.h>

const char *jali_stage_name(int32_t stage)
{
    static const char *const name[JALI_STAGES] = {"threshold", "place", "optimise", "predict",
                                                  "trace",     "carve", "check"};
    return stage >= 0 && stage < JALI_STAGES ? name[stage] : "";
}

jali_options jali_defaults(void)
{
    jali_options opt = {.threshold = jali_threshold_defaults(),
                        .place = jali_place_defaults(),
                        .optimise = jali_optimise_defaults(),
                        .trace = jali_trace_defaults(),
                        .carve = jali_carve_defaults(),
                        .predict = true,
                        .recall = true,
                        .solid = true,
                        .check = true};
    opt.place.frame_mm = opt.carve.frame_mm = 2;
    return opt;
}

void jali_result_free(jali_context *ctx, jali_result *result)
{
    jali_bitmap_free(ctx, &result->input);
    jali_optimised_free(ctx, &result->optimised);
    jali_prediction_free(ctx, &result->input_print);
    jali_prediction_free(ctx, &result->connected_print);
    jali_prediction_free(ctx, &result->result_print);
    jali_contours_free(ctx, &result->contours);
    jali_mesh_free(ctx, &result->mesh);
    *result = (jali_result){0};
}

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// One truth for what several stages need to know.
static jali_options agreed(const jali_options *given)
{
    jali_options opt = given ? *given : jali_defaults();
    opt.place.phi_e_mm = opt.optimise.phi_e_mm;
    opt.place.phi_s_mm = opt.optimise.phi_s_mm;
    opt.place.phi_v_mm = opt.optimise.phi_v_mm;
    opt.place.paper = opt.optimise.paper;
    opt.carve.frame_mm = opt.place.frame_mm;
    return opt;
}

static jali_status black_and_white(jali_context *ctx, jali_picture *picture, const jali_options *opt,
                                   jali_result *r)
{
    jali_status status;
    components pieces = {0};
    TRY(jali_threshold(ctx, picture, &opt->threshold, &r->threshold));
    TRY(jali_binarise(ctx, picture, r->threshold, &r->input));
    TRY(label_components(ctx, &r->input, true, 4, &pieces));
    r->input_pieces = pieces.count;
done:
    components_free(ctx, &pieces);
    return status;
}

// The picture at its own resolution in a margin of what surrounds it.
static jali_status framed(jali_context *ctx, const jali_bitmap *picture, bool outside_solid,
                          int32_t margin_px, jali_bitmap *out)
{
    jali_status status =
        jali_bitmap_create(ctx, picture->width_px + 2 * margin_px, picture->height_px + 2 * margin_px, out);
    if (status != JALI_OK) return status;
    fill(ctx, out, outside_solid);
    paste(picture, margin_px, margin_px, out);
    return JALI_OK;
}

// What the printer makes of the picture as it is, of the picture connected and no more, and of the result.
static jali_status predict(jali_context *ctx, const jali_options *opt, jali_result *r)
{
    jali_status status;
    enum { MARGIN_PX = 16 };
    bool outside = r->chart.outside_solid;
    jali_reference reference = {0};
    jali_bitmap plain = {0};
    jali_predict_options p = {.phi_e_mm = opt->optimise.phi_e_mm,
                              .phi_s_mm = opt->optimise.phi_s_mm,
                              .phi_v_mm = opt->optimise.phi_v_mm,
                              .recall = opt->recall};
    p.picture_mm = jali_chart_pixel_mm(&r->chart) * (r->chart.width_px - 2 * r->chart.margin_px);
    TRY(step(ctx, "predict", 0));
    TRY(jali_reference_create(ctx, &r->input, &p, &reference));
    TRY(framed(ctx, &r->input, outside, MARGIN_PX, &plain));
    TRY(jali_predict(ctx, &reference, &plain, MARGIN_PX, outside, &p, &r->input_print));
    TRY(jali_connect(ctx, &plain, NULL, &plain, NULL));
    TRY(jali_predict(ctx, &reference, &plain, MARGIN_PX, outside, &p, &r->connected_print));
    TRY(jali_predict(ctx, &reference, &r->optimised.mask, r->chart.margin_px, outside, &p, &r->result_print));
done:
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &plain);
    return status;
}

static jali_status judge_mask(jali_context *ctx, const jali_options *opt, jali_result *r)
{
    components pieces;
    jali_status status = label_components(ctx, &r->optimised.mask, true, 4, &pieces);
    const jali_round *left = &r->optimised.residual;
    r->one_piece = pieces.count == 1 && (!opt->predict || r->result_print.pieces == 1);
    r->printable = left->white[JALI_TYPE_A] + left->white[JALI_TYPE_B] + left->black[JALI_TYPE_A] +
                       left->black[JALI_TYPE_B] ==
                   0;
    components_free(ctx, &pieces);
    return status;
}

jali_status jali_make(jali_context *ctx, jali_picture *picture, const jali_options *given, jali_result *r)
{
    jali_status status;
    jali_options opt = agreed(given);
    jali_bitmap drawing = {0};
    jali_contours outline = {0};
    double begun = now_seconds();
    *r = (jali_result){0};
#define LAP(stage)                                                                                           \
    do {                                                                                                     \
        double t = now_seconds();                                                                            \
        r->seconds[stage] = t - begun;                                                                       \
        begun = t;                                                                                           \
    } while (0)

    TRY(black_and_white(ctx, picture, &opt, r));
    LAP(JALI_STAGE_THRESHOLD);
    TRY(jali_place(ctx, picture, r->threshold, &opt.place, &r->chart, &drawing));
    LAP(JALI_STAGE_PLACE);
    TRY(jali_optimise(ctx, &drawing, &r->chart, &opt.optimise, &r->optimised));
    LAP(JALI_STAGE_OPTIMISE);
    if (opt.predict) TRY(predict(ctx, &opt, r));
    TRY(judge_mask(ctx, &opt, r));
    LAP(JALI_STAGE_PREDICT);
    if (opt.solid) {
        TRY(jali_trace(ctx, &r->optimised.mask, &r->chart, &opt.trace, &outline));
        TRY(jali_plate(ctx, &outline, &r->chart, &opt.carve, &r->contours));
        LAP(JALI_STAGE_TRACE);
        TRY(jali_carve(ctx, &outline, &r->chart, &opt.carve, &r->mesh));
        LAP(JALI_STAGE_CARVE);
        if (opt.check) {
            TRY(jali_check(ctx, &r->mesh, NULL, &r->check));
            r->closed = r->check.solid;
            r->one_piece = r->one_piece && r->check.pieces == 1;
        }
        LAP(JALI_STAGE_CHECK);
    }
done:
    if (status != JALI_OK) jali_result_free(ctx, r);
    jali_bitmap_free(ctx, &drawing);
    jali_contours_free(ctx, &outline);
    return status;
}
