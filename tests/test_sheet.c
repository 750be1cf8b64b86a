// sheet: every mesh is checked as 2-manifold with borders; areas, angles and elements across against
// formulas.
#include "testing.h"
#include "judge_sheet.h"

#include <jali/carve.h>
#include <jali/place.h>
#include <jali/sheet.h>
#include <jali/trace.h>

#include <math.h>

// Contours under construction, mm on a grid of 100 x 100 mm with a margin of 10.
enum { UNITS_A_MM = 1024, MOST_POINTS = 4096 };

typedef struct sketch {
    jali_contours contours;
    int32_t first[64], point[MOST_POINTS][2];
} sketch;

static const jali_chart CHART = {.width_px = 1000,
                                 .height_px = 1000,
                                 .margin_px = 100,
                                 .outside_solid = true,
                                 .pixel_units = 102,
                                 .unit_mm = 1.0 / UNITS_A_MM};

static void add_place(sketch *s, double x, double y)
{
    int32_t *at = s->point[s->contours.point_count++];
    at[0] = (int32_t)lround(x * UNITS_A_MM);
    at[1] = (int32_t)lround(y * UNITS_A_MM);
    CHECK(s->contours.point_count < MOST_POINTS);
}

static void end_contour(sketch *s)
{
    s->contours.unit_mm = CHART.unit_mm;
    s->contours.first = s->first;
    s->contours.point = s->point;
    s->first[++s->contours.contour_count] = s->contours.point_count;
}

static void add_box(sketch *s, double x, double y, double w, double h, bool solid)
{
    for (int i = 0; i < 4; i++) {
        int k = solid ? i : 3 - i;
        add_place(s, x + (k == 1 || k == 2 ? w : 0), y + (k >= 2 ? h : 0));
    }
    end_contour(s);
}

static void add_ring(sketch *s, double x, double y, double radius, int points, bool solid)
{
    for (int i = 0; i < points; i++) {
        double angle = (solid ? 2 : -2) * M_PI * i / points;
        add_place(s, x + radius * cos(angle), y + radius * sin(angle));
    }
    end_contour(s);
}

static double contour_area(const jali_contours *c)
{
    int64_t twice = 0;
    for (int32_t i = 0; i < c->contour_count; i++)
        for (int32_t k = c->first[i]; k < c->first[i + 1]; k++) {
            const int32_t *a = c->point[k], *b = c->point[k + 1 < c->first[i + 1] ? k + 1 : c->first[i]];
            twice += (int64_t)a[0] * b[1] - (int64_t)b[0] * a[1];
        }
    return 0.5 * (double)twice * c->unit_mm * c->unit_mm;
}

static jali_sheet meshed(const sketch *s, bool whole, int32_t across)
{
    jali_sheet sheet;
    jali_sheet_options opt = {.phi_s_mm = 0.3, .across = across, .whole = whole};
    CHECK_OK(jali_sheet_plate(ctx, &s->contours, &CHART, 3, &opt, &sheet));
    CHECK(is_manifold(&sheet));
    CHECK(sheet.flat);
    for (int32_t i = 0; i < sheet.node_count; i++)
        CHECK(sheet.node[i][2] == 1.5 && sheet.thickness_mm[i] == 3 &&
              fabs(sheet.node[i][0] - sheet.at[i][0] * CHART.unit_mm) <= CHART.unit_mm);
    return sheet;
}

// How many edges the shortest ways from nodes on one line to another line have: the least and the mean.
static void count_across(const jali_sheet *sheet, double low, double high, int *least, double *mean)
{
    int32_t *hops = malloc((size_t)sheet->node_count * sizeof *hops);
    int32_t reached = 0, sum = 0;
    for (int32_t i = 0; i < sheet->node_count; i++) hops[i] = fabs(sheet->node[i][1] - low) < 1e-3 ? 0 : 1000;
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t t = 0; t < sheet->triangle_count; t++)
            for (int k = 0; k < 9; k++) {
                int32_t *a = &hops[sheet->triangle[t][k / 3]], b = hops[sheet->triangle[t][k % 3]] + 1;
                if (b < *a) *a = b, changed = true;
            }
    }
    *least = 1000;
    for (int32_t i = 0; i < sheet->node_count; i++)
        if (fabs(sheet->node[i][1] - high) < 1e-3) {
            *least = MIN(*least, hops[i]);
            sum += hops[i];
            reached++;
        }
    *mean = (double)sum / reached;
    free(hops);
}

