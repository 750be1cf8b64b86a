// nudge: edges end where the printer puts them right, and nothing ever gets worse.
#include "testing.h"

#include <jali/jali.h>
#include <jali/sample.h>

#include <math.h>

enum { MARGIN = 130 }; // of pixels of a hundredth of a mm; in proportion for others

// A picture in a frame of solid.
typedef struct scene {
    double pixel_mm;
    int32_t margin_px;
    jali_bitmap picture;
    jali_chart chart;
    jali_reference reference;
    jali_optimise_options optimise;
    jali_predict_options printer;
    jali_optimised result;
} scene;

// The picture itself, less what the optimiser thinks that the printer adds.
static jali_status open_scene(jali_context *c, const jali_bitmap *picture, scene *s)
{
    jali_status status;
    jali_bitmap drawing = {0};
    s->chart = (jali_chart){.width_px = picture->width_px + 2 * s->margin_px,
                            .height_px = picture->height_px + 2 * s->margin_px,
                            .margin_px = s->margin_px,
                            .outside_solid = true,
                            .pixel_units = 16,
                            .unit_mm = s->pixel_mm / 16};
    s->printer.picture_mm = picture->width_px * s->pixel_mm;
    s->printer.recall = false;
    TRY(jali_bitmap_create(c, s->chart.width_px, s->chart.height_px, &drawing));
    for (int y = 0; y < drawing.height_px; y++)
        for (int x = 0; x < drawing.width_px; x++) {
            int u = x - s->margin_px, v = y - s->margin_px;
            bool outside = u < 0 || v < 0 || u >= picture->width_px || v >= picture->height_px;
            jali_bitmap_set(&drawing, x, y, outside || jali_bitmap_get(picture, u, v));
        }
    TRY(jali_reference_create(c, picture, &s->printer, &s->reference));
    TRY(jali_optimise(c, &drawing, &s->chart, &s->optimise, &s->result));
done:
    jali_bitmap_free(c, &drawing);
    return status;
}

static void close_scene(jali_context *c, scene *s)
{
    jali_reference_free(c, &s->reference);
    jali_optimised_free(c, &s->result);
}

static scene plain_scene(void)
{
    return (scene){.pixel_mm = 0.01,
                   .margin_px = MARGIN,
                   .optimise = jali_optimise_defaults(),
                   .printer = jali_predict_defaults()};
}

// Two slots 1 and 3 mm wide (the second one cut by a bar of 1 mm) in a plate of 9 x 6 mm.
static jali_bitmap slots(jali_context *c)
{
    jali_bitmap b = {0};
    if (jali_bitmap_create(c, 900, 600, &b) != JALI_OK) return b;
    for (int y = 0; y < 600; y++)
        for (int x = 0; x < 900; x++) {
            bool slot = (x >= 150 && x < 250) || (x >= 450 && x < 750);
            bool bar = x >= 550 && x < 650;
            jali_bitmap_set(&b, x, y, y < 100 || y >= 500 || !slot || bar);
        }
    return b;
}

// White pixels of row y between two columns.
static int32_t white_in(const jali_bitmap *b, int32_t y, int32_t x0, int32_t x1)
{
    int32_t count = 0;
    for (int32_t x = x0; x < x1; x++) count += jali_bitmap_get(b, x, y);
    return count;
}

TEST(a_growth_that_the_optimiser_did_not_know_is_taken_off)
{
    jali_bitmap picture = slots(ctx);
    scene s = plain_scene();
    s.printer.phi_e_solid_mm = s.printer.phi_e_void_mm = 0.2; // it was told 0.1
    CHECK_OK(open_scene(ctx, &picture, &s));
    jali_nudge_report report;
    jali_prediction print;
    CHECK_OK(jali_nudge(ctx, &s.reference, &s.printer, &s.chart, &s.optimise, 4, &s.result, &report));
    CHECK(report.error_before > 5 * report.error_after);
    CHECK_OK(jali_predict(ctx, &s.reference, &s.result.mask, MARGIN, true, &s.printer, &print));
    CHECK(fabs(print.error_rate - report.error_after) < 1e-12);
    double fine = (double)print.printed.width_px / picture.width_px;
    int32_t middle = print.printed.height_px / 2;
    // The bar between the wider slots, and the void of the narrow one, within two hundredths of a mm.
    CHECK(fabs(white_in(&print.printed, middle, (int32_t)(500 * fine), (int32_t)(700 * fine)) / fine - 100) <=
          2);
    CHECK(fabs(200 - white_in(&print.printed, middle, (int32_t)(100 * fine), (int32_t)(300 * fine)) / fine -
               100) <= 2);
    jali_prediction_free(ctx, &print);
    close_scene(ctx, &s);
    jali_bitmap_free(ctx, &picture);
}

TEST(narrow_voids_that_print_narrower_are_drawn_wider)
{
    jali_bitmap picture = slots(ctx);
    scene s = plain_scene();
    s.printer.phi_e_void_mm = 0.3;
    CHECK_OK(open_scene(ctx, &picture, &s));
    jali_nudge_report report;
    CHECK_OK(jali_nudge(ctx, &s.reference, &s.printer, &s.chart, &s.optimise, 4, &s.result, &report));
    CHECK(report.error_after < 0.3 * report.error_before);
    CHECK(report.rounds >= 1 && report.changed_px > 1000);
    close_scene(ctx, &s);
    jali_bitmap_free(ctx, &picture);
}

