// The forward model of the printer: each figure of a profile on what it is about, bars, holes and corners of
// known size; what must hold for any mask.
#include "testing.h"

#include <jali/predict.h>
#include <jali/sample.h>
#include "raster/raster.h"

#include <math.h>

// Masks are drawn on the fine grid, 0.025 mm a pixel, in a margin of MARGIN pixels.
enum { PICTURE = 100, FINE = 4 * PICTURE, MARGIN = 40, SIDE = FINE + 2 * MARGIN };
static const double FINE_MM = 0.025;

static const uint64_t GOLDEN = UINT64_C(0xc1fab4cd3bb3cee3); // of a print by all figures

// 16 and 24 fine pixels are the narrowest, edges stay where they are.
static jali_predict_options plain_printer(void)
{
    return (jali_predict_options){.picture_mm = FINE * FINE_MM, .phi_s_mm = 0.4, .phi_v_mm = 0.6};
}

static jali_status print_in(jali_context *c, const jali_predict_options *opt, const jali_bitmap *mask,
                            bool outside, jali_prediction *p)
{
    jali_status status;
    jali_bitmap picture = {0};
    jali_reference reference = {0};
    *p = (jali_prediction){0};
    TRY(jali_bitmap_create(c, PICTURE, PICTURE, &picture));
    TRY(jali_reference_create(c, &picture, opt, &reference));
    TRY(jali_predict(c, &reference, mask, MARGIN, outside, opt, p));
done:
    jali_reference_free(c, &reference);
    jali_bitmap_free(c, &picture);
    return status;
}

static jali_bitmap printed(const jali_predict_options *opt, const jali_bitmap *mask, bool outside)
{
    jali_prediction p;
    CHECK_OK(print_in(ctx, opt, mask, outside, &p));
    CHECK_INT(p.printed.width_px, FINE);
    return p.printed;
}

// A mask by its rule, in coordinates that begin in the picture's middle.
static jali_bitmap drawn_by(bool (*white)(double x, double y, double size), double size)
{
    jali_bitmap mask;
    CHECK_OK(jali_bitmap_create(ctx, SIDE, SIDE, &mask));
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++)
            if (white(x + 0.5 - SIDE / 2, y + 0.5 - SIDE / 2, size)) jali_bitmap_set(&mask, x, y, true);
    return mask;
}

static bool bar(double x, double y, double size)
{
    (void)y;
    return fabs(x) < size / 2;
}

static bool slot(double x, double y, double size)
{
    return !bar(x, y, size);
}

static bool hole(double x, double y, double size)
{
    return hypot(x, y) > size / 2;
}

static bool square(double x, double y, double size)
{
    return fabs(x) < size / 2 && fabs(y) < size / 2;
}

// A square with a bar that leaves it to the right.
static bool flag(double x, double y, double size)
{
    return square(x, y, 160) || (x > 0 && fabs(y) < size / 2);
}

static int64_t white_in(const jali_bitmap *a)
{
    int64_t count = 0;
    for (int32_t y = 0; y < a->height_px; y++)
        for (int32_t x = 0; x < a->width_px; x++) count += jali_bitmap_get(a, x, y);
    return count;
}

// White pixels of the middle row in what the rule's mask prints as.
static int64_t across(const jali_predict_options *opt, bool (*white)(double, double, double), double size,
                      bool outside)
{
    jali_bitmap mask = drawn_by(white, size), print = printed(opt, &mask, outside);
    int64_t count = 0;
    for (int32_t x = 0; x < FINE; x++) count += jali_bitmap_get(&print, x, FINE / 2);
    jali_bitmap_free(ctx, &mask);
    jali_bitmap_free(ctx, &print);
    return count;
}

