// Reading models: what is right, every prefix of it, and what is wrong in one place.
#include "shapes.h"

#include <jali/check.h>
#include <jali/model.h>
#include <jali/write.h>
#include "base/bytes.h"
#include "base/file.h"
#include "base/number.h"
#include "write/zip.h"

static jali_status read_text(const char *text, jali_mesh *mesh)
{
    return jali_read_model_bytes(ctx, text, strlen(text), "model", NULL, mesh);
}

static const char ascii_tetrahedron[] =
    "solid a facet of vertex words\n"
    "facet normal 0 0 -1\n outer loop\n vertex 0 0 0\n vertex 0 1 0\n vertex 1 0 0\n endloop\nendfacet\n"
    "FACET NORMAL 0 -1 0\r\n OUTER LOOP\r\n VERTEX 0 0 0\r\n VERTEX 1 0 0\r\n VERTEX 0 0 1\r\n "
    "ENDLOOP\r\nENDFACET\r\n"
    "facet normal 1 1 1\n outer loop\n vertex 1e0 0 -0\n vertex 0 .1e+1 0\n vertex 0 0 1.000\n "
    "endloop\nendfacet\n"
    "facet normal -1 0 0 outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet\n"
    "endsolid a facet of vertex words\n";

TEST(ascii_stl_is_read_and_welded)
{
    jali_mesh mesh;
    jali_check_report r;
    CHECK_OK(read_text(ascii_tetrahedron, &mesh));
    CHECK_INT(mesh.vertex_count, 4);
    CHECK_OK(jali_check(ctx, &mesh, NULL, &r));
    CHECK(r.solid && fabs(r.volume_mm3 - 1.0 / 6) < 1e-15);
    jali_mesh_free(ctx, &mesh);
}

TEST(every_prefix_of_an_ascii_stl_is_refused)
{
    const char *last = strstr(ascii_tetrahedron, "endsolid"); // with that word the file is complete
    for (size_t length = 0; length < (size_t)(last - ascii_tetrahedron) + 8; length++) {
        char *text = strndup(ascii_tetrahedron, length);
        jali_mesh mesh;
        CHECK_STATUS(read_text(text, &mesh), JALI_BAD_INPUT);
        CHECK(strlen(jali_message(ctx)) > 10);
        free(text);
    }
}

TEST(a_binary_stl_may_begin_with_solid)
{
    jali_mesh torus_mesh = torus(12, 8), mesh;
    jali_bytes bytes = {0};
    CHECK_OK(jali_write_stl(ctx, &torus_mesh, &bytes));
    memcpy(bytes.data, "solid facet", 11);
    CHECK_OK(jali_read_model_bytes(ctx, bytes.data, bytes.size, "model", NULL, &mesh));
    CHECK_INT(mesh.triangle_count, torus_mesh.triangle_count);
    CHECK_INT(mesh.vertex_count, torus_mesh.vertex_count);
    jali_mesh_free(ctx, &mesh);
    jali_mesh_free(ctx, &torus_mesh);
    jali_bytes_free(ctx, &bytes);
}

TEST(every_prefix_of_a_binary_model_is_refused)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 2, 3), mesh;
    for (int kind = 0; kind < 2; kind++) {
        jali_bytes bytes = {0};
        if (kind)
            CHECK_OK(jali_write_3mf(ctx, &cube, &(jali_write_options){.no_thumbnail = true}, &bytes));
        else
            CHECK_OK(jali_write_stl(ctx, &cube, &bytes));
        for (size_t length = 0; length < bytes.size; length++) {
            uint8_t *exact = malloc(length + 1); // an own block: a read behind its end is seen
            memcpy(exact, bytes.data, length);
            CHECK_STATUS(jali_read_model_bytes(ctx, exact, length, "model", NULL, &mesh), JALI_BAD_INPUT);
            CHECK(mesh.vertex == NULL && strlen(jali_message(ctx)) > 10);
            free(exact);
        }
        jali_bytes_free(ctx, &bytes);
    }
    jali_mesh_free(ctx, &cube);
}

