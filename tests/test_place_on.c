// Pictures on surfaces: the metric against formulas, room and its offers, views, hidden parts, seams.
#include "shapes.h"

#include <jali/surface.h>

#include <jali/place.h>
#include "place/patch.h"
#include "plane/exact.h"

static const double pi = 3.14159265358979323846;

// A chessboard of 8 px squares.
static jali_picture chessboard(int32_t width, int32_t height)
{
    jali_picture picture = {.width_px = width, .height_px = height};
    CHECK_OK(ALLOCATE(ctx, picture.grey, (size_t)width * (size_t)height));
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) picture.grey[y * width + x] = (x / 8 + y / 8) % 2 ? 255 : 0;
    return picture;
}

typedef struct lying {
    jali_chart chart;
    jali_patch patch;
    jali_bitmap drawing;
    jali_placed placed;
} lying;

static jali_status put(const jali_surface *surface, const jali_place_options *opt, int32_t width,
                       int32_t height, lying *l)
{
    jali_picture picture = chessboard(width, height);
    jali_status status =
        jali_place_on(ctx, &picture, 128, opt, surface, &l->chart, &l->patch, &l->drawing, &l->placed);
    jali_picture_free(ctx, &picture);
    return status;
}

static void take_away(lying *l)
{
    jali_chart_free(ctx, &l->chart);
    jali_patch_free(ctx, &l->patch);
    jali_bitmap_free(ctx, &l->drawing);
}

static jali_surface surface_of(const char *description)
{
    jali_surface surface;
    CHECK_OK(jali_surface_make(ctx, description, NULL, &surface));
    return surface;
}

// Where knot (i, j) is in the plane of the picture, mm from its centre, y up.
static void knot_place(const jali_chart *c, int32_t i, int32_t j, double at[2])
{
    double pixel = jali_chart_pixel_mm(c);
    at[0] = ((i + 0.5) * c->metric_step_px - c->width_px / 2.0) * pixel;
    at[1] = (c->height_px / 2.0 - (j + 0.5) * c->metric_step_px) * pixel;
}

static double worst_metric(const lying *l, void (*wanted)(const double at[2], double g[3]))
{
    const jali_chart *c = &l->chart;
    double worst = 0;
    for (int32_t j = 0; j < c->metric_rows; j++)
        for (int32_t i = 0; i < c->metric_columns; i++) {
            double at[2], g[3], pixel = jali_chart_pixel_mm(c);
            knot_place(c, i, j, at);
            if (fabs(at[0]) > (c->width_px / 2.0 - c->margin_px) * pixel ||
                fabs(at[1]) > (c->height_px / 2.0 - c->margin_px) * pixel)
                continue;
            wanted(at, g);
            for (int k = 0; k < 3; k++)
                worst = MAX(worst, fabs(c->metric[j * c->metric_columns + i][k] - g[k]) / (g[0] + g[2]));
        }
    return worst;
}

// A projected cylinder of radius 30: only steps to the right are longer.
static void cylinder_metric(const double at[2], double g[3])
{
    g[0] = 1 / (1 - at[0] * at[0] / 900);
    g[1] = 0;
    g[2] = 1;
}

// A projected sphere of radius 30: z = sqrt(r^2 - x^2 - y^2); y down turns the mixed term's sign.
static void sphere_metric(const double at[2], double g[3])
{
    double z2 = 900 - at[0] * at[0] - at[1] * at[1];
    g[0] = 1 + at[0] * at[0] / z2;
    g[1] = -at[0] * at[1] / z2;
    g[2] = 1 + at[1] * at[1] / z2;
}

