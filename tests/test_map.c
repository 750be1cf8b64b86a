// map: colours, the picture's size and tones, and files that are read back.
#include "testing.h"
#include "sheets.h"

#include <jali/check.h>
#include <jali/map.h>
#include <jali/model.h>
#include <jali/read.h>

static const jali_chart CHART = {
    .width_px = 220, .height_px = 220, .margin_px = 10, .pixel_units = 10, .unit_mm = 0.01};

// A pierced plate whose nodes lie on the chart, pressed.
static void make(jali_sheet *sheet, jali_analysis *a)
{
    pierced_options o = {.cells = 40, .holes = 5, .size_mm = 20, .thickness_mm = 0.4, .hole_mm = 0.8};
    jali_analyse_options opt = jali_analyse_defaults();
    CHECK_OK(pierced_sheet(ctx, &o, sheet));
    CHECK_OK(ALLOCATE(ctx, sheet->at, sheet->node_count));
    for (int32_t i = 0; i < sheet->node_count; i++)
        for (int k = 0; k < 2; k++) sheet->at[i][k] = (int32_t)lround((1 + sheet->node[i][k]) * 100);
    opt.support = JALI_SUPPORT_RIM;
    opt.load.force_n = 1;
    CHECK_OK(jali_analyse(ctx, sheet, &opt, a));
}

static double brightness(double value, double limit, double top)
{
    uint8_t rgb[3];
    jali_map_colour(value, limit, top, rgb);
    return 0.3 * rgb[0] + 0.6 * rgb[1] + 0.1 * rgb[2];
}

TEST(light_grows_with_the_value_up_to_the_limit_and_falls_beyond)
{
    for (int i = 0; i < 100; i++) CHECK(brightness(i, 100, 300) < brightness(i + 1, 100, 300));
    for (int i = 101; i < 300; i++) CHECK(brightness(i, 100, 300) >= brightness(i + 1, 100, 300));
    uint8_t rgb[3];
    jali_map_colour(150, 100, 300, rgb);
    CHECK(rgb[0] > 200 && rgb[2] < 60); // orange to red
    jali_map_colour(0, 0, 0, rgb);      // nothing moves: no division by it
    CHECK_INT(rgb[0], 68);
}

TEST(the_map_shows_solid_where_it_is_and_paper_in_holes)
{
    jali_sheet sheet;
    jali_analysis a;
    jali_bytes png = {0};
    jali_picture picture;
    jali_map_options opt = jali_map_defaults();
    make(&sheet, &a);
    opt.longer_px = 400;
    CHECK_OK(jali_map_png(ctx, &sheet, &a, &CHART, &opt, &png));
    CHECK_OK(jali_read_bytes(ctx, png.data, png.size, "map.png", NULL, &picture));
    CHECK_INT(picture.height_px, 400);
    CHECK(picture.width_px > 400);
    const uint8_t *grey = picture.grey;
    CHECK(grey[40 * picture.width_px + 40] > 240); // 2 mm in: the middle of the first hole
    CHECK(grey[80 * picture.width_px + 80] < 240); // 4 mm in: between holes
    jali_picture_free(ctx, &picture);
    jali_bytes_free(ctx, &png);
    opt.longer_px = 10;
    CHECK_STATUS(jali_map_png(ctx, &sheet, &a, &CHART, &opt, &png), JALI_BAD_VALUE);
    jali_analysis_free(ctx, &a);
    jali_sheet_free(ctx, &sheet);
}

TEST(the_coloured_solid_is_a_solid)
{
    jali_sheet sheet;
    jali_analysis a;
    jali_mesh mesh;
    uint8_t(*colour)[3];
    jali_check_report report;
    make(&sheet, &a);
    double area = a.area_mm2;
    CHECK_OK(jali_map_solid(ctx, &sheet, &a, NULL, 0, &mesh, &colour));
    CHECK_INT(mesh.vertex_count, 2 * sheet.node_count);
    CHECK_OK(jali_check(ctx, &mesh, NULL, &report));
    CHECK(report.closed && fabs(report.volume_mm3 - 0.4 * area) < 1e-6);
    jali_map_release(ctx, colour);
    jali_mesh_free(ctx, &mesh);
    jali_analysis_free(ctx, &a);
    jali_sheet_free(ctx, &sheet);
}

TEST(ply_is_read_back)
{
    jali_sheet sheet;
    jali_analysis a;
    jali_bytes ply = {0};
    jali_mesh mesh;
    make(&sheet, &a);
    CHECK_OK(jali_map_ply(ctx, &sheet, &a, NULL, &ply));
    CHECK_OK(jali_read_model_bytes(ctx, ply.data, ply.size, "map.ply", NULL, &mesh));
    CHECK_INT(mesh.triangle_count, sheet.triangle_count);
    CHECK_INT(mesh.vertex_count, sheet.node_count);
    jali_mesh_free(ctx, &mesh);
    jali_bytes_free(ctx, &ply);
    jali_analysis_free(ctx, &a);
    jali_sheet_free(ctx, &sheet);
}

static uint64_t size_at(const jali_bytes *vtu, const char *name, const uint8_t *appended)
{
    char wanted[100], *at;
    uint64_t size;
    snprintf(wanted, sizeof wanted, "Name=\"%s\"", name);
    at = strstr((const char *)vtu->data, wanted);
    CHECK(at != NULL);
    at = strstr(at, "offset=\"");
    memcpy(&size, appended + strtoull(at + 8, NULL, 10), sizeof size);
    return size;
}

TEST(the_blocks_of_a_vtu_are_where_and_as_long_as_it_says)
{
    jali_sheet sheet;
    jali_analysis a;
    jali_bytes vtu = {0};
    make(&sheet, &a);
    CHECK_OK(jali_map_vtu(ctx, &sheet, &a, &vtu));
    CHECK(memchr(vtu.data, 0, vtu.size) != NULL); // so that strstr ends
    const char *data = strstr((const char *)vtu.data, "<AppendedData encoding=\"raw\">\n_");
    CHECK(data != NULL);
    const uint8_t *appended = (const uint8_t *)strchr(data, '_') + 1;
    uint64_t nodes = (uint64_t)sheet.node_count, triangles = (uint64_t)sheet.triangle_count;
    CHECK_INT(size_at(&vtu, "Points", appended), 12 * nodes);
    CHECK_INT(size_at(&vtu, "displacement_mm", appended), 12 * nodes);
    CHECK_INT(size_at(&vtu, "stress_mpa", appended), 4 * nodes);
    CHECK_INT(size_at(&vtu, "connectivity", appended), 12 * triangles);
    CHECK_INT(size_at(&vtu, "types", appended), triangles);
    CHECK(memcmp(vtu.data + vtu.size - 11, "</VTKFile>\n", 11) == 0);
    jali_bytes_free(ctx, &vtu);
    jali_analysis_free(ctx, &a);
    jali_sheet_free(ctx, &sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_grows_with_the_value_up_to_the_limit_and_falls_beyond),
        cmocka_unit_test(the_map_shows_solid_where_it_is_and_paper_in_holes),
        cmocka_unit_test(the_coloured_solid_is_a_solid),
        cmocka_unit_test(ply_is_read_back),
        cmocka_unit_test(the_blocks_of_a_vtu_are_where_and_as_long_as_it_says),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
