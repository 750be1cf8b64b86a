// carve: every mesh is checked as a closed, oriented 2-manifold; volumes and areas against formulas.
#include "testing.h"

#include <jali/carve.h>
#include <jali/trace.h>
#include "carve/prisms.h"
#include "plane/exact.h"

#include <math.h>

typedef struct half {
    int32_t from, to, triangle;
} half;

static int by_ends(const void *a, const void *b)
{
    const half *p = a, *q = b;
    if (p->from != q->from) return p->from < q->from ? -1 : 1;
    return (p->to > q->to) - (p->to < q->to);
}

static int32_t find_half(const half *list, int32_t count, int32_t from, int32_t to)
{
    half key = {from, to, 0}, *found = bsearch(&key, list, (size_t)count, sizeof key, by_ends);
    return found ? found->triangle : -1;
}

// Every edge has one triangle each way, every vertex one fan. Returns the Euler characteristic.
static int64_t check_closed(const jali_mesh *mesh)
{
    int32_t halves = 3 * mesh->triangle_count;
    half *list = malloc((size_t)halves * sizeof *list);
    int32_t *degree = calloc((size_t)mesh->vertex_count, sizeof *degree),
            *any = malloc((size_t)mesh->vertex_count * 4);
    for (int32_t h = 0; h < halves; h++) {
        const int32_t *t = mesh->triangle[h / 3];
        list[h] = (half){t[h % 3], t[(h + 1) % 3], h / 3};
        CHECK(list[h].from != list[h].to);
        degree[list[h].from]++;
        any[list[h].from] = list[h].to;
    }
    qsort(list, (size_t)halves, sizeof *list, by_ends);
    for (int32_t h = 0; h < halves; h++) {
        if (h > 0) CHECK(by_ends(&list[h - 1], &list[h]) != 0);
        CHECK(find_half(list, halves, list[h].to, list[h].from) >= 0);
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) { // turn around v until back
        CHECK(degree[v] >= 3);
        int32_t to = any[v], turned = 0;
        do {
            const int32_t *t = mesh->triangle[find_half(list, halves, v, to)];
            to = t[0] == v ? t[2] : t[1] == v ? t[0] : t[1];
            turned++;
        } while (to != any[v]);
        CHECK_INT(turned, degree[v]);
    }
    free(list);
    free(degree);
    free(any);
    return (int64_t)mesh->vertex_count - halves / 2 + mesh->triangle_count;
}

// Six times the volume, exact in lattice units.
static double volume6(const jali_mesh *mesh, double unit_mm)
{
    __int128 sum = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        int64_t p[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) p[i][k] = (int64_t)(mesh->vertex[mesh->triangle[t][i]][k] / unit_mm);
        for (int k = 0; k < 3; k++)
            sum += (__int128)p[0][k] *
                   (p[1][(k + 1) % 3] * p[2][(k + 2) % 3] - p[1][(k + 2) % 3] * p[2][(k + 1) % 3]);
    }
    return (double)sum;
}

static double area2(const jali_contours *c)
{
    int64_t sum = 0;
    for (int32_t k = 0; k < c->contour_count; k++)
        for (int32_t i = c->first[k], end = c->first[k + 1], p = end - 1; i < end; p = i++)
            sum += (int64_t)c->point[p][0] * c->point[i][1] - (int64_t)c->point[p][1] * c->point[i][0];
    return (double)sum;
}

static jali_chart chart_of(const jali_bitmap *bitmap, bool outside_solid)
{
    return (jali_chart){.width_px = bitmap->width_px,
                        .height_px = bitmap->height_px,
                        .outside_solid = outside_solid,
                        .pixel_units = 64,
                        .unit_mm = 1.0 / 256};
}