TEST(a_plain_plate_has_few_even_triangles)
{
    sketch s = {0};
    add_box(&s, 5, 5, 90, 90, true);
    jali_sheet whole = meshed(&s, true, 4), clipped = meshed(&s, false, 4);
    double side = 800 * 102 / (double)UNITS_A_MM; // of the window
    CHECK(fabs(area_of(&whole) - 8100) < 1e-6);
    CHECK(fabs(area_of(&clipped) - side * side) < 1e-6);
    CHECK(quality_of(&whole).least_degrees > 25 && quality_of(&clipped).least_degrees > 25);
    CHECK(whole.node_count > 1500 && whole.node_count < 4000);
    for (int32_t i = 0; i < whole.node_count; i++) CHECK((whole.border[i] & ~JALI_BORDER_RIM) == 0);
    for (int32_t i = 0; i < clipped.node_count; i++) CHECK((clipped.border[i] & ~JALI_BORDER_PICTURE) == 0);
    jali_sheet_free(ctx, &whole);
    jali_sheet_free(ctx, &clipped);
}

// What is near in the sheet is near in memory: triangles come by their first nodes, and most of them have all
// their nodes near each other.
TEST(nodes_and_triangles_are_numbered_along_a_curve)
{
    sketch s = {0};
    add_box(&s, 5, 5, 90, 90, true);
    jali_sheet sheet = meshed(&s, true, 4);
    int32_t last = 0, near = 0;
    for (int32_t t = 0; t < sheet.triangle_count; t++) {
        const int32_t *c = sheet.triangle[t];
        int32_t low = MIN(c[0], MIN(c[1], c[2])), high = MAX(c[0], MAX(c[1], c[2]));
        CHECK(low >= last);
        last = low;
        near += high - low < sheet.node_count / 16;
    }
    CHECK(near > sheet.triangle_count / 2);
    jali_sheet_free(ctx, &sheet);
}

TEST(every_strip_has_its_elements_across)
{
    const double widths[] = {0.3, 0.45, 0.6, 1, 2, 5};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++)
        for (int32_t across = 2; across <= 8; across *= 2) {
            double low = lround(20 * UNITS_A_MM) / (double)UNITS_A_MM, mean;
            double high = lround((20 + widths[i]) * UNITS_A_MM) / (double)UNITS_A_MM;
            int least;
            sketch s = {0};
            add_box(&s, 20, 20, 10 * widths[i], widths[i], true);
            jali_sheet sheet = meshed(&s, true, across);
            count_across(&sheet, low, high, &least, &mean);
            CHECK(least >= (across == 8 ? 4 : across - 1) && mean >= 0.98 * across && mean < 1.5 * across);
            CHECK(quality_of(&sheet).least_degrees > 25);
            jali_sheet_free(ctx, &sheet);
        }
}

TEST(borders_say_what_they_are)
{
    sketch s = {0};
    add_box(&s, 5, 5, 90, 90, true);
    add_ring(&s, 50, 50, 8, 60, false);
    add_box(&s, 40, 5.5, 20, 7, false); // across the window's lower side
    jali_sheet whole = meshed(&s, true, 4), clipped = meshed(&s, false, 4);
    double window = 100 * 102 / (double)UNITS_A_MM;
    CHECK(fabs(area_of(&whole) - contour_area(&s.contours)) < 1e-3);
    for (int32_t i = 0; i < clipped.node_count; i++) {
        double x = clipped.node[i][0], y = clipped.node[i][1], ring = hypot(x - 50, y - 50);
        bool on_window = fmin(x, y) < window + 1e-4 || fmax(x, y) > 9 * window - 1e-4;
        bool on_void = ring < 8.001 || (x > 39.999 && x < 60.001 && y < 12.501);
        CHECK(clipped.border[i] == (on_window ? JALI_BORDER_PICTURE : 0) + (on_void ? JALI_BORDER_VOID : 0) ||
              (y < window + 1e-4 && fabs(fabs(x - 50) - 10) < 1e-3));
    }
    jali_sheet_free(ctx, &whole);
    jali_sheet_free(ctx, &clipped);
}

