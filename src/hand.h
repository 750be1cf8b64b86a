// What was laid down by hand, as the image method needs it. Internal.
#ifndef HAND_H
#define HAND_H

#include <jali/adapt.h>
#include <jali/compensate.h>
#include <jali/optimise.h>

/// {0}: nothing by hand.
typedef struct hand {
    bool any;
    jali_marks marks;
    jali_bitmap drawn;       // bridges in the mask
    jali_bitmap drawn_print; // and as they come out
    jali_bitmap picture;     // the drawing with the bridges in it
    jali_bitmap fixed, kept; // what stays in the mask, locked and drawn, and its tones
} hand;

void hand_free(jali_context *ctx, hand *h);

/// Draw the edits.
///   in     edits       NULL or empty: nothing
///          widths      of the mask; afterwards its fixed, kept and closed point into `h`
///          compensate  from print to mask
///          tones       the drawing, or a mask: what stays where it is locked
jali_status hand_create(jali_context *ctx, const jali_edits *edits, const jali_chart *chart,
                        const jali_compensate_options *compensate, const jali_bitmap *tones,
                        jali_adapt_options *widths, hand *h);

/// What is locked or drawn has its tones again, in a mask or in a print.
void hand_keep(jali_context *ctx, const hand *h, bool in_print, jali_bitmap *picture);

/// Tell the main piece from those that nothing joins with it.
///   in     pieces   a mask, or its cores
///          outside_solid   then the main piece is the one that holds the upper left corner, else the largest
///   out    off      the pieces to take off: all others that hold no pixel that is fixed; no bitmap when none
///   inout  edited   left_out, and loose when `last`
jali_status hand_find_loose(jali_context *ctx, const hand *h, const jali_bitmap *pieces, bool outside_solid,
                            bool last, jali_bitmap *off, jali_edited *edited);

/// How many details touch what is locked, or lie within reach_px of it.
jali_status hand_count_locked(jali_context *ctx, const hand *h, const jali_details *details, bool white,
                              int32_t reach_px, int32_t *count);

#endif
