// Low bridges: as deep as asked for, nothing else changes, and the solid is one at every depth.
#include "testing.h"

#include <jali/jali.h>
#include "raster/raster.h"

#include <math.h>

static jali_picture blobs(uint64_t seed, int32_t width, int32_t height)
{
    jali_picture picture = {.width_px = width, .height_px = height};
    jali_bitmap drawn = random_blobs(&seed, width, height, 12, 45);
    CHECK_OK(ALLOCATE(ctx, picture.grey, (size_t)width * (size_t)height));
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            picture.grey[y * width + x] = jali_bitmap_get(&drawn, x, y) ? 255 : 0;
    jali_bitmap_free(ctx, &drawn);
    return picture;
}

// A disc in the middle of nothing: one bridge holds it.
static jali_picture island(void)
{
    jali_picture picture = {.width_px = 100, .height_px = 100};
    CHECK_OK(ALLOCATE_CLEARED(ctx, picture.grey, 10000));
    for (int32_t y = 0; y < 100; y++)
        for (int32_t x = 0; x < 100; x++)
            if (hypot(x - 40, y - 50) < 20) picture.grey[100 * y + x] = 255;
    return picture;
}

static jali_result made(jali_picture picture, double depth_mm)
{
    jali_options opt = jali_defaults();
    jali_result r;
    opt.place.width_mm = 20;
    opt.carve.thickness_mm = 3;
    opt.bridge_depth_mm = depth_mm;
    opt.predict = false;
    opt.optimise.mark_bridges = true;
    CHECK_OK(jali_make(ctx, &picture, &opt, &r));
    jali_picture_free(ctx, &picture);
    return r;
}

static double bridge_area_mm2(const jali_result *r)
{
    double pixel = jali_chart_pixel_mm(&r->chart);
    return (double)count_combined(ctx, RULE_AND, &r->optimised.mask, &r->optimised.bridge_mask) * pixel *
           pixel;
}

TEST(a_bridge_is_as_deep_as_asked_for)
{
    jali_result full = made(island(), 0);
    CHECK(full.closed && bridge_area_mm2(&full) > 1);
    for (int i = 1; i < 4; i++) {
        double depth = 0.7 * i, unit = full.chart.unit_mm;
        jali_result r = made(island(), depth);
        CHECK(r.closed && r.one_piece && r.printable);
        CHECK_INT(r.check.genus, full.check.genus);
        double missing = full.check.volume_mm3 - r.check.volume_mm3;
        CHECK(fabs(missing - bridge_area_mm2(&r) * (3 - depth)) < 0.05 * missing);
        int32_t between = 0; // heights are those of the plate and that of the bridge
        for (int32_t v = 0; v < r.mesh.vertex_count; v++) {
            double z = r.mesh.vertex[v][2];
            bool low = fabs(z - depth) <= unit;
            CHECK(z == 0 || low || fabs(z - 3) <= unit);
            between += low;
        }
        CHECK(between >= 4);
        CHECK(count_combined(ctx, RULE_XOR, &r.optimised.mask, &full.optimised.mask) == 0);
        jali_result_free(ctx, &r);
    }
    jali_result_free(ctx, &full);
}

TEST(random_pictures_make_solids_with_low_bridges)
{
    for (uint64_t seed = 1; seed <= 12; seed++) {
        jali_result full = made(blobs(seed, 150, 110), 0), r = made(blobs(seed, 150, 110), 1);
        CHECK(r.closed && r.one_piece && r.printable);
        CHECK_INT(r.check.genus, full.check.genus);
        double missing = full.check.volume_mm3 - r.check.volume_mm3, area = bridge_area_mm2(&r);
        CHECK(fabs(missing - 2 * area) < 0.1 * missing + 0.2);
        jali_result_free(ctx, &full);
        jali_result_free(ctx, &r);
    }
}

// On surfaces the hidden side is the inner skin; the outer skin of what stays is as it was.
TEST(on_surfaces_bridges_lie_inside)
{
    static const char *const surface[] = {"cylinder:r=15,h=40", "sphere:r=18", "vase:column,h=60,r=12"};
    for (int i = 0; i < 6; i++) {
        double volume[2], area = 0;
        int64_t genus[2];
        for (int low = 0; low < 2; low++) {
            jali_picture picture = island();
            jali_options opt = jali_defaults();
            jali_surface s;
            jali_result r;
            jali_object o;
            opt.place.width_mm = i < 3 ? 18 : 0;
            opt.place.frame_mm = 1;
            opt.around = i >= 3;
            opt.repeat = i < 3 ? 1 : 4;
            opt.predict = false;
            opt.optimise.mark_bridges = true;
            opt.bridge_depth_mm = low ? 0.6 : 0;
            CHECK_OK(jali_surface_make(ctx, surface[i % 3], NULL, &s));
            CHECK_OK(jali_make_on(ctx, &s, NULL, &picture, &opt, 1, &r, &o));
            CHECK(o.closed && o.one_piece);
            volume[low] = o.check.volume_mm3;
            genus[low] = o.check.genus;
            area = bridge_area_mm2(&r);
            jali_result_free(ctx, &r);
            jali_object_free(ctx, &o);
            jali_picture_free(ctx, &picture);
        }
        CHECK_INT(genus[0], genus[1]);
        double missing = volume[0] - volume[1];
        CHECK(area > 0.5 && missing > 0.5 * area * 1.4 && missing < 1.3 * area * 1.4);
    }
}

TEST(depths_that_cannot_be_are_refused)
{
    static const double depth[] = {0.1, 3, 7};
    for (int i = 0; i < 3; i++) {
        jali_picture picture = island();
        jali_options opt = jali_defaults();
        jali_result r;
        opt.place.width_mm = 20;
        opt.carve.thickness_mm = 3;
        opt.bridge_depth_mm = depth[i];
        CHECK_STATUS(jali_make(ctx, &picture, &opt, &r), JALI_BAD_VALUE);
        CHECK(strstr(jali_message(ctx), "is accepted") != NULL);
        opt.bridge_depth_mm = 1;
        opt.structure = true;
        CHECK_STATUS(jali_make(ctx, &picture, &opt, &r), JALI_BAD_VALUE);
        jali_picture_free(ctx, &picture);
    }
}

static jali_status lower_some(jali_context *limited, void *data)
{
    const jali_result *r = data;
    jali_contours low = {0};
    jali_mesh mesh = {0};
    jali_carve_options opt = jali_carve_defaults();
    jali_status status;
    TRY(jali_trace_bridges(limited, &r->optimised, &r->chart, false, NULL, &low));
    opt.frame_mm = 2;
    TRY(jali_carve_stepped(limited, &r->contours, &low, 1, &r->chart, &opt, &mesh));
done:
    jali_contours_free(limited, &low);
    jali_mesh_free(limited, &mesh);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_result r = made(island(), 0);
    jali_contours_free(ctx, &r.contours);
    CHECK_OK(jali_trace(ctx, &r.optimised.mask, &r.chart, NULL, &r.contours));
    refuse_each_allocation(lower_some, &r);
    jali_result_free(ctx, &r);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(a_bridge_is_as_deep_as_asked_for), RUN(random_pictures_make_solids_with_low_bridges),
        RUN(on_surfaces_bridges_lie_inside),   RUN(depths_that_cannot_be_are_refused),
        RUN(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
