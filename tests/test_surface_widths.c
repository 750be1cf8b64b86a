// Widths in mm on curved surfaces, through the whole image method, by a judge that knows the exact metric.
//
// A picture is optimised on a chart with a metric; then no disc of phi_s or phi_v, less TOLERANCE, may
// leave a detail of type A or B uncovered. On a sphere cap the smallest widths at the pole and at the rim,
// where lengths are stretched three times, must agree within 10 %.
#include "testing.h"
#include "judge_metric.h"

#include "raster/raster.h"

#include <jali/optimise.h>

// Of a width: what the interpolation between knots and the ellipses' rounding may take off.
static const double TOLERANCE = 0.02;
static const double PIXEL_MM = 0.025; // phi_s is 12 px, phi_v 20

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { CAP_RADIUS_PX = 260, RANDOM_ROUNDS = 4, RANDOM_PX = 130 };
#else
enum { CAP_RADIUS_PX = 400, RANDOM_ROUNDS = 12, RANDOM_PX = 200 };
#endif
enum { MARGIN_PX = 46 };

// --- Metrics

// A quarter of a sphere seen from above, its pole near the upper left corner. Beyond the rim it goes on as at
// the rim.
static const double RIM = 0.9428; // of the radius: there 1 / cos is 3

static void cap_metric(double x, double y, double g[3])
{
    double u = (x - MARGIN_PX - 20) / CAP_RADIUS_PX, v = (y - MARGIN_PX - 20) / CAP_RADIUS_PX;
    double r = hypot(u, v), inside = fmin(r, RIM), more = r > 0 ? 1 / (1 - inside * inside) - 1 : 0;
    u = r > 0 ? u / r : 1;
    v = r > 0 ? v / r : 0;
    g[0] = 1 + more * u * u;
    g[1] = more * u * v;
    g[2] = 1 + more * v * v;
}

// An upright cylinder seen from the side, from its middle to where it is stretched three times.
static void cylinder_metric(double x, double y, double g[3])
{
    (void)y;
    double u = fmin(fmax((x - MARGIN_PX) / (RANDOM_PX / RIM), 0), RIM);
    g[0] = 1 / (1 - u * u);
    g[1] = 0;
    g[2] = 1;
}

// Waves: 1 to 2.6 times in one direction, 0.8 to 1.1 in the other; the directions turn with the place.
static void wavy_metric(double x, double y, double g[3])
{
    double s = 1 + 1.6 * pow(sin(x / 180 + y / 260), 2), t = 0.8 + 0.3 * pow(cos(y / 200), 2),
           angle = x / 300 - y / 240;
    double c = cos(angle), d = sin(angle);
    g[0] = s * s * c * c + t * t * d * d;
    g[1] = (s * s - t * t) * c * d;
    g[2] = s * s * d * d + t * t * c * c;
}

