// Surfaces: closed or with the right rims, the size they should have, unrolled as the formulas say.
#include "shapes.h"

#include <jali/check.h>
#include <jali/surface.h>
#include "base/file.h"
#include "mesh/topology.h"

#include <unistd.h>

static jali_surface made(const char *description)
{
    jali_surface surface;
    jali_status status = jali_surface_make(ctx, description, NULL, &surface);
    if (status != JALI_OK) print_error("%s: %s\n", description, jali_message(ctx));
    CHECK_INT(status, JALI_OK);
    return surface;
}

// Closed loops of open edges: 0 for a closed surface, 1 for a vessel, 2 for a tube.
static int32_t rims(const jali_mesh *mesh)
{
    int32_t *next = malloc((size_t)mesh->vertex_count * sizeof *next), loops = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) next[v] = -1;
    // A side whose opposite is not there. Quadratic, but only over sides that leave the same vertex by a
    // table.
    int32_t sides = 3 * mesh->triangle_count, *first = calloc((size_t)mesh->vertex_count + 1, sizeof *first);
    int32_t *side = malloc((size_t)sides * sizeof *side);
    for (int32_t h = 0; h < sides; h++) first[mesh->triangle[h / 3][h % 3] + 1]++;
    for (int32_t v = 0; v < mesh->vertex_count; v++) first[v + 1] += first[v];
    int32_t *at = malloc((size_t)mesh->vertex_count * sizeof *at);
    memcpy(at, first, (size_t)mesh->vertex_count * sizeof *at);
    for (int32_t h = 0; h < sides; h++) side[at[mesh->triangle[h / 3][h % 3]]++] = h;
    for (int32_t h = 0; h < sides; h++) {
        int32_t from = mesh->triangle[h / 3][h % 3], to = mesh->triangle[h / 3][(h + 1) % 3];
        bool paired = false;
        for (int32_t i = first[to]; i < first[to + 1]; i++)
            paired |= mesh->triangle[side[i] / 3][(side[i] + 1) % 3] == from;
        if (!paired) next[from] = to;
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (next[v] < 0) continue;
        loops++;
        for (int32_t w = v, after; w >= 0 && next[w] >= 0; w = after) {
            after = next[w];
            next[w] = -1;
        }
    }
    free(next);
    free(first);
    free(side);
    free(at);
    return loops;
}

static double edge_mm(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

// The longest edge over the height on it.
static double worst_aspect(const jali_mesh *mesh)
{
    double worst = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        double side[3], half = 0, longest = 0;
        for (int k = 0; k < 3; k++) {
            side[k] =
                edge_mm(mesh->vertex[mesh->triangle[t][k]], mesh->vertex[mesh->triangle[t][(k + 1) % 3]]);
            half += side[k] / 2;
            longest = MAX(longest, side[k]);
        }
        double area = sqrt(half * (half - side[0]) * (half - side[1]) * (half - side[2]));
        worst = MAX(worst, longest * longest / (2 * area));
    }
    return worst;
}

// The side of (uv) over the side of the surface, least and most over all edges that are unrolled.
static void stretch(const jali_surface *surface, double *least, double *most)
{
    *least = INFINITY;
    *most = 0;
    for (int32_t t = 0; t < surface->mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const double *a = surface->uv[t][k], *b = surface->uv[t][(k + 1) % 3];
            const int32_t *v = surface->mesh.triangle[t];
            if (isnan(a[0])) continue;
            double ratio = hypot(a[0] - b[0], a[1] - b[1]) /
                           edge_mm(surface->mesh.vertex[v[k]], surface->mesh.vertex[v[(k + 1) % 3]]);
            *least = MIN(*least, ratio);
            *most = MAX(*most, ratio);
        }
}

