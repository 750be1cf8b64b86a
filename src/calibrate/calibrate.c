// From measured widths to a printer's figures.
//
// Source:  Binary Image Carving for 3D Printing, section 4.2: phi_e is the mean error of solid and void bars,
// phi_s
//          and phi_v are the narrowest that print.
// Differs: solid and void each on their own; a mean that outliers do not move; a width counts as printed only
//          together with all wider ones; round holes by their own law; each phi_e with its standard error,
//          which counts what bars of a row, or all bars by their width, have in common (clusters: K.-Y.
//          Liang, S. L. Zeger, Longitudinal data analysis using generalized linear models, 1986, with G / (G
//          - 1)).
// Checked: tests/test_calibrate.c.
#include <jali/calibrate.h>

#include "calibrate/robust.h"

#include <math.h>
#include <stdlib.h>

static const double LEAST_SCALE_MM = 0.004; // of what counts as an outlier: no gauge and no scan is better
static const double TRUSTED_MM = 0.02;      // twice the standard error of a phi_e may be this
static const double LEAST_KEPT = 0.8;       // of what was measured: else the outliers may be right
enum { FEWEST = 3 };                        // measurements for a figure
enum { ROWS = JALI_BOARD_KINDS * (JALI_BOARD_ROUND + 1) }; // a kind in a direction is a row

typedef enum tone { SOLID, VOID, NEITHER } tone;

// Whose phi a bar tells; what is round tells neither.
static tone bar_tone(jali_board_kind kind)
{
    if (kind == JALI_BOARD_SOLID || kind == JALI_BOARD_SOLID_PAIR) return SOLID;
    return kind == JALI_BOARD_VOID || kind == JALI_BOARD_VOID_PAIR ? VOID : NEITHER;
}

static jali_status check_width(jali_context *ctx, const jali_width *w)
{
    double most = MAX(2 * w->designed_mm, w->designed_mm + 1);
    if (!(w->designed_mm > 0) || !(w->measured_mm >= 0))
        return fail(ctx, JALI_BAD_INPUT, "line %d: widths are lengths in mm, the designed one above 0",
                    w->line);
    if (w->measured_mm > most)
        return fail(
            ctx, JALI_BAD_INPUT,
            "line %d: a %s of %g mm cannot come out %g mm wide; up to %g mm is accepted (are these mm?)",
            w->line, jali_board_kind_name(w->kind), w->designed_mm, w->measured_mm, most);
    return JALI_OK;
}

// By kind, direction and width; the same bar twice comes together.
static int by_bar(const void *a, const void *b)
{
    const jali_width *p = a, *q = b;
    if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
    if (p->direction != q->direction) return p->direction < q->direction ? -1 : 1;
    if (p->designed_mm != q->designed_mm) return p->designed_mm < q->designed_mm ? -1 : 1;
    return p->line < q->line ? -1 : p->line > q->line;
}

// With its direction said, a bar stands once on a board: it did print or it did not.
static jali_status check_contradictions(jali_context *ctx, const jali_width *sorted, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const jali_width *a = &sorted[i - 1], *b = &sorted[i];
        if (a->kind != b->kind || a->direction != b->direction || a->designed_mm != b->designed_mm) continue;
        if (a->direction == JALI_BOARD_ROUND || (a->measured_mm > 0) == (b->measured_mm > 0)) continue;
        return fail(
            ctx, JALI_BAD_INPUT,
            "the %s bar of %g mm did print (line %d) and did not (line %d), both in the same direction",
            jali_board_kind_name(a->kind), a->designed_mm, a->measured_mm > 0 ? a->line : b->line,
            a->measured_mm > 0 ? b->line : a->line);
    }
    return JALI_OK;
}

// How much wider solids, how much narrower voids came out.
static double error_of(const jali_width *w)
{
    double wider = w->measured_mm - w->designed_mm;
    return bar_tone(w->kind) == VOID || w->kind == JALI_BOARD_HOLE ? -wider : wider;
}

// Is it of this tone (SOLID, VOID) or, for NEITHER, a pin, and there?
static bool counts_for(const jali_width *w, tone of)
{
    return (of == NEITHER ? w->kind == JALI_BOARD_PIN : bar_tone(w->kind) == of) && w->measured_mm > 0;
}

// Of the mean of the errors from `low` to `high`. Chance alone leaves the spread over the root of the number.
// What bars have in common it leaves out: a row lies in one place and one direction, so the rows' means tell
// what light, blur and axes do. And a level that is wrong makes bars wrong in proportion to their width: the
// slope over the width, times the mean width, is what it does to the mean at most, and is taken as two
// standard errors.
static double standard_error(const jali_width *w, size_t count, tone of, double low, double high,
                             const jali_fitted *f)
{
    double row[ROWS] = {0}, n = f->kept, width = 0, ww = 0, we = 0, by_rows = 0, rows = 0;
    bool seen[ROWS] = {false};
    for (size_t i = 0; i < count; i++)
        if (counts_for(&w[i], of) && error_of(&w[i]) >= low && error_of(&w[i]) <= high)
            width += w[i].designed_mm / n;
    for (size_t i = 0; i < count; i++) {
        double off = error_of(&w[i]) - f->value, wider = w[i].designed_mm - width;
        size_t at = (size_t)w[i].kind * (JALI_BOARD_ROUND + 1) + (size_t)w[i].direction;
        if (!counts_for(&w[i], of) || error_of(&w[i]) < low || error_of(&w[i]) > high) continue;
        row[at] += off;
        seen[at] = true;
        ww += wider * wider;
        we += wider * off;
    }
    for (int i = 0; i < ROWS; i++) {
        by_rows += row[i] * row[i] / (n * n);
        rows += seen[i];
    }
    double chance = f->spread * f->spread / n, squares = f->spread * f->spread * (n - 1), common = 0;
    if (rows > 1) chance = fmax(chance, by_rows * rows / (rows - 1));
    if (ww > 0 && n > 2) {
        double slope = we / ww, of_slope = fmax(squares - slope * we, 0) / (n - 2) / ww;
        common = fmax(slope * slope - of_slope, 0) * width * width;
    }
    return sqrt(chance + common / 4);
}

