// Calibration from a scan: boards with known errors, scanned and photographed; scans that cannot be trusted.
#include "testing.h"
#include "printed.h"

#include <jali/calibrate.h>
#include <jali/predict.h>
#include "raster/raster.h"

static const double DPI = 100; // enough for the coarse board: a tenth of the pixels

// A coarse board, so that its scans are small.
static jali_board coarse_board(void)
{
    jali_board board;
    jali_board_options opt = jali_board_defaults();
    opt.phi_s_mm = opt.phi_v_mm = 1;
    CHECK_OK(jali_board_layout(ctx, &opt, &board));
    return board;
}

// The width that column i of a kind has.
static double width_of(const jali_board *b, jali_board_kind kind, int32_t column)
{
    for (int32_t i = 0; i < b->feature_count; i++)
        if (b->feature[i].kind == kind) return b->feature[i + column].width_mm;
    return NAN;
}

// A print with errors at random; the plate's bitmap is freed by the caller.
static printed some_print(const jali_board *b, jali_bitmap *plate, uint64_t *seed)
{
    double pixel_mm = 0.05;
    CHECK_OK(jali_board_bitmap(ctx, b, &pixel_mm, plate));
    return (printed){
        .board = b,
        .plate = plate,
        .plate_pixel_mm = pixel_mm,
        .e_solid = 0.02 + 0.18 * look_share(seed),
        .e_void = 0.02 + 0.18 * look_share(seed),
        .phi_s = width_of(b, JALI_BOARD_SOLID, 3 + (int32_t)(look_random(seed) % 6)) - 1e-6,
        .phi_v = width_of(b, JALI_BOARD_VOID, 3 + (int32_t)(look_random(seed) % 6)) - 1e-6,
        .hole_mm2 = 0.05 * look_share(seed),
        .corner_mm = 0.3 * look_share(seed),
    };
}

static jali_status calibrate_picture(jali_context *c, const jali_picture *picture,
                                     const jali_scan_options *opt, jali_scan *scan,
                                     jali_calibration *calibration)
{
    jali_widths widths = {0};
    jali_status status = jali_scan_board(c, picture, opt, scan);
    if (status == JALI_OK) status = jali_scan_widths(c, scan, &widths);
    if (status == JALI_OK) status = jali_calibrate(c, &widths, calibration);
    if (status != JALI_OK) jali_scan_free(c, scan);
    jali_widths_free(c, &widths);
    return status;
}

static void check_figures(const printed *p, const jali_calibration *c, double tolerance)
{
    CHECK(fabs(c->phi_e_solid.value - p->e_solid) < tolerance);
    CHECK(fabs(c->phi_e_void.value - p->e_void) < tolerance);
    CHECK(c->phi_s.bounded && fabs(c->phi_s.value_mm - p->phi_s) < 1e-4);
    CHECK(c->phi_v.bounded && fabs(c->phi_v.value_mm - p->phi_v) < 1e-4);
}

TEST(scans_and_photographs_give_back_what_was_printed)
{
    jali_board board = coarse_board();
    for (uint64_t n = 0; n < 6; n++) {
        uint64_t seed = 977 * n + 5;
        jali_bitmap plate;
        printed p = some_print(&board, &plate, &seed);
        look l = some_look(&board, n % 2, DPI * (n % 2 ? 1.3 : 1), &seed);
        jali_picture picture = looked_at(&p, &l);
        jali_scan scan;
        jali_calibration c;
        CHECK_OK(calibrate_picture(ctx, &picture, NULL, &scan, &c));
        check_figures(&p, &c, 0.02);
        CHECK(scan.code_read && scan.mirrored == l.mirrored && scan.dark == (l.through < l.solid));
        CHECK(fabs(c.hole.value - p.hole_mm2) < 0.04);
        CHECK(p.corner_mm < 0.25 || fabs(scan.corner_mm - p.corner_mm) < 0.1);
        jali_scan_free(ctx, &scan);
        jali_bitmap_free(ctx, &plate);
        free(picture.grey);
    }
    jali_board_free(ctx, &board);
}

