// Widths from a scan: the share of a bar's tone, integrated across it. Blur moves light about but loses none,
// so the integral is the width, however soft the edges; noise averages out along the bar.
//
// The share is (level - other) / (own - other). The other tone's level comes from both flanks of the bar
// itself, where they are wide enough, so that a slope of the light drops out; its own tone's from wide places
// near by (levels.h).
//
// Limits:  a bar's own level must be that of wide places: voids that are dark by depth read too narrow.
// Checked: tests/test_scan_board.c, bench/calibrate.c.
#include "calibrate/measure.h"

#include "calibrate/robust.h"

static const double GROWTH_MM = 0.12;    // an edge may be so far off and still leave its flank plain
static const double SPARE_MM = 0.03;     // beyond the growth that is known
static const double EDGE_PX = 2;         // and blurred so far, or
static const double EDGE_BLURS = 2.7;    // so many deviations: 0.1 % of an edge is left beyond
static const double FLANK_MM = 0.45;     // of plain flank that is looked at, and
static const double FLANK_PX = 2;        // so much more
static const double PRINTED_SHARE = 0.5; // of the width expected: it is there
static const double LINE_SHARE = 0.3;    // of the same, a line at a time
static const double LINES_THERE = 0.9;   // share of the lines at which it must be
static const double LEAST_EXPECTED_MM = 0.04;

// Samples of what lies beside a feature.
typedef struct flank {
    double sum, count;
} flank;

// How far about a drawn edge the level may be neither tone's: by growth, and by pixels or blur.
static double edge_of(const sight *s)
{
    double growth = fmax(fabs(s->e_solid), fabs(s->e_void)) / 2 + SPARE_MM;
    return fmax(growth, GROWTH_MM) + fmax(EDGE_PX * s->pixel_mm, EDGE_BLURS * s->blur_mm);
}

static bool is_solid(const jali_board_feature *f)
{
    return f->kind == JALI_BOARD_SOLID || f->kind == JALI_BOARD_SOLID_PAIR || f->kind == JALI_BOARD_PIN;
}

static double expected_width(const sight *s, const jali_board_feature *f)
{
    return fmax(f->width_mm + (is_solid(f) ? s->e_solid : -s->e_void), LEAST_EXPECTED_MM);
}

// A bar's frame: along, across, how far it is looked at, and in what steps.
typedef struct window {
    double along[2], across[2], centre[2], half_length, reach, plain; // flanks are plain from `plain` on
    int32_t lines, samples;
} window;

static window window_of(const sight *s, const jali_board_feature *f)
{
    static const double along[3][2] = {{1, 0}, {0, 1}, {M_SQRT1_2, M_SQRT1_2}};
    const double *d = along[f->direction];
    window w = {.along = {d[0], d[1]}, .across = {-d[1], d[0]}, .centre = {f->at_mm[0], f->at_mm[1]}};
    w.half_length = f->window_mm / 2;
    w.plain = f->width_mm / 2 + edge_of(s);
    if (f->beside_mm > 0) // between two bars or slots: to the middle of either
        w.reach = f->width_mm / 2 + f->beside_mm / 2;
    else
        w.reach = fmin(w.plain + FLANK_MM + FLANK_PX * s->pixel_mm, f->reach_mm - edge_of(s));
    w.lines = (int32_t)fmin(fmax(f->window_mm / s->pixel_mm, 12), MOST_LINES);
    w.samples = (int32_t)fmin(fmax(4 * w.reach / s->pixel_mm, 24), 2000);
    return w;
}

static double sample_of(const sight *s, const window *w, int32_t line, int32_t i, double *v)
{
    double u = ((line + 0.5) / w->lines * 2 - 1) * w->half_length;
    *v = ((i + 0.5) / w->samples * 2 - 1) * w->reach;
    return seen_at(s->picture, s->map, w->centre[0] + u * w->along[0] + *v * w->across[0],
                   w->centre[1] + u * w->along[1] + *v * w->across[1]);
}

