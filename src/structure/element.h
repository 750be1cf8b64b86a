// Facets of a shell: flat triangles with three nodes of six unknowns. Internal.
//
// Unknowns of a facet's node i stand at 6i: displacement along x, y, z (mm), rotation about x, y, z (rad,
// right-handed), all in global axes. Those of a plate's node i at 3i: w along z, rotation about x, rotation
// about y.
#ifndef STRUCTURE_ELEMENT_H
#define STRUCTURE_ELEMENT_H

#include "base/base.h"

/// What a triangle is made of.
typedef struct facet_material {
    double e_mpa, nu;
    double thickness_mm; // the mean over the triangle
} facet_material;

/// Stress resultants at one place, in the facet's own axes: xx, yy, xy.
typedef struct resultants {
    double n[3]; // N/mm, membrane
    double m[3]; // N, moments a length: stress at the outer face is n/t + 6 m/t^2
    double q[2]; // N/mm, transverse shear: 1.5 q/t in the middle
} resultants;

/// The axes of a facet: x along its first side, z outward. Rows are unit vectors.
void facet_frame(const double node[3][3], double frame[3][3]);

/// Stiffness of a facet in global axes.
void facet_stiffness(const double node[3][3], const facet_material *made_of, double k[18][18]);

/// Resultants at the three corners, from the unknowns in global axes; in the axes of facet_frame.
void facet_resultants(const double node[3][3], const facet_material *made_of, const double u[18],
                      resultants at[3]);

/// Resultants at the centroid, which are the means of those at the corners, at a sixth of their cost.
///   in     frame   of facet_frame
void facet_centre(const double node[3][3], const double frame[3][3], const facet_material *made_of,
                  const double u[18], resultants *centre);

/// Forces and moments at the nodes from a pressure along the normal (z of facet_frame). The moments are what
/// a force along the fold between two facets needs; they cancel but for contours, where a curved sheet
/// without them opens too far (7 % of the hoop stress at the end of a pipe with 16 facets a quarter; 0.1 %
/// with them). On flat plates a third of the force at each node does as well.
void facet_pressure(const double node[3][3], double pressure_mpa, double load[3][6]);

/// Stiffness of a flat plate in the xy plane under transverse load alone: bending and shear.
void plate_stiffness(const double node[3][2], const facet_material *made_of, double k[9][9]);

#endif