static void carve(const jali_bitmap *bitmap, const jali_chart *chart, const jali_carve_options *opt)
{
    jali_contours contours, plate;
    jali_mesh mesh;
    CHECK_OK(jali_trace(ctx, bitmap, chart, NULL, &contours));
    CHECK_OK(jali_plate(ctx, &contours, chart, opt, &plate));
    CHECK_OK(jali_carve(ctx, &contours, chart, opt, &mesh));
    int64_t euler = check_closed(&mesh), pieces_less_holes = 0;
    for (int32_t c = 0; c < plate.contour_count; c++) {
        jali_contours one = {1, 0, (int32_t[]){plate.first[c], plate.first[c + 1]}, plate.point,
                             plate.unit_mm};
        pieces_less_holes += area2(&one) > 0 ? 1 : -1;
    }
    CHECK_INT(euler, 2 * pieces_less_holes);
    CHECK_INT(mesh.vertex_count, 2 * plate.point_count);
    CHECK(volume6(&mesh, chart->unit_mm) == 3 * area2(&plate) * lround(opt->thickness_mm / chart->unit_mm));
    jali_mesh_free(ctx, &mesh);
    jali_contours_free(ctx, &plate);
    jali_contours_free(ctx, &contours);
}

TEST(random_plates_are_closed)
{
    uint64_t seed = 5;
    for (int32_t percent = 10; percent < 100; percent += 20) {
        jali_bitmap bitmap = random_bitmap(&seed, 70, 50, percent);
        jali_carve_options opt = jali_carve_defaults();
        jali_chart open = chart_of(&bitmap, false), framed = chart_of(&bitmap, true);
        carve(&bitmap, &open, &opt);
        opt.frame_mm = 3;
        opt.corner_radius_mm = 2;
        opt.thickness_mm = 1.5;
        carve(&bitmap, &framed, &opt);
        opt.hole_diameter_mm = 1.5;
        opt.hole_web_mm = 0.5;
        carve(&bitmap, &framed, &opt);
        opt.hole_diameter_mm = 3; // an ear
        carve(&bitmap, &framed, &opt);
        jali_bitmap_free(ctx, &bitmap);
    }
}

TEST(the_hole_keeps_its_web)
{
    jali_bitmap bitmap;
    CHECK_OK(jali_bitmap_create(ctx, 200, 100, &bitmap)); // 50 x 25 mm, all void
    jali_chart chart = chart_of(&bitmap, true);
    for (double frame = 0.5; frame < 12; frame += 0.5) {
        jali_carve_options opt = jali_carve_defaults();
        opt.frame_mm = frame;
        opt.hole_diameter_mm = 4;
        jali_contours contours, plate;
        CHECK_OK(jali_trace(ctx, &bitmap, &chart, NULL, &contours));
        CHECK_OK(jali_plate(ctx, &contours, &chart, &opt, &plate));
        CHECK_INT(plate.contour_count, 3);
        double least = INFINITY;
        for (int32_t i = plate.first[1]; i < plate.first[2]; i++) // to every edge of the other two
            for (int32_t c = 0; c < 3; c += 2)
                for (int32_t j = plate.first[c], end = plate.first[c + 1], before = end - 1; j < end;
                     before = j++) {
                    const int32_t *a = plate.point[before], *b = plate.point[j], *p = plate.point[i];
                    double dx = b[0] - a[0], dy = b[1] - a[1];
                    double along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy);
                    along = fmin(fmax(along, 0), 1);
                    least = fmin(least, hypot(a[0] + along * dx - p[0], a[1] + along * dy - p[1]));
                }
        CHECK(least * chart.unit_mm > opt.hole_web_mm - 0.02);
        carve(&bitmap, &chart, &opt);
        jali_contours_free(ctx, &plate);
        jali_contours_free(ctx, &contours);
    }
    jali_bitmap_free(ctx, &bitmap);
}

