// The working grid of a plate: sizes, lattice, margin; resampling against plain formulas; sentences.
#include "testing.h"

#include <math.h>
#include <jali/place.h>

static jali_chart chart;
static jali_bitmap drawing;

static jali_picture random_picture(uint64_t seed, int32_t width, int32_t height, bool two_tones)
{
    jali_picture p = {.width_px = width, .height_px = height};
    CHECK_OK(ALLOCATE(ctx, p.grey, width * height));
    for (int32_t i = 0; i < width * height; i++) {
        uint8_t grey = (uint8_t)(next_random(&seed) >> 56);
        p.grey[i] = two_tones ? (grey & 1 ? 255 : 0) : grey;
    }
    return p;
}

// A grid of exactly `columns` pixels, by way of the pixel's size.
static jali_place_options grid_of(int32_t columns, double frame_mm)
{
    jali_place_options opt = jali_place_defaults();
    opt.width_mm = 50;
    opt.pixel_mm = 50.0 / columns;
    opt.frame_mm = frame_mm;
    return opt;
}

static double grey_near(const jali_picture *p, int64_t x, int64_t y)
{
    x = MIN(MAX(x, 0), p->width_px - 1);
    y = MIN(MAX(y, 0), p->height_px - 1);
    return p->grey[y * p->width_px + x];
}

static double interpolated(const jali_picture *p, double x, double y)
{
    double u = floor(x - 0.5), v = floor(y - 0.5), fx = x - 0.5 - u, fy = y - 0.5 - v;
    int64_t i = (int64_t)u, j = (int64_t)v;
    double upper = grey_near(p, i, j) * (1 - fx) + grey_near(p, i + 1, j) * fx;
    double lower = grey_near(p, i, j + 1) * (1 - fx) + grey_near(p, i + 1, j + 1) * fx;
    return upper * (1 - fy) + lower * fy;
}

static double mean_over(const jali_picture *p, double x0, double x1, double y0, double y1)
{
    double sum = 0;
    for (int64_t y = (int64_t)y0; y < y1; y++)
        for (int64_t x = (int64_t)x0; x < x1; x++)
            sum += grey_near(p, x, y) * (MIN(x + 1, x1) - MAX(x, x0)) * (MIN(y + 1, y1) - MAX(y, y0));
    return sum / (x1 - x0) / (y1 - y0);
}

// Every pixel has the tone of the formula, but for those within rounding of the threshold.
static void check_against_formula(const jali_picture *p, int32_t threshold, int32_t columns, double frame_mm)
{
    jali_place_options opt = grid_of(columns, frame_mm);
    CHECK_OK(jali_place(ctx, p, threshold, &opt, &chart, &drawing));
    int32_t margin = chart.margin_px, rows = chart.height_px - 2 * margin;
    CHECK_INT(chart.width_px - 2 * margin, columns);
    double sx = (double)p->width_px / columns, sy = (double)p->height_px / rows;
    for (int32_t y = 0; y < chart.height_px; y++)
        for (int32_t x = 0; x < chart.width_px; x++) {
            int32_t u = x - margin, v = y - margin;
            bool white = jali_bitmap_get(&drawing, x, y);
            if (u < 0 || v < 0 || u >= columns || v >= rows) {
                CHECK(white);
                continue;
            }
            bool enlarged = columns >= p->width_px;
            double grey = enlarged ? interpolated(p, (u + 0.5) * sx, (v + 0.5) * sy)
                                   : mean_over(p, u * sx, (u + 1) * sx, v * sy, (v + 1) * sy);
            double rounding = enlarged ? 1.1 : 1e-9;
            if (fabs(grey - (threshold - 0.5)) > rounding) CHECK_INT(white, grey > threshold - 0.5);
        }
    jali_bitmap_free(ctx, &drawing);
}

TEST(resampling_is_its_formula)
{
    static const int32_t columns[] = {1, 2, 7, 30, 47, 63, 64, 65, 70, 128, 200, 391};
    for (int32_t i = 0; i < 12; i++)
        for (int32_t framed = 0; framed < 2; framed++) {
            jali_picture p = random_picture((uint64_t)i + 1, 64, 45, i % 2);
            int32_t wanted = columns[i];
            if (wanted > 2 || !framed) check_against_formula(&p, 20 + 18 * i, wanted, framed);
            jali_picture_free(ctx, &p);
        }
}

TEST(bits_beyond_the_width_are_zero)
{
    jali_picture p = random_picture(9, 70, 70, false);
    for (int32_t columns = 60; columns < 140; columns += 7) {
        jali_place_options opt = grid_of(columns, 2);
        CHECK_OK(jali_place(ctx, &p, 100, &opt, &chart, &drawing));
        for (int32_t y = 0; y < drawing.height_px; y++)
            for (int64_t x = drawing.width_px; x < drawing.stride * 64; x++)
                CHECK(!(drawing.word[y * drawing.stride + x / 64] >> (x % 64) & 1));
        jali_bitmap_free(ctx, &drawing);
    }
    jali_picture_free(ctx, &p);
}

