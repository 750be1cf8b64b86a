// The toolbox for scans: grey pictures, maps between planes, and finding a drawn plate in a photograph of it.
#include "testing.h"
#include "scan/align.h"
#include "scan/least.h"
#include "scan/outline.h"

#include <math.h>

static double uniform(uint64_t *seed, double from, double to)
{
    return from + (to - from) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// --- Grey pictures

TEST(a_shrunk_picture_holds_the_mean_of_its_pixels)
{
    uint8_t level[6] = {0, 51, 255, 255, 255, 0};
    jali_picture picture = {.width_px = 3, .height_px = 2, .grey = level};
    grey g;
    CHECK_OK(grey_of_picture(ctx, &picture, 2, &g));
    CHECK_INT(g.width, 2);
    CHECK_INT(g.height, 1);
    CHECK(fabs((double)g.level[0] - (0 + 51 + 255 + 255) / 4.0 / 255) < 1e-6);
    CHECK(fabs((double)g.level[1] - 0.5) < 1e-6);
    CHECK(fabs((double)grey_at(&g, 1, 1) - (double)g.level[0]) < 1e-6); // the centre of a pixel of 2 x 2
    CHECK(fabs((double)grey_at(&g, -9, 9) - (double)g.level[0]) < 1e-6);
    grey_free(ctx, &g);
    grey_free(ctx, &g);
}

TEST(a_blurred_point_has_the_deviation_asked_for_and_keeps_its_sum)
{
    enum { SIDE = 161 };
    for (double deviation = 1; deviation < 14; deviation *= 1.7) {
        grey g;
        double sum = 0, spread = 0;
        CHECK_OK(grey_create(ctx, SIDE, SIDE, 1, &g));
        memset(g.level, 0, SIDE * SIDE * sizeof *g.level);
        g.level[SIDE * (SIDE / 2) + SIDE / 2] = 1;
        CHECK_OK(grey_blur(ctx, &g, deviation));
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                sum += (double)g.level[SIDE * y + x];
                spread += (double)g.level[SIDE * y + x] * (x - SIDE / 2) * (x - SIDE / 2);
            }
        CHECK(fabs(sum - 1) < 1e-4);
        CHECK(fabs(sqrt(spread) - deviation) < 0.5);
        grey_free(ctx, &g);
    }
}

TEST(a_normalised_picture_does_not_depend_on_light)
{
    enum { SIDE = 96 };
    uint64_t seed = 5;
    grey plain, lit;
    CHECK_OK(grey_create(ctx, SIDE, SIDE, 1, &plain));
    CHECK_OK(grey_create(ctx, SIDE, SIDE, 1, &lit));
    for (int i = 0; i < SIDE * SIDE; i++) {
        plain.level[i] = (float)(next_random(&seed) >> 63);
        lit.level[i] = (float)(0.3 + 0.002 * (i % SIDE) + 0.25 * (double)plain.level[i]);
    }
    CHECK_OK(grey_normalise(ctx, &plain, 8));
    CHECK_OK(grey_normalise(ctx, &lit, 8));
    for (int i = 0; i < SIDE * SIDE; i++) CHECK(fabs((double)(plain.level[i] - lit.level[i])) < 0.12);
    grey_free(ctx, &plain);
    grey_free(ctx, &lit);
}

// --- Maps

static homography random_map(uint64_t *seed)
{
    homography h = {{uniform(seed, -3, 3), uniform(seed, -3, 3), uniform(seed, -200, 200),
                     uniform(seed, -3, 3), uniform(seed, -3, 3), uniform(seed, -200, 200),
                     uniform(seed, -1e-3, 1e-3), uniform(seed, -1e-3, 1e-3), 1}};
    return h;
}

TEST(maps_are_found_from_points_inverted_and_chained)
{
    for (uint64_t seed = 1; seed <= 300; seed++) {
        uint64_t s = seed * 7919;
        homography h = random_map(&s), found, inverse;
        if (!homography_inverse(&h, &inverse)) continue;
        double from[9][2], to[9][2], place[2], back[2];
        for (int i = 0; i < 9; i++) {
            from[i][0] = 100.0 * (i % 3) + uniform(&s, -20, 20);
            from[i][1] = 100.0 * (i / 3) + uniform(&s, -20, 20);
            homography_apply(&h, from[i], to[i]);
        }
        if (fabs(h.m[0] * h.m[4] - h.m[1] * h.m[3]) < 0.1) continue;
        CHECK(homography_of_points(9, (const double(*)[2])from, (const double(*)[2])to, &found));
        homography chained = homography_after(&inverse, &found);
        for (int i = 0; i < 9; i++) {
            homography_apply(&found, from[i], place);
            CHECK(hypot(place[0] - to[i][0], place[1] - to[i][1]) < 1e-5 * (1 + hypot(to[i][0], to[i][1])));
            homography_apply(&chained, from[i], back);
            CHECK(hypot(back[0] - from[i][0], back[1] - from[i][1]) < 1e-3);
        }
    }
}