// The board of a 0.4 mm nozzle, as a scanner at 300 dpi sees it.
TEST(a_usual_board_at_300_dpi)
{
    jali_board board;
    uint64_t seed = 31;
    jali_bitmap plate;
    CHECK_OK(jali_board_layout(ctx, NULL, &board));
    printed p = some_print(&board, &plate, &seed);
    look l = some_look(&board, false, 300, &seed);
    p.corner_mm = 0.2;
    jali_picture picture = looked_at(&p, &l);
    jali_scan scan;
    jali_calibration c;
    CHECK_OK(calibrate_picture(ctx, &picture, NULL, &scan, &c));
    check_figures(&p, &c, 0.005);
    CHECK(fabs(c.hole.value - p.hole_mm2) < 0.01 && fabs(scan.corner_mm - p.corner_mm) < 0.03);
    jali_bytes png = {0};
    CHECK_OK(jali_scan_map(ctx, &picture, &scan, &png));
    CHECK(png.size > 1000 && memcmp(png.data, "\x89PNG", 4) == 0);
    jali_bytes_free(ctx, &png);
    jali_scan_free(ctx, &scan);
    jali_bitmap_free(ctx, &plate);
    jali_board_free(ctx, &board);
    free(picture.grey);
}

// A plain scan of the coarse board, for what is done to it afterwards.
typedef struct plain_scan {
    jali_board board;
    jali_bitmap plate;
    printed p;
    look l;
    jali_picture picture;
} plain_scan;

static plain_scan plain(void)
{
    static jali_board board;
    static jali_bitmap plate;
    uint64_t seed = 12;
    board = coarse_board();
    plain_scan s = {.board = board};
    s.p = some_print(&board, &plate, &seed);
    s.plate = plate;
    s.l = some_look(&board, false, DPI, &seed);
    s.l.turn = 0.05;
    s.l.mirrored = false;
    s.l.noise = 0.005;
    s.l.blur_px = 0.6;
    s.l.solid = 0.2;
    s.l.through = 0.85;
    s.picture = looked_at(&s.p, &s.l);
    return s;
}

static void plain_scan_free(plain_scan *s)
{
    jali_board_free(ctx, &s->board);
    jali_bitmap_free(ctx, &s->plate);
    free(s->picture.grey);
}

// Turned by quarters, and flipped first.
static jali_picture turned(const jali_picture *p, int32_t quarters, bool flip)
{
    bool wide = quarters % 2;
    jali_picture t = {.width_px = wide ? p->height_px : p->width_px,
                      .height_px = wide ? p->width_px : p->height_px};
    t.grey = malloc((size_t)p->width_px * (size_t)p->height_px);
    for (int32_t y = 0; y < p->height_px; y++)
        for (int32_t x = 0; x < p->width_px; x++) {
            int32_t u = flip ? p->width_px - 1 - x : x, v = y;
            for (int32_t k = 0, w = p->width_px, h = p->height_px; k < quarters; k++) {
                int32_t keep = u;
                u = h - 1 - v;
                v = keep;
                keep = w;
                w = h;
                h = keep;
            }
            t.grey[(size_t)v * (size_t)t.width_px + (size_t)u] =
                p->grey[(size_t)y * (size_t)p->width_px + (size_t)x];
        }
    return t;
}

TEST(upside_down_and_from_behind_are_corrected)
{
    plain_scan s = plain();
    jali_calibration first = {0};
    for (int32_t way = 0; way < 16; way++) { // and as negatives
        jali_picture t = turned(&s.picture, way % 4, way & 4);
        for (size_t i = 0; way & 8 && i < (size_t)t.width_px * (size_t)t.height_px; i++)
            t.grey[i] = (uint8_t)(255 - t.grey[i]);
        jali_scan scan;
        jali_calibration c;
        CHECK_OK(calibrate_picture(ctx, &t, NULL, &scan, &c));
        check_figures(&s.p, &c, 0.02);
        if (way == 0) first = c;
        CHECK(fabs(c.phi_e_solid.value - first.phi_e_solid.value) < 0.003);
        CHECK(scan.mirrored == (bool)(way & 4) && scan.dark == (bool)(way & 8));
        jali_scan_free(ctx, &scan);
        free(t.grey);
    }
    plain_scan_free(&s);
}

