// The picture's error and recall under the forward model of the printer (model.c), on a grid finer than the
// picture.
//
// Source:  Binary Image Carving for 3D Printing, section 6 (Figs. 6, 11, 14).
// Checked: tests/test_predict.c.
#include "predict/model.h"

#include <math.h>

// A picture of few pixels is split further: on a grid this coarse a bar of phi_s may be a pixel too thin.
static const double COARSE_PX_PER_PHI_S = 8;
static const double COARSE_PX_STRETCHED = 4; // across an ellipse where the surface is stretched
static const double FINE_PX_PER_PHI_S = 32;  // finer than this gains nothing: 1/32 of the thinnest feature

jali_predict_options jali_predict_defaults(void)
{
    return (jali_predict_options){
        .phi_e_solid_mm = 0.1, .phi_e_void_mm = 0.1, .phi_s_mm = 0.3, .phi_v_mm = 0.5, .recall = true};
}

jali_predict_options jali_predict_of(const jali_printer *printer)
{
    jali_predict_options opt = jali_predict_defaults();
    opt.phi_e_solid_mm = printer->phi_e_solid_mm.value;
    opt.phi_e_void_mm = printer->phi_e_void_mm.value;
    opt.phi_s_mm = printer->phi_s_mm.value;
    opt.phi_v_mm = printer->phi_v_mm.value;
    opt.hole_mm2 = printer->hole_mm2.value;
    opt.corner_mm = printer->corner_mm.value;
    return opt;
}

static jali_status check_options(jali_context *ctx, const jali_predict_options *opt)
{
    const struct {
        const char *name;
        double value, least;
        bool least_is_in;
    } figure[] = {
        {"phi_e of solids", opt->phi_e_solid_mm, -1000, true},
        {"phi_e of voids", opt->phi_e_void_mm, -1000, true},
        {"the width of narrow voids", opt->narrow_mm, 0, true},
        {"phi_s", opt->phi_s_mm, 0, false},
        {"phi_v", opt->phi_v_mm, 0, false},
        {"the growth of holes", opt->hole_mm2, 0, true},
        {"the radius of corners", opt->corner_mm, 0, true},
    };
    for (size_t i = 0; i < sizeof figure / sizeof *figure; i++) {
        double value = figure[i].value, least = figure[i].least;
        if (!(figure[i].least_is_in ? value >= least : value > least) || !(value <= 1000))
            return fail(ctx, JALI_BAD_VALUE, "%s is %g; %s %g and up to 1000 is accepted", figure[i].name,
                        value, figure[i].least_is_in ? "from" : "more than", least);
    }
    return JALI_OK;
}

static int32_t choose_factor(double pixel_mm, double phi_s_mm, double most_stretch)
{
    double span_px = phi_s_mm / pixel_mm;
    int32_t factor = 1;
    while (factor < 4 && span_px * factor < FINE_PX_PER_PHI_S) factor *= 2;
    span_px = fmin(span_px, span_px / most_stretch * (COARSE_PX_PER_PHI_S / COARSE_PX_STRETCHED));
    while (factor < 256 && span_px * factor < COARSE_PX_PER_PHI_S) factor *= 2;
    return factor;
}

jali_status jali_reference_create(jali_context *ctx, const jali_bitmap *picture,
                                  const jali_predict_options *opt, jali_reference *reference)
{
    jali_status status;
    *reference = (jali_reference){0};
    if (!(opt->picture_mm > 0) || !picture->word)
        return fail(ctx, JALI_BAD_VALUE, "a prediction needs a picture with a width in mm above 0");
    int32_t factor =
        choose_factor(opt->picture_mm / picture->width_px, opt->phi_s_mm, most_stretch_of(opt->chart));
    reference->factor = factor;
    TRY(jali_bitmap_create(ctx, picture->width_px * factor, picture->height_px * factor,
                           &reference->picture));
    resize_nearest(ctx, picture, 0, 0, picture->width_px, picture->height_px, &reference->picture);
    if (opt->recall) {
        TRY(medial_axis(ctx, picture, true, true, 0, &reference->axis_white));
        TRY(medial_axis(ctx, picture, false, true, 0, &reference->axis_black));
        reference->axis_white_count = count_white(ctx, &reference->axis_white);
        reference->axis_black_count = count_white(ctx, &reference->axis_black);
    }
done:
    if (status != JALI_OK) jali_reference_free(ctx, reference);
    return status;
}

void jali_reference_free(jali_context *ctx, jali_reference *reference)
{
    jali_bitmap_free(ctx, &reference->picture);
    jali_bitmap_free(ctx, &reference->axis_white);
    jali_bitmap_free(ctx, &reference->axis_black);
    *reference = (jali_reference){0};
}

void jali_prediction_free(jali_context *ctx, jali_prediction *prediction)
{
    jali_bitmap_free(ctx, &prediction->printed);
    *prediction = (jali_prediction){0};
}

// Share of the axis's pixels whose centre prints in the tone.
static double recall_of(jali_context *ctx, const jali_bitmap *axis, int64_t axis_count,
                        const jali_bitmap *printed, bool white)
{
    if (axis_count == 0) return 1;
    int64_t hit = count_combined(ctx, white ? RULE_AND : RULE_AND_NOT, axis, printed);
    return (double)hit / (double)axis_count;
}

