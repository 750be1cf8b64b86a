// trace: every promise checked exactly, on every small bitmap and on drawn, random and analytic ones.
#include "testing.h"

#include <jali/trace.h>
#include "plane/exact.h"
#include "plane/rasterise.h"

#include <math.h>

enum { UNITS = 64 };

static jali_chart chart_of(const jali_bitmap *bitmap, bool outside_solid)
{
    return (jali_chart){.width_px = bitmap->width_px,
                        .height_px = bitmap->height_px,
                        .outside_solid = outside_solid,
                        .pixel_units = UNITS,
                        .unit_mm = 1.0 / 1024};
}

static bool touch(const int32_t a[2], const int32_t b[2], const int32_t c[2], const int32_t d[2])
{
    int64_t abc = orientation(a, b, c), abd = orientation(a, b, d);
    int64_t cda = orientation(c, d, a), cdb = orientation(c, d, b);
    if (abc == 0 && abd == 0)
        return MAX(MIN(a[0], b[0]), MIN(c[0], d[0])) <= MIN(MAX(a[0], b[0]), MAX(c[0], d[0])) &&
               MAX(MIN(a[1], b[1]), MIN(c[1], d[1])) <= MIN(MAX(a[1], b[1]), MAX(c[1], d[1]));
    return ((abc <= 0 && abd >= 0) || (abc >= 0 && abd <= 0)) &&
           ((cda <= 0 && cdb >= 0) || (cda >= 0 && cdb <= 0));
}

typedef struct edge {
    int32_t contour, index, low_y, high_y;
    const int32_t *a, *b;
} edge;

static int by_low_y(const void *a, const void *b)
{
    const edge *p = a, *q = b;
    return (p->low_y > q->low_y) - (p->low_y < q->low_y);
}

// No two edges share a point, but for the ends of neighbours; neighbours do not fold back.
static void check_apart(const jali_contours *contours)
{
    edge *list = calloc((size_t)contours->point_count + 1, sizeof *list);
    int32_t count = 0;
    for (int32_t c = 0; c < contours->contour_count; c++) {
        int32_t n = contours->first[c + 1] - contours->first[c];
        CHECK(n >= 3);
        const int32_t(*point)[2] = (const int32_t(*)[2])contours->point + contours->first[c];
        for (int32_t i = 0; i < n; i++) {
            const int32_t *a = point[i], *b = point[(i + 1) % n];
            CHECK(a[0] != b[0] || a[1] != b[1]);
            list[count++] = (edge){c, i, MIN(a[1], b[1]), MAX(a[1], b[1]), a, b};
        }
    }
    qsort(list, (size_t)count, sizeof *list, by_low_y);
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = i + 1; j < count && list[j].low_y <= list[i].high_y; j++) {
            const edge *p = &list[i], *q = &list[j];
            if (p->b == q->a || q->b == p->a) {
                const edge *before = p->b == q->a ? p : q, *after = before == p ? q : p;
                if (p->b == q->a && q->b == p->a) CHECK(false);
                CHECK(orientation(before->a, before->b, after->b) != 0 ||
                      strictly_between(before->a, after->b, before->b));
                continue;
            }
            CHECK(!touch(p->a, p->b, q->a, q->b));
        }
    free(list);
}

static void check_trace(const jali_bitmap *bitmap, bool outside_solid, jali_contours *contours)
{
    jali_chart chart = chart_of(bitmap, outside_solid);
    jali_bitmap back;
    CHECK_OK(jali_trace(ctx, bitmap, &chart, NULL, contours));
    CHECK_OK(rasterise(ctx, contours, &chart, &back));
    CHECK(same_bitmap(bitmap, &back));
    check_apart(contours);
    jali_bitmap_free(ctx, &back);
}

static void check_both(const jali_bitmap *bitmap)
{
    for (int solid = 0; solid < 2; solid++) {
        jali_contours contours;
        check_trace(bitmap, solid, &contours);
        jali_contours_free(ctx, &contours);
    }
}

TEST(all_bitmaps_of_4x4)
{
    jali_bitmap bitmap;
    int32_t *kept; // holds the arena's chunk, so that not every run maps it anew
    CHECK_OK(ARENA(ctx, kept, 1));
    CHECK_OK(jali_bitmap_create(ctx, 4, 4, &bitmap));
    for (uint32_t bits = 0; bits < 1 << 16; bits++) {
        for (int32_t i = 0; i < 16; i++) jali_bitmap_set(&bitmap, i % 4, i / 4, bits >> i & 1);
        check_both(&bitmap);
    }
    jali_bitmap_free(ctx, &bitmap);
}