TEST(a_stl_with_a_coordinate_that_is_no_number_is_refused)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 2, 3), mesh;
    jali_bytes bytes = {0};
    CHECK_OK(jali_write_stl(ctx, &cube, &bytes));
    memset(bytes.data + 84 + 3 * 50 + 12, 0xff, 4);
    CHECK_STATUS(jali_read_model_bytes(ctx, bytes.data, bytes.size, "model", NULL, &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "triangle 4 of 12") != NULL);
    CHECK_STATUS(read_text("solid\nfacet\nouter loop\nvertex nan 0 0\n", &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "line 4") != NULL);
    jali_bytes_free(ctx, &bytes);
    jali_mesh_free(ctx, &cube);
}

TEST(other_types_are_named)
{
    jali_mesh mesh;
    CHECK_STATUS(read_text("\x89PNG\r\n", &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "PNG picture") != NULL);
    CHECK_STATUS(read_text("", &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "empty") != NULL);
    CHECK_STATUS(read_text("hello", &mesh), JALI_BAD_INPUT);
    CHECK_STATUS(jali_read_model(ctx, "/nonexistent/model.stl", NULL, &mesh), JALI_IO);
    CHECK(strstr(jali_message(ctx), "/nonexistent/model.stl: No such file") != NULL);
    CHECK_STATUS(jali_read_model(ctx, "/", NULL, &mesh), JALI_IO);
}

// A 3MF around the given model text.
static jali_bytes archive_of(const char *model)
{
    jali_bytes bytes = {0};
    zip_writer zip = {0};
    CHECK_OK(zip_add(ctx, &zip, "3D/3dmodel.model", model, strlen(model), 1, &bytes));
    CHECK_OK(zip_finish(ctx, &zip, &bytes));
    return bytes;
}

static jali_status read_3mf_text(const char *model, jali_mesh *mesh)
{
    jali_bytes bytes = archive_of(model);
    jali_status status = jali_read_model_bytes(ctx, bytes.data, bytes.size, "model", NULL, mesh);
    jali_bytes_free(ctx, &bytes);
    return status;
}

#define MODEL(unit)                                                                                          \
    "<model unit=\"" unit "\" "                                                                              \
    "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
#define TETRAHEDRON(id)                                                                                      \
    "<object id=\"" id                                                                                       \
    "\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"                  \
    "<vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>"               \
    "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"                           \
    "<triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" "                                     \
    "v3=\"2\"/></triangles></mesh></object>"
#define BUILD(items) "</resources><build>" items "</build></model>"

TEST(components_units_and_mirrors_are_placed)
{
    jali_mesh mesh;
    jali_check_report r;
    CHECK_OK(read_3mf_text(
        MODEL("inch") TETRAHEDRON(
            "7") "<object id=\"3\"><components><component objectid=\"7\"/>"
                 "<component objectid=\"7\" transform=\"-1 0 0 0 1 0 0 0 1 -5 0 "
                 "0\"/></components></object>" BUILD(
                     "<item objectid=\"3\" transform=\"2 0 0 0 2 0 0 0 2 0 0 10\"/><item objectid=\"7\"/>"),
        &mesh));
    CHECK_INT(mesh.triangle_count, 12);
    CHECK_OK(jali_check(ctx, &mesh, NULL, &r));
    CHECK(r.solid);
    CHECK_INT(r.pieces, 3);
    CHECK(fabs(r.volume_mm3 / (25.4 * 25.4 * 25.4) - (8 + 8 + 1) / 6.0) < 1e-4);
    CHECK(fabs(r.low_mm[0] + 12 * 25.4) < 1e-3 && fabs(r.high_mm[2] - 12 * 25.4) < 1e-3);
    jali_mesh_free(ctx, &mesh);
}

