// Surfaces from files: put upright, mended, and what cannot be mended said.
#include "shapes.h"

#include <jali/check.h>
#include <jali/surface.h>
#include "base/bytes.h"
#include "base/file.h"

#include <unistd.h>

static char path[] = "mend-XXXXXX.obj";

// Write a mesh as OBJ, with more lines behind it, and free it.
static void write_obj(jali_mesh mesh, const char *more)
{
    jali_bytes text = {0};
    strcpy(path, "mend-XXXXXX.obj");
    int file = mkstemps(path, 4);
    CHECK(file >= 0);
    close(file);
    for (int32_t i = 0; i < mesh.vertex_count; i++)
        CHECK_OK(bytes_print(ctx, &text, "v %.9g %.9g %.9g\n", mesh.vertex[i][0], mesh.vertex[i][1],
                             mesh.vertex[i][2]));
    for (int32_t t = 0; t < mesh.triangle_count; t++)
        CHECK_OK(bytes_print(ctx, &text, "f %d %d %d\n", mesh.triangle[t][0] + 1, mesh.triangle[t][1] + 1,
                             mesh.triangle[t][2] + 1));
    CHECK_OK(bytes_print(ctx, &text, "%s", more));
    CHECK_OK(file_write(ctx, path, text.data, text.size));
    jali_bytes_free(ctx, &text);
    jali_mesh_free(ctx, &mesh);
}

typedef struct outcome {
    jali_surface surface;
    jali_surface_report report;
    jali_check_report check;
} outcome;

static outcome mended(jali_mesh mesh, const char *more)
{
    outcome o;
    write_obj(mesh, more);
    CHECK_OK(jali_surface_open(ctx, path, NULL, &o.surface, &o.report));
    CHECK_OK(jali_check(ctx, &o.surface.mesh, NULL, &o.check));
    unlink(path);
    CHECK_INT(o.check.triangles, o.report.triangles);
    CHECK(o.check.degenerate_triangles.count == 0 && o.check.repeated_triangles.count == 0);
    CHECK_INT(o.check.repeated_vertices, 0);
    CHECK_INT(o.check.open_edges.count, o.report.open_edges.count);
    CHECK_INT(o.check.crowded_edges.count, o.report.crowded_edges.count);
    CHECK_INT(o.check.crowded_vertices.count, o.report.crowded_vertices.count);
    CHECK_INT(o.check.misdirected_edges.count, o.report.misdirected_edges.count);
    CHECK_INT(o.check.intersections.count, o.report.intersections.count);
    int64_t faulty = 0;
    for (int32_t t = 0; t < o.report.triangles; t++) faulty += o.report.faulty[t];
    CHECK_INT(faulty, o.report.faulty_triangles);
    return o;
}

static void forget(outcome *o)
{
    jali_surface_free(ctx, &o->surface);
    jali_surface_report_free(ctx, &o->report);
}

static jali_mesh cube(double low, double high)
{
    return box_shape(low, low, low, high, high, high);
}

TEST(faces_are_turned_to_agree_and_outwards)
{
    for (int32_t t = 0; t < 12; t++) {
        jali_mesh mesh = cube(0, 1);
        flip_triangle(&mesh, t);
        outcome o = mended(mesh, "");
        CHECK(o.check.solid && o.check.volume_mm3 == 1);
        CHECK_INT(o.report.turned_triangles.count, 1);
        forget(&o);
    }
    outcome o = mended(inside_out(cube(0, 1)), "");
    CHECK(o.check.solid && o.check.volume_mm3 == 1);
    CHECK_INT(o.report.turned_triangles.count, 12);
    forget(&o);
}

TEST(shells_within_shells_are_voids_and_bodies_in_turn)
{
    for (int turned = 0; turned < 16; turned++) {
        jali_mesh all = {0};
        for (int i = 0; i < 4; i++) {
            jali_mesh shell = cube(-1 - i, 1 + i);
            if (turned >> i & 1) shell = inside_out(shell);
            all = i == 0 ? shell : together(all, shell);
        }
        outcome o = mended(all, "");
        CHECK(o.check.solid);
        CHECK_INT(o.check.pieces, 2);
        CHECK_INT(o.check.voids, 2);
        CHECK(o.check.volume_mm3 == 512 - 216 + 64 - 8);
        forget(&o);
    }
}

