// Calibration from numbers: tables and lists, the robust fit, limits, profiles.
#include "testing.h"

#include <math.h>
#include <jali/calibrate.h>
#include "base/bytes.h"
#include "calibrate/robust.h"

static jali_status read_text(const char *text, jali_widths *widths)
{
    return jali_widths_read(ctx, (const uint8_t *)text, strlen(text), "w.csv", widths);
}

TEST(tables_are_read_in_every_dress)
{
    static const char *const tables[] = {
        "designed,measured,kind\n0.4,0.52,solid\n1.5,-,void\n",
        "\xef\xbb\xbf"
        "designed;measured;kind\r\n0,4;0,52;solid\r\n1,5;0;void\r\n",
        "# by hand\n\n 0.4 mm , 0.52mm , SOLID # first\n1.5,,Void",
        "0.4\t0,52\tsolid\t\n15e-1\t-\tvoid\t",
    };
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        jali_widths w = {0};
        CHECK_OK(read_text(tables[i], &w));
        CHECK_INT(w.count, 2);
        CHECK(w.width[0].designed_mm == 0.4 && w.width[0].measured_mm == 0.52);
        CHECK(w.width[0].kind == JALI_BOARD_SOLID && w.width[0].direction == JALI_BOARD_ROUND);
        CHECK(w.width[1].designed_mm == 1.5 && w.width[1].measured_mm == 0 &&
              w.width[1].kind == JALI_BOARD_VOID);
        jali_widths_free(ctx, &w);
    }
    jali_widths w = {0};
    CHECK_OK(read_text("0.3,0.4,void pair,vertical\n1,0.9,hole\n1,1.1,pin\n", &w));
    CHECK(w.width[0].kind == JALI_BOARD_VOID_PAIR && w.width[0].direction == JALI_BOARD_VERTICAL);
    CHECK(w.width[1].kind == JALI_BOARD_HOLE && w.width[2].kind == JALI_BOARD_PIN && w.width[2].line == 3);
    jali_widths_free(ctx, &w);
}

