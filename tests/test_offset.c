// The inner skin: where the wall's thickness is known, and that nothing folds or meets where it is not.
#include "shapes.h"

#include <jali/check.h>
#include <jali/surface.h>
#include "mesh/offset.h"
#include "mesh/topology.h"

static const double unit_mm = 1.0 / 65536;

static bool *full_wanted; // by hollow, when it is set

typedef struct hollowed {
    jali_mesh outer, both; // both skins and the walls along rims
    double (*inner)[3];    // within both
    float *thickness;
    offset_report report;
    jali_check_report check;
} hollowed;

static jali_mesh with_walls(const jali_mesh *outer, const double (*inner)[3])
{
    int32_t count = outer->triangle_count, vertices = outer->vertex_count, next = 2 * count;
    topology_marks marks = {.twin = malloc(3 * (size_t)count * sizeof *marks.twin),
                            .crowded = malloc((size_t)vertices * sizeof *marks.crowded)};
    topology t;
    jali_mesh both;
    CHECK_OK(topology_mark(ctx, vertices, count, (const int32_t(*)[3])outer->triangle, &marks, &t));
    CHECK_OK(mesh_create(ctx, 2 * vertices, 2 * count + 2 * (int32_t)t.open_edges.count, &both));
    memcpy(both.vertex, outer->vertex, (size_t)vertices * sizeof *both.vertex);
    memcpy(both.vertex + vertices, inner, (size_t)vertices * sizeof *both.vertex);
    for (int32_t side = 0; side < 3 * count; side++) {
        int32_t a = outer->triangle[side / 3][side % 3], b = outer->triangle[side / 3][(side + 1) % 3];
        both.triangle[side / 3][side % 3] = a;
        both.triangle[count + side / 3][2 - side % 3] = a + vertices;
        if (marks.twin[side] != TWIN_OPEN) continue;
        memcpy(both.triangle[next++], (int32_t[3]){a + vertices, b + vertices, a}, sizeof *both.triangle);
        memcpy(both.triangle[next++], (int32_t[3]){a, b + vertices, b}, sizeof *both.triangle);
    }
    topology_free(ctx, &t);
    free(marks.twin);
    free(marks.crowded);
    return both;
}

static hollowed hollow(jali_mesh outer, double thickness_mm)
{
    hollowed h = {.outer = outer};
    const offset_options opt = {.thickness_mm = thickness_mm, .least_mm = 0.3, .unit_mm = unit_mm};
    for (int32_t v = 0; v < outer.vertex_count; v++)
        for (int k = 0; k < 3; k++) outer.vertex[v][k] = rint(outer.vertex[v][k] / unit_mm) * unit_mm;
    double(*inner)[3] = malloc((size_t)outer.vertex_count * sizeof *inner);
    h.thickness = malloc((size_t)outer.vertex_count * sizeof *h.thickness);
    CHECK_OK(offset_inward(ctx, &outer, &opt, inner, h.thickness, full_wanted, &h.report));
    h.both = with_walls(&outer, (const double(*)[3])inner);
    h.inner = h.both.vertex + outer.vertex_count;
    free(inner);
    CHECK_OK(jali_check(ctx, &h.both, NULL, &h.check));
    CHECK(h.check.coordinates_exact && h.check.unit_log2 >= -16);
    return h;
}

static void forget(hollowed *h)
{
    jali_mesh_free(ctx, &h->outer);
    jali_mesh_free(ctx, &h->both);
    free(h->thickness);
}

static hollowed hollow_surface(const char *description, double thickness_mm)
{
    jali_surface s;
    CHECK_OK(jali_surface_open(ctx, description, NULL, &s, NULL));
    release(ctx, s.uv);
    return hollow(s.mesh, thickness_mm);
}

TEST(a_box_has_a_box_within)
{
    hollowed h = hollow(box_shape(0, 0, 0, 10, 20, 30), 2);
    for (int32_t v = 0; v < 8; v++) {
        for (int k = 0; k < 3; k++) {
            double wanted = h.outer.vertex[v][k] > 0 ? h.outer.vertex[v][k] - 2 : 2;
            CHECK(fabs(h.inner[v][k] - wanted) < 1e-3);
        }
        CHECK(fabs(h.thickness[v] - 2) < 1e-3);
    }
    CHECK(h.check.solid && h.check.voids == 1 && h.report.thinned == 0);
    forget(&h);
}