TEST(random_bitmaps)
{
    static const int32_t sizes[][2] = {{1, 1}, {63, 5}, {64, 7}, {65, 40}, {130, 90}, {200, 200}};
    uint64_t seed = 11;
    for (int32_t percent = 0; percent <= 100; percent += 10)
        for (int32_t i = 0; i < 6; i++) {
            jali_bitmap bitmap = random_bitmap(&seed, sizes[i][0], sizes[i][1], percent);
            check_both(&bitmap);
            jali_bitmap_free(ctx, &bitmap);
        }
}

static void fill(jali_bitmap *bitmap, bool (*inside)(double x, double y, const double *shape),
                 const double *shape)
{
    for (int32_t y = 0; y < bitmap->height_px; y++)
        for (int32_t x = 0; x < bitmap->width_px; x++)
            jali_bitmap_set(bitmap, x, y, inside(x + 0.5, bitmap->height_px - y - 0.5, shape));
}

static bool in_rectangle(double x, double y, const double *s)
{
    return x > s[0] && x < s[0] + s[2] && y > s[1] && y < s[1] + s[3];
}

TEST(rectangles_have_four_points_at_their_corners)
{
    for (int32_t w = 1; w < 12; w++)
        for (int32_t h = 1; h < 40; h += 3) {
            jali_bitmap bitmap;
            CHECK_OK(jali_bitmap_create(ctx, 50, 50, &bitmap));
            fill(&bitmap, in_rectangle, (double[]){4, 5, w, h});
            jali_contours contours;
            check_trace(&bitmap, false, &contours);
            CHECK_INT(contours.contour_count, 1);
            CHECK_INT(contours.point_count, 4);
            int64_t area = 0;
            for (int32_t i = 0; i < 4; i++) {
                const int32_t *p = contours.point[i], *q = contours.point[(i + 1) % 4];
                CHECK_INT(p[0] % UNITS, 0);
                CHECK_INT(p[1] % UNITS, 0);
                area += (int64_t)p[0] * q[1] - (int64_t)p[1] * q[0];
            }
            CHECK_INT(area, 2LL * w * h * UNITS * UNITS); // counter-clockwise
            jali_contours_free(ctx, &contours);
            jali_bitmap_free(ctx, &bitmap);
        }
}

TEST(corner_touching_pixels_stay_apart)
{
    jali_bitmap bitmap = drawn_rows(4, "...."
                                       ".#.."
                                       "..#."
                                       "....");
    jali_contours contours;
    check_trace(&bitmap, false, &contours);
    CHECK_INT(contours.contour_count, 2);
    jali_contours_free(ctx, &contours);
    check_trace(&bitmap, true, &contours); // one ring of void around both, through the corner
    CHECK_INT(contours.contour_count, 3);
    jali_contours_free(ctx, &contours);
    jali_bitmap_free(ctx, &bitmap);
}

static bool in_circle_of(double x, double y, const double *s)
{
    return (x - s[0]) * (x - s[0]) + (y - s[1]) * (y - s[1]) < s[2] * s[2];
}

TEST(circles_are_round)
{
    for (double r = 6; r < 120; r *= 1.23) {
        jali_bitmap bitmap;
        double shape[3] = {130.3, 128.9, r};
        CHECK_OK(jali_bitmap_create(ctx, 260, 260, &bitmap));
        fill(&bitmap, in_circle_of, shape);
        jali_contours contours;
        check_trace(&bitmap, false, &contours);
        CHECK_INT(contours.contour_count, 1);
        double worst = 0, sharpest = 0, off = 0;
        int32_t n = contours.point_count;
        for (int32_t i = 0; i < n; i++) {
            const int32_t *a = contours.point[(i + n - 1) % n], *b = contours.point[i],
                          *c = contours.point[(i + 1) % n];
            double error = hypot((double)b[0] / UNITS - shape[0], (double)b[1] / UNITS - shape[1]) - r;
            double turned = atan2((double)orientation(a, b, c), (double)(b[0] - a[0]) * (c[0] - b[0]) +
                                                                    (double)(b[1] - a[1]) * (c[1] - b[1]));
            worst = fmax(worst, fabs(error));
            off += error / n;
            sharpest = fmax(sharpest, fabs(turned));
        }
        print_message("circle r %.1f: %d points, worst %.3f mean %.3f px, sharpest turn %.1f deg\n", r, n,
                      worst, off, sharpest * 180 / M_PI);
        CHECK(worst < 0.6 && fabs(off) < 0.25);
        CHECK(sharpest < (r < 20 ? 50 : r < 35 ? 22 : 14) * M_PI / 180); // pixel stairs turn by 90
        CHECK(n < 2 * M_PI * r / 2.2);
        jali_contours_free(ctx, &contours);
        jali_bitmap_free(ctx, &bitmap);
    }
}

