// Pictures once around: the same wherever the circle is cut, widths and one piece across the seam, solids.
#include "pictures.h"
#include "testing.h"

#include <jali/jali.h>
#include "raster/raster.h"

#include <math.h>
#include <stdlib.h>

// Waves that close after `width` columns: white where they are above a level.
static jali_picture waves(uint64_t *seed, int32_t width, int32_t height, int32_t shift)
{
    jali_picture picture = {.width_px = width, .height_px = height};
    double wave[6][4];
    for (int i = 0; i < 6; i++) {
        wave[i][0] = (double)((int)(next_random(seed) >> 61) - 3);
        wave[i][1] = (double)((int)(next_random(seed) >> 61) - 3);
        wave[i][2] = (double)(next_random(seed) >> 40) / (1 << 24) * 2 * M_PI;
        wave[i][3] = 0.5 + (double)(next_random(seed) >> 40) / (1 << 24);
    }
    CHECK_OK(ALLOCATE(ctx, picture.grey, (size_t)width * (size_t)height));
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) {
            double sum = 0;
            for (int i = 0; i < 6; i++)
                sum += wave[i][3] * cos(wave[i][0] * 2 * M_PI * (x + shift) / width +
                                        wave[i][1] * 2 * M_PI * y / height + wave[i][2]);
            picture.grey[(size_t)y * (size_t)width + (size_t)x] = sum > -0.4 ? 255 : 0;
        }
    return picture;
}

static jali_options options(int32_t repeat)
{
    jali_options opt = jali_defaults();
    opt.place.frame_mm = 1;
    opt.place.width_mm = 0;
    opt.around = true;
    opt.repeat = repeat;
    opt.predict = false;
    return opt;
}

static void carve_around(const char *surface, jali_picture *picture, const jali_options *opt,
                         jali_result *result, jali_object *object)
{
    jali_surface s;
    CHECK_OK(jali_surface_make(ctx, surface, NULL, &s));
    CHECK_OK(jali_make_on(ctx, &s, NULL, picture, opt, 1, result, object));
}

// The mask's columns between its margins, turned.
static jali_bitmap ring_of(const jali_result *r, int32_t turn)
{
    int32_t margin = r->chart.margin_px, width = r->chart.width_px - 2 * margin;
    jali_bitmap ring;
    CHECK_OK(jali_bitmap_create(ctx, width, r->chart.height_px, &ring));
    for (int32_t y = 0; y < ring.height_px; y++)
        for (int32_t x = 0; x < width; x++)
            jali_bitmap_set(&ring, x, y, jali_bitmap_get(&r->optimised.mask, margin + (x + turn) % width, y));
    return ring;
}

// Widths as jali_adapt_details judges them, with the seam in the middle of a strip of two turns.
static void check_widths(const jali_result *r)
{
    jali_bitmap ring = ring_of(r, r->chart.width_px / 2 - r->chart.margin_px), twice;
    CHECK_OK(jali_bitmap_create(ctx, 2 * ring.width_px, ring.height_px, &twice));
    paste(ctx, &ring, 0, 0, &twice);
    paste(ctx, &ring, ring.width_px, 0, &twice);
    jali_adapt_options widths = jali_adapt_defaults();
    widths.growth_px = r->optimised.kernels_px[0];
    widths.solid_px = r->optimised.kernels_px[1];
    widths.void_px = r->optimised.kernels_px[2];
    widths.epsilon_px = (int32_t)floor(4 / jali_chart_pixel_mm(&r->chart));
    widths.isolated_matters = true;
    widths.outside_solid = true;
    for (int white = 0; white < 2; white++) {
        jali_details found;
        CHECK_OK(jali_adapt_details(ctx, &twice, white, &widths, &found));
        int32_t quarter = ring.width_px / 2, seen = 0; // what the strip's own ends cut is not looked at
        for (int t = JALI_TYPE_A; t <= JALI_TYPE_B; t++)
            for (int32_t y = 0; y < twice.height_px; y++)
                for (int32_t x = quarter; x < 3 * quarter; x++) seen += jali_bitmap_get(&found.type[t], x, y);
        CHECK_INT(seen, 0);
        jali_details_free(ctx, &found);
    }
    jali_bitmap_free(ctx, &ring);
    jali_bitmap_free(ctx, &twice);
}

