// The whole pipeline. Read this first.
//
//     picture -> threshold -> place -> optimise -> nudge -> trace -> strengthen -> carve -> check
//                                 \________ predict ________/
//
// A plate is carved from its contours; a surface is hollowed out first, then each picture is pierced through
// the wall, then the wall becomes a solid.
#include <jali/jali.h>
#include "agreed.h"
#include "raster/raster.h"
#include "base/base.h"

#include <math.h>
#include <time.h>

const char *jali_stage_name(int32_t stage)
{
    static const char *const name[JALI_STAGES] = {"threshold", "place",      "optimise", "nudge", "predict",
                                                  "trace",     "strengthen", "carve",    "check"};
    return stage >= 0 && stage < JALI_STAGES ? name[stage] : "";
}

jali_options jali_defaults(void)
{
    jali_options opt = {.threshold = jali_threshold_defaults(),
                        .place = jali_place_defaults(),
                        .optimise = jali_optimise_defaults(),
                        .trace = jali_trace_defaults(),
                        .carve = jali_carve_defaults(),
                        .strengthen = jali_strengthen_defaults(),
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
    jali_chart_free(ctx, &result->chart);
    jali_optimised_free(ctx, &result->optimised);
    jali_prediction_free(ctx, &result->input_print);
    jali_prediction_free(ctx, &result->connected_print);
    jali_prediction_free(ctx, &result->result_print);
    jali_lost_free(ctx, &result->lost);
    jali_contours_free(ctx, &result->contours);
    jali_mesh_free(ctx, &result->mesh);
    jali_strength_free(ctx, &result->strength);
    *result = (jali_result){0};
}

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

jali_options agreed_options(const jali_options *given)
{
    jali_options opt = given ? *given : jali_defaults();
    if (*opt.printer.name) {
        opt.optimise.phi_e_mm = jali_printer_phi_e_mm(&opt.printer);
        opt.optimise.phi_s_mm = opt.printer.phi_s_mm.value;
        opt.optimise.phi_v_mm = opt.printer.phi_v_mm.value;
    }
    opt.place.phi_e_mm = opt.optimise.phi_e_mm;
    opt.place.phi_s_mm = opt.optimise.phi_s_mm;
    opt.place.phi_v_mm = opt.optimise.phi_v_mm;
    opt.place.paper = opt.optimise.paper;
    opt.carve.frame_mm = opt.place.frame_mm;
    opt.optimise.mark_bridges |= opt.bridge_depth_mm > 0;
    return opt;
}

// Copies side by side.
static jali_status repeated(jali_context *ctx, const jali_picture *picture, int32_t count, jali_picture *row)
{
    jali_status status;
    *row = (jali_picture){.width_px = picture->width_px * count, .height_px = picture->height_px};
    if (picture->width_px > INT32_MAX / count)
        return fail(ctx, JALI_LIMIT, "%d copies of a picture %d px wide are too many", count,
                    picture->width_px);
    TRY(ALLOCATE(ctx, row->grey, (size_t)row->width_px * (size_t)row->height_px));
    for (int32_t y = 0; y < row->height_px; y++)
        for (int32_t i = 0; i < count; i++)
            memcpy(row->grey + (size_t)y * (size_t)row->width_px + (size_t)i * (size_t)picture->width_px,
                   picture->grey + (size_t)y * (size_t)picture->width_px, (size_t)picture->width_px);
done:
    return status;
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
    paste(ctx, picture, margin_px, margin_px, out);
    return JALI_OK;
}

enum { MARGIN_PX = 16 }; // around a picture at its own resolution

jali_predict_options jali_prediction_options(const jali_options *opt)
{
    jali_predict_options p = jali_predict_of(&opt->printer);
    if (!*opt->printer.name) {
        p.phi_e_solid_mm = p.phi_e_void_mm = opt->optimise.phi_e_mm;
        p.phi_s_mm = opt->optimise.phi_s_mm;
        p.phi_v_mm = opt->optimise.phi_v_mm;
    }
    p.recall = opt->recall;
    return p;
}

jali_status jali_predict_picture(jali_context *ctx, jali_picture *picture, const jali_options *given,
                                 jali_result *r)
{
    jali_status status;
    jali_options opt = agreed_options(given);
    jali_reference reference = {0};
    jali_bitmap plain = {0};
    jali_predict_options p = jali_prediction_options(&opt);
    bool outside = opt.place.frame_mm > 0;
    *r = (jali_result){0};
    TRY(black_and_white(ctx, picture, &opt, r));
    p.picture_mm = opt.place.width_mm > 0 ? opt.place.width_mm
                                          : opt.place.height_mm * r->input.width_px / r->input.height_px;
    TRY(step(ctx, "predict", 0));
    TRY(jali_reference_create(ctx, &r->input, &p, &reference));
    TRY(framed(ctx, &r->input, outside, MARGIN_PX, &plain));
    TRY(jali_predict(ctx, &reference, &plain, MARGIN_PX, outside, &p, &r->input_print));
done:
    if (status != JALI_OK) jali_result_free(ctx, r);
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &plain);
    return status;
}

