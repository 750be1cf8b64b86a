// Shells: pictures pierced through them stay on the skins, and what comes out is always a closed solid.
#include "shapes.h"

#include <jali/check.h>
#include <jali/place.h>
#include <jali/shell.h>
#include <jali/trace.h>
#include "mesh/sides.h"

static jali_surface surface_of(const char *description)
{
    jali_surface surface;
    CHECK_OK(jali_surface_make(ctx, description, NULL, &surface));
    return surface;
}

// The bitmap as a picture whose pixels are working pixels, traced and laid on the shell: size in mm of a
// pixel.
static jali_status pierce(const jali_bitmap *bitmap, double pixel_mm, const jali_place_options *given,
                          double backing, jali_shell *shell, jali_contours *contours)
{
    jali_status status;
    jali_picture picture = {.width_px = bitmap->width_px, .height_px = bitmap->height_px};
    jali_place_options opt = *given;
    jali_chart chart = {0};
    jali_patch patch = {0};
    jali_bitmap drawing = {0};
    opt.paper = true;
    opt.width_mm = bitmap->width_px * pixel_mm;
    CHECK_OK(ALLOCATE(ctx, picture.grey, (size_t)picture.width_px * (size_t)picture.height_px));
    for (int32_t y = 0; y < picture.height_px; y++)
        for (int32_t x = 0; x < picture.width_px; x++)
            picture.grey[y * picture.width_px + x] = jali_bitmap_get(bitmap, x, y) ? 255 : 0;
    TRY(jali_place_on(ctx, &picture, 128, &opt, &shell->outer, &chart, &patch, &drawing, NULL));
    TRY(jali_trace(ctx, &drawing, &chart, NULL, contours));
    TRY(jali_pierce(ctx, contours, &patch, backing, shell));
done:
    jali_picture_free(ctx, &picture);
    jali_chart_free(ctx, &chart);
    jali_patch_free(ctx, &patch);
    jali_bitmap_free(ctx, &drawing);
    return status;
}

static jali_check_report solid_of(const jali_shell *shell)
{
    jali_mesh mesh;
    jali_check_report report;
    CHECK_OK(jali_shell_solid(ctx, shell, &mesh));
    CHECK_OK(jali_check(ctx, &mesh, NULL, &report));
    if (!report.solid) {
        jali_bytes text = {0};
        CHECK_OK(jali_check_sentences(ctx, &report, &text));
        print_error("%.*s\n", (int)text.size, (const char *)text.data);
        jali_bytes_free(ctx, &text);
    }
    jali_mesh_free(ctx, &mesh);
    return report;
}

// Twice the area inside a contour, lattice units; negative around voids.
static double signed_area2(const jali_contours *c, int32_t contour)
{
    double twice = 0;
    for (int32_t first = c->first[contour], end = c->first[contour + 1], k = first; k < end; k++) {
        const int32_t *p = c->point[k], *q = c->point[k + 1 < end ? k + 1 : first];
        twice += (double)p[0] * q[1] - (double)q[0] * p[1];
    }
    return twice;
}

static double solid_area(const jali_contours *c, double all_mm2)
{
    double twice = 0;
    for (int32_t i = 0; i < c->contour_count; i++) twice += signed_area2(c, i);
    return all_mm2 + twice / 2 * c->unit_mm * c->unit_mm;
}

TEST(a_plate_of_two_triangles_is_pierced_as_drawn)
{
    uint64_t random = 5;
    jali_place_options opt = jali_place_defaults();
    opt.placing = JALI_PLACE_WRAP;
    for (int32_t round = 0; round < 20; round++) {
        jali_surface plate = surface_of("plate:w=40,h=30");
        jali_shell shell;
        jali_contours contours = {0};
        jali_shell_options wall = {.thickness_mm = 2, .least_mm = 0.1};
        jali_bitmap bitmap = random_bitmap(&random, 40, 30, 50 + round);
        CHECK_OK(jali_shell_create(ctx, &plate, &wall, &shell, NULL));
        CHECK_OK(pierce(&bitmap, 0.8, &opt, 0, &shell, &contours));
        jali_check_report report = solid_of(&shell);
        CHECK(report.solid);
        CHECK(fabs(report.volume_mm3 - 2 * solid_area(&contours, 1200)) < 0.2);
        jali_contours_free(ctx, &contours);
        jali_shell_free(ctx, &shell);
        jali_bitmap_free(ctx, &bitmap);
    }
}

