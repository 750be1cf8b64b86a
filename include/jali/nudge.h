// Nudge: move the edges of a mask until its print comes nearest to the picture.
#ifndef JALI_NUDGE_H
#define JALI_NUDGE_H

#include <jali/optimise.h>
#include <jali/predict.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_nudge_report {
    int32_t rounds;                   // that made the print better
    double error_before, error_after; // of the predicted print, as jali_prediction has it
    int64_t changed_px;               // pixels of the mask
} jali_nudge_report;

/// The inverse of the forward model, by rounds: each edge of the mask moves by as much as the print's edge is
/// off the picture's, the widths are mended, and what brought the print no nearer about a place is taken
/// back. Never worse than before: by the predicted error, the pieces and the details left.
///   in     reference  the picture
///          printer    of the prediction; chart as below
///          opt        as the mask was made with
///          rounds     at most, 0 .. 100; the first three bring most
///   inout  result     mask and residual
///   out    report
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT; the mask is then as it was
///   cost   a round: two predictions and two finishes
JALI_API jali_status jali_nudge(jali_context *ctx, const jali_reference *reference,
                                const jali_predict_options *printer, const jali_chart *chart,
                                const jali_optimise_options *opt, int32_t rounds, jali_optimised *result,
                                jali_nudge_report *report);

#ifdef __cplusplus
}
#endif
#endif