// The mask on the fine grid: the picture's part scaled exactly, the margin around it as the surroundings are.
static jali_status place_mask(jali_context *ctx, const jali_bitmap *mask, int32_t margin_px, bool outside,
                              int32_t fine_margin, jali_bitmap *fine)
{
    jali_bitmap scaled;
    jali_status status =
        jali_bitmap_create(ctx, fine->width_px - 2 * fine_margin, fine->height_px - 2 * fine_margin, &scaled);
    if (status != JALI_OK) return status;
    resize_nearest(ctx, mask, margin_px, margin_px, mask->width_px - 2 * margin_px,
                   mask->height_px - 2 * margin_px, &scaled);
    fill(ctx, fine, outside);
    paste(ctx, &scaled, fine_margin, fine_margin, fine);
    jali_bitmap_free(ctx, &scaled);
    return JALI_OK;
}

// Where the chart's pixels lie on the fine grid.
static jali_status place_metric(jali_context *ctx, const jali_chart *chart, const jali_bitmap *picture,
                                int32_t fine_margin, tiling *tiles)
{
    double scale = chart ? (double)picture->width_px / (chart->width_px - 2 * chart->margin_px) : 1;
    double first = chart ? fine_margin - chart->margin_px * scale : 0;
    return tiling_create(ctx, chart, picture->width_px + 2 * fine_margin,
                         picture->height_px + 2 * fine_margin, first, first, scale, tiles);
}

// Components of the print that hold something laid. The others are specks of a fine pixel or two that the
// closing leaves between the void's discs: nothing that a printer would make.
static jali_status count_pieces(jali_context *ctx, const jali_bitmap *printed, const jali_bitmap *laid,
                                int32_t *pieces)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    components c = {0};
    bool *counted;
    *pieces = 0;
    TRY(label_components(ctx, printed, true, 4, &c));
    TRY(ARENA(ctx, counted, c.count));
    memset(counted, 0, (size_t)c.count * sizeof *counted);
    for (int32_t y = 0; y < c.height_px; y++)
        for (int32_t i = c.first[y]; i < c.first[y + 1]; i++)
            if (!counted[c.label[i]] && count_run(laid, y, c.span[i][0], c.span[i][1])) {
                counted[c.label[i]] = true;
                ++*pieces;
            }
done:
    components_free(ctx, &c);
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_measure(jali_context *ctx, const jali_reference *reference, jali_prediction *print)
{
    jali_status status;
    jali_bitmap coarse = {0};
    const jali_bitmap *picture = &reference->picture, *printed = &print->printed;
    if (printed->width_px != picture->width_px || printed->height_px != picture->height_px)
        return fail(ctx, JALI_BAD_VALUE,
                    "a print of %d x %d px cannot be measured on a picture of %d x %d px", printed->width_px,
                    printed->height_px, picture->width_px, picture->height_px);
    double all = (double)picture->width_px * picture->height_px;
    int64_t missing = count_combined(ctx, RULE_AND_NOT, picture, printed);
    int64_t excess = count_combined(ctx, RULE_AND_NOT, printed, picture);
    print->missing = (double)missing / all;
    print->excess = (double)excess / all;
    print->error_rate = (double)(missing + excess) / all;
    if (!reference->axis_white.word) return JALI_OK;
    TRY(jali_bitmap_create(ctx, reference->axis_white.width_px, reference->axis_white.height_px, &coarse));
    resize_nearest(ctx, printed, 0, 0, printed->width_px, printed->height_px, &coarse);
    print->recall_white = recall_of(ctx, &reference->axis_white, reference->axis_white_count, &coarse, true);
    print->recall_black = recall_of(ctx, &reference->axis_black, reference->axis_black_count, &coarse, false);
done:
    jali_bitmap_free(ctx, &coarse);
    return status;
}

jali_status jali_predict(jali_context *ctx, const jali_reference *reference, const jali_bitmap *mask,
                         int32_t margin_px, bool outside_solid, const jali_predict_options *opt,
                         jali_prediction *prediction)
{
    jali_status status;
    jali_bitmap fine = {0}, laid = {0};
    tiling tiles = {0};
    const jali_bitmap *picture = &reference->picture;
    *prediction = (jali_prediction){0};
    TRY(check_options(ctx, opt));
    double pixel_mm = opt->picture_mm / picture->width_px;
    double scale = (double)picture->width_px / (mask->width_px - 2 * margin_px);
    int32_t margin = (int32_t)ceil(margin_px * scale);
    TRY(jali_bitmap_create(ctx, picture->width_px + 2 * margin, picture->height_px + 2 * margin, &fine));
    TRY(place_mask(ctx, mask, margin_px, outside_solid, margin, &fine));
    TRY(place_metric(ctx, opt->chart, picture, margin, &tiles));
    TRY(print_mask(ctx, opt, &tiles, pixel_mm, outside_solid, &fine, &laid));
    TRY(count_pieces(ctx, &fine, &laid, &prediction->pieces));
    jali_bitmap_free(ctx, &laid);
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &prediction->printed));
    resize_nearest(ctx, &fine, margin, margin, picture->width_px, picture->height_px, &prediction->printed);
    TRY(jali_measure(ctx, reference, prediction));
done:
    if (status != JALI_OK) jali_prediction_free(ctx, prediction);
    jali_bitmap_free(ctx, &fine);
    jali_bitmap_free(ctx, &laid);
    tiling_free(ctx, &tiles);
    return status;
}
