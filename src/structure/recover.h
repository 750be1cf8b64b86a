// Stresses of a sheet from its displacements. Internal.
#ifndef STRUCTURE_RECOVER_H
#define STRUCTURE_RECOVER_H

#include <jali/sheet.h>

#include "structure/element.h"

/// The layers in which a shell is looked at.
enum { OUTER_FACE, MIDDLE, INNER_FACE, LAYERS };

/// {0} is valid and empty. MPa; a node that no triangle uses has none (0).
typedef struct stresses {
    int32_t node_count;
    double (*von_mises)[LAYERS]; // [node_count]
    double (*principal)[2][2];   // [node_count] on the outer, the inner face: the larger, the smaller
    double *worst;               // [node_count] the largest of the three von Mises stresses
    double *mean;                // [node_count] of `worst` over the disc around the node
    double worst_mpa, mean_mpa;  // the largest of each
    int32_t worst_at, mean_at;   // and their nodes, the first of equals; -1 without triangles
} stresses;

void stresses_free(jali_context *ctx, stresses *s);

/// Stresses at the nodes, at both faces and in the middle, and their means over discs.
///   in     sheet
///          made_of    e_mpa and nu; the thickness is the sheet's
///          u          [node_count] in global axes, as in element.h
///          disc_mm    diameter of the discs; 0: mean = worst. A disc takes in what is joined to its node
///                     through triangles within reach
///   out    s          free with stresses_free
///   fails  JALI_BAD_VALUE (disc), JALI_NO_RESULT (a displacement that is no number), JALI_CANCELLED,
///          JALI_NO_MEMORY
///   cost   O(n)
jali_status recover_stresses(jali_context *ctx, const jali_sheet *sheet, const facet_material *made_of,
                             const double (*u)[6], double disc_mm, stresses *s);

/// As recover_stresses, but only where the sheet is stressed most: for searches. Nodes about which no
/// triangle has a quarter of the largest stress keep what the worst of their triangles has for `worst` and
/// `mean`, and 0 for the rest.
jali_status recover_peaks(jali_context *ctx, const jali_sheet *sheet, const facet_material *made_of,
                          const double (*u)[6], double disc_mm, stresses *s);

#endif
