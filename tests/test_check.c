// Check: small solids whose every figure is known, each kind of flaw, exact signs, real meshes.
#include "shapes.h"

#include <jali/check.h>
#include "base/bytes.h"
#include "mesh/intersect.h"

static jali_check_report checked(jali_mesh mesh)
{
    jali_check_report report;
    CHECK_OK(jali_check(ctx, &mesh, NULL, &report));
    jali_mesh_free(ctx, &mesh);
    return report;
}

TEST(a_tetrahedron_is_a_solid)
{
    jali_check_report r = checked(tetrahedron());
    CHECK(r.solid && r.closed && r.manifold && r.oriented && r.clean && r.apart);
    CHECK_INT(r.edges, 6);
    CHECK_INT(r.euler, 2);
    CHECK_INT(r.genus, 0);
    CHECK_INT(r.pieces, 1);
    CHECK(fabs(r.volume_mm3 - 1.0 / 6) < 1e-15);
    CHECK(fabs(r.area_mm2 - (1.5 + sqrt(3) / 2)) < 1e-15);
}

TEST(a_cube_measures_what_it_should)
{
    jali_check_report r = checked(box_shape(-1, 2, 3, 1, 5, 7));
    CHECK(r.solid && r.coordinates_exact);
    CHECK_INT(r.unit_log2, 0);
    CHECK(r.volume_mm3 == 24 && r.area_mm2 == 52);
    CHECK(r.low_mm[0] == -1 && r.high_mm[2] == 7);
}

TEST(a_torus_has_one_hole)
{
    jali_check_report r = checked(torus(30, 16));
    CHECK(r.solid);
    CHECK_INT(r.euler, 0);
    CHECK_INT(r.genus, 1);
    CHECK(fabs(r.volume_mm3 - 59.2) < 3); // 2 pi^2 R r^2 = 59.2, less the flats
}

TEST(an_open_box_shows_its_four_edges)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 1, 1);
    memmove(cube.triangle + 2, cube.triangle + 4, 8 * sizeof *cube.triangle); // no top
    cube.triangle_count = 10;
    jali_check_report r = checked(cube);
    CHECK(!r.closed && !r.solid && r.manifold && r.oriented && r.apart);
    CHECK_INT(r.open_edges.count, 4);
    CHECK(r.open_edges.at_mm[2] == 1);
    CHECK_INT(r.genus, -1);
}

TEST(a_flipped_face_is_misdirected)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 1, 1);
    flip_triangle(&cube, 3);
    jali_check_report r = checked(cube);
    CHECK(r.closed && r.manifold && !r.oriented && !r.solid);
    CHECK_INT(r.misdirected_edges.count, 3);
}

TEST(a_box_inside_out_is_misplaced)
{
    jali_check_report r = checked(inside_out(box_shape(0, 0, 0, 1, 1, 1)));
    CHECK(!r.oriented && !r.solid);
    CHECK_INT(r.misplaced_shells.count, 1);
    CHECK(r.volume_mm3 == -1);
}

TEST(cubes_that_share_an_edge_or_a_vertex_are_not_manifold)
{
    jali_check_report r = checked(together(box_shape(0, 0, 0, 1, 1, 1), box_shape(1, 1, 0, 2, 2, 1)));
    CHECK(r.closed && !r.manifold && r.apart);
    CHECK_INT(r.crowded_edges.count, 1);
    CHECK_INT(r.crowded_vertices.count, 0);
    CHECK_INT(r.repeated_vertices, 2);
    CHECK(r.crowded_edges.at_mm[0] == 1 && r.crowded_edges.at_mm[2] == 0.5);
    r = checked(together(box_shape(0, 0, 0, 1, 1, 1), box_shape(1, 1, 1, 2, 2, 2)));
    CHECK(r.closed && !r.manifold && r.apart);
    CHECK_INT(r.crowded_edges.count, 0);
    CHECK_INT(r.crowded_vertices.count, 1);
    CHECK_INT(r.pieces, 2);
    CHECK(r.crowded_vertices.at_mm[1] == 1);
}

