// Calibration from scans: boards printed with known errors, looked at by scanners and phones, measured,
// compared.
//
//     build/release/bench/calibrate [SEEDS [FIRST [ROW]]]     100 seeds, some three seconds each and row; all
//     rows
//
// The pictures come from tests/printed.h, which shares nothing with what measures them.
#include "printed.h"

#include <jali/calibrate.h>
#include <stdio.h>

// How a row's boards are printed and looked at.
typedef struct row {
    const char *name;
    double phi_s_mm, phi_v_mm, dpi;
    bool photograph, hard; // hard: blurred, noisy and coarse beyond what is trusted
} row;

static const row rows[] = {
    {"0.3/0.5 mm, scan, 300 dpi", 0.3, 0.5, 300, false, false},
    {"0.3/0.5 mm, photograph, 300 dpi", 0.3, 0.5, 300, true, false},
    {"0.15/0.2 mm, scan, 600 dpi", 0.15, 0.2, 600, false, false},
    {"1/1 mm, photograph, 130 dpi", 1, 1, 130, true, false},
    {"0.3/0.5 mm, hard photograph", 0.3, 0.5, 300, true, true},
};

// What became of a row's pictures.
typedef struct tally {
    int32_t right, wrong, doubted, doubted_wrong, refused;
    double worst[2], squares[2];
} tally;

static double step_width(const jali_board *b, jali_board_kind kind, int32_t column)
{
    int32_t i = 0;
    while (b->feature[i].kind != kind) i++;
    return b->feature[i + column].width_mm - 1e-6;
}

static printed print_board(const jali_board *b, const jali_bitmap *plate, double pixel_mm, uint64_t *seed)
{
    double scale = fmin(1, b->phi_v_mm / 0.4); // finer printers err less
    printed p = {.board = b, .plate = plate, .plate_pixel_mm = pixel_mm};
    p.e_solid = (0.02 + 0.18 * look_share(seed)) * scale;
    p.e_void = (0.02 + 0.18 * look_share(seed)) * scale;
    p.hole_mm2 = 0.06 * look_share(seed) * scale * scale;
    p.corner_mm = 0.3 * look_share(seed);
    p.waviness_mm = 0.01 * look_share(seed);
    p.phi_s = step_width(b, JALI_BOARD_SOLID, 4 + (int32_t)(look_random(seed) % 6));
    p.phi_v = step_width(b, JALI_BOARD_VOID, 5 + (int32_t)(look_random(seed) % 6));
    return p;
}

static void make_hard(look *l, uint64_t *seed)
{
    l->blur_px = 1 + 3 * look_share(seed);
    l->noise = 0.02 + 0.04 * look_share(seed);
    l->lens *= 4 * look_share(seed);
    if (look_share(seed) < 0.3) l->through = l->solid + (l->through > l->solid ? 0.15 : -0.15);
    for (int k = 0; k < 2; k++) l->light[k] *= 2;
}

static void judge(jali_context *ctx, const printed *p, const jali_picture *picture, int32_t n, tally *t)
{
    jali_scan scan = {0};
    jali_widths widths = {0};
    jali_calibration c = {0};
    jali_status status = jali_scan_board(ctx, picture, NULL, &scan);
    if (status == JALI_OK) status = jali_scan_widths(ctx, &scan, &widths);
    if (status == JALI_OK) status = jali_calibrate(ctx, &widths, &c);
    if (status != JALI_OK) {
        fprintf(stderr, "  %d: %s\n", n, jali_message(ctx));
        t->refused++;
    } else {
        double off[2] = {c.phi_e_solid.value - p->e_solid, c.phi_e_void.value - p->e_void};
        bool right = fabs(c.phi_s.value_mm - p->phi_s) < 1e-4 && fabs(c.phi_v.value_mm - p->phi_v) < 1e-4;
        for (int k = 0; k < 2; k++) {
            t->worst[k] = fmax(t->worst[k], fabs(off[k]));
            t->squares[k] += off[k] * off[k];
            right = right && fabs(off[k]) <= 0.02;
        }
        bool doubted = c.phi_e_solid.doubtful || c.phi_e_void.doubtful;
        *(doubted ? &t->doubted : right ? &t->right : &t->wrong) += 1;
        t->doubted_wrong += doubted && !right;
        if (!right || doubted)
            fprintf(stderr,
                    "  %d: phi_e %+.3f (%.3f) %+.3f (%.3f) off, phi_s %.3f for %.3f, phi_v %.3f for %.3f\n",
                    n, off[0], c.phi_e_solid.error_mm, off[1], c.phi_e_void.error_mm, c.phi_s.value_mm,
                    p->phi_s, c.phi_v.value_mm, p->phi_v);
    }
    jali_widths_free(ctx, &widths);
    jali_scan_free(ctx, &scan);
}

static jali_status run_row(jali_context *ctx, const row *r, int32_t first, int32_t seeds)
{
    jali_board board = {0};
    jali_bitmap plate = {0};
    tally t = {0};
    double pixel_mm = 0.05;
    jali_board_options opt = jali_board_defaults();
    opt.phi_s_mm = r->phi_s_mm;
    opt.phi_v_mm = r->phi_v_mm;
    jali_status status = jali_board_layout(ctx, &opt, &board);
    if (status == JALI_OK) status = jali_board_bitmap(ctx, &board, &pixel_mm, &plate);
    for (int32_t n = first; status == JALI_OK && n < first + seeds; n++) {
        uint64_t seed = (uint64_t)n * 7919 + 3;
        for (int k = 0; k < 5; k++) look_random(&seed);
        printed p = print_board(&board, &plate, pixel_mm, &seed);
        look l = some_look(&board, r->photograph, r->dpi, &seed);
        if (r->hard) make_hard(&l, &seed);
        jali_picture picture = looked_at(&p, &l);
        judge(ctx, &p, &picture, n, &t);
        free(picture.grey);
    }
    double count = fmax(t.right + t.wrong + t.doubted, 1);
    printf("| %-32s | %d | %d | %d, %d | %d | %.4f / %.4f | %.4f / %.4f |\n", r->name, t.right, t.wrong,
           t.doubted, t.doubted_wrong, t.refused, sqrt(t.squares[0] / count), t.worst[0],
           sqrt(t.squares[1] / count), t.worst[1]);
    fflush(stdout);
    jali_bitmap_free(ctx, &plate);
    jali_board_free(ctx, &board);
    return status;
}

int main(int argc, char **argv)
{
    long number[3] = {100, 1, 0}; // seeds, the first, the row (0: all)
    for (int i = 1; i < argc && i <= 3; i++) number[i - 1] = strtol(argv[i], NULL, 10);
    jali_context *ctx;
    if (jali_context_create(NULL, &ctx) != JALI_OK) return 1;
    printf("| board and picture                | right | wrong | doubted, of them wrong | refused | phi_e "
           "solid, rms / worst | phi_e void |\n");
    printf("|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if ((number[2] == 0 || number[2] == (long)i + 1) &&
            run_row(ctx, &rows[i], (int32_t)number[1], (int32_t)number[0]) != JALI_OK)
            printf("%s\n", jali_message(ctx));
    jali_context_free(ctx);
    return 0;
}
