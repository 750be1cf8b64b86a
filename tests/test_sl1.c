// SL1: archives made here; the size of a pixel, which layers count, refusals.
#include "testing.h"

#include <jali/jali.h>
#include "base/bytes.h"
#include "raster/raster.h"
#include "write/zip.h"

#include <math.h>

static const char settings[] =
    "absolute_correction = 0\ndisplay_height = 68\ndisplay_mirror_x = 1\ndisplay_orientation = "
    "portrait\ndisplay_pixels_x = 2560\ndisplay_pixels_y = 1440\ndisplay_width = 120\n";

// An archive of these settings (NULL: none) and layers, named as PrusaSlicer does, and a thumbnail.
static jali_bytes archive_of(const char *text, const jali_bitmap *const *layer, int32_t count)
{
    static const char *const name[] = {"p00000.png", "p00001.png", "p00002.png", "p00003.png", "p00004.png"};
    jali_bytes archive = {0}, png = {0};
    zip_writer zip = {0};
    if (text) CHECK_OK(zip_add(ctx, &zip, "prusaslicer.ini", text, strlen(text), 6, &archive));
    for (int32_t i = count; i-- > 0;) { // any order
        png.size = 0;
        CHECK_OK(jali_bitmap_png(ctx, layer[i], 0, &png));
        CHECK_OK(zip_add(ctx, &zip, name[i], png.data, png.size, 0, &archive));
    }
    CHECK_OK(zip_add(ctx, &zip, "thumbnail/thumbnail400x400.png", "no layer", 8, 0, &archive));
    CHECK_OK(zip_finish(ctx, &zip, &archive));
    jali_bytes_free(ctx, &png);
    return archive;
}

static jali_bitmap rectangle(int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    jali_bitmap a;
    CHECK_OK(jali_bitmap_create(ctx, 300, 200, &a));
    for (int32_t y = y0; y < y1; y++) paint_run(&a, y, x0, x1, true);
    return a;
}

TEST(the_middle_layers_count_by_majority_and_the_display_gives_their_size)
{
    jali_bitmap pad = rectangle(0, 0, 300, 200), plate = rectangle(20, 30, 120, 80),
                more = rectangle(20, 30, 130, 80);
    const jali_bitmap *const layer[] = {&pad, &plate, &more, &plate, &pad};
    jali_bytes archive = archive_of(settings, layer, 5);
    jali_print print;
    CHECK_OK(jali_print_sl1_bytes(ctx, archive.data, archive.size, "a.sl1", NULL, &print));
    CHECK(print.layers == 5 && print.first == 1 && print.last == 3 && print.looked_at == 3);
    CHECK(print.pixel_mm[0] == 120.0 / 2560 && print.pixel_mm[1] == 68.0 / 1440);
    CHECK(print.solid.width_px == 100 && print.solid.height_px == 50 &&
          count_white(ctx, &print.solid) == 5000);
    CHECK(fabs(print.size_mm[0] - 100 * 120.0 / 2560) < 1e-12 &&
          fabs(print.size_mm[1] - 50 * 68.0 / 1440) < 1e-12);
    jali_print_free(ctx, &print);
    jali_bytes_free(ctx, &archive);
    jali_bitmap_free(ctx, &pad);
    jali_bitmap_free(ctx, &plate);
    jali_bitmap_free(ctx, &more);
}

// What has an archive of layers to say when it is wrong?
static void check_refused(const void *bytes, size_t size, const jali_print_options *opt, jali_status status,
                          const char *words)
{
    jali_print print;
    CHECK_STATUS(jali_print_sl1_bytes(ctx, bytes, size, "a.sl1", opt, &print), status);
    if (!strstr(jali_message(ctx), words)) print_error("%s\n", jali_message(ctx));
    CHECK(strstr(jali_message(ctx), words) && print.solid.word == NULL);
}

