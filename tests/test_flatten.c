// Flattening: planes, cylinders, cones and caps against formulas; rough surfaces, one-to-one by exact
// orientations and by the solids that come out; refusals.
#include "shapes.h"

#include <jali/check.h>
#include <jali/place.h>
#include <jali/shell.h>
#include <jali/trace.h>
#include "place/disc.h"
#include "place/lay.h"
#include "plane/exact.h"

// A shape without its unrolling.
static jali_surface bare(const char *description)
{
    jali_surface s;
    CHECK_OK(jali_surface_make(ctx, description, NULL, &s));
    release(ctx, s.uv);
    s.uv = NULL;
    s.around_mm = 0;
    return s;
}

// A sheet of n x n squares of 1 mm that faces the front, its middle at the origin: vertices inside are moved
// by up to `rough` to all sides, and the sheet is bent to waves of that many mm.
static jali_surface sheet(int32_t n, double rough, double waves, uint64_t seed)
{
    jali_surface s = {0};
    CHECK_OK(mesh_create(ctx, (n + 1) * (n + 1), 2 * n * n, &s.mesh));
    for (int32_t j = 0; j <= n; j++)
        for (int32_t i = 0; i <= n; i++) {
            double x = i - n / 2.0, z = j - n / 2.0, move[3];
            for (int k = 0; k < 3; k++)
                move[k] = rough * ((double)(next_random(&seed) >> 40) / (1 << 23) - 1);
            double at[3] = {x + move[0], waves * sin(x / 5) * cos(z / 7) + 2 * move[1], z + move[2]};
            for (int k = 0; k < 3; k++) at[k] = rint(at[k] * 65536) / 65536;
            memcpy(s.mesh.vertex[j * (n + 1) + i], at, sizeof at);
        }
    for (int32_t j = 0, t = 0; j < n; j++)
        for (int32_t i = 0; i < n; i++) {
            int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            memcpy(s.mesh.triangle[t++], (int32_t[3]){a, b, c}, sizeof *s.mesh.triangle);
            memcpy(s.mesh.triangle[t++], (int32_t[3]){a, c, d}, sizeof *s.mesh.triangle);
        }
    return s;
}

static flat_window window_at(double x, double y, double z, double width, double height)
{
    return (flat_window){.at_mm = {x, y, z}, .size_mm = {width, height}, .ring_mm = {1, 1}};
}

// Every face that lies in the plane lies there counter-clockwise; their number.
static int32_t check_upright(const laid *l)
{
    int32_t count = 0;
    for (int32_t t = 0; t < l->surface->mesh.triangle_count; t++) {
        int32_t at[3][2];
        if (isnan(l->at[t][0][0])) continue;
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++) at[k][i] = (int32_t)rint(l->at[t][k][i] * 4096);
        CHECK(orientation(at[0], at[1], at[2]) > 0);
        count++;
    }
    return count;
}

TEST(a_plane_stays_as_it_is)
{
    jali_surface s = sheet(30, 0, 0, 1);
    uint64_t seed = 3;
    for (int32_t v = 0; v < s.mesh.vertex_count; v++) // moved within the plane
        for (int k = 0; k < 3; k += 2) s.mesh.vertex[v][k] += (double)(next_random(&seed) >> 56) / 1024;
    flat_window w = window_at(1.5, -4, 2.25, 12, 8);
    laid l;
    CHECK_OK(lay_by_flattening(ctx, &s, &w, &l));
    CHECK(check_upright(&l) > 2 * 14 * 10);
    for (int32_t t = 0; t < s.mesh.triangle_count; t++)
        for (int k = 0; k < 3 && !isnan(l.at[t][0][0]); k++) {
            const double *p = s.mesh.vertex[s.mesh.triangle[t][k]];
            CHECK(fabs(l.at[t][k][0] - (p[0] - 1.5)) < 1e-6 && fabs(l.at[t][k][1] - (p[2] - 2.25)) < 1e-6);
        }
    laid_free(ctx, &l);
    jali_surface_free(ctx, &s);
}

