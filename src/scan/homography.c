// Maps between planes that keep straight lines.
//
// Source:  R. Hartley, In defense of the eight-point algorithm, 1997: scale the points first (here to mean
//          distance sqrt 2), then solve for the eight ratios by least squares.
// Checked: tests/test_scan.c.
#include "scan/homography.h"
#include "scan/least.h"
#include "base/base.h"

#include <math.h>

homography homography_identity(void)
{
    return (homography){{1, 0, 0, 0, 1, 0, 0, 0, 1}};
}

void homography_apply(const homography *h, const double from[2], double to[2])
{
    const double *m = h->m;
    double x = from[0], y = from[1], w = m[6] * x + m[7] * y + m[8];
    to[0] = (m[0] * x + m[1] * y + m[2]) / w;
    to[1] = (m[3] * x + m[4] * y + m[5]) / w;
}

static double determinant(const double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

double homography_scale(const homography *h, const double at[2])
{
    double w = h->m[6] * at[0] + h->m[7] * at[1] + h->m[8];
    return sqrt(fabs(determinant(h->m) / (w * w * w)));
}

static homography scaled(homography h)
{
    double most = 0;
    for (int i = 0; i < 9; i++) most = fmax(most, fabs(h.m[i]));
    if (fabs(h.m[8]) > 1e-9 * most) most = h.m[8];
    for (int i = 0; i < 9 && most != 0; i++) h.m[i] /= most;
    return h;
}

homography homography_after(const homography *outer, const homography *inner)
{
    homography h = {{0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) h.m[3 * i + j] += outer->m[3 * i + k] * inner->m[3 * k + j];
    return scaled(h);
}

bool homography_inverse(const homography *h, homography *inverse)
{
    const double *m = h->m;
    double d = determinant(m), size = 0;
    for (int i = 0; i < 9; i++) size = fmax(size, fabs(m[i]));
    if (!(fabs(d) > 1e-14 * size * size * size)) return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, e = (i + 2) % 3;
            inverse->m[3 * i + j] = (m[3 * a + c] * m[3 * b + e] - m[3 * a + e] * m[3 * b + c]) / d;
        }
    *inverse = scaled(*inverse);
    return true;
}

// The similarity that brings points about the origin, at mean distance sqrt 2.
static bool centring(int32_t count, const double (*p)[2], homography *h)
{
    double x = 0, y = 0, far = 0;
    for (int32_t i = 0; i < count; i++) {
        x += p[i][0] / count;
        y += p[i][1] / count;
    }
    for (int32_t i = 0; i < count; i++) far += hypot(p[i][0] - x, p[i][1] - y) / count;
    if (!(far > 0) || !isfinite(far)) return false;
    double s = sqrt(2) / far;
    *h = (homography){{s, 0, -s * x, 0, s, -s * y, 0, 0, 1}};
    return true;
}

bool homography_of_points(int32_t count, const double (*from)[2], const double (*to)[2], homography *h)
{
    enum { UNKNOWNS = 8 };
    homography before, after, back, middle;
    normal_equations sums = {.unknowns = UNKNOWNS};
    double x[UNKNOWNS];
    if (count < 4 || !centring(count, from, &before) || !centring(count, to, &after)) return false;
    for (int32_t i = 0; i < count; i++) {
        double p[2], q[2];
        homography_apply(&before, from[i], p);
        homography_apply(&after, to[i], q);
        add_equation(&sums, (double[]){p[0], p[1], 1, 0, 0, 0, -q[0] * p[0], -q[0] * p[1]}, q[0], 1);
        add_equation(&sums, (double[]){0, 0, 0, p[0], p[1], 1, -q[1] * p[0], -q[1] * p[1]}, q[1], 1);
    }
    if (!solve_normal(&sums, x) || !homography_inverse(&after, &back)) return false;
    memcpy(middle.m, x, sizeof x);
    middle.m[8] = 1;
    homography whole = homography_after(&middle, &before);
    *h = homography_after(&back, &whole);
    return true;
}