TEST(a_kerf_takes_from_solids_and_gives_to_voids)
{
    jali_predict_options opt = plain_printer();
    opt.phi_e_solid_mm = opt.phi_e_void_mm = -0.2; // 4 px a side
    for (int32_t size = 10; size < 100; size += 6) {
        CHECK_INT(across(&opt, bar, size, false), size < 16 ? 0 : size - 8);
        CHECK_INT(across(&opt, slot, size, true), FINE - (size < 24 ? 0 : size + 8));
    }
}

TEST(narrow_voids_have_a_growth_of_their_own)
{
    jali_predict_options opt = plain_printer();
    opt.narrow_mm = 2; // 80 px
    for (double of_void = -0.3; of_void < 0.35; of_void += 0.3)
        for (double of_solid = -0.1; of_solid < 0.35; of_solid += 0.2) {
            opt.phi_e_solid_mm = of_solid;
            opt.phi_e_void_mm = of_void;
            int32_t solid_px = 2 * (int32_t)lround(of_solid / 2 / FINE_MM),
                    void_px = 2 * (int32_t)lround(of_void / 2 / FINE_MM);
            for (int32_t size = 30; size < 120; size += 10) {
                CHECK_INT(across(&opt, bar, size, false), size + solid_px); // with all the void beside it
                CHECK_INT(across(&opt, slot, size, true), FINE - (size - (size < 80 ? void_px : solid_px)));
            }
        }
}

// A wide void has corners into which the disc of narrow voids does not fit: they are not narrow all the same.
TEST(corners_of_wide_voids_are_not_narrow)
{
    jali_predict_options opt = plain_printer();
    jali_bitmap mask = drawn_by(square, 200);
    invert(ctx, &mask, &mask);
    opt.phi_e_solid_mm = 0.1;
    opt.phi_e_void_mm = 0.1;
    jali_bitmap plain = printed(&opt, &mask, true);
    opt.phi_e_void_mm = -0.3;
    jali_bitmap same = printed(&opt, &mask, true);
    CHECK(same_bitmap(&plain, &same));
    jali_bitmap_free(ctx, &plain);
    jali_bitmap_free(ctx, &same);
    jali_bitmap_free(ctx, &mask);
}

// A disc's area tells its diameter to a tenth of a pixel.
static double hole_mm(const jali_predict_options *opt, double size_px)
{
    jali_bitmap mask = drawn_by(hole, size_px), print = printed(opt, &mask, true);
    double area = (double)(FINE * FINE - white_in(&print));
    jali_bitmap_free(ctx, &mask);
    jali_bitmap_free(ctx, &print);
    return 2 * sqrt(area / M_PI) * FINE_MM;
}

// Narrow is what was drawn narrow, not what the rim of a hole leaves of it.
TEST(a_small_hole_is_a_narrow_void_as_well)
{
    jali_predict_options opt = plain_printer();
    opt.phi_e_solid_mm = 0.1;
    opt.phi_e_void_mm = -0.2;
    opt.hole_mm2 = 0.2; // 0.29 mm of 0.7
    CHECK(fabs(hole_mm(&opt, 0.7 / FINE_MM) - (0.7 - 0.2 / 0.7 + 0.2)) <= 0.08);
    CHECK(fabs(hole_mm(&opt, 5 / FINE_MM) - (5 - 0.2 / 5 - 0.1)) <= 0.08); // a wide one grows as solids do
}

TEST(round_holes_shrink_the_more_the_smaller_they_are)
{
    jali_predict_options opt = plain_printer();
    opt.phi_e_solid_mm = opt.phi_e_void_mm = 0.1;
    opt.hole_mm2 = 0.3;
    for (double d_mm = 0.7; d_mm < 6; d_mm *= 1.3) {
        double want = d_mm - 0.1 - 0.3 / d_mm, got = hole_mm(&opt, d_mm / FINE_MM);
        if (fabs(got - want) > 0.08) print_error("a hole of %g mm: %g, not %g\n", d_mm, got, want);
        CHECK(fabs(got - want) <=
              0.08); // three pixels: both steps move by whole ones, slants by half of one more
    }
    opt.phi_v_mm = 0.1;
    CHECK(hole_mm(&opt, 0.5 / FINE_MM) == 0);                 // 0.3 / 0.5 is more than there is
    CHECK_INT(across(&opt, slot, 40, true), FINE - (40 - 4)); // a slot is no hole
    CHECK_INT(across(&opt, bar, 40, false), 40 + 4);
}

