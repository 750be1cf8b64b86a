// The built-in pictures: the drawing board against its definition, and every sample by its hash.
#include "testing.h"
#include "sample/draw.h"

#include <math.h>
#include <jali/sample.h>

TEST(direction_is_the_sine_and_cosine)
{
    for (int32_t i = -2000; i <= 2000; i++) {
        double turns = i / 797.0;
        spot d = direction(turns);
        CHECK(fabs(d.x - cos(turns * 2 * M_PI)) < 1e-14 && fabs(d.y - sin(turns * 2 * M_PI)) < 1e-14);
    }
    CHECK(direction(0.25).y == 1 && direction(0.5).x == -1 && direction(-0.25).y == -1);
}

// Winding number of a point by the angle it sees, a slow formula of its own.
static bool inside_polygon(const spot *p, int32_t count, spot q)
{
    double sum = 0;
    for (int32_t i = 0; i < count; i++) {
        spot a = minus(p[i], q), z = minus(p[(i + 1) % count], q);
        sum += atan2(a.x * z.y - a.y * z.x, a.x * z.x + a.y * z.y);
    }
    return fabs(sum) > 3;
}

TEST(board_fills_what_lies_inside)
{
    for (uint64_t seed = 1; seed <= 60; seed++) {
        board b = {.ctx = ctx, .seed = seed};
        spot p[5], centre = at(1000 * next_share(&b), 1000 * next_share(&b));
        double radius = 20 + 400 * next_share(&b);
        for (int32_t i = 0; i < 5; i++) p[i] = at(1400 * next_share(&b) - 200, 1400 * next_share(&b) - 200);
        draw_polygon(&b, WHITE, p, 5);
        draw_disc(&b, BLACK, centre, radius);
        jali_bitmap bitmap;
        int32_t side = 60 + (int32_t)seed;
        CHECK_OK(jali_bitmap_create(ctx, side, side, &bitmap));
        CHECK_OK(rasterise_board(&b, &bitmap));
        for (int32_t y = 0; y < side; y++)
            for (int32_t x = 0; x < side; x++) {
                spot q = at((x + 0.5) * 1000 / side, (y + 0.5) * 1000 / side);
                bool white = inside_polygon(p, 5, q) && length_of(minus(q, centre)) >= radius;
                CHECK_INT(jali_bitmap_get(&bitmap, x, y), white);
            }
        jali_bitmap_free(ctx, &bitmap);
        release(ctx, b.point);
        release(ctx, b.shape);
    }
}

static uint64_t hash_of(const jali_bitmap *bitmap)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (int64_t i = 0; i < bitmap->stride * bitmap->height_px; i++)
        hash = (hash ^ bitmap->word[i]) * UINT64_C(1099511628211);
    return hash;
}

// A change of a picture changes README, benches and figures: it is meant to be noticed here.
static const struct {
    const char *name;
    uint64_t hash;
} golden[] = {
    {"girih", UINT64_C(0x9bf721a42cf5e549)},     {"tree", UINT64_C(0x027b12f72ac56111)},
    {"mask", UINT64_C(0xdda762ccdefba962)},      {"lettering", UINT64_C(0xc3203beae9c073c0)},
    {"sunflower", UINT64_C(0x7ad1076971bebd2e)}, {"spiral", UINT64_C(0x80450b88e6a22351)},
    {"rings", UINT64_C(0x45e7748f420ee3f5)},     {"halftone", UINT64_C(0x2554c39a71c9dca8)},
    {"stripes", UINT64_C(0xae91e1e981f3449d)},   {"checkerboard", UINT64_C(0xc759c4d67c60c225)},
};

TEST(samples_are_the_same_on_any_number_of_threads)
{
    int32_t count;
    const jali_sample_info *info = jali_sample_list(&count);
    CHECK_INT(count, sizeof golden / sizeof *golden);
    for (int32_t threads = 1; threads <= 3; threads++) {
        jali_context_options opt = jali_context_defaults();
        opt.threads = threads;
        jali_context *own;
        CHECK_INT(jali_context_create(&opt, &own), JALI_OK);
        for (int32_t i = 0; i < count; i++) {
            jali_bitmap bitmap;
            CHECK_INT(jali_sample(own, info[i].name, 300, &bitmap), JALI_OK);
            assert_string_equal(info[i].name, golden[i].name);
            if (hash_of(&bitmap) != golden[i].hash)
                print_error("    {\"%s\", UINT64_C(0x%016llx)},\n", info[i].name,
                            (unsigned long long)hash_of(&bitmap));
            CHECK(hash_of(&bitmap) == golden[i].hash);
            jali_bitmap_free(own, &bitmap);
        }
        jali_context_free(own);
    }
}

// The pictures do not depend on the size: the share of white at 1100 and at 2003 px is nearly the same.
TEST(samples_keep_their_shape_at_any_size)
{
    int32_t count;
    const jali_sample_info *info = jali_sample_list(&count);
    for (int32_t i = 0; i < count; i++) {
        double share[2];
        for (int32_t k = 0; k < 2; k++) {
            jali_bitmap bitmap;
            int32_t side = k ? 2003 : 1100;
            int64_t white = 0;
            CHECK_OK(jali_sample(ctx, info[i].name, side, &bitmap));
            for (int64_t w = 0; w < bitmap.stride * side; w++) white += __builtin_popcountll(bitmap.word[w]);
            share[k] = (double)white / side / side;
            jali_bitmap_free(ctx, &bitmap);
        }
        CHECK(share[0] > 0.05 && share[0] < 0.95);
        CHECK(fabs(share[0] - share[1]) < 0.01);
    }
}

TEST(bad_names_and_sizes_are_refused)
{
    jali_bitmap bitmap;
    CHECK_STATUS(jali_sample(ctx, "lion", 100, &bitmap), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "girih, tree") && strstr(jali_message(ctx), "and checkerboard"));
    CHECK_STATUS(jali_sample(ctx, "tree", 15, &bitmap), JALI_BAD_VALUE);
    CHECK_STATUS(jali_sample(ctx, "tree", 32769, &bitmap), JALI_BAD_VALUE);
    CHECK(bitmap.word == NULL);
}

static jali_status draw_one(jali_context *limited, void *name)
{
    jali_bitmap bitmap;
    jali_status status = jali_sample(limited, name, 64, &bitmap);
    jali_bitmap_free(limited, &bitmap);
    return status;
}

TEST(each_allocation_may_be_refused)
{
    refuse_each_allocation(draw_one, (char[]){"rings"});
    refuse_each_allocation(draw_one, (char[]){"girih"});
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(direction_is_the_sine_and_cosine),
        CASE(board_fills_what_lies_inside),
        CASE(samples_are_the_same_on_any_number_of_threads),
        CASE(samples_keep_their_shape_at_any_size),
        CASE(bad_names_and_sizes_are_refused),
        CASE(each_allocation_may_be_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
