// How wide features came out, by integrating the share of their tone. Internal to calibrate.
#ifndef CALIBRATE_MEASURE_H
#define CALIBRATE_MEASURE_H

#include "calibrate/levels.h"

/// What is known of the scan.
typedef struct sight {
    const jali_picture *picture;
    const homography *map;
    const levels *levels;
    double pixel_mm, blur_mm; // blur_mm: 0 until it is known
    double e_solid, e_void;   // expected: how much wider solids, narrower voids came out, mm
} sight;

/// Measure one feature; width_mm is what was found also where it did not print.
///   in     lines     [MOST_LINES * 2] scratch
///   out    soft_mm   how wide its edges are: the part of the profile between a fifth and four fifths, each
///   edge; 0:
///                    not told (round things, those too narrow)
///          contrast  between its tone and its surroundings
enum { MOST_LINES = 256 };
jali_measured measure_feature(const sight *s, const jali_board_feature *f, double *lines, double *soft_mm,
                              double *contrast);

/// The radius of a window's corner from the void that is missing in it, mm2 over (1 - pi / 4); may be below 0
/// by chance. `corner`: 0 .. 3.
double corner_square(const sight *s, const jali_board_feature *f, int32_t corner);

#endif