TEST(a_map_of_points_on_a_line_is_refused)
{
    const double line[4][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}},
                 square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    homography h;
    CHECK(!homography_of_points(4, line, square, &h));
    CHECK(!homography_of_points(3, square, square, &h));
    CHECK(homography_of_points(4, square, square, &h));
}

TEST(the_scale_of_a_map_is_how_lengths_grow)
{
    homography h = {{0, -3, 50, 3, 0, 20, 0, 0, 1}};
    CHECK(fabs(homography_scale(&h, (double[]){10, 10}) - 3) < 1e-12);
}

// --- Outline

TEST(the_outline_of_a_turned_rectangle_is_its_corners)
{
    jali_bitmap b;
    double corner[4][2];
    bool found;
    CHECK_OK(jali_bitmap_create(ctx, 300, 260, &b));
    double c = cos(0.3), s = sin(0.3);
    for (int y = 0; y < 260; y++)
        for (int x = 0; x < 300; x++) {
            double u = c * (x + 0.5 - 150) + s * (y + 0.5 - 130),
                   v = -s * (x + 0.5 - 150) + c * (y + 0.5 - 130);
            jali_bitmap_set(&b, x, y, fabs(u) < 100 && fabs(v) < 60 && !(fabs(u) < 80 && fabs(v) < 40));
        }
    CHECK_OK(outline_of_bitmap(ctx, &b, corner, &found));
    CHECK(found);
    for (int k = 0; k < 4; k++) {
        double u = c * (corner[k][0] - 150) + s * (corner[k][1] - 130),
               v = -s * (corner[k][0] - 150) + c * (corner[k][1] - 130);
        CHECK(fabs(fabs(u) - 100) < 2 && fabs(fabs(v) - 60) < 2);
    }
    jali_bitmap_free(ctx, &b);
}

// --- A plate in a scan

enum { PLATE_W = 420, PLATE_H = 300, MARGIN = 30 };

// A plate that has no symmetry: a frame, bars, a disc, a wedge.
static bool solid_at(double x, double y)
{
    if (x < 0 || y < 0 || x > PLATE_W || y > PLATE_H) return false;
    if (x < 24 || y < 24 || x > PLATE_W - 24 || y > PLATE_H - 24) return true;
    if (hypot(x - 110, y - 100) < 50) return hypot(x - 120, y - 95) < 20;
    if (x > 220 && x < 360 && y > 60 && y < 240) return fmod(x - 220, 28) < 12;
    return !(y > 190 && x < 190 && y - 190 < 0.45 * x - 8);
}

static jali_bitmap plate_drawing(void)
{
    jali_bitmap b;
    CHECK_OK(jali_bitmap_create(ctx, PLATE_W + 2 * MARGIN, PLATE_H + 2 * MARGIN, &b));
    for (int y = 0; y < b.height_px; y++)
        for (int x = 0; x < b.width_px; x++)
            jali_bitmap_set(&b, x, y, solid_at(x + 0.5 - MARGIN, y + 0.5 - MARGIN));
    return b;
}

typedef struct photograph {
    homography map; // drawing to scan
    double solid, hollow, slope_x, slope_y, noise;
    int32_t width, height;
} photograph;

// Draw what a camera would see: four by four rays a pixel, light that falls off, noise.
static jali_picture photographed(const photograph *p, uint64_t *seed)
{
    jali_picture scan = {.width_px = p->width, .height_px = p->height};
    homography inverse;
    CHECK(homography_inverse(&p->map, &inverse));
    CHECK_OK(allocate_array(ctx, &scan.grey, (size_t)(p->width * p->height), 1));
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            double share = 0, at[2];
            for (int k = 0; k < 16; k++) {
                homography_apply(&inverse, (double[]){x + (k % 4 + 0.5) / 4, y + (k / 4 + 0.5) / 4}, at);
                share += solid_at(at[0] - MARGIN, at[1] - MARGIN) / 16.0;
            }
            double light = 1 + p->slope_x * (x - p->width / 2.0) / p->width +
                           p->slope_y * (y - p->height / 2.0) / p->height;
            double level =
                light * (p->hollow + (p->solid - p->hollow) * share) + uniform(seed, -1, 1) * p->noise;
            scan.grey[y * p->width + x] = (uint8_t)fmin(fmax(level * 255 + 0.5, 0), 255);
        }
    return scan;
}

