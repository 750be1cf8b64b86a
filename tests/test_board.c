// The reference board: its widths on the contours themselves, the solid, what holds when bars break, its
// code.
#include "testing.h"

#include <math.h>
#include <jali/board.h>
#include <jali/carve.h>
#include <jali/check.h>
#include "raster/raster.h"

static const double expected[][2] = {{0.3, 0.5},  {0.15, 0.2}, {1, 1},     {0.05, 0.05},
                                     {0.8, 0.15}, {0.1, 0.6},  {0.7, 0.9}, {0.25, 0.45}};
enum { BOARDS = sizeof expected / sizeof *expected };

static jali_board board_of(int32_t i)
{
    jali_board board;
    jali_board_options opt = jali_board_defaults();
    opt.phi_s_mm = expected[i][0];
    opt.phi_v_mm = expected[i][1];
    CHECK_OK(jali_board_layout(ctx, &opt, &board));
    return board;
}

TEST(widths_bracket_what_is_expected)
{
    for (int32_t n = 0; n < BOARDS; n++) {
        jali_board board = board_of(n);
        CHECK(MAX(board.width_mm, board.height_mm) <= 200);
        int32_t below[2] = {0}, above[2] = {0};
        for (int32_t i = 0; i < board.feature_count; i++) {
            const jali_board_feature *f = &board.feature[i];
            if (f->direction != JALI_BOARD_VERTICAL || f->kind > JALI_BOARD_VOID) continue;
            double phi = f->kind == JALI_BOARD_VOID ? board.phi_v_mm : board.phi_s_mm;
            below[f->kind] += f->width_mm < phi - 1e-9;
            above[f->kind] += f->width_mm > phi + 1e-9;
        }
        for (int k = 0; k < 2; k++) CHECK(below[k] >= 4 && above[k] >= 4);
        jali_board_free(ctx, &board);
    }
}

// Along the line through a place in a direction, how far it is to the nearest contours on both sides.
static void nearest_crossings(const jali_contours *c, const double at[2], const double dir[2], double side[2])
{
    side[0] = side[1] = INFINITY;
    for (int32_t k = 0; k < c->contour_count; k++)
        for (int32_t i = c->first[k], before = c->first[k + 1] - 1; i < c->first[k + 1]; before = i++) {
            double p[2], q[2];
            for (int a = 0; a < 2; a++) {
                p[a] = c->point[before][a] * c->unit_mm - at[a];
                q[a] = c->point[i][a] * c->unit_mm - at[a];
            }
            double left = dir[0] * p[1] - dir[1] * p[0], right = dir[0] * q[1] - dir[1] * q[0];
            if ((left < 0) == (right < 0)) continue;
            double t = left / (left - right), along = 0;
            for (int a = 0; a < 2; a++) along += dir[a] * (p[a] + t * (q[a] - p[a]));
            side[along > 0] = MIN(side[along > 0], fabs(along));
        }
}

TEST(contours_are_as_wide_as_designed)
{
    static const double across[4][2] = {{0, 1}, {1, 0}, {-M_SQRT1_2, M_SQRT1_2}, {1, 0}};
    for (int32_t n = 0; n < BOARDS; n++) {
        jali_board board = board_of(n);
        jali_contours contours;
        CHECK_OK(jali_board_contours(ctx, &board, &contours));
        for (int32_t i = 0; i < board.feature_count; i++) {
            const jali_board_feature *f = &board.feature[i];
            double side[2], tolerance = f->direction == JALI_BOARD_ROUND ? 2e-3 : 1e-4;
            for (int place = -1; place <= 1; place++) { // the middle and both ends of the window
                const double *d = across[f->direction], move = place * f->window_mm / 2;
                const double at[2] = {f->at_mm[0] + d[1] * move, f->at_mm[1] - d[0] * move};
                nearest_crossings(&contours, at, d, side);
                CHECK(fabs(side[0] + side[1] - f->width_mm) < tolerance);
                CHECK(fabs(side[0] - side[1]) < tolerance);
            }
        }
        jali_contours_free(ctx, &contours);
        jali_board_free(ctx, &board);
    }
}