TEST(an_open_vessel_faces_outwards)
{
    for (int turned = 0; turned < 2; turned++) {
        jali_mesh mesh = cube(0, 2);
        if (turned) mesh = inside_out(mesh);
        mesh.triangle_count -= 2; // the side towards +x is gone
        outcome o = mended(mesh, "");
        CHECK_INT(o.report.open_edges.count, 4);
        CHECK_INT(o.report.turned_triangles.count, turned ? 10 : 0);
        CHECK_INT(o.report.faulty_triangles, 0);
        forget(&o);
    }
    // A flat sheet has no outside and stays.
    static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const int32_t half[2][3] = {{0, 2, 1}, {0, 2, 3}};
    outcome o = mended(shape(4, corner, 2, half), "");
    CHECK_INT(o.report.turned_triangles.count, 1);
    CHECK_INT(o.surface.mesh.triangle[0][1], 2);
    forget(&o);
}

TEST(soups_copies_and_needles_are_cleaned)
{
    jali_mesh mesh = cube(0, 1), soup;
    CHECK_OK(mesh_create(ctx, 36, 12, &soup));
    for (int32_t i = 0; i < 36; i++) {
        memcpy(soup.vertex[i], mesh.vertex[mesh.triangle[i / 3][i % 3]], sizeof *soup.vertex);
        soup.triangle[i / 3][i % 3] = i;
    }
    jali_mesh_free(ctx, &mesh);
    // A copy, a copy the other way round, a needle, a point; a vertex of nobody.
    outcome o = mended(soup, "f 1 2 3\nf 1 3 2\nf 1 2 2\nv 0.5 0 0\nv 7 7 7\nf 1 1 1\n");
    CHECK(o.check.solid);
    CHECK_INT(o.report.vertices, 8);
    CHECK_INT(o.report.triangles, 12);
    CHECK_INT(o.report.repeated_triangles.count, 2);
    CHECK_INT(o.report.degenerate_triangles.count, 2);
    CHECK(o.report.welded_vertices == 28 && o.report.file_triangles == 16);
    jali_bytes text = {0};
    CHECK_OK(jali_surface_sentences(ctx, &o.report, &text));
    CHECK(strstr((char *)text.data, "28 vertices at the place of another") != NULL);
    CHECK(strstr((char *)text.data, "2 triangles without area were dropped; the first is at") != NULL);
    CHECK(strstr((char *)text.data, "open") == NULL);
    jali_bytes_free(ctx, &text);
    forget(&o);
}

TEST(what_cannot_be_mended_is_marked)
{
    // Two cubes that share an edge: the four faces at it.
    outcome o = mended(together(cube(0, 1), box_shape(1, 1, 0, 2, 2, 1)), "");
    CHECK_INT(o.report.crowded_edges.count, 1);
    CHECK_INT(o.report.faulty_triangles, 4);
    forget(&o);
    // Two that share a corner.
    o = mended(together(cube(0, 1), cube(1, 2)), "");
    CHECK_INT(o.report.crowded_vertices.count, 1);
    CHECK(o.report.faulty_triangles >= 6 && o.report.faulty_triangles < 24);
    forget(&o);
}

// A small cube through the face of a large one, whichever faces which way: one solid, faulty along the line.
TEST(parts_that_cross_are_made_one)
{
    for (int turned = 0; turned < 4; turned++) {
        jali_mesh large = cube(0, 10), small = box_shape(4, 6, 9, 5, 7, 11);
        if (turned & 1) large = inside_out(large);
        if (turned & 2) small = inside_out(small);
        outcome o = mended(together(large, small), "");
        CHECK(o.check.solid && o.check.pieces == 1 && fabs(o.check.volume_mm3 - 1001) < 0.01);
        CHECK(o.report.merged.count >= 8 && o.report.intersections.count == 0);
        for (int32_t t = 0; t < o.report.triangles; t++) {
            bool above = true;
            for (int k = 0; k < 3; k++)
                above &= o.surface.mesh.vertex[o.surface.mesh.triangle[t][k]][2] > 9.99;
            CHECK(above || !o.report.faulty[t]);
        }
        CHECK(o.report.faulty_triangles >= 8);
        forget(&o);
    }
    // A void that a body crosses is none.
    outcome o =
        mended(together(together(cube(0, 10), inside_out(cube(2, 8))), box_shape(4, 4, 4, 5, 5, 20)), "");
    CHECK(o.check.solid && o.check.voids == 0 && fabs(o.check.volume_mm3 - 1010) < 0.1);
    forget(&o);
}

