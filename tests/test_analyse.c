// analyse: loads and supports by their sums, a plate and a beam by their formulas, and every bad figure by
// its sentence.
#include "testing.h"
#include "sheets.h"
#include "structure/loads.h"

#include <jali/analyse.h>

static jali_sheet plate(int32_t cells, int32_t holes)
{
    pierced_options o = {.cells = cells, .holes = holes, .size_mm = 20, .thickness_mm = 0.4, .hole_mm = 0.8};
    jali_sheet sheet;
    CHECK_OK(pierced_sheet(ctx, &o, &sheet));
    return sheet;
}

static jali_analyse_options held_at_rim(void)
{
    jali_analyse_options opt = jali_analyse_defaults();
    opt.support = JALI_SUPPORT_RIM;
    return opt;
}

static void sum_of(const double (*force)[6], int32_t count, double sum[3])
{
    memset(sum, 0, 3 * sizeof *sum);
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) sum[k] += force[i][k];
}

// Forces at the nodes under a load, and what they sum to.
static void load_sum(const jali_sheet *sheet, const jali_load *load, double sum[3])
{
    jali_analyse_options opt = held_at_rim();
    double(*force)[6] = calloc((size_t)sheet->node_count, sizeof *force), applied;
    uint8_t *held = calloc((size_t)sheet->node_count, 1);
    opt.load = *load;
    if (opt.load.spot_mm == 0) opt.load.spot_mm = 3;
    CHECK_OK(load_nodes(ctx, sheet, &opt, held, force, &applied));
    sum_of((const double(*)[6])force, sheet->node_count, sum);
    free(held);
    free(force);
}

TEST(loads_sum_to_what_was_asked_for)
{
    jali_sheet sheet = plate(40, 5);
    double sum[3], area = sheet_area(&sheet);
    load_sum(&sheet, &(jali_load){.force_n = 7}, sum);
    CHECK(fabs(sum[2] + 7) < 1e-9 && fabs(sum[0]) < 1e-12);
    load_sum(&sheet, &(jali_load){.pressure_mpa = 0.01}, sum);
    CHECK(fabs(sum[2] + 0.01 * area) < 1e-9);
    load_sum(&sheet, &(jali_load){.weight = 2}, sum); // PLA, 1.24 g/cm3
    CHECK(fabs(sum[2] + 2 * 1.24e-6 * 9.80665 * area * 0.4) < 1e-12);
    load_sum(&sheet, &(jali_load){.weight = 1, .gravity = {0, -3, 0}}, sum);
    CHECK(sum[1] < 0 && sum[2] == 0);
    load_sum(&sheet, &(jali_load){.push_n = 5, .push_at_mm = {10, 10, 50}}, sum);
    CHECK(fabs(sum[2] + 5) < 1e-9);
    load_sum(&sheet, &(jali_load){.pinch_n = 5}, sum);
    CHECK(fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2]) < 1e-9);
    drop_sheet(ctx, &sheet);
}

TEST(only_loads_across_a_flat_sheet_need_no_more_than_bending)
{
    jali_sheet sheet = plate(4, 0);
    CHECK(bends_only(&sheet, &(jali_load){.force_n = 1, .push_n = 1}));
    CHECK(bends_only(&sheet, &(jali_load){.weight = 1}));
    CHECK(!bends_only(&sheet, &(jali_load){.weight = 1, .gravity = {0, -1, 0}}));
    CHECK(!bends_only(&sheet, &(jali_load){.force_n = 1, .pinch_n = 1}));
    sheet.flat = false;
    CHECK(!bends_only(&sheet, &(jali_load){.force_n = 1}));
    drop_sheet(ctx, &sheet);
}

// Clamped square plate: 0.00126532 q a^4 / D in the middle, moment 0.0513 q a^2 in the middle of a side.
TEST(a_clamped_plate_gives_way_and_is_stressed_by_the_formula)
{
    jali_sheet sheet = plate(48, 0);
    jali_analyse_options opt = held_at_rim();
    jali_analysis a;
    double q = 0.002, e = opt.material.e_mpa, nu = opt.material.nu, t = 0.4;
    double rigidity = e * t * t * t / (12 * (1 - nu * nu));
    opt.load.pressure_mpa = q;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &a));
    double wanted = 0.00126532 * q * 160000 / rigidity;
    CHECK(fabs(a.moved.value / wanted - 1) < 0.01);
    CHECK(fabs(a.moved.at_mm[0] - 10) < 0.5 && fabs(a.moved.at_mm[1] - 10) < 0.5);
    double side = 6 * 0.0513 * q * 400 / (t * t); // across the clamped side; along it nu times that
    double von_mises = side * sqrt(1 - nu + nu * nu);
    CHECK(fabs(a.raw_stress.value / von_mises - 1) < 0.05);
    CHECK(a.stress.value <= a.raw_stress.value * 1.0001 && a.residual < 1e-8);
    jali_analysis_free(ctx, &a);
    jali_analysis_free(ctx, &a);
    drop_sheet(ctx, &sheet);
}