TEST(with_dpi_a_print_that_shrank_is_told)
{
    plain_scan s = plain();
    jali_scan_options opt = {.dpi = DPI / 0.99}; // the scanner saw finer, so the print is smaller
    jali_scan scan;
    jali_calibration c;
    CHECK_OK(calibrate_picture(ctx, &s.picture, &opt, &scan, &c));
    CHECK(fabs(scan.scale[0] - 0.99) < 5e-4 && fabs(scan.scale[1] - 0.99) < 5e-4);
    jali_scan_free(ctx, &scan);
    plain_scan_free(&s);
}

static jali_picture shrunk(const jali_picture *p, int32_t k)
{
    jali_picture t = {.width_px = p->width_px / k, .height_px = p->height_px / k};
    t.grey = malloc((size_t)t.width_px * (size_t)t.height_px);
    for (int32_t y = 0; y < t.height_px; y++)
        for (int32_t x = 0; x < t.width_px; x++) {
            int32_t sum = 0;
            for (int32_t i = 0; i < k * k; i++)
                sum += p->grey[(size_t)(y * k + i / k) * (size_t)p->width_px + (size_t)(x * k + i % k)];
            t.grey[(size_t)y * (size_t)t.width_px + (size_t)x] = (uint8_t)(sum / (k * k));
        }
    return t;
}

static jali_picture plain_grey(int32_t width, int32_t height, int32_t level, int32_t noise)
{
    jali_picture p = {.width_px = width, .height_px = height, .grey = malloc((size_t)width * (size_t)height)};
    uint64_t seed = 3;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        p.grey[i] = (uint8_t)(level + (noise ? (int32_t)(next_random(&seed) >> 33) % noise : 0));
    return p;
}

static void check_refused(jali_picture p, const char *says)
{
    jali_scan scan;
    CHECK_STATUS(jali_scan_board(ctx, &p, NULL, &scan), JALI_NO_RESULT);
    if (!strstr(jali_message(ctx), says)) print_error("not \"%s\": %s\n", says, jali_message(ctx));
    CHECK(strstr(jali_message(ctx), says));
    CHECK(scan.feature == NULL && scan.board.feature_count == 0);
    free(p.grey);
}

TEST(bad_scans_end_in_a_sentence)
{
    plain_scan s = plain();
    check_refused(plain_grey(800, 600, 255, 0), "no reference board");
    check_refused(plain_grey(1, 1, 0, 0), "no reference board");
    check_refused(plain_grey(3, 2000, 90, 0), "no reference board");
    check_refused(plain_grey(700, 500, 20, 200), "no reference board");
    check_refused(shrunk(&s.picture, 5), "no reference board"); // 20 dpi
    check_refused(shrunk(&s.picture, 2), "at least 150 dpi");
    jali_picture half = turned(&s.picture, 0, false);
    half.height_px /= 2;
    check_refused(half, "no reference board");
    jali_picture flat = turned(&s.picture, 0, false); // grey in grey
    for (size_t i = 0; i < (size_t)flat.width_px * (size_t)flat.height_px; i++)
        flat.grey[i] = (uint8_t)(100 + flat.grey[i] / 10);
    check_refused(flat, "grey levels");
    plain_scan_free(&s);
}

// The far marks of a tilted board are small, and beside them lies what looks like void: the table.
TEST(a_tilted_board_is_registered_to_its_far_corner)
{
    plain_scan s = plain();
    for (int way = 0; way < 4; way++) {
        look l = s.l;
        l.px_per_mm = 130 / 25.4;
        l.width = (int32_t)(1.35 * s.board.width_mm * l.px_per_mm);
        l.height = (int32_t)(1.35 * s.board.height_mm * l.px_per_mm);
        l.aside[0] = l.aside[1] = 0;
        l.tilt[0] = way & 1 ? 0.08 : -0.08;
        l.tilt[1] = way & 2 ? 0.08 : -0.08;
        jali_picture picture = looked_at(&s.p, &l);
        jali_scan scan;
        jali_calibration c;
        CHECK_OK(calibrate_picture(ctx, &picture, NULL, &scan, &c));
        check_figures(&s.p, &c, 0.01);
        CHECK(scan.residual_mm < 0.02 && !c.phi_e_solid.doubtful && !c.phi_e_void.doubtful);
        for (int k = 0; k < 4; k++) {
            double board[2], *h = scan.map, x = s.board.mark_mm[k][0], y = s.board.mark_mm[k][1];
            double w = h[6] * x + h[7] * y + h[8];
            look_through(&l, &s.board, (h[0] * x + h[1] * y + h[2]) / w, (h[3] * x + h[4] * y + h[5]) / w,
                         board);
            CHECK(hypot(board[0] - x, board[1] - y) < 0.05);
        }
        jali_scan_free(ctx, &scan);
        free(picture.grey);
    }
    plain_scan_free(&s);
}