TEST(within_reach_there_is_nothing_else)
{
    jali_board board = board_of(0);
    jali_bitmap bitmap;
    double pixel_mm = 0.02;
    CHECK_OK(jali_board_bitmap(ctx, &board, &pixel_mm, &bitmap));
    for (int32_t i = 0; i < board.feature_count; i++) {
        const jali_board_feature *f = &board.feature[i];
        if (f->direction == JALI_BOARD_ROUND) continue;
        bool solid = f->kind == JALI_BOARD_SOLID || f->kind == JALI_BOARD_SOLID_PAIR;
        double angle = f->direction == JALI_BOARD_HORIZONTAL ? 0
                       : f->direction == JALI_BOARD_VERTICAL ? M_PI_2
                                                             : M_PI_4;
        for (double u = -f->window_mm / 2; u <= f->window_mm / 2; u += 0.1)
            for (double v = -f->reach_mm; v <= f->reach_mm; v += 0.03) {
                if (fabs(fabs(v) - f->width_mm / 2) < 0.05 || fabs(v) > f->reach_mm - 0.05) continue;
                double x = f->at_mm[0] + u * cos(angle) - v * sin(angle);
                double y = f->at_mm[1] + u * sin(angle) + v * cos(angle);
                bool white = jali_bitmap_get(&bitmap, (int32_t)(x / pixel_mm),
                                             bitmap.height_px - 1 - (int32_t)(y / pixel_mm));
                CHECK(white == (solid == (fabs(v) < f->width_mm / 2)));
            }
    }
    jali_bitmap_free(ctx, &bitmap);
    jali_board_free(ctx, &board);
}

TEST(board_is_one_closed_solid)
{
    for (int32_t n = 0; n < BOARDS; n++) {
        jali_board board = board_of(n);
        jali_contours contours;
        jali_mesh mesh;
        jali_check_report report;
        jali_carve_options opt = jali_carve_defaults();
        opt.thickness_mm = board.thickness_mm;
        CHECK_OK(jali_board_contours(ctx, &board, &contours));
        CHECK_OK(jali_carve(ctx, &contours, &(jali_chart){.unit_mm = contours.unit_mm}, &opt, &mesh));
        CHECK_OK(jali_check(ctx, &mesh, NULL, &report));
        CHECK(report.solid && report.pieces == 1);
        jali_mesh_free(ctx, &mesh);
        jali_contours_free(ctx, &contours);
        jali_board_free(ctx, &board);
    }
}

// Take the bars out of a picture of the board: nothing may hang on them.
TEST(nothing_hangs_on_a_bar)
{
    for (int32_t n = 0; n < BOARDS; n++) {
        jali_board board = board_of(n);
        jali_bitmap bitmap;
        components parts;
        double pixel_mm = MAX(board.phi_s_mm / 8, board.width_mm / 4000);
        CHECK_OK(jali_board_bitmap(ctx, &board, &pixel_mm, &bitmap));
        for (int32_t i = 0; i < board.feature_count; i++) {
            const jali_board_feature *f = &board.feature[i];
            if (f->kind != JALI_BOARD_SOLID && f->kind != JALI_BOARD_SOLID_PAIR) continue;
            double half = board.cell_mm * 0.4 + 2 * pixel_mm; // its whole window
            for (double y = f->at_mm[1] - half; y < f->at_mm[1] + half; y += pixel_mm / 2)
                for (double x = f->at_mm[0] - half; x < f->at_mm[0] + half; x += pixel_mm / 2)
                    jali_bitmap_set(&bitmap, (int32_t)(x / pixel_mm),
                                    bitmap.height_px - 1 - (int32_t)(y / pixel_mm), false);
        }
        CHECK_OK(label_components(ctx, &bitmap, true, 4, &parts));
        CHECK_INT(parts.count, 1);
        components_free(ctx, &parts);
        jali_bitmap_free(ctx, &bitmap);
        jali_board_free(ctx, &board);
    }
}

