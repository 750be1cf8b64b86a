// Scans of prints whose error is known: turned, tilted, mirrored, blurred, noised, unevenly lit.
#include "testing.h"

#include <jali/jali.h>
#include "raster/raster.h"
#include "scan/homography.h"

#include <math.h>

enum { SIDE_PX = 120 };
static const double SIDE_MM = 30, FRAME_MM = 2; // of most plates

static double uniform(uint64_t *seed, double from, double to)
{
    return from + (to - from) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// A picture, its plate as printed - edges grown by 0.05 mm, a bar missing, one too many - and its true
// figures.
typedef struct subject {
    jali_bitmap picture;
    jali_reference reference;
    jali_print print;
    jali_compare_options opt;
    jali_comparison truth;
} subject;

static subject subject_of(uint64_t seed, double side_mm)
{
    enum { ROOM = 80 };
    subject s = {.picture = random_blobs(&seed, SIDE_PX, SIDE_PX - 20, 12, 50)};
    element disc;
    jali_bitmap grown;
    jali_predict_options predict = jali_predict_defaults();
    predict.picture_mm = side_mm;
    CHECK_OK(jali_reference_create(ctx, &s.picture, &predict, &s.reference));
    s.opt = (jali_compare_options){{side_mm, side_mm * (SIDE_PX - 20) / SIDE_PX}, FRAME_MM, 0.3};
    double pixel_mm = side_mm / s.reference.picture.width_px;
    int32_t frame = (int32_t)lround(FRAME_MM / pixel_mm), w = s.reference.picture.width_px,
            h = s.reference.picture.height_px;
    s.print = (jali_print){.pixel_mm = {pixel_mm, pixel_mm}};
    CHECK_OK(jali_bitmap_create(ctx, w + 2 * (frame + ROOM), h + 2 * (frame + ROOM), &s.print.solid));
    for (int32_t y = ROOM; y < s.print.solid.height_px - ROOM; y++)
        paint_run(&s.print.solid, y, ROOM, s.print.solid.width_px - ROOM, true);
    paste(ctx, &s.reference.picture, ROOM + frame, ROOM + frame, &s.print.solid);
    CHECK_OK(element_disc(ctx, 1 + 2 * floor(0.05 / pixel_mm + 0.5), &disc));
    CHECK_OK(jali_bitmap_create(ctx, s.print.solid.width_px, s.print.solid.height_px, &grown));
    CHECK_OK(dilate(ctx, &s.print.solid, &disc, false, &grown));
    jali_bitmap_free(ctx, &s.print.solid);
    s.print.solid = grown;
    element_free(ctx, &disc);
    for (int32_t y = 0; y < 20; y++) {
        paint_run(&s.print.solid, ROOM + frame + h / 3 + y, ROOM + frame + w / 2, ROOM + frame + w / 2 + 200,
                  false);
        paint_run(&s.print.solid, ROOM + frame + 2 * h / 3 + y, ROOM + frame + w / 2,
                  ROOM + frame + w / 2 + 200, true);
    }
    CHECK_OK(jali_compare(ctx, &s.reference, &s.print, &s.opt, &s.truth));
    return s;
}

static void subject_free(subject *s)
{
    jali_bitmap_free(ctx, &s->picture);
    jali_reference_free(ctx, &s->reference);
    jali_print_free(ctx, &s->print);
    jali_comparison_free(ctx, &s->truth);
}

typedef struct camera {
    double px_per_mm, turn_rad, tilt; // tilt: how far corners leave the rectangle, share of the plate
    bool mirrored, negative;
    double light, noise, blur_px;
} camera;

// The plate as a scanner or a camera sees it, on a picture with 4 mm around it.
static jali_picture photographed(const subject *s, const camera *how, uint64_t seed)
{
    enum { ACROSS = 4 };
    const jali_bitmap *a = &s->print.solid;
    double w = a->width_px * s->print.pixel_mm[0], h = a->height_px * s->print.pixel_mm[1];
    double half = hypot(w, h) / 2 * how->px_per_mm * (1 + how->tilt), c = cos(how->turn_rad),
           t = sin(how->turn_rad);
    int32_t side = (int32_t)(2 * half);
    jali_picture scan = {.width_px = side, .height_px = side};
    CHECK_OK(ALLOCATE(ctx, scan.grey, (size_t)side * (size_t)side));
    double from[4][2], to[4][2];
    for (int k = 0; k < 4; k++) {
        double x = (k == 1 || k == 2 ? 0.5 : -0.5) * w, y = (k >= 2 ? 0.5 : -0.5) * h,
               u = how->mirrored ? -x : x;
        to[k][0] = (x + w / 2) / s->print.pixel_mm[0];
        to[k][1] = (y + h / 2) / s->print.pixel_mm[1];
        from[k][0] = half + how->px_per_mm * (c * u - t * y + how->tilt * w * uniform(&seed, -0.5, 0.5));
        from[k][1] = half + how->px_per_mm * (t * u + c * y + how->tilt * w * uniform(&seed, -0.5, 0.5));
    }
    homography map;
    CHECK(homography_of_points(4, (const double(*)[2])from, (const double(*)[2])to, &map));
    for (int32_t y = 0; y < side; y++)
        for (int32_t x = 0; x < side; x++) {
            double share = 0;
            for (int i = 0; i < ACROSS * ACROSS; i++) {
                double spread = 1 + how->blur_px;
                double at[2] = {x + 0.5 + spread * ((i % ACROSS + 0.5) / ACROSS - 0.5),
                                y + 0.5 + spread * ((i / ACROSS + 0.5) / ACROSS - 0.5)};
                homography_apply(&map, at, at);
                share += at[0] >= 0 && at[1] >= 0 && at[0] < a->width_px && at[1] < a->height_px &&
                         jali_bitmap_get(a, (int32_t)at[0], (int32_t)at[1]);
            }
            share /= ACROSS * ACROSS;
            double light =
                1 + how->light * ((double)x / side - 0.5) - how->light * ((double)y / side - 0.5) / 2;
            double level = light * (how->negative ? 0.75 - 0.5 * share : 0.25 + 0.5 * share);
            level += uniform(&seed, -how->noise, how->noise);
            scan.grey[(size_t)y * (size_t)side + (size_t)x] = (uint8_t)(255 * fmin(fmax(level, 0), 1) + 0.5);
        }
    return scan;
}

TEST(a_scan_gives_the_error_that_the_print_has)
{
    static const camera cameras[] = {
        {24, 0, 0, false, false, 0, 0, 0},           // 600 dpi, flat
        {24, 0.03, 0, true, false, 0.2, 0.02, 0.5},  // face down, a little askew
        {24, 1.6, 0.01, false, true, 0.3, 0.05, 1},  // dark plate, turned
        {16, 3.3, 0.04, false, false, 0.5, 0.05, 1}, // a photograph
        {16, -0.7, 0.05, true, true, 0.4, 0.05, 1},  // from behind, askew
    };
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        subject s = subject_of(31 + i, SIDE_MM);
        jali_picture scan = photographed(&s, &cameras[i], 1000 + i);
        jali_comparison c;
        CHECK_OK(jali_compare_scan(ctx, &s.reference, &scan, &s.opt, &c));
        const jali_prediction *got = &c.print, *want = &s.truth.print;
        print_message("error %.3f of %.3f %%, missing %.3f of %.3f, recall %.1f of %.1f, agreement %.2f\n",
                      100 * got->error_rate, 100 * want->error_rate, 100 * got->missing, 100 * want->missing,
                      100 * got->recall_black, 100 * want->recall_black, c.agreement);
        CHECK(fabs(got->error_rate - want->error_rate) < 0.003);
        CHECK(fabs(got->missing - want->missing) < 0.003 && fabs(got->excess - want->excess) < 0.003);
        CHECK(fabs(got->recall_white - want->recall_white) < 0.02);
        CHECK(fabs(got->recall_black - want->recall_black) < 0.02);
        CHECK_INT(got->pieces, want->pieces);
        CHECK_INT(c.mirrored, cameras[i].mirrored);
        jali_comparison_free(ctx, &c);
        jali_picture_free(ctx, &scan);
        subject_free(&s);
    }
}

