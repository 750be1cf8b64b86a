// What an analysis keeps for what comes after. Internal; reinforce uses it too.
#ifndef ANALYSE_STIFFNESS_H
#define ANALYSE_STIFFNESS_H

#include "analyse/assemble.h"

#include <jali/analyse.h>

typedef struct jali_stiffness {
    structure structure;
    jali_analyse_options opt;
    double (*load)[6]; // [node_count] what was solved for
} jali_stiffness;

/// What a part of the wall carries itself: pressure and weight, no spots.
///   out    force   [node_count] N, added to what is there
void carried_load(const jali_sheet *sheet, const jali_analyse_options *opt, double pressure_mpa,
                  double (*force)[3]);

/// Stresses and peaks of a sheet from the displacements that stand in `a`.
jali_status stresses_of(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt,
                        jali_analysis *a);

#endif
