// From a scan to measured features.
//
// Limits:  see docs/calibrate.md for which errors remain.
// Checked: tests/test_scan_board.c, bench/calibrate.c: boards with known errors, scanned and photographed.
#include "calibrate/measure.h"
#include "calibrate/register.h"
#include "calibrate/robust.h"

// What a scan must show for its figures to be trusted.
static const double PIXELS_A_WIDTH = 3;   // of the narrower width expected: fewer, and a lost bar and a thin
                                          // one differ by less than noise
static const double BLURS_A_WIDTH = 1.4;  // likewise, deviations of the blur
static const double LEAST_CONTRAST = 0.1; // 25 of 255 grey levels: 1 % of noise is a tenth of it
static const double MOST_RESIDUAL_MM =
    0.12; // places against the map: a bent board or a lens, and windows miss their bars
// From an edge, where the level is that of the tone alone: what growth, pixels and blur reach.
static const double MARGIN_MM = 0.2, MARGIN_PX = 2, MARGIN_BLURS = 2.7;
static const double SURE_WIDTHS = 1.25;       // times phi: bars that tell the errors to expect of the others
static const double LEAST_CORNER_MM = 0.1;    // a radius that a scan can tell from none
static const double SOFT_DEVIATIONS = 1.6832; // from a fifth to four fifths of a blurred edge

jali_scan_options jali_scan_defaults(void)
{
    return (jali_scan_options){0};
}

void jali_scan_free(jali_context *ctx, jali_scan *scan)
{
    jali_board_free(ctx, &scan->board);
    release(ctx, scan->feature);
    *scan = (jali_scan){0};
}

static double finest_width(const jali_board *board)
{
    return MIN(board->phi_s_mm, board->phi_v_mm);
}

// The next of the resolutions that scanners have.
static int32_t dpi_needed(double pixel_mm)
{
    static const int32_t usual[] = {150, 200, 300, 400, 600, 1200, 2400};
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (25.4 / usual[i] <= pixel_mm) return usual[i];
    return 4800;
}

static jali_status check_resolution(jali_context *ctx, const jali_scan *scan)
{
    double most = finest_width(&scan->board) / PIXELS_A_WIDTH;
    int32_t dpi = dpi_needed(most);
    if (scan->pixel_mm <= most) return JALI_OK;
    return fail(ctx, JALI_NO_RESULT,
                "the scan resolves %.2g mm a pixel; at least %d dpi (%.2g mm) are needed for this board, "
                "three pixels "
                "across %g mm",
                scan->pixel_mm, dpi, 25.4 / dpi, finest_width(&scan->board));
}

// What the features say together.
typedef struct together {
    double soft, contrast;
    int32_t soft_count;
} together;

static together measure_all(const sight *s, jali_scan *scan, double *lines)
{
    together t = {.contrast = 1};
    for (int32_t i = 0; i < scan->board.feature_count; i++) {
        double soft, contrast;
        scan->feature[i] = measure_feature(s, &scan->board.feature[i], lines, &soft, &contrast);
        t.contrast = fmin(t.contrast, contrast);
        t.soft += soft;
        t.soft_count += soft > 0;
    }
    return t;
}

// The error that the wide bars show: what the narrow ones are judged against.
static void expect_errors(const jali_scan *scan, double *scratch, sight *s)
{
    for (int solid = 0; solid < 2; solid++) {
        double phi = solid ? scan->board.phi_s_mm : scan->board.phi_v_mm, mean, spread;
        jali_board_kind kind = solid ? JALI_BOARD_SOLID : JALI_BOARD_VOID;
        int32_t count = 0;
        for (int32_t i = 0; i < scan->board.feature_count; i++) {
            const jali_board_feature *f = &scan->board.feature[i];
            double error = scan->feature[i].width_mm - f->width_mm;
            if (f->kind == kind && f->width_mm >= SURE_WIDTHS * phi && fabs(error) < f->width_mm / 2)
                scratch[count++] = solid ? error : -error;
        }
        if (count < 3) continue;
        robust_mean(scratch, count, 0.004, scratch + count, &mean, &spread);
        *(solid ? &s->e_solid : &s->e_void) = mean;
    }
}

static jali_status check_sight(jali_context *ctx, const jali_scan *scan)
{
    if (!(scan->contrast >= LEAST_CONTRAST))
        return fail(
            ctx, JALI_NO_RESULT,
            "plate and voids differ by %.0f of 255 grey levels where they differ least; %.0f are needed: lay "
            "something lighter or darker behind the board",
            255 * scan->contrast, 255 * LEAST_CONTRAST);
    if (scan->residual_mm > MOST_RESIDUAL_MM)
        return fail(ctx, JALI_NO_RESULT,
                    "the board is bent in the picture: features lie %.3f mm from where a flat board has "
                    "them, %.2f mm at "
                    "most are accepted; press it flat, or take the photograph from farther away",
                    scan->residual_mm, MOST_RESIDUAL_MM);
    if (scan->blur_mm > finest_width(&scan->board) / BLURS_A_WIDTH)
        return fail(ctx, JALI_NO_RESULT,
                    "the scan is blurred by %.2f mm; %.2f mm are accepted for this board", scan->blur_mm,
                    finest_width(&scan->board) / BLURS_A_WIDTH);
    return JALI_OK;
}

