// compare: prints that lie anywhere and any way up, errors counted by hand, an ideal print, refusals.
#include "testing.h"

#include <jali/jali.h>
#include "compare/lay.h"
#include "plane/rasterise.h"
#include "raster/raster.h"

#include <math.h>

enum { SIDE_PX = 120 };
static const double SIDE_MM = 30, FRAME_MM = 2;

// A picture without any symmetry: blobs, and an F that is not seen the same way from any side.
static jali_bitmap picture_of(uint64_t seed)
{
    jali_bitmap a = random_blobs(&seed, SIDE_PX, SIDE_PX - 20, 12, 50);
    for (int32_t y = 20; y < 80; y++)
        for (int32_t x = 20; x < 80; x++)
            jali_bitmap_set(&a, x, y, x < 32 || (y < 32 && x < 70) || (y > 44 && y < 56 && x < 55));
    return a;
}

static jali_reference reference_of(const jali_bitmap *picture)
{
    jali_reference reference;
    jali_predict_options opt = jali_predict_defaults();
    opt.picture_mm = SIDE_MM;
    CHECK_OK(jali_reference_create(ctx, picture, &opt, &reference));
    return reference;
}

static jali_compare_options options_of(const jali_bitmap *picture)
{
    return (jali_compare_options){{SIDE_MM, SIDE_MM * picture->height_px / picture->width_px}, FRAME_MM, 0.3};
}

// The picture in its frame, on a grid `finer` times finer than its own, off its place by so many of those
// pixels.
static jali_print print_of(const jali_bitmap *picture, int32_t finer, int32_t right, int32_t down)
{
    double pixel_mm = SIDE_MM / picture->width_px / finer;
    int32_t frame = (int32_t)lround(FRAME_MM / pixel_mm), room = 60;
    int32_t w = picture->width_px * finer, h = picture->height_px * finer;
    jali_bitmap large;
    jali_print print = {.pixel_mm = {pixel_mm, pixel_mm},
                        .size_mm = {(w + 2 * frame) * pixel_mm, (h + 2 * frame) * pixel_mm}};
    CHECK_OK(jali_bitmap_create(ctx, w, h, &large));
    CHECK_OK(jali_bitmap_create(ctx, w + 2 * (frame + room), h + 2 * (frame + room), &print.solid));
    resize_nearest(ctx, picture, 0, 0, picture->width_px, picture->height_px, &large);
    for (int32_t y = room; y < print.solid.height_px - room; y++)
        paint_run(&print.solid, y + down, room + right, print.solid.width_px - room + right, true);
    paste(ctx, &large, room + frame + right, room + frame + down, &print.solid);
    jali_bitmap_free(ctx, &large);
    return print;
}

TEST(a_perfect_print_is_found_any_way_up_and_has_no_error)
{
    jali_bitmap picture = picture_of(3);
    jali_reference reference = reference_of(&picture);
    jali_compare_options opt = options_of(&picture);
    for (int32_t way = 0; way < 8; way++) {
        int32_t right = 7 * way - 20, down = 30 - 5 * way;
        jali_print print = print_of(&picture, reference.factor, right, down);
        jali_bitmap turned;
        jali_comparison c;
        CHECK_OK(turn_bitmap(ctx, &print.solid, way % 4, way >= 4, &turned));
        jali_bitmap_free(ctx, &print.solid);
        print.solid = turned;
        CHECK_OK(jali_compare(ctx, &reference, &print, &opt, &c));
        CHECK(c.print.error_rate == 0 && c.print.missing == 0 && c.print.excess == 0 &&
              c.agreement > 1 - 1e-12);
        CHECK(c.print.recall_white == 1 && c.print.recall_black == 1);
        CHECK_INT(c.mirrored, way >= 4);
        CHECK_INT((c.quarter_turns + (c.mirrored ? 8 - way : way)) % 4, 0);
        if (way == 0) {
            CHECK(fabs(c.shift_mm[0] + right * print.pixel_mm[0]) < 1e-9);
            CHECK(fabs(c.shift_mm[1] + down * print.pixel_mm[1]) < 1e-9);
        }
        jali_comparison_free(ctx, &c);
        jali_print_free(ctx, &print);
    }
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
}