TEST(what_a_3mf_must_not_say_is_refused)
{
    static const struct {
        const char *model, *sentence;
    } cases[] = {
        {"<a/>", "no 3MF model"},
        {"<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>", "document type"},
        {"<a>", "no element found"},
        {MODEL("league") BUILD(""), "unknown unit"},
        {MODEL("meter") TETRAHEDRON("1") BUILD(""), "nothing is placed"},
        {MODEL("meter") TETRAHEDRON("1") BUILD("<item objectid=\"2\"/>"), "earlier object"},
        {MODEL("meter") TETRAHEDRON("1") BUILD("<item objectid=\"1\" transform=\"1 2 3\"/>"), "12 numbers"},
        {MODEL("meter") TETRAHEDRON("1") TETRAHEDRON("1") BUILD(""), "id of its own"},
        {MODEL("meter") "<object id=\"1\"><components><component "
                        "objectid=\"1\"/></components></object>" BUILD(""),
         "earlier object"},
        {MODEL("meter") "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"nan\" z=\"0\"/>",
         "finite number as y"},
        {MODEL("meter") "<object id=\"1\"><mesh><triangles><triangle v1=\"0\" v2=\"0\" v3=\"0\"/>",
         "0 vertices"},
        {MODEL("meter") "<object id=\"1\"/>" BUILD("<item objectid=\"1\"/>"), "no triangles"},
        {MODEL("meter") TETRAHEDRON("1")
             BUILD("<item objectid=\"1\" transform=\"1e300 0 0 0 1 0 0 0 1 0 0 0\"/>"
                   "<item objectid=\"1\" transform=\"1e308 0 0 0 1 0 0 0 1 0 0 0\"/>"),
         "not a finite number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        jali_mesh mesh;
        jali_status status = read_3mf_text(cases[i].model, &mesh);
        if (status != JALI_BAD_INPUT || !strstr(jali_message(ctx), cases[i].sentence))
            print_error("case %zu: status %d: %s\n", i, status, jali_message(ctx));
        CHECK_INT(status, JALI_BAD_INPUT);
        CHECK(strstr(jali_message(ctx), cases[i].sentence) != NULL);
    }
}

// Each object holds the one before it twice: 2^30 tetrahedra in 3 kB.
TEST(a_component_bomb_is_a_limit)
{
    jali_bytes model = {0};
    jali_mesh mesh;
    CHECK_OK(bytes_print(ctx, &model, "%s", MODEL("meter") TETRAHEDRON("1")));
    for (int i = 2; i <= 31; i++)
        CHECK_OK(bytes_print(ctx, &model,
                             "<object id=\"%d\"><components><component objectid=\"%d\"/>"
                             "<component objectid=\"%d\"/></components></object>",
                             i, i - 1, i - 1));
    CHECK_OK(bytes_print(ctx, &model, "%s", BUILD("<item objectid=\"31\"/>")));
    CHECK_STATUS(read_3mf_text((char *)model.data, &mesh), JALI_LIMIT);
    jali_bytes_free(ctx, &model);
}

TEST(a_decompression_bomb_is_refused)
{
    size_t size = 64 << 20;
    char *spaces = malloc(size + 1);
    memset(spaces, ' ', size);
    spaces[size] = 0;
    jali_mesh mesh;
    CHECK_STATUS(read_3mf_text(spaces, &mesh), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "which no model does") != NULL);
    free(spaces);
}

TEST(damage_anywhere_in_a_3mf_never_passes_for_the_model)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 2, 3), mesh;
    jali_bytes bytes = {0};
    CHECK_OK(jali_write_3mf(ctx, &cube, &(jali_write_options){.no_thumbnail = true}, &bytes));
    for (size_t i = 0; i < bytes.size; i++) {
        bytes.data[i] ^= 0x55;
        jali_status status = jali_read_model_bytes(ctx, bytes.data, bytes.size, "model", NULL, &mesh);
        if (status == JALI_OK)
            CHECK_OK(jali_check_readback(ctx, bytes.data, bytes.size, &cube)); // harmless there
        jali_mesh_free(ctx, &mesh);
        bytes.data[i] ^= 0x55;
    }
    jali_bytes_free(ctx, &bytes);
    jali_mesh_free(ctx, &cube);
}

