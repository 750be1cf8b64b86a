// Widths on curved surfaces: patches, fields and their operators against the definitions.
#include "testing.h"
#include "plain.h"
#include "raster/field.h"
#include "adapt/local.h"
#include "judge_metric.h"

#include <math.h>

static const double FLAT[3] = {1, 0, 1};

// --- Charts with a metric

// A chart whose knots are exact at their places.
static jali_chart curved_chart(int32_t width_px, int32_t height_px, int32_t step_px, metric_of metric)
{
    jali_chart chart = {.width_px = width_px,
                        .height_px = height_px,
                        .outside_solid = true,
                        .pixel_units = 64,
                        .unit_mm = 0.025 / 64,
                        .metric_columns = (width_px + step_px - 1) / step_px,
                        .metric_rows = (height_px + step_px - 1) / step_px,
                        .metric_step_px = step_px};
    chart.metric = malloc(sizeof *chart.metric * (size_t)chart.metric_columns * (size_t)chart.metric_rows);
    for (int32_t j = 0; j < chart.metric_rows; j++)
        for (int32_t i = 0; i < chart.metric_columns; i++) {
            double g[3];
            metric((i + 0.5) * step_px, (j + 0.5) * step_px, g);
            for (int32_t k = 0; k < 3; k++) chart.metric[j * chart.metric_columns + i][k] = (float)g[k];
        }
    return chart;
}

static void identity_metric(double x, double y, double g[3])
{
    (void)x, (void)y;
    memcpy(g, FLAT, sizeof FLAT);
}

// Waves of stretch up to 3 times, turning with the place.
static void wavy_metric(double x, double y, double g[3])
{
    double s = 1 + 2 * pow(sin(x / 90 + y / 140), 2), t = 0.8 + 0.4 * pow(cos(y / 100), 2),
           angle = x / 150 - y / 120;
    double c = cos(angle), d = sin(angle);
    g[0] = s * s * c * c + t * t * d * d;
    g[1] = (s * s - t * t) * c * d;
    g[2] = s * s * d * d + t * t * c * c;
}

// --- Patches

static bool same_as_element(const patch *p, const element *e)
{
    patch q;
    CHECK_OK(patch_of_element(ctx, e, &q));
    bool same = p->size == q.size && p->top == q.top && p->rows == q.rows &&
                memcmp(p->span, q.span, (size_t)p->rows * sizeof *p->span) == 0;
    patch_free(ctx, &q);
    return same;
}

TEST(patches_of_flat_places_are_the_elements)
{
    for (int32_t size = 1; size <= 60; size++) {
        ellipse disc = ellipse_of_disc(FLAT, size, 0);
        element e;
        patch p;
        CHECK_OK(patch_within(ctx, &disc, false, &p));
        CHECK_OK(element_disc(ctx, size, &e));
        CHECK(same_as_element(&p, &e));

        patch_free(ctx, &p);
        element_free(ctx, &e);
        CHECK_OK(patch_around(ctx, &disc, &p));
        CHECK_OK(element_wide_disc(ctx, size, &e));
        CHECK(same_as_element(&p, &e));
        CHECK(patch_as_wide(&p, &disc));
        patch_free(ctx, &p);
        element_free(ctx, &e);
        if (size % 2 == 0) continue;
        disc = ellipse_of_disc(FLAT, size - 1, 0.5);
        CHECK_OK(patch_within(ctx, &disc, true, &p));
        CHECK_OK(element_disc(ctx, size, &e));
        CHECK(same_as_element(&p, &e));
        patch_free(ctx, &p);
        element_free(ctx, &e);
    }
}

// The ellipse's own test of a point, relative to its centre.
static double level_of(const ellipse *e, double x, double y)
{
    double determinant = e->shape[0] * e->shape[2] - e->shape[1] * e->shape[1];
    return (e->shape[2] * x * x - 2 * e->shape[1] * x * y + e->shape[0] * y * y) / determinant;
}

static bool patch_has(const patch *p, int32_t dx, int32_t dy)
{
    int32_t k = dy - p->top;
    return k >= 0 && k < p->rows && dx >= p->span[k][0] && dx <= p->span[k][1];
}

// A patch's centre: the middle of its rows and of its columns.
static void centre_of(const patch *p, double centre[2])
{
    int32_t left = INT32_MAX, right = INT32_MIN;
    for (int32_t k = 0; k < p->rows; k++) {
        left = p->span[k][0] < left ? p->span[k][0] : left;
        right = p->span[k][1] > right ? p->span[k][1] : right;
    }
    centre[0] = (left + right) / 2.0;
    centre[1] = p->top + (p->rows - 1) / 2.0;
}