TEST(nested_shells_are_judged_by_what_encloses_them)
{
    jali_mesh hollow = together(box_shape(0, 0, 0, 9, 9, 9), inside_out(box_shape(1, 1, 1, 8, 8, 8)));
    jali_check_report r = checked(hollow);
    CHECK(r.solid);
    CHECK_INT(r.pieces, 1);
    CHECK_INT(r.voids, 1);
    CHECK(r.volume_mm3 == 729 - 343);
    hollow = together(box_shape(0, 0, 0, 9, 9, 9), inside_out(box_shape(1, 1, 1, 8, 8, 8)));
    r = checked(together(hollow, box_shape(2, 2, 2, 7, 7, 7)));
    CHECK(r.solid); // a ball in a bell
    CHECK_INT(r.pieces, 2);
    r = checked(together(box_shape(0, 0, 0, 9, 9, 9), box_shape(1, 1, 1, 8, 8, 8)));
    CHECK_INT(r.misplaced_shells.count, 1); // solid within solid
    CHECK(r.apart && !r.solid);
    r = checked(together(box_shape(0, 0, 0, 9, 9, 9), inside_out(box_shape(11, 1, 1, 18, 8, 8))));
    CHECK_INT(r.misplaced_shells.count, 1); // a void outside
}

TEST(boxes_through_each_other_are_counted)
{
    // A bar through the middle of a box: its four sides pass two faces of the box, at either end.
    jali_check_report r = checked(together(box_shape(0, 0, 0, 4, 4, 4), box_shape(1, 1, -1, 2, 2, 5)));
    CHECK(r.closed && r.manifold && !r.apart && !r.solid);
    CHECK(r.intersections.count >= 16);
    CHECK(r.intersections.at_mm[0] >= 0 && r.intersections.at_mm[0] <= 4);
}

TEST(touching_boxes_intersect_without_a_common_vertex)
{
    jali_check_report r = checked(together(box_shape(0, 0, 0, 4, 4, 4), box_shape(4, 1, 1, 6, 2, 2)));
    CHECK(r.manifold && !r.apart);
    r = checked(together(box_shape(0, 0, 0, 4, 4, 4), box_shape(4.0000000001, 1, 1, 6, 2, 2)));
    CHECK(r.solid);
}

static bool meet(double (*vertex)[3], const int32_t a[3], const int32_t b[3], int32_t count)
{
    lattice l;
    CHECK_OK(lattice_create(ctx, count, (const double(*)[3])vertex, &l));
    bool result = triangles_meet(&l, a, b);
    CHECK(result == triangles_meet(&l, b, a));
    l.narrow = false; // the wide arithmetic must say the same
    CHECK(result == triangles_meet(&l, a, b));
    lattice_free(ctx, &l);
    return result;
}

TEST(pairs_in_one_plane)
{
    double v[][3] = {{0, 0, 1},   {4, 0, 1}, {0, 4, 1}, {1, 1, 1},  {2, 1, 1},  {1, 2, 1}, {4, 4, 1},
                     {-1, -1, 1}, {5, 5, 1}, {2, 2, 1}, {-4, 0, 1}, {0, -4, 1}, {3, 0, 1}};
    const int32_t n = sizeof v / sizeof *v;
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){3, 4, 5}, n));  // one inside the other
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){2, 1, 6}, n)); // neighbours
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){1, 2, 3}, n));  // folded over the common edge
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 4, 5}, n));  // sector within the sector
    CHECK(meet(v, (int32_t[]){0, 4, 5}, (int32_t[]){0, 1, 2}, n));
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 10, 11}, n)); // opposite sectors
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 12, 11}, n));  // along an arm
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){9, 6, 1}, n));    // a vertex on the opposite edge
}

TEST(pairs_in_space)
{
    double v[][3] = {{0, 0, 0},  {4, 0, 0}, {0, 4, 0}, {1, 1, -1},  {1, 1, 1},
                     {2, 1, 5},  {0, 0, 4}, {1, 1, 0}, {9, 9, 9},   {2, 2, 3},
                     {2, 2, -3}, {3, 3, 0}, {4, 4, 1}, {-1, -1, 3}, {5, 5, 0}};
    const int32_t n = sizeof v / sizeof *v;
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){3, 4, 5}, n));  // pierced
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){7, 4, 5}, n));  // touched by a vertex
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){4, 5, 8}, n)); // above
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 1, 6}, n)); // a common edge, upright
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 6, 8}, n)); // a common vertex, upright
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 3, 4}, n));  // a common vertex, through it
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 6, 7}, n));  // a common vertex, an edge within it
    CHECK(meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 9, 10}, n)); // through the common vertex and beyond
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){11, 12, 9}, n));
    CHECK(!meet(v, (int32_t[]){0, 1, 2}, (int32_t[]){0, 13, 8}, n));
}