// A lens bends what eight ratios cannot take back; 0.12 mm of it are accepted.
TEST(a_bent_board_is_measured_or_refused)
{
    static const struct {
        double lens;
        bool accepted;
    } cases[] = {{0.004, true}, {0.02, true}, {0.03, false}, {-0.02, true}, {-0.03, false}};
    plain_scan s = plain();
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        look l = s.l;
        l.lens = cases[n].lens;
        jali_picture picture = looked_at(&s.p, &l);
        jali_scan scan;
        jali_calibration c;
        jali_scan_options opt = {.board = &s.board}; // its code is bent as well
        jali_status status = calibrate_picture(ctx, &picture, &opt, &scan, &c);
        if (cases[n].accepted) {
            CHECK_INT(status, JALI_OK);
            check_figures(&s.p, &c, 0.02);
            CHECK(scan.residual_mm < 0.12 && (fabs(l.lens) < 0.01 || scan.residual_mm > 0.08));
            jali_scan_free(ctx, &scan);
        } else {
            CHECK_INT(status, JALI_NO_RESULT);
            CHECK(strstr(jali_message(ctx), "bent in the picture"));
            CHECK(strstr(jali_message(ctx), "0.12 mm at most"));
        }
        free(picture.grey);
    }
    plain_scan_free(&s);
}

TEST(a_lost_code_is_said_and_can_be_given)
{
    plain_scan s = plain();
    // A strip of tape along the lower edge, between the marks.
    for (int32_t y = 0; y < s.picture.height_px; y++)
        for (int32_t x = 0; x < s.picture.width_px; x++) {
            double at[2];
            look_through(&s.l, &s.board, x + 0.5, y + 0.5, at);
            if (fabs(at[1] - s.board.code_mm[0][1]) < s.board.code_side_mm && at[0] > 12 &&
                at[0] < s.board.width_mm - 12)
                s.picture.grey[(size_t)y * (size_t)s.picture.width_px + (size_t)x] = 50;
        }
    jali_scan scan;
    jali_calibration c;
    CHECK_STATUS(jali_scan_board(ctx, &s.picture, NULL, &scan), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "code") && strstr(jali_message(ctx), "--phi-s"));
    jali_scan_options opt = {.board = &s.board};
    CHECK_OK(calibrate_picture(ctx, &s.picture, &opt, &scan, &c));
    CHECK(!scan.code_read);
    check_figures(&s.p, &c, 0.02);
    jali_scan_free(ctx, &scan);
    plain_scan_free(&s);
}