TEST(patches_cover_or_lie_within_their_ellipse)
{
    uint64_t seed = 4;
    for (int32_t round = 0; round < 400; round++) {
        double g[3], d = 1 + (double)(next_random(&seed) % 300) / 10, centre[2];
        wavy_metric((double)(next_random(&seed) % 1000), (double)(next_random(&seed) % 1000), g);
        ellipse e = ellipse_of_disc(g, d, 0);
        // By its definition: a step of half the diameter on the surface ends on the ellipse.
        for (int32_t k = 0; k < 12; k++) {
            double x = cos(k * 0.5), y = sin(k * 0.5);
            double reach = d / 2 / sqrt(g[0] * x * x + 2 * g[1] * x * y + g[2] * y * y);
            CHECK(fabs(level_of(&e, reach * x, reach * y) - 1) < 1e-9);
        }
        patch around, within;
        CHECK_OK(patch_around(ctx, &e, &around));
        CHECK_OK(patch_within(ctx, &e, false, &within));
        CHECK(patch_as_wide(&around, &e));
        centre_of(&around, centre);
        CHECK(fabs(centre[0]) <= 0.5 && fabs(centre[1]) <= 0.5);
        for (int32_t k = 0; k < 400; k++) { // points of the ellipse lie on pixels of the patch
            double x = cos(k * 0.0157), y = sin(k * 0.0157);
            double reach = 0.999999 * d / 2 / sqrt(g[0] * x * x + 2 * g[1] * x * y + g[2] * y * y);
            CHECK(patch_has(&around, (int32_t)floor(centre[0] + reach * x + 0.5),
                            (int32_t)floor(centre[1] + reach * y + 0.5)));
        }
        CHECK(around.rows < 2 * sqrt(e.shape[2]) + 1);
        if (within.rows > 4) { // slim ones may hold a pixel between two centres
            centre_of(&within, centre);
            for (int32_t k = 0; k < within.rows; k++)
                if (within.span[k][0] < within.span[k][1])
                    for (int32_t side = 0; side < 2; side++)
                        CHECK(level_of(&e, within.span[k][side] - (centre[0] < -0.1 ? -0.5 : 0),
                                       within.top + k - (centre[1] < -0.1 ? -0.5 : 0)) < 1 + 1e-6);
        }
        patch_free(ctx, &around);
        patch_free(ctx, &within);
    }
}

TEST(a_sum_paints_what_its_parts_paint_one_after_the_other)
{
    uint64_t seed = 9;
    for (int32_t round = 0; round < 40; round++) {
        double g[3];
        wavy_metric((double)(next_random(&seed) % 1000), (double)(next_random(&seed) % 1000), g);
        ellipse e = ellipse_of_disc(g, 12 + round % 5, 0), f = ellipse_of_disc(g, 4, 0.5);
        patch a, b, sum;
        CHECK_OK(patch_around(ctx, &e, &a));
        CHECK_OK(patch_within(ctx, &f, true, &b));
        CHECK_OK(patch_sum(ctx, &a, &b, &sum));
        jali_bitmap once, twice;
        CHECK_OK(jali_bitmap_create(ctx, 64, 64, &once));
        CHECK_OK(jali_bitmap_create(ctx, 64, 64, &twice));
        paint_patch(&once, 32, 32, &sum, true);
        for (int32_t k = 0; k < a.rows; k++)
            for (int32_t dx = a.span[k][0]; dx <= a.span[k][1]; dx++)
                paint_patch(&twice, 32 + dx, 32 + a.top + k, &b, true);
        CHECK(same_bitmap(&once, &twice));
        CHECK_INT(count_patch(&once, 32, 32, &sum, true), count_white(ctx, &once));
        jali_bitmap_free(ctx, &once);
        jali_bitmap_free(ctx, &twice);
        patch_free(ctx, &a);
        patch_free(ctx, &b);
        patch_free(ctx, &sum);
    }
}

// --- Tiles