TEST(the_metric_follows_the_formulas)
{
    lying l;
    jali_place_options opt = jali_place_defaults();
    opt.frame_mm = 1;
    opt.placing = JALI_PLACE_PROJECT;
    opt.width_mm = 40;
    jali_surface cylinder = surface_of("cylinder:r=30,h=70,tolerance=0.001");
    CHECK_OK(put(&cylinder, &opt, 64, 64, &l));
    CHECK(worst_metric(&l, cylinder_metric) < 0.01);
    CHECK(fabs(l.placed.stretch[0] - 1) < 1e-3 &&
          fabs(l.placed.stretch[1] - 1 / sqrt(1 - 400.0 / 900)) < 0.02);
    take_away(&l);
    jali_surface_free(ctx, &cylinder);

    jali_surface sphere = surface_of("sphere:r=30,tolerance=0.001");
    opt.width_mm = 36;
    CHECK_OK(put(&sphere, &opt, 64, 64, &l));
    CHECK(worst_metric(&l, sphere_metric) < 0.01);
    take_away(&l);
    jali_surface_free(ctx, &sphere);

    static const char *const developable[] = {"cylinder:r=30,h=70", "cone:r=40,top=20,h=70",
                                              "plate:w=80,h=70"};
    opt.placing = JALI_PLACE_WRAP;
    for (int i = 0; i < 3; i++) { // facets are chords: not quite
        jali_surface s = surface_of(developable[i]);
        CHECK_OK(put(&s, &opt, 64, 64, &l));
        CHECK(l.chart.metric == NULL && l.placed.stretch[0] > 0.998 && l.placed.stretch[1] < 1.002);
        CHECK_INT(l.placed.placing, JALI_PLACE_WRAP);
        take_away(&l);
        jali_surface_free(ctx, &s);
    }
}

TEST(a_perspective_is_true_at_its_centre)
{
    lying l;
    jali_place_options opt = jali_place_defaults();
    jali_surface plate = surface_of("plate:w=100,h=100");
    opt.placing = JALI_PLACE_PROJECT;
    opt.camera.perspective = opt.at_given = true;
    opt.at_mm[2] = 50;
    opt.camera.from[1] = -80;
    opt.camera.from[2] = 50;
    opt.frame_mm = 1;
    opt.width_mm = 50;
    CHECK_OK(put(&plate, &opt, 64, 64, &l));
    CHECK(l.chart.metric == NULL && fabs(l.placed.stretch[1] - 1) < 1e-5);
    CHECK(l.patch.weight != NULL);
    take_away(&l);
    opt.camera.fov_deg = 2 * atan(30.0 / 80) * 180 / pi; // 60 mm at 80 mm
    opt.width_mm = 0;
    CHECK_OK(put(&plate, &opt, 64, 64, &l));
    CHECK(fabs((l.chart.width_px - 2 * l.chart.margin_px) * jali_chart_pixel_mm(&l.chart) - 60) < 1e-6);
    take_away(&l);
    opt.camera.fov_deg = 20;
    opt.camera.from[0] = 60; // from the side: the plate is further off on the left
    CHECK_OK(put(&plate, &opt, 64, 64, &l));
    CHECK(l.placed.stretch[1] > 1.3 && l.placed.stretch[0] < 1);
    take_away(&l);
    opt.camera.from[1] = 80; // its back
    CHECK_STATUS(put(&plate, &opt, 64, 64, &l), JALI_NO_RESULT);
    jali_surface_free(ctx, &plate);
}

// What an offer says must fit, and a little more must not.
TEST(too_large_a_picture_is_refused_with_a_size_that_fits)
{
    static const char *const surfaces[] = {"sphere:r=30", "cylinder:r=30,h=50", "cone:r=30,top=10,h=60",
                                           "vase"};
    lying l;
    for (int i = 0; i < 4; i++)
        for (int wrapped = 0; wrapped < 2; wrapped++) {
            jali_surface s = surface_of(surfaces[i]);
            jali_place_options opt = jali_place_defaults();
            opt.placing = wrapped ? JALI_PLACE_WRAP : JALI_PLACE_PROJECT;
            opt.width_mm = i == 3 ? 300 : 150;
            opt.frame_mm = 1;
            CHECK_STATUS(put(&s, &opt, 100, 80, &l), JALI_NO_RESULT);
            const char *offer = strstr(jali_message(ctx), "a width of ");
            CHECK(offer != NULL);
            opt.width_mm = atof(offer + strlen("a width of "));
            CHECK(opt.width_mm > 15);
            CHECK_OK(put(&s, &opt, 100, 80, &l));
            take_away(&l);
            opt.width_mm *= 1.03;
            CHECK_STATUS(put(&s, &opt, 100, 80, &l), JALI_NO_RESULT);
            jali_surface_free(ctx, &s);
        }
}

