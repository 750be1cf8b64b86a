// Maps between planes that keep straight lines: how a flat thing lies in a photograph. Internal.
#ifndef SCAN_HOMOGRAPHY_H
#define SCAN_HOMOGRAPHY_H

#include <stdbool.h>
#include <stdint.h>

/// (x, y) goes to ((m0 x + m1 y + m2) / w, (m3 x + m4 y + m5) / w), w = m6 x + m7 y + m8.
typedef struct homography {
    double m[9];
} homography;

/// What nothing moves.
homography homography_identity(void);
/// The map that takes from[i] to[i]; with more than four points the one of least squares (of the algebraic
/// error, in coordinates scaled to the points).
///   in     count   4 .. 1,000,000
/// False when the points do not tell (three of four on a line, or all of them).
bool homography_of_points(int32_t count, const double (*from)[2], const double (*to)[2], homography *h);
/// First `inner`, then `outer`; scaled so that the coefficients stay near 1.
homography homography_after(const homography *outer, const homography *inner);
/// False when it has none.
bool homography_inverse(const homography *h, homography *inverse);
void homography_apply(const homography *h, const double from[2], double to[2]);
/// How much longer lengths become about a place: the square root of the growth of areas there.
double homography_scale(const homography *h, const double at[2]);

#endif
