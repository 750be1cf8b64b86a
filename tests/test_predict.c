// predict: the forward model on bars of known width, an error rate counted by hand, recall of a drawn axis.
#include "testing.h"
#include "plain.h"

#include <jali/predict.h>
#include "raster/raster.h"
#include "base/base.h"

#include <math.h>
#include <png.h>

// One picture pixel is 0.1 mm; phi_s 0.4, phi_v 0.6, phi_e 0.2 mm: 4, 6 and 1 a side, 16, 24 and 4 on the
// fine grid.
static jali_predict_options options(int32_t width_px)
{
    return (jali_predict_options){.picture_mm = 0.1 * width_px,
                                  .phi_e_solid_mm = 0.2,
                                  .phi_e_void_mm = 0.2,
                                  .phi_s_mm = 0.4,
                                  .phi_v_mm = 0.6,
                                  .recall = true};
}

enum { SIDE_PX = 60, MASK_SCALE = 8, MARGIN_PX = 40 };

// A mask eight times finer than the picture, in a margin, with an upright bar of `wide` mask pixels in its
// middle.
static jali_bitmap bar_mask(int32_t wide, bool white)
{
    jali_bitmap mask;
    int32_t side = SIDE_PX * MASK_SCALE + 2 * MARGIN_PX, left = (side - wide) / 2;
    CHECK_OK(jali_bitmap_create(ctx, side, side, &mask));
    for (int32_t y = 0; y < side; y++)
        for (int32_t x = 0; x < side; x++)
            jali_bitmap_set(&mask, x, y, (x >= left && x < left + wide) == white);
    return mask;
}

// White fine pixels in the middle row of what the mask prints as on a surface.
static int32_t printed_on(const jali_chart *chart, const jali_bitmap *mask, bool outside_solid)
{
    jali_bitmap picture;
    jali_reference reference;
    jali_prediction p;
    jali_predict_options opt = options(SIDE_PX);
    opt.chart = chart;
    CHECK_OK(jali_bitmap_create(ctx, SIDE_PX, SIDE_PX, &picture));
    CHECK_OK(jali_reference_create(ctx, &picture, &opt, &reference));
    CHECK_INT(reference.factor, 4);
    CHECK_OK(jali_predict(ctx, &reference, mask, MARGIN_PX, outside_solid, &opt, &p));
    int32_t across = 0;
    for (int32_t x = 0; x < p.printed.width_px; x++)
        across += jali_bitmap_get(&p.printed, x, p.printed.height_px / 2);
    jali_prediction_free(ctx, &p);
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
    return across;
}

static int32_t printed_across(const jali_bitmap *mask, bool outside_solid)
{
    return printed_on(NULL, mask, outside_solid);
}

TEST(a_solid_bar_of_phi_s_prints_phi_e_wider_and_a_thinner_one_not_at_all)
{
    for (int32_t fine = 10; fine <= 40; fine += 2) { // mask pixels are half fine ones
        jali_bitmap mask = bar_mask(2 * fine, true);
        CHECK_INT(printed_across(&mask, false), fine >= 16 ? fine + 8 : 0);
        jali_bitmap_free(ctx, &mask);
    }
    jali_bitmap almost = bar_mask(2 * 15, true); // 0.375 mm
    CHECK_INT(printed_across(&almost, false), 0);
    jali_bitmap_free(ctx, &almost);
}

TEST(a_void_bar_of_phi_v_prints_phi_e_narrower_and_a_thinner_one_not_at_all)
{
    for (int32_t fine = 18; fine <= 40; fine += 2) {
        jali_bitmap mask = bar_mask(2 * fine, false);
        CHECK_INT(printed_across(&mask, true), SIDE_PX * 4 - (fine >= 24 ? fine - 8 : 0));
        jali_bitmap_free(ctx, &mask);
    }
}

