// Beams for ranking: natural modes of a Timoshenko beam, each blind to rigid motion.
//
//   stretch     (u1 - u0).x                              E A / L
//   twist       (r1 - r0).x                              G J / L
//   bow         (r1 - r0).y   out of the wall, even      E I / L
//   shear       (u1 - u0).z + L (r0 + r1).y / 2, odd     12 E I / (L^3 (1 + 12 E I / (k G A L^2)))
//   and both of these within the wall.
// J of a rectangle a >= b: a b^3 (1/3 - 0.21 b/a (1 - b^4 / 12 a^4)) (Roark, table 10.7). A plate under
// transverse load has twist, bow and shear out of the wall alone.
#include "reinforce/beam.h"
#include "base/vector.h"

#include <math.h>

static const double SHEAR_FACTOR = 5.0 / 6;
// Of an end's three nodes in what it does.
static const double SHARE[3] = {0.5, 0.25, 0.25};

static void make_unit(double a[3])
{
    double size = sqrt(dot(a, a));
    for (int k = 0; k < 3; k++) a[k] = size > 0 ? a[k] / size : 0;
}

static double twist_constant(double one, double other)
{
    double a = fmax(one, other), b = fmin(one, other), q = b / a;
    return a * b * b * b * (1.0 / 3 - 0.21 * q * (1 - q * q * q * q / 12));
}

// Square to the wall: across the border's direction at both ends and the beam.
static void wall_axis(const jali_sheet *sheet, const borders *b, const span *s, const double x[3],
                      double z[3])
{
    memset(z, 0, 3 * sizeof *z);
    for (int end = 0; end < 2; end++) {
        int32_t i = s->node[end];
        double along[3], n[3];
        for (int k = 0; k < 3; k++) along[k] = sheet->node[b->next[i]][k] - sheet->node[b->last[i]][k];
        // Solid lies to the left of the border; at end 0 the beam goes off to the right, at end 1 it comes
        // from there.
        cross(x, along, n);
        for (int k = 0; k < 3; k++) z[k] += end == 0 ? n[k] : -n[k];
    }
    double lean = dot(z, x);
    for (int k = 0; k < 3; k++) z[k] -= lean * x[k];
    make_unit(z);
}

// Add share * (a.u or a.r) of an end to a mode's weights.
static void add_weight(beam *b, int mode, int end, bool turned, const double axis[3], double share)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            b->weight[mode][3 * end + i][k + (turned ? 3 : 0)] += SHARE[i] * share * axis[k];
}

// Even and odd bending about `about`, which moves the beam along `across`; sign: of a turn's effect.
static void add_bending(beam *b, int even, const double about[3], const double across[3], double sign)
{
    for (int end = 0; end < 2; end++) {
        double side = end ? 1 : -1;
        add_weight(b, even, end, true, about, side);
        add_weight(b, even + 1, end, false, across, side);
        add_weight(b, even + 1, end, true, about, sign * b->length_mm / 2);
    }
}

static void set_mode(beam *b, int mode, double stiffness, double stress)
{
    b->stiffness[mode] = stiffness;
    b->stress[mode] = stress;
}

// The section has the modulus w * t^2 / 6; an odd force bends the ends by half the length.
static void stiffen_bending(beam *b, int even, double e, double ga, double w, double t)
{
    double length = b->length_mm, ei = e * w * t * t * t / 12, modulus = w * t * t / 6;
    set_mode(b, even, ei / length, 1 / modulus);
    set_mode(b, even + 1, 12 * ei / (length * length * length * (1 + 12 * ei / (ga * length * length))),
             fmax(length / 2 / modulus, sqrt(3) * 1.5 / (w * t)));
}

void beam_stiffen(beam *b, const jali_material *material, double w)
{
    double e = material->e_mpa, g = e / (2 * (1 + material->nu)), t = b->thickness_mm,
           ga = SHEAR_FACTOR * g * w * t;
    set_mode(b, 0, g * twist_constant(w, t) / b->length_mm,
             sqrt(3) * (3 + 1.8 * fmin(w, t) / fmax(w, t)) / (fmax(w, t) * fmin(w, t) * fmin(w, t)));
    stiffen_bending(b, 1, e, ga, w, t);
    if (b->mode_count < BEAM_MODES) return;
    stiffen_bending(b, 3, e, ga, t, w);
    set_mode(b, 5, e * w * t / b->length_mm, 1 / (w * t));
}

void beam_along(const jali_sheet *sheet, const borders *loops, const span *s, const jali_material *material,
                bool bending_only, beam *out)
{
    double x[3], y[3], z[3];
    *out = (beam){.mode_count = bending_only ? 3 : BEAM_MODES,
                  .length_mm = fmax(s->length_mm, 1e-6),
                  .thickness_mm = (sheet->thickness_mm[s->node[0]] + sheet->thickness_mm[s->node[1]]) / 2};
    for (int k = 0; k < 3; k++) x[k] = sheet->node[s->node[1]][k] - sheet->node[s->node[0]][k];
    make_unit(x);
    wall_axis(sheet, loops, s, x, z);
    cross(z, x, y);
    for (int end = 0; end < 2; end++) {
        int32_t i = s->node[end];
        out->node[3 * end] = i;
        out->node[3 * end + 1] = loops->next[i];
        out->node[3 * end + 2] = loops->last[i];
        add_weight(out, 0, end, true, x, end ? 1 : -1);
        if (!bending_only) add_weight(out, 5, end, false, x, end ? 1 : -1);
    }
    add_bending(out, 1, y, z, 1);
    if (!bending_only) add_bending(out, 3, z, y, -1);
    beam_stiffen(out, material, s->width_mm);
}

void beam_deformation(const beam *b, const double (*u)[6], double mode[BEAM_MODES])
{
    double mean[2][6];
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < 6; k++) {
            mean[end][k] = 0;
            for (int i = 0; i < 3; i++) mean[end][k] += SHARE[i] * u[b->node[3 * end + i]][k];
        }
    for (int m = 0; m < b->mode_count; m++) {
        mode[m] = 0;
        for (int end = 0; end < 2; end++)
            for (int k = 0; k < 6; k++) mode[m] += b->weight[m][3 * end][k] / SHARE[0] * mean[end][k];
    }
}