// With the scanner's own scale, lengths are those of the print, not of the drawing.
static void apply_dpi(double dpi, const homography *map, jali_scan *scan)
{
    const jali_board *b = &scan->board;
    double factor = 25.4 / dpi;
    for (int k = 0; k < 2; k++) {
        double from[2], to[2], low[2] = {b->width_mm / 2, b->height_mm / 2}, high[2] = {low[0], low[1]};
        low[k] = b->mark_mm[0][k];
        high[k] = b->mark_mm[2][k];
        homography_apply(map, low, from);
        homography_apply(map, high, to);
        scan->scale[k] = hypot(to[0] - from[0], to[1] - from[1]) * factor / (high[k] - low[k]);
    }
    for (int32_t i = 0; i < b->feature_count; i++) {
        jali_board_direction d = b->feature[i].direction;
        double across = d == JALI_BOARD_HORIZONTAL ? scan->scale[1]
                        : d == JALI_BOARD_VERTICAL ? scan->scale[0]
                                                   : (scan->scale[0] + scan->scale[1]) / 2;
        scan->feature[i].width_mm *= across;
    }
}

// The corners of the windows of bars that lie along x or y. One that is below what chance makes is none.
static void measure_corners(const sight *s, double *scratch, jali_scan *scan)
{
    double square, spread;
    int32_t count = 0;
    for (int32_t i = 0; i < scan->board.feature_count; i++) {
        const jali_board_feature *f = &scan->board.feature[i];
        if (f->kind != JALI_BOARD_SOLID || f->direction == JALI_BOARD_DIAGONAL) continue;
        for (int32_t corner = 0; corner < 4; corner++) scratch[count++] = corner_square(s, f, corner);
    }
    int32_t kept = robust_mean(scratch, count, 0.004, scratch + count, &square, &spread);
    if (square < MAX(LEAST_CORNER_MM * LEAST_CORNER_MM, 4 * spread / sqrt(kept))) return;
    scan->corner_mm = sqrt(square);
    scan->corners = kept;
}

static jali_status measure_board(jali_context *ctx, const jali_picture *picture, homography *map,
                                 jali_scan *scan)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    levels l = {0};
    double *lines, *scratch;
    sight s = {.picture = picture, .map = map, .levels = &l, .pixel_mm = scan->pixel_mm};
    TRY(ARENA(ctx, lines, 2 * MOST_LINES));
    TRY(ARENA(ctx, scratch, 8 * scan->board.feature_count));
    TRY(ALLOCATE_CLEARED(ctx, scan->feature, scan->board.feature_count));
    // Where things are, then how wide they are, then which are there.
    for (int round = 0; round < 3; round++) {
        TRY(step(ctx, "calibrate", 0.3 + 0.2 * round));
        if (round < 2) {
            levels_free(ctx, &l);
            level_margin margin = {fmax(MARGIN_MM, fmax(fabs(s.e_solid), fabs(s.e_void)) / 2 + MARGIN_MM / 3),
                                   fmax(MARGIN_PX * scan->pixel_mm, MARGIN_BLURS * s.blur_mm)};
            TRY(learn_levels(ctx, picture, &scan->board, round ? scan->feature : NULL, map, &margin, &l));
        }
        together t = measure_all(&s, scan, lines);
        scan->contrast = t.contrast;
        scan->blur_mm = s.blur_mm = t.soft_count ? t.soft / t.soft_count / SOFT_DEVIATIONS : 0;
        expect_errors(scan, scratch, &s);
        if (round < 2) TRY(refine_map(ctx, &scan->board, scan->feature, map, &scan->residual_mm));
    }
    measure_corners(&s, scratch, scan);
done:
    levels_free(ctx, &l);
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_scan_board(jali_context *ctx, const jali_picture *picture, const jali_scan_options *given,
                            jali_scan *scan)
{
    jali_status status;
    jali_scan_options opt = given ? *given : jali_scan_defaults();
    homography map;
    *scan = (jali_scan){0};
    if (opt.dpi < 0 || !isfinite(opt.dpi))
        return fail(ctx, JALI_BAD_VALUE, "a scan of %g dpi: 0 or more is accepted", opt.dpi);
    TRY(find_board(ctx, picture, opt.board, scan, &map));
    TRY(check_resolution(ctx, scan));
    TRY(measure_board(ctx, picture, &map, scan));
    TRY(check_sight(ctx, scan));
    if (opt.dpi > 0) apply_dpi(opt.dpi, &map, scan);
    memcpy(scan->map, map.m, sizeof scan->map);
done:
    if (status != JALI_OK) jali_scan_free(ctx, scan);
    return status;
}

jali_status jali_scan_widths(jali_context *ctx, const jali_scan *scan, jali_widths *widths)
{
    jali_status status = JALI_OK;
    for (int32_t i = 0; i < scan->board.feature_count; i++) {
        const jali_board_feature *f = &scan->board.feature[i];
        const jali_measured *m = &scan->feature[i];
        jali_width one = {f->kind, f->direction, f->width_mm, m->printed ? m->width_mm : 0, i + 1};
        TRY(jali_widths_add(ctx, &one, widths));
    }
done:
    return status;
}
