// Triangulations against their definition: a closed sphere of counter-clockwise triangles, every free side
// locally Delaunay, every constrained edge present.
#include "testing.h"

#include "plane/exact.h"
#include "plane/snap.h"
#include "plane/triangulation.h"

static void check_plane(const triangulation *plane)
{
    int32_t stored = 0;
    for (int32_t p = 0; p < plane->point_count; p++) {
        stored += plane->twin[p] == p;
        if (plane->twin[p] != p || plane->triangle_count == 0) continue;
        const int32_t *corner = plane->corner + 4 * plane->star[p];
        CHECK(corner[0] == p || corner[1] == p || corner[2] == p);
    }
    if (plane->triangle_count > 0) CHECK_INT(plane->triangle_count, 2 * stored - 2);
    for (int32_t s = 0; s < 4 * plane->triangle_count; s++) {
        if ((s & 3) == 3) continue;
        int32_t o = plane->beside[s];
        CHECK_INT(plane->beside[o], s);
        CHECK_INT(plane->kind[o], plane->kind[s]);
        CHECK_INT(plane->corner[next_side(s)], plane->corner[last_side(o)]);
        CHECK_INT(plane->corner[last_side(s)], plane->corner[next_side(o)]);
        bool ghost = is_ghost(plane, s >> 2);
        if ((s & 3) == 0 && !ghost)
            CHECK(orientation(plane->point[plane->corner[s]], plane->point[plane->corner[s + 1]],
                              plane->point[plane->corner[s + 2]]) > 0);
        if (plane->kind[s] == 0 && plane->corner[s] != GHOST && (!ghost || is_ghost(plane, o >> 2)))
            CHECK(!in_disc(plane, o >> 2, plane->corner[s]));
    }
}

static void check_edge(const triangulation *plane, int32_t a, int32_t b)
{
    bool found = false;
    for (int32_t s = 0; s < 4 * plane->triangle_count && !found; s++)
        found = (s & 3) != 3 && plane->corner[next_side(s)] == a && plane->corner[last_side(s)] == b &&
                plane->kind[s] == EDGE_CONTOUR;
    CHECK(found);
}

static void check_points(const int32_t (*point)[2], int32_t count)
{
    triangulation plane = {0};
    CHECK_OK(insert_points(ctx, &plane, point, count));
    check_plane(&plane);
    triangulation_free(ctx, &plane);
}

TEST(grids_circles_lines_and_twins)
{
    static int32_t point[4000][2];
    int32_t n = 0;
    for (int32_t y = 0; y < 50; y++)
        for (int32_t x = 0; x < 60; x++, n++) point[n][0] = x * 7, point[n][1] = y * 7;
    check_points(point, n);
    n = 0; // every lattice point of the circle of radius 5^4 * 13 * 17: all cocircular
    int64_t r = 5 * 5 * 5 * 13 * 17, r2 = r * r;
    for (int64_t x = -r; x <= r; x++) {
        int64_t y = (int64_t)(sqrt((double)(r2 - x * x)) + 0.5);
        if (x * x + y * y != r2) continue;
        point[n][0] = (int32_t)x, point[n++][1] = (int32_t)y;
        if (y > 0) point[n][0] = (int32_t)x, point[n++][1] = (int32_t)-y;
    }
    CHECK(n > 100);
    check_points(point, n);
    for (n = 0; n < 300; n++) point[n][0] = (n * 37) % 300, point[n][1] = 2 * point[n][0];
    check_points(point, n); // one line: no triangles
    point[n][0] = 5, point[n++][1] = 11;
    check_points(point, n);
    for (n = 0; n < 1000; n++) point[n][0] = n % 10, point[n][1] = n / 10 % 10; // each ten times
    check_points(point, n);
    int32_t far[5][2] = {{-COORDINATE_LIMIT, -COORDINATE_LIMIT},
                         {COORDINATE_LIMIT, -COORDINATE_LIMIT},
                         {COORDINATE_LIMIT, COORDINATE_LIMIT},
                         {-COORDINATE_LIMIT, COORDINATE_LIMIT},
                         {1, 0}};
    check_points(far, 5);
    check_points(far, 0);
    check_points(far, 2);
}

TEST(random_points_on_all_scales)
{
    static int32_t point[3000][2];
    for (uint64_t seed = 1; seed < 40; seed++) {
        uint64_t random = seed;
        int32_t span = 1 << (2 + seed % 23), count = (int32_t)(next_random(&random) >> 40) % 2000 + 1;
        for (int32_t i = 0; i < count; i++)
            for (int k = 0; k < 2; k++) point[i][k] = (int32_t)(next_random(&random) >> 32) % span;
        check_points(point, count);
    }
}

