// Compensate: take off the solid what the printer will add (Eq. 1), or add what it will take.
#ifndef JALI_COMPENSATE_H
#define JALI_COMPENSATE_H

#include <jali/adapt.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_compensate_options {
    jali_shape shape; // disc, or the paper's square
    int32_t size_px;  // omega_c, odd: the solid loses (size_px - 1) / 2 at each edge; 1 changes nothing; < 0:
                      // it gains (1 - size_px) / 2
    bool outside_solid;
    const jali_chart *chart; // with a metric: size_px is on the surface (discs only); NULL: flat
} jali_compensate_options;

/// I' = I eroded by S_C, or dilated where size_px is negative.
///   out    thinned   a new bitmap
///   fails  JALI_NO_MEMORY, JALI_BAD_VALUE (even size)
JALI_API jali_status jali_compensate(jali_context *ctx, const jali_bitmap *picture,
                                     const jali_compensate_options *opt, jali_bitmap *thinned);

#ifdef __cplusplus
}
#endif
#endif