TEST(a_tile_is_within_its_slack_of_the_metric)
{
    jali_chart chart = curved_chart(700, 500, 8, wavy_metric);
    tiling t;
    CHECK_OK(tiling_create(ctx, &chart, 700, 500, 0, 0, 1, &t));
    double least = 1, most = 0;
    for (int32_t i = 0; i < t.kinds; i++) least = fmin(least, t.slack[i]), most = fmax(most, t.slack[i]);
    print_message("tiles of %d px, %d kinds, slack %.1f to %.1f %%\n", t.tile_px, t.kinds, 100 * least,
                  100 * most);
    CHECK(least > 0 && most < 0.06);
    CHECK(t.most_stretch > 2.8 && t.most_stretch < 3.1);
    for (int32_t y = 4; y < 496; y += 3)
        for (int32_t x = 4; x < 696; x += 3) {
            double g[3];
            const double *h = metric_at(&t, x, y);
            double slack = t.slack[(h - t.metric[0]) / 3];
            wavy_metric(x + 0.5, y + 0.5, g);
            for (int32_t k = 0; k < 8; k++) {
                double u = cos(k * 0.4), v = sin(k * 0.4);
                double ratio = sqrt((g[0] * u * u + 2 * g[1] * u * v + g[2] * v * v) /
                                    (h[0] * u * u + 2 * h[1] * u * v + h[2] * v * v));
                CHECK(fabs(log(ratio)) < slack + 0.01);
            }
        }
    tiling_free(ctx, &t);
    free(chart.metric);
}

TEST(a_metric_that_is_the_identity_leaves_no_slack)
{
    jali_chart chart = curved_chart(300, 200, 32, identity_metric);
    tiling t;
    CHECK_OK(tiling_create(ctx, &chart, 300, 200, 0, 0, 1, &t));
    CHECK_INT(t.kinds, 1);
    CHECK(t.slack[0] == 0 && t.most_stretch == 1 && memcmp(t.metric[0], FLAT, sizeof FLAT) == 0);
    tiling_free(ctx, &t);
    free(chart.metric);
}

