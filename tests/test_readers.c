// OBJ, PLY and OFF: what is right, every prefix of it, and what is wrong in one place.
#include "shapes.h"

#include <jali/check.h>
#include <jali/model.h>
#include "base/bytes.h"
#include "mesh/gather.h"
#include "mesh/readers.h"

static jali_status read_text(const char *text, jali_mesh *mesh)
{
    return jali_read_model_bytes(ctx, text, strlen(text), "model", NULL, mesh);
}

static void check_tetrahedron(jali_status status, jali_mesh *mesh)
{
    jali_check_report r;
    CHECK_OK(status);
    CHECK_INT(mesh->vertex_count, 4);
    CHECK_OK(jali_check(ctx, mesh, NULL, &r));
    CHECK(r.solid && fabs(r.volume_mm3 - 1.0 / 6) < 1e-15);
    jali_mesh_free(ctx, mesh);
}

static const char obj_tetrahedron[] =

    "v 0 0 0\nv 1e0 0 0 0.5 0.5 0.5\r\n\tv 0 .1e+1 -0\nv 0 0 \\\n 1.000 1.0\n"
    "vt 0 0\nvt 1 0 0\nvt 0.5\nvn 0 0 1\no a thing\ng f f f\ns off\nusemtl f\n"
    "f 2 4 3\nf -4/1 -3/2/1 -1//1 # corner\nf 2/1/1 3/1/1 4/1/1\nf 1 4 3\n";

static const char off_tetrahedron[] =
    "# first\nOFF # and\n4 4 6\n\n0 0 0\n1 0 0 255 0 0\n0 1 0\n# between\n0 0 1\n"
    "3 0 2 1\n3 0 1 3 0.5 0.5 0.5\n3 1 2 3 7\n3 0 3 2\n";

static const char ply_tetrahedron[] =
    "ply\nformat ascii 1.0\ncomment element vertex 7\nelement vertex 4\nproperty double nx\nproperty float32 "
    "x\n"
    "property int y\nproperty list uchar int8 more\nproperty uchar z\nelement nothing 3\nelement edge 1\n"
    "property int a\nelement face 4\nproperty uchar colour\nproperty list uint8 short "
    "vertex_index\nend_header\n"
    "nan 0 0 0 0\ninf 1 0 2 7 7 0\n0 0 1 1 9 0\n0 0 0 0 1\n5\n1 3 0 2 1\n1 3 0 1 3\n1 3 1 2\n3\n1 3 0 3 2\n";

TEST(each_text_format_is_read)
{
    jali_mesh mesh;

    check_tetrahedron(read_text(off_tetrahedron, &mesh), &mesh);
    check_tetrahedron(read_text(ply_tetrahedron, &mesh), &mesh);
    CHECK_OK(read_text(obj_tetrahedron, &mesh));
    CHECK_INT(mesh.vertex_count, 4);
    CHECK_INT(mesh.triangle_count, 4);
    CHECK_INT(mesh.triangle[1][0], 0);
    CHECK_INT(mesh.triangle[1][2], 3);
    jali_mesh_free(ctx, &mesh);
}

// A file that is cut off is refused, or so near to its end that only decorations are gone.
TEST(every_prefix_is_refused_or_whole)
{
    static const char *const text[] = {off_tetrahedron, ply_tetrahedron};
    for (int i = 0; i < 2; i++)
        for (size_t length = 0; length < strlen(text[i]); length++) {
            char *exact = malloc(length + 1);
            jali_mesh mesh;
            memcpy(exact, text[i], length);
            jali_status status = jali_read_model_bytes(ctx, exact, length, "model", NULL, &mesh);
            CHECK(status == JALI_BAD_INPUT || (status == JALI_OK && length + 2 > strlen(text[i])));
            CHECK(status == JALI_OK || (mesh.vertex == NULL && strlen(jali_message(ctx)) > 10));
            jali_mesh_free(ctx, &mesh);
            free(exact);
        }
}

// The tetrahedron in binary: x, y, z of three types and a list of another.
static void append_number(jali_bytes *bytes, bool big, uint64_t bits, int size)
{
    for (int i = 0; i < size; i++) {
        uint8_t byte = (uint8_t)(bits >> 8 * (big ? size - 1 - i : i));
        CHECK_OK(bytes_append(ctx, bytes, &byte, 1));
    }
}

