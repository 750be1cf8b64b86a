// The plate that should have come out, and the figures of the one that did. Internal to compare.
#ifndef COMPARE_PLATE_H
#define COMPARE_PLATE_H

#include "base/base.h"
#include <jali/compare.h>

// Where the picture lies on the plate's grid.
typedef struct plate_frame {
    double pixel_mm[2];
    int32_t frame_px[2], around_px[2]; // columns, rows on each side
} plate_frame;

/// Draw the picture in its frame, void around it. Without a frame nothing is known of what lies around.
///   fails  JALI_BAD_VALUE (options), JALI_NO_MEMORY, JALI_LIMIT
jali_status draw_wanted(jali_context *ctx, const jali_reference *reference, const jali_compare_options *opt,
                        plate_frame *f, jali_bitmap *plate);

/// From c->plate, what was printed on that grid, the picture's part and all its figures.
jali_status measure_plate(jali_context *ctx, const jali_reference *reference, const jali_compare_options *opt,
                          const plate_frame *f, jali_comparison *c);

#endif