// A star-shaped polygon has no crossings; the edges between its random radii cross many Delaunay edges.
TEST(constrained_edges_are_kept_and_the_rest_is_delaunay)
{
    static int32_t point[2400][2], edge[1200][2];
    for (uint64_t seed = 1; seed < 30; seed++) {
        uint64_t random = seed;
        int32_t corners = 3 + (int32_t)(next_random(&random) >> 40) % 600, count = corners;
        for (int32_t i = 0; i < corners; i++) {
            double radius = 100 + (double)(next_random(&random) >> 44), angle = 2 * M_PI * i / corners;
            point[i][0] = (int32_t)(radius * cos(angle)), point[i][1] = (int32_t)(radius * sin(angle));
            edge[i][0] = i, edge[i][1] = (i + 1) % corners;
        }
        for (int32_t i = 0; i < 300; i++, count++)
            for (int k = 0; k < 2; k++) point[count][k] = (int32_t)(next_random(&random) >> 43) - (1 << 20);
        triangulation plane = {0};
        contact met;
        CHECK_OK(insert_points(ctx, &plane, point, count));
        CHECK_OK(insert_edges(ctx, &plane, edge, corners, EDGE_CONTOUR, true, &met));
        CHECK_INT(met.found, NO_CONTACT);
        check_plane(&plane);
        if (corners < 100)
            for (int32_t i = 0; i < corners; i++) check_edge(&plane, edge[i][0], edge[i][1]);
        uint8_t *tone;
        CHECK_OK(ALLOCATE(ctx, tone, plane.triangle_count));
        CHECK_OK(label_tones(ctx, &plane, EDGE_CONTOUR, tone));
        int64_t inside = 0, area = 0;
        for (int32_t t = 0; t < plane.triangle_count; t++)
            if (tone[t])
                inside += orientation(plane.point[plane.corner[4 * t]], plane.point[plane.corner[4 * t + 1]],
                                      plane.point[plane.corner[4 * t + 2]]);
        for (int32_t i = 0; i < corners; i++) {
            const int32_t *p = point[edge[i][0]], *q = point[edge[i][1]];
            area += (int64_t)p[0] * q[1] - (int64_t)p[1] * q[0];
        }
        CHECK_INT(inside, area);
        // More points later: constrained edges survive, halves included.
        CHECK_OK(insert_points(ctx, &plane, (int32_t[4][2]){{1, 1}, {5000, 7}, {-9, 80}, {-2000000, 3}}, 4));
        check_plane(&plane);
        release(ctx, tone);
        triangulation_free(ctx, &plane);
    }
}

TEST(long_edges_through_random_points)
{
    static int32_t point[1502][2];
    uint64_t random = 7;
    for (int32_t i = 0; i < 1500; i++)
        for (int k = 0; k < 2; k++) point[i][k] = (int32_t)(next_random(&random) >> 44);
    point[1500][0] = -5, point[1500][1] = 11, point[1501][0] = 1 << 21, point[1501][1] = 1 << 20;
    for (int32_t i = 0; i < 200; i++) {
        triangulation plane = {0};
        contact met;
        int32_t edge[2] = {i < 199 ? i : 1500, i < 199 ? 500 + i * 3 : 1501};
        CHECK_OK(insert_points(ctx, &plane, point, 1502));
        CHECK_OK(insert_edges(ctx, &plane, &edge, 1, EDGE_CONTOUR, true, &met));
        CHECK_INT(met.found, NO_CONTACT);
        check_plane(&plane);
        check_edge(&plane, edge[0], edge[1]);
        triangulation_free(ctx, &plane);
    }
}

TEST(contacts_are_reported_with_their_edges)
{
    int32_t point[6][2] = {{0, 0}, {10, 10}, {0, 10}, {10, 0}, {20, 20}, {30, 0}};
    int32_t cross[2][2] = {{0, 1}, {2, 3}}, over[1][2] = {{0, 4}};
    triangulation plane = {0};
    contact met;
    CHECK_OK(insert_points(ctx, &plane, point, 6));
    CHECK_OK(insert_edges(ctx, &plane, cross, 2, EDGE_CONTOUR, false, &met));
    CHECK_INT(met.found, EDGES_CROSS);
    CHECK_INT(met.from, 2);
    CHECK_INT(met.other[0] + met.other[1], 1);
    CHECK_OK(insert_edges(ctx, &plane, over, 1, EDGE_CONTOUR, false, &met));
    CHECK_INT(met.found, EDGE_MEETS_POINT);
    CHECK_INT(met.other[0], 1);
    CHECK_OK(insert_edges(ctx, &plane, over, 1, EDGE_CONTOUR, true, &met));
    CHECK_INT(met.found, NO_CONTACT);
    check_plane(&plane);
    CHECK_STATUS(insert_points(ctx, &plane, (int32_t[1][2]){{COORDINATE_LIMIT + 1, 0}}, 1), JALI_BAD_INPUT);
    triangulation_free(ctx, &plane);
}

