// smallest: what is lost in drawn pictures, and the size from which nothing is, against what stripes need.
#include "testing.h"

#include <jali/smallest.h>
#include "raster/raster.h"

#include <math.h>

enum { SIDE = 64 };

// A black square with a white dot, a white piece with a hair, and a white block with two voids.
static jali_bitmap scene(void)
{
    jali_bitmap b;
    CHECK_OK(jali_bitmap_create(ctx, SIDE, SIDE, &b));
    for (int32_t y = 4; y < 8; y++) paint_run(&b, y, 4, 8, true);      // dot, 16 px
    for (int32_t y = 12; y < 30; y++) paint_run(&b, y, 4, 20, true);   // piece
    for (int32_t y = 20; y < 22; y++) paint_run(&b, y, 20, 50, true);  // its hair, 30 px
    for (int32_t y = 36; y < 62; y++) paint_run(&b, y, 4, 60, true);   // block
    for (int32_t y = 40; y < 44; y++) paint_run(&b, y, 8, 12, false);  // small void
    for (int32_t y = 50; y < 54; y++) paint_run(&b, y, 10, 50, false); // slot, 40 px
    return b;
}

typedef struct found {
    jali_bitmap picture;
    jali_reference reference;
    jali_prediction print;
    jali_lost lost;
} found;

static found begin(void)
{
    found f = {.picture = scene()};
    jali_predict_options opt = jali_predict_defaults();
    opt.picture_mm = 20;
    CHECK_OK(jali_reference_create(ctx, &f.picture, &opt, &f.reference));
    CHECK_OK(jali_bitmap_copy(ctx, &f.reference.picture, &f.print.printed));
    return f;
}

// Paint pixels of the picture into its print.
static void print_box(found *f, int32_t x0, int32_t y0, int32_t x1, int32_t y1, bool white)
{
    int32_t k = f->reference.factor;
    for (int32_t y = y0 * k; y < y1 * k; y++) paint_run(&f->print.printed, y, x0 * k, x1 * k, white);
}

static void expect(found *f, const jali_lost_options *opt, int32_t white_parts, int32_t black_parts,
                   int32_t white_stretches, int32_t black_stretches)
{
    CHECK_OK(jali_find_lost(ctx, &f->reference, &f->print, opt, &f->lost));
    CHECK_INT(f->lost.white.parts, white_parts);
    CHECK_INT(f->lost.black.parts, black_parts);
    CHECK_INT(f->lost.white.stretches, white_stretches);
    CHECK_INT(f->lost.black.stretches, black_stretches);
    CHECK_INT(any_white(ctx, &f->lost.where),
              white_parts + black_parts + white_stretches + black_stretches > 0);
    jali_lost_free(ctx, &f->lost);
}

static void end(found *f)
{
    jali_bitmap_free(ctx, &f->picture);
    jali_reference_free(ctx, &f->reference);
    jali_prediction_free(ctx, &f->print);
}

TEST(parts_and_stretches_that_do_not_print_are_counted_once)
{
    found f = begin();
    expect(&f, NULL, 0, 0, 0, 0);
    print_box(&f, 4, 4, 8, 8, false); // the dot: a part, and no stretch besides
    expect(&f, NULL, 1, 0, 0, 0);
    print_box(&f, 30, 20, 50, 22, false); // most of the hair
    expect(&f, NULL, 1, 0, 1, 0);
    print_box(&f, 8, 40, 12, 44, true); // the small void
    expect(&f, NULL, 1, 1, 1, 0);
    print_box(&f, 20, 50, 40, 54, true); // half of the slot
    expect(&f, NULL, 1, 1, 1, 1);
    print_box(&f, 10, 50, 50, 54, true); // all of it: a part now
    expect(&f, NULL, 1, 2, 1, 0);
    end(&f);
}

TEST(what_is_below_a_speck_is_no_detail_and_a_pixel_shows_a_part)
{
    found f = begin();
    jali_lost_options opt = jali_lost_defaults();
    print_box(&f, 4, 4, 8, 8, false);
    opt.least_px = 16;
    expect(&f, &opt, 1, 0, 0, 0);
    opt.least_px = 17;
    expect(&f, &opt, 0, 0, 0, 0);
    opt.least_px = 8;
    print_box(&f, 7, 7, 8, 8, true);
    expect(&f, &opt, 0, 0, 0, 0);
    print_box(&f, 43, 20, 50, 22, false); // 7 px of the hair's end, and then 8
    expect(&f, &opt, 0, 0, 0, 0);
    print_box(&f, 41, 20, 50, 22, false);
    expect(&f, &opt, 0, 0, 1, 0);
    opt.least_px = 0;
    CHECK_STATUS(jali_find_lost(ctx, &f.reference, &f.print, &opt, &f.lost), JALI_BAD_VALUE);
    end(&f);
}

