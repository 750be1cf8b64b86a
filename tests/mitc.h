// MITC3+: another plate triangle of the same theory, to check the one of the library against. Tests only.
//
// Source:  Y. Lee, P.-S. Lee, K.-J. Bathe, The MITC3+ shell element and its performance, Computers and
//          Structures 138 (2014) 12-23: rotations with a cubic bubble (condensed) and their assumed shear.
//          The membrane is the library's.
#ifndef TESTS_MITC_H
#define TESTS_MITC_H

#include "structure/modes.h"

// Covariant shear strains rt, st at (r, s): from 11 unknowns, (w, rotation x, rotation y) of three nodes,
// then the bubble's rotations.
static inline void mitc_covariant(const flat_triangle *t, double r, double s, double e[2][11])
{
    double side[2][2] = {{t->side[0][0], t->side[0][1]}, {-t->side[2][0], -t->side[2][1]}};
    double bubble = 27 * r * s * (1 - r - s);
    double shape[4] = {1 - r - s - bubble / 3, r - bubble / 3, s - bubble / 3, bubble};
    for (int d = 0; d < 2; d++) {
        for (int i = 0; i < 3; i++) {
            e[d][3 * i] = i == 0 ? -1 : i == d + 1;
            e[d][3 * i + 1] = -shape[i] * side[d][1];
            e[d][3 * i + 2] = shape[i] * side[d][0];
        }
        e[d][9] = -shape[3] * side[d][1];
        e[d][10] = shape[3] * side[d][0];
    }
}

static inline void mitc_assumed(const flat_triangle *t, double r, double s, double shear[2][11])
{
    static const double d = 1e-4;
    const double tie[6][2] = {{1. / 6, 2. / 3},
                              {2. / 3, 1. / 6},
                              {1. / 6, 1. / 6},
                              {1. / 3 + d, 1. / 3 - 2 * d},
                              {1. / 3 - 2 * d, 1. / 3 + d},
                              {1. / 3 + d, 1. / 3 + d}};
    double e[6][2][11], twice = 2 * t->area;
    for (int i = 0; i < 6; i++) mitc_covariant(t, tie[i][0], tie[i][1], e[i]);
    for (int j = 0; j < 11; j++) {
        double c = e[5][0][j] - e[3][0][j] - e[5][1][j] + e[4][1][j];
        double common = (e[2][0][j] + e[2][1][j]) / 3;
        double rt = 2. / 3 * (e[1][0][j] - 0.5 * e[1][1][j]) + common + c * (3 * s - 1) / 3;
        double st = 2. / 3 * (e[0][1][j] - 0.5 * e[0][0][j]) + common + c * (1 - 3 * r) / 3;
        shear[0][j] = (-t->side[2][1] * rt - t->side[0][1] * st) / twice;
        shear[1][j] = (t->side[2][0] * rt + t->side[0][0] * st) / twice;
    }
}

static inline void mitc_curvature(const flat_triangle *t, double r, double s, double b[3][11])
{
    double area[3] = {1 - r - s, r, s};
    memset(b, 0, 3 * sizeof *b);
    for (int i = 0; i < 4; i++) {
        double g[2] = {0, 0};
        for (int k = 0; k < 2; k++) {
            for (int n = 0; n < 3; n++)
                g[k] += 27 * area[(n + 1) % 3] * area[(n + 2) % 3] * t->gradient[n][k];
            if (i < 3) g[k] = t->gradient[i][k] - g[k] / 3;
        }
        int x = i < 3 ? 3 * i + 1 : 9, y = x + 1;
        b[0][y] = g[0];
        b[1][x] = -g[1];
        b[2][x] = -g[0];
        b[2][y] = g[1];
    }
}

static inline void mitc_plate(const flat_triangle *t, const facet_material *m, double k[9][9])
{
    // Seven points, exact for the fifth degree.
    static const double place[3][2] = {
        {1. / 3, 0.225}, {0.101286507323456, 0.125939180544827}, {0.470142064105115, 0.132394152788506}};
    double full[11][11] = {{0}}, h = m->thickness_mm, bends = h * h * h / 12;
    double shears = 5. / 6 * h * m->e_mpa / (2 * (1 + m->nu));
    plane_stress p = plane_stress_of(m);
    for (int point = 0; point < 7; point++) {
        int orbit = point == 0 ? 0 : point < 4 ? 1 : 2, turn = (point + 2) % 3;
        double a = place[orbit][0], weight = place[orbit][1] * t->area, curve[3][11], shear[2][11];
        double at[3] = {a, a, a};
        at[turn] = 1 - 2 * a;
        mitc_curvature(t, at[1], at[2], curve);
        mitc_assumed(t, at[1], at[2], shear);
        for (int j = 0; j < 11; j++) {
            double strain[3] = {curve[0][j], curve[1][j], curve[2][j]}, moment[3];
            stress_of(p, strain, moment);
            for (int i = 0; i < 11; i++) {
                for (int c = 0; c < 3; c++) full[i][j] += weight * bends * curve[c][i] * moment[c];
                for (int c = 0; c < 2; c++) full[i][j] += weight * shears * shear[c][i] * shear[c][j];
            }
        }
    }
    for (int last = 10; last >= 9; last--)
        for (int i = 0; i < last; i++)
            for (int j = 0; j < last; j++) full[i][j] -= full[i][last] * full[last][j] / full[last][last];
    for (int i = 0; i < 9; i++) memcpy(k[i], full[i], sizeof k[i]);
}

/// As facet_stiffness.
static inline void mitc_stiffness(const double node[3][3], const facet_material *made_of, double k[18][18])
{
    double frame[3][3], flat[3][2], plate[9][9], row[6][9], modes[6][6], own[18][18] = {{0}};
    facet_frame(node, frame);
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 2; d++) {
            flat[i][d] = 0;
            for (int c = 0; c < 3; c++) flat[i][d] += frame[d][c] * (node[i][c] - node[0][c]);
        }
    flat_triangle t = lay_flat((const double(*)[2])flat);
    mitc_plate(&t, made_of, plate);
    membrane_rows(&t, row);
    membrane_modes_stiffness(&t, made_of, modes);
    static const int bends[3] = {2, 3, 4}, stretches[3] = {0, 1, 5};
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            own[i / 3 * 6 + bends[i % 3]][j / 3 * 6 + bends[j % 3]] = plate[i][j];
            double *to = &own[i / 3 * 6 + stretches[i % 3]][j / 3 * 6 + stretches[j % 3]];
            for (int a = 0; a < 6; a++)
                for (int b = 0; b < 6; b++) *to += row[a][i] * modes[a][b] * row[b][j];
        }
    for (int i = 0; i < 18; i++)
        for (int j = 0; j < 18; j++) {
            double sum = 0;
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++)
                    sum += frame[a][i % 3] * own[i / 3 * 3 + a][j / 3 * 3 + b] * frame[b][j % 3];
            k[i][j] = sum;
        }
}

#endif