TEST(a_moebius_strip_stays_one)
{
    enum { STEPS = 20 };
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, 2 * STEPS, 2 * STEPS, &mesh));
    for (int32_t i = 0; i < STEPS; i++) {
        double angle = 2 * M_PI * i / STEPS;
        for (int32_t side = 0; side < 2; side++) {
            double across = side ? 1 : -1, radius = 5 + across * cos(angle / 2);
            double at[3] = {radius * cos(angle), radius * sin(angle), across * sin(angle / 2)};
            memcpy(mesh.vertex[2 * i + side], at, sizeof at);
        }
        bool last = i == STEPS - 1; // there the sides change places
        int32_t a = 2 * i, b = 2 * i + 1, c = last ? 1 : a + 2, d = last ? 0 : b + 2;
        memcpy(mesh.triangle[2 * i], (int32_t[3]){a, c, b}, sizeof *mesh.triangle);
        memcpy(mesh.triangle[2 * i + 1], (int32_t[3]){b, c, d}, sizeof *mesh.triangle);
    }
    outcome o = mended(mesh, "");
    CHECK_INT(o.report.misdirected_edges.count, 1);
    CHECK_INT(o.report.faulty_triangles, 2);
    forget(&o);
}

TEST(models_are_put_upright)
{
    static const struct {
        const char *keys;
        double size[3], corner[3]; // of the box, and where the file's corner (0, 0, 0) comes to lie
    } cases[] = {
        {"", {2, 4, 8}, {-1, -2, 0}},
        {":up=z", {2, 4, 8}, {-1, -2, 0}},
        {":up=y", {2, 8, 4}, {-1, 4, 0}},
        {":up=x", {8, 4, 2}, {4, -2, 0}},
        {":up=-z", {2, 4, 8}, {-1, 2, 8}},
        {":up=-y", {2, 8, 4}, {-1, -4, 4}},
        {":up=-x", {8, 4, 2}, {-4, -2, 2}},
        {":turn=90", {4, 2, 8}, {2, -1, 0}},
        {":unit=cm", {20, 40, 80}, {-10, -20, 0}},
        {":unit=in,scale=0.5", {25.4, 50.8, 101.6}, {-12.7, -25.4, 0}},
        {":height=24", {6, 12, 24}, {-3, -6, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char description[64];
        jali_surface s;
        jali_check_report r;
        write_obj(box_shape(0, 0, 0, 2, 4, 8), "");
        snprintf(description, sizeof description, "%s%s", path, cases[i].keys);
        CHECK_OK(jali_surface_open(ctx, description, NULL, &s, NULL));
        unlink(path);
        CHECK_OK(jali_check(ctx, &s.mesh, NULL, &r));
        CHECK(r.solid && r.low_mm[2] == 0);
        for (int k = 0; k < 3; k++) {
            CHECK(fabs(r.high_mm[k] - r.low_mm[k] - cases[i].size[k]) < 1e-5);
            CHECK(fabs(s.mesh.vertex[0][k] - cases[i].corner[k]) < 1e-5);
        }
        jali_surface_free(ctx, &s);
    }
}

TEST(what_is_asked_of_a_model_is_checked)
{
    static const struct {
        const char *keys, *sentence;
    } cases[] = {
        {":up=w", "there are x, y, z"},          {":unit=yd", "there are mm, cm, m, in"},
        {":scale=0", "scale must be"},           {":height=x", "is not a number"},
        {":r=3", "a model does not take \"r\""}, {":turn=1000", "turn must be"},
        {":unit=m,scale=6", "6000 x 12000 x"},
    };
    jali_surface s;
    jali_surface_report r;
    write_obj(box_shape(0, 0, 0, 1, 2, 1), "");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char description[64];
        snprintf(description, sizeof description, "%s%s", path, cases[i].keys);
        CHECK_STATUS(jali_surface_open(ctx, description, NULL, &s, &r), JALI_BAD_VALUE);
        if (!strstr(jali_message(ctx), cases[i].sentence))
            print_error("%s: %s\n", description, jali_message(ctx));
        CHECK(strstr(jali_message(ctx), cases[i].sentence) != NULL);
        CHECK(s.mesh.vertex == NULL && r.faulty == NULL);
    }
    unlink(path);
    CHECK_STATUS(jali_surface_open(ctx, "nothing-here.obj:up=y", NULL, &s, &r), JALI_IO);
    CHECK_STATUS(jali_surface_open(ctx, "dodecahedron", NULL, &s, &r), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "there is no surface") != NULL);
    CHECK_OK(jali_surface_open(ctx, "sphere:r=5", NULL, &s, &r));
    CHECK(s.uv != NULL && r.faulty == NULL);
    jali_surface_free(ctx, &s);
    write_obj(shape(0, NULL, 0, NULL), "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n");
    CHECK_STATUS(jali_surface_open(ctx, path, NULL, &s, &r), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "no triangle has an area") != NULL);
    unlink(path);
    write_obj(shape(0, NULL, 0, NULL), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    jali_surface_options opt = jali_surface_defaults();
    opt.height_mm = 10;
    CHECK_STATUS(jali_surface_read(ctx, path, &opt, &s, &r), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "is flat") != NULL);
    unlink(path);
}