// A bridge across the slot: no loss where it is known as one.
TEST(bridges_are_no_loss)
{
    found f = begin();
    jali_lost_options opt = jali_lost_defaults();
    jali_bitmap bridges;
    CHECK_OK(jali_bitmap_create(ctx, 2 * SIDE + 20, 2 * SIDE + 20, &bridges)); // finer, in a margin of 10
    for (int32_t y = 100; y < 108; y++) paint_run(&bridges, y + 10, 40 + 10, 56 + 10, true);
    print_box(&f, 20, 50, 28, 54, true);
    expect(&f, &opt, 0, 0, 0, 1);
    opt.bridges = &bridges;
    opt.margin_px = 10;
    expect(&f, &opt, 0, 0, 0, 0);
    print_box(&f, 16, 50, 32, 54, true); // it comes out 4 px wider to each side
    opt.reach_px = 3;
    expect(&f, &opt, 0, 0, 0, 0);
    print_box(&f, 16, 50, 42, 54, true); // but not 14
    expect(&f, &opt, 0, 0, 0, 1);
    print_box(&f, 10, 50, 50, 54, true); // nor may it fill a void
    expect(&f, &opt, 0, 1, 0, 0);
    jali_bitmap_free(ctx, &bridges);
    end(&f);
}

// Upright stripes from border to border, as wide as the gaps between them.
static jali_picture stripes(int32_t side, int32_t pitch)
{
    jali_picture p = {.width_px = side, .height_px = side};
    CHECK_OK(ALLOCATE(ctx, p.grey, side * side));
    for (int32_t i = 0; i < side * side; i++) p.grey[i] = i % side % pitch < pitch / 2 ? 255 : 0;
    return p;
}

// In the print a bar is at least phi_s + phi_e and a gap phi_v - phi_e wide: both fit when the pitch is
// phi_s + phi_v; on the working grid each is up to a pixel more.
TEST(stripes_are_whole_from_the_size_at_which_bar_and_gap_fit)
{
    jali_options opt = jali_defaults();
    jali_smallest_options range = jali_smallest_defaults();
    range.least_mm = 4;
    range.most_mm = 200;
    for (int32_t pitch = 12; pitch <= 36; pitch += 24) {
        jali_smallest s;
        jali_picture p = stripes(180, pitch);
        double wanted_mm = 180.0 / pitch * (opt.optimise.phi_s_mm + opt.optimise.phi_v_mm);
        CHECK_OK(jali_find_smallest(ctx, &p, &opt, &range, &s));
        CHECK(s.width_mm > 0.9 * wanted_mm && s.width_mm < 1.15 * wanted_mm);
        CHECK(s.confirmed_mm > s.width_mm);
        bool below = false;
        for (int32_t i = 0; i < s.try_count; i++) {
            const jali_smallest_try *t = &s.tried[i];
            CHECK(t->whole ==
                  (t->pixel_mm > 0 &&
                   t->white.parts + t->white.stretches + t->black.parts + t->black.stretches == 0));
            below |= !t->coarse && !t->whole && t->width_mm >= s.width_mm / (1 + range.precision) - 1e-9;
        }
        CHECK(below); // it is the smallest to the precision that was asked for
        jali_picture_free(ctx, &p);
    }
}

TEST(what_no_size_keeps_is_said_so_and_bad_ranges_are_refused)
{
    jali_options opt = jali_defaults();
    jali_smallest_options range = {5, 12, 0.05, 8};
    jali_smallest s;
    jali_picture p = stripes(200, 4);
    CHECK_OK(jali_find_smallest(ctx, &p, &opt, &range, &s));
    CHECK(s.width_mm == 0 && s.try_count >= 3 && s.tried[s.try_count - 1].width_mm == 12);
    static const jali_smallest_options bad[] = {{0, 10, 0.1, 8},  {10, 10, 0.1, 8}, {NAN, 10, 0.1, 8},
                                                {1, 1e9, 0.1, 8}, {1, 10, 0, 8},    {1, 10, 0.1, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK_STATUS(jali_find_smallest(ctx, &p, &opt, &bad[i], &s), JALI_BAD_VALUE);
    jali_picture_free(ctx, &p);
}

TEST(the_same_for_any_number_of_threads)
{
    jali_smallest s[2];
    jali_smallest_options range = {5, 30, 0.2, 8};
    jali_context *alone;
    jali_context_options one = jali_context_defaults();
    one.threads = 1;
    CHECK_OK(jali_context_create(&one, &alone));
    jali_picture p = stripes(100, 20);
    CHECK_OK(jali_find_smallest(ctx, &p, NULL, &range, &s[0]));
    CHECK_OK(jali_find_smallest(alone, &p, NULL, &range, &s[1]));
    CHECK_INT(s[0].try_count, s[1].try_count);
    CHECK(s[0].width_mm == s[1].width_mm);
    jali_picture_free(ctx, &p);
    jali_context_free(alone);
}

static jali_status find(jali_context *limited, void *data)
{
    jali_smallest s;
    jali_smallest_options range = {2, 2.5, 1, 8};
    return jali_find_smallest(limited, data, NULL, &range, &s);
}

TEST(each_allocation_may_be_refused)
{
    jali_picture p = stripes(16, 8);
    refuse_each_allocation(find, &p);
    jali_picture_free(ctx, &p);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(parts_and_stretches_that_do_not_print_are_counted_once),
        CASE(what_is_below_a_speck_is_no_detail_and_a_pixel_shows_a_part),
        CASE(bridges_are_no_loss),
        CASE(stripes_are_whole_from_the_size_at_which_bar_and_gap_fit),
        CASE(what_no_size_keeps_is_said_so_and_bad_ranges_are_refused),
        CASE(the_same_for_any_number_of_threads),
        CASE(each_allocation_may_be_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
