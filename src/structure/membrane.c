// Stretching of a flat triangle with rotations about its normal: the optimal membrane triangle (OPT).
//
// Source:  C. A. Felippa, A study of optimal membrane triangles with drilling freedoms, report CU-CAS-03-02,
//          2003 (also Comput. Methods Appl. Mech. Engng 192 (2003) 2125-2168): the basic and the higher order
//          stiffness of the ANDES template with the parameters of its optimal member.
// How:     The mean strains are those of sides that bend with the rotations at their ends (alpha_b = 3/2).
// The
//          corners' rotations beyond the triangle's own strain it linearly, with mean zero, by the integers
//          beta_1 .. beta_9; beta_0 = (1 - 4 nu^2)/2 makes the energy of bending in the plane exact at every
//          aspect ratio. With area coordinates his lengths cancel: the natural strain of side ij enters as
//          the product of two gradients.
// Limits:  beta_0 is kept at 0.01 or more, as he advises; that holds from nu = 0.495 on.
// Checked: tests/test_element.c, tests/test_published.c.
#include "structure/modes.h"

#include <math.h>

static const double LEAST_BETA_0 = 0.01;

// beta_1 .. beta_9 of OPT: strain of each side (row) at the first corner from the three corners' rotations;
// at the other corners it is the same, turned.
static const double OPTIMAL[3][3] = {{1, 2, 1}, {0, 1, -1}, {-1, -1, -2}};

void membrane_rows(const flat_triangle *t, double row[6][9])
{
    double eighth = 0.125 / t->area; // alpha_b / (12 area)
    memset(row, 0, 6 * sizeof *row);
    for (int i = 0; i < 3; i++) {
        double gx = t->gradient[i][0], gy = t->gradient[i][1];
        const double *next = t->side[i], *last = t->side[(i + 2) % 3];
        row[0][3 * i] = row[2][3 * i + 1] = gx;
        row[1][3 * i + 1] = row[2][3 * i] = gy;
        row[0][3 * i + 2] = eighth * (last[1] * last[1] - next[1] * next[1]);
        row[1][3 * i + 2] = eighth * (last[0] * last[0] - next[0] * next[0]);
        row[2][3 * i + 2] = 2 * eighth * (next[0] * next[1] - last[0] * last[1]);
        for (int corner = 3; corner < 6; corner++) {
            row[corner][3 * i] = 0.5 * gy;
            row[corner][3 * i + 1] = -0.5 * gx;
        }
        row[3 + i][3 * i + 2] = 1;
    }
}

// Strains at each corner from a unit of each corner's rotation beyond the triangle's: [corner][rotation][xx
// ..].
static void higher_strains(const flat_triangle *t, double nu, double strain[3][3][3])
{
    double scale = -t->area * sqrt(MAX(0.5 * (1 - 4 * nu * nu), LEAST_BETA_0));
    memset(strain, 0, 3 * sizeof *strain);
    for (int k = 0; k < 3; k++) {
        const double *g = t->gradient[k], *h = t->gradient[(k + 1) % 3];
        double natural[3] = {scale * g[0] * h[0], scale * g[1] * h[1], scale * (g[0] * h[1] + g[1] * h[0])};
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < 3; j++) {
                double beta = OPTIMAL[(k - c + 3) % 3][(j - c + 3) % 3];
                for (int i = 0; i < 3; i++) strain[c][j][i] += beta * natural[i];
            }
    }
}

void membrane_modes_stiffness(const flat_triangle *t, const facet_material *made_of, double stiffness[6][6])
{
    plane_stress p = plane_stress_of(made_of);
    double volume = t->area * made_of->thickness_mm, strain[3][3][3];
    memset(stiffness, 0, 6 * sizeof *stiffness);
    stiffness[0][0] = stiffness[1][1] = volume * p.straight;
    stiffness[0][1] = stiffness[1][0] = volume * p.across;
    stiffness[2][2] = volume * p.shear;
    // Linear fields with mean zero: the integral of a b is area / 12 (sum of corners a_c b_c).
    higher_strains(t, made_of->nu, strain);
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < 3; j++) {
            double stress[3];
            stress_of(p, strain[c][j], stress);
            for (int k = 0; k <= j; k++) {
                double work = 0;
                for (int i = 0; i < 3; i++) work += stress[i] * strain[c][k][i];
                stiffness[3 + j][3 + k] += volume / 12 * work;
            }
        }
    stiffness[3][4] = stiffness[4][3];
    stiffness[3][5] = stiffness[5][3];
    stiffness[4][5] = stiffness[5][4];
}

void membrane_resultants(const flat_triangle *t, const facet_material *made_of, const double mode[6],
                         resultants at[3])
{
    plane_stress p = plane_stress_of(made_of);
    double higher[3][3][3];
    higher_strains(t, made_of->nu, higher);
    for (int c = 0; c < 3; c++) {
        double strain[3] = {mode[0], mode[1], mode[2]};
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) strain[i] += higher[c][j][i] * mode[3 + j];
        stress_of(p, strain, at[c].n);
        for (int i = 0; i < 3; i++) at[c].n[i] *= made_of->thickness_mm;
    }
}

void membrane_centre(const flat_triangle *t, const facet_material *made_of, const double u[9], double n[3])
{
    double row[6][9], strain[3] = {0, 0, 0};
    membrane_rows(t, row);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 9; j++) strain[i] += row[i][j] * u[j];
    stress_of(plane_stress_of(made_of), strain, n);
    for (int i = 0; i < 3; i++) n[i] *= made_of->thickness_mm;
}
