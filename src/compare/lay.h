// Where a print lies on the plate it should be. Internal to compare.
#ifndef COMPARE_LAY_H
#define COMPARE_LAY_H

#include "base/base.h"
#include <jali/bitmap.h>

/// The plate as drawn: its bitmap and the size of a pixel. What a print is laid on.
typedef struct plate_grid {
    const jali_bitmap *bitmap;
    double pixel_mm[2];
} plate_grid;

/// How a print's pixels lie on a plate: centres on each other, then shifted.
typedef struct laying {
    const jali_bitmap *print; // as it lies, turns undone
    double pixel_mm[2];
    double shift_mm[2]; // of the print's centre, right and down of the plate's
    int32_t row_step;   // look at every so many rows of the plate alone
} laying;

/// The correlation of print and plate, -1 .. 1; 0 where one of them is of one tone.
jali_status agreement_of(jali_context *ctx, const plate_grid *plate, const laying *l, double *agreement);

/// The print as it lies on the plate's grid: each pixel takes the print's at its centre, void beyond.
jali_status sample_print(jali_context *ctx, const plate_grid *plate, const laying *l, jali_bitmap *sampled);

/// Shift the print until no step of step_mm or its halves down to least_mm makes it agree better.
///   inout  l          shift_mm
///   out    agreement
jali_status shift_print(jali_context *ctx, const plate_grid *plate, double step_mm, double least_mm,
                        laying *l, double *agreement);

/// Mirror (left and right swapped), then turn clockwise by quarters.
jali_status turn_bitmap(jali_context *ctx, const jali_bitmap *src, int32_t quarter_turns, bool mirrored,
                        jali_bitmap *dst);

#endif