static const struct {
    const char *description;
    int32_t rims;
    double width_mm, height_mm, area_mm2; // 0: not known in closed form
    bool isometric;
} shapes_made[] = {
    {"plate:w=80,h=30", 1, 80, 30, 2400, true},
    {"cylinder:r=35,h=71", 2, 70, 71, 2 * M_PI * 35 * 71, true},
    {"cylinder:r=35,h=71,floor=yes", 1, 70, 71, 2 * M_PI * 35 * 71 + M_PI * 35 * 35, true},
    {"cylinder:r=4000,h=9000,tolerance=2", 2, 8000, 9000, 2 * M_PI * 4000 * 9000.0, true},
    {"cylinder:r=0.1,h=100", 2, 0.2, 100, 20 * M_PI, true},
    {"cone:r=50,top=20,h=60", 2, 100, 60, M_PI * 70 * 67.08203932499369, true},
    {"cone:r=50,top=0,h=60", 1, 100, 60, M_PI * 50 * 78.10249675906654, true},
    {"cone:r=20,top=50,h=60,floor=yes", 1, 100, 60, M_PI * 70 * 67.08203932499369 + M_PI * 400, true},
    {"cone:r=30,top=30,h=10", 2, 60, 10, 2 * M_PI * 300, true},
    {"cone:r=30,top=30.0001,h=10", 2, 60.0002, 10, 2 * M_PI * 300, true},
    {"sphere:r=40", 0, 80, 80, 4 * M_PI * 1600, false},
    {"sphere:r=40,facets=9", 0, 0, 80, 0, false},
    {"sphere:r=1000", 0, 2000, 2000, 4 * M_PI * 1e6, false},
    {"vase", 1, 114, 204, 0, false},
    {"vase:floor=no", 2, 114, 204, 0, false},
    {"vase:classic,h=102", 1, 57, 102, 0, false},
    {"vase:bottle,r=20,h=150", 1, 40, 150, 0, false},
    {"vase:bowl,r=100", 1, 200, 100, 0, false},
    {"vase:tulip,facets=37", 1, 0, 180, 0, false},
    {"vase:column,tolerance=0.005", 1, 92, 200, 0, false},
};

TEST(shapes_are_manifold_and_as_large_as_they_should_be)
{
    for (size_t i = 0; i < sizeof shapes_made / sizeof *shapes_made; i++) {
        jali_surface s = made(shapes_made[i].description);
        jali_check_report r;
        CHECK_OK(jali_check(ctx, &s.mesh, NULL, &r));
        double wide = r.high_mm[0] - r.low_mm[0], high = r.high_mm[2] - r.low_mm[2];
        double aspect = worst_aspect(&s.mesh), least, most;
        stretch(&s, &least, &most);
        print_message("%-36s %6d triangles, aspect %4.1f, stretch %.4f .. %.4f\n", shapes_made[i].description,
                      r.triangles, aspect, least, most);
        CHECK(r.manifold && r.clean && r.apart && r.misdirected_edges.count == 0 && r.coordinates_exact);
        CHECK_INT(r.shells, 1);
        CHECK_INT(rims(&s.mesh), shapes_made[i].rims);
        if (shapes_made[i].rims == 0) CHECK(r.solid);
        CHECK(r.low_mm[2] == 0);
        if (shapes_made[i].width_mm > 0)
            CHECK(fabs(wide - shapes_made[i].width_mm) < 3e-3 * shapes_made[i].width_mm);
        CHECK(fabs(high - shapes_made[i].height_mm) < 1e-6 * shapes_made[i].height_mm);
        CHECK(r.low_mm[0] == -r.high_mm[0]);
        if (shapes_made[i].area_mm2 > 0) CHECK(fabs(r.area_mm2 / shapes_made[i].area_mm2 - 1) < 0.01);
        CHECK(aspect < 25);
        if (shapes_made[i].isometric) CHECK(least > 0.999 && most < 1.011);
        jali_surface_free(ctx, &s);
    }
}

// Facets lie within the tolerance, on both sides of it nothing is wasted.
TEST(facets_keep_the_tolerance)
{
    static const double tolerance[] = {0.2, 0.02, 0.005};
    for (int i = 0; i < 3; i++) {
        jali_surface s;
        jali_surface_options opt = {.tolerance_mm = tolerance[i]};
        CHECK_OK(jali_surface_make(ctx, "sphere:r=50", &opt, &s));
        double deepest = 0;
        for (int32_t t = 0; t < s.mesh.triangle_count; t++)
            for (int k = 0; k < 3; k++) {
                const double *a = s.mesh.vertex[s.mesh.triangle[t][k]];
                const double *b = s.mesh.vertex[s.mesh.triangle[t][(k + 1) % 3]];
                double mid[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2 - 50};
                deepest = MAX(deepest, 50 - sqrt(mid[0] * mid[0] + mid[1] * mid[1] + mid[2] * mid[2]));
            }
        CHECK(deepest < 2.1 * tolerance[i] && deepest > 0.5 * tolerance[i]); // along and around add up
        jali_surface_free(ctx, &s);
    }
}