TEST(a_picture_that_ends_in_void_is_its_own_plate)
{
    sketch s = {0};
    jali_chart chart = CHART;
    chart.outside_solid = false;
    add_box(&s, 10, 10, 60, 60, true); // within half a pixel of the window's lower left corner
    add_ring(&s, 40, 40, 10, 40, false);
    jali_sheet sheet;
    CHECK_OK(jali_sheet_plate(ctx, &s.contours, &chart, 3, NULL, &sheet));
    CHECK(is_manifold(&sheet));
    CHECK(fabs(area_of(&sheet) - contour_area(&s.contours)) < 1e-3);
    for (int32_t i = 0; i < sheet.node_count; i++) {
        double x = sheet.node[i][0], y = sheet.node[i][1];
        if (x == 10 || y == 10)
            CHECK_INT(sheet.border[i], JALI_BORDER_PICTURE | JALI_BORDER_RIM | JALI_BORDER_VOID);
        if (x == 70 && y > 10) CHECK_INT(sheet.border[i], JALI_BORDER_RIM | JALI_BORDER_VOID);
    }
    jali_sheet_free(ctx, &sheet);
}

TEST(nasty_shapes_end)
{
    sketch s = {0};
    add_box(&s, 1, 1, 98, 98, true);
    add_place(&s, 30, 30); // a needle of a void, of 2 degrees
    add_place(&s, 50, 30.7);
    add_place(&s, 50, 30);
    end_contour(&s);
    for (int i = 0; i < 144; i++) { // a star of spikes of 5 degrees
        double radius = i % 2 ? 12 : 2, angle = -2 * M_PI * i / 144;
        add_place(&s, 70 + radius * cos(angle), 70 + radius * sin(angle));
    }
    end_contour(&s);
    add_box(&s, 20, 60, 10, 10, false); // voids a unit apart
    add_box(&s, 30 + 1.0 / UNITS_A_MM, 60, 10, 10, false);
    add_box(&s, 20, 70 + 1.0 / UNITS_A_MM, 20, 10, false);
    jali_sheet sheet = meshed(&s, true, 4), clipped = meshed(&s, false, 4);
    CHECK(fabs(area_of(&sheet) - contour_area(&s.contours)) < 1e-2);
    CHECK(sheet.node_count < 200000);
    jali_sheet_free(ctx, &sheet);
    jali_sheet_free(ctx, &clipped);
}

TEST(what_cannot_be_meshed_is_refused)
{
    sketch s = {0};
    jali_sheet sheet;
    jali_sheet_options opt = jali_sheet_defaults();
    add_box(&s, 10, 10, 20, 20, true);
    CHECK_STATUS(jali_sheet_plate(ctx, &s.contours, &CHART, 0, &opt, &sheet), JALI_BAD_VALUE);
    CHECK_STATUS(jali_sheet_plate(ctx, &s.contours, &CHART, NAN, &opt, &sheet), JALI_BAD_VALUE);
    opt.across = 0;
    CHECK_STATUS(jali_sheet_plate(ctx, &s.contours, &CHART, 3, &opt, &sheet), JALI_BAD_VALUE);
    opt = jali_sheet_defaults();
    opt.phi_s_mm = NAN;
    CHECK_STATUS(jali_sheet_plate(ctx, &s.contours, &CHART, 3, &opt, &sheet), JALI_BAD_VALUE);
    sketch empty = {0};
    add_box(&empty, 2, 2, 5, 5, true); // outside the window
    CHECK_STATUS(jali_sheet_plate(ctx, &empty.contours, &CHART, 3, NULL, &sheet), JALI_NO_RESULT);
    CHECK_STATUS(jali_sheet_plate(ctx, &(jali_contours){.unit_mm = 1}, &CHART, 3, NULL, &sheet),
                 JALI_NO_RESULT);
    add_box(&s, 25, 25, 20, 20, true); // crosses the first
    opt = jali_sheet_defaults();
    for (int whole = 0; whole < 2; whole++) {
        opt.whole = whole;
        CHECK_STATUS(jali_sheet_plate(ctx, &s.contours, &CHART, 3, &opt, &sheet), JALI_BAD_INPUT);
        CHECK(sheet.node == NULL && sheet.node_count == 0);
    }
}

static void add_pierced(sketch *s, uint64_t seed)
{
    add_box(s, 5, 5, 90, 90, true);
    for (int i = 0; i < 36; i++) {
        double radius = 2 + 0.01 * (double)(next_random(&seed) % 480);
        add_ring(s, 15 + i % 6 * 14, 15 + i / 6 * 14, radius, 8 + (int)(next_random(&seed) % 40), false);
    }
}