TEST(bad_input_is_a_sentence)
{
    jali_bitmap bitmap;
    CHECK_OK(jali_bitmap_create(ctx, 40, 40, &bitmap)); // 10 mm, void
    jali_chart chart = chart_of(&bitmap, true), open = chart_of(&bitmap, false);
    jali_contours void_border, none;
    jali_mesh mesh;
    CHECK_OK(jali_trace(ctx, &bitmap, &chart, NULL, &void_border));
    CHECK_OK(jali_trace(ctx, &bitmap, &open, NULL, &none));
    jali_carve_options opt = jali_carve_defaults();
    CHECK_STATUS(jali_carve(ctx, &none, &open, &opt, &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "nothing solid") != NULL);
    CHECK_STATUS(jali_carve(ctx, &void_border, &chart, &opt, &mesh),
                 JALI_BAD_INPUT); // void along the whole edge
    CHECK(strstr(jali_message(ctx), "touch or cross") != NULL && mesh.vertex == NULL);
    opt.frame_mm = 1;
    opt.hole_diameter_mm = 8;
    CHECK_STATUS(jali_carve(ctx, &void_border, &chart, &opt, &mesh), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "smaller hole") != NULL);
    opt.hole_diameter_mm = 0;
    opt.corner_radius_mm = 5.9; // cuts into the void's corners
    CHECK_STATUS(jali_carve(ctx, &void_border, &chart, &opt, &mesh), JALI_BAD_INPUT);
    opt.corner_radius_mm = 7;
    CHECK_STATUS(jali_carve(ctx, &void_border, &chart, &opt, &mesh), JALI_BAD_VALUE);
    opt.corner_radius_mm = 0;
    opt.thickness_mm = NAN;
    CHECK_STATUS(jali_carve(ctx, &void_border, &chart, &opt, &mesh), JALI_BAD_VALUE);
    opt = jali_carve_defaults();
    opt.frame_mm = 1;
    CHECK_STATUS(jali_carve(ctx, &none, &open, &opt, &mesh), JALI_BAD_VALUE);
    for (int32_t i = 0; i < void_border.point_count / 2; i++) { // turn the void around
        int32_t other = void_border.point_count - 1 - i, kept[2];
        memcpy(kept, void_border.point[i], sizeof kept);
        memcpy(void_border.point[i], void_border.point[other], sizeof kept);
        memcpy(void_border.point[other], kept, sizeof kept);
    }
    CHECK_STATUS(jali_carve(ctx, &void_border, &chart, &opt, &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "wrong side") != NULL);
    jali_contours_free(ctx, &void_border);
    jali_contours_free(ctx, &none);
    jali_bitmap_free(ctx, &bitmap);
}

// Random points, random intervals in regions cut by random lines: every mesh that is not refused is closed,
// and its volume is the sum over the cells.
static int check_cells(uint64_t seed, int32_t points, int32_t kinds, bool anchored)
{
    int32_t point[60][2];
    triangulation plane = {0};
    for (int32_t i = 0; i < points; i++)
        for (int k = 0; k < 2; k++) point[i][k] = (int32_t)(next_random(&seed) >> 52);
    CHECK_OK(insert_points(ctx, &plane, point, points));
    interval *solid;
    CHECK_OK(ALLOCATE_CLEARED(ctx, solid, plane.triangle_count));
    double wanted = 0;
    int32_t split = (int32_t)(next_random(&seed) >> 52);
    for (int32_t t = 0; t < plane.triangle_count; t++) {
        if (is_ghost(&plane, t)) continue;
        const int32_t *a = plane.point[plane.corner[4 * t]], *b = plane.point[plane.corner[4 * t + 1]];
        const int32_t *c = plane.point[plane.corner[4 * t + 2]];
        int32_t pick =
            anchored ? (a[0] + b[0] + c[0]) / 3 > split : (int32_t)(next_random(&seed) >> 40) % kinds;
        solid[t].bottom = anchored || pick % 2 == 0 ? 0 : 3;
        solid[t].top = anchored ? (pick ? 10 : 4) : (int32_t[]){10, 10, 4, 7, 0}[pick % 5];
        if (solid[t].top > solid[t].bottom)
            wanted += 3.0 * (solid[t].top - solid[t].bottom) * (double)orientation(a, b, c);
    }
    jali_mesh mesh;
    jali_status status = build_plate(ctx, &plane, solid, 1, &mesh);
    if (status == JALI_OK) {
        check_closed(&mesh);
        CHECK(volume6(&mesh, 1) == wanted);
        jali_mesh_free(ctx, &mesh);
    } else {
        CHECK_INT(status, JALI_BAD_INPUT);
        CHECK(strstr(jali_message(ctx), "no more than an edge") != NULL);
    }
    release(ctx, solid);
    triangulation_free(ctx, &plane);
    return status == JALI_OK;
}