static void check_corners(const char *description, void (*expected)(const double at[3], double uv[2]))
{
    jali_surface s = made(description);
    for (int32_t t = 0; t < s.mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const double *at = s.mesh.vertex[s.mesh.triangle[t][k]];
            double wanted[2], u = s.uv[t][k][0];
            expected(at, wanted);
            if (at[0] == 0 && at[1] > 0 && u < 0) wanted[0] = -wanted[0]; // left of the seam
            CHECK(isnan(u) || (fabs(u - wanted[0]) < 1e-3 && fabs(s.uv[t][k][1] - wanted[1]) < 1e-3));
        }
    jali_surface_free(ctx, &s);
}

static void on_cylinder(const double at[3], double uv[2])
{
    uv[0] = atan2(at[0], -at[1]) * 25;
    uv[1] = at[2];
}

static void on_cone(const double at[3], double uv[2])
{
    const double slant = sqrt(60.0 * 60 + 30 * 30), sector = 30 / slant, from_apex = 50 / sector;
    double angle = atan2(at[0], -at[1]) * sector, apart = hypot(at[0], at[1]) / sector;
    uv[0] = apart * sin(angle);
    uv[1] = from_apex - apart * cos(angle);
}

static void on_funnel(const double at[3], double uv[2])
{
    const double slant = sqrt(60.0 * 60 + 30 * 30), sector = 30 / slant, from_apex = 20 / sector;
    double angle = atan2(at[0], -at[1]) * sector, apart = hypot(at[0], at[1]) / sector;
    uv[0] = apart * sin(angle);
    uv[1] = apart * cos(angle) - from_apex;
}

TEST(unrolled_corners_follow_the_formula)
{
    check_corners("cylinder:r=25,h=40,floor=yes", on_cylinder);
    check_corners("cone:r=50,top=20,h=60", on_cone);
    check_corners("cone:r=20,top=50,h=60", on_funnel);
}

// Once around in u, nothing but the seam leaps, all unrolled triangles turn the same way.
TEST(unrolled_triangles_do_not_turn_over)
{
    static const char *const shape[] = {"cylinder:r=25,h=40", "cone:r=50,top=0,h=60", "sphere:r=30",
                                        "vase:bottle"};
    for (int i = 0; i < 4; i++) {
        jali_surface s = made(shape[i]);
        for (int32_t t = 0; t < s.mesh.triangle_count; t++) {
            const double(*uv)[2] = (const double(*)[2])s.uv[t];
            double turn =
                (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) - (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]);
            CHECK(isnan(turn) || turn > 0);
            for (int k = 0; k < 3; k++)
                CHECK(isnan(turn) || s.around_mm == 0 || fabs(uv[k][0]) <= s.around_mm / 2 + 1e-9);
        }
        jali_surface_free(ctx, &s);
    }
}