// Board -> the forward model of predict -> calibrate.
TEST(what_predict_prints_comes_back_as_the_profile)
{
    static const struct {
        double e_solid, e_void;
        int32_t s, v;
    } cases[] = {{0.12, 0.12, 6, 6}, {0.2, 0.08, 4, 7}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        jali_board board;
        jali_board_options coarse = {.phi_s_mm = 0.5, .phi_v_mm = 0.5, .most_mm = 200, .thickness_mm = 2};
        jali_bitmap drawn, mask;
        jali_reference reference;
        jali_prediction print;
        double pixel_mm = 0.02;
        enum { MARGIN = 120, SHRINK = 6 };
        CHECK_OK(jali_board_layout(ctx, &coarse, &board));
        CHECK_OK(jali_board_bitmap(ctx, &board, &pixel_mm, &drawn));
        CHECK_OK(jali_bitmap_create(ctx, drawn.width_px + 2 * MARGIN, drawn.height_px + 2 * MARGIN, &mask));
        paste(ctx, &drawn, MARGIN, MARGIN, &mask);
        jali_predict_options opt = jali_predict_defaults();
        opt.picture_mm = mask.width_px * pixel_mm;
        opt.phi_e_solid_mm = cases[n].e_solid;
        opt.phi_e_void_mm = cases[n].e_void;
        opt.phi_s_mm = width_of(&board, JALI_BOARD_SOLID, cases[n].s) - 0.02; // between two widths
        opt.phi_v_mm = width_of(&board, JALI_BOARD_VOID, cases[n].v) - 0.02;
        opt.recall = false;
        opt.narrow_mm = 1.5; // the slots are, the bars' windows are not
        CHECK_OK(jali_reference_create(ctx, &mask, &opt, &reference));
        CHECK_OK(jali_predict(ctx, &reference, &mask, 0, false, &opt, &print));
        int32_t k = SHRINK * print.printed.width_px / mask.width_px;
        jali_picture picture = {.width_px = print.printed.width_px / k,
                                .height_px = print.printed.height_px / k};
        picture.grey = malloc((size_t)picture.width_px * (size_t)picture.height_px);
        for (int32_t y = 0; y < picture.height_px; y++)
            for (int32_t x = 0; x < picture.width_px; x++) {
                int32_t sum = 0;
                for (int32_t v = 0; v < k; v++) sum += count_run(&print.printed, y * k + v, x * k, x * k + k);
                picture.grey[(size_t)y * (size_t)picture.width_px + (size_t)x] =
                    (uint8_t)(20 + 200 * sum / (k * k));
            }
        jali_scan scan;
        jali_calibration c;
        CHECK_OK(calibrate_picture(ctx, &picture, NULL, &scan, &c));
        CHECK(fabs(c.phi_e_solid.value - cases[n].e_solid) < 0.02);
        CHECK(fabs(c.phi_e_void.value - cases[n].e_void) < 0.02);
        CHECK(fabs(c.phi_s.value_mm - opt.phi_s_mm - 0.02) < 1e-6);
        CHECK(fabs(c.phi_v.value_mm - opt.phi_v_mm - 0.02) < 1e-6);
        jali_scan_free(ctx, &scan);
        free(picture.grey);
        jali_prediction_free(ctx, &print);
        jali_reference_free(ctx, &reference);
        jali_bitmap_free(ctx, &mask);
        jali_bitmap_free(ctx, &drawn);
        jali_board_free(ctx, &board);
    }
}

TEST(any_number_of_threads_finds_the_same)
{
    plain_scan s = plain();
    jali_context *by_threads[3];
    jali_scan scan[3];
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        assert_int_equal(jali_scan_board(by_threads[i], &s.picture, NULL, &scan[i]), JALI_OK);
        CHECK(memcmp(scan[i].feature, scan[0].feature,
                     (size_t)s.board.feature_count * sizeof *scan[i].feature) == 0);
    }
    for (int32_t i = 0; i < 3; i++) jali_scan_free(by_threads[i], &scan[i]);
    close_thread_contexts(by_threads);
    plain_scan_free(&s);
}

static jali_status scan_and_draw(jali_context *limited, void *data)
{
    jali_scan scan;
    jali_calibration c;
    jali_bytes png = {0};
    jali_status status = calibrate_picture(limited, data, NULL, &scan, &c);
    if (status == JALI_OK) status = jali_scan_map(limited, data, &scan, &png);
    jali_bytes_free(limited, &png);
    jali_scan_free(limited, &scan);
    return status;
}

TEST(scan_survives_refused_memory)
{
    plain_scan s = plain();
    refuse_each_allocation(scan_and_draw, &s.picture);
    plain_scan_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_and_photographs_give_back_what_was_printed),
        cmocka_unit_test(a_usual_board_at_300_dpi),
        cmocka_unit_test(upside_down_and_from_behind_are_corrected),
        cmocka_unit_test(with_dpi_a_print_that_shrank_is_told),
        cmocka_unit_test(bad_scans_end_in_a_sentence),
        cmocka_unit_test(a_tilted_board_is_registered_to_its_far_corner),
        cmocka_unit_test(a_bent_board_is_measured_or_refused),
        cmocka_unit_test(a_lost_code_is_said_and_can_be_given),
        cmocka_unit_test(what_predict_prints_comes_back_as_the_profile),
        cmocka_unit_test(any_number_of_threads_finds_the_same),
        cmocka_unit_test(scan_survives_refused_memory),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