static jali_bytes binary_ply(bool big, double first_x)
{
    static const uint8_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    jali_bytes bytes = {0};
    CHECK_OK(bytes_print(
        ctx, &bytes,
        "ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty double x\nproperty ushort skip\n"
        "property float y\nproperty char z\nelement face 4\nproperty list ushort uint vertex_indices\n"
        "property list uchar double more\nend_header\n",
        big ? "big" : "little"));
    for (int v = 0; v < 4; v++) {
        double x = v == 0 ? first_x : v == 1;
        float y = v == 2;
        uint64_t bits;
        uint32_t low;
        memcpy(&bits, &x, sizeof bits);
        memcpy(&low, &y, sizeof low);
        append_number(&bytes, big, bits, 8);
        append_number(&bytes, big, 0xffff, 2);
        append_number(&bytes, big, low, 4);
        append_number(&bytes, big, v == 3, 1);
    }
    for (int f = 0; f < 4; f++) {
        append_number(&bytes, big, 3, 2);
        for (int k = 0; k < 3; k++) append_number(&bytes, big, face[f][k], 4);
        append_number(&bytes, big, 1, 1);
        append_number(&bytes, big, UINT64_MAX, 8);
    }
    return bytes;
}

TEST(binary_ply_of_both_byte_orders_is_read_and_no_prefix_of_it)
{
    for (int big = 0; big < 2; big++) {
        jali_bytes bytes = binary_ply(big, 0);
        jali_mesh mesh;
        check_tetrahedron(jali_read_model_bytes(ctx, bytes.data, bytes.size, "model", NULL, &mesh), &mesh);
        for (size_t length = 0; length < bytes.size; length++) {
            uint8_t *exact = malloc(length + 1);
            memcpy(exact, bytes.data, length);
            CHECK_STATUS(jali_read_model_bytes(ctx, exact, length, "model", NULL, &mesh), JALI_BAD_INPUT);
            free(exact);
        }
        jali_bytes_free(ctx, &bytes);
        bytes = binary_ply(big, NAN);
        CHECK_STATUS(jali_read_model_bytes(ctx, bytes.data, bytes.size, "model", NULL, &mesh),
                     JALI_BAD_INPUT);
        CHECK(strstr(jali_message(ctx), "vertex 1 of 4 has a coordinate that is not a finite number") !=
              NULL);
        jali_bytes_free(ctx, &bytes);
    }
}

#define PLY_HEAD          "ply\nformat ascii 1.0\n"
#define PLY_VERTEX(count) "element vertex " count "\nproperty float x\nproperty float y\nproperty float z\n"
#define PLY_FACE(count)   "element face " count "\nproperty list uchar int vertex_indices\nend_header\n"