TEST(scans_that_will_not_do_are_refused_with_a_reason)
{
    subject s = subject_of(5, SIDE_MM);
    camera how = {16, 0.1, 0, false, false, 0.2, 0.02, 0.5};
    jali_comparison c;
    jali_picture scan = photographed(&s, &how, 7),
                 cut = {.width_px = scan.width_px, .height_px = scan.height_px * 6 / 10, .grey = scan.grey};
    CHECK_STATUS(jali_compare_scan(ctx, &s.reference, &cut, &s.opt, &c), JALI_NO_RESULT); // half a plate
    print_message("%s\n", jali_message(ctx));
    CHECK(c.plate.word == NULL && c.print.printed.word == NULL);
    memset(scan.grey, 200, (size_t)scan.width_px * (size_t)scan.height_px);
    CHECK_STATUS(jali_compare_scan(ctx, &s.reference, &scan, &s.opt, &c), JALI_NO_RESULT); // nothing there
    CHECK(strstr(jali_message(ctx), "not found"));
    jali_picture_free(ctx, &scan);
    how.px_per_mm = 4; // 100 dpi
    scan = photographed(&s, &how, 7);
    CHECK_STATUS(jali_compare_scan(ctx, &s.reference, &scan, &s.opt, &c), JALI_NO_RESULT);
    print_message("%s\n", jali_message(ctx));
    CHECK(strstr(jali_message(ctx), "dpi"));
    jali_picture_free(ctx, &scan);
    CHECK_STATUS(jali_compare_scan(ctx, &s.reference, &scan, &s.opt, &c), JALI_BAD_VALUE); // an empty one
    subject_free(&s);
}

typedef struct refused_scan {
    const subject *subject;
    const jali_picture *scan;
} refused_scan;

static jali_status compare_once(jali_context *limited, void *data)
{
    const refused_scan *r = data;
    jali_comparison c;
    jali_status status = jali_compare_scan(limited, &r->subject->reference, r->scan, &r->subject->opt, &c);
    jali_comparison_free(limited, &c);
    return status;
}

TEST(allocations_may_be_refused)
{
    subject s = subject_of(31, 8);
    camera how = {10, 0, 0, false, false, 0, 0, 0};
    jali_picture scan = photographed(&s, &how, 1000);
    refuse_allocations(compare_once, &(refused_scan){&s, &scan},
                       7); // of 531; test_scan.c refuses each of the parts'
    jali_picture_free(ctx, &scan);
    subject_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scan_gives_the_error_that_the_print_has),
        cmocka_unit_test(scans_that_will_not_do_are_refused_with_a_reason),
        cmocka_unit_test(allocations_may_be_refused),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