// How far the print of a square falls short of the corner, along the diagonal, in mm.
static double lost_at_corner(const jali_predict_options *opt, int32_t size, bool white)
{
    jali_bitmap mask = drawn_by(square, size);
    for (int64_t i = 0; !white && i < mask.stride * mask.height_px; i++) mask.word[i] = ~mask.word[i];
    for (int32_t y = 0; !white && y < SIDE; y++) // bits beyond the width are 0
        for (int32_t x = SIDE; x < mask.stride * 64; x++)
            mask.word[y * mask.stride + x / 64] &= ~((uint64_t)1 << x % 64);
    jali_bitmap print = printed(opt, &mask, !white);
    int32_t at = FINE / 2 + size / 2 - 1, lost = 0;
    while (jali_bitmap_get(&print, at - lost, at - lost) != white) lost++;
    jali_bitmap_free(ctx, &mask);
    jali_bitmap_free(ctx, &print);
    return lost * sqrt(2.0) * FINE_MM;
}

TEST(corners_come_out_as_round_as_stated)
{
    jali_predict_options opt = plain_printer();
    for (opt.corner_mm = 0; opt.corner_mm < 1.8; opt.corner_mm += 0.25) {
        double solid = fmax(opt.corner_mm, opt.phi_s_mm / 2), hollow = fmax(opt.corner_mm, opt.phi_v_mm / 2);
        CHECK(fabs(lost_at_corner(&opt, 200, true) - (sqrt(2.0) - 1) * solid) < 0.03);
        CHECK(fabs(lost_at_corner(&opt, 200, false) - (sqrt(2.0) - 1) * hollow) < 0.03);
    }
}

TEST(rounding_leaves_thin_features)
{
    jali_predict_options opt = plain_printer();
    opt.corner_mm = 1; // an opening by 2 mm, 80 px, would take the bars with it
    for (int32_t size = 16; size < 80; size += 8) {
        jali_bitmap mask = drawn_by(flag, size), print = printed(&opt, &mask, false);
        int32_t wide = 0;
        for (int32_t y = 0; y < FINE; y++) wide += jali_bitmap_get(&print, FINE - 60, y);
        CHECK_INT(wide, size);
        CHECK(!jali_bitmap_get(&print, FINE / 2 - 79,
                               FINE / 2 - 79)); // the square's corner is round all the same
        jali_bitmap_free(ctx, &mask);
        jali_bitmap_free(ctx, &print);
        CHECK_INT(across(&opt, slot, MAX(size, 24), true), FINE - MAX(size, 24));
    }
}

// Two of three figures at a time that say nothing leave no trace.
TEST(figures_that_are_zero_or_equal_change_nothing)
{
    for (int32_t k = 1; k < 6; k++) {
        uint64_t seed = (uint64_t)k;
        jali_bitmap mask = random_blobs(&seed, SIDE, SIDE, 19, 50);
        jali_predict_options opt = plain_printer();
        opt.phi_e_solid_mm = opt.phi_e_void_mm = 0.1;
        jali_bitmap plain = printed(&opt, &mask, true);
        opt.narrow_mm = 1;
        opt.hole_mm2 = 1e-9;
        opt.corner_mm = 0.2; // no more than phi leaves
        jali_bitmap same = printed(&opt, &mask, true);
        CHECK(same_bitmap(&plain, &same));
        jali_bitmap_free(ctx, &plain);
        jali_bitmap_free(ctx, &same);
        jali_bitmap_free(ctx, &mask);
    }
}