// The outer vertices lie on the facets of the cylinder, which has as many corners as its first row.
static double worst_off_facets(const jali_mesh *mesh, int32_t facets, double radius)
{
    double worst = 0, turn = 2 * acos(-1) / facets;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        double angle = atan2(mesh->vertex[v][0], -mesh->vertex[v][1]);
        double middle = (floor(angle / turn) + 0.5) * turn; // of the facet
        double away = mesh->vertex[v][0] * sin(middle) - mesh->vertex[v][1] * cos(middle);
        worst = MAX(worst, fabs(away - radius * cos(turn / 2)));
    }
    return worst;
}

TEST(the_outer_skin_stays_where_it_is)
{
    uint64_t random = 9;
    jali_surface tube = surface_of("cylinder:r=20,h=40,facets=64");
    jali_place_options opt = jali_place_defaults();
    jali_shell shell;
    jali_contours contours = {0};
    jali_bitmap bitmap = random_bitmap(&random, 100, 60, 60);
    CHECK_OK(jali_shell_create(ctx, &tube, NULL, &shell, NULL));
    CHECK(worst_off_facets(&shell.outer.mesh, 64, 20) < 2e-5);
    CHECK_OK(pierce(&bitmap, 0.5, &opt, 0, &shell, &contours));
    CHECK(shell.outer.mesh.vertex_count > 3000);
    CHECK(worst_off_facets(&shell.outer.mesh, 64, 20) < 2e-5);
    for (int32_t t = 0; t < shell.outer.mesh.triangle_count;
         t++) // still unrolled, to two units: v is the height
        for (int k = 0; k < 3; k++)
            CHECK(fabs(shell.outer.uv[t][k][1] -
                       shell.outer.mesh.vertex[shell.outer.mesh.triangle[t][k]][2]) < 2.0 / 64);
    jali_check_report report = solid_of(&shell);
    CHECK(report.solid);
    int32_t islands = 0; // their contours run counter-clockwise
    for (int32_t c = 0; c < contours.contour_count; c++) islands += signed_area2(&contours, c) > 0;
    CHECK_INT(report.pieces, 1 + islands);
    CHECK_INT(report.genus, 1 + contours.contour_count - islands); // a tube has one hole already
    jali_contours_free(ctx, &contours);
    jali_shell_free(ctx, &shell);
    jali_bitmap_free(ctx, &bitmap);
}

// Random bumps on a sphere or a tube, random pictures, both placements: closed solids without exception.
TEST(random_surfaces_and_pictures_make_solids)
{
    static const char *const shapes[] = {"sphere:r=20", "cylinder:r=20,h=40", "vase:h=60",
                                         "cone:r=25,top=12,h=50"};
    int32_t placed = 0;
    for (uint64_t seed = 1; seed <= 60; seed++) {
        uint64_t random = seed * 7919;
        jali_surface s = surface_of(shapes[seed % 4]);
        double phase = (double)(next_random(&random) >> 40);
        for (int32_t v = 0; v < s.mesh.vertex_count; v++) {
            double *p = s.mesh.vertex[v], bump = 1 + 0.03 * sin(phase + p[0] / 4) * sin(p[2] / 5 + phase / 7);
            p[0] *= bump, p[1] *= bump;
        }
        jali_place_options opt = jali_place_defaults();
        opt.placing = seed % 3 ? JALI_PLACE_WRAP : JALI_PLACE_PROJECT;
        opt.at_given = true;
        opt.at_mm[0] = (double)(next_random(&random) >> 60) - 8;
        opt.at_mm[1] = -20;
        opt.at_mm[2] = 12 + (double)(next_random(&random) >> 60);
        jali_shell_options wall = {.thickness_mm = 0.5 + (double)(seed % 5) / 4, .least_mm = 0.1};
        jali_bitmap bitmap = random_bitmap(&random, 20 + (int32_t)(seed % 30), 24, 30 + (int32_t)(seed % 60));
        double backing = seed % 5 == 0 ? 0.3 : 0;
        jali_contours contours = {0};
        jali_shell shell;
        CHECK_OK(jali_shell_create(ctx, &s, &wall, &shell, NULL));
        jali_status status = pierce(&bitmap, 0.3, &opt, backing, &shell, &contours);
        if (status == JALI_OK) {
            placed++;
            jali_check_report report = solid_of(&shell);
            if (!report.solid) print_error("seed %d: %s\n", (int)seed, shapes[seed % 4]);
            CHECK(report.solid);
        } else {
            CHECK_INT(status, JALI_NO_RESULT);
        }
        jali_contours_free(ctx, &contours);
        jali_shell_free(ctx, &shell);
        jali_bitmap_free(ctx, &bitmap);
    }
    print_message("%d of 60 placed\n", placed);
    CHECK(placed > 40);
}