// The same, for where the picture lies.
static jali_predict_options prediction_on_chart(const jali_options *opt, const jali_chart *chart)
{
    jali_predict_options p = jali_prediction_options(opt);
    p.chart = chart;
    p.picture_mm = jali_chart_pixel_mm(chart) * (chart->width_px - 2 * chart->margin_px);
    return p;
}

static jali_status nudge(jali_context *ctx, const jali_options *opt, jali_result *r)
{
    jali_status status;
    jali_reference reference = {0};
    jali_predict_options p = prediction_on_chart(opt, &r->chart);
    p.recall = false;
    TRY(jali_reference_create(ctx, &r->input, &p, &reference));
    TRY(jali_nudge(ctx, &reference, &p, &r->chart, &opt->optimise, opt->nudge_rounds, &r->optimised,
                   &r->nudge));
done:
    jali_reference_free(ctx, &reference);
    return status;
}

jali_lost_options lost_options(const jali_options *opt, const jali_chart *chart, const jali_optimised *made,
                               int32_t picture_px)
{
    jali_lost_options what = jali_lost_defaults();
    double picture_mm = jali_chart_pixel_mm(chart) * (chart->width_px - 2 * chart->margin_px);
    double grown_mm = MAX(jali_prediction_options(opt).phi_e_void_mm, 0);
    what.bridges = made->bridge_mask.width_px > 0 ? &made->bridge_mask : NULL;
    what.margin_px = chart->margin_px;
    what.reach_px = (int32_t)(grown_mm / 2 * picture_px / picture_mm);
    return what;
}