// The plate's four corners somewhere in the scan, each a little off a turned, perhaps mirrored rectangle.
static photograph random_photograph(uint64_t *seed)
{
    photograph p = {.width = 760, .height = 700};
    double angle = uniform(seed, 0, 6.283), scale = uniform(seed, 0.9, 1.2), to[4][2];
    double mirror = next_random(seed) >> 63 ? -1 : 1;
    const double from[4][2] = {{MARGIN, MARGIN},
                               {MARGIN + PLATE_W, MARGIN},
                               {MARGIN + PLATE_W, MARGIN + PLATE_H},
                               {MARGIN, MARGIN + PLATE_H}};
    for (int k = 0; k < 4; k++) {
        double u = mirror * scale * (from[k][0] - MARGIN - PLATE_W / 2.0),
               v = scale * (from[k][1] - MARGIN - PLATE_H / 2.0);
        to[k][0] = p.width / 2.0 + cos(angle) * u - sin(angle) * v + uniform(seed, -12, 12);
        to[k][1] = p.height / 2.0 + sin(angle) * u + cos(angle) * v + uniform(seed, -12, 12);
    }
    CHECK(homography_of_points(4, from, (const double(*)[2])to, &p.map));
    bool dark = next_random(seed) >> 63;
    p.solid = dark ? 0.25 : 0.75;
    p.hollow = dark ? 0.8 : 0.3;
    p.slope_x = uniform(seed, -0.3, 0.3);
    p.slope_y = uniform(seed, -0.3, 0.3);
    p.noise = 0.06;
    return p;
}

TEST(a_plate_is_found_turned_tilted_mirrored_and_in_either_tone)
{
    jali_bitmap drawing = plate_drawing();
    for (uint64_t seed = 1; seed <= 8; seed++) {
        uint64_t s = seed * 104729;
        photograph p = random_photograph(&s);
        jali_picture scan = photographed(&p, &s);
        alignment a;
        double most = 0;
        CHECK_OK(find_in_scan(ctx, &scan, &drawing, 800, &a));
        for (int k = 0; k < 9; k++) {
            double at[2] = {MARGIN + PLATE_W * (k % 3) / 2.0, MARGIN + PLATE_H * (k / 3) / 2.0};
            double wanted[2], got[2];
            homography_apply(&p.map, at, wanted);
            homography_apply(&a.map, at, got);
            most = fmax(most, hypot(got[0] - wanted[0], got[1] - wanted[1]));
        }
        if (!(most < 0.25))
            print_error("seed %d: off by %.2f px, agreement %.3f\n", (int)seed, most, a.agreement);
        CHECK(most < 0.25);
        CHECK(a.agreement > 0.8);
        CHECK_INT(a.negative, p.solid < p.hollow);
        jali_picture_free(ctx, &scan);
    }
    jali_bitmap_free(ctx, &drawing);
}

TEST(a_plate_that_fills_the_scan_is_found)
{
    jali_bitmap drawing = plate_drawing();
    photograph p = {.map = {{1.5, 0.02, -MARGIN * 1.5 + 3, 0.01, 1.5, -MARGIN * 1.5 + 2, 0, 0, 1}},
                    0.8,
                    0.2,
                    0,
                    0,
                    0.02,
                    640,
                    460};
    uint64_t seed = 3;
    jali_picture scan = photographed(&p, &seed);
    alignment a;
    CHECK_OK(find_in_scan(ctx, &scan, &drawing, 800, &a));
    double wanted[2], got[2];
    homography_apply(&p.map, (double[]){300, 200}, wanted);
    homography_apply(&a.map, (double[]){300, 200}, got);
    if (!(hypot(got[0] - wanted[0], got[1] - wanted[1]) < 0.3))
        print_error("off by %.2f px, agreement %.3f\n", hypot(got[0] - wanted[0], got[1] - wanted[1]),
                    a.agreement);
    CHECK(hypot(got[0] - wanted[0], got[1] - wanted[1]) < 0.3);
    jali_picture_free(ctx, &scan);
    jali_bitmap_free(ctx, &drawing);
}