// The level beside a bar as a line across it: its value in the middle and its slope.
static void level_beside(const sight *s, const window *w, double model, double beside[2])
{
    flank side[2] = {0};
    for (int32_t line = 0; line < w->lines; line++)
        for (int32_t i = 0; i < w->samples; i++) {
            double v, level = sample_of(s, w, line, i, &v);
            if (fabs(v) < w->plain) continue;
            side[v > 0].sum += level;
            side[v > 0].count++;
        }
    beside[0] = model;
    beside[1] = 0;
    if (side[0].count < 2 * w->lines || side[1].count < 2 * w->lines) return;
    double left = side[0].sum / side[0].count, right = side[1].sum / side[1].count;
    beside[0] = (left + right) / 2;
    beside[1] = (right - left) / (w->plain + w->reach);
}

// What the integration over a bar's lines finds.
typedef struct profile {
    double weight, moment, soft;
} profile;

static profile integrate(const sight *s, const window *w, const double beside[2], double own, double *lines)
{
    profile p = {0};
    double dv = 2 * w->reach / w->samples;
    for (int32_t line = 0; line < w->lines; line++) {
        lines[line] = 0;
        for (int32_t i = 0; i < w->samples; i++) {
            double v, level = sample_of(s, w, line, i, &v), other = beside[0] + beside[1] * v;
            double share = (level - other) / (own - other);
            lines[line] += share * dv;
            p.weight += share;
            p.moment += share * v;
            p.soft += share > 0.2 && share < 0.8 ? dv : 0;
        }
    }
    p.soft /= 2 * w->lines;
    return p;
}

static bool is_there(const sight *s, const jali_board_feature *f, double mean, const double *lines,
                     int32_t count)
{
    double expected = expected_width(s, f);
    int32_t there = 0;
    for (int32_t i = 0; i < count; i++) there += lines[i] > LINE_SHARE * expected;
    return mean > PRINTED_SHARE * expected && there >= LINES_THERE * count;
}

static jali_measured measure_bar(const sight *s, const jali_board_feature *f, double *lines, double *soft_mm,
                                 double *contrast)
{
    jali_measured m = {0};
    window w = window_of(s, f);
    double level[2], beside[2], own;
    levels_at(s->levels, f->at_mm[0], f->at_mm[1], level);
    own = level[is_solid(f) ? 0 : 1];
    level_beside(s, &w, level[is_solid(f) ? 1 : 0], beside);
    *contrast = fabs(own - beside[0]);
    profile p = integrate(s, &w, beside, own, lines);
    robust_mean(lines, w.lines, 0.3 * s->pixel_mm, lines + MOST_LINES, &m.width_mm, &m.spread_mm);
    m.printed = is_there(s, f, m.width_mm, lines, w.lines);
    *soft_mm = m.printed && m.width_mm > 4 * s->pixel_mm ? p.soft : 0;
    double off = p.weight > 0 ? p.moment / p.weight : 0;
    for (int k = 0; k < 2; k++) m.off_mm[k] = off * w.across[k];
    return m;
}

// A round thing is looked at in steps over a square; of a pin the half away from its stem.
typedef struct disc_view {
    double plain, reach, step;
    int32_t steps;
    bool half;
} disc_view;

static disc_view view_of(const sight *s, const jali_board_feature *f)
{
    disc_view d = {.plain = f->width_mm / 2 + edge_of(s), .half = f->kind == JALI_BOARD_PIN};
    d.reach = fmin(d.plain + FLANK_MM + FLANK_PX * s->pixel_mm, f->reach_mm - edge_of(s));
    d.steps = (int32_t)fmin(fmax(4 * d.reach / s->pixel_mm, 24), 1000);
    d.step = 2 * d.reach / d.steps;
    return d;
}

// The i-th place, from the centre; false when it is not looked at.
static bool place_of(const disc_view *d, int32_t i, double at[2])
{
    int32_t row = i / d->steps, column = i % d->steps;
    at[0] = (column + 0.5) * d->step - d->reach;
    at[1] = (row + 0.5) * d->step - d->reach;
    return hypot(at[0], at[1]) <= d->reach && !(d->half && at[1] < 0);
}