TEST(every_code_reads_back_and_wrong_ones_do_not)
{
    for (int32_t n = 0; n < BOARDS; n++) {
        jali_board board = board_of(n), again;
        CHECK_OK(jali_board_decode(ctx, board.code, &again));
        CHECK(again.phi_s_mm == board.phi_s_mm && again.phi_v_mm == board.phi_v_mm &&
              again.feature_count == board.feature_count && again.width_mm == board.width_mm);
        CHECK(memcmp(again.feature, board.feature, (size_t)board.feature_count * sizeof *board.feature) == 0);
        jali_board_free(ctx, &again);
        for (int32_t i = 0; i < JALI_BOARD_CODE_BITS; i++)
            for (int32_t k = 0; k <= i; k++) {
                bool wrong[JALI_BOARD_CODE_BITS];
                memcpy(wrong, board.code, sizeof wrong);
                wrong[i] = !wrong[i];
                if (k < i) wrong[k] = !wrong[k];
                CHECK_STATUS(jali_board_decode(ctx, wrong, &again), JALI_BAD_INPUT);
            }
        jali_board_free(ctx, &board);
    }
    jali_board none;
    CHECK_STATUS(jali_board_decode(ctx, (bool[JALI_BOARD_CODE_BITS]){0}, &none), JALI_BAD_INPUT);
}

TEST(impossible_boards_are_refused_with_figures)
{
    jali_board board;
    jali_board_options opt = jali_board_defaults();
    opt.phi_s_mm = 4;
    CHECK_STATUS(jali_board_layout(ctx, &opt, &board), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "0.05 to 3 mm"));
    opt.phi_s_mm = opt.phi_v_mm = 1.5;
    opt.most_mm = 100;
    CHECK_STATUS(jali_board_layout(ctx, &opt, &board), JALI_NO_RESULT);
    CHECK(strstr(jali_message(ctx), "needs ") && strstr(jali_message(ctx), "100 mm is the longest"));
    opt.most_mm = 200; // made for less, its widths reach beyond
    CHECK_OK(jali_board_layout(ctx, &opt, &board));
    CHECK(board.phi_s_mm < 1.5 && board.phi_s_mm > 0.9 && MAX(board.width_mm, board.height_mm) <= 200);
    jali_board_free(ctx, &board);
    opt = jali_board_defaults();
    opt.phi_v_mm = NAN;
    CHECK_STATUS(jali_board_layout(ctx, &opt, &board), JALI_BAD_VALUE);
    opt = jali_board_defaults();
    opt.most_mm = 105;
    CHECK_OK(jali_board_layout(ctx, &opt, &board));
    CHECK(board.height_mm <= 105);
    jali_board_free(ctx, &board);
}

static jali_status lay_and_draw(jali_context *limited, void *data)
{
    jali_status status;
    jali_board board = {0};
    jali_contours contours = {0};
    jali_bitmap bitmap = {0};
    double pixel_mm = 0.5;
    (void)data;
    status = jali_board_layout(limited, NULL, &board);
    if (status == JALI_OK) status = jali_board_contours(limited, &board, &contours);
    if (status == JALI_OK) status = jali_board_bitmap(limited, &board, &pixel_mm, &bitmap);
    jali_bitmap_free(limited, &bitmap);
    jali_contours_free(limited, &contours);
    jali_board_free(limited, &board);
    return status;
}

TEST(board_survives_refused_memory)
{
    refuse_each_allocation(lay_and_draw, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(widths_bracket_what_is_expected),
        cmocka_unit_test(contours_are_as_wide_as_designed),
        cmocka_unit_test(within_reach_there_is_nothing_else),
        cmocka_unit_test(board_is_one_closed_solid),
        cmocka_unit_test(nothing_hangs_on_a_bar),
        cmocka_unit_test(every_code_reads_back_and_wrong_ones_do_not),
        cmocka_unit_test(impossible_boards_are_refused_with_figures),
        cmocka_unit_test(board_survives_refused_memory),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
