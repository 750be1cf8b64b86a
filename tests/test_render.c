// Rays against formulas and against all triangles; pictures: what is seen where, and the same everywhere.
#include "shapes.h"

#include <jali/render.h>
#include "mesh/rays.h"
#include "render/light.h"

static double random_number(uint64_t *seed)
{
    return (double)(next_random(seed) >> 11) * 0x1p-53 * 2 - 1;
}

static ray random_ray(uint64_t *seed, double reach)
{
    ray r = {.near = 0, .far = INFINITY};
    for (int k = 0; k < 3; k++) {
        r.from[k] = reach * random_number(seed);
        r.along[k] = random_number(seed);
    }
    return r;
}

TEST(rays_meet_a_box_where_the_formula_says)
{
    jali_mesh block = box_shape(9, 18, 27, 11, 22, 33);
    ray_scene scene;
    uint64_t seed = 5;
    int32_t hits = 0;
    CHECK_OK(ray_scene_create(ctx, &block, &scene));
    CHECK(scene.origin[0] == 10 && scene.origin[1] == 20 && scene.origin[2] == 30);
    for (int32_t i = 0; i < 20000; i++) {
        ray r = random_ray(&seed, 6);
        double enter = -INFINITY, leave = INFINITY;
        for (int k = 0; k < 3; k++) {
            double a = (scene.low[k] - r.from[k]) / r.along[k], b = (scene.high[k] - r.from[k]) / r.along[k];
            enter = MAX(enter, MIN(a, b));
            leave = MIN(leave, MAX(a, b));
        }
        bool meets = enter < leave && leave > 0;
        ray_hit hit;
        CHECK_INT(ray_nearest(&scene, &r, &hit), meets);
        CHECK_INT(ray_any(&scene, &r), meets);
        if (meets) CHECK(fabs(hit.t - (enter > 0 ? enter : leave)) < 1e-9 * MAX(1, hit.t));
        hits += meets;
    }
    CHECK(hits > 2000 && hits < 18000);
    ray_scene_free(ctx, &scene);
    jali_mesh_free(ctx, &block);
}

// A torus of 2,000 triangles against the test of each of them, alone in a scene.
TEST(the_walk_finds_what_a_search_of_all_triangles_finds)
{
    jali_mesh mesh = torus(50, 20);
    ray_scene scene, *one;
    uint64_t seed = 9;
    CHECK_OK(ray_scene_create(ctx, &mesh, &scene));
    one = malloc((size_t)mesh.triangle_count * sizeof *one);
    for (int32_t i = 0; i < mesh.triangle_count; i++) {
        jali_mesh alone = {mesh.vertex_count, 1, mesh.vertex, mesh.triangle + i};
        CHECK_OK(ray_scene_create(ctx, &alone, &one[i]));
    }
    for (int32_t i = 0; i < 300; i++) {
        ray r = random_ray(&seed, 4);
        ray_hit hit, other;
        double nearest = INFINITY;
        for (int32_t t = 0; t < mesh.triangle_count; t++)
            if (ray_nearest(&one[t], &r, &other)) nearest = MIN(nearest, other.t);
        CHECK_INT(ray_nearest(&scene, &r, &hit), nearest < INFINITY);
        if (nearest < INFINITY) CHECK(hit.t == nearest);
        r.far = nearest;
        CHECK(!ray_any(&scene, &r));
    }
    for (int32_t i = 0; i < mesh.triangle_count; i++) ray_scene_free(ctx, &one[i]);
    free(one);
    ray_scene_free(ctx, &scene);
    jali_mesh_free(ctx, &mesh);
}

// Through corners, edges and along faces: from inside a closed surface every ray must get out exactly
// somewhere.
TEST(no_ray_slips_between_triangles)
{
    jali_mesh mesh = box_shape(-1, -1, -1, 1, 1, 1);
    ray_scene scene;
    CHECK_OK(ray_scene_create(ctx, &mesh, &scene));
    for (int32_t i = 0; i < 21 * 21 * 21; i++) {
        ray r = {{0, 0, 0}, {i % 21 - 10, i / 21 % 21 - 10, i / 441 - 10}, 0, INFINITY};
        double largest = MAX(fabs(r.along[0]), MAX(fabs(r.along[1]), fabs(r.along[2])));
        ray_hit hit;
        if (largest == 0) continue;
        CHECK(ray_nearest(&scene, &r, &hit));
        CHECK(fabs(hit.t - 1 / largest) < 1e-12);
    }
    ray_scene_free(ctx, &scene);
    jali_mesh_free(ctx, &mesh);
}

