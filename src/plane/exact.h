// The predicates of plane geometry, exact for coordinates of at most 2^24 in magnitude.
//
// Differences stay below 2^25 + 1, so an orientation fits 64 bits with room to spare; an in-circle
// determinant is below 2^105 and is taken in 128 bits, after a floating-point filter that settles nearly all
// cases.
#ifndef PLANE_EXACT_H
#define PLANE_EXACT_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { COORDINATE_LIMIT = 1 << 24 };

/// Twice the signed area of the triangle a, b, c: positive when it is counter-clockwise.
static inline int64_t orientation(const int32_t a[2], const int32_t b[2], const int32_t c[2])
{
    return (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
}

/// True when d lies strictly inside the circle through the counter-clockwise triangle a, b, c.
static inline bool in_circle(const int32_t a[2], const int32_t b[2], const int32_t c[2], const int32_t d[2])
{
    int64_t ax = a[0] - d[0], ay = a[1] - d[1];
    int64_t bx = b[0] - d[0], by = b[1] - d[1];
    int64_t cx = c[0] - d[0], cy = c[1] - d[1];
    int64_t a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    int64_t bc = bx * cy - by * cx, ca = cx * ay - cy * ax, ab = ax * by - ay * bx;

    // Each factor is an integer below 2^53 and so exact as a double: three products and two sums round,
    // each by at most 2^-53 of the magnitude below.
    double sum = (double)a2 * (double)bc + (double)b2 * (double)ca + (double)c2 * (double)ab;
    double magnitude =
        (double)a2 * fabs((double)bc) + (double)b2 * fabs((double)ca) + (double)c2 * fabs((double)ab);
    double bound = 8 * 0x1p-53 * magnitude;
    if (sum > bound) return true;
    if (sum < -bound) return false;
    return (__int128)a2 * bc + (__int128)b2 * ca + (__int128)c2 * ab > 0;
}

/// For p on the line through a and b: true when it lies strictly between them.
static inline bool strictly_between(const int32_t a[2], const int32_t b[2], const int32_t p[2])
{
    int64_t abx = b[0] - a[0], aby = b[1] - a[1];
    int64_t along = abx * (p[0] - a[0]) + aby * (p[1] - a[1]);
    return along > 0 && along < abx * abx + aby * aby;
}

#endif
