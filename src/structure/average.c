// The mean of a linear value over a disc on a triangulated sheet, by exact integrals.
//
// How:     The ball meets the plane of a triangle in a circle. What a triangle and a circle have in common is
// a
//          signed sum over its sides of the part of (centre, side) within the circle: a triangle where the
//          side runs inside, sectors where it runs outside.
// Limits:  at most MOST_NEAR triangles, the first reached: a disc four sides in radius has about 120.
// Checked: tests/test_recover.c: against sampling.
#include "structure/average.h"

#include <math.h>

enum { MOST_NEAR = 256 };

// The sector from direction p to direction q (any lengths), radius 1.
static void add_sector(const double p[2], const double q[2], double *area, double moment[2])
{
    double a = sqrt(p[0] * p[0] + p[1] * p[1]), b = sqrt(q[0] * q[0] + q[1] * q[1]);
    *area += 0.5 * atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
    moment[0] += (q[1] / b - p[1] / a) / 3;
    moment[1] += (p[0] / a - q[0] / b) / 3;
}

void circle_moments(const double node[3][2], double radius, double *area, double moment[2])
{
    *area = moment[0] = moment[1] = 0;
    for (int i = 0; i < 3; i++) {
        double p[2] = {node[i][0] / radius, node[i][1] / radius};
        double q[2] = {node[(i + 1) % 3][0] / radius, node[(i + 1) % 3][1] / radius};
        double d[2] = {q[0] - p[0], q[1] - p[1]}, turn = p[0] * q[1] - p[1] * q[0];
        double square = d[0] * d[0] + d[1] * d[1], along = p[0] * d[0] + p[1] * d[1];
        double under = square - turn * turn;        // times square: how deep the line cuts the unit circle
        if (fabs(turn) <= 1e-14 * square) continue; // the line goes through the centre
        double enter = under > 0 ? (-along - sqrt(under)) / square : 2;
        double leave = under > 0 ? (-along + sqrt(under)) / square : 2;
        if (enter >= 1 || leave <= 0) {
            add_sector(p, q, area, moment);
            continue;
        }
        double from = MAX(enter, 0), to = MIN(leave, 1);
        double a[2] = {p[0] + from * d[0], p[1] + from * d[1]}, b[2] = {p[0] + to * d[0], p[1] + to * d[1]};
        if (enter > 0) add_sector(p, a, area, moment);
        if (leave < 1) add_sector(b, q, area, moment);
        double part = 0.5 * turn * (to - from);
        *area += part;
        for (int k = 0; k < 2; k++) moment[k] += part * (a[k] + b[k]) / 3;
    }
    *area *= radius * radius;
    for (int k = 0; k < 2; k++) moment[k] *= radius * radius * radius;
}

// A triangle laid into its plane with the ball's centre above the origin; the square of the height.
static double lay_around(const double at[3][3], const double centre[3], double flat[3][2])
{
    double x[3], z[3], y[3], b[3], length = 0, height = 0;
    for (int k = 0; k < 3; k++) x[k] = at[1][k] - at[0][k], b[k] = at[2][k] - at[0][k];
    length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int k = 0; k < 3; k++) x[k] /= length;
    for (int k = 0; k < 3; k++) z[k] = x[(k + 1) % 3] * b[(k + 2) % 3] - x[(k + 2) % 3] * b[(k + 1) % 3];
    length = sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
    for (int k = 0; k < 3; k++) z[k] /= length;
    for (int k = 0; k < 3; k++) y[k] = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
    for (int i = 0; i < 3; i++) {
        flat[i][0] = flat[i][1] = 0;
        for (int k = 0; k < 3; k++) {
            flat[i][0] += x[k] * (at[i][k] - centre[k]);
            flat[i][1] += y[k] * (at[i][k] - centre[k]);
        }
    }
    for (int k = 0; k < 3; k++) height += z[k] * (at[0][k] - centre[k]);
    return height * height;
}

// Whether a side comes within the radius of the origin.
static bool reaches(const double p[2], const double q[2], double square)
{
    double d[2] = {q[0] - p[0], q[1] - p[1]}, length = d[0] * d[0] + d[1] * d[1];
    double t = length > 0 ? -(p[0] * d[0] + p[1] * d[1]) / length : 0;
    t = MIN(MAX(t, 0), 1);
    double x = p[0] + t * d[0], y = p[1] + t * d[1];
    return x * x + y * y < square;
}

// The integral of the value over the circle's part of a triangle; its area.
static double integral(const double flat[3][2], const double value[3], double radius, double *area)
{
    double moment[2], sum = 0;
    circle_moments(flat, radius, area, moment);
    double twice = (flat[1][0] - flat[0][0]) * (flat[2][1] - flat[0][1]) -
                   (flat[1][1] - flat[0][1]) * (flat[2][0] - flat[0][0]);
    for (int i = 0; i < 3; i++) {
        const double *p = flat[(i + 1) % 3], *q = flat[(i + 2) % 3];
        double whole =
            *area * (p[0] * q[1] - p[1] * q[0]) + moment[0] * (p[1] - q[1]) + moment[1] * (q[0] - p[0]);
        sum += value[i] * whole / twice;
    }
    return sum;
}

double mean_around(const jali_sheet *sheet, const fans *f, const double *value, int32_t node,
                   double radius_mm)
{
    int32_t near[MOST_NEAR], count = 0;
    const double *centre = sheet->node[node];
    double sum = 0, whole = 0;
    for (int32_t i = f->first[node]; i < f->first[node + 1] && count < MOST_NEAR; i++)
        near[count++] = f->corner[i] / 3;
    for (int32_t i = 0; i < count; i++) {
        int32_t t = near[i];
        double at[3][3], flat[3][2], own[3], area;
        for (int k = 0; k < 3; k++) {
            memcpy(at[k], sheet->node[sheet->triangle[t][k]], sizeof at[k]);
            own[k] = value[f->fan[3 * t + k]];
        }
        double square = radius_mm * radius_mm - lay_around((const double(*)[3])at, centre, flat);
        if (square <= 0) continue;
        sum += integral((const double(*)[2])flat, own, sqrt(square), &area);
        whole += area;
        for (int k = 0; k < 3; k++) {
            int32_t next = triangle_across(sheet, f, t, k);
            if (next < 0 || count == MOST_NEAR || !reaches(flat[k], flat[(k + 1) % 3], square)) continue;
            bool known = false;
            for (int32_t j = 0; j < count && !known; j++) known = near[j] == next;
            if (!known) near[count++] = next;
        }
    }
    return whole > 0 ? sum / whole : 0;
}