TEST(a_picture_around_leaves_a_bar)
{
    lying l;
    jali_surface s = surface_of("cylinder:r=20,h=40");
    jali_place_options opt = jali_place_defaults();
    double around = 40 * pi;
    CHECK(fabs(s.around_mm - around) < 1e-6);
    opt.frame_mm = 2;
    opt.width_mm = around - 0.31;
    CHECK_OK(put(&s, &opt, 600, 150, &l));
    CHECK(l.patch.face_count > 0);
    take_away(&l);
    opt.width_mm = around - 0.29;
    CHECK_STATUS(put(&s, &opt, 600, 150, &l), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "at most 125.36 mm fit") != NULL);
    opt.width_mm = 60;
    opt.at_given = true; // across the seam at the back
    opt.at_mm[1] = 20;
    opt.at_mm[2] = 20;
    CHECK_OK(put(&s, &opt, 600, 150, &l));
    CHECK(l.placed.centre_mm[1] > 19.5);
    int32_t seam = 0; // the vertices on the seam have one place in the plane each
    for (int32_t p = 0; p < l.patch.point_count; p++)
        for (int32_t q = 0; q < p; q++) seam += l.patch.vertex[p] == l.patch.vertex[q];
    CHECK_INT(seam, 0);
    take_away(&l);
    jali_surface_free(ctx, &s);
}

// Facets are as tall as the shape: the place counts, not the facet.
TEST(a_wrapped_picture_goes_where_it_is_said)
{
    static const char *const surfaces[] = {"cylinder:r=30,h=90", "cone:r=40,top=25,h=90", "sphere:r=45",
                                           "vase:h=120"};
    lying l;
    for (int i = 0; i < 4; i++) {
        jali_surface s = surface_of(surfaces[i]);
        for (int n = 0; n < 5; n++) {
            jali_place_options opt = jali_place_defaults();
            double angle = 0.7 * n - 1.4;
            opt.placing = JALI_PLACE_WRAP;
            opt.width_mm = 20;
            opt.frame_mm = 1;
            opt.at_given = true;
            opt.at_mm[0] = 33 * sin(angle), opt.at_mm[1] = -33 * cos(angle), opt.at_mm[2] = 35 + 4.3 * n;
            CHECK_OK(put(&s, &opt, 64, 64, &l));
            const double *c = l.placed.centre_mm;
            CHECK(fabs(atan2(c[0], -c[1]) - angle) < 0.01);
            if (i == 0) CHECK(fabs(c[2] - opt.at_mm[2]) < 0.01 && fabs(hypot(c[0], c[1]) - 30) < 0.03);
            take_away(&l);
        }
        jali_surface_free(ctx, &s);
    }
}

TEST(a_view_is_found_and_hidden_parts_are_refused)
{
    lying l;
    jali_surface s = {.mesh = together(box_shape(-30, -5, 0, 30, 5, 60), box_shape(-4, -30, 25, 4, -25, 35))};
    jali_place_options opt = jali_place_defaults();
    opt.frame_mm = 1;
    opt.width_mm = 40; // a post stands before the front: the back has the room
    CHECK_OK(put(&s, &opt, 64, 64, &l));
    CHECK(l.placed.direction[1] < -0.9 && fabs(l.placed.centre_mm[1] - 5) < 1e-9);
    take_away(&l);
    opt.width_mm = 20; // beside the post there is room
    CHECK_OK(put(&s, &opt, 64, 64, &l));
    CHECK(l.placed.direction[1] > 0.9 && fabs(l.placed.centre_mm[1] + 5) < 1e-9);
    take_away(&l);
    opt.width_mm = 40;
    opt.at_given = true;
    opt.at_mm[0] = 8, opt.at_mm[1] = -5, opt.at_mm[2] = 30;
    CHECK_STATUS(put(&s, &opt, 64, 64, &l), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "hides") && strstr(jali_message(ctx), "seen along (0, -1, 0)"));
    const char *offer = strstr(jali_message(ctx), "a width of ");
    CHECK(offer != NULL);
    opt.width_mm = atof(offer + strlen("a width of "));
    CHECK_OK(put(&s, &opt, 64, 64, &l));
    take_away(&l);
    opt.width_mm = 40;
    opt.at_mm[0] = 500;
    CHECK_STATUS(put(&s, &opt, 64, 64, &l), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "beside the surface") != NULL);
    opt.camera.direction[2] = 1;
    opt.camera.up[2] = 1;
    CHECK_STATUS(put(&s, &opt, 64, 64, &l), JALI_BAD_VALUE);
    opt.placing = JALI_PLACE_WRAP; // around two edges of the box: it is flattened without stretch
    opt.camera.direction[2] = opt.camera.up[2] = 0;
    CHECK_OK(put(&s, &opt, 64, 64, &l));
    CHECK(fabs(l.placed.stretch[0] - 1) < 1e-3 && fabs(l.placed.stretch[1] - 1) < 1e-3);
    CHECK(fabs(l.placed.centre_mm[0] - 30) < 1e-9 && fabs(l.placed.centre_mm[2] - 30) < 1e-9);
    take_away(&l);
    jali_surface_free(ctx, &s);
}