// A second opinion by other means. Two convex sets meet when 0 lies in the hull of all differences of their
// corners; by Caratheodory it then lies in a simplex of at most four of them, and every such simplex is
// tried.
typedef int64_t vector[3];

static int64_t dot(const vector a, const vector b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const vector a, const vector b, vector c)
{
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static int64_t volume(const vector a, const vector b, const vector c)
{
    vector n;
    cross(b, c, n);
    return dot(a, n);
}

static bool all_of_one_sign(const int64_t *v, int count)
{
    bool negative = false, positive = false;
    for (int i = 0; i < count; i++) {
        negative |= v[i] < 0;
        positive |= v[i] > 0;
    }
    return !(negative && positive);
}

static bool zero_in_segment(const vector a, const vector b)
{
    vector n;
    cross(a, b, n);
    return dot(n, n) == 0 && dot(a, b) <= 0;
}

static bool zero_in_triangle(const vector a, const vector b, const vector c)
{
    vector ab, bc, ca, n;
    cross(a, b, ab);
    cross(b, c, bc);
    cross(c, a, ca);
    for (int k = 0; k < 3; k++) n[k] = ab[k] + bc[k] + ca[k];
    if (dot(n, n) == 0 || volume(a, b, c) != 0) return false;
    return all_of_one_sign((int64_t[]){dot(ab, n), dot(bc, n), dot(ca, n)}, 3);
}

static bool zero_in_tetrahedron(const vector a, const vector b, const vector c, const vector d)
{
    int64_t part[4] = {volume(b, c, d), -volume(a, c, d), volume(a, b, d), -volume(a, b, c)};
    return part[0] + part[1] + part[2] + part[3] != 0 && all_of_one_sign(part, 4);
}

static bool zero_in_hull(const vector *v, int count)
{
    for (int a = 0; a < count; a++)
        for (int b = a; b < count; b++)
            for (int c = b; c < count; c++)
                for (int d = c; d < count; d++)
                    if (zero_in_segment(v[a], v[b]) || zero_in_triangle(v[a], v[b], v[c]) ||
                        zero_in_tetrahedron(v[a], v[b], v[c], v[d]))
                        return true;
    return false;
}

// Triangles a = 0, 1, 2 and b = 3, 4, 5; when they share a vertex, b = 0, 4, 5 and the question is whether
// their sectors share a direction: whether 0 is in the hull of the arms of a and the opposite arms of b.
static bool hulls_meet(const vector v[6], bool shared)
{
    vector difference[9];
    int count = 0;
    if (shared)
        for (int i = 1; i < 6; i++) {
            if (i == 3) continue;
            for (int k = 0; k < 3; k++) difference[count][k] = (v[i][k] - v[0][k]) * (i < 3 ? 1 : -1);
            count++;
        }
    else
        for (int i = 0; i < 9; i++, count++)
            for (int k = 0; k < 3; k++) difference[i][k] = v[i / 3][k] - v[3 + i % 3][k];
    return zero_in_hull((const vector *)difference, count);
}

TEST(random_pairs_agree_with_a_search_of_all_simplices)
{
    uint64_t seed = 2024;
    int32_t tried = 0, met = 0;
    for (int32_t round = 0; round < 60000; round++) {
        double v[6][3];
        vector w[6];
        int32_t a[3] = {0, 1, 2}, b[3] = {round & 1 ? 0 : 3, 4, 5};
        for (int i = 0; i < 6; i++)
            for (int k = 0; k < 3; k++)
                v[i][k] =
                    (double)(w[i][k] = (int64_t)(next_random(&seed) >> 32) % (k == 2 && round & 2 ? 2 : 4));
        if (round & 1) memcpy(w[3], w[0], sizeof *w), memcpy(v[3], v[0], sizeof *v);
        bool fit = true;
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < i; j++)
                fit &= (i == 3 && j == 0 && round & 1) || memcmp(w[i], w[j], sizeof *w);
        for (int t = 0; t < 6; t += 3) {
            vector u[2], n;
            for (int i = 0; i < 2; i++)
                for (int k = 0; k < 3; k++) u[i][k] = w[t + 1 + i][k] - w[t][k];
            cross(u[0], u[1], n);
            fit &= dot(n, n) != 0;
        }
        if (!fit) continue;
        bool wanted = hulls_meet((const vector *)w, round & 1);
        CHECK_INT(meet(v, a, b, 6), wanted);
        tried++;
        met += wanted;
    }
    CHECK(tried > 10000 && met > tried / 10 && met < tried - tried / 10);
}