TEST(a_second_picture_needs_room_of_its_own)
{
    uint64_t random = 3;
    jali_surface s = surface_of("cylinder:r=20,h=40");
    jali_shell shell;
    jali_contours contours = {0};
    jali_place_options opt = jali_place_defaults();
    jali_bitmap bitmap = random_bitmap(&random, 60, 60, 60);
    opt.at_given = true;
    opt.at_mm[1] = -20;
    opt.at_mm[2] = 20;
    CHECK_OK(jali_shell_create(ctx, &s, NULL, &shell, NULL));
    CHECK_OK(pierce(&bitmap, 0.4, &opt, 0, &shell, &contours));
    jali_contours_free(ctx, &contours);
    opt.at_mm[0] = 15, opt.at_mm[1] = -13; // overlaps
    CHECK_STATUS(pierce(&bitmap, 0.4, &opt, 0, &shell, &contours), JALI_NO_RESULT);
    jali_contours_free(ctx, &contours);
    opt.at_mm[1] = 20; // behind, across the seam
    CHECK_OK(pierce(&bitmap, 0.4, &opt, 0, &shell, &contours));
    CHECK(solid_of(&shell).solid);
    jali_contours_free(ctx, &contours);
    jali_shell_free(ctx, &shell);
    jali_bitmap_free(ctx, &bitmap);
}

TEST(a_patch_that_covers_a_place_twice_is_refused)
{
    // Two triangles with a common edge, one folded onto the other on the lattice.
    int32_t point[4][2] = {{0, 0}, {1000, 0}, {500, 800}, {600, 300}}, vertex[4] = {0, 1, 2, 3},
            face[2] = {0, 1};
    int32_t corner[2][3] = {{0, 1, 2}, {0, 1, 3}};
    jali_patch patch = {4, point, vertex, NULL, 2, face, corner};
    double at[4][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.8, 0}, {0.6, 0.3, 1}}, inner[4][3] = {{0}};
    int32_t triangle[2][3] = {{0, 1, 2}, {0, 1, 3}};
    jali_shell shell = {.outer.mesh = {4, 2, at, triangle}, .inner = inner, .unit_mm = 0x1p-20};
    int32_t outline[3][2] = {{450, 200}, {650, 400}, {550, 100}}, first[2] = {0, 3};
    jali_contours contours = {1, 3, first, outline, 0.01};
    CHECK_STATUS(jali_pierce(ctx, &contours, &patch, 0, &shell), JALI_NO_RESULT);
}

static jali_status pierce_some(jali_context *limited, void *data)
{
    jali_status status;
    jali_surface s = {0};
    jali_shell shell = {0};
    jali_mesh mesh = {0};
    jali_chart chart = {0};
    jali_patch patch = {0};
    jali_bitmap drawing = {0};
    jali_contours contours = {0};
    jali_place_options opt = jali_place_defaults();
    opt.width_mm = 10;
    TRY(jali_surface_make(limited, "cylinder:r=10,h=20,facets=16", NULL, &s));
    TRY(jali_shell_create(limited, &s, NULL, &shell, NULL));
    TRY(jali_place_on(limited, data, 128, &opt, &shell.outer, &chart, &patch, &drawing, NULL));
    TRY(jali_trace(limited, &drawing, &chart, NULL, &contours));
    TRY(jali_pierce(limited, &contours, &patch, 0.2, &shell));
    TRY(jali_shell_solid(limited, &shell, &mesh));
done:
    jali_surface_free(limited, &s);
    jali_shell_free(limited, &shell);
    jali_mesh_free(limited, &mesh);
    jali_chart_free(limited, &chart);
    jali_patch_free(limited, &patch);
    jali_bitmap_free(limited, &drawing);
    jali_contours_free(limited, &contours);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_picture picture = {.width_px = 8, .height_px = 8};
    CHECK_OK(ALLOCATE(ctx, picture.grey, 64));
    for (int32_t i = 0; i < 64; i++) picture.grey[i] = (uint8_t)(i % 5 * 60);
    refuse_each_allocation(pierce_some, &picture);
    jali_picture_free(ctx, &picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_plate_of_two_triangles_is_pierced_as_drawn, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(the_outer_skin_stays_where_it_is, open_context, close_context),
        cmocka_unit_test_setup_teardown(random_surfaces_and_pictures_make_solids, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(a_second_picture_needs_room_of_its_own, open_context, close_context),
        cmocka_unit_test_setup_teardown(a_patch_that_covers_a_place_twice_is_refused, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