TEST(no_rounds_change_nothing)
{
    jali_bitmap picture = slots(ctx);
    scene s = plain_scene();
    jali_bitmap before;
    jali_nudge_report report;
    CHECK_OK(open_scene(ctx, &picture, &s));
    CHECK_OK(jali_bitmap_copy(ctx, &s.result.mask, &before));
    CHECK_OK(jali_nudge(ctx, &s.reference, &s.printer, &s.chart, &s.optimise, 0, &s.result, &report));
    CHECK(same_bitmap(&before, &s.result.mask));
    CHECK_INT(report.changed_px, 0);
    CHECK_STATUS(jali_nudge(ctx, &s.reference, &s.printer, &s.chart, &s.optimise, 101, &s.result, &report),
                 JALI_BAD_VALUE);
    CHECK_STATUS(jali_nudge(ctx, &s.reference, &s.printer, &s.chart, &s.optimise, -1, &s.result, &report),
                 JALI_BAD_VALUE);
    CHECK(same_bitmap(&before, &s.result.mask));
    jali_bitmap_free(ctx, &before);
    close_scene(ctx, &s);
    jali_bitmap_free(ctx, &picture);
}

static jali_picture grey_of(jali_context *c, const jali_bitmap *b)
{
    jali_picture picture = {.width_px = b->width_px, .height_px = b->height_px};
    CHECK_OK(allocate_array(c, &picture.grey, (size_t)(b->width_px * b->height_px), 1));
    for (int i = 0; i < b->width_px * b->height_px; i++)
        picture.grey[i] = jali_bitmap_get(b, i % b->width_px, i / b->width_px) ? 255 : 0;
    return picture;
}

// The whole run with so many threads; its predicted error, its mask copied out.
static double run(const jali_bitmap *sample, double phi_e_void_mm, int32_t rounds, int32_t threads,
                  jali_bitmap *mask)
{
    jali_context *own;
    jali_context_options copt = jali_context_defaults();
    copt.threads = threads;
    CHECK_INT(jali_context_create(&copt, &own), JALI_OK);
    jali_picture picture = grey_of(own, sample);
    jali_options opt = jali_defaults();
    jali_result r;
    opt.place.width_mm = 12;
    opt.solid = false;
    opt.nudge_rounds = rounds;
    CHECK_OK(jali_printer_find(own, "hori-z500", NULL, &opt.printer));
    opt.printer.phi_e_void_mm.value = phi_e_void_mm;
    CHECK_OK(jali_make(own, &picture, &opt, &r));
    CHECK(r.one_piece && r.printable);
    double error = r.result_print.error_rate;
    if (rounds) CHECK(fabs(error - r.nudge.error_after) < 1e-12);
    CHECK_OK(jali_bitmap_copy(ctx, &r.optimised.mask, mask));
    jali_result_free(own, &r);
    jali_picture_free(own, &picture);
    jali_context_free(own);
    return error;
}

// Whatever the printer: the error that a run reports is never above that without, the promises hold, and any
// number of threads makes the same mask.
TEST(samples_never_get_worse_with_any_threads)
{
    static const char *const NAMES[] = {"girih", "tree", "lettering"};
    for (int k = 0; k < 3; k++) {
        jali_bitmap sample, mask[3];
        CHECK_OK(jali_sample(ctx, NAMES[k], 120, &sample));
        double phi_e_void_mm = k == 1 ? 0.25 : 0.1;
        double without = run(&sample, phi_e_void_mm, 0, 1, &mask[0]),
               one = run(&sample, phi_e_void_mm, 2, 1, &mask[1]),
               three = run(&sample, phi_e_void_mm, 2, 3, &mask[2]);
        CHECK(one <= without);
        CHECK(one == three);
        CHECK(same_bitmap(&mask[1], &mask[2]));
        for (int way = 0; way < 3; way++) jali_bitmap_free(ctx, &mask[way]);
        jali_bitmap_free(ctx, &sample);
    }
}

static jali_status nudge_small(jali_context *limited, void *data)
{
    jali_status status;
    scene s = plain_scene();
    jali_nudge_report report;
    s.pixel_mm = 0.05;
    s.margin_px = MARGIN / 5;
    s.printer.phi_e_void_mm = 0.2;
    TRY(open_scene(limited, data, &s));
    TRY(jali_nudge(limited, &s.reference, &s.printer, &s.chart, &s.optimise, 1, &s.result, &report));
done:
    close_scene(limited, &s);
    return status;
}

TEST(every_allocation_may_be_refused)
{
    jali_bitmap picture;
    CHECK_OK(jali_bitmap_create(ctx, 40, 40, &picture));
    for (int i = 0; i < 40 * 40; i++) jali_bitmap_set(&picture, i % 40, i / 40, i % 40 < 10 || i % 40 > 30);
    refuse_each_allocation(nudge_small, &picture);
    jali_bitmap_free(ctx, &picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_growth_that_the_optimiser_did_not_know_is_taken_off),
        cmocka_unit_test(narrow_voids_that_print_narrower_are_drawn_wider),
        cmocka_unit_test(no_rounds_change_nothing),
        cmocka_unit_test(samples_never_get_worse_with_any_threads),
        cmocka_unit_test(every_allocation_may_be_refused),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