// Triangles between random points of a small lattice; `far` adds one at a distance that needs the wide
// arithmetic and float boxes that are rounded.
static jali_mesh random_soup(uint64_t seed, int32_t count, double spread, bool far)
{
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, 3 * (count + far), count + far, &mesh));
    for (int32_t t = 0; t < count + far; t++) {
        double centre[3];
        for (int k = 0; k < 3; k++)
            centre[k] = (double)(next_random(&seed) >> 58) + (t == count ? 0x1p50 : 0);
        for (int i = 0; i < 3; i++) {
            mesh.triangle[t][i] = 3 * t + i;
            for (int k = 0; k < 3; k++)
                mesh.vertex[3 * t + i][k] =
                    centre[k] + floor(spread * (double)(next_random(&seed) >> 11) * 0x1p-53);
        }
    }
    return mesh;
}

TEST(the_search_finds_every_pair)
{
    for (int round = 0; round < 12; round++) {
        jali_mesh mesh = random_soup(round + 77u, 500, round % 3 * 12 + 12, round & 1);
        jali_check_report r;
        lattice l;
        int64_t pairs = 0;
        int32_t first[1600], (*t)[3] = mesh.triangle;
        CHECK_OK(jali_check(ctx, &mesh, NULL, &r));
        CHECK_OK(weld_points(ctx, mesh.vertex_count, (const double(*)[3])mesh.vertex, first, NULL));
        CHECK_OK(lattice_create(ctx, mesh.vertex_count, (const double(*)[3])mesh.vertex, &l));
        CHECK_INT(l.narrow, !(round & 1));
        for (int32_t i = 0; i < 3 * mesh.triangle_count; i++) t[i / 3][i % 3] = first[t[i / 3][i % 3]];
        for (int32_t i = 0; i < mesh.triangle_count; i++)
            for (int32_t j = 0; j < i; j++) {
                normal a = normal_of(l.narrow, l.point[t[i][0]], l.point[t[i][1]], l.point[t[i][2]]);
                normal b = normal_of(l.narrow, l.point[t[j][0]], l.point[t[j][1]], l.point[t[j][2]]);
                pairs += axis_of(&a) >= 0 && axis_of(&b) >= 0 && triangles_meet(&l, t[i], t[j]);
            }
        CHECK_INT(r.intersections.count, pairs);
        CHECK(pairs > 50);
        lattice_free(ctx, &l);
        jali_mesh_free(ctx, &mesh);
    }
}

TEST(degenerate_and_repeated_triangles_are_found)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 1, 1);
    jali_mesh twice = shape(8, (const double(*)[3])cube.vertex, 12, (const int32_t(*)[3])cube.triangle);
    twice.triangle_count = 1;
    jali_check_report r = checked(together(cube, twice));
    CHECK_INT(r.repeated_triangles.count, 1);
    CHECK(!r.manifold);
    double line[3][3] = {{5, 5, 5}, {6, 6, 6}, {7, 7, 7}};
    r = checked(together(box_shape(0, 0, 0, 1, 1, 1),
                         shape(3, (const double(*)[3])line, 1, (const int32_t[][3]){{0, 1, 2}})));
    CHECK_INT(r.degenerate_triangles.count, 1);
    CHECK(!r.clean && r.degenerate_triangles.at_mm[0] == 6);
}

TEST(pierced_plates_are_solids)
{
    for (int32_t n = 1; n <= 9; n += 2) {
        jali_check_report r = checked(pierced_plate(n, 1, 0));
        CHECK(r.solid);
        CHECK_INT(r.genus, (n / 2) * (n / 2));
        CHECK(r.volume_mm3 == 4.0 * (n * n - (n / 2) * (n / 2)));
        CHECK(checked(pierced_plate(n, 1, 7)).solid);
    }
}