TEST(bad_metrics_are_a_sentence)
{
    static const float bad[][3] = {{1, 1, 1},        {-1, 0, 1}, {NAN, 0, 1},
                                   {1, 0, INFINITY}, {0, 0, 1},  {1e7f, 0, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        jali_chart chart = curved_chart(300, 200, 32, identity_metric);
        tiling t;
        memcpy(chart.metric[13], bad[i], sizeof bad[i]);
        CHECK_INT(tiling_create(ctx, &chart, 300, 200, 0, 0, 1, &t), JALI_BAD_VALUE);
        CHECK(strstr(jali_message(ctx), "knot (3, 1)"));
        free(chart.metric);
    }
}

// --- Operators

static bool pixel(const jali_bitmap *a, int32_t x, int32_t y, bool outside)
{
    return x < 0 || y < 0 || x >= a->width_px || y >= a->height_px ? outside : jali_bitmap_get(a, x, y);
}

static bool fits(const jali_bitmap *a, const field *f, int32_t x, int32_t y, bool outside)
{
    const patch *p = patch_at(f, x, y);
    for (int32_t k = 0; k < p->rows; k++)
        for (int32_t dx = p->span[k][0]; dx <= p->span[k][1]; dx++)
            if (!pixel(a, x + dx, y + p->top + k, outside)) return false;
    return true;
}

static void check_operators(const jali_bitmap *a, const field *f, bool outside, bool white_beyond)
{
    jali_bitmap eroded, dilated, painted, opened, scratch;
    int32_t w = a->width_px, h = a->height_px, reach = 40;
    CHECK_OK(jali_bitmap_create(ctx, w, h, &eroded));
    CHECK_OK(jali_bitmap_create(ctx, w, h, &dilated));
    CHECK_OK(jali_bitmap_create(ctx, w, h, &painted));
    CHECK_OK(jali_bitmap_create(ctx, w, h, &opened));
    CHECK_OK(jali_bitmap_create(ctx, w, h, &scratch));
    CHECK_OK(field_erode(ctx, a, f, outside, &eroded));
    for (int32_t y = 0; y < h; y++)
        for (int32_t x = 0; x < w; x++) CHECK(jali_bitmap_get(&eroded, x, y) == fits(a, f, x, y, outside));
    CHECK_OK(field_dilate(ctx, a, f, white_beyond, &dilated));
    for (int32_t y = -reach; y < h + reach; y++)
        for (int32_t x = -reach; x < w + reach; x++)
            if (pixel(a, x, y, white_beyond)) paint_patch(&painted, x, y, patch_at(f, x, y), true);
    CHECK(same_bitmap(&dilated, &painted));
    // Opening: no more than the picture, and again the same.
    CHECK_OK(field_open(ctx, a, f, outside, &scratch, &opened));
    CHECK_INT(count_combined(ctx, RULE_AND_NOT, &opened, a), 0);
    CHECK_OK(field_open(ctx, &opened, f, outside, &scratch, &painted));
    CHECK(same_bitmap(&opened, &painted));
    // Closing: the opening of the complement.
    CHECK_OK(field_close(ctx, a, f, outside, &scratch, &painted));
    invert(ctx, a, &dilated);
    CHECK_OK(field_open(ctx, &dilated, f, !outside, &scratch, &opened));
    invert(ctx, &opened, &opened);
    CHECK(same_bitmap(&opened, &painted));
    jali_bitmap_free(ctx, &eroded);
    jali_bitmap_free(ctx, &dilated);
    jali_bitmap_free(ctx, &painted);
    jali_bitmap_free(ctx, &opened);
    jali_bitmap_free(ctx, &scratch);
}

TEST(operators_are_their_definition)
{
    static const int32_t sizes[][2] = {{130, 40}, {64, 33}, {401, 81}, {20, 9}};
    uint64_t seed = 21;
    for (int32_t round = 0; round < 16; round++) {
        int32_t w = sizes[round % 4][0], h = sizes[round % 4][1];
        jali_chart chart = curved_chart(w, h, 8, wavy_metric);
        jali_bitmap a = random_bitmap(&seed, w, h, round % 2 ? 97 : 30);
        for (int32_t y = 0; y < h && round % 4 == 2; y++) paint_run(&a, y, 30, w, true); // whole words set
        tiling t;
        field f;
        CHECK_OK(tiling_create(ctx, &chart, w, h, 0, 0, 1, &t));
        CHECK_OK(field_of_discs(ctx, &t, 2 + round, 0, false, false, &f));
        check_operators(&a, &f, round & 4, round & 2);
        field_free(ctx, &f);
        tiling_free(ctx, &t);
        free(chart.metric);
        jali_bitmap_free(ctx, &a);
    }
}

// Windows over random places against the operators on the whole picture.
TEST(windows_see_what_the_whole_picture_sees)
{
    enum { SIZE = 300, HALF = 40, ROWS = 2 * HALF + 24 };
    uint64_t seed = 77;
    jali_chart chart = curved_chart(SIZE, SIZE, 8, wavy_metric);
    tiling t;
    field f;
    window_field local;
    jali_bitmap a = random_bitmap(&seed, SIZE, SIZE, 98), sparse = random_bitmap(&seed, SIZE, SIZE, 1), fits,
                square, all;
    CHECK_OK(tiling_create(ctx, &chart, SIZE, SIZE, 0, 0, 1, &t));
    CHECK_OK(field_of_discs(ctx, &t, 11, 0, false, false, &f));
    CHECK_OK(window_field_create(ctx, &f, &local));
    CHECK_OK(jali_bitmap_create(ctx, SIZE, SIZE, &fits));
    CHECK_OK(jali_bitmap_create(ctx, SIZE, SIZE, &all));
    CHECK_OK(field_erode(ctx, &a, &f, true, &fits));
    for (int32_t round = 0; round < 60; round++) {
        int32_t x0 = (int32_t)(next_random(&seed) % (SIZE - 140)),
                y0 = (int32_t)(next_random(&seed) % (SIZE - ROWS));
        int32_t left = x0 + 64 - HALF, top = y0 + ROWS / 2 - HALF;
        window w, got;
        window_read(&a, x0, y0, ROWS, &w);
        local_erode(&local, &w, x0, y0, ROWS, HALF, &got);
        CHECK_OK(jali_bitmap_create(ctx, SIZE, SIZE, &square));
        for (int32_t y = top; y < top + 2 * HALF; y++) {
            paint_run(&square, y, left, left + 2 * HALF, true);
            for (int32_t x = left; x < left + 2 * HALF; x++) {
                uint64_t word = x - x0 < 64 ? got.left[y - y0] : got.right[y - y0];
                CHECK((word >> ((x - x0) & 63) & 1) == jali_bitmap_get(&fits, x, y));
            }
        }
        combine(ctx, RULE_AND, &sparse, &square, &square);
        CHECK_OK(field_dilate(ctx, &square, &f, false, &all));
        window_read(&sparse, x0, y0, ROWS, &w);
        local_dilate(&local, &w, x0, y0, ROWS, HALF, &got);
        for (int32_t y = y0; y < y0 + ROWS; y++)
            for (int32_t x = x0; x < x0 + WINDOW_COLUMNS; x++) {
                uint64_t word = x - x0 < 64 ? got.left[y - y0] : got.right[y - y0];
                CHECK((word >> ((x - x0) & 63) & 1) == jali_bitmap_get(&all, x, y));
            }
        jali_bitmap_free(ctx, &square);
    }
    window_field_free(ctx, &local);
    field_free(ctx, &f);
    tiling_free(ctx, &t);
    free(chart.metric);
    jali_bitmap_free(ctx, &a);
    jali_bitmap_free(ctx, &sparse);
    jali_bitmap_free(ctx, &fits);
    jali_bitmap_free(ctx, &all);
}

TEST(wide_patches_cross_words)
{
    jali_chart chart = curved_chart(400, 300, 8, wavy_metric);
    tiling t;
    field f;
    jali_bitmap a, got, want;
    CHECK_OK(tiling_create(ctx, &chart, 400, 300, 0, 0, 1, &t));
    CHECK_OK(field_of_discs(ctx, &t, 190, 0, false, false, &f));
    CHECK_OK(jali_bitmap_create(ctx, 400, 300, &a));
    CHECK_OK(jali_bitmap_create(ctx, 400, 300, &got));
    CHECK_OK(jali_bitmap_create(ctx, 400, 300, &want));
    static const int32_t dot[3][2] = {{5, 120}, {199, 150}, {380, 290}};
    for (int32_t i = 0; i < 3; i++) {
        jali_bitmap_set(&a, dot[i][0], dot[i][1], true);
        paint_patch(&want, dot[i][0], dot[i][1], patch_at(&f, dot[i][0], dot[i][1]), true);
    }
    CHECK_OK(field_dilate(ctx, &a, &f, false, &got));
    CHECK(same_bitmap(&got, &want));
    CHECK_OK(field_erode(ctx, &want, &f, true, &got)); // where they fit they do, and nothing else is painted
    CHECK_INT(count_combined(ctx, RULE_AND_NOT, &a, &got), 0);
    CHECK_OK(field_open(ctx, &want, &f, true, &a, &got));
    CHECK(same_bitmap(&got, &want));
    jali_bitmap_free(ctx, &a);
    jali_bitmap_free(ctx, &got);
    jali_bitmap_free(ctx, &want);
    field_free(ctx, &f);
    tiling_free(ctx, &t);
    free(chart.metric);
}

// A field that remembers against one that does not, over pictures that change here and there.
static void check_memory(const jali_chart *chart, int32_t width, int32_t height, int32_t diameter_px)
{
    uint64_t seed = 12;
    tiling t;
    field forgetful, remembering;
    jali_bitmap a = random_bitmap(&seed, width, height, 97), scratch, got, want;
    CHECK_OK(tiling_create(ctx, chart, width, height, 0, 0, 1, &t));
    CHECK_OK(field_of_discs(ctx, &t, diameter_px, 0, false, false, &forgetful));
    CHECK_OK(field_of_discs(ctx, &t, diameter_px, 0, false, false, &remembering));
    CHECK_OK(field_remember(ctx, &remembering));
    CHECK_OK(jali_bitmap_create(ctx, width, height, &scratch));
    CHECK_OK(jali_bitmap_create(ctx, width, height, &got));
    CHECK_OK(jali_bitmap_create(ctx, width, height, &want));
    for (int32_t round = 0; round < 60; round++) {
        bool outside = round / 20 != 1; // another surrounding forgets
        for (int32_t dot = 0; dot < round % 5; dot++) {
            int32_t x = (int32_t)(next_random(&seed) >> 40) % width,
                    y = (int32_t)(next_random(&seed) >> 40) % height;
            paint_patch(&a, x, y, patch_at(&forgetful, x, y), round % 2);
        }
        CHECK_OK(field_open(ctx, &a, &forgetful, outside, &scratch, &want));
        CHECK_OK(field_open(ctx, &a, &remembering, outside, &scratch, &got));
        CHECK(same_bitmap(&got, &want));
        CHECK_OK(field_close(ctx, &a, &forgetful, outside, &scratch, &want));
        jali_bitmap_free(ctx, &got);
        CHECK_OK(jali_bitmap_copy(ctx, &a, &got));
        CHECK_OK(field_close(ctx, &got, &remembering, outside, &scratch, &got)); // in place
        CHECK(same_bitmap(&got, &want));
        CHECK_OK(field_dilate(ctx, &a, &forgetful, outside, &want));
        CHECK_OK(field_dilate(ctx, &a, &remembering, outside, &got));
        CHECK(same_bitmap(&got, &want));
    }
    jali_bitmap_free(ctx, &a);
    jali_bitmap_free(ctx, &scratch);
    jali_bitmap_free(ctx, &got);
    jali_bitmap_free(ctx, &want);
    field_free(ctx, &forgetful);
    field_free(ctx, &remembering);
    tiling_free(ctx, &t);
}

TEST(a_memory_changes_no_result)
{
    enum { WIDTH = 500, HEIGHT = 300 };
    jali_chart chart = curved_chart(WIDTH, HEIGHT, 16, wavy_metric);
    check_memory(&chart, WIDTH, HEIGHT, 9);
    free(chart.metric);
    for (int32_t diameter_px = 1; diameter_px <= 30; diameter_px += 7) // flat: blocks of 512 columns
        check_memory(NULL, 1700, 200, diameter_px);
    check_memory(NULL, 1024, 300, 140); // reaches beyond a word
}

TEST(operators_give_the_same_for_any_number_of_threads)
{
    uint64_t seed = 8;
    jali_chart chart = curved_chart(500, 400, 16, wavy_metric);
    jali_bitmap a = random_bitmap(&seed, 500, 400, 98), opened[3], scratch;
    jali_context *by_threads[3];
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        tiling t;
        field f;
        CHECK_OK(tiling_create(by_threads[i], &chart, 500, 400, 0, 0, 1, &t));
        CHECK_OK(field_of_discs(by_threads[i], &t, 9, 0, false, false, &f));
        CHECK_OK(jali_bitmap_create(by_threads[i], 500, 400, &opened[i]));
        CHECK_OK(jali_bitmap_create(by_threads[i], 500, 400, &scratch));
        CHECK_OK(field_open(by_threads[i], &a, &f, true, &scratch, &opened[i]));
        CHECK(same_bitmap(&opened[i], &opened[0]));
        jali_bitmap_free(by_threads[i], &scratch);
        field_free(by_threads[i], &f);
        tiling_free(by_threads[i], &t);
    }
    CHECK(any_white(ctx, &opened[0]));
    for (int32_t i = 0; i < 3; i++) jali_bitmap_free(by_threads[i], &opened[i]);
    close_thread_contexts(by_threads);
    jali_bitmap_free(ctx, &a);
    free(chart.metric);
}