TEST(bad_lines_end_in_their_number_and_what_is_accepted)
{
    static const struct {
        const char *text, *line, *accepted;
    } bad[] = {
        {"0.4,0.5,solid\n0,4,0,52,solid\n", "line 2", "semicolons"},
        {"0.4,0.5\n", "line 1", "designed,measured,kind are needed"},
        {"x,0.5,solid\n", "line 1", "such as 0.4"},
        {"0.4,x,solid\n", "line 1", "0 or - for what did not print"},
        {"0.4,0.5,wall\n", "line 1", "solid, void, hole, pin"},
        {"0.4,0.5,solid,up\n", "line 1", "horizontal, vertical, diagonal"},
        {"-1,0.5,solid\n", "line 1", "above 0"},
        {"0.4,-0.5,solid\n", "line 1", "0 to 1000 mm"},
        {"0.4,nan,solid\n", "line 1", "a number of mm"},
        {"0.4,0.5,solid\n\n0.4,a,solid\n0.4,b,solid\n0.4,c,solid", "line 3", "neither can be read: 4, 5"},
        {"designed,measured,kind\n", "w.csv", "no widths"},
        {"", "w.csv", "no widths"},
        {"0.4,0.5,solid\ndesigned,measured,kind\n", "line 2", "no designed width"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        jali_widths w = {0};
        CHECK_STATUS(read_text(bad[i].text, &w), JALI_BAD_INPUT);
        CHECK(strstr(jali_message(ctx), bad[i].line) && strstr(jali_message(ctx), bad[i].accepted));
        CHECK_INT(w.count, 0);
        jali_widths_free(ctx, &w);
    }
}

TEST(lists_are_read)
{
    jali_widths w = {0};
    CHECK_OK(jali_widths_parse(ctx, "solid:0.4=0.52, void:0.3=-,hole:1=0.8", &w));
    CHECK_INT(w.count, 3);
    CHECK(w.width[0].measured_mm == 0.52 && w.width[1].measured_mm == 0 &&
          w.width[2].kind == JALI_BOARD_HOLE);
    static const char *const bad[] = {"",           "solid",          "solid:0.4",
                                      "wall:0.4=1", "solid:0.4=0.5,", "solid=0.4:1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK_STATUS(jali_widths_parse(ctx, bad[i], &w), JALI_BAD_VALUE);
        CHECK_INT(w.count, 3);
    }
    jali_widths_free(ctx, &w);
}

static double random_share(uint64_t *seed)
{
    return (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

TEST(an_outlier_among_ten_does_not_move_the_mean)
{
    for (uint64_t seed = 1; seed <= 200; seed++) {
        uint64_t random = seed * 77;
        double value[10], clean[10], scratch[10], mean[2], spread[2];
        for (int i = 0; i < 10; i++) value[i] = clean[i] = 0.1 + 0.01 * (random_share(&random) - 0.5);
        CHECK_INT(robust_mean(clean, 9, 0.004, scratch, &mean[0], &spread[0]), 9);
        value[9] = (random_share(&random) < 0.5 ? -1 : 1) * (0.2 + 100 * random_share(&random));
        CHECK_INT(robust_mean(value, 10, 0.004, scratch, &mean[1], &spread[1]), 9);
        CHECK(fabs(mean[0] - mean[1]) < 1e-15 && fabs(spread[0] - spread[1]) < 1e-15);
    }
}

TEST(the_slope_of_holes_is_that_of_least_squares_without_outliers)
{
    uint64_t random = 5;
    double point[9][2], scratch[9], slope, spread, products = 0, squares = 0;
    for (int i = 0; i < 8; i++) {
        point[i][0] = 1 / (0.5 + 0.4 * i);
        point[i][1] = 0.05 * point[i][0] + 0.004 * (random_share(&random) - 0.5);
        products += point[i][0] * point[i][1];
        squares += point[i][0] * point[i][0];
    }
    point[8][0] = 1.5;
    point[8][1] = -0.4;
    CHECK_INT(robust_slope(point, 9, 0.004, scratch, &slope, &spread), 8);
    CHECK(fabs(slope - products / squares) < 1e-14 && spread < 0.004);
}

// A board printed by a printer of known figures, measured with an error.
static jali_widths printed_board(double e_solid, double e_void, double phi_s, double phi_v, double hole,
                                 double error, uint64_t *random)
{
    jali_widths w = {0};
    jali_board board;
    CHECK_OK(jali_board_layout(ctx, NULL, &board));
    for (int32_t i = 0; i < board.feature_count; i++) {
        const jali_board_feature *f = &board.feature[i];
        double d = f->width_mm, m = d + e_solid, least = 0;
        if (f->kind == JALI_BOARD_SOLID || f->kind == JALI_BOARD_SOLID_PAIR) least = phi_s;
        if (f->kind == JALI_BOARD_VOID || f->kind == JALI_BOARD_VOID_PAIR) least = phi_v, m = d - e_void;
        if (f->kind == JALI_BOARD_HOLE) m = d - e_void - hole / d;
        m += error * (random_share(random) - 0.5);
        jali_width one = {f->kind, f->direction, d, d < least - 1e-9 ? 0 : MAX(m, 0), i + 1};
        CHECK_OK(jali_widths_add(ctx, &one, &w));
    }
    jali_board_free(ctx, &board);
    return w;
}

TEST(what_a_printer_does_comes_back_as_its_figures)
{
    for (uint64_t seed = 1; seed <= 50; seed++) {
        uint64_t random = seed * 991;
        double e_solid = 0.3 * random_share(&random) - 0.1, e_void = 0.3 * random_share(&random) - 0.1;
        double hole = 0.08 * random_share(&random), phi_s = 0.24 + 0.03 * (double)(seed % 5);
        double phi_v = 0.45 + 0.05 * (double)(seed % 3);
        jali_widths w = printed_board(e_solid, e_void, phi_s, phi_v, hole, 0.01, &random);
        for (int k = 0; k < 10; k++) { // one bar in ten badly measured
            jali_width *bad = &w.width[next_random(&random) % w.count];
            if (bad->measured_mm > 0) bad->measured_mm = bad->designed_mm * (1 + random_share(&random));
        }
        jali_calibration c;
        CHECK_OK(jali_calibrate(ctx, &w, &c));
        CHECK(fabs(c.phi_e_solid.value - e_solid) < 0.004 && fabs(c.phi_e_void.value - e_void) < 0.004);
        CHECK(fabs(c.hole.value - hole) < 0.01);
        CHECK(c.phi_s.bounded && fabs(c.phi_s.value_mm - phi_s) < 1e-9);
        CHECK(c.phi_v.bounded && fabs(c.phi_v.value_mm - phi_v) < 1e-9);
        CHECK(fabs(c.pin.value - e_solid) < 0.01);
        jali_printer printer = {0};
        CHECK_OK(jali_calibration_apply(ctx, &c, "a test", &printer));
        CHECK(printer.phi_s_mm.value == c.phi_s.value_mm && strstr(printer.phi_s_mm.source, "a test"));
        CHECK(strstr(printer.phi_e_void_mm.source, "bars, spread 0.00"));
        jali_widths_free(ctx, &w);
    }
}

static jali_calibration calibrated(const char *list)
{
    jali_widths w = {0};
    jali_calibration c;
    CHECK_OK(jali_widths_parse(ctx, list, &w));
    CHECK_OK(jali_calibrate(ctx, &w, &c));
    jali_widths_free(ctx, &w);
    return c;
}

// Is it doubted, and said so?
static void check_doubt(const jali_widths *w, bool doubtful, double least_mm, double most_mm)
{
    jali_calibration c;
    jali_bytes text = {0};
    CHECK_OK(jali_calibrate(ctx, w, &c));
    CHECK(c.phi_e_void.error_mm >= least_mm && c.phi_e_void.error_mm <= most_mm);
    CHECK_INT(c.phi_e_void.doubtful, doubtful);
    CHECK(!c.phi_e_solid.doubtful);
    CHECK_OK(jali_calibration_sentences(ctx, &c, &text));
    CHECK_OK(bytes_append(ctx, &text, "", 1));
    CHECK_INT(strstr((const char *)text.data, "not sure") != NULL, doubtful);
    jali_bytes_free(ctx, &text);
}

TEST(the_standard_error_counts_what_bars_have_in_common)
{
    for (uint64_t seed = 1; seed <= 20; seed++) {
        uint64_t random = seed * 77;
        jali_widths w = printed_board(0.1, 0.1, 0.3, 0.5, 0.02, 0.02, &random);
        check_doubt(&w, false, 0.0004, 0.005); // noise: 0.0058 mm over the root of some 40 bars
        for (size_t i = 0; i < w.count; i++)   // voids read 5 % too narrow: 0.05 mm of a bar of 1 mm
            if (w.width[i].kind == JALI_BOARD_VOID || w.width[i].kind == JALI_BOARD_VOID_PAIR)
                w.width[i].measured_mm *= 0.95;
        check_doubt(&w, true, 0.01, 0.04);
        jali_widths_free(ctx, &w);
        w = printed_board(0.1, 0.1, 0.3, 0.5, 0.02, 0.02, &random);
        for (size_t i = 0; i < w.count; i++) // one axis loses its steps
            if (w.width[i].kind == JALI_BOARD_VOID && w.width[i].direction == JALI_BOARD_HORIZONTAL &&
                w.width[i].measured_mm > 0)
                w.width[i].measured_mm -= 0.06;
        check_doubt(&w, true, 0.0004, 0.03); // its bars are outliers: a quarter of all
        jali_widths_free(ctx, &w);
    }
}

TEST(limits_say_what_is_known_and_no_more)
{
    jali_calibration c = calibrated("solid:0.2=0.3,solid:0.3=0,solid:0.4=0.5,solid:0.5=0.6,solid:0.5=0.61");
    CHECK(c.phi_s.bounded && c.phi_s.value_mm == 0.4 && c.phi_s.lost_mm == 0.3);
    CHECK(c.phi_s.odd_count == 1 && c.phi_s.odd_mm[0] == 0.2);
    c = calibrated("solid:0.4=0.5,solid:0.5=0.6"); // all
    CHECK(c.phi_s.found && !c.phi_s.bounded && c.phi_s.value_mm == 0.4);
    c = calibrated("void:0.4=0,void:0.5=-"); // none
    CHECK(!c.phi_v.found && c.phi_v.lost_mm == 0.5);
    c = calibrated("solid:0.4=0.5,solid:0.4=0,solid:0.5=0.6"); // one direction of a width is not enough
    CHECK(c.phi_s.value_mm == 0.5 && c.phi_s.lost_mm == 0.4);
    jali_bytes text = {0};
    CHECK_OK(jali_calibration_sentences(ctx, &c, &text));
    CHECK(memmem(text.data, text.size, "phi_s is 0.5 mm", 15) != NULL);
    jali_bytes_free(ctx, &text);
}

TEST(too_little_and_contradictions_end_in_sentences)
{
    jali_printer printer = {0};
    static const char voids[] = "void:0.5=0.4,void:0.6=0.5,void:0.7=0.6,void:0.4=0,";
    static const struct {
        const char *list, *says;
    } bad[] = {
        {"solid:0.4=0.5,solid:0.5=0.6", "2 solid bars that printed are too few"},
        {"solid:0.4=0,solid:0.5=0", "0 solid bars"},
        {"hole:1=0.9", "--printer NAME"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char list[300];
        snprintf(list, sizeof list, "%s%s", voids, bad[i].list);
        jali_calibration c = calibrated(list);
        CHECK_STATUS(jali_calibration_apply(ctx, &c, "a test", &printer), JALI_NO_RESULT);
        CHECK(strstr(jali_message(ctx), bad[i].says));
    }
    jali_calibration c =
        calibrated("solid:0.4=0.5,solid:0.5=0.6,solid:0.6=0.7,solid:0.7=0,void:0.5=0.4,void:0.6=0.5,"
                   "void:0.7=0.6");
    CHECK_STATUS(jali_calibration_apply(ctx, &c, "a test", &printer), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "wider than that"));
    CHECK(!*printer.phi_s_mm.source); // untouched
    jali_widths w = {0};
    CHECK_OK(read_text("0.4,0.5,solid,vertical\n0.4,0,solid,vertical\n", &w));
    CHECK_STATUS(jali_calibrate(ctx, &w, &c), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "line 1") && strstr(jali_message(ctx), "line 2"));
    jali_widths_free(ctx, &w);
    CHECK_OK(read_text("0.4,52,solid\n", &w));
    CHECK_STATUS(jali_calibrate(ctx, &w, &c), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "are these mm"));
    jali_widths_free(ctx, &w);
}

TEST(what_a_profile_says_already_stays)
{
    jali_printer printer = {0};
    printer.phi_e_solid_mm.value = 0.07;
    snprintf(printer.phi_e_solid_mm.source, sizeof printer.phi_e_solid_mm.source, "before");
    printer.phi_s_mm = printer.phi_e_solid_mm;
    jali_calibration c = calibrated("void:0.5=0.4,void:0.6=0.5,void:0.7=0.6,void:0.4=0");
    CHECK_OK(jali_calibration_apply(ctx, &c, "a test", &printer));
    CHECK(printer.phi_e_solid_mm.value == 0.07 && strcmp(printer.phi_e_solid_mm.source, "before") == 0);
    CHECK(fabs(printer.phi_e_void_mm.value - 0.1) < 1e-9 && printer.phi_v_mm.value == 0.5);
}

static jali_status read_and_calibrate(jali_context *limited, void *data)
{
    static const char text[] =
        "0.4,0.5,solid\n0.5,0.6,solid\n0.6,0.7,solid\n0.5,0.4,void\n1,0.9,hole\n2,1.9,hole\n";
    jali_status status;
    jali_widths w = {0};
    jali_calibration c;
    jali_bytes bytes = {0};
    (void)data;
    status = jali_widths_read(limited, (const uint8_t *)text, sizeof text - 1, "w", &w);
    if (status == JALI_OK) status = jali_calibrate(limited, &w, &c);
    if (status == JALI_OK) status = jali_calibration_sentences(limited, &c, &bytes);
    jali_bytes_free(limited, &bytes);
    jali_widths_free(limited, &w);
    return status;
}

TEST(calibrate_survives_refused_memory)
{
    refuse_each_allocation(read_and_calibrate, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_are_read_in_every_dress),
        cmocka_unit_test(bad_lines_end_in_their_number_and_what_is_accepted),
        cmocka_unit_test(lists_are_read),
        cmocka_unit_test(an_outlier_among_ten_does_not_move_the_mean),
        cmocka_unit_test(the_slope_of_holes_is_that_of_least_squares_without_outliers),
        cmocka_unit_test(what_a_printer_does_comes_back_as_its_figures),
        cmocka_unit_test(the_standard_error_counts_what_bars_have_in_common),
        cmocka_unit_test(limits_say_what_is_known_and_no_more),
        cmocka_unit_test(too_little_and_contradictions_end_in_sentences),
        cmocka_unit_test(what_a_profile_says_already_stays),
        cmocka_unit_test(calibrate_survives_refused_memory),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
