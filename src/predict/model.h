// The forward model of the printer on a grid. Internal.
#ifndef PREDICT_MODEL_H
#define PREDICT_MODEL_H

#include <jali/predict.h>
#include "raster/field.h"
#include "base/base.h"

/// A mask on its way through the printer.
typedef struct printing {
    const jali_predict_options *opt;
    const tiling *tiles;
    double pixel_mm;
    bool outside;
    jali_bitmap *solid;  // what is solid so far
    jali_bitmap scratch; // of its size, for the operators
} printing;

/// Whole pixels of a width, so that a bar of that width holds the disc.
double whole_px(const printing *p, double mm);
jali_status disc_that_fits(jali_context *ctx, const printing *p, double mm, field *f);
/// Half of a growth, to the nearest pixel: how far each edge moves.
int32_t edge_px(const printing *p, double growth_mm);
/// Move all edges by so many pixels: outwards, or inwards when `back`.
jali_status move_edges(jali_context *ctx, const printing *p, const jali_bitmap *from, int32_t px, bool back,
                       jali_bitmap *to);
void swap_bitmaps(jali_bitmap *a, jali_bitmap *b);

/// Where voids are narrow, with the edges beside them as far as any edge moves, reach_px; a new bitmap.
/// (narrow.c)
jali_status narrow_places(jali_context *ctx, printing *p, int32_t reach_px, jali_bitmap *narrow);
/// Round holes shrink by hole_mm2 over their diameter. (holes.c)
jali_status narrow_holes(jali_context *ctx, printing *p);
/// Corners of both tones come out with a radius of corner_mm at most. (corners.c)
jali_status round_corners(jali_context *ctx, printing *p);

/// Print a mask in place (docs/predict.md).
///   in     outside   what surrounds it
///          pixel_mm  of its grid
///   inout  mask
///   out    laid      what the printer lays by itself, before voids fill up and edges grow; a new bitmap
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
jali_status print_mask(jali_context *ctx, const jali_predict_options *opt, const tiling *tiles,
                       double pixel_mm, bool outside, jali_bitmap *mask, jali_bitmap *laid);

#endif