// What comes unrolled by a formula comes unrolled without it, to the same lengths, upright.
TEST(developable_surfaces_keep_their_lengths)
{
    static const char *const shapes[] = {"cylinder:r=30,h=70", "cone:r=40,top=20,h=70",
                                         "cylinder:r=10,h=60,facets=12"};
    for (int i = 0; i < 3; i++) {
        jali_surface known, s = bare(shapes[i]);
        CHECK_OK(jali_surface_make(ctx, shapes[i], NULL, &known));
        flat_window w = window_at(0, -40, 35, 30, 30);
        laid l;
        CHECK_OK(lay_by_flattening(ctx, &s, &w, &l));
        CHECK(check_upright(&l) > 0);
        double origin[2] = {0};
        bool first = true;
        for (int32_t t = 0; t < s.mesh.triangle_count; t++) {
            if (isnan(l.at[t][0][0])) continue;
            for (int k = 0; k < 3; k++) {
                double off[2] = {l.at[t][k][0] - known.uv[t][k][0], l.at[t][k][1] - known.uv[t][k][1]};
                if (first) memcpy(origin, off, sizeof off);
                first = false;
                // Facets are chords of what the formula measures: 0.02 mm of sagitta; 12 of them, 1.2 %.
                double most = i == 2 ? 0.6 : 0.02;
                CHECK(fabs(off[0] - origin[0]) < most && fabs(off[1] - origin[1]) < most);
            }
            double g[3];
            CHECK(face_metric(&l, t, g));
            CHECK(fabs(g[0] - 1) < 1e-3 && fabs(g[1]) < 1e-3 && fabs(g[2] - 1) < 1e-3);
        }
        laid_free(ctx, &l);
        jali_surface_free(ctx, &s);
        jali_surface_free(ctx, &known);
    }
}

static double ratio_on_cap(double half_mm, jali_placed *placed)
{
    jali_surface s = bare("sphere:r=30,tolerance=0.005");
    jali_picture picture = {.width_px = 8, .height_px = 8};
    jali_place_options opt = jali_place_defaults();
    jali_chart chart;
    jali_patch patch;
    jali_bitmap drawing;
    CHECK_OK(ALLOCATE_CLEARED(ctx, picture.grey, 64));
    opt.width_mm = 2 * half_mm;
    opt.placing = JALI_PLACE_WRAP;
    opt.at_given = true;
    opt.at_mm[1] = -40; // from the middle 2 to the front, 1 up
    opt.at_mm[2] = 50;
    CHECK_OK(jali_place_on(ctx, &picture, 128, &opt, &s, &chart, &patch, &drawing, placed));
    jali_chart_free(ctx, &chart);
    jali_patch_free(ctx, &patch);
    jali_bitmap_free(ctx, &drawing);
    jali_picture_free(ctx, &picture);
    jali_surface_free(ctx, &s);
    return placed->stretch[1] / placed->stretch[0];
}

// No map of a cap of radius a (an angle) has a ratio of stretches below a / sin a (J. Milnor, A Problem in
// Cartography, 1969): that of the circle inside the window bounds it from below, and the one around it should
// not be missed by much.
TEST(caps_are_stretched_no_more_than_they_must)
{
    static const double half_mm[] = {5, 10, 15, 20};
    for (int i = 0; i < 4; i++) {
        jali_placed placed;
        double ratio = ratio_on_cap(half_mm[i], &placed), in = half_mm[i] / 30, around = in * sqrt(2);
        CHECK(ratio > 1 + 0.9 * (in / sin(in) - 1));
        CHECK(ratio < 1.005 + 1.5 * (around / sin(around) - 1));
        CHECK(placed.stretch[0] < 1 && placed.stretch[1] > 1);
        double away = hypot(hypot(placed.centre_mm[0], placed.centre_mm[1]), placed.centre_mm[2] - 30);
        CHECK(fabs(away - 30) < 0.01 && fabs(placed.centre_mm[0]) < 0.01);
        CHECK(fabs(placed.centre_mm[1] + 60 / sqrt(5)) < 0.3);
    }
}

// A layout folded beyond repair begins again from the circle, and comes to the same end.
TEST(a_guess_that_folds_does_no_harm)
{
    jali_surface s = sheet(20, 0.2, 1.5, 5);
    sides linked;
    disc d[2];
    disc_seed seed = {.at = {0, 0, 0}, .right = {1, 0, 0}, .normal = {0, -1, 0}};
    double half[2] = {8, 8}, apart = 0;
    bool folded;
    arena_mark mark = arena_here(ctx);
    seed.face = 2 * (10 * 20 + 10);
    memcpy(seed.at, s.mesh.vertex[s.mesh.triangle[seed.face][0]], sizeof seed.at);
    CHECK_OK(sides_create(ctx, s.mesh.vertex_count, s.mesh.triangle_count,
                          (const int32_t(*)[3])s.mesh.triangle, &linked));
    for (int i = 0; i < 2; i++) {
        CHECK_OK(grow_disc(ctx, &s.mesh, &linked, &seed, half, &d[i]));
        CHECK(d[i].vertex_count - (3 * d[i].face_count - d[i].vertex_count) < d[i].face_count);
        uint64_t random = 8;
        for (int32_t v = 0; v < d[i].vertex_count && i == 1; v++)
            for (int k = 0; k < 2; k++) d[i].at[v][k] = (double)(next_random(&random) >> 58);
        CHECK_OK(flatten_disc(ctx, &d[i], &folded));
        CHECK(!folded);
    }
    CHECK_INT(d[0].vertex_count, d[1].vertex_count);
    for (int32_t v = 1; v < d[0].vertex_count; v++) {
        double length[2];
        for (int i = 0; i < 2; i++)
            length[i] = hypot(d[i].at[v][0] - d[i].at[0][0], d[i].at[v][1] - d[i].at[0][1]);
        apart = MAX(apart, fabs(length[0] - length[1]));
    }
    CHECK(apart < 0.02);
    sides_free(ctx, &linked);
    arena_rewind(ctx, mark);
    jali_surface_free(ctx, &s);
}

