// A facet in its own plane, and the twelve ways in which it strains. Internal to the element.
//
// A flat triangle with 18 unknowns has 6 rigid motions and 12 strains: 6 of the membrane, 6 of bending. Each
// element is given as modes = rows x unknowns and an energy modes . stiffness . modes / 2, so that the
// stiffness of the unknowns is rows^T stiffness rows, of rank 12 by construction, and rows can be written in
// any axes.
#ifndef STRUCTURE_MODES_H
#define STRUCTURE_MODES_H

#include "structure/element.h"

/// A triangle in the plane, nodes counter-clockwise; side i leads from node i to node i + 1.
typedef struct flat_triangle {
    double area;
    double side[3][2];
    double gradient[3][2]; // of the area coordinate that is 1 at node i
} flat_triangle;

static inline flat_triangle lay_flat(const double node[3][2])
{
    flat_triangle t;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) t.side[i][k] = node[(i + 1) % 3][k] - node[i][k];
    double twice = t.side[0][0] * t.side[1][1] - t.side[0][1] * t.side[1][0];
    t.area = 0.5 * twice;
    for (int i = 0; i < 3; i++) {
        t.gradient[i][0] = -t.side[(i + 1) % 3][1] / twice;
        t.gradient[i][1] = t.side[(i + 1) % 3][0] / twice;
    }
    return t;
}

/// Plane stress of a unit thickness: stress = matrix . strain (xx, yy, engineering xy). Its three numbers.
typedef struct plane_stress {
    double straight, across, shear;
} plane_stress;

static inline plane_stress plane_stress_of(const facet_material *m)
{
    double straight = m->e_mpa / (1 - m->nu * m->nu);
    return (plane_stress){straight, straight * m->nu, m->e_mpa / (2 * (1 + m->nu))};
}

static inline void stress_of(plane_stress p, const double strain[3], double stress[3])
{
    stress[0] = p.straight * strain[0] + p.across * strain[1];
    stress[1] = p.across * strain[0] + p.straight * strain[1];
    stress[2] = p.shear * strain[2];
}

/// Membrane. Unknowns of node i at 3i: displacement along x, along y, rotation about z. Modes: mean strains
/// xx, yy, xy; the rotations of the three corners beyond that of the triangle.
void membrane_rows(const flat_triangle *t, double row[6][9]);
void membrane_modes_stiffness(const flat_triangle *t, const facet_material *made_of, double stiffness[6][6]);
void membrane_resultants(const flat_triangle *t, const facet_material *made_of, const double mode[6],
                         resultants at[3]);

/// The force at the centroid, from unknowns in the triangle's axes; the higher strains are zero there.
void membrane_centre(const flat_triangle *t, const facet_material *made_of, const double u[9], double n[3]);

/// Bending. Unknowns of node i at 3i: displacement along z, rotation about x, about y. Modes: curvatures xx,
/// yy, xy of the rotations at the nodes; the shear strain summed along each side.
void bending_rows(const flat_triangle *t, double row[6][9]);
void bending_modes_stiffness(const flat_triangle *t, const facet_material *made_of, double stiffness[6][6]);
void bending_resultants(const flat_triangle *t, const facet_material *made_of, const double mode[6],
                        resultants at[3]);
/// Moment and shear at the centroid, from unknowns in the triangle's axes.
void bending_centre(const flat_triangle *t, const facet_material *made_of, const double u[9], double m[3],
                    double q[2]);

#endif