TEST(on_a_stretched_surface_bars_count_as_wide_as_they_are_there)
{
    // Twice as wide across (a step of the logarithm, so that nothing is rounded), as they are along.
    float metric[4][3];
    for (int32_t knot = 0; knot < 4; knot++) {
        metric[knot][0] = (float)exp(2 * 44 / 64.0);
        metric[knot][1] = 0;
        metric[knot][2] = 1;
    }
    jali_chart chart = {.width_px = SIDE_PX * MASK_SCALE + 2 * MARGIN_PX,
                        .height_px = SIDE_PX * MASK_SCALE + 2 * MARGIN_PX,
                        .margin_px = MARGIN_PX,
                        .metric = metric,
                        .metric_columns = 2,
                        .metric_rows = 2,
                        .metric_step_px = 300};
    for (int32_t fine = 4; fine <= 20; fine += 2) {
        jali_bitmap solid = bar_mask(2 * fine, true), hollow = bar_mask(2 * fine, false);
        CHECK_INT(printed_on(&chart, &solid, false), fine >= 8 ? fine + 4 : 0);
        CHECK_INT(printed_on(&chart, &hollow, true), SIDE_PX * 4 - (fine >= 12 ? fine - 4 : 0));
        jali_bitmap_free(ctx, &solid);
        jali_bitmap_free(ctx, &hollow);
    }
}

TEST(phi_is_a_whole_number_of_pixels_where_floating_point_misses_it_by_a_hair)
{
    // 0.3 mm over a fine pixel of 7 mm / 280 is 11.999999999999998: still 12 px, so that a bar of 11 px does
    // not print.
    jali_predict_options opt = {.picture_mm = 7,
                                .phi_e_solid_mm = 0,
                                .phi_e_void_mm = 0,
                                .phi_s_mm = 0.3,
                                .phi_v_mm = 0.3,
                                .recall = false};
    jali_bitmap picture;
    jali_reference reference;
    CHECK_OK(jali_bitmap_create(ctx, 70, 30, &picture));
    CHECK_OK(jali_reference_create(ctx, &picture, &opt, &reference));
    for (int32_t wide = 11; wide <= 12; wide++) {
        jali_bitmap mask;
        jali_prediction p;
        CHECK_OK(jali_bitmap_create(ctx, 280, 120, &mask));
        for (int32_t y = 0; y < 120; y++)
            for (int32_t x = 100; x < 100 + wide; x++) jali_bitmap_set(&mask, x, y, true);
        CHECK_OK(jali_predict(ctx, &reference, &mask, 0, false, &opt, &p));
        CHECK_INT(jali_bitmap_get(&p.printed, 105, 60), wide == 12);
        jali_prediction_free(ctx, &p);
        jali_bitmap_free(ctx, &mask);
    }
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
}

// A picture of 12 px over 8 mm: split by 4 alone, phi_s would span 3 fine pixels and a bar of phi_s could
// lose one.
TEST(pictures_of_few_pixels_are_split_until_a_bar_of_phi_s_prints_wherever_it_lies)
{
    enum { PICTURE_PX = 12, MASK_PX = 160 };
    for (double phi_mm = 0.5; phi_mm < 4; phi_mm *= 2) {
        jali_predict_options opt = {.picture_mm = 8,
                                    .phi_e_solid_mm = 0,
                                    .phi_e_void_mm = 0,
                                    .phi_s_mm = phi_mm,
                                    .phi_v_mm = 0.1,
                                    .recall = false};
        jali_bitmap picture;
        jali_reference reference;
        CHECK_OK(jali_bitmap_create(ctx, PICTURE_PX, PICTURE_PX, &picture));
        CHECK_OK(jali_reference_create(ctx, &picture, &opt, &reference));
        CHECK(phi_mm / opt.picture_mm * PICTURE_PX * reference.factor >= 8);
        int32_t wide = (int32_t)(phi_mm / opt.picture_mm * MASK_PX + 0.5);
        for (int32_t left = 40; left < 56; left++) {
            jali_bitmap mask;
            jali_prediction p;
            CHECK_OK(jali_bitmap_create(ctx, MASK_PX, MASK_PX, &mask));
            for (int32_t y = 0; y < MASK_PX; y++)
                for (int32_t x = left; x < left + wide; x++) jali_bitmap_set(&mask, x, y, true);
            CHECK_OK(jali_predict(ctx, &reference, &mask, 0, false, &opt, &p));
            CHECK_INT(p.pieces, 1);
            jali_prediction_free(ctx, &p);
            jali_bitmap_free(ctx, &mask);
        }
        jali_reference_free(ctx, &reference);
        jali_bitmap_free(ctx, &picture);
    }
}