TEST(threads_do_not_change_a_report)
{
    jali_mesh mesh = together(pierced_plate(41, 1, 3), box_shape(3.5, 3.25, -1, 30, 30, 3));
    jali_check_report reference;
    CHECK_OK(jali_check(ctx, &mesh, NULL, &reference));
    CHECK(reference.intersections.count > 1000);
    for (int32_t threads = 1; threads <= 3; threads++) {
        jali_context_options opt = jali_context_defaults();
        opt.threads = threads;
        jali_context *other;
        jali_check_report r;
        CHECK_INT(jali_context_create(&opt, &other), JALI_OK);
        CHECK_INT(jali_check(other, &mesh, NULL, &r), JALI_OK);
        CHECK(memcmp(&r, &reference, sizeof r) == 0);
        jali_context_free(other);
    }
    jali_mesh_free(ctx, &mesh);
}

TEST(what_cannot_be_checked_is_refused)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 1, 1);
    jali_check_report r;
    cube.vertex[3][1] = NAN;
    CHECK_STATUS(jali_check(ctx, &cube, NULL, &r), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "coordinate y of vertex 3") != NULL);
    cube.vertex[3][1] = 1;
    cube.triangle[11][0] = 8;
    CHECK_STATUS(jali_check(ctx, &cube, NULL, &r), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "triangle 11 names vertex 8") != NULL);
    jali_mesh_free(ctx, &cube);
    r = checked((jali_mesh){0});
    CHECK(!r.solid);
}

TEST(coordinates_of_any_size_are_put_on_a_lattice)
{
    double far[4][3] = {{1e300, 0, 0}, {0, 1e-300, 0}, {0, 0, 1}, {0, 0, 0}};
    lattice l;
    CHECK_OK(lattice_create(ctx, 4, (const double(*)[3])far, &l));
    CHECK(!l.exact && !l.narrow);
    CHECK(llabs((long long)l.point[0][0]) <= (long long)1 << 60);
    lattice_free(ctx, &l);
    double plate[2][3] = {{0, 1.0 / 1024, 100}, {5e-324, 0, 0}};
    CHECK_OK(lattice_create(ctx, 1, (const double(*)[3])plate, &l));
    CHECK(l.exact && l.narrow && l.unit_log2 == -10 && l.point[0][2] == 102400);
    lattice_free(ctx, &l);
}

TEST(the_report_reads_well)
{
    jali_bytes text = {0};
    jali_check_report r = checked(together(box_shape(0, 0, 0, 4, 4, 4), box_shape(1, 1, -1, 2, 2, 5)));
    CHECK_OK(jali_check_sentences(ctx, &r, &text));
    CHECK_OK(jali_check_json(ctx, &r, &text));
    CHECK_OK(bytes_append(ctx, &text, "", 1));
    CHECK(strstr((char *)text.data, "pairs of triangles intersect; the first is at (") != NULL);
    CHECK(strstr((char *)text.data, "\"self_intersections\"") != NULL);
    CHECK(strstr((char *)text.data, "\"pieces\": 2") != NULL);
    jali_bytes_free(ctx, &text);
}

static jali_status check_all(jali_context *limited, void *data)
{
    jali_check_report r;
    jali_bytes text = {0};
    jali_status status = jali_check(limited, data, NULL, &r);
    if (status == JALI_OK) status = jali_check_sentences(limited, &r, &text);
    if (status == JALI_OK) status = jali_check_json(limited, &r, &text);
    jali_bytes_free(limited, &text);
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    jali_mesh mesh = together(torus(5, 4), box_shape(0, 0, 0, 9, 9, 9));
    refuse_each_allocation(check_all, &mesh);
    jali_mesh_free(ctx, &mesh);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(a_tetrahedron_is_a_solid),
        RUN(a_cube_measures_what_it_should),
        RUN(a_torus_has_one_hole),
        RUN(an_open_box_shows_its_four_edges),
        RUN(a_flipped_face_is_misdirected),
        RUN(a_box_inside_out_is_misplaced),
        RUN(cubes_that_share_an_edge_or_a_vertex_are_not_manifold),
        RUN(nested_shells_are_judged_by_what_encloses_them),
        RUN(boxes_through_each_other_are_counted),
        RUN(touching_boxes_intersect_without_a_common_vertex),
        RUN(pairs_in_one_plane),
        RUN(pairs_in_space),
        RUN(random_pairs_agree_with_a_search_of_all_simplices),
        RUN(the_search_finds_every_pair),
        RUN(degenerate_and_repeated_triangles_are_found),
        RUN(pierced_plates_are_solids),
        RUN(threads_do_not_change_a_report),
        RUN(what_cannot_be_checked_is_refused),
        RUN(coordinates_of_any_size_are_put_on_a_lattice),
        RUN(the_report_reads_well),
        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