TEST(twice_the_load_is_twice_the_stress_and_stiffness_does_not_matter_to_it)
{
    jali_sheet sheet = plate(24, 3);
    jali_analyse_options opt = held_at_rim();
    jali_analysis one, two, soft;
    opt.load.force_n = 1;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &one));
    opt.load.force_n = 2;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &two));
    opt.material.e_mpa /= 10;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &soft));
    CHECK(fabs(two.stress.value / one.stress.value - 2) < 1e-5);
    CHECK(fabs(soft.stress.value / two.stress.value - 1) < 1e-5);
    CHECK(fabs(soft.moved.value / two.moved.value - 10) < 1e-5);
    jali_analysis_free(ctx, &one);
    jali_analysis_free(ctx, &two);
    jali_analysis_free(ctx, &soft);
    drop_sheet(ctx, &sheet);
}

// A flat sheet that is not said to be flat: the six unknowns must tell the same as the three. (Not under
// pressure, which six unknowns get with the moments of facet_pressure.)
TEST(bending_alone_and_all_six_unknowns_agree)
{
    jali_sheet sheet = plate(24, 3);
    jali_analyse_options opt = held_at_rim();
    jali_analysis three, six;
    opt.load.weight = 100;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &three));
    sheet.flat = false;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &six));
    CHECK(fabs(three.moved.value / six.moved.value - 1) < 1e-9);
    CHECK(fabs(three.stress.value / six.stress.value - 1) < 1e-6);
    jali_analysis_free(ctx, &three);
    jali_analysis_free(ctx, &six);
    drop_sheet(ctx, &sheet);
}

TEST(a_thicker_wall_is_analysed_again_as_if_anew)
{
    jali_sheet sheet = plate(30, 5);
    jali_analyse_options opt = held_at_rim();
    jali_analysis again, anew;
    opt.load.force_n = 3;
    opt.load.weight = 1;
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &again));
    for (int32_t i = 0; i < sheet.node_count; i++) sheet.thickness_mm[i] *= 1.7;
    CHECK_OK(jali_analyse_again(ctx, &sheet, &again));
    CHECK_OK(jali_analyse(ctx, &sheet, &opt, &anew));
    CHECK(memcmp(again.mean_mpa, anew.mean_mpa, (size_t)sheet.node_count * sizeof *anew.mean_mpa) == 0);
    CHECK(again.moved.value == anew.moved.value);
    jali_analysis_free(ctx, &anew);
    sheet.thickness_mm[3] = -1;
    CHECK_STATUS(jali_analyse_again(ctx, &sheet, &again), JALI_BAD_VALUE);
    CHECK(again.node_count == 0 && !again.stiffness);
    drop_sheet(ctx, &sheet);
}

TEST(bad_figures_get_a_sentence)
{
    jali_sheet sheet = plate(8, 0);
    jali_analyse_options good = held_at_rim(), opt;
    jali_analysis a;
    good.load.force_n = 1;
#define REFUSED(change, wanted)                                                                              \
    do {                                                                                                     \
        opt = good;                                                                                          \
        change;                                                                                              \
        CHECK_STATUS(jali_analyse(ctx, &sheet, &opt, &a), wanted);                                           \
        CHECK(strlen(jali_message(ctx)) > 10 && a.node_count == 0 && !a.displacement);                       \
    } while (0)
    REFUSED(opt.load.force_n = NAN, JALI_BAD_VALUE);
    REFUSED(opt.load.force_n = INFINITY, JALI_BAD_VALUE);
    REFUSED(opt.load.force_n = 0, JALI_BAD_VALUE);
    REFUSED(opt.load.pressure_mpa = 1, JALI_BAD_VALUE);
    REFUSED(opt.load.spot_mm = 0, JALI_BAD_VALUE);
    REFUSED(opt.load.gravity[1] = NAN, JALI_BAD_VALUE);
    REFUSED(opt.material.e_mpa = 0, JALI_BAD_VALUE);
    REFUSED(opt.material.nu = 0.5, JALI_BAD_VALUE);
    REFUSED(opt.phi_s_mm = -1, JALI_BAD_VALUE);
    REFUSED(sheet.thickness_mm[5] = 0, JALI_BAD_VALUE);
    sheet.thickness_mm[5] = 0.4;
    REFUSED(opt.support = JALI_SUPPORT_PICTURE, JALI_NO_RESULT); // no node of this sheet is on one
    REFUSED(opt.support = JALI_SUPPORT_BASE, JALI_NO_RESULT);    // flat: all of it lies lowest
    drop_sheet(ctx, &sheet);
}