// A picture with a solid square of 10 px and a speck of 2 px, printed with growth 1 px a side: the square
// gains a rim, the speck is lost.
TEST(the_error_rate_is_what_is_counted_by_hand)
{
    jali_bitmap picture;
    CHECK_OK(jali_bitmap_create(ctx, 40, 30, &picture));
    for (int32_t y = 10; y < 20; y++)
        for (int32_t x = 8; x < 18; x++) jali_bitmap_set(&picture, x, y, true);
    for (int32_t y = 14; y < 16; y++)
        for (int32_t x = 30; x < 32; x++) jali_bitmap_set(&picture, x, y, true);
    jali_predict_options opt = options(40);
    jali_reference reference;
    jali_prediction p;
    CHECK_OK(jali_reference_create(ctx, &picture, &opt, &reference));
    CHECK_OK(jali_predict(ctx, &reference, &picture, 0, false, &opt, &p));
    // On the fine grid: a 40 px square opened by a disc of 16 loses its four corners, and comes out 4 px
    // wider.
    plain want = plain_create(160, 120);
    for (int32_t y = 0; y < 120; y++)
        for (int32_t x = 0; x < 160; x++) {
            bool near = false;
            for (int32_t v = 40; v < 80 && !near; v++)
                for (int32_t u = 32; u < 72 && !near; u++) {
                    // In half pixels: centres of discs of diameter 16 run from 32 + 8 to 72 - 8.
                    int32_t du = 2 * u + 1 < 80 ? 80 - 2 * u - 1 : 2 * u + 1 > 128 ? 2 * u + 1 - 128 : 0;
                    int32_t dv = 2 * v + 1 < 96 ? 96 - 2 * v - 1 : 2 * v + 1 > 144 ? 2 * v + 1 - 144 : 0;
                    bool opened = du * du + dv * dv <= 16 * 16;
                    near = opened && 4 * ((u - x) * (u - x) + (v - y) * (v - y)) <= 9 * 9;
                }
            want.white[y * 160 + x] = near;
        }
    CHECK(plain_equals(&want, &p.printed));
    int32_t wrong = 0, missing = 0;
    for (int32_t y = 0; y < 120; y++)
        for (int32_t x = 0; x < 160; x++) {
            bool white = jali_bitmap_get(&picture, x / 4, y / 4);
            wrong += plain_at(&want, x, y, false) != (int32_t)white;
            missing += white && !plain_at(&want, x, y, false);
        }
    CHECK(wrong > 16 * 4 * 10 && p.error_rate == wrong / (160.0 * 120.0));
    CHECK(missing >= 64 && p.missing == missing / (160.0 * 120.0)); // the small square is 8 x 8
    CHECK(p.excess == (wrong - missing) / (160.0 * 120.0));
    CHECK_INT(p.pieces, 1);
    plain_free(&want);
    jali_prediction_free(ctx, &p);
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
}

// Two black bars in white, 9 and 3 px wide and 20 long, inside a wide frame: the wide one prints, the thin
// one fills up.
TEST(recall_is_the_share_of_the_axis_that_prints)
{
    jali_bitmap picture;
    CHECK_OK(jali_bitmap_create(ctx, 60, 40, &picture));
    for (int32_t y = 0; y < 40; y++)
        for (int32_t x = 0; x < 60; x++) {
            bool wide = x >= 10 && x < 19 && y >= 10 && y < 30, thin = x >= 40 && x < 43 && y >= 10 && y < 30;
            jali_bitmap_set(&picture, x, y, !wide && !thin);
        }
    jali_predict_options opt = options(60);
    jali_reference reference;
    jali_prediction p;
    CHECK_OK(jali_reference_create(ctx, &picture, &opt, &reference));
    // Centres of maximal squares: of 9 x 20 a column of 12, of 3 x 20 a column of 18.
    CHECK_INT(reference.axis_black_count, 12 + 18);
    CHECK_OK(jali_predict(ctx, &reference, &picture, 0, true, &opt, &p));
    CHECK(p.recall_black == 12.0 / 30.0);
    CHECK(p.recall_white == 1);
    jali_prediction_free(ctx, &p);
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
}

