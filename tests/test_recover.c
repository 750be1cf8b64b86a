// Stresses at nodes: constant states, creases and steps, discs, bad input.
#include "testing.h"
#include "shell_model.h"
#include "structure/average.h"

static const facet_material PLASTIC = {.e_mpa = 2300, .nu = 0.35, .thickness_mm = 1.5};

static double uniform(uint64_t *seed)
{
    return (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// A grid of 10 x 6 mm with nodes inside moved about, in the xy plane.
static shell_model uneven_grid(uint64_t *seed)
{
    shell_model m = grid_model(10, 6, CROSSED, PLASTIC);
    for (int32_t n = 0; n < m.node_count; n++)
        for (int k = 0; k < 2; k++) {
            bool inside = m.place[n][k] > 0 && m.place[n][k] < 1;
            double cells = k ? 6 : 10;
            m.node[n][k] = cells * m.place[n][k] + (inside ? 0.5 * (uniform(seed) - 0.5) : 0);
        }
    return m;
}

// Pull along x by 1 MPa, bend by a moment whose stress on the outer face is 4 MPa along x.
static void pull_and_bend(shell_model *m, double pull_mpa, double bend_mpa)
{
    double e = m->made_of.e_mpa, nu = m->made_of.nu, strain = pull_mpa / e;
    double curve = bend_mpa / (e * 0.5 * m->made_of.thickness_mm); // of the slope along x
    for (int32_t n = 0; n < m->node_count; n++) {
        double x = m->node[n][0], y = m->node[n][1];
        double u[6] = {strain * x, -nu * strain * y, -0.5 * curve * (x * x - nu * y * y), nu * curve * y,
                       curve * x};
        memcpy(m->u[n], u, sizeof u);
    }
}

TEST(constant_stress_is_found_at_every_node)
{
    uint64_t seed = 5;
    shell_model m = uneven_grid(&seed);
    jali_sheet sheet = model_sheet(&m);
    stresses s;
    pull_and_bend(&m, 1, 4);
    CHECK_OK(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 0.7, &s));
    for (int32_t n = 0; n < m.node_count; n++) {
        CHECK(fabs(s.von_mises[n][OUTER_FACE] - 5) < 1e-9);
        CHECK(fabs(s.von_mises[n][MIDDLE] - 1) < 1e-9);
        CHECK(fabs(s.von_mises[n][INNER_FACE] - 3) < 1e-9);
        CHECK(fabs(s.principal[n][0][0] - 5) < 1e-9 && fabs(s.principal[n][0][1]) < 1e-9);
        CHECK(fabs(s.principal[n][1][0]) < 1e-9 && fabs(s.principal[n][1][1] + 3) < 1e-9);
        CHECK(fabs(s.worst[n] - 5) < 1e-9 && fabs(s.mean[n] - 5) < 1e-9);
    }
    CHECK(fabs(s.worst_mpa - 5) < 1e-9 && s.worst_at >= 0);
    stresses_free(ctx, &s);
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

// Tension along x that peaks in the middle of a strip as four squares across see it: 1, and 0 at its sides.
TEST(peaks_inside_a_strip_are_not_levelled)
{
    shell_model m = grid_model(10, 6, CROSSED, (facet_material){1000, 0, 1});
    jali_sheet sheet = model_sheet(&m);
    stresses s;
    int32_t seen = 0;
    for (int32_t n = 0; n < m.node_count; n++) {
        double x = 10 * m.place[n][0] - 5;
        m.node[n][0] = 10 * m.place[n][0], m.node[n][1] = 6 * m.place[n][1];
        m.u[n][0] = 1e-3 * (x - x * x * x / 12);
    }
    CHECK_OK(recover_stresses(ctx, &sheet, &m.made_of, (const double(*)[6])m.u, 0, &s));
    for (int32_t n = 0; n < m.node_count; n++) {
        if (fabs(m.node[n][0] - 5) > 1e-9 || m.place[n][1] < 0.3 || m.place[n][1] > 0.7) continue;
        CHECK(fabs(s.worst[n] - 1) < 0.06);
        seen++;
    }
    CHECK(seen > 0);
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

// Too thick to bend, a slope shears it: 1.5 times the mean stress in the middle, none on the faces.
TEST(shear_is_largest_in_the_middle)
{
    shell_model m = grid_model(3, 3, CROSSED, (facet_material){100, 0.25, 1e5});
    jali_sheet sheet = model_sheet(&m);
    stresses s;
    for (int32_t n = 0; n < m.node_count; n++) m.u[n][2] = 0.01 * m.node[n][0];
    CHECK_OK(recover_stresses(ctx, &sheet, &m.made_of, (const double(*)[6])m.u, 0, &s));
    double shear = 1.5 * 5 / 6 * 100 / 2.5 * 0.01;
    for (int32_t n = 0; n < m.node_count; n++) {
        CHECK(fabs(s.von_mises[n][MIDDLE] - sqrt(3) * shear) < 1e-6);
        CHECK(s.von_mises[n][OUTER_FACE] < 1e-4 * shear);
        CHECK(s.mean[n] == s.worst[n]);
    }
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

// Half of the grid folded up, or thicker: what happens on one side does not reach the other.
static void check_two_sides(bool folded)
{
    shell_model m = grid_model(8, 4, CROSSED, PLASTIC);
    for (int32_t n = 0; n < m.node_count; n++) {
        double x = 8 * m.place[n][0] - 4;
        m.node[n][0] = folded ? MIN(x, 0) : x;
        m.node[n][1] = 4 * m.place[n][1];
        m.node[n][2] = folded ? MAX(x, 0) : 0;
        if (x < 0) m.u[n][0] = 2 * x / PLASTIC.e_mpa; // 2 MPa held from narrowing: on this side alone
        if (x > 0) m.u[n][folded ? 2 : 0] = 0;
    }
    jali_sheet sheet = model_sheet(&m);
    if (!folded) // thick from one column after the middle on; the column between is of its own
        for (int32_t n = 0; n < m.node_count; n++)
            if (m.node[n][0] > 0.5) sheet.thickness_mm[n] *= 3;
    stresses s;
    CHECK_OK(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 0, &s));
    double nu = PLASTIC.nu, pulled = 2 / (1 - nu * nu) * sqrt(1 - nu + nu * nu);
    for (int32_t n = 0; n < m.node_count; n++)
        CHECK(fabs(s.von_mises[n][MIDDLE] - (m.place[n][0] > 0.5 ? 0 : pulled)) < 1e-9);
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

TEST(creases_keep_their_sides_apart)
{
    check_two_sides(true);
}

TEST(steps_of_thickness_keep_their_sides_apart)
{
    check_two_sides(false);
}

// A shallow cylinder is one surface: hoop stress comes out whole although every facet has axes of its own.
TEST(curved_sheets_are_read_in_the_axes_of_the_node)
{
    shell_model m = grid_model(24, 6, CROSSED, PLASTIC);
    double radius = 20, swell = 0.01;
    for (int32_t n = 0; n < m.node_count; n++) {
        double angle = m.place[n][0] * 2;
        m.node[n][0] = radius * sin(angle);
        m.node[n][1] = 6 * m.place[n][1];
        m.node[n][2] = radius * cos(angle);
        m.u[n][0] = swell * sin(angle);
        m.u[n][2] = swell * cos(angle);
    }
    jali_sheet sheet = model_sheet(&m);
    stresses s;
    CHECK_OK(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 1, &s));
    double nu = PLASTIC.nu, hoop = PLASTIC.e_mpa * swell / radius / (1 - nu * nu) * sqrt(1 - nu + nu * nu);
    for (int32_t n = 0; n < m.node_count; n++) CHECK(fabs(s.von_mises[n][MIDDLE] / hoop - 1) < 1e-3);
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

TEST(circles_cut_triangles_exactly)
{
    uint64_t seed = 77;
    for (int round = 0; round < 60; round++) {
        double node[3][2], twice, area, moment[2], sampled[3] = {0};
        do {
            for (int i = 0; i < 6; i++) node[i / 2][i % 2] = 4 * (uniform(&seed) - 0.5);
            twice = (node[1][0] - node[0][0]) * (node[2][1] - node[0][1]) -
                    (node[1][1] - node[0][1]) * (node[2][0] - node[0][0]);
        } while (twice < 0.5);
        if (round % 3 == 0) node[0][0] = node[0][1] = 0; // the centre on a corner
        twice = (node[1][0] - node[0][0]) * (node[2][1] - node[0][1]) -
                (node[1][1] - node[0][1]) * (node[2][0] - node[0][0]);
        if (twice < 0.2) continue;
        circle_moments((const double(*)[2])node, 1, &area, moment);
        enum { FINE = 400 };
        for (int i = 0; i < FINE; i++)
            for (int j = 0; i + j < FINE; j++)
                for (int half = 0; half < (i + j < FINE - 1 ? 2 : 1); half++) {
                    double a = (i + (half ? 2. / 3 : 1. / 3)) / FINE,
                           b = (j + (half ? 2. / 3 : 1. / 3)) / FINE, p[2];
                    for (int k = 0; k < 2; k++)
                        p[k] = node[0][k] + a * (node[1][k] - node[0][k]) + b * (node[2][k] - node[0][k]);
                    if (p[0] * p[0] + p[1] * p[1] > 1) continue;
                    sampled[0] += 0.5 * twice / FINE / FINE;
                    for (int k = 0; k < 2; k++) sampled[1 + k] += p[k] * 0.5 * twice / FINE / FINE;
                }
        CHECK(fabs(area - sampled[0]) < 4e-3);
        CHECK(fabs(moment[0] - sampled[1]) < 4e-3 && fabs(moment[1] - sampled[2]) < 4e-3);
    }
}

// The fans of a flat model of one thickness, and a value at each.
static double *slope_on(const jali_sheet *sheet, const uint8_t *wanted, fans *f)
{
    double(*up)[3] = zeros((size_t)sheet->triangle_count, sizeof *up);
    double *thick = zeros((size_t)sheet->triangle_count, sizeof *thick);
    for (int32_t t = 0; t < sheet->triangle_count; t++) up[t][2] = thick[t] = 1;
    CHECK_OK(fans_of(ctx, sheet, (const double(*)[3])up, thick, wanted, f));
    double *value = zeros((size_t)f->fan_count, sizeof *value);
    for (int32_t n = 0; n < sheet->node_count; n++)
        for (int32_t i = f->first_fan[n]; i < f->first_fan[n + 1]; i++) value[i] = 3 + sheet->node[n][1];
    free(up);
    free(thick);
    return value;
}

TEST(means_are_over_discs_half_discs_and_what_is_joined)
{
    shell_model m = grid_model(12, 12, CROSSED, PLASTIC);
    fans f;
    for (int32_t n = 0; n < m.node_count; n++)
        for (int k = 0; k < 2; k++) m.node[n][k] *= 12;
    jali_sheet sheet = model_sheet(&m);
    double *value = slope_on(&sheet, NULL, &f), radius = 2.2, off = 4 * radius / (3 * M_PI);
    CHECK_INT(f.fan_count, m.node_count);
    CHECK(fabs(mean_around(&sheet, &f, value, node_at(&m, 0.5, 0.5), radius) - 9) < 1e-12);
    CHECK(fabs(mean_around(&sheet, &f, value, node_at(&m, 0.5, 0), radius) - 3 - off) < 1e-12);
    CHECK(fabs(mean_around(&sheet, &f, value, node_at(&m, 0.5, 1), radius) - 15 + off) < 1e-12);
    CHECK(fabs(mean_around(&sheet, &f, value, node_at(&m, 0, 0), radius) - 3 - off) < 1e-12);
    CHECK(fabs(mean_around(&sheet, &f, value, node_at(&m, 0.5, 0.5), 1e-9) - 9) < 1e-6);
    fans_free(ctx, &f);
    free(value);
    // A slit along y = 6 from x = 0 to 6: nodes of the upper side are their own.
    m.node = realloc(m.node, (size_t)(m.node_count + 6) * sizeof *m.node);
    for (int32_t i = 0; i < 6; i++) memcpy(m.node[m.node_count + i], m.node[6 * 13 + i], sizeof *m.node);
    for (int32_t t = 12 * 12; t < m.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (m.triangle[t][k] >= 6 * 13 && m.triangle[t][k] < 6 * 13 + 6)
                m.triangle[t][k] += m.node_count - 6 * 13;
    m.node_count += 6;
    free(sheet.thickness_mm);
    sheet = model_sheet(&m);
    uint8_t *none = zeros((size_t)m.node_count, sizeof *none);
    value = slope_on(&sheet, none, &f); // sides that were not sought are found as they are met
    CHECK(fabs(mean_around(&sheet, &f, value, 6 * 13 + 3, radius) - 9 + off) < 1e-12);
    CHECK(fabs(mean_around(&sheet, &f, value, m.node_count - 3, radius) - 9 - off) < 1e-12);
    CHECK(f.beside[0] == NOT_SOUGHT);
    free(none);
    fans_free(ctx, &f);
    free(value);
    free(sheet.thickness_mm);
    model_free(&m);
}

// Bent about a few places only: what is read there is what is read when all is.
TEST(peaks_are_the_same_where_the_rest_is_not_read)
{
    uint64_t seed = 11;
    shell_model m = grid_model(60, 40, CROSSED, PLASTIC);
    jali_sheet sheet = model_sheet(&m);
    stresses all, peaks;
    int32_t passed_over = 0;
    for (int i = 0; i < 5; i++)
        m.u[next_random(&seed) % (uint64_t)m.node_count][2] = 0.01 + 0.02 * uniform(&seed);
    CHECK_OK(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 0.05, &all));
    CHECK_OK(recover_peaks(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 0.05, &peaks));
    CHECK(peaks.mean_mpa == all.mean_mpa && peaks.mean_at == all.mean_at);
    CHECK(peaks.worst_mpa == all.worst_mpa && peaks.worst_at == all.worst_at);
    for (int32_t n = 0; n < m.node_count; n++) {
        CHECK(all.mean[n] < 0.4 * all.mean_mpa || peaks.mean[n] == all.mean[n]);
        CHECK(peaks.mean[n] < 0.4 * all.mean_mpa || peaks.mean[n] == all.mean[n]);
        passed_over += peaks.mean[n] != all.mean[n];
    }
    CHECK(passed_over > 0);
    stresses_free(ctx, &all);
    stresses_free(ctx, &peaks);
    free(sheet.thickness_mm);
    model_free(&m);
}

TEST(any_number_of_threads_gives_the_same_bytes)
{
    uint64_t seed = 9;
    shell_model m = grid_model(60, 40, CROSSED, PLASTIC);
    for (int32_t n = 0; n < m.node_count; n++)
        for (int k = 0; k < 6; k++) m.u[n][k] = uniform(&seed);
    jali_sheet sheet = model_sheet(&m);
    jali_context *by_threads[3];
    stresses s[3];
    open_thread_contexts(by_threads);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(
            recover_stresses(by_threads[i], &sheet, &PLASTIC, (const double(*)[6])m.u, 0.05, &s[i]), 0);
        CHECK(memcmp(s[i].mean, s[0].mean, (size_t)m.node_count * sizeof *s[0].mean) == 0);
        CHECK(memcmp(s[i].von_mises, s[0].von_mises, (size_t)m.node_count * sizeof *s[0].von_mises) == 0);
        CHECK_INT(s[i].mean_at, s[0].mean_at);
    }
    for (int i = 0; i < 3; i++) stresses_free(by_threads[i], &s[i]);
    close_thread_contexts(by_threads);
    free(sheet.thickness_mm);
    model_free(&m);
}

static jali_status recover_with(jali_context *limited, void *data)
{
    const shell_model *m = data;
    jali_sheet sheet = model_sheet(m);
    stresses s;
    jali_status status = recover_stresses(limited, &sheet, &PLASTIC, (const double(*)[6])m->u, 0.5, &s);
    stresses_free(limited, &s);
    free(sheet.thickness_mm);
    return status;
}

TEST(refused_memory_and_bad_values_end_in_a_sentence)
{
    uint64_t seed = 3;
    shell_model m = uneven_grid(&seed);
    jali_sheet sheet = model_sheet(&m);
    stresses s;
    refuse_each_allocation(recover_with, &m);
    CHECK_STATUS(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, NAN, &s), JALI_BAD_VALUE);
    CHECK_STATUS(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, -1, &s), JALI_BAD_VALUE);
    m.u[7][3] = NAN;
    CHECK_STATUS(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 1, &s), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "no number"));
    m.u[7][3] = 0;
    sheet.thickness_mm[4] = 0;
    CHECK_STATUS(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 1, &s), JALI_BAD_VALUE);
    sheet.node_count = sheet.triangle_count = 0;
    CHECK_OK(recover_stresses(ctx, &sheet, &PLASTIC, (const double(*)[6])m.u, 1, &s));
    CHECK_INT(s.worst_at, -1);
    stresses_free(ctx, &s);
    free(sheet.thickness_mm);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_stress_is_found_at_every_node),
        cmocka_unit_test(peaks_inside_a_strip_are_not_levelled),
        cmocka_unit_test(shear_is_largest_in_the_middle),
        cmocka_unit_test(creases_keep_their_sides_apart),
        cmocka_unit_test(steps_of_thickness_keep_their_sides_apart),
        cmocka_unit_test(curved_sheets_are_read_in_the_axes_of_the_node),
        cmocka_unit_test(circles_cut_triangles_exactly),
        cmocka_unit_test(means_are_over_discs_half_discs_and_what_is_joined),
        cmocka_unit_test(peaks_are_the_same_where_the_rest_is_not_read),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(refused_memory_and_bad_values_end_in_a_sentence),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
