// The first of two looks at spans. Internal to reinforce.
#ifndef REINFORCE_SIEVE_H
#define REINFORCE_SIEVE_H

#include "reinforce/rank.h"

enum { SIEVED = 104 };

/// Visible pixels of a connector.
double visible_pixels(const span *s, const rank_options *opt);

/// The best spans of each width for each hot spot, twice as many for the highest; no two in the same place.
///   out    best    [SIEVED] with their widths
///          count   of them
///   fails  JALI_NO_MEMORY
jali_status sieve_spans(jali_context *ctx, const jali_sheet *sheet, const borders *loops, const spans *all,
                        const jali_material *material, bool bending_only, const outlook *now,
                        const rank_options *opt, span best[SIEVED], int32_t *count);

#endif