// A half plane stays where it is at any scale: the boundary moves by less than a working pixel.
TEST(a_straight_edge_keeps_its_place)
{
    jali_picture p = {.width_px = 90, .height_px = 40};
    CHECK_OK(ALLOCATE(ctx, p.grey, 90 * 40));
    for (int32_t i = 0; i < 90 * 40; i++) {
        double covered = 37.3 - i % 90; // the edge stands at x = 37.3, anti-aliased
        p.grey[i] = (uint8_t)(255 * (covered < 0 ? 0 : covered > 1 ? 1 : covered) + 0.5);
    }
    for (int32_t columns = 45; columns < 800; columns += 13) {
        jali_place_options opt = grid_of(columns, 0);
        CHECK_OK(jali_place(ctx, &p, 128, &opt, &chart, &drawing));
        int32_t white = 0;
        while (jali_bitmap_get(&drawing, white, 5)) white++;
        double edge = (double)white * 90 / columns;
        CHECK(fabs(edge - 37.3) < 0.5 * 90 / columns + 0.21);
        jali_bitmap_free(ctx, &drawing);
    }
    jali_picture_free(ctx, &p);
}

TEST(paper_keeps_the_input_pixels)
{
    jali_picture p = random_picture(4, 131, 77, false);
    jali_place_options opt = jali_place_defaults();
    opt.paper = true;
    opt.frame_mm = 5;
    CHECK_OK(jali_place(ctx, &p, 90, &opt, &chart, &drawing));
    CHECK(chart.outside_solid && chart.width_px == 131 + 2 * chart.margin_px);
    for (int32_t y = 0; y < chart.height_px; y++)
        for (int32_t x = 0; x < chart.width_px; x++) {
            int32_t u = jali_input_column(&chart, 131, x, 1), v = jali_input_row(&chart, 77, y, 1);
            bool white = u < 0 || v < 0 || p.grey[v * 131 + u] >= 90;
            CHECK_INT(jali_bitmap_get(&drawing, x, y), white);
        }
    jali_bitmap_free(ctx, &drawing);
    jali_picture_free(ctx, &p);
}

TEST(input_pixels_are_found_at_any_fineness)
{
    jali_chart c = {.width_px = 110, .height_px = 60, .margin_px = 5};
    for (int32_t per_px = 1; per_px <= 4; per_px++)
        for (int32_t x = 0; x < 110 * per_px; x++) {
            double place = ((x + 0.5) / per_px - 5) / 100 * 37;
            CHECK_INT(jali_input_column(&c, 37, x, per_px), place < 0 || place >= 37 ? -1 : (int32_t)place);
        }
    CHECK(jali_input_row(&c, 20, 5, 1) == 0 && jali_input_row(&c, 20, 54, 1) == 19);
    CHECK(jali_input_row(&c, 20, 4, 1) == -1 && jali_input_row(&c, 20, 55, 1) == -1);
}

TEST(the_lattice_holds_every_coordinate_in_float32)
{
    jali_picture p = random_picture(4, 100, 150, true);
    for (double width = 1; width < 3000; width *= 1.37)
        for (double frame = 0; frame < 40; frame += 13) {
            jali_place_options opt = jali_place_defaults();
            opt.width_mm = width;
            opt.frame_mm = frame;
            opt.pixel_mm = width / 300;
            CHECK_OK(jali_place(ctx, &p, 128, &opt, &chart, &drawing));
            double units = (1.5 * width + 2 * frame + 20) / chart.unit_mm;
            int exponent;
            CHECK(frexp(chart.unit_mm, &exponent) == 0.5);
            CHECK(units < 16777216 && chart.pixel_units % 2 == 0 && chart.pixel_units >= 16);
            CHECK((double)chart.pixel_units * MAX(chart.width_px, chart.height_px) < 16777216);
            CHECK(fabs(jali_chart_pixel_mm(&chart) * 300 - width) < 300 * chart.unit_mm);
            CHECK_INT(chart.margin_px, frame > 0 ? (int32_t)ceil(1.1 / opt.pixel_mm) + 2 : 0);
            CHECK_INT(chart.outside_solid, frame > 0);
            jali_bitmap_free(ctx, &drawing);
        }
    jali_picture_free(ctx, &p);
}

static void refused(const jali_picture *p, jali_place_options opt, jali_status wanted, const char *words)
{
    CHECK_STATUS(jali_place(ctx, p, 128, &opt, &chart, &drawing), wanted);
    if (!strstr(jali_message(ctx), words)) print_error("%s\n", jali_message(ctx));
    CHECK(strstr(jali_message(ctx), words) && drawing.word == NULL && chart.width_px == 0);
}