TEST(refusals_are_sentences)
{
    jali_bitmap plate = rectangle(20, 30, 120, 80), empty = rectangle(0, 0, 0, 0),
                small = drawn_rows(2, "#.");
    const jali_bitmap *const good[] = {&plate, &plate}, *const mixed[] = {&plate, &small},
                             *const dark[] = {&empty};
    jali_print_options opt = jali_print_defaults();
    jali_bytes archive = archive_of(NULL, good, 2);
    opt.pixel_mm = 0;
    check_refused(archive.data, archive.size, &opt, JALI_BAD_INPUT, "how large a pixel is");
    jali_bytes_free(ctx, &archive);
    archive = archive_of("", good, 2); // settings without a byte
    check_refused(archive.data, archive.size, &opt, JALI_BAD_INPUT, "how large a pixel is");
    opt.pixel_mm = 0.05; // given by the user
    jali_print print;
    CHECK_OK(jali_print_sl1_bytes(ctx, archive.data, archive.size, "a.sl1", &opt, &print));
    CHECK(print.pixel_mm[0] == 0.05 && print.pixel_mm[1] == 0.05);
    jali_print_free(ctx, &print);
    check_refused(archive.data, archive.size - 30, &opt, JALI_BAD_INPUT, "archive");
    check_refused(archive.data, 0, &opt, JALI_BAD_INPUT, "no SL1 file");
    check_refused("G1 X5 E1\n", 9, &opt, JALI_BAD_INPUT, "no SL1 file");
    jali_bytes_free(ctx, &archive);
    archive = archive_of(settings, mixed, 2);
    check_refused(archive.data, archive.size, &opt, JALI_BAD_INPUT, "2 x 1 px, others have 300 x 200");
    jali_bytes_free(ctx, &archive);
    archive = archive_of(settings, dark, 1);
    check_refused(archive.data, archive.size, &opt, JALI_BAD_INPUT, "exposes nothing");
    jali_bytes_free(ctx, &archive);
    archive = archive_of(settings, good, 0);
    check_refused(archive.data, archive.size, &opt, JALI_BAD_INPUT, "without layers");
    jali_bytes_free(ctx, &archive);
    CHECK_STATUS(jali_print_sl1(ctx, "/nowhere.sl1", NULL, &print), JALI_IO);
    jali_bitmap_free(ctx, &plate);
    jali_bitmap_free(ctx, &empty);
    jali_bitmap_free(ctx, &small);
}

// A picture exposed on a screen of 0.05 mm, mirrored as printers do: wrong by less than half a pixel of the
// screen along its edges.
TEST(a_picture_exposed_has_the_screen_s_error)
{
    enum { SIDE_PX = 100 };
    static const double SIDE_MM = 10, FRAME_MM = 1, SCREEN_MM = 0.05;
    uint64_t seed = 17;
    jali_bitmap picture = random_blobs(&seed, SIDE_PX, SIDE_PX, 10, 50), layer = rectangle(0, 0, 0, 0);
    for (int32_t y = 0; y < 200; y++) // 12 mm are 240 px wide: the rows lie outside, the columns in
        for (int32_t x = 0; x < 300; x++) {
            double u = 12.5 - (x + 0.5) * SCREEN_MM, v = (y + 0.5) * SCREEN_MM - 0; // mirrored
            int32_t i = (int32_t)floor((u - FRAME_MM) * SIDE_PX / SIDE_MM),
                    k = (int32_t)floor(v * SIDE_PX / SIDE_MM);
            bool plate = u >= 0 && u < SIDE_MM + 2 * FRAME_MM;
            bool inside = i >= 0 && i < SIDE_PX;
            jali_bitmap_set(&layer, x, y, plate && (inside ? jali_bitmap_get(&picture, i, k) : true));
        }
    const jali_bitmap *const layers[] = {&layer};
    jali_bytes archive = archive_of(NULL, layers, 1);
    jali_print_options opt = {.pixel_mm = SCREEN_MM};
    jali_predict_options predict = jali_predict_defaults();
    jali_print print;
    jali_reference reference;
    jali_comparison c;
    predict.picture_mm = SIDE_MM;
    CHECK_OK(jali_print_sl1_bytes(ctx, archive.data, archive.size, "a.sl1", &opt, &print));
    CHECK_OK(jali_reference_create(ctx, &picture, &predict, &reference));
    // Without frame above and below: nothing is known of what lies around.
    jali_compare_options compare = {{SIDE_MM, SIDE_MM}, 0, 0.3};
    CHECK_OK(jali_compare(ctx, &reference, &print, &compare, &c));
    CHECK(c.mirrored && c.quarter_turns == 0);
    CHECK(c.print.error_rate < 1e-9); // two screen pixels are one of the picture's
    jali_comparison_free(ctx, &c);
    jali_reference_free(ctx, &reference);
    jali_print_free(ctx, &print);
    jali_bytes_free(ctx, &archive);
    jali_bitmap_free(ctx, &picture);
    jali_bitmap_free(ctx, &layer);
}

static jali_status refused_body(jali_context *limited, void *data)
{
    const jali_bytes *archive = data;
    jali_print print;
    jali_status status = jali_print_sl1_bytes(limited, archive->data, archive->size, "a.sl1", NULL, &print);
    jali_print_free(limited, &print);
    return status;
}

TEST(every_allocation_refused_once)
{
    jali_bitmap plate = rectangle(20, 30, 120, 80);
    const jali_bitmap *const layer[] = {&plate, &plate, &plate};
    jali_bytes archive = archive_of(settings, layer, 3);
    refuse_each_allocation(refused_body, &archive);
    jali_bytes_free(ctx, &archive);
    jali_bitmap_free(ctx, &plate);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_middle_layers_count_by_majority_and_the_display_gives_their_size),
        cmocka_unit_test(refusals_are_sentences),
        cmocka_unit_test(a_picture_exposed_has_the_screen_s_error),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