TEST(what_is_wrong_in_one_place_is_said)
{
    static const struct {
        const char *text, *sentence;
        jali_status status;
    } cases[] = {
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "holds no triangles", JALI_BAD_INPUT},
        {"# nothing", "holds no triangles", JALI_BAD_INPUT},
        {"v 0 0 nan\n", "line 1: a vertex needs three", JALI_BAD_INPUT},
        {"v 0 0 1e39\n", "line 1: a vertex needs three", JALI_BAD_INPUT},
        {"v 0 0\n1\n", "line 1: a vertex needs three", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4: the face names vertex 4; there are 3",
         JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "vertex 0", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "vertex -4", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", "line 4", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/2\n", "texture point 2", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "line 4: a face is three or more", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 three\n", "line 4: a face is three or more", JALI_BAD_INPUT},
        {"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3 4\n", "line 5: the face of 4 corners crosses",
         JALI_BAD_INPUT},
        {"vt nan\n", "line 1: a texture point", JALI_BAD_INPUT},
        {"OFF", "cut off", JALI_BAD_INPUT},
        {"OFF 3 x\n", "line 1: the numbers of vertices", JALI_BAD_INPUT},
        {"OFF -3 1 0\n", "line 1: the numbers of vertices", JALI_BAD_INPUT},
        {"OFF 99999999999999 1 0\n", "line 1: the numbers of vertices", JALI_BAD_INPUT},
        {"OFF\n2000000000 2000000000 0\n0 0 0\n", "cut off at line", JALI_BAD_INPUT},
        {"OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "line 4: a face of 3 corners", JALI_BAD_INPUT},
        {"OFF\n1 1 0\n0 0 0\n3 0 0\n", "line 4: a face of 3 corners", JALI_BAD_INPUT},
        {"OFF\n1 1 0\n0 0 0\n99999999 0 0 0\n", "line 4: a face of", JALI_BAD_INPUT},
        {"OFF\n0 1 0\n3 0 0 0\n", "line 3", JALI_BAD_INPUT},
        {"OFF\n1 0 0\n0 0 0\n", "holds no triangles", JALI_BAD_INPUT},
        {"OFF BINARY\n", "line 1", JALI_BAD_INPUT},
        {"ply\n", "no end_header", JALI_BAD_INPUT},
        {"ply\nend_header\n", "no format", JALI_BAD_INPUT},
        {"ply\nformat utf8 1.0\nend_header\n", "line 2: a format is", JALI_BAD_INPUT},
        {PLY_HEAD "element vertex\n", "line 3: an element is", JALI_BAD_INPUT},
        {PLY_HEAD "element vertex -1\n", "line 3: an element is", JALI_BAD_INPUT},
        {PLY_HEAD "property int x\n", "property of no element", JALI_BAD_INPUT},
        {PLY_HEAD "element face 1\nproperty list float int x\n", "line 4: a property is", JALI_BAD_INPUT},
        {PLY_HEAD "element vertex 1\nproperty float x\nend_header\n1\n", "without x, y or z", JALI_BAD_INPUT},
        {PLY_HEAD PLY_VERTEX("3") PLY_FACE("1") "0 0 0 1 0 0 0 1 0 3 0 1 3", "face 1 of 1 is cut off",
         JALI_BAD_INPUT},
        {PLY_HEAD PLY_VERTEX("3") PLY_FACE("1") "0 0 0 1 0 0 0 1 0 3 0 1 3\n",
         "names a vertex that is not there", JALI_BAD_INPUT},
        {PLY_HEAD PLY_VERTEX("3") PLY_FACE("1") "0 0 0 1 0 0 0 1 0 3 0 1 1.5\n", "names a vertex",
         JALI_BAD_INPUT},
        {PLY_HEAD PLY_VERTEX("3") PLY_FACE("1") "0 0 0 1 0 0 0 1 0 -3 0 1 2\n", "without a length",
         JALI_BAD_INPUT},
        {PLY_HEAD PLY_VERTEX("3") PLY_FACE("0") "0 0 0 1 0 0 0 1 0\n", "holds no triangles", JALI_BAD_INPUT},
        {PLY_HEAD PLY_FACE("1") "3 0 1 2\n", "names a vertex", JALI_BAD_INPUT},
        {PLY_HEAD PLY_VERTEX("9000000000000000000") PLY_FACE("1") "0 0 0\n", "vertex 2 of", JALI_BAD_INPUT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        jali_mesh mesh;
        jali_status status = read_text(cases[i].text, &mesh);
        if (status != cases[i].status || !strstr(jali_message(ctx), cases[i].sentence))
            print_error("case %zu: status %d: %s\n", i, status, jali_message(ctx));
        CHECK_INT(status, cases[i].status);
        CHECK(strstr(jali_message(ctx), cases[i].sentence) != NULL);
        CHECK(mesh.vertex == NULL);
    }
}

TEST(limits_on_triangles_hold_for_each_format)
{
    static const char *const text[] = {
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        "OFF 4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        PLY_HEAD PLY_VERTEX("4") PLY_FACE("1") "0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3\n",
    };
    for (int i = 0; i < 3; i++) {
        jali_mesh mesh;
        jali_model_options limits = jali_model_defaults();
        limits.max_triangles = 1;
        CHECK_STATUS(jali_read_model_bytes(ctx, text[i], strlen(text[i]), "model", &limits, &mesh),
                     JALI_LIMIT);
        limits.max_triangles = 2;
        CHECK_OK(jali_read_model_bytes(ctx, text[i], strlen(text[i]), "model", &limits, &mesh));
        CHECK_INT(mesh.triangle_count, 2);
        jali_mesh_free(ctx, &mesh);
    }
}

// The area of a polygon's triangles, all of which must turn as it does.
static double split_area(int32_t count, const double (*corner)[2], int dropped, bool mirrored)
{
    jali_bytes text = {0};
    jali_mesh mesh;
    jali_check_report r;
    for (int32_t i = 0; i < count; i++) {
        double at[3] = {0};
        at[(dropped + 1) % 3] = corner[i][0];
        at[(dropped + 2) % 3] = corner[i][1];
        CHECK_OK(bytes_print(ctx, &text, "v %.17g %.17g %.17g\n", at[0], at[1], at[2] + 0.1 * at[0]));
    }
    CHECK_OK(bytes_print(ctx, &text, "f"));
    for (int32_t i = 0; i < count; i++)
        CHECK_OK(bytes_print(ctx, &text, " %d", mirrored ? count - i : i + 1));
    CHECK_OK(jali_read_model_bytes(ctx, text.data, text.size, "model", NULL, &mesh));
    CHECK_INT(mesh.triangle_count, count - 2);
    CHECK_OK(jali_check(ctx, &mesh, NULL, &r));
    CHECK(r.misdirected_edges.count == 0 && r.crowded_edges.count == 0 && r.intersections.count == 0);
    jali_mesh_free(ctx, &mesh);
    jali_bytes_free(ctx, &text);
    return r.area_mm2;
}

TEST(concave_polygons_are_split_along_their_inside)
{
    // A comb whose first corner is at the bottom of a gap, so that no fan fits; a spiral.
    static const double comb[][2] = {{2, 1}, {2, 4}, {1, 4}, {1, 0}, {8, 0}, {8, 4}, {7, 4}, {7, 1},
                                     {6, 1}, {6, 4}, {5, 4}, {5, 1}, {4, 1}, {4, 4}, {3, 4}, {3, 1}};
    static const double spiral[][2] = {{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2},
                                       {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}};
    for (int dropped = 0; dropped < 3; dropped++)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            double slope = dropped == 2 ? sqrt(1.01) : 1; // z rises with x; in a plane of z that only shears
            CHECK(fabs(split_area(16, comb, dropped, mirrored) / slope - 19) < 1e-5);
            CHECK(fabs(split_area(12, spiral, dropped, mirrored) / slope - 15) < 1e-5);
        }
}

TEST(texture_points_stay_with_their_corners)
{
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\nvt 5 5\n"
                               "f 1/1 2/2 3/3 4/-2\nf 1/5 3/3 4/4\n";
    const model_file file = {text, strlen(text), "model", jali_model_defaults()};
    jali_mesh mesh;
    double(*uv)[3][2];
    CHECK_OK(read_any_model(ctx, &file, &mesh, &uv));
    CHECK(uv[0][0][0] == 0 && uv[0][1][0] == 2 && uv[1][2][1] == 2 && uv[2][0][0] == 5);
    jali_mesh_free(ctx, &mesh);
    release(ctx, uv);
    const char *bare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3\n";
    const model_file partly = {bare, strlen(bare), "model", jali_model_defaults()};
    CHECK_OK(read_any_model(ctx, &partly, &mesh, &uv));
    CHECK(uv == NULL);
    jali_mesh_free(ctx, &mesh);
}

static jali_status read_again(jali_context *limited, void *data)
{
    jali_mesh mesh;
    double(*uv)[3][2];
    const model_file file = {data, strlen(data), "model", jali_model_defaults()};
    jali_status status = read_any_model(limited, &file, &mesh, &uv);
    jali_mesh_free(limited, &mesh);
    release(limited, uv);
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    refuse_each_allocation(read_again, (char[]){"v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"});
    refuse_each_allocation(read_again, (void *)(uintptr_t)off_tetrahedron);
    refuse_each_allocation(read_again, (void *)(uintptr_t)ply_tetrahedron);
}

// What data/SOURCES.md says of the real files.
TEST(real_files_are_read)
{
    static const struct {
        const char *name;
        int32_t triangles;
        int64_t open, crowded;
    } known[] = {{"bunny.obj", 59664, 0, 0},          {"bunny-scan-open.obj", 69451, 223, 0},
                 {"vase.obj", 10296, 0, 0},           {"plane.off", 32, 16, 0},
                 {"sphere.obj", 1280, 0, 0},          {"spot.obj", 5856, 0, 0},
                 {"teapot-open.obj", 6320, 160, 0},   {"bad-nonmanifold.ply", 43368, 0, 242},
                 {"bad-frog-legs.obj", 18334, 12, 0}, {"bad-degenerate.obj", 10200, 0, 0}};
    const char *data = getenv("JALI_DATA");
    int32_t skipped = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char path[4096];
        jali_mesh mesh;
        jali_check_report r;
        snprintf(path, sizeof path, "%s/meshes/%s", data ? data : "", known[i].name);
        if (jali_read_model(ctx, path, NULL, &mesh) == JALI_IO) {
            skipped++;
            continue;
        }
        CHECK_OK(jali_check(ctx, &mesh, &(jali_check_options){.skip_intersections = true}, &r));
        CHECK_INT(r.triangles, known[i].triangles);
        CHECK_INT(r.open_edges.count, known[i].open);
        CHECK_INT(r.crowded_edges.count, known[i].crowded);
        jali_mesh_free(ctx, &mesh);
    }
    if (skipped) print_message("%d of 10 meshes not there: skipped\n", skipped);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(each_text_format_is_read),
        RUN(every_prefix_is_refused_or_whole),
        RUN(binary_ply_of_both_byte_orders_is_read_and_no_prefix_of_it),
        RUN(what_is_wrong_in_one_place_is_said),
        RUN(limits_on_triangles_hold_for_each_format),
        RUN(concave_polygons_are_split_along_their_inside),
        RUN(texture_points_stay_with_their_corners),
        RUN(every_refused_allocation_is_a_status),
        RUN(real_files_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