TEST(a_piece_that_nothing_holds_gets_a_sentence_with_its_place)
{
    jali_sheet sheet = plate(8, 0);
    jali_analyse_options opt = held_at_rim();
    jali_analysis a;
    opt.load.force_n = 1;
    // A square of four nodes far away, joined to nothing.
    int32_t n = sheet.node_count;
    jali_sheet two = {.node_count = n + 4, .triangle_count = sheet.triangle_count + 2, .flat = true};
    CHECK_OK(ALLOCATE(ctx, two.node, n + 4));
    CHECK_OK(ALLOCATE(ctx, two.thickness_mm, n + 4));
    CHECK_OK(ALLOCATE_CLEARED(ctx, two.border, n + 4));
    CHECK_OK(ALLOCATE(ctx, two.triangle, two.triangle_count));
    memcpy(two.node, sheet.node, (size_t)n * sizeof *two.node);
    memcpy(two.border, sheet.border, (size_t)n);
    memcpy(two.triangle, sheet.triangle, (size_t)sheet.triangle_count * sizeof *two.triangle);
    for (int32_t i = 0; i < n + 4; i++) two.thickness_mm[i] = 0.4;
    for (int32_t i = 0; i < 4; i++) {
        two.node[n + i][0] = 77 + (i == 1 || i == 2);
        two.node[n + i][1] = i >= 2;
        two.node[n + i][2] = 0;
    }
    memcpy(two.triangle[two.triangle_count - 2], (int32_t[]){n, n + 1, n + 2}, 12);
    memcpy(two.triangle[two.triangle_count - 1], (int32_t[]){n, n + 2, n + 3}, 12);
    CHECK_STATUS(jali_analyse(ctx, &two, &opt, &a), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "77") != NULL);
    drop_sheet(ctx, &two);
    drop_sheet(ctx, &sheet);
}

TEST(materials_are_found_by_name_in_any_case)
{
    int32_t count;
    const jali_material *list = jali_material_list(&count);
    CHECK(count >= 5 && jali_material_find("PETG") && !jali_material_find("cheese"));
    for (int32_t i = 0; i < count; i++) {
        CHECK(jali_material_find(list[i].name) == &list[i] && strlen(list[i].source) > 5);
        CHECK(list[i].e_mpa > 0 && list[i].nu > 0 && list[i].nu < 0.5 && list[i].limit_mpa > 0);
    }
}

TEST(any_number_of_threads_gives_the_same_bytes)
{
    jali_context *by_threads[3];
    jali_sheet sheet = plate(32, 4);
    jali_analyse_options opt = held_at_rim();
    jali_analysis a[3];
    opt.load.force_n = 1;
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) CHECK_INT(jali_analyse(by_threads[i], &sheet, &opt, &a[i]), JALI_OK);
    for (int32_t i = 1; i < 3; i++) {
        CHECK(memcmp(a[0].displacement, a[i].displacement,
                     (size_t)a[0].node_count * sizeof *a[0].displacement) == 0);
        CHECK(memcmp(a[0].mean_mpa, a[i].mean_mpa, (size_t)a[0].node_count * sizeof *a[0].mean_mpa) == 0);
    }
    for (int32_t i = 0; i < 3; i++) jali_analysis_free(by_threads[i], &a[i]);
    close_thread_contexts(by_threads);
    drop_sheet(ctx, &sheet);
}

static jali_status analyse_once(jali_context *limited, void *data)
{
    jali_analyse_options opt = held_at_rim();
    jali_analysis a;
    opt.load.force_n = 1;
    jali_status status = jali_analyse(limited, data, &opt, &a);
    jali_analysis_free(limited, &a);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_sheet sheet = plate(6, 0);
    refuse_each_allocation(analyse_once, &sheet);
    drop_sheet(ctx, &sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loads_sum_to_what_was_asked_for),
        cmocka_unit_test(only_loads_across_a_flat_sheet_need_no_more_than_bending),
        cmocka_unit_test(a_clamped_plate_gives_way_and_is_stressed_by_the_formula),
        cmocka_unit_test(twice_the_load_is_twice_the_stress_and_stiffness_does_not_matter_to_it),
        cmocka_unit_test(bending_alone_and_all_six_unknowns_agree),
        cmocka_unit_test(a_thicker_wall_is_analysed_again_as_if_anew),
        cmocka_unit_test(bad_figures_get_a_sentence),
        cmocka_unit_test(a_piece_that_nothing_holds_gets_a_sentence_with_its_place),
        cmocka_unit_test(materials_are_found_by_name_in_any_case),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