TEST(missing_excess_and_pieces_are_what_is_counted_by_hand)
{
    jali_bitmap picture = picture_of(5);
    jali_reference reference = reference_of(&picture);
    jali_compare_options opt = options_of(&picture);
    jali_print print = print_of(&picture, reference.factor, 0, 0);
    int32_t f = reference.factor, corner = (print.solid.width_px - picture.width_px * f) / 2;
    // The F loses a foot, 12 x 10 px, and gains a bar of 10 x 6 px in its void; below it lies a loose square.
    int32_t taken = 0, added = 0;
    for (int32_t y = 60 * f; y < 70 * f; y++)
        for (int32_t x = 20 * f; x < 32 * f; x++, taken++)
            jali_bitmap_set(&print.solid, corner + x, corner + y, false);
    for (int32_t y = 60 * f; y < 66 * f; y++)
        for (int32_t x = 60 * f; x < 70 * f; x++, added++)
            jali_bitmap_set(&print.solid, corner + x, corner + y, true);
    jali_bitmap_set(&print.solid, corner + 50 * f, corner + 70 * f, true); // dirt, a pixel of the grid
    jali_comparison c;
    components pieces;
    CHECK_OK(jali_compare(ctx, &reference, &print, &opt, &c));
    double all = (double)reference.picture.width_px * reference.picture.height_px;
    CHECK(c.print.missing == taken / all && c.print.excess == (added + 1) / all);
    CHECK(c.print.error_rate == (taken + added + 1) / all);
    CHECK_OK(label_components(ctx, &print.solid, true, 4, &pieces));
    CHECK_INT(c.print.pieces, pieces.count - 1); // without the dirt
    components_free(ctx, &pieces);
    jali_comparison_free(ctx, &c);
    jali_print_free(ctx, &print);
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
}

// A print of what a carving's contours hold, the picture neither compensated nor adapted: its error is that
// of the working grid, whose pixels are 0.0375 mm: less than half a pixel along each edge.
TEST(an_ideal_print_of_a_picture_s_contours_has_the_grid_s_error)
{
    static const double PHI_S_MM = 0.3;
    jali_bitmap mask, picture = picture_of(11), filled;
    jali_picture grey = {.width_px = picture.width_px, .height_px = picture.height_px};
    jali_chart chart;
    jali_contours contours;
    jali_comparison c;
    jali_place_options place = jali_place_defaults();
    jali_print print = {0};
    place.width_mm = SIDE_MM;
    place.frame_mm = FRAME_MM;
    CHECK_OK(ALLOCATE(ctx, grey.grey, picture.width_px * picture.height_px));
    for (int32_t y = 0; y < picture.height_px; y++)
        for (int32_t x = 0; x < picture.width_px; x++)
            grey.grey[y * picture.width_px + x] = jali_bitmap_get(&picture, x, y) ? 255 : 0;
    CHECK_OK(jali_place(ctx, &grey, 128, &place, &chart, &mask));
    CHECK_OK(jali_trace(ctx, &mask, &chart, NULL, &contours));
    CHECK_OK(rasterise(ctx, &contours, &chart, &filled));
    // The margin is solid as the frame is, and nearly as wide.
    double pixel_mm = jali_chart_pixel_mm(&chart);
    int32_t frame = (int32_t)lround(FRAME_MM / pixel_mm), more = frame - chart.margin_px;
    CHECK(more > 0);
    CHECK_OK(jali_bitmap_create(ctx, filled.width_px + 2 * more, filled.height_px + 2 * more, &print.solid));
    fill(ctx, &print.solid, true);
    paste(ctx, &filled, more, more, &print.solid);
    print.pixel_mm[0] = print.pixel_mm[1] = pixel_mm;
    jali_reference reference = reference_of(&picture);
    jali_compare_options opt = options_of(&picture);
    opt.phi_s_mm = PHI_S_MM;
    CHECK_OK(jali_compare(ctx, &reference, &print, &opt, &c));
    int64_t edges = 0; // sides between white and black pixels of the picture
    for (int32_t y = 1; y < picture.height_px; y++)
        for (int32_t x = 1; x < picture.width_px; x++)
            edges += (jali_bitmap_get(&picture, x, y) != jali_bitmap_get(&picture, x - 1, y)) +
                     (jali_bitmap_get(&picture, x, y) != jali_bitmap_get(&picture, x, y - 1));
    double input_mm = SIDE_MM / picture.width_px, area = opt.picture_mm[0] * opt.picture_mm[1];
    double most = (double)edges * input_mm * pixel_mm / 2 / area;
    CHECK(c.print.error_rate < most && c.agreement > 1 - 4 * most);
    CHECK(fabs(c.shift_mm[0]) <= pixel_mm && fabs(c.shift_mm[1]) <= pixel_mm);
    jali_comparison_free(ctx, &c);
    jali_print_free(ctx, &print);
    jali_reference_free(ctx, &reference);
    jali_contours_free(ctx, &contours);
    jali_chart_free(ctx, &chart);
    jali_picture_free(ctx, &grey);
    jali_bitmap_free(ctx, &filled);
    jali_bitmap_free(ctx, &mask);
    jali_bitmap_free(ctx, &picture);
}