static jali_picture spots(uint64_t seed)
{
    jali_picture picture = {.width_px = 64, .height_px = 48};
    CHECK_OK(ALLOCATE(ctx, picture.grey, 64 * 48));
    for (int32_t y = 0; y < 48; y++)
        for (int32_t x = 0; x < 64; x++)
            picture.grey[y * 64 + x] = x % 8 > 1 && y % 8 > 1 && (x / 8 * 7 + y / 8 * 3 + seed) % 4 ? 255 : 0;
    return picture;
}

static jali_status place_spots(jali_context *in, const jali_surface *s, double width, const double at[3],
                               jali_chart *chart, jali_patch *patch, jali_bitmap *drawing,
                               jali_placed *placed, uint64_t seed)
{
    jali_picture picture = spots(seed);
    jali_place_options opt = jali_place_defaults();
    opt.width_mm = width;
    opt.placing = JALI_PLACE_WRAP;
    opt.at_given = at != NULL;
    if (at) memcpy(opt.at_mm, at, sizeof opt.at_mm);
    jali_status status = jali_place_on(in, &picture, 128, &opt, s, chart, patch, drawing, placed);
    jali_picture_free(ctx, &picture);
    return status;
}

// Rough sheets, by seeds: what is pierced through them is a solid.
TEST(rough_surfaces_are_pierced_one_to_one)
{
    for (uint64_t seed = 1; seed <= 12; seed++) {
        jali_surface s = sheet(40, 0.05 * (double)(seed % 6), 0.25 * (double)seed, seed);
        jali_shell shell;
        jali_shell_options wall = jali_shell_defaults();
        jali_chart chart = {0};
        jali_patch patch = {0};
        jali_bitmap drawing = {0};
        jali_contours contours = {0};
        jali_mesh mesh = {0};
        jali_check_report report;
        double at[3] = {2, 0, -1};
        flat_window w = window_at(2, 0, -1, 22, 18);
        laid l;
        CHECK_OK(lay_by_flattening(ctx, &s, &w, &l));
        CHECK(check_upright(&l) > 20 * 16);
        laid_free(ctx, &l);
        wall.thickness_mm = 0.5;
        wall.least_mm = 0.02;
        CHECK_OK(jali_shell_create(ctx, &s, &wall, &shell, NULL));
        CHECK_OK(place_spots(ctx, &shell.outer, 22, at, &chart, &patch, &drawing, NULL, seed));
        CHECK_OK(jali_trace(ctx, &drawing, &chart, NULL, &contours));
        CHECK(contours.contour_count > 20);
        CHECK_OK(jali_pierce(ctx, &contours, &patch, 0, &shell));
        CHECK_OK(jali_shell_solid(ctx, &shell, &mesh));
        CHECK_OK(jali_check(ctx, &mesh, NULL, &report));
        CHECK(report.solid);
        jali_mesh_free(ctx, &mesh);
        jali_contours_free(ctx, &contours);
        jali_bitmap_free(ctx, &drawing);
        jali_patch_free(ctx, &patch);
        jali_chart_free(ctx, &chart);
        jali_shell_free(ctx, &shell);
        jali_surface_free(ctx, &s);
    }
}

// A refusal says what would fit, and that does.
static void check_offer(const jali_surface *s, double width, const double at[3], const char *words)
{
    jali_chart chart = {0};
    jali_patch patch = {0};
    jali_bitmap drawing = {0};
    jali_placed placed;
    CHECK_STATUS(place_spots(ctx, s, width, at, &chart, &patch, &drawing, &placed, 1), JALI_NO_RESULT);
    const char *said = jali_message(ctx), *offer = strstr(said, "a width of ");
    if (!strstr(said, words) || !offer) print_error("%s\n", said);
    CHECK(strstr(said, words) != NULL && offer != NULL);
    double fits = atof(offer + strlen("a width of "));
    CHECK(fits > 3 && fits < width);
    CHECK_OK(place_spots(ctx, s, fits, at, &chart, &patch, &drawing, &placed, 1));
    jali_chart_free(ctx, &chart);
    jali_patch_free(ctx, &patch);
    jali_bitmap_free(ctx, &drawing);
}

