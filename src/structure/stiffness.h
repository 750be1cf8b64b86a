// What an analysis keeps for what comes after. Internal.
#ifndef STRUCTURE_STIFFNESS_H
#define STRUCTURE_STIFFNESS_H

#include "structure/assemble.h"

#include <jali/analyse.h>

typedef struct jali_stiffness {
    structure structure;
    jali_analyse_options opt;
    double (*load)[6]; // [node_count] what was solved for
} jali_stiffness;

/// Arrays for the results of so many nodes; what was there is given back.
jali_status room_for_results(jali_context *ctx, int32_t nodes, jali_analysis *a);

/// Stresses and peaks of a sheet from the displacements that stand in `a`.
///   in     peaks_only   where little is borne an estimate will do (recover_peaks)
jali_status stresses_of(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt,
                        bool peaks_only, jali_analysis *a);

#endif