static bool within(const jali_bitmap *a, const jali_bitmap *b)
{
    for (int64_t i = 0; i < a->stride * a->height_px; i++)
        if (a->word[i] & ~b->word[i]) return false;
    return true;
}

TEST(more_growth_is_more_solid)
{
    for (int32_t k = 1; k < 6; k++) {
        uint64_t seed = (uint64_t)k;
        jali_bitmap mask = random_blobs(&seed, SIDE, SIDE, 23, 50), before = {0};
        jali_predict_options opt = plain_printer();
        opt.hole_mm2 = k % 2 ? 0.1 : 0;
        for (double e_mm = -0.3; e_mm < 0.35; e_mm += 0.1) {
            opt.phi_e_solid_mm = opt.phi_e_void_mm = e_mm;
            jali_bitmap print = printed(&opt, &mask, true);
            CHECK(before.word == NULL || within(&before, &print));
            jali_bitmap_free(ctx, &before);
            before = print;
        }
        jali_bitmap_free(ctx, &before);
        jali_bitmap_free(ctx, &mask);
    }
}

// Twice as long across on the surface: a hole that is round there is half as wide in the picture.
static bool narrow_hole(double x, double y, double size)
{
    return hypot(2 * x, y) > size / 2;
}

TEST(on_a_stretched_surface_holes_are_those_that_are_round_there)
{
    float metric[4][3];
    for (int32_t knot = 0; knot < 4; knot++) {
        metric[knot][0] = (float)exp(2 * 44 / 64.0); // a step of the logarithm: 1.989 times
        metric[knot][1] = 0;
        metric[knot][2] = 1;
    }
    jali_chart chart = {.width_px = SIDE,
                        .height_px = SIDE,
                        .margin_px = MARGIN,
                        .metric = metric,
                        .metric_columns = 2,
                        .metric_rows = 2,
                        .metric_step_px = SIDE};
    jali_predict_options opt = plain_printer();
    jali_bitmap mask = drawn_by(narrow_hole, 80);
    opt.chart = &chart;
    for (int32_t i = 0; i < 2; i++) {
        opt.hole_mm2 = i * 0.4; // 0.2 mm of 2: 4 px a side along, 2 across
        jali_bitmap print = printed(&opt, &mask, true);
        int32_t wide = 0, high = 0;
        for (int32_t k = 0; k < FINE; k++) {
            wide += !jali_bitmap_get(&print, k, FINE / 2);
            high += !jali_bitmap_get(&print, FINE / 2, k);
        }
        CHECK(abs(wide - (40 - 4 * i)) <= 2 && abs(high - (80 - 8 * i)) <= 2);
        jali_bitmap_free(ctx, &print);
    }
    jali_bitmap_free(ctx, &mask);
}

static jali_predict_options everything(void)
{
    jali_predict_options opt = plain_printer();
    opt.phi_e_solid_mm = 0.1;
    opt.phi_e_void_mm = -0.2;
    opt.hole_mm2 = 0.2;
    opt.corner_mm = 0.8;
    return opt;
}

TEST(threads_do_not_change_a_print_of_all_figures)
{
    uint64_t seed = 7;
    jali_bitmap mask = random_blobs(&seed, SIDE, SIDE, 21, 60);
    jali_context *by_threads[3];
    jali_prediction p[3];
    jali_predict_options opt = everything();
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        CHECK_INT(print_in(by_threads[i], &opt, &mask, true, &p[i]), JALI_OK);
        CHECK(same_bitmap(&p[i].printed, &p[0].printed));
    }
    for (int32_t i = 0; i < 3; i++) jali_prediction_free(by_threads[i], &p[i]);
    close_thread_contexts(by_threads);
    jali_bitmap_free(ctx, &mask);
}

