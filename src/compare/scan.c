// A print in a scan or photograph of it.
//
//     plate from the picture -> find it in the scan -> straighten -> share of solid -> half of it is solid ->
//     measure
//
// Levels between scan pixels are interpolated, so an edge keeps its place within a pixel.
//
// Limits:  the scan is flat to the plate's upper or lower side; what is seen of its walls counts as it looks.
// Checked: tests/test_compare_scan.c.
#include "compare/plate.h"
#include "raster/raster.h"
#include "scan/align.h"

#include <math.h>

enum { FINEST_PX = 800, BAND_ROWS = 64 };
static const double LEAST_AGREEMENT = 0.5;
static const double LEAST_PX_PER_PHI_S = 3;
static const double LIGHT_MM = 4;       // the neighbourhood over which light is taken to be even
static const double MOST_UNSEEN = 1e-3; // of the plate

static jali_status check_scan(jali_context *ctx, const alignment *a, const plate_frame *f,
                              const jali_bitmap *plate, const jali_compare_options *opt)
{
    const double middle[2] = {plate->width_px / 2.0, plate->height_px / 2.0};
    if (a->agreement < LEAST_AGREEMENT)
        return fail(ctx, JALI_NO_RESULT,
                    "the plate of %.1f x %.1f mm is not found in the scan: at best they agree by %.2f of 1; "
                    "all of the "
                    "frame and a little around it should be seen, and size and frame be those of the print",
                    opt->picture_mm[0] + 2 * opt->frame_mm, opt->picture_mm[1] + 2 * opt->frame_mm,
                    a->agreement);
    double px_per_mm = homography_scale(&a->map, middle) / f->pixel_mm[0];
    if (px_per_mm * opt->phi_s_mm < LEAST_PX_PER_PHI_S)
        return fail(
            ctx, JALI_NO_RESULT,
            "the scan shows the plate at %.0f dpi: a bar of %g mm is %.1f px wide; %.0f dpi or more would do",
            25.4 * px_per_mm, opt->phi_s_mm, px_per_mm * opt->phi_s_mm,
            ceil(25.4 * LEAST_PX_PER_PHI_S / opt->phi_s_mm));
    return JALI_OK;
}

// How the plate lay: the nearest of the eight ways, as what undoes it.
static void find_way(const alignment *a, const jali_bitmap *plate, jali_comparison *c)
{
    const double from[3][2] = {{0, plate->height_px / 2.0},
                               {plate->width_px, plate->height_px / 2.0},
                               {plate->width_px / 2.0, plate->height_px}};
    double to[3][2];
    for (int i = 0; i < 3; i++) homography_apply(&a->map, from[i], to[i]);
    double x[2] = {to[1][0] - to[0][0], to[1][1] - to[0][1]};
    double down[2] = {to[2][0] - (to[0][0] + to[1][0]) / 2, to[2][1] - (to[0][1] + to[1][1]) / 2};
    c->mirrored = x[0] * down[1] - x[1] * down[0] < 0;
    int32_t quarters = (int32_t)lround(atan2(x[1], x[0]) / (M_PI / 2)) & 3; // clockwise, y down
    c->quarter_turns = c->mirrored ? (quarters + 2) & 3 : (4 - quarters) & 3;
}

typedef struct halving {
    const grey *share;
    jali_bitmap *solid;
    int64_t *unseen; // [bands]
} halving;

static void halve_band(void *shared, int32_t band)
{
    const halving *h = shared;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, h->solid->height_px); y++)
        for (int32_t x = 0; x < h->solid->width_px; x++) {
            float share = grey_at(h->share, x + 0.5, y + 0.5);
            if (share >= 0.5f) jali_bitmap_set(h->solid, x, y, true);
            h->unseen[band] += isnan(share);
        }
}

// Solid is where more than half of it is.
static jali_status halve(jali_context *ctx, const grey *share, const jali_bitmap *plate, jali_bitmap *solid)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t bands = (plate->height_px + BAND_ROWS - 1) / BAND_ROWS;
    halving h = {share, solid, NULL};
    double unseen = 0;
    TRY(jali_bitmap_create(ctx, plate->width_px, plate->height_px, solid));
    TRY(ARENA(ctx, h.unseen, bands));
    memset(h.unseen, 0, (size_t)bands * sizeof *h.unseen);
    parallel(ctx, bands, halve_band, &h);
    for (int32_t i = 0; i < bands; i++) unseen += (double)h.unseen[i];
    unseen /= (double)plate->width_px * plate->height_px;
    if (unseen > MOST_UNSEEN)
        status =
            fail(ctx, JALI_NO_RESULT,
                 "the scan ends inside the plate: %.1f %% of it, the 1 mm around it included, is not seen",
                 100 * unseen);
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_compare_scan(jali_context *ctx, const jali_reference *reference, const jali_picture *scan,
                              const jali_compare_options *opt, jali_comparison *c)
{
    jali_status status;
    jali_bitmap plate = {0};
    grey straight = {0}, drawn = {0};
    plate_frame frame;
    alignment a;
    *c = (jali_comparison){0};
    if (!scan->grey || scan->width_px < 1 || scan->height_px < 1)
        return fail(ctx, JALI_BAD_VALUE, "a comparison needs a scan");
    TRY(draw_wanted(ctx, reference, opt, &frame, &plate));
    TRY(find_in_scan(ctx, scan, &plate, FINEST_PX, &a));
    TRY(check_scan(ctx, &a, &frame, &plate, opt));
    c->agreement = a.agreement;
    find_way(&a, &plate, c);
    const double middle[2] = {plate.width_px / 2.0, plate.height_px / 2.0};
    // At least as fine as the scan is, and not twice as fine without need.
    int32_t shrink = MAX(1, (int32_t)(1 / homography_scale(&a.map, middle)));
    TRY(straighten(ctx, scan, &plate, &a.map, shrink, &straight));
    TRY(grey_of_bitmap(ctx, &plate, shrink, &drawn));
    TRY(share_of_solid(ctx, &drawn, LIGHT_MM / (frame.pixel_mm[0] * shrink), &straight));
    TRY(halve(ctx, &straight, &plate, &c->plate));
    TRY(measure_plate(ctx, reference, opt, &frame, c));
done:
    if (status != JALI_OK) jali_comparison_free(ctx, c);
    jali_bitmap_free(ctx, &plate);
    grey_free(ctx, &straight);
    grey_free(ctx, &drawn);
    return status;
}
