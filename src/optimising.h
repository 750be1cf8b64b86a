// What the image method knows while it runs. Internal to optimise.c and the files beside it.
#ifndef OPTIMISING_H
#define OPTIMISING_H

#include <jali/compensate.h>
#include <jali/connect.h>
#include <jali/optimise.h>
#include "hand.h"
#include "base/base.h"

typedef struct optimising {
    const jali_chart *chart;
    jali_optimise_options opt;
    jali_adapt_options widths; // of the mask
    jali_metric metric;
    hand by_hand;
    jali_elements *elements;
    size_t round_capacity, laid_capacity, via_capacity;
    jali_optimised *result;
} optimising;

/// What the widths are in pixels: of the mask, by the paper's formula or on the working grid.
///   fails  JALI_BAD_VALUE: a width or kernel nothing can be made of
jali_status choose_kernels(jali_context *ctx, const jali_optimise_options *opt, const jali_chart *chart,
                           int32_t kernels_px[3]);

/// Get ready: widths, elements, edits by hand on `tones`. chart, opt and result are set.
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY; closed all the same
jali_status optimising_open(jali_context *ctx, const jali_bitmap *tones, optimising *o);
void optimising_close(jali_context *ctx, optimising *o);

/// Join parts, around what is blocked: by the strokes' width in the mask or in the print.
jali_status join_parts(jali_context *ctx, optimising *o, bool in_print, const jali_bitmap *picture,
                       const jali_bitmap *parts, jali_bitmap *joined, jali_bridges *bridges);

/// The finish: rounds until the mask is one piece and has nothing thinner than the widths, no neck either.
/// Only the first takes solid off.
jali_status finish(jali_context *ctx, optimising *o, jali_bitmap *mask);

/// What the finish left: types A and B must be none.
jali_status count_residual(jali_context *ctx, optimising *o, const jali_bitmap *mask);

#endif