TEST(faulty_faces_matter_under_the_picture_alone)
{
    lying l;
    jali_surface s = surface_of("cylinder:r=30,h=60");
    jali_place_options opt = jali_place_defaults();
    opt.width_mm = 20;
    CHECK_OK(ALLOCATE_CLEARED(ctx, s.faulty, s.mesh.triangle_count));
    for (int32_t t = 0; t < s.mesh.triangle_count; t++) // the whole back
        s.faulty[t] = s.mesh.vertex[s.mesh.triangle[t][0]][1] > 0;
    CHECK_OK(put(&s, &opt, 64, 64, &l));
    take_away(&l);
    opt.at_given = true;
    opt.at_mm[1] = 30, opt.at_mm[2] = 30;
    CHECK_STATUS(put(&s, &opt, 64, 64, &l), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "under the picture are faulty") != NULL);
    jali_surface_free(ctx, &s);
}

// A disc of rings of triangles, radius 1, counter-clockwise seen from -y.
static jali_mesh disc(int32_t rings, int32_t around)
{
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, 1 + rings * around, around * (2 * rings - 1), &mesh));
    memset(mesh.vertex[0], 0, sizeof *mesh.vertex);
    int32_t next = 0;
    for (int32_t r = 0; r < rings; r++)
        for (int32_t i = 0; i < around; i++) {
            double radius = (r + 1.0) / rings, angle = 2 * M_PI * i / around;
            int32_t a = 1 + r * around + i, b = 1 + r * around + (i + 1) % around;
            double at[3] = {radius * cos(angle), 0, radius * sin(angle)};
            memcpy(mesh.vertex[a], at, sizeof at);
            if (r == 0) {
                memcpy(mesh.triangle[next++], (int32_t[3]){0, a, b}, sizeof *mesh.triangle);
                continue;
            }
            memcpy(mesh.triangle[next++], (int32_t[3]){a - around, a, b}, sizeof *mesh.triangle);
            memcpy(mesh.triangle[next++], (int32_t[3]){a - around, b, b - around}, sizeof *mesh.triangle);
        }
    return mesh;
}

// The insides of two triangles have a place in common, unless a line through an edge of one parts them.
static bool triangles_overlap(int32_t (*const a[3])[2], int32_t (*const b[3])[2])
{
    for (int way = 0; way < 2; way++) {
        int32_t(*const *one)[2] = way ? b : a, (*const *other)[2] = way ? a : b;
        for (int k = 0; k < 3; k++) {
            bool apart = true;
            for (int i = 0; i < 3; i++) apart &= orientation(*one[k], *one[(k + 1) % 3], *other[i]) <= 0;
            if (apart) return false;
        }
    }
    return true;
}

// Strips of a ring that turn by up to one and a half times, moved at random: decided as by all pairs of
// faces.
TEST(patches_that_cover_a_place_twice_are_found)
{
    enum { LONG = 24, WIDE = 3, POINTS = (LONG + 1) * (WIDE + 1), FACES = 2 * LONG * WIDE };
    int32_t found[2] = {0};
    for (uint64_t seed = 1; seed <= 200; seed++) {
        uint64_t random = seed;
        int32_t point[POINTS][2], vertex[POINTS], face[FACES], corner[FACES][3], where;
        double angle = 3 + (double)(next_random(&random) >> 40) / (1 << 24) * 6.5;
        double drift = (double)(next_random(&random) >> 40) / (1 << 24) * 400 - 200;
        for (int32_t i = 0; i <= LONG; i++)
            for (int32_t j = 0; j <= WIDE; j++) {
                double a = angle * i / LONG, r = 900 - 150 * j + drift * i / LONG;
                point[i * (WIDE + 1) + j][0] =
                    (int32_t)lrint(r * cos(a)) + (int32_t)(next_random(&random) >> 61);
                point[i * (WIDE + 1) + j][1] =
                    (int32_t)lrint(r * sin(a)) + (int32_t)(next_random(&random) >> 61);
            }
        for (int32_t f = 0; f < FACES; f++) {
            int32_t a = f / 2 / WIDE * (WIDE + 1) + f / 2 % WIDE, b = a + WIDE + 1;
            int32_t both[2][3] = {{a, b, b + 1}, {a, b + 1, a + 1}};
            memcpy(corner[f], both[f % 2], sizeof *corner);
            CHECK(orientation(point[corner[f][0]], point[corner[f][1]], point[corner[f][2]]) > 0);
        }
        jali_patch patch = {POINTS, point, vertex, NULL, FACES, face, corner};
        bool twice = false;
        for (int32_t f = 0; f < FACES; f++)
            for (int32_t g = 0; g < f && !twice; g++) {
                int32_t(*a[3])[2], (*b[3])[2];
                for (int k = 0; k < 3; k++) a[k] = &point[corner[f][k]], b[k] = &point[corner[g][k]];
                twice = triangles_overlap(a, b);
            }
        CHECK_OK(find_overlap(ctx, &patch, &where));
        CHECK_INT(where >= 0, twice);
        found[twice]++;
    }
    CHECK(found[0] > 40 && found[1] > 40);
}