TEST(what_has_no_room_is_refused_with_what_has)
{
    jali_surface s = bare("sphere:r=20");
    check_offer(&s, 95, (double[3]){0, -20, 20}, "laid flat, the surface is stretched");
    jali_surface_free(ctx, &s);

    s = sheet(30, 0.1, 1, 4);
    check_offer(&s, 24, (double[3]){8, 0, 3}, "laid flat, the surface ends within");
    jali_surface_free(ctx, &s);

    s = (jali_surface){.mesh = torus(60, 30)}; // radii 3 and 1: around the tube there is no disc
    for (int32_t v = 0; v < s.mesh.vertex_count; v++)
        for (int k = 0; k < 3; k++) s.mesh.vertex[v][k] *= 10;
    check_offer(&s, 110, (double[3]){0, -50, 0}, "laid flat");
    jali_surface_free(ctx, &s);
}

// A texture of other scale, and mirrored: the picture keeps its size in mm at its centre. Cut in the middle,
// it has room on one side alone, and the message says that the surface itself has more.
TEST(a_texture_is_brought_to_scale)
{
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        jali_surface s = sheet(30, 0, 0, 1);
        jali_chart chart = {0};
        jali_patch patch = {0};
        jali_bitmap drawing = {0};
        jali_placed placed;
        CHECK_OK(ALLOCATE(ctx, s.uv, s.mesh.triangle_count));
        s.textured = true;
        for (int32_t t = 0; t < s.mesh.triangle_count; t++)
            for (int k = 0; k < 3; k++) {
                const double *p = s.mesh.vertex[s.mesh.triangle[t][k]];
                bool right = s.mesh.vertex[s.mesh.triangle[t][0]][0] >= 5;
                s.uv[t][k][0] = (mirrored ? -3 : 3) * p[0] + (right ? 500 : 0);
                s.uv[t][k][1] = 3 * p[2];
            }
        CHECK_OK(place_spots(ctx, &s, 12, (double[3]){-3, 0, 1}, &chart, &patch, &drawing, &placed, 1));
        CHECK(fabs(placed.stretch[0] - 1) < 1e-5 && fabs(placed.stretch[1] - 1) < 1e-5);
        jali_chart_free(ctx, &chart);
        jali_patch_free(ctx, &patch);
        jali_bitmap_free(ctx, &drawing);
        CHECK_STATUS(place_spots(ctx, &s, 20, (double[3]){0, 0, 1}, &chart, &patch, &drawing, &placed, 1),
                     JALI_NO_RESULT);
        CHECK(strstr(jali_message(ctx), "texture=no") != NULL);
        jali_surface_free(ctx, &s);
    }
}

static jali_status flatten_some(jali_context *limited, void *data)
{
    flat_window w = window_at(0, 0, 0, 5, 4);
    laid l = {0};
    jali_status status = lay_by_flattening(limited, data, &w, &l);
    laid_free(limited, &l);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_surface s = sheet(12, 0.3, 1, 2);
    refuse_each_allocation(flatten_some, &s);
    jali_surface_free(ctx, &s);
}

TEST(threads_do_not_change_a_byte)
{
    jali_context *by_threads[3];
    jali_surface s = sheet(40, 0.2, 3, 9);
    jali_patch patch[3];
    open_thread_contexts(by_threads);
    for (int i = 0; i < 3; i++) {
        jali_chart chart;
        jali_bitmap drawing;
        CHECK_OK(place_spots(by_threads[i], &s, 20, NULL, &chart, &patch[i], &drawing, NULL, 1));
        jali_chart_free(by_threads[i], &chart);
        jali_bitmap_free(by_threads[i], &drawing);
        CHECK_INT(patch[i].point_count, patch[0].point_count);
        CHECK(memcmp(patch[i].point, patch[0].point, (size_t)patch[0].point_count * sizeof *patch->point) ==
              0);
    }
    for (int i = 0; i < 3; i++) jali_patch_free(by_threads[i], &patch[i]);
    close_thread_contexts(by_threads);
    jali_surface_free(ctx, &s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_plane_stays_as_it_is, open_context, close_context),
        cmocka_unit_test_setup_teardown(developable_surfaces_keep_their_lengths, open_context, close_context),
        cmocka_unit_test_setup_teardown(caps_are_stretched_no_more_than_they_must, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(a_guess_that_folds_does_no_harm, open_context, close_context),
        cmocka_unit_test_setup_teardown(rough_surfaces_are_pierced_one_to_one, open_context, close_context),
        cmocka_unit_test_setup_teardown(what_has_no_room_is_refused_with_what_has, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(a_texture_is_brought_to_scale, open_context, close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
        cmocka_unit_test_setup_teardown(threads_do_not_change_a_byte, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