// phi_s 0.3, phi_v 0.5, phi_e / 2 = 0.05: the largest divisor of the growth of which 0.3 mm hold enough.
TEST(a_coarser_grid_keeps_the_growth_whole)
{
    static const struct {
        int32_t grid;
        double pixel_mm;
    } cases[] = {{0, 0.025}, {8, 0.025}, {4, 0.05}, {2, 0.15}, {13, 0.05 / 3}};
    jali_picture p = random_picture(5, 64, 64, true);
    for (int i = 0; i < 5; i++) {
        jali_place_options opt = jali_place_defaults();
        opt.grid = cases[i].grid;
        CHECK_OK(jali_place(ctx, &p, 128, &opt, &chart, &drawing));
        CHECK(fabs(jali_chart_pixel_mm(&chart) - cases[i].pixel_mm) < 0.005 * cases[i].pixel_mm);
        jali_bitmap_free(ctx, &drawing);
    }
    jali_picture_free(ctx, &p);
}

TEST(impossible_sizes_are_sentences)
{
    jali_picture p = random_picture(4, 100, 50, true);
    jali_place_options opt = jali_place_defaults();
#define REFUSED(change, status, words) (opt = jali_place_defaults(), change, refused(&p, opt, status, words))
    REFUSED(opt.width_mm = 0, JALI_BAD_VALUE, "a width or a height");
    REFUSED(opt.width_mm = -1, JALI_BAD_VALUE, "not -1");
    REFUSED(opt.width_mm = NAN, JALI_BAD_VALUE, "not ");
    REFUSED(opt.width_mm = INFINITY, JALI_BAD_VALUE, "not inf");
    REFUSED(opt.height_mm = 36, JALI_BAD_VALUE, "70 mm wide makes it 35 mm high");
    REFUSED(opt.phi_s_mm = 0, JALI_BAD_VALUE, "phi_s");
    REFUSED(opt.phi_v_mm = -1, JALI_BAD_VALUE, "phi_v");
    REFUSED(opt.phi_e_mm = NAN, JALI_BAD_VALUE, "phi_e");
    REFUSED(opt.frame_mm = -1, JALI_BAD_VALUE, "frame");
    REFUSED(opt.width_mm = 1, JALI_NO_RESULT, "narrowest feature");
    REFUSED(opt.pixel_mm = 1e-5, JALI_NO_RESULT, "coarser");
    REFUSED(opt.grid = 1, JALI_BAD_VALUE, "2 .. 64");
    jali_picture flat = random_picture(4, 1000, 2, true);
    opt = jali_place_defaults();
    opt.width_mm = 9000;
    opt.pixel_mm = 0.0123; // fewer than 2^20 pixels, but fewer than 16 lattice units each
    refused(&flat, opt, JALI_NO_RESULT, "or more is needed");
    jali_picture_free(ctx, &flat);
    opt = jali_place_defaults();
    opt.height_mm = 35.2; // within 1 %
    CHECK_OK(jali_place(ctx, &p, 128, &opt, &chart, &drawing));
    jali_bitmap_free(ctx, &drawing);
    opt.width_mm = 0;
    CHECK_OK(jali_place(ctx, &p, 128, &opt, &chart, &drawing));
    CHECK(fabs(jali_chart_pixel_mm(&chart) * chart.height_px - 35.2) < 0.04);
    jali_bitmap_free(ctx, &drawing);
    CHECK_STATUS(jali_place(ctx, &p, 0, NULL, &chart, &drawing), JALI_BAD_VALUE);
    jali_picture_free(ctx, &p);
}

TEST(threads_do_not_change_the_drawing)
{
    jali_picture p = random_picture(4, 300, 200, false);
    for (int32_t columns = 150; columns <= 900; columns += 750) {
        jali_bitmap first = {0};
        jali_place_options opt = grid_of(columns, 1);
        CHECK_OK(jali_place(ctx, &p, 128, &opt, &chart, &first));
        for (int32_t threads = 1; threads <= 3; threads += 2) {
            jali_context_options own = jali_context_defaults();
            jali_context *other;
            own.threads = threads;
            CHECK_INT(jali_context_create(&own, &other), JALI_OK);
            CHECK_INT(jali_place(other, &p, 128, &opt, &chart, &drawing), JALI_OK);
            CHECK(same_bitmap(&first, &drawing));
            jali_bitmap_free(other, &drawing);
            jali_context_free(other);
        }
        jali_bitmap_free(ctx, &first);
    }
    jali_picture_free(ctx, &p);
}

static jali_status place_one(jali_context *limited, void *picture)
{
    jali_place_options opt = grid_of(90, 1);
    jali_status status = jali_place(limited, picture, 128, &opt, &chart, &drawing);
    jali_bitmap_free(limited, &drawing);
    return status;
}

TEST(each_allocation_may_be_refused)
{
    jali_picture p = random_picture(4, 30, 20, false);
    refuse_each_allocation(place_one, &p);
    jali_picture_free(ctx, &p);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(resampling_is_its_formula),
        CASE(bits_beyond_the_width_are_zero),
        CASE(a_straight_edge_keeps_its_place),
        CASE(paper_keeps_the_input_pixels),
        CASE(a_coarser_grid_keeps_the_growth_whole),
        CASE(input_pixels_are_found_at_any_fineness),
        CASE(the_lattice_holds_every_coordinate_in_float32),
        CASE(impossible_sizes_are_sentences),
        CASE(threads_do_not_change_the_drawing),
        CASE(each_allocation_may_be_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