// What the printer makes of the picture as it is, of the picture connected and no more, and of the result.
static jali_status predict(jali_context *ctx, const jali_options *opt, jali_result *r)
{
    jali_status status;
    bool outside = r->chart.outside_solid;
    jali_reference reference = {0};
    jali_bitmap plain = {0};
    jali_predict_options p = prediction_on_chart(opt, &r->chart);
    TRY(step(ctx, "predict", 0));
    TRY(jali_reference_create(ctx, &r->input, &p, &reference));
    TRY(framed(ctx, &r->input, outside, MARGIN_PX, &plain));
    TRY(jali_predict(ctx, &reference, &plain, MARGIN_PX, outside, &p, &r->input_print));
    TRY(jali_connect(ctx, &plain, NULL, &plain, NULL));
    TRY(jali_predict(ctx, &reference, &plain, MARGIN_PX, outside, &p, &r->connected_print));
    TRY(jali_predict(ctx, &reference, &r->optimised.mask, r->chart.margin_px, outside, &p, &r->result_print));
    if (opt->recall && opt->optimise.details) {
        jali_lost_options what = lost_options(opt, &r->chart, &r->optimised, r->input.width_px);
        TRY(jali_find_lost(ctx, &reference, &r->result_print, &what, &r->lost));
    }
    if (r->result_print.pieces == 0)
        status =
            fail(ctx, JALI_NO_RESULT,
                 "nothing of the picture would come out of the printer: its solid is hardly wider than %g mm "
                 "anywhere; a larger size or a finer printer would help",
                 opt->optimise.phi_s_mm);
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

// Seconds since the last lap go to a stage.
static void lap(double seconds[JALI_STAGES], int32_t stage, double *begun)
{
    double now = now_seconds();
    seconds[stage] += now - *begun;
    *begun = now;
}

// From the picture to contours: what a plate and a surface have in common. With a shell, its outer skin is
// where the picture lies.
static jali_status image_stages(jali_context *ctx, jali_picture *picture, const jali_options *opt,
                                const jali_shell *shell, jali_patch *patch, jali_contours *outline,
                                jali_result *r)
{
    jali_status status;
    jali_bitmap drawing = {0};
    jali_picture row = {0};
    jali_place_options place = opt->place;
    int32_t pieces = 0;
    jali_options own = *opt;
    jali_edits edits = {0};
    jali_wall wall = {.plate = shell ? NULL : &opt->carve, .shell = shell, .patch = patch};
    double begun = now_seconds();
    if (opt->repeat > 1) {
        TRY(repeated(ctx, picture, opt->repeat, &row));
        picture = &row;
        place.width_mm *= opt->repeat;
        if (opt->optimise.edits) {
            TRY(jali_edits_repeat(ctx, opt->optimise.edits, opt->repeat, &edits));
            own.optimise.edits = &edits;
            opt = &own;
        }
    }
    TRY(black_and_white(ctx, picture, opt, r));
    lap(r->seconds, JALI_STAGE_THRESHOLD, &begun);
    if (shell)
        TRY(jali_place_on(ctx, picture, r->threshold, &place, &shell->outer, &r->chart, patch, &drawing,
                          &r->placed));
    else
        TRY(jali_place(ctx, picture, r->threshold, &place, &r->chart, &drawing));
    lap(r->seconds, JALI_STAGE_PLACE, &begun);
    if (place.around > 0)
        TRY(jali_optimise_around(ctx, &drawing, &r->chart, place.around, &opt->optimise, &r->optimised,
                                 &pieces));
    else
        TRY(jali_optimise(ctx, &drawing, &r->chart, &opt->optimise, &r->optimised));
    lap(r->seconds, JALI_STAGE_OPTIMISE, &begun);
    if (opt->nudge_rounds) TRY(nudge(ctx, opt, r));
    lap(r->seconds, JALI_STAGE_NUDGE, &begun);
    if (opt->solid && place.around > 0)
        TRY(jali_trace_around(ctx, &r->optimised.mask, &r->chart, &opt->trace, outline));
    else if (opt->solid)
        TRY(jali_trace(ctx, &r->optimised.mask, &r->chart, &opt->trace, outline));
    lap(r->seconds, JALI_STAGE_TRACE, &begun);
    if (opt->solid && opt->structure)
        TRY(jali_strengthen(ctx, &r->chart, &wall, &opt->optimise, &opt->trace, &opt->strengthen,
                            &r->optimised, outline, &r->strength));
    lap(r->seconds, JALI_STAGE_STRENGTHEN, &begun);
    if (opt->predict) TRY(predict(ctx, opt, r));
    TRY(judge_mask(ctx, opt, r));
    if (place.around > 0) r->one_piece = pieces == 1; // its pieces are counted on the closed strip
    lap(r->seconds, JALI_STAGE_PREDICT, &begun);
done:
    jali_bitmap_free(ctx, &drawing);
    jali_edits_free(ctx, &edits);
    jali_picture_free(ctx, &row);
    return status;
}

static jali_status check_depth(jali_context *ctx, const jali_options *opt, double thickness_mm)
{
    double depth = opt->bridge_depth_mm, least = opt->optimise.phi_s_mm;
    if (depth == 0) return JALI_OK;
    if (opt->structure)
        return fail(ctx, JALI_BAD_VALUE,
                    "low bridges are not analysed: leave out either their depth or the load");
    if (!(depth >= least) || !(depth < thickness_mm))
        return fail(ctx, JALI_BAD_VALUE,
                    "bridges %g mm deep: from phi_s, %g mm, to less than the thickness, %g mm, is accepted",
                    depth, least, thickness_mm);
    return JALI_OK;
}

jali_status jali_make(jali_context *ctx, jali_picture *picture, const jali_options *given, jali_result *r)
{
    jali_status status;
    jali_options opt = agreed_options(given);
    jali_contours outline = {0}, low = {0};
    *r = (jali_result){0};
    TRY(check_depth(ctx, &opt, opt.carve.thickness_mm));
    TRY(image_stages(ctx, picture, &opt, NULL, NULL, &outline, r));
    double begun = now_seconds();
    if (opt.solid) {
        if (opt.bridge_depth_mm > 0)
            TRY(jali_trace_bridges(ctx, &r->optimised, &r->chart, opt.around, &opt.trace, &low));
        TRY(jali_plate(ctx, &outline, &r->chart, &opt.carve, &r->contours));
        if (opt.bridge_depth_mm > 0)
            TRY(jali_carve_stepped(ctx, &outline, &low, opt.bridge_depth_mm, &r->chart, &opt.carve,
                                   &r->mesh));
        else
            TRY(jali_carve(ctx, &outline, &r->chart, &opt.carve, &r->mesh));
        lap(r->seconds, JALI_STAGE_CARVE, &begun);
        if (opt.check) {
            TRY(jali_check(ctx, &r->mesh, NULL, &r->check));
            r->closed = r->check.solid;
            r->one_piece = r->one_piece && r->check.pieces == 1;
        }
        lap(r->seconds, JALI_STAGE_CHECK, &begun);
    }
done:
    if (status != JALI_OK) jali_result_free(ctx, r);
    jali_contours_free(ctx, &outline);
    jali_contours_free(ctx, &low);
    return status;
}

// --- Surfaces

void jali_object_free(jali_context *ctx, jali_object *object)
{
    jali_mesh_free(ctx, &object->mesh);
    *object = (jali_object){0};
}

// The least distance between the skins over the faces under a picture.
static double thinnest_wall(const jali_shell *shell, const jali_patch *patch)
{
    double least2 = INFINITY;
    for (int32_t i = 0; i < patch->point_count; i++) {
        const double *outer = shell->outer.mesh.vertex[patch->vertex[i]],
                     *inner = shell->inner[patch->vertex[i]];
        double sum = 0;
        for (int k = 0; k < 3; k++) sum += (outer[k] - inner[k]) * (outer[k] - inner[k]);
        least2 = MIN(least2, sum);
    }
    return sqrt(least2);
}

// The size of a picture that goes all around, copy by copy.
static jali_status go_around(jali_context *ctx, jali_options *opt, const jali_shell *shell)
{
    jali_place_options *place = &opt->place;
    if (place->width_mm != 0 || place->height_mm != 0)
        return fail(
            ctx, JALI_BAD_VALUE,
            "a picture that goes all around has the size that this gives it; leave out width and height");
    if (opt->nudge_rounds > 0 || opt->structure)
        return fail(ctx, JALI_BAD_VALUE, "a picture that goes all around can be neither %s",
                    opt->structure ? "loaded nor strengthened" : "nudged");
    if (opt->optimise.edits && opt->optimise.edits->count > 0)
        return fail(
            ctx, JALI_BAD_VALUE,
            "a picture that goes all around takes no edits by hand; with --repeat and a bar at the back it "
            "does");
    place->around = MAX(opt->repeat, 1);
    place->width_mm = shell->outer.around_mm > 0 ? shell->outer.around_mm / place->around : 1;
    return JALI_OK;
}

static jali_status pierce_one(jali_context *ctx, jali_picture *picture, const jali_options *given,
                              double thickness_mm, jali_shell *shell, jali_result *r)
{
    jali_status status;
    jali_options opt = agreed_options(given);
    jali_patch patch = {0};
    jali_contours low = {0};
    jali_place_options *place = &opt.place;
    TRY(check_depth(ctx, &opt, thickness_mm));
    if (opt.around)
        TRY(go_around(ctx, &opt, shell));
    else if (opt.repeat > 0 && place->width_mm == 0 &&
             place->height_mm == 0) // all around, with a bar at the back
        place->width_mm = shell->outer.around_mm > 0
                              ? (shell->outer.around_mm - MAX(place->frame_mm, place->phi_s_mm)) / opt.repeat
                              : jali_place_defaults().width_mm;
    TRY(image_stages(ctx, picture, &opt, shell, &patch, &r->contours, r));
    double begun = now_seconds();
    r->wall_mm = thinnest_wall(shell, &patch);
    r->printable = r->printable && r->wall_mm >= MIN(opt.optimise.phi_s_mm, thickness_mm);
    if (opt.solid && opt.bridge_depth_mm > 0)
        TRY(jali_trace_bridges(ctx, &r->optimised, &r->chart, opt.around, &opt.trace, &low));
    if (opt.solid)
        TRY(jali_pierce_stepped(ctx, &r->contours, opt.bridge_depth_mm > 0 ? &low : NULL,
                                opt.bridge_depth_mm / thickness_mm, &patch,
                                MIN(opt.backing_mm / thickness_mm, 1), shell));
    lap(r->seconds, JALI_STAGE_CARVE, &begun);
done:
    jali_patch_free(ctx, &patch);
    jali_contours_free(ctx, &low);
    return status;
}

jali_status jali_make_on(jali_context *ctx, jali_surface *surface, const jali_shell_options *given,
                         jali_picture *picture, const jali_options *opt, int32_t count, jali_result *result,
                         jali_object *object)
{
    jali_status status = JALI_OK;
    jali_shell_options wall = given ? *given : jali_shell_defaults();
    jali_shell shell = {0};
    double begun = now_seconds();
    *object = (jali_object){.one_piece = true};
    for (int32_t i = 0; i < count; i++) result[i] = (jali_result){0};
    TRY(jali_shell_create(ctx, surface, &wall, &shell, &object->wall));
    lap(object->seconds, JALI_STAGE_CARVE, &begun);
    for (int32_t i = 0; i < count; i++) {
        TRY(pierce_one(ctx, &picture[i], &opt[i], wall.thickness_mm, &shell, &result[i]));
        object->one_piece = object->one_piece && result[i].one_piece;
    }
    begun = now_seconds();
    if (count > 0 && !opt[0].solid) goto done;
    TRY(jali_shell_solid(ctx, &shell, &object->mesh));
    lap(object->seconds, JALI_STAGE_CARVE, &begun);
    TRY(jali_check(ctx, &object->mesh, NULL, &object->check));
    object->closed = object->check.solid;
    object->one_piece = object->one_piece && object->check.pieces == 1;
    lap(object->seconds, JALI_STAGE_CHECK, &begun);
done:
    jali_surface_free(ctx, surface);
    jali_shell_free(ctx, &shell);
    for (int32_t i = 0; i < count && status != JALI_OK; i++) jali_result_free(ctx, &result[i]);
    if (status != JALI_OK) jali_object_free(ctx, object);
    return status;
}
