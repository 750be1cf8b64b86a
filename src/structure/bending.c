// Bending with transverse shear of a flat triangle: DKMT, the discrete Kirchhoff-Mindlin triangle.
//
// Source:  I. Katili, A new discrete Kirchhoff-Mindlin element based on Mindlin-Reissner plate theory and
//          assumed shear strain fields, part I, Int. J. Numer. Meth. Engng 36 (1993) 1859-1883.
// How:     The normals turn linearly between the nodes, and along each side as a parabola besides, by as much
//          as makes the shear of the side agree, in the mean, with the equilibrium of a strip that bends
//          along it. What is left to know of a side is its shear strain summed along it,
//              W = w_j - w_i + (b_i + b_j) . side / 2,
//          of which 1/(1 + phi) bends the side and phi/(1 + phi) shears it, phi = 12 D_b / (D_s length^2).
//          The shear field with those tangential values on the sides is linear (Whitney's edge functions),
//          and so are the curvatures: all integrals are closed sums over the corners.
// Limits:  one layer; shear factor 5/6. Thin (phi -> 0) it is DKT.
// Checked: tests/test_element.c, tests/test_published.c.
#include "structure/modes.h"

static const double SHEAR_FACTOR = 5.0 / 6;

void bending_rows(const flat_triangle *t, double row[6][9])
{
    memset(row, 0, 6 * sizeof *row);
    for (int i = 0; i < 3; i++) {
        double gx = t->gradient[i][0], gy = t->gradient[i][1];
        // The normal leans by rotation_y along x and by -rotation_x along y.
        row[0][3 * i + 2] = gx;
        row[1][3 * i + 1] = -gy;
        row[2][3 * i + 1] = -gx;
        row[2][3 * i + 2] = gy;
        int j = (i + 1) % 3;
        row[3 + i][3 * i] = -1;
        row[3 + i][3 * j] = 1;
        row[3 + i][3 * i + 1] = row[3 + i][3 * j + 1] = -0.5 * t->side[i][1];
        row[3 + i][3 * i + 2] = row[3 + i][3 * j + 2] = 0.5 * t->side[i][0];
    }
}

// Plate stiffnesses D_b (times plane stress of unit E), D_s, and 12 D_b / D_s.
typedef struct plate_figures {
    double bends, shears, ratio;
} plate_figures;

static plate_figures figures_of(const facet_material *m)
{
    double bends = m->thickness_mm * m->thickness_mm * m->thickness_mm / 12;
    double shears = SHEAR_FACTOR * m->thickness_mm * m->e_mpa / (2 * (1 + m->nu));
    return (plate_figures){bends, shears, 12 * bends * m->e_mpa / ((1 - m->nu * m->nu) * shears)};
}

// By how much a unit of shear W of a side turns the normals along it, and slides.
static void side_parts(const double side[2], double ratio, double *turn, double *slide)
{
    double square = side[0] * side[0] + side[1] * side[1], whole = square + ratio;
    *turn = -6 / whole;     // -3/2 . 4 / (length^2 (1 + phi))
    *slide = ratio / whole; // phi / (1 + phi)
}

// What a unit of shear W of each side does at the corners.
typedef struct side_fields {
    double bends, shears;      // of plate_figures
    double curvature[3][3][3]; // [corner][side][xx, yy, xy]
    double shear[3][3][2];     // [corner][side][x, y]
} side_fields;

static side_fields fields_of(const flat_triangle *t, const facet_material *m)
{
    plate_figures of = figures_of(m);
    side_fields f = {.bends = of.bends, .shears = of.shears};
    for (int k = 0; k < 3; k++) {
        const double *side = t->side[k];
        double turn, slide;
        side_parts(side, of.ratio, &turn, &slide);
        // The parabola 4 a_i a_j has the slope 4 grad a_j at node i, 4 grad a_i at node j, none at the third;
        // the edge function a_i grad a_j - a_j grad a_i is grad a_j, -grad a_i and nothing there.
        for (int end = 0; end < 2; end++) {
            int corner = (k + end) % 3;
            const double *g = t->gradient[(k + 1 - end) % 3];
            double sign = end ? -slide : slide;
            f.curvature[corner][k][0] = turn * g[0] * side[0];
            f.curvature[corner][k][1] = turn * g[1] * side[1];
            f.curvature[corner][k][2] = turn * (g[0] * side[1] + g[1] * side[0]);
            f.shear[corner][k][0] = sign * g[0];
            f.shear[corner][k][1] = sign * g[1];
        }
        memset(f.curvature[(k + 2) % 3][k], 0, sizeof f.curvature[0][0]);
        memset(f.shear[(k + 2) % 3][k], 0, sizeof f.shear[0][0]);
    }
    return f;
}