TEST(random_voids_keep_every_promise)
{
    for (uint64_t seed = 1; seed <= 6; seed++) {
        sketch s = {0};
        add_pierced(&s, seed);
        for (int whole = 0; whole < 2; whole++) {
            jali_sheet sheet = meshed(&s, whole, 2);
            if (whole) CHECK(fabs(area_of(&sheet) / contour_area(&s.contours) - 1) < 1e-7);
            // A clipped plate has the sharp corners in which its window cuts the voids.
            CHECK(quality_of(&sheet).share_below_20 < (whole ? 0.0001 : 0.003));
            jali_sheet_free(ctx, &sheet);
        }
    }
}

TEST(the_same_sheet_with_any_number_of_threads)
{
    jali_context *by_threads[3];
    jali_sheet sheet[3];
    sketch s = {0};
    add_pierced(&s, 77);
    open_thread_contexts(by_threads);
    for (int i = 0; i < 3; i++)
        CHECK_OK(jali_sheet_plate(by_threads[i], &s.contours, &CHART, 3, NULL, &sheet[i]));
    for (int i = 1; i < 3; i++) {
        CHECK_INT(sheet[i].node_count, sheet[0].node_count);
        CHECK(memcmp(sheet[i].node, sheet[0].node, (size_t)sheet[0].node_count * sizeof *sheet[0].node) == 0);
        CHECK(memcmp(sheet[i].triangle, sheet[0].triangle,
                     (size_t)sheet[0].triangle_count * sizeof *sheet[0].triangle) == 0);
    }
    for (int i = 0; i < 3; i++) jali_sheet_free(by_threads[i], &sheet[i]);
    close_thread_contexts(by_threads);
}

static jali_status mesh_once(jali_context *limited, void *data)
{
    jali_sheet sheet;
    jali_status status = jali_sheet_plate(limited, &((sketch *)data)->contours, &CHART, 3, NULL, &sheet);
    jali_sheet_free(limited, &sheet);
    jali_sheet_free(limited, &sheet);
    return status;
}

TEST(refused_memory_is_said_and_nothing_leaks)
{
    sketch s = {0};
    add_box(&s, 5, 5, 90, 90, true);
    add_ring(&s, 50, 50, 20, 30, false);
    refuse_each_allocation(mesh_once, &s);
}

// --- Surfaces

typedef struct laid {
    jali_shell shell;
    jali_chart chart;
    jali_patch patch;
    jali_contours contours;
} laid;

static void laid_free(laid *on)
{
    jali_shell_free(ctx, &on->shell);
    jali_chart_free(ctx, &on->chart);
    jali_patch_free(ctx, &on->patch);
    jali_contours_free(ctx, &on->contours);
}

// A picture with three voids, `width_mm` wide, on a surface with a wall of 2 mm.
static laid lay(const char *surface_words, jali_placing placing, double width_mm)
{
    laid on = {0};
    jali_surface surface;
    jali_place_options opt = jali_place_defaults();
    jali_bitmap drawing;
    enum { SIDE = 120 };
    jali_picture picture = {.width_px = SIDE, .height_px = SIDE};
    CHECK_OK(ALLOCATE(ctx, picture.grey, SIDE * SIDE));
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            picture.grey[y * SIDE + x] = hypot(x - 35, y - 40) < 22 || hypot(x - 85, y - 45) < 20 ||
                                                 (y > 75 && y < 100 && x > 20 && x < 95 + y / 10)
                                             ? 0
                                             : 255;
    opt.width_mm = width_mm;
    opt.placing = placing;
    CHECK_OK(jali_surface_make(ctx, surface_words, NULL, &surface));
    CHECK_OK(jali_shell_create(ctx, &surface, NULL, &on.shell, NULL));
    CHECK_OK(jali_place_on(ctx, &picture, 128, &opt, &on.shell.outer, &on.chart, &on.patch, &drawing, NULL));
    CHECK_OK(jali_trace(ctx, &drawing, &on.chart, NULL, &on.contours));
    CHECK_INT(on.contours.contour_count, 3);
    jali_bitmap_free(ctx, &drawing);
    jali_picture_free(ctx, &picture);
    return on;
}