// Every vertex is inside the frame and some touch it; the hole of a torus shows the ground.
// side.
TEST(the_whole_object_is_in_the_picture)
{
    enum { SIDE = 96 };
    static uint8_t rgb[SIDE * SIDE * 3];
    jali_mesh mesh = torus(60, 24);
    ray_scene scene;
    stage s;
    jali_render_options opt = jali_render_defaults();
    CHECK_OK(ray_scene_create(ctx, &mesh, &scene));
    for (int32_t way = 0; way < 12; way++) {
        double low[2] = {1, 1}, high[2] = {-1, -1};
        opt.view[0] = cos(way), opt.view[1] = sin(way), opt.view[2] = way % 3 - 1;
        CHECK_OK(stage_create(ctx, &scene, &mesh, &opt, &s));
        for (int32_t i = 0; i < mesh.vertex_count; i++) {
            vec p = subtract((vec){mesh.vertex[i][0] - scene.origin[0], mesh.vertex[i][1] - scene.origin[1],
                                   mesh.vertex[i][2] - scene.origin[2]},
                             s.eye);
            for (int k = 0; k < 2; k++) {
                double at = dot(p, s.axis[k]) / -dot(p, s.axis[2]) / s.slope[k];
                low[k] = MIN(low[k], at);
                high[k] = MAX(high[k], at);
            }
        }
        // Inside, and touching the frame on both sides of one way.
        double wide = MAX(high[0] - low[0], high[1] - low[1]);
        CHECK(low[0] > -0.85 && low[1] > -0.85 && high[0] < 0.85 && high[1] < 0.85);
        CHECK(wide > 1.67 && wide < 1.69);
    }
    opt.width_px = opt.height_px = SIDE;
    opt.view[0] = opt.view[1] = 0, opt.view[2] = -1; // from above: the hole shows the ground
    CHECK_OK(jali_render(ctx, &mesh, &opt, rgb));
    const uint8_t *middle = rgb + 3 * (SIDE / 2 * SIDE + SIDE / 2),
                  *ring = rgb + 3 * (SIDE / 2 * SIDE + SIDE / 6);
    CHECK(ring[0] > ring[2] + 25);          // stone is warm
    CHECK(abs(middle[0] - middle[2]) < 25); // the ground is not
    ray_scene_free(ctx, &scene);
    jali_mesh_free(ctx, &mesh);
}

static uint64_t hash_of(const uint8_t *bytes, size_t count)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < count; i++) hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

TEST(the_lamp_stands_in_the_room_there_is)
{
    jali_mesh shell = together(box_shape(-10, -10, -10, 10, 10, 10), box_shape(-9, -9, -9, 9, 9, 9));
    ray_scene scene;
    stage s;
    jali_render_options opt = jali_render_defaults();
    opt.lamp = true;
    for (int32_t t = 12; t < 24; t++) flip_triangle(&shell, t);
    CHECK_OK(ray_scene_create(ctx, &shell, &scene));
    CHECK_OK(stage_create(ctx, &scene, &shell, &opt, &s));
    CHECK(length(s.bulb) < 1e-9); // the middle of the hollow
    ray_scene_free(ctx, &scene);
    shell.triangle_count = 12; // solid: behind it
    CHECK_OK(ray_scene_create(ctx, &shell, &scene));
    CHECK_OK(stage_create(ctx, &scene, &shell, &opt, &s));
    CHECK(dot(s.bulb, s.towards) < -10 && -dot(s.bulb, s.towards) < s.wall);
    ray_scene_free(ctx, &scene);
    jali_mesh_free(ctx, &shell);
}

TEST(threads_do_not_change_a_picture)
{
    enum { WIDE = 70, HIGH = 45 };
    static uint8_t rgb[3][WIDE * HIGH * 3];
    jali_context *by_threads[3];
    jali_mesh mesh = together(torus(40, 16), pierced_plate(9, 1, 0));
    open_thread_contexts(by_threads);
    for (int32_t kind = 0; kind < 3; kind++) {
        jali_render_options opt = {
            .width_px = WIDE, .height_px = HIGH, .lamp = kind == 1, .draft = kind == 2};
        for (int32_t i = 0; i < 3; i++) CHECK_INT(jali_render(by_threads[i], &mesh, &opt, rgb[i]), JALI_OK);
        CHECK(memcmp(rgb[0], rgb[1], sizeof *rgb) == 0 && memcmp(rgb[0], rgb[2], sizeof *rgb) == 0);
        CHECK(hash_of(rgb[0], sizeof *rgb) != hash_of(rgb[0], sizeof *rgb - 3));
    }
    close_thread_contexts(by_threads);
    jali_mesh_free(ctx, &mesh);
}

TEST(what_cannot_be_drawn_is_refused)
{
    static uint8_t rgb[16 * 16 * 3];
    jali_mesh block = box_shape(0, 0, 0, 1, 1, 1), nothing = {0};
    jali_render_options opt = jali_render_defaults();
    opt.width_px = 15;
    CHECK_STATUS(jali_render(ctx, &block, &opt, rgb), JALI_BAD_VALUE);
    opt.width_px = opt.height_px = 16;
    opt.view[1] = NAN;
    CHECK_STATUS(jali_render(ctx, &block, &opt, rgb), JALI_BAD_VALUE);
    opt.view[1] = 0;
    opt.lamp = true;
    CHECK_OK(jali_render(ctx, &nothing, &opt, rgb));
    block.vertex[3][1] = 1e30;
    CHECK_STATUS(jali_render(ctx, &block, &opt, rgb), JALI_BAD_INPUT);
    block.vertex[3][1] = NAN;
    CHECK_STATUS(jali_render(ctx, &block, &opt, rgb), JALI_BAD_INPUT);
    jali_mesh_free(ctx, &block);
}

static jali_status draw(jali_context *limited, void *data)
{
    static uint8_t rgb[16 * 16 * 3];
    jali_render_options opt = {.width_px = 16, .height_px = 16, .lamp = true};
    return jali_render(limited, data, &opt, rgb);
}

TEST(every_refused_allocation_is_a_status)
{
    jali_mesh mesh = torus(5, 4);
    refuse_each_allocation(draw, &mesh);
    jali_mesh_free(ctx, &mesh);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(rays_meet_a_box_where_the_formula_says), RUN(the_walk_finds_what_a_search_of_all_triangles_finds),
        RUN(no_ray_slips_between_triangles),         RUN(the_whole_object_is_in_the_picture),
        RUN(the_lamp_stands_in_the_room_there_is),   RUN(threads_do_not_change_a_picture),
        RUN(what_cannot_be_drawn_is_refused),        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