static jali_status open_on_a_curve(jali_context *limited, void *data)
{
    jali_status status;
    const jali_chart *chart = data;
    jali_bitmap a = {0}, scratch = {0};
    tiling t = {0};
    field f = {0};
    status = jali_bitmap_create(limited, 90, 40, &a);
    if (status == JALI_OK) status = jali_bitmap_create(limited, 90, 40, &scratch);
    if (status == JALI_OK) status = tiling_create(limited, chart, 90, 40, 0, 0, 1, &t);
    if (status == JALI_OK) status = field_of_discs(limited, &t, 6, 0, false, false, &f);
    if (status == JALI_OK) status = field_remember(limited, &f);
    for (int32_t twice = 0; twice < 2; twice++)
        if (status == JALI_OK) status = field_open(limited, &a, &f, true, &scratch, &a);
    field_free(limited, &f);
    tiling_free(limited, &t);
    jali_bitmap_free(limited, &a);
    jali_bitmap_free(limited, &scratch);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_chart chart = curved_chart(90, 40, 32, wavy_metric);
    refuse_each_allocation(open_on_a_curve, &chart);
    free(chart.metric);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patches_of_flat_places_are_the_elements),
        cmocka_unit_test(patches_cover_or_lie_within_their_ellipse),
        cmocka_unit_test(a_sum_paints_what_its_parts_paint_one_after_the_other),
        cmocka_unit_test(a_tile_is_within_its_slack_of_the_metric),
        cmocka_unit_test(a_metric_that_is_the_identity_leaves_no_slack),
        cmocka_unit_test(bad_metrics_are_a_sentence),
        cmocka_unit_test(operators_are_their_definition),
        cmocka_unit_test(windows_see_what_the_whole_picture_sees),
        cmocka_unit_test(wide_patches_cross_words),
        cmocka_unit_test(a_memory_changes_no_result),
        cmocka_unit_test(operators_give_the_same_for_any_number_of_threads),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