// A texture that goes around its middle twice, face by face the right way round, with one border for two.
TEST(a_texture_that_overlaps_is_refused_before_anything_else)
{
    lying l;
    for (int turns = 1; turns < 3; turns++) {
        jali_surface s = {.mesh = disc(8, 48), .textured = true};
        jali_place_options opt = jali_place_defaults();
        opt.placing = JALI_PLACE_WRAP;
        opt.width_mm = 20;
        opt.frame_mm = 1;
        opt.at_given = true;
        CHECK_OK(ALLOCATE(ctx, s.uv, s.mesh.triangle_count));
        for (int32_t v = 0; v < s.mesh.vertex_count; v++)
            for (int k = 0; k < 3; k++) s.mesh.vertex[v][k] *= 40;
        for (int32_t t = 0; t < s.mesh.triangle_count; t++)
            for (int k = 0; k < 3; k++) {
                const double *p = s.mesh.vertex[s.mesh.triangle[t][k]];
                double r = hypot(p[0], p[2]), a = turns * atan2(p[2], p[0]);
                s.uv[t][k][0] = r * cos(a);
                s.uv[t][k][1] = r * sin(a);
            }
        if (turns == 1) {
            CHECK_OK(put(&s, &opt, 64, 64, &l));
            take_away(&l);
        } else {
            CHECK_STATUS(put(&s, &opt, 64, 64, &l), JALI_NO_RESULT);
            CHECK(strstr(jali_message(ctx), "covers the picture's window twice: its texture") != NULL);
            CHECK(strstr(jali_message(ctx), "texture=no") != NULL);
        }
        jali_surface_free(ctx, &s);
    }
}

static jali_status place_some(jali_context *limited, void *data)
{
    lying l;
    jali_picture *picture = data;
    jali_surface s = {0};
    jali_place_options opt = jali_place_defaults();
    jali_status status;
    opt.width_mm = 15;
    opt.placing = JALI_PLACE_PROJECT;
    TRY(jali_surface_make(limited, "sphere:r=20,facets=16", NULL, &s));
    TRY(jali_place_on(limited, picture, 128, &opt, &s, &l.chart, &l.patch, &l.drawing, NULL));
    jali_chart_free(limited, &l.chart);
    jali_patch_free(limited, &l.patch);
    jali_bitmap_free(limited, &l.drawing);
done:
    jali_surface_free(limited, &s);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_picture picture = chessboard(32, 32);
    refuse_each_allocation(place_some, &picture);
    jali_picture_free(ctx, &picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_metric_follows_the_formulas, open_context, close_context),
        cmocka_unit_test_setup_teardown(a_perspective_is_true_at_its_centre, open_context, close_context),
        cmocka_unit_test_setup_teardown(a_wrapped_picture_goes_where_it_is_said, open_context, close_context),
        cmocka_unit_test_setup_teardown(too_large_a_picture_is_refused_with_a_size_that_fits, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(a_picture_around_leaves_a_bar, open_context, close_context),
        cmocka_unit_test_setup_teardown(a_view_is_found_and_hidden_parts_are_refused, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(patches_that_cover_a_place_twice_are_found, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(a_texture_that_overlaps_is_refused_before_anything_else, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(faulty_faces_matter_under_the_picture_alone, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