TEST(a_sphere_has_a_sphere_within)
{
    static const double thickness[] = {0.5, 2, 10, 30};
    for (int i = 0; i < 4; i++) {
        hollowed h = hollow_surface("sphere:r=40", thickness[i]);
        for (int32_t v = 0; v < h.outer.vertex_count; v++) {
            const double *p = h.inner[v];
            double radius = sqrt(p[0] * p[0] + p[1] * p[1] + (p[2] - 40) * (p[2] - 40));
            double wanted = 40 - MIN(thickness[i], h.thickness[v]);
            CHECK(fabs(radius - wanted) < 0.01 * thickness[i]);
        }
        CHECK(h.check.solid && h.check.voids == 1);
        CHECK(thickness[i] > 20 || h.report.thinned == 0);
        forget(&h);
    }
}

TEST(a_vessel_keeps_a_flat_rim)
{
    hollowed h = hollow_surface("cylinder:r=35,h=70,floor=yes", 2);
    CHECK(h.check.solid && h.check.genus == 0 && h.check.pieces == 1 && h.report.thinned == 0);
    for (int32_t v = 0; v < h.outer.vertex_count; v++) {
        const double *at = h.outer.vertex[v], *in = h.inner[v];
        if (at[2] == 70) CHECK(in[2] == 70);
        if (at[2] == 0) CHECK(fabs(in[2] - 2) < 2e-3);
        if (hypot(at[0], at[1]) > 34.9) CHECK(fabs(hypot(in[0], in[1]) - 33) < 0.01);
    }
    forget(&h);
    h = hollow_surface("cylinder", 3); // two rims
    CHECK(h.check.solid && h.check.genus == 1 && h.report.thinned == 0);
    for (int32_t v = 0; v < h.outer.vertex_count; v++)
        if (h.outer.vertex[v][2] == 0 || h.outer.vertex[v][2] == 70)
            CHECK(h.inner[v][2] == h.outer.vertex[v][2]);
    forget(&h);
    h = hollow_surface("plate:w=50,h=20", 4); // its rim lies in its own plane: a slab
    CHECK(h.check.solid && h.check.volume_mm3 == 50 * 20 * 4);
    forget(&h);
}

// A ring of vertices on the lid, nearer to its edge than the wall is thick, makes room.
TEST(vertices_beside_a_crease_make_room)
{
    enum { AROUND = 48 };
    static const double ring[4][2] = {{20, 0}, {20, 30}, {19, 30}, {18.3, 30}}; // radius, height
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, 4 * AROUND + 2, 8 * AROUND, &mesh));
    int32_t bottom = 4 * AROUND, top = bottom + 1, t = 0;
    for (int32_t i = 0; i < AROUND; i++) {
        int32_t j = (i + 1) % AROUND;
        for (int32_t r = 0; r < 4; r++) {
            double angle = 2 * M_PI * i / AROUND;
            double at[3] = {ring[r][0] * cos(angle), ring[r][0] * sin(angle), ring[r][1]};
            memcpy(mesh.vertex[r * AROUND + i], at, sizeof at);
            if (r == 3) continue;
            int32_t a = r * AROUND + i, b = r * AROUND + j, c = a + AROUND, d = b + AROUND;
            memcpy(mesh.triangle[t++], (int32_t[3]){a, b, d}, sizeof *mesh.triangle);
            memcpy(mesh.triangle[t++], (int32_t[3]){a, d, c}, sizeof *mesh.triangle);
        }
        memcpy(mesh.triangle[t++], (int32_t[3]){j, i, bottom}, sizeof *mesh.triangle);
        memcpy(mesh.triangle[t++], (int32_t[3]){3 * AROUND + i, 3 * AROUND + j, top}, sizeof *mesh.triangle);
    }
    memcpy(mesh.vertex[bottom], (double[3]){0, 0, 0}, sizeof *mesh.vertex);
    memcpy(mesh.vertex[top], (double[3]){0, 0, 30}, sizeof *mesh.vertex);
    hollowed h = hollow(mesh, 2.5);
    CHECK(h.check.solid && h.check.voids == 1);
    CHECK_INT(h.report.thinned, 0);
    CHECK(h.report.thinnest_mm > 2.45);
    for (int32_t v = AROUND; v < 4 * AROUND; v++) CHECK(fabs(h.inner[v][2] - 27.5) < 0.01);
    forget(&h);
}

