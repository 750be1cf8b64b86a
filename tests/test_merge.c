// Parts that cross are made one: what the union measures, that it is a solid, and what cannot be told.
#include "shapes.h"

#include <jali/check.h>
#include "mesh/mend.h"
#include "mesh/merge.h"

static uint64_t random_below(uint64_t *state, uint64_t end)
{
    return (next_random(state) >> 20) % end;
}

typedef struct outcome {
    merging merged;
    jali_surface_report report; // of the merged mesh, mended
    jali_check_report check;
} outcome;

// Merge until nothing meets; frees the mesh.
static outcome merged(jali_mesh mesh, double (*uv)[3][2])
{
    outcome o = {0};
    bool *marked = calloc((size_t)mesh.triangle_count + 1, sizeof *marked);
    mesh_round(&mesh);
    for (int32_t round = 0; round < 6; round++) {
        merging next;
        CHECK_OK(merge_crossings(ctx, &mesh, (const double(*)[3][2])uv, marked, round, &next));
        if (!next.done) continue;
        jali_surface_report_free(ctx, &o.report);
        o.report = (jali_surface_report){0};
        CHECK_OK(mend(ctx, &next.mesh, next.uv, next.faulty, &o.report));
        merging_free(ctx, &o.merged);
        o.merged = next;
        if (o.report.intersections.count == 0) break;
    }
    CHECK_OK(jali_check(ctx, &o.merged.mesh, NULL, &o.check));
    jali_mesh_free(ctx, &mesh);
    free(marked);
    return o;
}

static void forget(outcome *o)
{
    jali_surface_report_free(ctx, &o->report);
    merging_free(ctx, &o->merged);
}

TEST(two_boxes_become_one)
{
    outcome o = merged(together(box_shape(0, 0, 0, 30, 30, 30), box_shape(10, 11, 12, 25, 45, 20)), NULL);
    CHECK(o.check.solid && o.check.pieces == 1 && o.check.shells == 1 && o.check.genus == 0);
    CHECK(fabs(o.check.volume_mm3 - (27000 + 15 * 15 * 8)) < 1);
    forget(&o);
    // A bar through a box; a box through a ring.
    o = merged(together(box_shape(0, 0, 0, 30, 30, 30), box_shape(-10, 11, 12, 45, 19, 20)), NULL);
    CHECK(o.check.solid && o.check.genus == 0 && fabs(o.check.volume_mm3 - (27000 + 25 * 64)) < 1);
    forget(&o);
    o = merged(together(torus(40, 20), box_shape(-0.3, -5, -0.4, 0.5, 5, 0.3)), NULL);
    CHECK(o.check.solid && o.check.pieces == 1 && o.check.genus == 2);
    forget(&o);
}

TEST(faces_in_one_plane_and_faces_that_touch)
{
    static const double other[][6] = {
        {10, 10, 0, 20, 50, 20}, // on the same ground
        {10, 30, 5, 20, 50, 20}, // against a side
        {0, 10, 0, 30, 50, 20},  // in the planes of both sides and the ground
        {5, 5, 30, 25, 25, 40},  // standing on it
        {-5, -5, 0, 35, 35, 10}, // a plinth around it
    };
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        const double *b = other[i], box[6] = {0, 0, 0, 30, 30, 30};
        outcome o = merged(
            together(box_shape(0, 0, 0, 30, 30, 30), box_shape(b[0], b[1], b[2], b[3], b[4], b[5])), NULL);
        double volume = 27000 + (b[3] - b[0]) * (b[4] - b[1]) * (b[5] - b[2]), common = 1;
        for (int k = 0; k < 3; k++) common *= MIN(box[3 + k], b[3 + k]) - MAX(box[k], b[k]);
        CHECK(o.check.solid && o.check.pieces == 1);
        CHECK(fabs(o.check.volume_mm3 - (volume - common)) < 3);
        CHECK(o.check.low_mm[2] == 0);
        forget(&o);
    }
}

static double common_volume(const double a[6], const double b[6], double c[6])
{
    double volume = 1;
    for (int k = 0; k < 3; k++) {
        c[k] = MAX(a[k], b[k]);
        c[3 + k] = MAX(MIN(a[3 + k], b[3 + k]), c[k]);
        volume *= c[3 + k] - c[k];
    }
    return volume;
}

// Three boxes on a lattice of whole mm, so that planes and edges coincide often: inclusion and exclusion.
TEST(random_boxes_measure_what_their_union_does)
{
    int32_t solid = 0, wrong = 0;
    enum { SEEDS = 150 };
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        uint64_t random = seed;
        double box[3][6], c[6], d[6], volume = 0;
        jali_mesh mesh = {0};
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++) {
                box[i][k] = (double)random_below(&random, 12);
                box[i][3 + k] = box[i][k] + 3 + (double)random_below(&random, 9);
            }
            jali_mesh one = box_shape(box[i][0], box[i][1], box[i][2], box[i][3], box[i][4], box[i][5]);
            mesh = i ? together(mesh, one) : one;
            volume += common_volume(box[i], box[i], c);
        }
        for (int i = 0; i < 3; i++) volume -= common_volume(box[i], box[(i + 1) % 3], c);
        common_volume(box[0], box[1], c);
        volume += common_volume(c, box[2], d);
        outcome o = merged(mesh, NULL);
        solid += o.check.solid;
        wrong += o.check.solid && fabs(o.check.volume_mm3 - volume) > 1 + 0.002 * volume;
        forget(&o);
    }
    print_message("%d of %d are solids\n", solid, SEEDS);
    CHECK(solid >= SEEDS * 9 / 10);
    CHECK_INT(wrong, 0);
}