TEST(what_does_not_fit_is_refused_with_both_sizes)
{
    jali_bitmap picture = picture_of(3), empty;
    jali_reference reference = reference_of(&picture);
    jali_compare_options opt = options_of(&picture);
    jali_print print = print_of(&picture, 4, 0, 0);
    jali_comparison c;
    print.pixel_mm[0] = print.pixel_mm[1] = print.pixel_mm[0] / 2; // half the size
    print.size_mm[0] /= 2, print.size_mm[1] /= 2;
    CHECK_STATUS(jali_compare(ctx, &reference, &print, &opt, &c), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "17.0 x 14.5 mm") && strstr(jali_message(ctx), "34.0 x 29.0 mm"));
    CHECK(c.print.printed.word == NULL && c.plate.word == NULL);
    CHECK_OK(jali_bitmap_create(ctx, 100, 100, &empty));
    jali_bitmap_free(ctx, &print.solid);
    print.solid = empty;
    CHECK_STATUS(jali_compare(ctx, &reference, &print, &opt, &c), JALI_NO_RESULT);
    opt.picture_mm[0] = 0;
    CHECK_STATUS(jali_compare(ctx, &reference, &print, &opt, &c), JALI_BAD_VALUE);
    jali_print none = {0};
    CHECK_STATUS(jali_compare(ctx, &reference, &none, &opt, &c), JALI_BAD_VALUE);
    jali_print_free(ctx, &print);
    jali_reference_free(ctx, &reference);
    jali_bitmap_free(ctx, &picture);
}

typedef struct subject {
    jali_reference reference;
    jali_print print;
    jali_compare_options opt;
} subject;

static jali_status compare_body(jali_context *limited, void *data)
{
    const subject *s = data;
    jali_comparison c;
    jali_status status = jali_compare(limited, &s->reference, &s->print, &s->opt, &c);
    jali_comparison_free(limited, &c);
    return status;
}

static subject subject_of(const jali_bitmap *picture)
{
    jali_bitmap turned;
    subject s = {reference_of(picture), print_of(picture, 4, 3, -2), options_of(picture)};
    CHECK_OK(turn_bitmap(ctx, &s.print.solid, 3, true, &turned));
    jali_bitmap_free(ctx, &s.print.solid);
    s.print.solid = turned;
    return s;
}

static void subject_free(subject *s)
{
    jali_reference_free(ctx, &s->reference);
    jali_print_free(ctx, &s->print);
}

TEST(every_allocation_refused_once)
{
    jali_bitmap picture = picture_of(3);
    subject s = subject_of(&picture);
    refuse_each_allocation(compare_body, &s);
    subject_free(&s);
    jali_bitmap_free(ctx, &picture);
}

TEST(threads_do_not_change_a_comparison)
{
    jali_context *by_threads[3];
    jali_comparison c[3];
    jali_bitmap picture = picture_of(4);
    subject s = subject_of(&picture);
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        CHECK_INT(jali_compare(by_threads[i], &s.reference, &s.print, &s.opt, &c[i]), JALI_OK);
        CHECK(same_bitmap(&c[i].plate, &c[0].plate) && c[i].agreement == c[0].agreement);
    }
    for (int32_t i = 0; i < 3; i++) jali_comparison_free(by_threads[i], &c[i]);
    close_thread_contexts(by_threads);
    subject_free(&s);
    jali_bitmap_free(ctx, &picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_perfect_print_is_found_any_way_up_and_has_no_error),
        cmocka_unit_test(missing_excess_and_pieces_are_what_is_counted_by_hand),
        cmocka_unit_test(an_ideal_print_of_a_picture_s_contours_has_the_grid_s_error),
        cmocka_unit_test(what_does_not_fit_is_refused_with_both_sizes),
        cmocka_unit_test(every_allocation_refused_once),
        cmocka_unit_test(threads_do_not_change_a_comparison),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