// A sample printed with every figure, as it was found right by looking at it.
TEST(a_sample_gives_the_golden_print)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    jali_bitmap sample, mask;
    jali_predict_options opt = everything();
    CHECK_OK(jali_sample(ctx, "girih", FINE, &sample));
    CHECK_OK(jali_bitmap_create(ctx, SIDE, SIDE, &mask));
    fill(ctx, &mask, true);
    paste(ctx, &sample, MARGIN, MARGIN, &mask);
    jali_bitmap print = printed(&opt, &mask, true);
    for (int32_t y = 0; y < FINE; y++)
        for (int32_t x = 0; x < FINE; x++)
            hash = (hash ^ jali_bitmap_get(&print, x, y)) * UINT64_C(1099511628211);
    if (hash != GOLDEN) print_error("UINT64_C(0x%016llx)\n", (unsigned long long)hash);
    CHECK(hash == GOLDEN);
    jali_bitmap_free(ctx, &print);
    jali_bitmap_free(ctx, &sample);
    jali_bitmap_free(ctx, &mask);
}

static jali_status print_everything(jali_context *limited, void *mask)
{
    jali_predict_options opt = everything();
    jali_prediction p;
    jali_status status = print_in(limited, &opt, mask, true, &p);
    if (status != JALI_OK) CHECK(p.printed.word == NULL);
    jali_prediction_free(limited, &p);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_bitmap mask = drawn_by(hole, 60);
    refuse_each_allocation(print_everything, &mask);
    jali_bitmap_free(ctx, &mask);
}

TEST(bad_figures_are_a_sentence)
{
    jali_bitmap mask = drawn_by(square, 60);
    const double bad[] = {NAN, INFINITY, 2000, -2000};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        for (int32_t figure = 0; figure < 7; figure++) {
            jali_prediction p;
            jali_predict_options opt = plain_printer();
            double *field[] = {&opt.phi_e_solid_mm, &opt.phi_e_void_mm, &opt.narrow_mm, &opt.phi_s_mm,
                               &opt.phi_v_mm,       &opt.hole_mm2,      &opt.corner_mm};
            *field[figure] = bad[i];
            CHECK_STATUS(print_in(ctx, &opt, &mask, true, &p), JALI_BAD_VALUE);
            CHECK(strstr(jali_message(ctx), "is accepted"));
        }
    jali_bitmap_free(ctx, &mask);
}

TEST(a_profile_says_all_of_it)
{
    jali_printer printer = {.phi_e_solid_mm.value = 1,
                            .phi_e_void_mm.value = 2,
                            .phi_s_mm.value = 3,
                            .phi_v_mm.value = 4,
                            .hole_mm2.value = 5,
                            .corner_mm.value = 6};
    jali_predict_options opt = jali_predict_of(&printer);
    CHECK(opt.phi_e_solid_mm == 1 && opt.phi_e_void_mm == 2 && opt.phi_s_mm == 3 && opt.phi_v_mm == 4 &&
          opt.hole_mm2 == 5 && opt.corner_mm == 6 && opt.recall && opt.narrow_mm == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_kerf_takes_from_solids_and_gives_to_voids),
        cmocka_unit_test(narrow_voids_have_a_growth_of_their_own),
        cmocka_unit_test(corners_of_wide_voids_are_not_narrow),
        cmocka_unit_test(a_small_hole_is_a_narrow_void_as_well),
        cmocka_unit_test(round_holes_shrink_the_more_the_smaller_they_are),
        cmocka_unit_test(corners_come_out_as_round_as_stated),
        cmocka_unit_test(rounding_leaves_thin_features),
        cmocka_unit_test(figures_that_are_zero_or_equal_change_nothing),
        cmocka_unit_test(more_growth_is_more_solid),
        cmocka_unit_test(on_a_stretched_surface_holes_are_those_that_are_round_there),
        cmocka_unit_test(threads_do_not_change_a_print_of_all_figures),
        cmocka_unit_test(a_sample_gives_the_golden_print),
        cmocka_unit_test(every_allocation_refused_once),
        cmocka_unit_test(bad_figures_are_a_sentence),
        cmocka_unit_test(a_profile_says_all_of_it),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