void bending_modes_stiffness(const flat_triangle *t, const facet_material *made_of, double stiffness[6][6])
{
    side_fields f = fields_of(t, made_of);
    plane_stress p = plane_stress_of(made_of);
    double bends = f.bends * t->area, twelfth = t->area / 12;
    memset(stiffness, 0, 6 * sizeof *stiffness);
    stiffness[0][0] = stiffness[1][1] = bends * p.straight;
    stiffness[0][1] = stiffness[1][0] = bends * p.across;
    stiffness[2][2] = bends * p.shear;
    // Linear fields a, b: the integral of a b is area / 12 (sum of corners a_c b_c + sum a_c sum b_c).
    for (int k = 0; k < 3; k++) {
        double moment[4][3], force[4][2], sum[3], slid[2];
        for (int i = 0; i < 3; i++)
            sum[i] = f.curvature[0][k][i] + f.curvature[1][k][i] + f.curvature[2][k][i];
        for (int i = 0; i < 2; i++) slid[i] = f.shear[0][k][i] + f.shear[1][k][i] + f.shear[2][k][i];
        stress_of(p, sum, moment[3]);
        for (int i = 0; i < 3; i++) stiffness[i][3 + k] = stiffness[3 + k][i] = bends / 3 * moment[3][i];
        for (int c = 0; c < 3; c++) {
            stress_of(p, f.curvature[c][k], moment[c]);
            for (int i = 0; i < 3; i++) moment[c][i] = f.bends * twelfth * (moment[c][i] + moment[3][i]);
            for (int i = 0; i < 2; i++) force[c][i] = f.shears * twelfth * (f.shear[c][k][i] + slid[i]);
        }
        for (int j = 0; j <= k; j++) {
            double work = 0;
            for (int c = 0; c < 3; c++) {
                for (int i = 0; i < 3; i++) work += moment[c][i] * f.curvature[c][j][i];
                for (int i = 0; i < 2; i++) work += force[c][i] * f.shear[c][j][i];
            }
            stiffness[3 + k][3 + j] = stiffness[3 + j][3 + k] = work;
        }
    }
}

void bending_resultants(const flat_triangle *t, const facet_material *made_of, const double mode[6],
                        resultants at[3])
{
    side_fields f = fields_of(t, made_of);
    plane_stress p = plane_stress_of(made_of);
    for (int c = 0; c < 3; c++) {
        double curvature[3] = {mode[0], mode[1], mode[2]}, shear[2] = {0, 0};
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++) curvature[i] += f.curvature[c][k][i] * mode[3 + k];
            for (int i = 0; i < 2; i++) shear[i] += f.shear[c][k][i] * mode[3 + k];
        }
        stress_of(p, curvature, at[c].m);
        for (int i = 0; i < 3; i++) at[c].m[i] *= f.bends;
        for (int i = 0; i < 2; i++) at[c].q[i] = f.shears * shear[i];
    }
}

void bending_centre(const flat_triangle *t, const facet_material *made_of, const double u[9], double m[3],
                    double q[2])
{
    double row[6][9], mode[6], shear[2] = {0, 0};
    plate_figures of = figures_of(made_of);
    bending_rows(t, row);
    for (int r = 0; r < 6; r++) {
        mode[r] = 0;
        for (int j = 0; j < 9; j++) mode[r] += row[r][j] * u[j];
    }
    double curvature[3] = {mode[0], mode[1], mode[2]};
    for (int k = 0; k < 3; k++) {
        const double *side = t->side[k], *g = t->gradient[k], *h = t->gradient[(k + 1) % 3];
        double turn, slide;
        side_parts(side, of.ratio, &turn, &slide);
        turn *= mode[3 + k] / 3; // of the slopes 4 h, 4 g and none at the corners the mean
        slide *= mode[3 + k] / 3;
        double gx = g[0] + h[0], gy = g[1] + h[1];
        curvature[0] += turn * gx * side[0];
        curvature[1] += turn * gy * side[1];
        curvature[2] += turn * (gx * side[1] + gy * side[0]);
        shear[0] += slide * (h[0] - g[0]);
        shear[1] += slide * (h[1] - g[1]);
    }
    stress_of(plane_stress_of(made_of), curvature, m);
    for (int i = 0; i < 3; i++) m[i] *= of.bends;
    for (int i = 0; i < 2; i++) q[i] = of.shears * shear[i];
}
