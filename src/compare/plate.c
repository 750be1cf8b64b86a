// The plate that should have come out, and the figures of the one that did.
//
// Checked: tests/test_compare.c.
#include "compare/plate.h"
#include "raster/raster.h"

#include <math.h>

static const double AROUND_MM = 1; // what is looked at beyond the plate's edge

void jali_comparison_free(jali_context *ctx, jali_comparison *comparison)
{
    jali_prediction_free(ctx, &comparison->print);
    jali_bitmap_free(ctx, &comparison->plate);
    *comparison = (jali_comparison){0};
}

static jali_status check_options(jali_context *ctx, const jali_reference *reference,
                                 const jali_compare_options *opt)
{
    if (!reference->picture.word) return fail(ctx, JALI_BAD_VALUE, "a comparison needs a picture");
    if (!(opt->picture_mm[0] > 0 && opt->picture_mm[1] > 0 && opt->picture_mm[0] <= 1e4 &&
          opt->picture_mm[1] <= 1e4 && opt->frame_mm >= 0 && opt->frame_mm <= 1000 && opt->phi_s_mm >= 0))
        return fail(
            ctx, JALI_BAD_VALUE,
            "a picture of %g x %g mm in a frame of %g mm: sizes above 0 and a frame of 0 to 1000 mm are "
            "accepted",
            opt->picture_mm[0], opt->picture_mm[1], opt->frame_mm);
    return JALI_OK;
}

jali_status draw_wanted(jali_context *ctx, const jali_reference *reference, const jali_compare_options *opt,
                        plate_frame *f, jali_bitmap *plate)
{
    const jali_bitmap *picture = &reference->picture;
    jali_status status = check_options(ctx, reference, opt);
    if (status != JALI_OK) return status;
    const int32_t size[2] = {picture->width_px, picture->height_px};
    int32_t all[2];
    for (int k = 0; k < 2; k++) {
        f->pixel_mm[k] = opt->picture_mm[k] / size[k];
        f->frame_px[k] = (int32_t)lround(opt->frame_mm / f->pixel_mm[k]);
        f->around_px[k] = opt->frame_mm > 0 ? (int32_t)lround(AROUND_MM / f->pixel_mm[k]) : 0;
        all[k] = size[k] + 2 * (f->frame_px[k] + f->around_px[k]);
    }
    status = jali_bitmap_create(ctx, all[0], all[1], plate);
    if (status != JALI_OK) return status;
    for (int32_t y = f->around_px[1]; opt->frame_mm > 0 && y < all[1] - f->around_px[1]; y++)
        paint_run(plate, y, f->around_px[0], all[0] - f->around_px[0], true);
    paste(ctx, picture, f->frame_px[0] + f->around_px[0], f->frame_px[1] + f->around_px[1], plate);
    return JALI_OK;
}

// Components at least as large as a disc of phi_s.
static jali_status count_pieces(jali_context *ctx, const jali_bitmap *plate, double least_px, int32_t *pieces)
{
    jali_status status;
    components c = {0};
    int64_t *area = NULL;
    *pieces = 0;
    TRY(label_components(ctx, plate, true, 4, &c));
    TRY(component_areas(ctx, &c, &area));
    for (int32_t i = 0; i < c.count; i++) *pieces += (double)area[i] >= least_px;
done:
    release(ctx, area);
    components_free(ctx, &c);
    return status;
}

jali_status measure_plate(jali_context *ctx, const jali_reference *reference, const jali_compare_options *opt,
                          const plate_frame *f, jali_comparison *c)
{
    jali_status status;
    double disc_px = M_PI / 4 * opt->phi_s_mm * opt->phi_s_mm / (f->pixel_mm[0] * f->pixel_mm[1]);
    TRY(jali_bitmap_create(ctx, reference->picture.width_px, reference->picture.height_px,
                           &c->print.printed));
    cut_out(ctx, &c->plate, f->frame_px[0] + f->around_px[0], f->frame_px[1] + f->around_px[1], &c->print.printed);
    TRY(jali_measure(ctx, reference, &c->print));
    TRY(count_pieces(ctx, &c->plate, disc_px, &c->print.pieces));
done:
    return status;
}
