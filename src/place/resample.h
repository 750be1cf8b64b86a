// Grey picture to black and white on another grid. Internal to the stage place.
#ifndef PLACE_RESAMPLE_H
#define PLACE_RESAMPLE_H

#include <jali/bitmap.h>
#include <jali/read.h>
#include "base/base.h"

/// Fill the part of `to` inside the margin; what lies in the margin stays black.
///   in     threshold   white is grey >= threshold, with the edge half a level below it
///   fails  JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
jali_status resample(jali_context *ctx, const jali_picture *from, int32_t threshold, int32_t margin_px,
                     jali_bitmap *to);

#endif