// The mean error of what counts.
static jali_fitted fit_error(const jali_width *w, size_t count, tone of, double *scratch)
{
    jali_fitted f = {0};
    for (size_t i = 0; i < count; i++)
        if (counts_for(&w[i], of)) scratch[f.measured++] = error_of(&w[i]);
    if (f.measured < FEWEST) return f;
    f.kept = robust_mean(scratch, f.measured, LEAST_SCALE_MM, scratch + count, &f.value, &f.spread);
    double low = scratch[0], high = scratch[0];
    for (int32_t i = 1; i < f.kept; i++) {
        low = fmin(low, scratch[i]);
        high = fmax(high, scratch[i]);
    }
    f.error_mm = standard_error(w, count, of, low, high, &f);
    f.doubtful = 2 * f.error_mm > TRUSTED_MM || f.kept < LEAST_KEPT * f.measured;
    return f;
}

// Holes: the error beyond that of bars is hole_mm2 / d.
static jali_fitted fit_holes(const jali_width *w, size_t count, double phi_e_void, double *scratch)
{
    jali_fitted f = {0};
    double(*point)[2] = (double(*)[2])scratch;
    for (size_t i = 0; i < count; i++)
        if (w[i].kind == JALI_BOARD_HOLE && w[i].measured_mm > 0) {
            point[f.measured][0] = 1 / w[i].designed_mm;
            point[f.measured++][1] = error_of(&w[i]) - phi_e_void;
        }
    if (f.measured < FEWEST) return f;
    f.kept = robust_slope(point, f.measured, LEAST_SCALE_MM, scratch + 2 * count, &f.value, &f.spread);
    f.value = MAX(f.value, 0); // a profile's is not below 0: smaller holes that come out better are chance
    return f;
}

static int widest_first(const void *a, const void *b)
{
    const jali_width *p = a, *q = b;
    return p->designed_mm > q->designed_mm ? -1 : p->designed_mm < q->designed_mm;
}

static void note_odd(double designed_mm, jali_limit *limit)
{
    if (limit->odd_count > 0 && limit->odd_mm[MIN(limit->odd_count, JALI_ODD_WIDTHS) - 1] == designed_mm)
        return;
    if (limit->odd_count < JALI_ODD_WIDTHS) limit->odd_mm[limit->odd_count] = designed_mm;
    limit->odd_count++;
}

// From the widest down, a width at a time: all of it must be there.
static jali_limit find_limit(const jali_width *sorted, size_t count, tone of)
{
    jali_limit limit = {0};
    for (size_t i = 0; i < count;) {
        double designed = sorted[i].designed_mm;
        int32_t printed = 0, lost = 0;
        for (; i < count && sorted[i].designed_mm == designed; i++)
            if (bar_tone(sorted[i].kind) == of) sorted[i].measured_mm > 0 ? printed++ : lost++;
        if (lost > 0 && limit.lost_mm == 0) limit.lost_mm = designed;
        if (printed > 0 && limit.lost_mm > 0 && designed < limit.lost_mm) note_odd(designed, &limit);
        if (printed > 0 && limit.lost_mm == 0) {
            limit.found = true;
            limit.value_mm = designed;
        }
    }
    limit.bounded = limit.found && limit.lost_mm > 0;
    return limit;
}

jali_status jali_calibrate(jali_context *ctx, const jali_widths *widths, jali_calibration *c)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    jali_width *sorted;
    double *scratch;
    size_t count = widths->count;
    *c = (jali_calibration){0};
    TRY(ARENA(ctx, sorted, count + 1));
    TRY(ARENA(ctx, scratch, 3 * count + 1));
    for (size_t i = 0; i < count; i++) {
        TRY(check_width(ctx, &widths->width[i]));
        sorted[i] = widths->width[i];
    }
    qsort(sorted, count, sizeof *sorted, by_bar);
    TRY(check_contradictions(ctx, sorted, count));
    c->phi_e_solid = fit_error(sorted, count, SOLID, scratch);
    c->phi_e_void = fit_error(sorted, count, VOID, scratch);
    if (c->phi_e_void.kept >= FEWEST) c->hole = fit_holes(sorted, count, c->phi_e_void.value, scratch);
    c->pin = fit_error(sorted, count, NEITHER, scratch);
    qsort(sorted, count, sizeof *sorted, widest_first);
    c->phi_s = find_limit(sorted, count, SOLID);
    c->phi_v = find_limit(sorted, count, VOID);
done:
    arena_rewind(ctx, mark);
    return status;
}