static bool in_band(double x, double y, const double *s)
{
    double along = (x - s[0]) * s[2] + (y - s[1]) * s[3], across = (y - s[1]) * s[2] - (x - s[0]) * s[3];
    return fabs(along) < s[4] && fabs(across) < s[5];
}

TEST(straight_bands_have_few_points)
{
    for (int32_t degrees = 0; degrees < 90; degrees += 3) {
        jali_bitmap bitmap;
        double angle = (degrees + 0.37) * M_PI / 180;
        CHECK_OK(jali_bitmap_create(ctx, 300, 300, &bitmap));
        fill(&bitmap, in_band, (double[]){150.2, 149.7, cos(angle), sin(angle), 120, 15});
        jali_contours contours;
        check_trace(&bitmap, false, &contours);
        print_message("band %d: %d points\n", degrees, contours.point_count);
        CHECK(contours.point_count <= 24);
        jali_contours_free(ctx, &contours);
        jali_bitmap_free(ctx, &bitmap);
    }
}

static void trace_with_threads(const jali_bitmap *bitmap, int32_t threads, jali_contours *copy)
{
    jali_context_options opt = jali_context_defaults();
    opt.threads = threads;
    jali_context *other;
    jali_contours contours;
    jali_chart chart = chart_of(bitmap, true);
    CHECK_INT(jali_context_create(&opt, &other), JALI_OK);
    CHECK_INT(jali_trace(other, bitmap, &chart, NULL, &contours), JALI_OK);
    *copy = contours;
    CHECK_OK(ALLOCATE(ctx, copy->point, contours.point_count));
    memcpy(copy->point, contours.point, (size_t)contours.point_count * sizeof *copy->point);
    copy->first = NULL;
    jali_contours_free(other, &contours);
    jali_context_free(other);
}

TEST(any_number_of_threads_gives_the_same_bytes)
{
    uint64_t seed = 21;
    jali_bitmap bitmap = random_bitmap(&seed, 400, 300, 70);
    jali_contours one, more;
    trace_with_threads(&bitmap, 1, &one);
    for (int32_t threads = 2; threads <= 3; threads++) {
        trace_with_threads(&bitmap, threads, &more);
        CHECK_INT(one.point_count, more.point_count);
        CHECK(memcmp(one.point, more.point, (size_t)one.point_count * sizeof *one.point) == 0);
        jali_contours_free(ctx, &more);
    }
    jali_contours_free(ctx, &one);
    jali_bitmap_free(ctx, &bitmap);
}

TEST(bad_values_are_a_sentence)
{
    jali_bitmap bitmap = drawn_rows(2, "#.");
    jali_chart chart = chart_of(&bitmap, false);
    jali_contours contours;
    chart.pixel_units = 15;
    CHECK_STATUS(jali_trace(ctx, &bitmap, &chart, NULL, &contours), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "15 units") != NULL && contours.point == NULL);
    chart.pixel_units = 1 << 24;
    CHECK_STATUS(jali_trace(ctx, &bitmap, &chart, NULL, &contours), JALI_LIMIT);
    chart.pixel_units = 16;
    chart.width_px = 3;
    CHECK_STATUS(jali_trace(ctx, &bitmap, &chart, NULL, &contours), JALI_BAD_VALUE);
    chart.width_px = 2;
    CHECK_STATUS(jali_trace(ctx, &bitmap, &chart, &(jali_trace_options){.deviation_mm = NAN}, &contours),
                 JALI_BAD_VALUE);
    jali_bitmap_free(ctx, &bitmap);
}

static jali_status trace_some(jali_context *limited, void *data)
{
    jali_contours contours;
    jali_chart chart = chart_of(data, true);
    jali_status status = jali_trace(limited, data, &chart, NULL, &contours);
    jali_contours_free(limited, &contours);
    return status;
}

TEST(every_allocation_refused_once)
{
    uint64_t seed = 2;
    jali_bitmap bitmap = random_bitmap(&seed, 40, 40, 50);
    refuse_each_allocation(trace_some, &bitmap);
    jali_bitmap_free(ctx, &bitmap);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(rectangles_have_four_points_at_their_corners, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(corner_touching_pixels_stay_apart, open_context, close_context),
        cmocka_unit_test_setup_teardown(circles_are_round, open_context, close_context),
        cmocka_unit_test_setup_teardown(straight_bands_have_few_points, open_context, close_context),
        cmocka_unit_test_setup_teardown(any_number_of_threads_gives_the_same_bytes, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(bad_values_are_a_sentence, open_context, close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
        cmocka_unit_test_setup_teardown(random_bitmaps, open_context, close_context),
        cmocka_unit_test_setup_teardown(all_bitmaps_of_4x4, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