TEST(decimals_are_read_as_strtod_reads_them)
{
    static const char *const texts[] = {
        "0",
        "-0",
        "1",
        ".5",
        "5.",
        "1e5",
        "1E-5",
        "123456789012345678901234567890",
        "0.1",
        "1e22",
        "1e23",
        "8e22",
        "9007199254740993",
        "2.2250738585072011e-308",
        "4.9e-324",
        "1.7976931348623157e308",
        "0.00000000000000000001",
        "6.02214076e+23",
        "1e-400",
        "000000000000000000000000000000000000001.5",
        "9007199254740992.99999999999999999999999999999999999999999999999999999999",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const char *at = texts[i], *end = at + strlen(at);
        double value;
        CHECK(read_decimal(&at, end, &value));
        CHECK(at == end && value == strtod(texts[i], NULL));
    }
    static const char *const none[] = {"", "-", ".", "e5", "nan", "inf", "1e999", "+-1"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        const char *at = none[i];
        double value;
        CHECK(!read_decimal(&at, at + strlen(at), &value));
        CHECK(at == none[i]);
    }
    uint64_t seed = 5;
    for (int i = 0; i < 100000; i++) {
        char text[64];
        int length =
            snprintf(text, sizeof text, "%.*e", (int)(next_random(&seed) >> 59),
                     ldexp((double)(next_random(&seed) >> 11), (int)(next_random(&seed) >> 57) - 116));
        const char *at = text;
        double value;
        CHECK(read_decimal(&at, text + length, &value));
        CHECK(value == strtod(text, NULL) && at == text + length);
    }
}

// Figures of SOURCES.md for the files of a format that is read.
TEST(real_meshes_show_their_flaws)
{
    static const struct {
        const char *name;
        int32_t triangles;
        int64_t open, crossing;
        bool solid;
    } known[] = {
        {"cylinder.stl", 416, 0, 0, true},
        {"bad-holes-tiny-units.stl", 3262, 54, 131, false},
    };
    const char *data = getenv("JALI_DATA");
    int skipped = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char path[4096];
        jali_mesh mesh;
        jali_check_report r;
        snprintf(path, sizeof path, "%s/meshes/%s", data ? data : "", known[i].name);
        jali_status status = jali_read_model(ctx, path, NULL, &mesh);
        if (status == JALI_IO) {
            skipped++;
            continue;
        }
        CHECK_INT(status, JALI_OK);
        CHECK_OK(jali_check(ctx, &mesh, NULL, &r));
        print_message("%s: %d triangles, %lld open edges, %lld crossings, %lld without area\n", known[i].name,
                      r.triangles, (long long)r.open_edges.count, (long long)r.intersections.count,
                      (long long)r.degenerate_triangles.count);
        CHECK_INT(r.triangles, known[i].triangles);
        CHECK_INT(r.open_edges.count, known[i].open);
        CHECK_INT(r.solid, known[i].solid);
        CHECK(r.intersections.count >= known[i].crossing);
        jali_mesh_free(ctx, &mesh);
    }
    if (skipped) print_message("%d of 2 meshes not there: skipped\n", skipped);
}

static jali_status read_again(jali_context *limited, void *data)
{
    jali_mesh mesh;
    const jali_bytes *bytes = data;
    jali_status status = jali_read_model_bytes(limited, bytes->data, bytes->size, "model", NULL, &mesh);
    jali_mesh_free(limited, &mesh);
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 2, 3);
    jali_bytes bytes = {0};
    CHECK_OK(jali_write_stl(ctx, &cube, &bytes));
    refuse_each_allocation(read_again, &bytes);
    jali_bytes_free(ctx, &bytes);
    CHECK_OK(bytes_print(ctx, &bytes, "%s", ascii_tetrahedron));
    refuse_each_allocation(read_again, &bytes);
    jali_bytes_free(ctx, &bytes);
    bytes =
        archive_of(MODEL("meter") TETRAHEDRON("1") "<object id=\"2\"><components><component objectid=\"1\"/>"
                                                   "</components></object>" BUILD("<item objectid=\"2\"/>"));
    refuse_each_allocation(read_again, &bytes);
    jali_bytes_free(ctx, &bytes);
    jali_mesh_free(ctx, &cube);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(ascii_stl_is_read_and_welded),
        RUN(every_prefix_of_an_ascii_stl_is_refused),
        RUN(a_binary_stl_may_begin_with_solid),
        RUN(every_prefix_of_a_binary_model_is_refused),
        RUN(a_stl_with_a_coordinate_that_is_no_number_is_refused),
        RUN(other_types_are_named),
        RUN(components_units_and_mirrors_are_placed),
        RUN(what_a_3mf_must_not_say_is_refused),
        RUN(a_component_bomb_is_a_limit),
        RUN(a_decompression_bomb_is_refused),
        RUN(damage_anywhere_in_a_3mf_never_passes_for_the_model),
        RUN(decimals_are_read_as_strtod_reads_them),
        RUN(real_meshes_show_their_flaws),
        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