static jali_status predict_some(jali_context *limited, void *data)
{
    jali_status status;
    jali_reference reference = {0};
    jali_prediction p = {0};
    jali_predict_options opt = options(20);
    TRY(jali_reference_create(limited, data, &opt, &reference));
    TRY(jali_predict(limited, &reference, data, 2, true, &opt, &p));
done:
    if (status != JALI_OK) CHECK(p.printed.word == NULL);
    jali_prediction_free(limited, &p);
    jali_reference_free(limited, &reference);
    return status;
}

// Without growth a piece is no smaller than a disc of phi_s; the closing's specks are.
TEST(specks_between_the_discs_of_a_void_are_no_pieces)
{
    enum { SEEDS = 60, BLOCKS = 40, SIDE = 30, DISC_AREA = 200 }; // of 16 fine px, rounded down
    uint64_t seed = 3;
    int32_t specks = 0;
    jali_bitmap mask;
    jali_reference reference;
    jali_predict_options opt = options(SIDE);
    opt.phi_e_solid_mm = opt.phi_e_void_mm = 0;
    opt.recall = false;
    CHECK_OK(jali_bitmap_create(ctx, SIDE, SIDE, &mask));
    CHECK_OK(jali_reference_create(ctx, &mask, &opt, &reference));
    for (int32_t i = 0; i < SEEDS; i++) {
        for (int32_t block = 0; block < BLOCKS; block++) {
            int32_t x0 = (int32_t)(next_random(&seed) >> 40) % SIDE,
                    y0 = (int32_t)(next_random(&seed) >> 40) % SIDE;
            for (int32_t y = y0; y < MIN(y0 + 6, SIDE); y++)
                for (int32_t x = x0; x < MIN(x0 + 6, SIDE); x++) jali_bitmap_set(&mask, x, y, block % 2);
        }
        jali_prediction p;
        components c;
        int64_t *area;
        int32_t pieces = 0;
        CHECK_OK(jali_predict(ctx, &reference, &mask, 0, false, &opt, &p));
        CHECK_OK(label_components(ctx, &p.printed, true, 4, &c));
        CHECK_OK(component_areas(ctx, &c, &area));
        for (int32_t k = 0; k < c.count; k++) pieces += area[k] >= DISC_AREA;
        CHECK_INT(p.pieces, pieces);
        specks += c.count - pieces;
        release(ctx, area);
        components_free(ctx, &c);
        jali_prediction_free(ctx, &p);
    }
    CHECK(specks > 0); // else this tested nothing
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &mask);
}

// The reader's own: what a PNG of 8-bit colours holds, by way of libpng's simple interface.
static void colours_of(const jali_bytes *png, int32_t width, int32_t height, uint8_t *rgb)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    CHECK(png_image_begin_read_from_memory(&image, png->data, png->size));
    CHECK_INT(image.width, width);
    CHECK_INT(image.height, height);
    image.format = PNG_FORMAT_RGB;
    CHECK(png_image_finish_read(&image, NULL, rgb, 0, NULL));
}

TEST(missing_is_red_and_excess_is_yellow)
{
    jali_bitmap wanted = drawn_rows(2, "#."
                                       "#.");
    jali_bitmap printed = drawn_rows(4, "####"
                                        "##.."
                                        ".#.."
                                        "##..");
    uint8_t rgb[4 * 4 * 3];
    jali_bytes png = {0};
    CHECK_OK(jali_error_map(ctx, &wanted, &printed, 4, &png));
    colours_of(&png, 4, 4, rgb);
    const uint8_t *light = &rgb[0], *yellow = &rgb[3 * 2], *red = &rgb[3 * 8], *dark = &rgb[3 * 15];
    CHECK(light[0] > 200 && light[1] > 200 && light[2] > 200 && dark[0] < 60 && dark[1] < 60 && dark[2] < 60);
    CHECK(red[0] > 200 && red[1] < 60 && red[2] < 60);
    CHECK(yellow[0] > 200 && yellow[1] > 180 && yellow[2] < 60);
    for (int32_t i = 0; i < 16; i++)
        CHECK(memcmp(&rgb[3 * i],
                     i == 2 || i == 3 ? yellow
                     : i == 8         ? red
                     : i % 4 < 2      ? light
                                      : dark,
                     3) == 0);
    png.size = 0;
    uint8_t small[2 * 2 * 3];
    CHECK_OK(jali_error_map(ctx, &wanted, &printed, 3, &png)); // blocks of 2: their means
    colours_of(&png, 2, 2, small);
    for (int32_t k = 0; k < 3; k++) {
        CHECK_INT(small[3 + k], (2 * yellow[k] + 2 * dark[k]) / 4);
        CHECK_INT(small[6 + k], (3 * light[k] + red[k]) / 4);
    }
    CHECK_STATUS(jali_error_map(ctx, &wanted, &printed, 0, &png), JALI_BAD_VALUE);
    CHECK_STATUS(jali_error_map(ctx, &(jali_bitmap){0}, &printed, 9, &png), JALI_BAD_VALUE);
    jali_bytes_free(ctx, &png);
    jali_bitmap_free(ctx, &wanted);
    jali_bitmap_free(ctx, &printed);
}