static double level_around(const sight *s, const jali_board_feature *f, const disc_view *d, double model)
{
    flank around = {0};
    double at[2];
    for (int32_t i = 0; i < d->steps * d->steps; i++) {
        if (!place_of(d, i, at) || hypot(at[0], at[1]) < d->plain) continue;
        around.sum += seen_at(s->picture, s->map, f->at_mm[0] + at[0], f->at_mm[1] + at[1]);
        around.count++;
    }
    return around.count > d->steps ? around.sum / around.count : model;
}

// By its area.
static jali_measured measure_round(const sight *s, const jali_board_feature *f, double *contrast)
{
    jali_measured m = {0};
    disc_view d = view_of(s, f);
    double level[2], at[2], weight = 0;
    levels_at(s->levels, f->at_mm[0], f->at_mm[1], level);
    double own = level[d.half ? 0 : 1], other = level_around(s, f, &d, level[d.half ? 1 : 0]);
    for (int32_t i = 0; i < d.steps * d.steps; i++) {
        if (!place_of(&d, i, at)) continue;
        double share =
            (seen_at(s->picture, s->map, f->at_mm[0] + at[0], f->at_mm[1] + at[1]) - other) / (own - other);
        weight += share;
        for (int k = 0; k < 2; k++) m.off_mm[k] += share * at[k];
    }
    *contrast = fabs(own - other);
    double area = weight * d.step * d.step * (d.half ? 2 : 1);
    m.width_mm = area > 0 ? 2 * sqrt(area / M_PI) : 0;
    m.printed = m.width_mm > PRINTED_SHARE * expected_width(s, f);
    for (int k = 0; k < 2; k++) m.off_mm[k] = weight > 0 ? m.off_mm[k] / weight : 0;
    return m;
}

jali_measured measure_feature(const sight *s, const jali_board_feature *f, double *lines, double *soft_mm,
                              double *contrast)
{
    *soft_mm = 0;
    return f->direction == JALI_BOARD_ROUND ? measure_round(s, f, contrast)
                                            : measure_bar(s, f, lines, soft_mm, contrast);
}

// --- Corners

static const double CORNER_SHARE = 0.15; // of a window's side: beyond the radius of any corner

// A corner of a bar's window: places count inwards from it along x and y.
typedef struct corner_view {
    double at[2], inward[2], level[2], outside, step;
} corner_view;

// Void in a rectangle of the corner's frame, mm2.
static double void_in(const sight *s, const corner_view *c, double x0, double x1, double y0, double y1)
{
    int32_t columns = MAX(4, (int32_t)ceil((x1 - x0) / c->step)),
            rows = MAX(4, (int32_t)ceil((y1 - y0) / c->step));
    double sum = 0, dx = (x1 - x0) / columns, dy = (y1 - y0) / rows;
    for (int32_t i = 0; i < columns * rows; i++) {
        int32_t row = i / columns, column = i % columns;
        double x = x0 + (column + 0.5) * dx, y = y0 + (row + 0.5) * dy;
        double seen = seen_at(s->picture, s->map, c->at[0] + x * c->inward[0], c->at[1] + y * c->inward[1]);
        sum += (seen - c->level[0]) / (c->level[1] - c->level[0]);
    }
    return sum * dx * dy;
}

double corner_square(const sight *s, const jali_board_feature *f, int32_t corner)
{
    corner_view c = {.outside = edge_of(s), .step = s->pixel_mm / 2};
    double half = f->length_mm / 2, side = CORNER_SHARE * f->length_mm;
    for (int k = 0; k < 2; k++) {
        double sign = corner >> k & 1 ? 1 : -1;
        c.at[k] = f->at_mm[k] + sign * half;
        c.inward[k] = -sign;
    }
    levels_at(s->levels, c.at[0], c.at[1], c.level);
    // Where both edges came out, beside the corner; then what the corner keeps of the square they enclose.
    double wide = void_in(s, &c, -c.outside, side, side, 2 * side) / side;
    double high = void_in(s, &c, side, 2 * side, -c.outside, side) / side;
    return (wide * high - void_in(s, &c, -c.outside, side, -c.outside, side)) / (1 - M_PI_4);
}
