// Rank spans by what a connector there would do, without solving anew. Internal to reinforce.
#ifndef REINFORCE_RANK_H
#define REINFORCE_RANK_H

#include "structure/assemble.h"
#include "reinforce/beam.h"
#include "reinforce/hotspots.h"

/// What is known of the wall as it is, connectors laid before included.
typedef struct outlook {
    const double (*u)[6]; // [node_count] displacements
    int32_t hotspot_count;
    double stress_mpa[MOST_HOTSPOTS];          // at the hot spots
    const double (*adjoint[MOST_HOTSPOTS])[6]; // [node_count] K^-1 times the gradient of each
    double load_n;                             // all forces together, for a scale
} outlook;

typedef struct rank_options {
    double width_mm, apart_mm; // of the narrowest connector; between two
    double pixel_mm;
    double limit_mpa;
    int32_t most;
} rank_options;

/// Least distance between two straight connectors, looked at in nine places of each.
double spans_apart(const jali_sheet *sheet, const span *a, const span *b);

/// Choose connectors: again and again the one that takes most off the highest hot spot a visible pixel, all
/// chosen before reckoned with.
///   in     laid     [laid_count] connectors that are there
///   out    chosen   [opt->most] spans with their widths, the first one first
///          count    0: none takes off 1 %
jali_status rank_spans(jali_context *ctx, structure *s, const jali_sheet *sheet, const borders *b,
                       const spans *all, const beam *laid, int32_t laid_count, const jali_material *material,
                       const outlook *now, const rank_options *opt, span *chosen, int32_t *count);

#endif