static jali_sheet sheet_on(const laid *on, bool whole, int32_t across)
{
    jali_sheet sheet;
    jali_sheet_options opt = {.phi_s_mm = 0.3, .across = across, .whole = whole};
    CHECK_OK(jali_sheet_shell(ctx, &on->contours, &on->chart, &on->patch, &on->shell, &opt, &sheet));
    CHECK(is_manifold(&sheet));
    CHECK(!sheet.flat);
    return sheet;
}

TEST(a_picture_wrapped_on_a_cylinder_keeps_its_area)
{
    laid on = lay("cylinder:r=20,h=60,tolerance=0.002", JALI_PLACE_WRAP, 30);
    jali_sheet sheet = sheet_on(&on, false, 4);
    // The middle of the wall is 1 mm further in: 19 / 20 of the width.
    double window = pow((on.chart.width_px - 2 * on.chart.margin_px) * jali_chart_pixel_mm(&on.chart), 2);
    double solid = (window + contour_area(&on.contours)) * 19 / 20;
    CHECK(fabs(area_of(&sheet) / solid - 1) < 0.002);
    CHECK(quality_of(&sheet).least_degrees > 24);
    for (int32_t i = 0; i < sheet.node_count; i++) {
        CHECK(fabs(hypot(sheet.node[i][0], sheet.node[i][1]) - 19) < 0.01);
        CHECK(fabs(sheet.thickness_mm[i] - 2) < 0.01);
        CHECK((sheet.border[i] & ~(JALI_BORDER_VOID | JALI_BORDER_PICTURE)) == 0 &&
              sheet.at[i][0] != INT32_MIN);
    }
    jali_sheet_free(ctx, &sheet);
    laid_free(&on);
}

TEST(the_rest_of_a_surface_joins_node_by_node)
{
    laid on = lay("cylinder:r=20,h=60,tolerance=0.05", JALI_PLACE_WRAP, 30);
    jali_sheet sheet = sheet_on(&on, true, 2);
    double facets = 0; // the middle of the wall, from its own facets
    for (int32_t t = 0; t < on.shell.outer.mesh.triangle_count; t++) {
        double corner[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                int32_t v = on.shell.outer.mesh.triangle[t][i];
                corner[i][k] = 0.5 * (on.shell.outer.mesh.vertex[v][k] + on.shell.inner[v][k]);
            }
        jali_sheet one = {.triangle_count = 1, .node = corner, .triangle = (int32_t[1][3]){{0, 1, 2}}};
        facets += area_of(&one);
    }
    CHECK(fabs(area_of(&sheet) / (facets + contour_area(&on.contours) * 19 / 20) - 1) < 0.002);
    int32_t off_chart = 0;
    for (int32_t i = 0; i < sheet.node_count; i++) {
        double z = sheet.node[i][2];
        bool rim = z < 1e-9 || z > 60 - 1e-9;
        CHECK(rim == ((sheet.border[i] & JALI_BORDER_RIM) != 0) && !(sheet.border[i] & JALI_BORDER_PICTURE));
        off_chart += sheet.at[i][0] == INT32_MIN;
    }
    CHECK(off_chart > 100);
    // One piece with two rims and three voids: Euler's characteristic of a tube less three.
    int64_t edges = 0;
    int32_t *beside = edges_beside(&sheet);
    for (int32_t i = 0; i < 3 * sheet.triangle_count; i++) edges += beside[i] < i;
    CHECK_INT(sheet.node_count - edges + sheet.triangle_count, -3);
    free(beside);
    jali_sheet_free(ctx, &sheet);
    laid_free(&on);
}

TEST(a_projection_keeps_its_angles_on_the_surface)
{
    const char *surfaces[] = {"sphere:r=20", "vase:tulip,h=60", "cone:r=20,top=12,h=50"};
    for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++) {
        laid on = lay(surfaces[i], JALI_PLACE_PROJECT, 18);
        for (int whole = 0; whole < 2; whole++) {
            jali_sheet sheet = sheet_on(&on, whole, 4);
            if (!whole) CHECK(quality_of(&sheet).share_below_20 < 0.001);
            jali_sheet_free(ctx, &sheet);
        }
        laid_free(&on);
    }
}