static void check_grading(const hollowed *h)
{
    for (int32_t side = 0; side < 3 * h->outer.triangle_count; side++) {
        int32_t a = h->outer.triangle[side / 3][side % 3], b = h->outer.triangle[side / 3][(side + 1) % 3];
        double length = 0;
        for (int k = 0; k < 3; k++) length += pow(h->outer.vertex[a][k] - h->outer.vertex[b][k], 2);
        // Of what is asked for; at a spike the faces keep less of it.
        CHECK(fabs(h->thickness[a] - h->thickness[b]) < 0.5 * sqrt(length) + 0.6);
    }
}

TEST(where_the_object_is_thin_so_is_the_wall)
{
    hollowed h = hollow(box_shape(0, 0, 0, 20, 20, 1.5), 2);
    CHECK(h.check.solid && h.check.voids == 1);
    CHECK(h.report.thinnest_mm > 0.3 && h.report.thinnest_mm < 0.75);
    CHECK_INT(h.report.thinned, 8);
    forget(&h);
    static const char *const narrow[] = {"cone:r=3,top=0,h=40,floor=yes", "sphere:r=2.5", "cylinder:r=1,h=30",
                                         "vase:bottle,r=9,h=50"};
    for (int i = 0; i < 4; i++) {
        h = hollow_surface(narrow[i], 3);
        CHECK(h.check.solid && h.report.thinned > 0 && h.report.unsolved_triangles == 0);
        CHECK(h.report.thinnest_mm > 0.1 && h.report.thinnest_mm < 3);
        check_grading(&h);
        forget(&h);
    }
}

// Balls with bumps of all sizes: when the report says that nothing folds or meets, the exact check agrees.
TEST(what_is_called_solved_is_a_solid)
{
    int32_t solved = 0;
    for (uint64_t seed = 1; seed <= 24; seed++) {
        uint64_t random = seed * 7919;
        jali_surface s;
        CHECK_OK(jali_surface_open(ctx, "sphere:r=20,tolerance=0.2", NULL, &s, NULL));
        double wave[6][4];
        for (int w = 0; w < 6; w++)
            for (int k = 0; k < 4; k++)
                wave[w][k] = ((double)(next_random(&random) >> 40) / (1 << 24) - 0.5) * (w + 1);
        for (int32_t v = 0; v < s.mesh.vertex_count; v++) {
            double *p = s.mesh.vertex[v], grow = 1;
            for (int w = 0; w < 6; w++)
                grow += 0.08 * sin(wave[w][0] * p[0] + wave[w][1] * p[1] + wave[w][2] * (p[2] - 20) +
                                   9 * wave[w][3]);
            for (int k = 0; k < 3; k++) p[k] = (p[k] - (k == 2 ? 20 : 0)) * grow;
        }
        release(ctx, s.uv);
        hollowed h = hollow(s.mesh, 1 + (double)(seed % 4));
        CHECK(h.check.solid || h.report.unsolved_triangles > 0);
        solved += h.report.unsolved_triangles == 0;
        forget(&h);
    }
    print_message("%d of 24 solved\n", solved);
    CHECK(solved >= 12);
}

// Spikes as close as the wall is thick: no wall will do there, and a full one does. Far from them all is as
// ever.
TEST(where_no_wall_will_do_it_is_left_full)
{
    int32_t filled = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        uint64_t random = seed;
        jali_surface s;
        CHECK_OK(jali_surface_open(ctx, "sphere:r=30,facets=96", NULL, &s, NULL));
        for (int32_t v = 0; v < s.mesh.vertex_count; v++) {
            double *p = s.mesh.vertex[v];
            bool crumpled = p[1] > 26;
            for (int k = 0; k < 3 && crumpled; k++)
                p[k] += 1.9 * ((double)(next_random(&random) >> 40) / (1 << 24) - 0.5);
        }
        jali_check_report before;
        CHECK_OK(jali_check(ctx, &s.mesh, NULL, &before));
        release(ctx, s.uv);
        bool *full = malloc((size_t)s.mesh.triangle_count * sizeof *full);
        full_wanted = full;
        hollowed h = hollow(s.mesh, 2);
        CHECK(!before.solid || (h.check.solid && h.check.voids == 1 && h.report.unsolved_triangles == 0));
        CHECK(h.check.volume_mm3 > 4.0 / 3 * M_PI * (30 * 30 * 30 - 28 * 28 * 28) * 0.95);
        int32_t count = 0;
        for (int32_t t = 0; t < h.outer.triangle_count; t++) {
            count += full[t];
            CHECK(!full[t] || h.outer.vertex[h.outer.triangle[t][0]][1] > 15);
        }
        for (int32_t v = 0; v < h.outer.vertex_count; v++)
            CHECK(h.outer.vertex[v][1] > 0 || fabs(h.thickness[v] - 2) < 0.02);
        CHECK_INT(count, h.report.full_triangles);
        filled += before.solid && count > 0;
        full_wanted = NULL;
        free(full);
        forget(&h);
    }
    print_message("%d of 12 left full in part\n", filled);
    CHECK(filled >= 2);
}