TEST(a_crumpled_ring_becomes_a_solid)
{
    int32_t solid = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        uint64_t random = seed;
        jali_mesh mesh = torus(48, 24);
        for (int32_t v = 0; v < mesh.vertex_count; v++)
            for (int k = 0; k < 3; k++)
                if (mesh.vertex[v][0] > 2.5)
                    mesh.vertex[v][k] += 0.35 * ((double)random_below(&random, 2001) / 1000 - 1);
        outcome o = merged(mesh, NULL);
        solid += o.check.solid;
        CHECK(!o.check.solid || (o.check.volume_mm3 > 50 && o.check.volume_mm3 < 70));
        forget(&o);
    }
    print_message("%d of 20 are solids\n", solid);
    CHECK(solid >= 16);
}

// Far from the line nothing moves; texture points follow; triangles on the line are faulty, others are not.
TEST(what_does_not_cross_stays_as_it_is)
{
    jali_mesh mesh = together(box_shape(0, 0, 0, 30, 30, 30), box_shape(10, 11, 12, 25, 45, 20));
    double uv[24][3][2];
    for (int32_t t = 0; t < 24; t++)
        for (int c = 0; c < 3; c++) {
            const double *p = mesh.vertex[mesh.triangle[t][c]];
            uv[t][c][0] = p[0] + 2 * p[2];
            uv[t][c][1] = p[1] - p[2];
        }
    outcome o = merged(mesh, uv);
    CHECK(o.check.solid);
    int32_t faulty = 0;
    for (int32_t t = 0; t < o.merged.mesh.triangle_count; t++) {
        faulty += o.report.faulty[t];
        CHECK(o.report.faulty[t] == o.merged.faulty[t]);
        for (int c = 0; c < 3; c++) {
            const double *p = o.merged.mesh.vertex[o.merged.mesh.triangle[t][c]];
            CHECK(fabs(o.merged.uv[t][c][0] - p[0] - 2 * p[2]) < 0.2);
            CHECK(fabs(o.merged.uv[t][c][1] - p[1] + p[2]) < 0.2);
        }
    }
    CHECK(faulty >= 8 && faulty < o.merged.mesh.triangle_count);
    forget(&o);

    jali_mesh ring = torus(48, 24);
    mesh_round(&ring);
    double far[48 * 24][3];
    memcpy(far, ring.vertex, sizeof far);
    o = merged(together(ring, box_shape(2.5, -0.4, -3, 3.6, 0.5, 3)), NULL);
    CHECK(o.check.solid);
    for (int32_t i = 0; i < 48 * 24; i++) {
        if (far[i][0] > 1.5) continue;
        bool there = false;
        for (int32_t v = 0; v < o.merged.mesh.vertex_count && !there; v++)
            there = memcmp(far[i], o.merged.mesh.vertex[v], sizeof far[i]) == 0;
        CHECK(there);
    }
    forget(&o);
}

TEST(where_a_rim_leaves_open_what_is_inside_nothing_is_done)
{
    jali_mesh sheet = box_shape(10, 10, 10, 50, 20, 20), mesh;
    sheet.triangle_count = 2; // its bottom alone: its rim runs within the box
    mesh = together(box_shape(0, 0, 0, 30, 30, 30), sheet);
    bool marked[14] = {false};
    merging result;
    mesh_round(&mesh);
    for (int32_t round = 0; round < 3; round++) {
        CHECK_OK(merge_crossings(ctx, &mesh, NULL, marked, round, &result));
        CHECK(!result.done && result.mesh.vertex == NULL && result.faulty == NULL);
    }
    jali_mesh_free(ctx, &mesh);
}

static jali_status merge_again(jali_context *limited, void *data)
{
    merging result;
    bool marked[24] = {false};
    jali_status status = merge_crossings(limited, data, NULL, marked, 0, &result);
    CHECK(status != JALI_OK || result.done);
    merging_free(limited, &result);
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    jali_mesh mesh = together(box_shape(0, 0, 0, 9, 9, 9), box_shape(5, 4, 3, 19, 19, 19));
    refuse_each_allocation(merge_again, &mesh);
    jali_mesh_free(ctx, &mesh);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(two_boxes_become_one),
        RUN(faces_in_one_plane_and_faces_that_touch),
        RUN(random_boxes_measure_what_their_union_does),
        RUN(a_crumpled_ring_becomes_a_solid),
        RUN(what_does_not_cross_stays_as_it_is),
        RUN(where_a_rim_leaves_open_what_is_inside_nothing_is_done),
        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