static jali_status mesh_surface_once(jali_context *limited, void *data)
{
    const laid *on = data;
    jali_sheet sheet;
    jali_sheet_options opt = {.phi_s_mm = 9, .across = 1, .whole = true};
    jali_status status =
        jali_sheet_shell(limited, &on->contours, &on->chart, &on->patch, &on->shell, &opt, &sheet);
    jali_sheet_free(limited, &sheet);
    return status;
}

TEST(refused_memory_on_a_surface_is_said_and_nothing_leaks)
{
    laid on = lay("cylinder:r=20,h=30,facets=16,tolerance=5", JALI_PLACE_WRAP, 25);
    refuse_each_allocation(mesh_surface_once, &on);
    laid_free(&on);
}

// What carve makes of contours gives their sheet back: the same area, held at the rim, thickness and all.
TEST(a_plates_mesh_gives_the_sheet_of_its_contours)
{
    sketch s = {0};
    jali_sheet sheet, of_mesh;
    jali_mesh mesh;
    jali_chart chart;
    jali_carve_options carve = jali_carve_defaults();
    jali_sheet_options opt = jali_sheet_defaults();
    double thickness;
    add_ring(&s, 40, 50, 12, 60, false);
    add_box(&s, 60, 30, 10, 40, false);
    carve.frame_mm = 5;
    carve.thickness_mm = 3;
    opt.phi_s_mm = 2;
    opt.whole = true;
    jali_contours plate;
    CHECK_OK(jali_plate(ctx, &s.contours, &CHART, &carve, &plate));
    CHECK_OK(jali_carve(ctx, &s.contours, &CHART, &carve, &mesh));
    CHECK_OK(jali_sheet_plate(ctx, &plate, &CHART, 3, &opt, &sheet));
    CHECK_OK(jali_sheet_plate_model(ctx, &mesh, &opt, &chart, &thickness, &of_mesh));
    double area[2] = {0}, rim[2] = {0};
    const jali_sheet *both[] = {&sheet, &of_mesh};
    for (int k = 0; k < 2; k++) {
        for (int32_t t = 0; t < both[k]->triangle_count; t++) {
            const int32_t *c = both[k]->triangle[t];
            const double(*v)[3] = (const double(*)[3])both[k]->node;
            area[k] += ((v[c[1]][0] - v[c[0]][0]) * (v[c[2]][1] - v[c[0]][1]) -
                        (v[c[1]][1] - v[c[0]][1]) * (v[c[2]][0] - v[c[0]][0])) /
                       2;
        }
        for (int32_t i = 0; i < both[k]->node_count; i++)
            rim[k] += (both[k]->border[i] & JALI_BORDER_RIM) != 0;
    }
    CHECK(fabs(thickness - 3) < 1e-9 && fabs(area[0] / area[1] - 1) < 1e-4);
    CHECK(rim[1] > 0.8 * rim[0] && rim[1] < 1.2 * rim[0]);
    mesh.vertex[0][2] += 1; // a corner between the planes
    jali_sheet_free(ctx, &of_mesh);
    CHECK_STATUS(jali_sheet_plate_model(ctx, &mesh, &opt, &chart, &thickness, &of_mesh), JALI_NO_RESULT);
    CHECK(of_mesh.node == NULL);
    jali_mesh_free(ctx, &mesh);
    jali_contours_free(ctx, &plate);
    jali_sheet_free(ctx, &sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plates_mesh_gives_the_sheet_of_its_contours),
        cmocka_unit_test(a_plain_plate_has_few_even_triangles),
        cmocka_unit_test(nodes_and_triangles_are_numbered_along_a_curve),
        cmocka_unit_test(every_strip_has_its_elements_across),
        cmocka_unit_test(borders_say_what_they_are),
        cmocka_unit_test(a_picture_that_ends_in_void_is_its_own_plate),
        cmocka_unit_test(nasty_shapes_end),
        cmocka_unit_test(what_cannot_be_meshed_is_refused),
        cmocka_unit_test(random_voids_keep_every_promise),
        cmocka_unit_test(the_same_sheet_with_any_number_of_threads),
        cmocka_unit_test(refused_memory_is_said_and_nothing_leaks),
        cmocka_unit_test(a_picture_wrapped_on_a_cylinder_keeps_its_area),
        cmocka_unit_test(the_rest_of_a_surface_joins_node_by_node),
        cmocka_unit_test(a_projection_keeps_its_angles_on_the_surface),
        cmocka_unit_test(refused_memory_on_a_surface_is_said_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