TEST(what_a_description_must_not_say_is_refused)
{
    static const struct {
        const char *description, *sentence;
    } cases[] = {
        {"", "there are plate"},
        {"cub:r=3", "there is no surface \"cub\""},
        {"cylinder:r=0", "r must be 0.1 .. 10000, not 0"},
        {"cylinder:r=abc", "r=abc is not a number"},
        {"cylinder:r=nan", "is not a number"},
        {"cylinder:r=3mm", "is not a number"},
        {"cylinder:x=3", "cylinder does not take \"x\"; it takes r, h, facets, tolerance, floor"},
        {"cylinder:r=", "a value is missing"},
        {"cylinder:,", "a value is missing"},
        {"cylinder:=3", "a value is missing"},
        {"cylinder:floor=maybe", "there are no, yes"},
        {"cylinder:facets=7.5", "facets must be 8"},
        {"cylinder:facets=9.5", "whole number"},
        {"sphere:floor=yes", "sphere does not take \"floor\""},
        {"plate:floor=yes", "plate does not take"},
        {"vase:pot", "there are classic, bottle"},
        {"cone:top=0.01", "top must be 0 or at least"},
        {"vase:profile=/nonexistent/profile.txt", "No such file"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        jali_surface s;
        jali_status status = jali_surface_make(ctx, cases[i].description, NULL, &s);
        if (status == JALI_OK || !strstr(jali_message(ctx), cases[i].sentence))
            print_error("%s: %s\n", cases[i].description, jali_message(ctx));
        CHECK(status == JALI_BAD_VALUE || status == JALI_IO);
        CHECK(strstr(jali_message(ctx), cases[i].sentence) != NULL);
        CHECK(s.mesh.vertex == NULL && s.uv == NULL);
    }
}

static jali_status make_from_text(const char *text, const char *more, jali_surface *s)
{
    char path[] = "profile-XXXXXX", description[64];
    int file = mkstemp(path);
    CHECK(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
    close(file);
    snprintf(description, sizeof description, "vase:profile=%s%s", path, more);
    jali_status status = jali_surface_make(ctx, description, NULL, s);
    unlink(path);
    return status;
}

TEST(profiles_are_read_from_files)
{
    jali_surface s;
    jali_check_report r;
    // A prism's wall with sharp corners: straight lines only, so the area is known; given from the top down.
    CHECK_OK(make_from_text("# a drum\n30 50 # rim\n30 20\n30,20\r\n20\t0\n", "", &s));
    CHECK_OK(jali_check(ctx, &s.mesh, NULL, &r));
    double cone = M_PI * (30 + 20) * sqrt(100 + 400);
    CHECK(fabs(r.area_mm2 / (2 * M_PI * 30 * 30 + cone + M_PI * 400) - 1) < 2e-3);
    CHECK(r.high_mm[2] == 50 && rims(&s.mesh) == 1);
    jali_surface_free(ctx, &s);
    CHECK_OK(make_from_text("0 -5\n30 20\n0 40\n", "", &s)); // closed at both ends, moved to the ground
    CHECK_OK(jali_check(ctx, &s.mesh, NULL, &r));
    CHECK(r.solid && r.low_mm[2] == 0);
    jali_surface_free(ctx, &s);

    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"", "2 .. 1000 points, not 0"},
        {"3 4\n", "2 .. 1000 points, not 1"},
        {"3 4\n5\n", "line 2: a radius and a height"},
        {"3 4\n5 6 7\n", "line 2: more than"},
        {"3 4\nnan 6\n", "line 2"},
        {"3 4\n3 4\n", "the same"},
        {"3 4\n3 4\n3 4\n5 6\n", "more than twice"},
        {"30 0\n-1 20\n30 40\n", "meets the axis"},
        {"30 0\n0 20\n30 40\n", "meets the axis"},
        {"30 0\n30 0\n40 20\n40 20\n20 20\n20 20\n45 0\n45 0\n50 50\n", "crosses itself"},
        {"30 5\n40 0\n20 -10\n20 30\n", "crosses itself or its floor"},
        {"30 0\n30 0\n30 9\n30 9\n30 4\n30 4\n60 20\n", "crosses itself"},
        {"30 0\n40 0\n", "less than 0.1 mm high"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        jali_status status = make_from_text(cases[i].text, "", &s);
        if (status == JALI_OK || !strstr(jali_message(ctx), cases[i].sentence))
            print_error("case %zu: %s\n", i, jali_message(ctx));
        CHECK(status == JALI_BAD_VALUE || status == JALI_BAD_INPUT);
        CHECK(strstr(jali_message(ctx), cases[i].sentence) != NULL);
    }
}

TEST(every_listed_surface_can_be_made)
{
    int32_t count;
    const jali_surface_info *info = jali_surface_list(&count);
    CHECK(count >= 9);
    for (int32_t i = 0; i < count; i++) {
        if (strchr(info[i].name, '=')) continue;
        jali_surface s = made(info[i].name);
        jali_surface_free(ctx, &s);
    }
}

static jali_status make_again(jali_context *limited, void *data)
{
    jali_surface s;
    jali_status status = jali_surface_make(limited, data, NULL, &s);
    jali_surface_free(limited, &s);
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    refuse_each_allocation(make_again, (char[]){"vase:bowl,facets=16"});
    refuse_each_allocation(make_again, (char[]){"plate"});
    refuse_each_allocation(make_again, (char[]){"cone:floor=yes"});
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(shapes_are_manifold_and_as_large_as_they_should_be),
        RUN(facets_keep_the_tolerance),
        RUN(unrolled_corners_follow_the_formula),
        RUN(unrolled_triangles_do_not_turn_over),
        RUN(what_a_description_must_not_say_is_refused),
        RUN(profiles_are_read_from_files),
        RUN(every_listed_surface_can_be_made),
        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