static jali_status draw_map(jali_context *limited, void *data)
{
    jali_bytes png = {0};
    jali_status status = jali_error_map(limited, data, data, 10, &png);
    jali_bytes_free(limited, &png);
    return status;
}

TEST(every_allocation_refused_once)
{
    uint64_t seed = 3;
    jali_bitmap a = random_bitmap(&seed, 20, 20, 60);
    refuse_each_allocation(predict_some, &a);
    refuse_each_allocation(draw_map, &a);
    jali_bitmap_free(ctx, &a);
}

TEST(threads_do_not_change_a_prediction)
{
    uint64_t seed = 5;
    jali_bitmap a = random_bitmap(&seed, 90, 70, 70);
    jali_context *by_threads[3];
    jali_prediction p[3];
    jali_predict_options opt = options(30);
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        jali_reference reference;
        CHECK_INT(jali_reference_create(by_threads[i], &a, &opt, &reference), JALI_OK);
        CHECK_INT(jali_predict(by_threads[i], &reference, &a, 0, true, &opt, &p[i]), JALI_OK);
        CHECK(same_bitmap(&p[i].printed, &p[0].printed));
        CHECK(p[i].error_rate == p[0].error_rate && p[i].recall_white == p[0].recall_white &&
              p[i].pieces == p[0].pieces);
        jali_reference_free(by_threads[i], &reference);
    }
    for (int32_t i = 0; i < 3; i++) jali_prediction_free(by_threads[i], &p[i]);
    close_thread_contexts(by_threads);
    jali_bitmap_free(ctx, &a);
}

TEST(bad_values_are_a_sentence)
{
    jali_bitmap a = drawn_rows(2, "#.");
    jali_reference reference;
    jali_predict_options opt = jali_predict_defaults();
    CHECK_STATUS(jali_reference_create(ctx, &a, &opt, &reference), JALI_BAD_VALUE); // no width in mm
    CHECK(strstr(jali_message(ctx), "mm") && reference.picture.word == NULL);
    jali_bitmap_free(ctx, &a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_solid_bar_of_phi_s_prints_phi_e_wider_and_a_thinner_one_not_at_all),
        cmocka_unit_test(a_void_bar_of_phi_v_prints_phi_e_narrower_and_a_thinner_one_not_at_all),
        cmocka_unit_test(on_a_stretched_surface_bars_count_as_wide_as_they_are_there),
        cmocka_unit_test(phi_is_a_whole_number_of_pixels_where_floating_point_misses_it_by_a_hair),
        cmocka_unit_test(pictures_of_few_pixels_are_split_until_a_bar_of_phi_s_prints_wherever_it_lies),
        cmocka_unit_test(the_error_rate_is_what_is_counted_by_hand),
        cmocka_unit_test(recall_is_the_share_of_the_axis_that_prints),
        cmocka_unit_test(specks_between_the_discs_of_a_void_are_no_pieces),
        cmocka_unit_test(missing_is_red_and_excess_is_yellow),
        cmocka_unit_test(every_allocation_refused_once),
        cmocka_unit_test(threads_do_not_change_a_prediction),
        cmocka_unit_test(bad_values_are_a_sentence),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