static double along_chord(metric_of metric, int32_t steps, const int32_t from[2], const int32_t to[2])
{
    double g[3], dx = to[0] - from[0], dy = to[1] - from[1];
    if (dx == 0 && dy == 0) return steps;
    metric((from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0, g);
    return steps * sqrt((g[0] * dx * dx + 2 * g[1] * dx * dy + g[2] * dy * dy) / (dx * dx + dy * dy));
}

static double cap_length(int32_t steps, const int32_t from[2], const int32_t to[2])
{
    return along_chord(cap_metric, steps, from, to);
}

static double cylinder_length(int32_t steps, const int32_t from[2], const int32_t to[2])
{
    return along_chord(cylinder_metric, steps, from, to);
}

static double wavy_length(int32_t steps, const int32_t from[2], const int32_t to[2])
{
    return along_chord(wavy_metric, steps, from, to);
}

static jali_chart chart_of(int32_t size_px, metric_of metric)
{
    enum { STEP = 8 };
    int32_t knots = (size_px + STEP - 1) / STEP;
    jali_chart chart = {.width_px = size_px,
                        .height_px = size_px,
                        .margin_px = MARGIN_PX,
                        .outside_solid = true,
                        .pixel_units = 64,
                        .unit_mm = PIXEL_MM / 64,
                        .metric_columns = knots,
                        .metric_rows = knots,
                        .metric_step_px = STEP};
    chart.metric = malloc(sizeof *chart.metric * (size_t)knots * (size_t)knots);
    for (int32_t j = 0; j < knots; j++)
        for (int32_t i = 0; i < knots; i++) {
            double g[3];
            metric((i + 0.5) * STEP, (j + 0.5) * STEP, g);
            for (int32_t k = 0; k < 3; k++) chart.metric[j * knots + i][k] = (float)g[k];
        }
    return chart;
}

static judge_rule rule_for(bool white, double share)
{
    jali_optimise_options opt = jali_optimise_defaults();
    return (judge_rule){.width_px = (white ? opt.phi_s_mm : opt.phi_v_mm) / PIXEL_MM * share,
                        .epsilon_px = 1.2 * opt.epsilon_mm / PIXEL_MM, // a chord is no medial axis
                        .isolated = true};
}

static void check_widths(const jali_optimised *r, const char *what, metric_of metric, judge_length length)
{
    plain mask = plain_of(&r->mask);
    CHECK_INT(plain_pieces(&mask, true, 4), 1);
    plain_free(&mask);
    for (int32_t white = 0; white < 2; white++) {
        const int32_t *left = white ? r->residual.white : r->residual.black;
        CHECK_INT(left[JALI_TYPE_A] + left[JALI_TYPE_B], 0);
        judge_verdict v =
            judge_on_surface(&r->mask, true, white, metric, rule_for(white, 1 - TOLERANCE), length);
        if (v.type[0] + v.type[1])
            print_error("%s: %s A %d B %d, first (%d, %d)\n", what, white ? "solid" : "void", v.type[0],
                        v.type[1], v.at[0], v.at[1]);
        CHECK_INT(v.type[0] + v.type[1], 0);
    }
}

// --- The sphere cap

// Bars of 90 % of the printer's widths, along and across the slope, solid ones in voids and voids in
// solid, in mm alike near the pole and near the rim.
static bool drawn_on_cap(int32_t x, int32_t y)
{
    double u = x + 0.5 - MARGIN_PX - 20, v = y + 0.5 - MARGIN_PX - 20;
    double r = hypot(u, v) / CAP_RADIUS_PX, angle = atan2(v, u) * 57.29578;
    double steep = 1 / sqrt(1 - fmin(r, RIM) * fmin(r, RIM)), px = CAP_RADIUS_PX;
    const double solid = 0.45 * 12, hollow = 0.45 * 20; // half widths
    bool near_rim = r > 0.565;
    double step = near_rim ? 10 : 30, off = fabs(angle - step * (floor(angle / step) + 0.5));
    double aside = off / 57.29578 * r * px;
    if ((r > 0.1 && r < 0.34) || (r > 0.8 && r < 0.93))
        return aside < solid || fabs(r - (near_rim ? 0.87 : 0.22)) * px * steep < solid;
    if ((r >= 0.36 && r < 0.55) || (r > 0.58 && r < 0.79)) {
        double low = near_rim ? 0.58 : 0.36, high = near_rim ? 0.79 : 0.55;
        off = fabs(angle - 12 * (floor(angle / 12) + 0.5));
        bool radial = off / 57.29578 * r * px < hollow && r > low + 0.02 && r < high - 0.1;
        bool around = fabs(r - high + 0.04) * px * steep < hollow && angle > 5 && angle < 85;
        return !radial && !around;
    }
    return true;
}

static bool near_pole(int32_t x, int32_t y)
{
    return hypot(x + 0.5 - MARGIN_PX - 20, y + 0.5 - MARGIN_PX - 20) < 0.565 * CAP_RADIUS_PX;
}

// The largest share of the width at which discs still cover all of a tone's details of types A and B in the
// zone.
static double smallest_width(const jali_bitmap *mask, bool white, bool pole)
{
    const double step = 0.03, most = 1.5;
    for (double share = 1 - TOLERANCE + step; share < most; share += step) {
        judge_rule rule = rule_for(white, share);
        int32_t pad = 2 * (int32_t)rule.width_px + 3;
        plain p = judge_padded(mask, true, pad);
        plain bare = judge_uncovered_on_surface(&p, white, cap_metric, pad, rule.width_px);
        for (int32_t y = 0; y < p.h; y++)
            for (int32_t x = 0; x < p.w; x++)
                if (near_pole(x - pad, y - pad) != pole) bare.white[(int64_t)y * p.w + x] = 0;
        judge_verdict v = judge_groups(&p, &bare, white, rule, pad, cap_length);
        plain_free(&bare);
        plain_free(&p);
        if (v.type[0] + v.type[1]) return share - step;
    }
    return most;
}

static jali_bitmap cap_drawing(void)
{
    int32_t size = CAP_RADIUS_PX + 2 * MARGIN_PX;
    jali_bitmap drawing;
    CHECK_OK(jali_bitmap_create(ctx, size, size, &drawing));
    for (int32_t y = 0; y < size; y++)
        for (int32_t x = 0; x < size; x++) {
            bool inside = x >= MARGIN_PX && y >= MARGIN_PX && x < size - MARGIN_PX && y < size - MARGIN_PX;
            jali_bitmap_set(&drawing, x, y, !inside || drawn_on_cap(x, y));
        }
    return drawing;
}

TEST(a_cap_has_the_same_smallest_widths_at_pole_and_rim)
{
    jali_bitmap drawing = cap_drawing();
    jali_chart chart = chart_of(drawing.width_px, cap_metric);
    jali_optimised r;
    CHECK_OK(jali_optimise(ctx, &drawing, &chart, NULL, &r));
    check_widths(&r, "cap", cap_metric, cap_length);
    judge_verdict flat = judge_widths(&r.mask, true, true, rule_for(true, 1));
    CHECK(flat.type[0] + flat.type[1] > 0); // in the picture the rim's bars are too thin
    for (int32_t white = 0; white < 2; white++) {
        double pole = smallest_width(&r.mask, white, true), rim = smallest_width(&r.mask, white, false);
        double phi_mm = white ? 0.3 : 0.5;
        print_message("smallest %s: %.3f mm at the pole, %.3f mm at the rim\n", white ? "solid" : "void",
                      phi_mm * pole, phi_mm * rim);
        CHECK(fabs(pole / rim - 1) <= 0.1);
    }
    jali_optimised_free(ctx, &r);
    jali_bitmap_free(ctx, &drawing);
    free(chart.metric);
}

// --- Random pictures

static void check_random(const char *what, metric_of metric, judge_length length, uint64_t seed)
{
    int32_t size = RANDOM_PX + 2 * MARGIN_PX;
    jali_chart chart = chart_of(size, metric);
    jali_context *by_threads[3];
    open_thread_contexts(by_threads);
    for (int32_t round = 0; round < RANDOM_ROUNDS; round++) {
        int32_t grain = 4 + 3 * (round % 4);
        jali_bitmap small = random_bitmap(&seed, size, size, 35 + 15 * (round % 3)), drawing;
        jali_optimised r[3];
        CHECK_OK(jali_bitmap_create(ctx, size, size, &drawing));
        for (int32_t y = 0; y < size; y++)
            for (int32_t x = 0; x < size; x++) {
                bool inside =
                    x >= MARGIN_PX && y >= MARGIN_PX && x < size - MARGIN_PX && y < size - MARGIN_PX;
                jali_bitmap_set(&drawing, x, y, !inside || jali_bitmap_get(&small, x / grain, y / grain));
            }
        jali_status status = JALI_OK;
        for (int32_t i = 0; i < 3; i++) {
            status = jali_optimise(by_threads[i], &drawing, &chart, NULL, &r[i]);
            CHECK(status == JALI_OK || status == JALI_NO_RESULT);
            CHECK(same_bitmap(&r[i].mask, &r[0].mask));
        }
        if (status == JALI_OK) check_widths(&r[0], what, metric, length);
        for (int32_t i = 0; i < 3; i++) jali_optimised_free(by_threads[i], &r[i]);
        jali_bitmap_free(ctx, &small);
        jali_bitmap_free(ctx, &drawing);
    }
    close_thread_contexts(by_threads);
    free(chart.metric);
}

TEST(random_pictures_on_a_cylinder_with_any_threads)
{
    check_random("cylinder", cylinder_metric, cylinder_length, 31);
}

TEST(random_pictures_on_waves)
{
    check_random("waves", wavy_metric, wavy_length, 32);
}

// --- Flat surfaces with a metric

static void identity_metric(double x, double y, double g[3])
{
    (void)x, (void)y;
    g[0] = g[2] = 1;
    g[1] = 0;
}

TEST(a_metric_that_is_the_identity_changes_nothing)
{
    uint64_t seed = 5;
    int32_t size = RANDOM_PX + 2 * MARGIN_PX;
    jali_chart chart = chart_of(size, identity_metric), flat = chart;
    jali_bitmap drawing = random_bitmap(&seed, size, size, 0);
    flat.metric = NULL;
    for (int32_t y = 0; y < size; y++)
        for (int32_t x = 0; x < size; x++)
            jali_bitmap_set(&drawing, x, y, hypot(x % 60 - 30, y % 70 - 35) > 18 && x % 45 > 9);
    jali_optimised r[2];
    CHECK_OK(jali_optimise(ctx, &drawing, &chart, NULL, &r[0]));
    CHECK_OK(jali_optimise(ctx, &drawing, &flat, NULL, &r[1]));
    CHECK(same_bitmap(&r[0].mask, &r[1].mask));
    jali_optimised_free(ctx, &r[0]);
    jali_optimised_free(ctx, &r[1]);
    jali_bitmap_free(ctx, &drawing);
    free(chart.metric);
}

static jali_status optimise_on_a_curve(jali_context *limited, void *data)
{
    jali_optimised r;
    const jali_chart *chart = data;
    jali_bitmap drawing = {0};
    jali_status status = jali_bitmap_create(limited, chart->width_px, chart->height_px, &drawing);
    if (status != JALI_OK) return status;
    for (int32_t y = 0; y < drawing.height_px; y++)
        for (int32_t x = 0; x < drawing.width_px; x++)
            jali_bitmap_set(&drawing, x, y, x < 40 || y < 40 || x > 90 || y > 90 || (x > 60 && x < 66));
    status = jali_optimise(limited, &drawing, chart, NULL, &r);
    if (status == JALI_OK) jali_optimised_free(limited, &r);
    jali_bitmap_free(limited, &drawing);
    return status;
}

static void stretched_twice(double x, double y, double g[3])
{
    (void)x, (void)y;
    g[0] = 4;
    g[1] = 0;
    g[2] = 1;
}

TEST(every_allocation_refused_once)
{
    jali_chart chart = chart_of(130, stretched_twice);
    refuse_each_allocation(optimise_on_a_curve, &chart);
    free(chart.metric);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cap_has_the_same_smallest_widths_at_pole_and_rim),
        cmocka_unit_test(random_pictures_on_a_cylinder_with_any_threads),
        cmocka_unit_test(random_pictures_on_waves),
        cmocka_unit_test(a_metric_that_is_the_identity_changes_nothing),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
