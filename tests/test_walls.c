// Walls and gaps: shapes whose widths are known, plates carved with widths asked for.
#include "shapes.h"

#include <jali/jali.h>
#include "base/bytes.h"

static jali_check_report measured(jali_mesh mesh)
{
    jali_check_report report;
    jali_check_options opt = jali_check_defaults();
    opt.walls = true;
    CHECK_OK(jali_check(ctx, &mesh, &opt, &report));
    CHECK(report.walls.measured && report.gaps.measured);
    jali_mesh_free(ctx, &mesh);
    return report;
}

static bool about(double value, double wanted, double share)
{
    return fabs(value - wanted) <= share * wanted;
}

static jali_mesh stretched(jali_mesh mesh, double x, double y, double z)
{
    const double by[3] = {x, y, z};
    for (int32_t i = 0; i < mesh.vertex_count; i++)
        for (int k = 0; k < 3; k++) mesh.vertex[i][k] *= by[k];
    return mesh;
}

/// A pipe along z from radius r to s, `facets` around each; the outer skin first.
static jali_mesh pipe(int32_t facets, double r, double s, double height)
{
    static const int32_t next[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    jali_mesh mesh;
    int32_t at = 0;
    CHECK_OK(mesh_create(ctx, 4 * facets, 8 * facets, &mesh));
    for (int32_t i = 0; i < facets; i++)
        for (int32_t ring = 0; ring < 4; ring++) { // outside below, outside above, inside above, inside below
            double radius = ring < 2 ? s : r, angle = 6.283185307179586 * i / facets;
            double p[3] = {radius * cos(angle), radius * sin(angle), ring == 1 || ring == 2 ? height : 0};
            memcpy(mesh.vertex[4 * i + ring], p, sizeof p);
        }
    for (int32_t i = 0; i < facets; i++)
        for (int32_t ring = 0; ring < 4; ring++) {
            int32_t corner[4];
            for (int k = 0; k < 4; k++) corner[k] = (i + next[k][0]) % facets * 4 + (ring + next[k][1]) % 4;
            memcpy(mesh.triangle[at++], (int32_t[3]){corner[0], corner[1], corner[2]}, sizeof *mesh.triangle);
            memcpy(mesh.triangle[at++], (int32_t[3]){corner[0], corner[2], corner[3]}, sizeof *mesh.triangle);
        }
    return mesh;
}

/// A prism: a polygon, counter-clockwise and convex as seen from its first corner, from z = 0 up.
static jali_mesh prism(int32_t corners, const double (*corner)[2], double height)
{
    jali_mesh mesh;
    int32_t at = 0;
    CHECK_OK(mesh_create(ctx, 2 * corners, 4 * corners - 4, &mesh));
    for (int32_t i = 0; i < 2 * corners; i++) {
        double p[3] = {corner[i / 2][0], corner[i / 2][1], i % 2 ? height : 0};
        memcpy(mesh.vertex[i], p, sizeof p);
    }
    for (int32_t i = 0; i < corners; i++) {
        int32_t a = 2 * i, b = 2 * ((i + 1) % corners);
        memcpy(mesh.triangle[at++], (int32_t[3]){a, b, b + 1}, sizeof *mesh.triangle);
        memcpy(mesh.triangle[at++], (int32_t[3]){a, b + 1, a + 1}, sizeof *mesh.triangle);
        if (i == 0 || i + 1 == corners) continue;
        memcpy(mesh.triangle[at++], (int32_t[3]){0, b, a}, sizeof *mesh.triangle);
        memcpy(mesh.triangle[at++], (int32_t[3]){1, a + 1, b + 1}, sizeof *mesh.triangle);
    }
    return mesh;
}

TEST(a_cube_measures_its_side)
{
    jali_check_report r = measured(box_shape(100, 200, 300, 120, 220, 320));
    CHECK(about(r.walls.thinnest_mm, 20, 1e-6) && about(r.walls.percentile1_mm, 20, 1e-6));
    CHECK(r.gaps.thinnest_mm == INFINITY);
    r = measured(box_shape(0, 0, 0, 7, 3, 11));
    CHECK(about(r.walls.thinnest_mm, 3, 1e-6));
    CHECK(fabs(r.walls.at_mm[1] - 1.5) < 1e-6);
}

TEST(bars_and_slots_measure_their_widths)
{
    jali_check_report r = measured(stretched(pierced_plate(15, 1, 0), 0.3, 0.7, 1));
    CHECK(r.solid);
    CHECK(about(r.walls.thinnest_mm, 0.3, 1e-5) && about(r.gaps.thinnest_mm, 0.3, 1e-5));
    r = measured(together(box_shape(0, 0, 0, 5, 9, 5), box_shape(5.25, 0, 0, 9, 9, 5)));
    CHECK(about(r.gaps.thinnest_mm, 0.25, 1e-6) && about(r.walls.thinnest_mm, 3.75, 1e-6));
    CHECK(fabs(r.gaps.at_mm[0] - 5.125) < 1e-6);
}

TEST(round_walls_measure_what_is_between_their_skins)
{
    for (int32_t facets = 12; facets <= 200; facets += 47) {
        double flat = cos(3.141592653589793 / facets); // of the radius, at the middle of a facet
        jali_check_report r = measured(pipe(facets, 18, 20, 30));
        CHECK(r.solid);
        CHECK(about(r.walls.thinnest_mm, 2 * flat, 0.011));
    }
    jali_mesh skins = together(stretched(torus(80, 60), 8, 8, 8), inside_out(torus(80, 60)));
    for (int32_t i = skins.vertex_count / 2; i < skins.vertex_count;
         i++) { // the tube's radius 6 in place of 8
        double *p = skins.vertex[i], ring = hypot(p[0], p[1]);
        double radius = 24 + 6 * (ring - 3);
        p[0] *= radius / ring, p[1] *= radius / ring, p[2] *= 6;
    }
    jali_check_report r = measured(skins);
    CHECK_INT(r.voids, 1);
    CHECK(about(r.walls.thinnest_mm, 2, 0.02) && about(r.walls.percentile1_mm, 2, 0.02));
}

// Sides that lean by 4 degrees to each other: thinnest at the blunt end. Sides that meet in an edge of 4 or
// of 60 degrees read nothing near it.
TEST(leaning_sides_are_read_but_not_the_edge_they_meet_in)
{
    double slope = tan(0.07);
    const double blunt[4][2] = {{0, 0}, {20, 0}, {20, 1 + 20 * slope}, {0, 1}};
    jali_check_report r = measured(prism(4, blunt, 40));
    CHECK(r.solid);
    CHECK(r.walls.thinnest_mm > 0.97 && r.walls.thinnest_mm < 1.05);
    CHECK(r.walls.at_mm[0] < 1);
    const double sharp[3][2] = {{0, 0}, {20, 0}, {20, 20 * slope}},
                 wide[3][2] = {{0, 0}, {20, 0}, {10, 17.32}};
    CHECK(about(measured(prism(3, wide, 30)).walls.thinnest_mm, 30, 1e-6)); // top to bottom
    CHECK(about(measured(prism(3, sharp, 40)).walls.thinnest_mm, 40, 1e-6));
}

// What is promised on the mask, found again on the mesh. The smallest reading is a tip or a neck that adapt
// lets pass, so it is not asked for.
TEST(carved_plates_keep_the_widths_asked_for)
{
    for (int32_t round = 0; round < 3; round++) {
        jali_picture picture = {.width_px = 300, .height_px = 300, .grey = malloc(300 * 300)};
        jali_bitmap drawing;
        jali_options opt = jali_defaults();
        jali_result made;
        jali_check_report r;
        jali_check_options check = {.walls = true};
        CHECK_OK(jali_sample(ctx, "girih", 300, &drawing));
        for (int32_t i = 0; i < 300 * 300; i++)
            picture.grey[i] = jali_bitmap_get(&drawing, i % 300, i / 300) ? 255 : 0;
        opt.place.width_mm = 40;
        opt.optimise.phi_s_mm = 0.4 + 0.1 * round;
        opt.optimise.phi_v_mm = 0.6 - 0.1 * round;
        opt.predict = false;
        CHECK_OK(jali_make(ctx, &picture, &opt, &made));
        CHECK_OK(jali_check(ctx, &made.mesh, &check, &r));
        CHECK(about(r.walls.percentile1_mm, opt.optimise.phi_s_mm, 0.12));
        CHECK(r.gaps.percentile1_mm > 0.65 * opt.optimise.phi_v_mm);
        jali_result_free(ctx, &made);
        jali_bitmap_free(ctx, &drawing);
        free(picture.grey);
    }
}

TEST(a_mesh_without_an_inside_is_not_measured)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 1, 1);
    jali_check_options opt = {.walls = true};
    jali_check_report r;
    jali_bytes json = {0};
    cube.triangle_count = 11;
    CHECK_OK(jali_check(ctx, &cube, &opt, &r));
    CHECK(!r.walls.measured && !r.gaps.measured);
    cube.triangle_count = 12;
    CHECK_OK(jali_check(ctx, &cube, &opt, &r));
    CHECK_OK(jali_check_sentences(ctx, &r, &json));
    CHECK_OK(jali_check_json(ctx, &r, &json));
    CHECK_OK(bytes_append(ctx, &json, "", 1));
    CHECK(strstr((char *)json.data, "The thinnest wall measures 1 mm, at ("));
    CHECK(strstr((char *)json.data, "\"thinnest_mm\": 1.0") &&
          strstr((char *)json.data, "\"thinnest_mm\": null"));
    jali_bytes_free(ctx, &json);
    jali_mesh_free(ctx, &cube);
}