TEST(what_is_not_there_is_not_found)
{
    enum { SIDE = 400 };
    jali_bitmap drawing = plate_drawing();
    uint64_t seed = 11;
    jali_picture scan = {.width_px = SIDE, .height_px = SIDE};
    CHECK_OK(allocate_array(ctx, &scan.grey, SIDE * SIDE, 1));
    for (int kind = 0; kind < 3; kind++) {
        for (int i = 0; i < SIDE * SIDE; i++)
            scan.grey[i] = kind == 0   ? 200
                           : kind == 1 ? (uint8_t)(next_random(&seed) >> 56)
                                       : (uint8_t)(40 + 170 * (hypot(i % SIDE - 190, i / SIDE - 210) < 130));
        alignment a;
        CHECK_OK(find_in_scan(ctx, &scan, &drawing, 400, &a));
        CHECK(a.agreement < 0.5);
    }
    jali_picture_free(ctx, &scan);
    jali_bitmap_free(ctx, &drawing);
}

TEST(the_share_of_solid_is_what_was_drawn_whatever_the_light)
{
    jali_bitmap drawing = plate_drawing();
    uint64_t seed = 77;
    photograph p = random_photograph(&seed);
    jali_picture scan = photographed(&p, &seed);
    grey straight, drawn;
    double off = 0, count = 0;
    CHECK_OK(straighten(ctx, &scan, &drawing, &p.map, 1, &straight));
    CHECK_OK(grey_of_bitmap(ctx, &drawing, 1, &drawn));
    CHECK_OK(share_of_solid(ctx, &drawn, 40, &straight));
    for (int i = 0; i < drawn.width * drawn.height; i++)
        if (!isnan(straight.level[i])) {
            off += fabs((double)(straight.level[i] - drawn.level[i]));
            count++;
        }
    CHECK(count > 0.9 * drawn.width * drawn.height);
    CHECK(off / count < 0.12); // the noise and the edges' pixels
    grey_free(ctx, &straight);
    grey_free(ctx, &drawn);
    jali_picture_free(ctx, &scan);
    jali_bitmap_free(ctx, &drawing);
}

static jali_status find_all(jali_context *limited, void *data)
{
    jali_status status;
    (void)data;
    jali_bitmap drawing = {0};
    uint8_t level[32 * 24];
    jali_picture scan = {.width_px = 32, .height_px = 24, .grey = level};
    grey straight = {0}, drawn = {0};
    alignment a;
    for (int i = 0; i < 32 * 24; i++)
        level[i] = i % 32 > 4 && i % 32 < 26 && i / 32 > 3 && i / 32 < 20 ? 220 : 30;
    TRY(jali_bitmap_create(limited, 32, 24, &drawing));
    for (int i = 0; i < 32 * 24; i++) jali_bitmap_set(&drawing, i % 32, i / 32, level[i] > 99);
    TRY(find_in_scan(limited, &scan, &drawing, 200, &a));
    TRY(straighten(limited, &scan, &drawing, &a.map, 2, &straight));
    TRY(grey_of_bitmap(limited, &drawing, 2, &drawn));
    TRY(share_of_solid(limited, &drawn, 4, &straight));
done:
    grey_free(limited, &straight);
    grey_free(limited, &drawn);
    jali_bitmap_free(limited, &drawing);
    return status;
}

TEST(every_allocation_may_be_refused)
{
    refuse_each_allocation(find_all, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shrunk_picture_holds_the_mean_of_its_pixels),
        cmocka_unit_test(a_blurred_point_has_the_deviation_asked_for_and_keeps_its_sum),
        cmocka_unit_test(a_normalised_picture_does_not_depend_on_light),
        cmocka_unit_test(maps_are_found_from_points_inverted_and_chained),
        cmocka_unit_test(a_map_of_points_on_a_line_is_refused),
        cmocka_unit_test(the_scale_of_a_map_is_how_lengths_grow),
        cmocka_unit_test(the_outline_of_a_turned_rectangle_is_its_corners),
        cmocka_unit_test(a_plate_is_found_turned_tilted_mirrored_and_in_either_tone),
        cmocka_unit_test(a_plate_that_fills_the_scan_is_found),
        cmocka_unit_test(what_is_not_there_is_not_found),
        cmocka_unit_test(the_share_of_solid_is_what_was_drawn_whatever_the_light),
        cmocka_unit_test(every_allocation_may_be_refused),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