TEST(faults_of_the_surface_itself_are_left_alone)
{
    hollowed h = hollow(together(box_shape(0, 0, 0, 30, 30, 30), box_shape(20, 10, 25, 25, 20, 60)), 1);
    CHECK(!h.check.solid);
    CHECK(h.report.rounds <= 31);
    forget(&h);
}

static void offset_with(jali_context *other, const jali_mesh *mesh, double (*inner)[3])
{
    offset_report report;
    const offset_options opt = {.thickness_mm = 3, .least_mm = 0.3, .unit_mm = unit_mm};
    CHECK_INT(offset_inward(other, mesh, &opt, inner, NULL, NULL, &report), JALI_OK);
}

TEST(the_same_for_any_number_of_threads)
{
    jali_context *by_threads[3];
    jali_surface s;
    open_thread_contexts(by_threads);
    CHECK_OK(jali_surface_open(ctx, "vase:bottle,r=12,h=60", NULL, &s, NULL));
    size_t size = (size_t)s.mesh.vertex_count * sizeof *s.mesh.vertex;
    double(*first)[3] = malloc(size), (*again)[3] = malloc(size);
    offset_with(by_threads[0], &s.mesh, first);
    for (int i = 1; i < 3; i++) {
        offset_with(by_threads[i], &s.mesh, again);
        CHECK(memcmp(first, again, size) == 0);
    }
    free(first);
    free(again);
    jali_surface_free(ctx, &s);
    close_thread_contexts(by_threads);
}

static jali_status offset_again(jali_context *limited, void *data)
{
    const jali_mesh *mesh = data;
    double inner[64][3];
    offset_report report;
    return offset_inward(limited, mesh, &(offset_options){2, 0.3, NULL, unit_mm}, inner, NULL, NULL, &report);
}

TEST(every_refused_allocation_is_a_status)
{
    jali_mesh mesh = together(box_shape(0, 0, 0, 9, 9, 9), box_shape(5, 5, 5, 19, 19, 19));
    refuse_each_allocation(offset_again, &mesh);
    mesh.triangle_count -= 2;
    refuse_each_allocation(offset_again, &mesh);
    jali_mesh_free(ctx, &mesh);
}

TEST(real_meshes_are_hollowed)
{
    static const struct {
        const char *description;
        double thickness_mm, thinnest_mm;
        int32_t thinned;
    } known[] = {{"bunny-small.obj:up=y,scale=145.2", 2, 1.7, 50},
                 {"spot.obj:up=y,scale=100", 2, 0.4, 150},
                 {"vase.obj:up=-y,height=326", 2, 1, 1500},
                 {"cylinder.stl:scale=10", 2, 1.9, 0},
                 {"sphere.obj:scale=40", 2, 1.9, 0},
                 {"bad-degenerate.obj:scale=30", 2, 1.9, 0}};
    const char *data = getenv("JALI_DATA");
    int32_t skipped = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char description[4096];
        jali_surface s;
        snprintf(description, sizeof description, "%s/meshes/%s", data ? data : "/nonexistent",
                 known[i].description);
        if (jali_surface_open(ctx, description, NULL, &s, NULL) == JALI_IO) {
            skipped++;
            continue;
        }
        release(ctx, s.uv);
        hollowed h = hollow(s.mesh, known[i].thickness_mm);
        CHECK(h.check.solid && h.check.voids == 1 && h.report.unsolved_triangles == 0);
        CHECK(h.report.thinnest_mm > known[i].thinnest_mm && h.report.thinned <= known[i].thinned);
        forget(&h);
    }
    if (skipped) print_message("%d of 6 meshes not there: skipped\n", skipped);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(a_box_has_a_box_within),
        RUN(a_sphere_has_a_sphere_within),
        RUN(a_vessel_keeps_a_flat_rim),
        RUN(vertices_beside_a_crease_make_room),
        RUN(where_the_object_is_thin_so_is_the_wall),
        RUN(what_is_called_solved_is_a_solid),
        RUN(where_no_wall_will_do_it_is_left_full),
        RUN(faults_of_the_surface_itself_are_left_alone),
        RUN(the_same_for_any_number_of_threads),
        RUN(every_refused_allocation_is_a_status),
        RUN(real_meshes_are_hollowed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
