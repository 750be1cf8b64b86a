// A connector as a beam between two border nodes: six ways to deform, each with its stiffness. Internal to
// reinforce.
#ifndef REINFORCE_BEAM_H
#define REINFORCE_BEAM_H

#include "reinforce/spans.h"

enum { BEAM_MODES = 6, BEAM_NODES = 6 }; // three nodes at each end share it

typedef struct beam {
    int32_t mode_count; // 3 on a plate that only bends, else 6
    double length_mm, thickness_mm;
    double stiffness[BEAM_MODES];             // N mm or N/mm
    double stress[BEAM_MODES];                // MPa in the beam a unit of each mode's force (N or N mm)
    int32_t node[BEAM_NODES];                 // end 0's three, then end 1's
    double weight[BEAM_MODES][BEAM_NODES][6]; // how the nodes' unknowns make a mode's deformation
} beam;

/// Lay a beam along a span: its width and the wall's thickness give its stiffness.
void beam_along(const jali_sheet *sheet, const borders *b, const span *s, const jali_material *material,
                bool bending_only, beam *out);

/// The stiffnesses and stresses of the same beam in another width.
void beam_stiffen(beam *b, const jali_material *material, double width_mm);

/// The deformation of each mode under nodal displacements.
void beam_deformation(const beam *b, const double (*u)[6], double mode[BEAM_MODES]);

#endif