TEST(random_waves_go_around_as_solids)
{
    int32_t crossing = 0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        uint64_t random = seed;
        jali_picture picture = waves(&random, 120, 60 + 20 * (int32_t)(seed % 3), 0);
        jali_options opt = options(1 + (int32_t)(seed % 3));
        jali_result r;
        jali_object o;
        carve_around(seed % 2 ? "cylinder:r=9,h=60,tolerance=0.1" : "vase:column,h=70,r=9,tolerance=0.1",
                     &picture, &opt, &r, &o);
        CHECK(r.one_piece && r.printable && o.one_piece && o.closed);
        if (!r.chart.metric) check_widths(&r);
        int32_t margin = r.chart.margin_px, last = r.chart.width_px - margin - 1, open = 0;
        for (int32_t y = 0; y < r.chart.height_px; y++)
            open += !jali_bitmap_get(&r.optimised.mask, margin, y) &&
                    !jali_bitmap_get(&r.optimised.mask, last, y);
        crossing += open > 0;
        jali_result_free(ctx, &r);
        jali_object_free(ctx, &o);
        jali_picture_free(ctx, &picture);
    }
    CHECK(crossing >= 4); // voids lie across the seam, not only beside it
}

// A ring of void all around, and a disc in it: bridges hold the upper rim as well as the disc.
TEST(what_the_circle_parts_is_joined)
{
    for (int32_t repeat = 1; repeat <= 3; repeat++) {
        jali_picture picture = {.width_px = 120, .height_px = 30};
        jali_options opt = options(repeat);
        jali_result r;
        jali_object o;
        CHECK_OK(ALLOCATE_CLEARED(ctx, picture.grey, 120 * 30));
        for (int32_t y = 0; y < 30; y++)
            for (int32_t x = 0; x < 120; x++)
                if (hypot(x - 118, y - 15) < 8) picture.grey[120 * y + x] = 255;
        carve_around("cylinder:r=9,h=50,tolerance=0.1", &picture, &opt, &r, &o);
        CHECK(r.one_piece && r.printable && o.one_piece && o.closed);
        check_widths(&r);
        jali_result_free(ctx, &r);
        jali_object_free(ctx, &o);
        jali_picture_free(ctx, &picture);
    }
}

// Half a turn of the picture is half a turn of the mask, and of the object: same volume, faces to spare.
TEST(a_shifted_picture_gives_the_object_turned)
{
    double volume[2];
    jali_bitmap ring[2];
    for (int shifted = 0; shifted < 2; shifted++) {
        uint64_t random = 5;
        jali_picture picture = waves(&random, 128, 80, shifted * 64);
        jali_options opt = options(1);
        jali_result r;
        jali_object o;
        carve_around("cylinder:r=9,h=50,facets=64", &picture, &opt, &r, &o);
        CHECK(o.closed && o.one_piece);
        volume[shifted] = o.check.volume_mm3;
        int32_t width = r.chart.width_px - 2 * r.chart.margin_px;
        ring[shifted] = ring_of(&r, shifted ? 0 : width / 2);
        jali_result_free(ctx, &r);
        jali_object_free(ctx, &o);
        jali_picture_free(ctx, &picture);
    }
    int64_t apart = count_combined(ctx, RULE_XOR, &ring[0], &ring[1]);
    int64_t all = (int64_t)ring[0].width_px * ring[0].height_px;
    print_message("%lld of %lld pixels apart, volumes %.3f and %.3f\n", (long long)apart, (long long)all,
                  volume[0], volume[1]);
    CHECK(apart * 1000 < all);
    CHECK(fabs(volume[0] - volume[1]) < 2e-3 * volume[0]);
    for (int i = 0; i < 2; i++) jali_bitmap_free(ctx, &ring[i]);
}