TEST(cells_with_partial_heights_are_closed)
{
    int built = 0, stepped = 0;
    for (uint64_t seed = 1; seed <= 300; seed++) {
        stepped += check_cells(seed, 60, 2, true);
        built += check_cells(seed * 77, 4 + (int32_t)(seed % 12), 2 + (int32_t)(seed % 4), false);
    }
    print_message("%d random cells and %d steps of 300 built\n", built, stepped);
    CHECK(built > 50 && built < 280 && stepped > 50);
}

// A strip of squares with given intervals, drawn by hand.
static jali_status strip(const interval *height, int32_t count, jali_mesh *mesh)
{
    int32_t point[20][2], n = 0;
    for (int32_t i = 0; i <= count; i++)
        for (int32_t y = 0; y < 2; y++, n++) point[n][0] = 10 * i, point[n][1] = 10 * y;
    triangulation plane = {0};
    interval *solid;
    CHECK_OK(insert_points(ctx, &plane, point, n));
    CHECK_OK(ALLOCATE_CLEARED(ctx, solid, plane.triangle_count));
    for (int32_t t = 0; t < plane.triangle_count; t++) {
        if (is_ghost(&plane, t)) continue;
        int32_t x = 0;
        for (int k = 0; k < 3; k++) x += plane.point[plane.corner[4 * t + k]][0];
        solid[t] = height[x / 30];
    }
    jali_status status = build_plate(ctx, &plane, solid, 1, mesh);
    release(ctx, solid);
    triangulation_free(ctx, &plane);
    return status;
}

TEST(a_low_bridge_between_two_pillars)
{
    jali_mesh mesh;
    CHECK_OK(strip((interval[]){{0, 10}, {0, 4}, {0, 10}}, 3, &mesh));
    CHECK_INT(check_closed(&mesh), 2);
    CHECK(volume6(&mesh, 1) == 6.0 * 100 * 24);
    jali_mesh_free(ctx, &mesh);
    CHECK_OK(
        strip((interval[]){{0, 10}, {4, 6}, {0, 10}, {5, 7}, {0, 10}}, 5, &mesh)); // bars between pillars
    CHECK_INT(check_closed(&mesh), 2);
    jali_mesh_free(ctx, &mesh);
    CHECK_OK(strip((interval[]){{0, 10}, {0, 0}, {3, 8}}, 3, &mesh)); // two pieces
    CHECK_INT(check_closed(&mesh), 4);
    jali_mesh_free(ctx, &mesh);
    CHECK_STATUS(strip((interval[]){{0, 4}, {4, 10}}, 2, &mesh), JALI_BAD_INPUT); // only an edge in common
}

static jali_status carve_some(jali_context *limited, void *data)
{
    jali_status status;
    jali_bitmap *bitmap = data;
    jali_chart chart = chart_of(bitmap, true);
    jali_contours contours = {0};
    jali_mesh mesh = {0};
    jali_carve_options opt = jali_carve_defaults();
    opt.frame_mm = 2;
    opt.hole_diameter_mm = 1;
    opt.hole_web_mm = 0.5;
    TRY(jali_trace(limited, bitmap, &chart, NULL, &contours));
    TRY(jali_carve(limited, &contours, &chart, &opt, &mesh));
done:
    jali_contours_free(limited, &contours);
    jali_mesh_free(limited, &mesh);
    return status;
}

TEST(every_allocation_refused_once)
{
    uint64_t seed = 9;
    jali_bitmap bitmap = random_bitmap(&seed, 30, 30, 60);
    refuse_each_allocation(carve_some, &bitmap);
    jali_bitmap_free(ctx, &bitmap);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_low_bridge_between_two_pillars, open_context, close_context),
        cmocka_unit_test_setup_teardown(cells_with_partial_heights_are_closed, open_context, close_context),
        cmocka_unit_test_setup_teardown(random_plates_are_closed, open_context, close_context),
        cmocka_unit_test_setup_teardown(the_hole_keeps_its_web, open_context, close_context),
        cmocka_unit_test_setup_teardown(bad_input_is_a_sentence, open_context, close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
