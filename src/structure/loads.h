// From loads and supports in words to forces and held unknowns at the nodes of a sheet. Internal.
#ifndef STRUCTURE_LOADS_H
#define STRUCTURE_LOADS_H

#include <jali/analyse.h>
#include "base/base.h"

/// Which nodes are held.
///   out    held    [node_count] 1 = all six unknowns are zero
///   fails  JALI_NO_RESULT (none)
jali_status support_nodes(jali_context *ctx, const jali_sheet *sheet, jali_support support, uint8_t *held);

/// Forces (N) and moments (N mm) at the nodes.
///   in     held     [node_count] spots avoid them
///   out    force    [node_count] added to what is there
///          applied  the pressure, MPa
///   fails  JALI_BAD_VALUE (no load, or a figure that is none), JALI_NO_MEMORY
jali_status load_nodes(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt,
                       const uint8_t *held, double (*force)[6], double *applied);

/// What a part of the wall carries itself: pressure and weight, no spots.
///   out    force   [node_count], added to what is there
void carried_load(const jali_sheet *sheet, const jali_analyse_options *opt, double pressure_mpa,
                  double (*force)[6]);

double sheet_area(const jali_sheet *sheet);

/// True when only w and the rotations about x and y move: a flat sheet, and loads across it.
bool bends_only(const jali_sheet *sheet, const jali_load *load);

#endif