// Every column is the first one in turn: equal contours, cut elsewhere, have equal areas.
TEST(contours_are_cut_at_the_same_heights)
{
    uint64_t random = 3;
    jali_picture picture = waves(&random, 120, 80, 0);
    jali_options opt = options(1);
    jali_result r;
    jali_object o;
    carve_around("cylinder:r=9,h=50,tolerance=0.1", &picture, &opt, &r, &o);
    int32_t left = r.chart.margin_px * r.chart.pixel_units;
    int32_t right = (r.chart.width_px - r.chart.margin_px) * r.chart.pixel_units;
    int64_t sum[2] = {0}, count[2] = {0};
    for (int32_t i = 0; i < r.contours.point_count; i++) {
        const int32_t *p = r.contours.point[i];
        CHECK(p[0] >= left && p[0] <= right);
        for (int side = 0; side < 2; side++)
            if (p[0] == (side ? right : left)) {
                uint64_t hash = (uint64_t)(uint32_t)p[1] * UINT64_C(0x9e3779b97f4a7c15);
                sum[side] += (int64_t)(hash >> 20);
                count[side]++;
            }
    }
    CHECK(count[0] > 0 && count[0] == count[1] && sum[0] == sum[1]);
    jali_result_free(ctx, &r);
    jali_object_free(ctx, &o);
    jali_picture_free(ctx, &picture);
}

TEST(what_cannot_go_around_is_refused)
{
    static const char *const surface[] = {"cone:r=20,h=40", "plate:w=40,h=40", "cylinder:r=9,h=20"};
    for (int i = 0; i < 3; i++) {
        uint64_t random = 1;
        jali_picture picture = waves(&random, 40, 40, 0);
        jali_options opt = options(1);
        jali_result r;
        jali_object o;
        jali_surface s;
        if (i == 2) opt.place.width_mm = 20;
        CHECK_OK(jali_surface_make(ctx, surface[i], NULL, &s));
        CHECK_STATUS(jali_make_on(ctx, &s, NULL, &picture, &opt, 1, &r, &o), JALI_BAD_VALUE);
        CHECK(strstr(jali_message(ctx), "around") != NULL);
        jali_picture_free(ctx, &picture);
    }
}

static jali_status around_some(jali_context *limited, void *data)
{
    const jali_bitmap *drawing = data;
    jali_chart chart = {.width_px = drawing->width_px,
                        .height_px = drawing->height_px,
                        .margin_px = 8,
                        .outside_solid = true,
                        .pixel_units = 64,
                        .unit_mm = 0.1 / 64};
    jali_optimise_options opt = jali_optimise_defaults();
    jali_optimised result = {0};
    jali_contours contours = {0};
    jali_status status;
    int32_t pieces;
    opt.details = true;
    TRY(jali_optimise_around(limited, drawing, &chart, 2, &opt, &result, &pieces));
    CHECK_INT(pieces, 1);
    TRY(jali_trace_around(limited, &result.mask, &chart, NULL, &contours));
done:
    jali_optimised_free(limited, &result);
    jali_contours_free(limited, &contours);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_bitmap drawing;
    CHECK_OK(jali_bitmap_create(ctx, 96, 60, &drawing));
    fill(ctx, &drawing, true);
    for (int32_t y = 16; y < 44; y++)
        for (int32_t x = 8; x < 88; x++)
            jali_bitmap_set(&drawing, x, y, (x - 8) % 40 > 9 && (x - 8) % 40 < 34);
    refuse_each_allocation(around_some, &drawing);
    jali_bitmap_free(ctx, &drawing);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(random_waves_go_around_as_solids),          RUN(what_the_circle_parts_is_joined),
        RUN(a_shifted_picture_gives_the_object_turned), RUN(contours_are_cut_at_the_same_heights),
        RUN(what_cannot_go_around_is_refused),          RUN(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
