// The judge of widths on a curved surface: which pixels does no disc of a given diameter on the surface
// cover?
//
// Independent: no tiles, no rounding of the metric, no patches: at each centre the ellipse is that of the
//              exact metric there, and every pixel around it is asked in real numbers.
// Method:      centres are all points of the lattice of half pixels. A disc lies in a tone when no pixel
//              centre of the other tone lies inside its ellipse; it covers the pixels whose centre lies in
//              the ellipse widened by half a pixel.
// Limits:      cost = pixels * 4 * pixels of a disc: pictures up to about 1000 px a side.
#ifndef TESTS_JUDGE_METRIC_H
#define TESTS_JUDGE_METRIC_H

#include "judge_widths.h"

#include <math.h>

/// The metric at a point, in pixels from the bitmap's upper left corner, y down: (g11, g12, g22).
typedef void (*metric_of)(double x, double y, double g[3]);

/// The points v with v^T m v <= 1.
typedef struct judge_ellipse {
    double m[3], reach_x, reach_y;
} judge_ellipse;

/// A disc of a diameter on the surface, `more_px` wider on all sides.
static inline judge_ellipse judge_ellipse_at(const double g[3], double diameter_px, double more_px)
{
    // Eigenvectors by the angle that turns the metric to its axes.
    double angle = 0.5 * atan2(2 * g[1], g[0] - g[2]), c = cos(angle), s = sin(angle);
    double along = g[0] * c * c + 2 * g[1] * c * s + g[2] * s * s, across = g[0] + g[2] - along;
    double a = diameter_px / 2 / sqrt(along) + more_px, b = diameter_px / 2 / sqrt(across) + more_px;
    judge_ellipse e = {{c * c / (a * a) + s * s / (b * b), c * s * (1 / (a * a) - 1 / (b * b)),
                        s * s / (a * a) + c * c / (b * b)},
                       sqrt(a * a * c * c + b * b * s * s),
                       sqrt(a * a * s * s + b * b * c * c)};
    return e;
}

static inline bool judge_inside(const judge_ellipse *e, double x, double y, double level)
{
    return e->m[0] * x * x + 2 * e->m[1] * x * y + e->m[2] * y * y < level;
}

/// Whether no pixel of the other tone has its centre in the ellipse about (x, y), in pixels of the padded
/// picture.
static inline bool judge_fits(const plain *p, bool white, const judge_ellipse *e, double x, double y)
{
    int32_t x0 = (int32_t)ceil(x - e->reach_x - 0.5), x1 = (int32_t)floor(x + e->reach_x - 0.5);
    int32_t y0 = (int32_t)ceil(y - e->reach_y - 0.5), y1 = (int32_t)floor(y + e->reach_y - 0.5);
    if (x0 < 0 || y0 < 0 || x1 >= p->w || y1 >= p->h) return false;
    for (int32_t v = y0; v <= y1; v++)
        for (int32_t u = x0; u <= x1; u++)
            if ((p->white[(int64_t)v * p->w + u] == 1) != white &&
                judge_inside(e, u + 0.5 - x, v + 0.5 - y, 1 - 1e-9))
                return false;
    return true;
}

static inline void judge_cover(plain *bare, const judge_ellipse *e, double x, double y)
{
    for (int32_t v = (int32_t)fmax(floor(y - e->reach_y), 0); v <= y + e->reach_y && v < bare->h; v++)
        for (int32_t u = (int32_t)fmax(floor(x - e->reach_x), 0); u <= x + e->reach_x && u < bare->w; u++)
            if (judge_inside(e, u + 0.5 - x, v + 0.5 - y, 1 + 1e-9))
                bare->white[(int64_t)v * bare->w + u] = 0;
}

static inline plain judge_uncovered_on_surface(const plain *p, bool white, metric_of metric, int32_t pad,
                                               double diameter_px)
{
    plain bare = plain_create(p->w, p->h);
    for (int64_t i = 0; i < (int64_t)p->w * p->h; i++) bare.white[i] = (p->white[i] == 1) == white;
    for (int32_t j = 0; j < 2 * p->h; j++)
        for (int32_t i = 0; i < 2 * p->w; i++) {
            if ((p->white[(int64_t)(j / 2) * p->w + i / 2] == 1) != white) continue;
            double g[3], x = i / 2.0, y = j / 2.0;
            metric(x - pad, y - pad, g);
            judge_ellipse e = judge_ellipse_at(g, diameter_px, 0);
            if (!judge_fits(p, white, &e, x, y)) continue;
            e = judge_ellipse_at(g, diameter_px, 0.5);
            judge_cover(&bare, &e, x, y);
        }
    return bare;
}

/// Judge one tone: rule.width_px and rule.epsilon_px are on the surface, in flat pixels.
static inline judge_verdict judge_on_surface(const jali_bitmap *a, bool outside_solid, bool white,
                                             metric_of metric, judge_rule rule, judge_length length)
{
    int32_t pad = 2 * (int32_t)rule.width_px + 3;
    plain p = judge_padded(a, outside_solid, pad);
    plain bare = judge_uncovered_on_surface(&p, white, metric, pad, rule.width_px);
    judge_verdict v = judge_groups(&p, &bare, white, rule, pad, length);
    plain_free(&bare);
    plain_free(&p);
    return v;
}

#endif