TEST(threads_do_not_change_a_reading)
{
    jali_context *by_threads[3];
    jali_check_report r[3];
    jali_check_options opt = {.walls = true};
    jali_mesh mesh = stretched(pierced_plate(31, 1, 7), 0.4, 0.5, 1);
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) CHECK_INT(jali_check(by_threads[i], &mesh, &opt, &r[i]), JALI_OK);
    CHECK(memcmp(&r[0], &r[1], sizeof *r) == 0 && memcmp(&r[0], &r[2], sizeof *r) == 0);
    CHECK(r[0].walls.measured);
    close_thread_contexts(by_threads);
    jali_mesh_free(ctx, &mesh);
}

static jali_status measure(jali_context *limited, void *data)
{
    jali_check_report r;
    jali_check_options opt = {.walls = true};
    return jali_check(limited, data, &opt, &r);
}

TEST(every_refused_allocation_is_a_status)
{
    jali_mesh mesh = box_shape(0, 0, 0, 1, 1, 1);
    refuse_each_allocation(measure, &mesh);
    jali_mesh_free(ctx, &mesh);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(a_cube_measures_its_side),
        RUN(bars_and_slots_measure_their_widths),
        RUN(round_walls_measure_what_is_between_their_skins),
        RUN(leaning_sides_are_read_but_not_the_edge_they_meet_in),
        RUN(carved_plates_keep_the_widths_asked_for),
        RUN(a_mesh_without_an_inside_is_not_measured),
        RUN(threads_do_not_change_a_reading),
        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
