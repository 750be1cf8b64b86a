// The facet of a shell: a flat triangle that stretches (membrane.c) and bends (bending.c), in global axes.
//
// How:     The rows that give the twelve modes of a facet from its unknowns are written in global axes; the
//          stiffness is rows^T . stiffness of the modes . rows, upper half computed, lower half copied.
// Limits:  flat facets; curvature of the shell comes from the angles between them.
// Cost:    about 0.8 us a facet, 0.3 us a plate's triangle; allocates nothing.
// Checked: tests/test_element.c, tests/test_published.c.
#include "structure/modes.h"

#include <math.h>

void facet_frame(const double node[3][3], double frame[3][3])
{
    double a[3], b[3], *x = frame[0], *y = frame[1], *z = frame[2];
    for (int k = 0; k < 3; k++) {
        a[k] = node[1][k] - node[0][k];
        b[k] = node[2][k] - node[0][k];
    }
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int k = 0; k < 3; k++) x[k] = a[k] / length;
    for (int k = 0; k < 3; k++) z[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    length = sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
    for (int k = 0; k < 3; k++) z[k] /= length;
    for (int k = 0; k < 3; k++) y[k] = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
}

// The triangle in its own axes, node 0 at the origin.
static flat_triangle facet_flat(const double node[3][3], const double frame[3][3])
{
    double flat[3][2];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            flat[i][k] = 0;
            for (int c = 0; c < 3; c++) flat[i][k] += frame[k][c] * (node[i][c] - node[0][c]);
        }
    return lay_flat(flat);
}

// The twelve rows in global axes: membrane first.
static void facet_rows(const flat_triangle *t, const double frame[3][3], double row[12][18])
{
    double own[6][9];
    const double *x = frame[0], *y = frame[1], *z = frame[2];
    membrane_rows(t, own);
    for (int r = 0; r < 6; r++)
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++) {
                row[r][6 * i + c] = own[r][3 * i] * x[c] + own[r][3 * i + 1] * y[c];
                row[r][6 * i + 3 + c] = own[r][3 * i + 2] * z[c];
            }
    bending_rows(t, own);
    for (int r = 0; r < 6; r++)
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++) {
                row[6 + r][6 * i + c] = own[r][3 * i] * z[c];
                row[6 + r][6 * i + 3 + c] = own[r][3 * i + 1] * x[c] + own[r][3 * i + 2] * y[c];
            }
}

VECTORISED void facet_stiffness(const double node[3][3], const facet_material *made_of, double k[18][18])
{
    double frame[3][3], row[12][18], part[2][6][6], force[12][18];
    facet_frame(node, frame);
    flat_triangle t = facet_flat(node, (const double(*)[3])frame);
    facet_rows(&t, (const double(*)[3])frame, row);
    membrane_modes_stiffness(&t, made_of, part[0]);
    bending_modes_stiffness(&t, made_of, part[1]);
    for (int r = 0; r < 12; r++) {
        const double *stiff = part[r / 6][r % 6];
        const double(*of)[18] = (const double(*)[18])row + r / 6 * 6;
        for (int j = 0; j < 18; j++) {
            double sum = 0;
            for (int m = 0; m < 6; m++) sum += stiff[m] * of[m][j];
            force[r][j] = sum;
        }
    }
    for (int i = 0; i < 18; i++)
        for (int j = 0; j < 18; j++) {
            double sum = 0;
            for (int r = 0; r < 12; r++) sum += row[r][i] * force[r][j];
            k[i][j] = sum;
        }
    for (int i = 0; i < 18; i++)
        for (int j = 0; j < i; j++) k[i][j] = k[j][i];
}

void facet_resultants(const double node[3][3], const facet_material *made_of, const double u[18],
                      resultants at[3])
{
    double frame[3][3], row[12][18], mode[12];
    facet_frame(node, frame);
    flat_triangle t = facet_flat(node, (const double(*)[3])frame);
    facet_rows(&t, (const double(*)[3])frame, row);
    for (int r = 0; r < 12; r++) {
        mode[r] = 0;
        for (int j = 0; j < 18; j++) mode[r] += row[r][j] * u[j];
    }
    membrane_resultants(&t, made_of, mode, at);
    bending_resultants(&t, made_of, mode + 6, at);
}

void facet_centre(const double node[3][3], const double frame[3][3], const facet_material *made_of,
                  const double u[18], resultants *centre)
{
    double stretches[9], bends[9]; // unknowns in the facet's axes
    const double *x = frame[0], *y = frame[1], *z = frame[2];
    flat_triangle t = facet_flat(node, frame);
    for (int i = 0; i < 3; i++) {
        const double *move = u + 6 * i, *turn = move + 3;
        double *in_plane = stretches + 3 * i, *across = bends + 3 * i;
        in_plane[0] = x[0] * move[0] + x[1] * move[1] + x[2] * move[2];
        in_plane[1] = y[0] * move[0] + y[1] * move[1] + y[2] * move[2];
        in_plane[2] = z[0] * turn[0] + z[1] * turn[1] + z[2] * turn[2];
        across[0] = z[0] * move[0] + z[1] * move[1] + z[2] * move[2];
        across[1] = x[0] * turn[0] + x[1] * turn[1] + x[2] * turn[2];
        across[2] = y[0] * turn[0] + y[1] * turn[1] + y[2] * turn[2];
    }
    membrane_centre(&t, made_of, stretches, centre->n);
    bending_centre(&t, made_of, bends, centre->m, centre->q);
}

// A membrane with rotations about its normal takes the force across a side as that of a line load, ends fixed
// by 3/2 (alpha_b) of its moments; at a fold those of the two facets leave a moment about the side's normal,
// against which the pressure's has to stand.
void facet_pressure(const double node[3][3], double pressure_mpa, double load[3][6])
{
    double frame[3][3];
    facet_frame(node, frame);
    flat_triangle t = facet_flat(node, (const double(*)[3])frame);
    double third = pressure_mpa * t.area / 3, fixed = 1.5 * pressure_mpa * t.area / 24;
    for (int i = 0; i < 3; i++) {
        // The deflection of a side with slopes s_i, s_j at its ends is a_i a_j (s_i - s_j) . side / 2, whose
        // integral is a 24th of the area: moments about the normal of the side in the plane.
        const double *next = t.side[i], *last = t.side[(i + 2) % 3];
        double about[2] = {fixed * (next[1] - last[1]), -fixed * (next[0] - last[0])};
        for (int c = 0; c < 3; c++) {
            load[i][c] = third * frame[2][c];
            load[i][3 + c] = about[0] * frame[0][c] + about[1] * frame[1][c];
        }
    }
}

VECTORISED void plate_stiffness(const double node[3][2], const facet_material *made_of, double k[9][9])
{
    double row[6][9], stiff[6][6], force[6][9];
    flat_triangle t = lay_flat(node);
    bending_rows(&t, row);
    bending_modes_stiffness(&t, made_of, stiff);
    for (int r = 0; r < 6; r++)
        for (int j = 0; j < 9; j++) {
            double sum = 0;
            for (int m = 0; m < 6; m++) sum += stiff[r][m] * row[m][j];
            force[r][j] = sum;
        }
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            double sum = 0;
            for (int r = 0; r < 6; r++) sum += row[r][i] * force[r][j];
            k[i][j] = sum;
        }
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < i; j++) k[i][j] = k[j][i];
}
