// The forward model of the printer on a grid. Internal.
#ifndef PREDICT_MODEL_H
#define PREDICT_MODEL_H

#include <jali/predict.h>
#include "raster/field.h"
#include "base/base.h"

/// Print a mask in place (docs/predict.md).
///   in     outside   what surrounds it
///          pixel_mm  of its grid
///   inout  mask
///   out    laid      what the printer lays by itself, before voids fill up and edges move; a new bitmap
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT
jali_status print_mask(jali_context *ctx, const jali_predict_options *opt, const tiling *tiles,
                       double pixel_mm, bool outside, jali_bitmap *mask, jali_bitmap *laid);

#endif