TEST(texture_points_are_scaled_and_turned_with_their_triangles)
{
    // A flap in space, its texture a hundredth of the size; the second half is the wrong way round.
    write_obj(shape(0, NULL, 0, NULL),
              "v 0 0 0\nv 10 0 0\nv 10 0 10\nv 0 0 10\nv 5 5 20\nvt 0 0\nvt .1 0\nvt .1 .1\n"
              "vt 0 .1\nf 1/1 2/2 3/3\nf 1/1 4/4 3/3\n");
    jali_surface s;
    jali_surface_report r;
    CHECK_OK(jali_surface_open(ctx, path, NULL, &s, &r));
    unlink(path);
    CHECK_INT(r.turned_triangles.count, 1);
    for (int32_t t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++) {
            CHECK(fabs(s.uv[t][k][0] - (s.mesh.vertex[s.mesh.triangle[t][k]][0] + 5)) < 1e-5);
            CHECK(fabs(s.uv[t][k][1] - s.mesh.vertex[s.mesh.triangle[t][k]][2]) < 1e-5);
        }
    jali_surface_free(ctx, &s);
    jali_surface_report_free(ctx, &r);
}

static jali_status open_again(jali_context *limited, void *data)
{
    jali_surface s;
    jali_surface_report r;
    jali_status status = jali_surface_open(limited, data, NULL, &s, &r);
    jali_surface_free(limited, &s);
    jali_surface_report_free(limited, &r);
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    write_obj(together(cube(0, 1), cube(2, 3)), "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    refuse_each_allocation(open_again, path);
    unlink(path);
}

TEST(real_meshes_show_what_is_wrong)
{
    static const struct {
        const char *description;
        int32_t triangles, shells;
        int64_t open, crowded, turned;
        bool solid, textured;
    } known[] = {
        {"bunny.obj:up=y,scale=145.2", 59664, 1, 0, 0, 0, true, false},
        {"bunny-scan-open.obj:up=y,unit=m", 69451, 1, 223, 0, 0, false, false},
        {"vase.obj:up=-y,height=326", 10296, 1, 0, 0, 0, true, true},
        {"plane.off:up=y,scale=50", 32, 1, 16, 0, 0, false, false},
        {"spot.obj:up=y,scale=100", 5856, 1, 0, 0, 0, true, true},
        {"bad-degenerate.obj:scale=30", 10000, 1, 0, 0, 0, true, true},
        {"bad-holes-tiny-units.stl:unit=m", 3262, 1, 0, 0, 0, true,
         false}, // its cracks are below the lattice
        {"bad-frog-legs.obj", 18334, 3, 12, 0, 0, false, false},
        {"bad-nonmanifold.ply:scale=50", 43368, 112, 0, 242, 0, false, false},
    };
    const char *data = getenv("JALI_DATA");
    int32_t skipped = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char description[4096];
        outcome o;
        snprintf(description, sizeof description, "%s/meshes/%s", data ? data : "/nonexistent",
                 known[i].description);
        if (jali_surface_open(ctx, description, NULL, &o.surface, &o.report) == JALI_IO) {
            skipped++;
            continue;
        }
        CHECK_OK(jali_check(ctx, &o.surface.mesh, NULL, &o.check));
        CHECK_INT(o.report.triangles, known[i].triangles);
        CHECK_INT(o.report.shells, known[i].shells);
        CHECK_INT(o.report.open_edges.count, known[i].open);
        CHECK_INT(o.report.crowded_edges.count, known[i].crowded);
        CHECK_INT(o.report.turned_triangles.count, known[i].turned);
        CHECK_INT(o.check.solid, known[i].solid);
        CHECK_INT(o.surface.uv != NULL, known[i].textured);
        CHECK(!known[i].solid || o.report.faulty_triangles == 0);
        forget(&o);
    }
    if (skipped) print_message("%d of 9 meshes not there: skipped\n", skipped);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(faces_are_turned_to_agree_and_outwards),
        RUN(shells_within_shells_are_voids_and_bodies_in_turn),
        RUN(an_open_vessel_faces_outwards),
        RUN(soups_copies_and_needles_are_cleaned),
        RUN(what_cannot_be_mended_is_marked),
        RUN(parts_that_cross_are_made_one),
        RUN(a_moebius_strip_stays_one),
        RUN(models_are_put_upright),
        RUN(what_is_asked_of_a_model_is_checked),
        RUN(texture_points_are_scaled_and_turned_with_their_triangles),
        RUN(every_refused_allocation_is_a_status),
        RUN(real_meshes_show_what_is_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