// Edges on a small lattice, so that many hot pixels are met: the pieces chain each edge from end to end
// within a unit of it, cross nowhere (the triangulation takes them all), and no point changes sides.
static void check_snapped(const int32_t (*point)[2], int32_t points, const int32_t (*edge)[2], int32_t edges)
{
    snapped s;
    triangulation plane = {0};
    contact met;
    int32_t crossed[2], at = 0;
    CHECK_OK(snap_round(ctx, point, points, edge, edges, edges, &s, crossed));
    for (int32_t i = 0; i < points; i++) CHECK(memcmp(s.point[s.home[i]], point[i], sizeof *point) == 0);
    for (int32_t e = 0; e < edges; e++) {
        int32_t here = s.home[edge[e][0]];
        const int32_t *a = point[edge[e][0]], *b = point[edge[e][1]];
        double dx = b[0] - a[0], dy = b[1] - a[1], length = hypot(dx, dy);
        for (; at < s.piece_count && s.edge[at] == e; at++) {
            CHECK_INT(s.piece[at][0], here);
            here = s.piece[at][1];
            CHECK(fabs((double)orientation(a, b, s.point[here])) <= 0.708 * length);
        }
        CHECK_INT(here, s.home[edge[e][1]]);
    }
    CHECK_INT(at, s.piece_count);
    CHECK_OK(insert_points(ctx, &plane, (const int32_t(*)[2])s.point, s.point_count));
    for (int32_t p = 0; p < s.point_count; p++) CHECK_INT(plane.twin[p], p);
    CHECK_OK(
        insert_edges(ctx, &plane, (const int32_t(*)[2])s.piece, s.piece_count, EDGE_CONTOUR, false, &met));
    CHECK_INT(met.found, NO_CONTACT);
    check_plane(&plane);
    triangulation_free(ctx, &plane);
    snapped_free(ctx, &s);
}

TEST(snapped_edges_meet_only_in_points)
{
    enum { MOST = 120 };
    uint64_t random = 77;
    for (int32_t round = 0; round < 400; round++) {
        int32_t point[MOST][2], edge[MOST][2], points = 4 + round % 60, edges = 1 + round % (MOST / 2);
        int32_t side = 4 + (int32_t)(next_random(&random) >> (round % 5 == 0 ? 44 : 58));
        for (int32_t i = 0; i < points; i++)
            for (int k = 0; k < 2; k++)
                point[i][k] = (int32_t)((next_random(&random) >> 40) % (uint64_t)side) - side / 2;
        for (int32_t i = 0; i < edges; i++)
            for (int k = 0; k < 2; k++)
                edge[i][k] = (int32_t)((next_random(&random) >> 40) % (uint64_t)points);
        check_snapped((const int32_t(*)[2])point, points, (const int32_t(*)[2])edge, edges);
    }
}

TEST(crossings_of_the_first_group_are_reported)
{
    int32_t point[6][2] = {{0, 0}, {100, 100}, {0, 100}, {100, 0}, {50, -20}, {50, 120}};
    int32_t edge[3][2] = {{0, 1}, {4, 5}, {2, 3}}, crossed[2];
    snapped s;
    CHECK_OK(snap_round(ctx, (const int32_t(*)[2])point, 6, (const int32_t(*)[2])edge, 3, 1, &s, crossed));
    CHECK_INT(crossed[0], -1);
    CHECK_INT(s.piece_count, 6); // the three meet in one point
    CHECK_INT(s.point_count, 7);
    snapped_free(ctx, &s);
    CHECK_OK(snap_round(ctx, (const int32_t(*)[2])point, 6, (const int32_t(*)[2])edge, 3, 2, &s, crossed));
    CHECK_INT(crossed[0], 0);
    CHECK_INT(crossed[1], 1);
    snapped_free(ctx, &s);
}

static jali_status snap_some(jali_context *limited, void *data)
{
    snapped s;
    int32_t edge[3][2] = {{0, 90}, {90, 45}, {44, 3}}, crossed[2];
    jali_status status = snap_round(limited, data, 100, (const int32_t(*)[2])edge, 3, 0, &s, crossed);
    snapped_free(limited, &s);
    return status;
}

static jali_status triangulate_some(jali_context *limited, void *data)
{
    jali_status status;
    triangulation plane = {0};
    contact met;
    const int32_t(*point)[2] = data;
    int32_t edge[3][2] = {{0, 90}, {90, 45}, {45, 3}};
    TRY(insert_points(limited, &plane, point, 100));
    TRY(insert_edges(limited, &plane, edge, 3, EDGE_CONTOUR, true, &met));
done:
    triangulation_free(limited, &plane);
    return status;
}

TEST(every_allocation_refused_once)
{
    static int32_t point[100][2];
    uint64_t random = 3;
    for (int32_t i = 0; i < 100; i++)
        for (int k = 0; k < 2; k++) point[i][k] = (int32_t)(next_random(&random) >> 50);
    refuse_each_allocation(triangulate_some, point);
    refuse_each_allocation(snap_some, point);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(grids_circles_lines_and_twins, open_context, close_context),
        cmocka_unit_test_setup_teardown(random_points_on_all_scales, open_context, close_context),
        cmocka_unit_test_setup_teardown(constrained_edges_are_kept_and_the_rest_is_delaunay, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(long_edges_through_random_points, open_context, close_context),
        cmocka_unit_test_setup_teardown(contacts_are_reported_with_their_edges, open_context, close_context),
        cmocka_unit_test_setup_teardown(snapped_edges_meet_only_in_points, open_context, close_context),
        cmocka_unit_test_setup_teardown(crossings_of_the_first_group_are_reported, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
