// Published cases of shells and plates, in one table for tests/test_published.c and bench/published.c.
//
// Each case builds its model at the mesh of the table (its `n`), solves it and gives a value beside the
// published one. Sources in full: docs/analyse.md.
#ifndef TESTS_PUBLISHED_H
#define TESTS_PUBLISHED_H

#include "shell_model.h"

typedef struct published {
    const char *name, *source, *mesh;
    int32_t n;
    double reference;
    double low, high; // percent: where value / reference - 1 must lie
    double (*value)(jali_context *with, int32_t n, stiffness_of *element);
} published;

// Solve, take one unknown of one node, free.
static inline double solved(jali_context *with, shell_model *m, stiffness_of *element, double s, double t,
                            int unknown)
{
    m->element = element;
    double value = solve_model(with, m) == JALI_OK ? m->u[node_at(m, s, t)][unknown] : NAN;
    model_free(m);
    return value;
}

static inline void stretch_grid(shell_model *m, double wide, double high)
{
    for (int32_t n = 0; n < m->node_count; n++) {
        m->node[n][0] = m->place[n][0] * wide;
        m->node[n][1] = m->place[n][1] * high;
    }
}

static inline double plate_rigidity(const facet_material *p)
{
    return p->e_mpa * p->thickness_mm * p->thickness_mm * p->thickness_mm / (12 * (1 - p->nu * p->nu));
}

// Plates. A quarter, x = 0 and y = 0 in the middle.

enum { MIDDLE_X = HOLD_X | HOLD_RY | HOLD_RZ, MIDDLE_Y = HOLD_Y | HOLD_RX | HOLD_RZ };

static inline shell_model quarter_plate(int32_t n, double half_wide, double half_high, facet_material made_of,
                                        int edge_x, int edge_y)
{
    shell_model m = grid_model(n, n, RISING, made_of);
    stretch_grid(&m, half_wide, half_high);
    hold(&m, 0, 0, MIDDLE_X);
    hold(&m, 1, 0, MIDDLE_Y);
    hold(&m, 0, 1, edge_x);
    hold(&m, 1, 1, edge_y);
    return m;
}

// Centre deflection in q a^4 / D.
static inline double clamped_square(jali_context *with, int32_t n, stiffness_of *element, double ratio)
{
    facet_material p = {1e4, 0.3, ratio};
    shell_model m = quarter_plate(n, 0.5, 0.5, p, HOLD_ALL, HOLD_ALL);
    load_area(&m, 1, NULL);
    return solved(with, &m, element, 0, 0, 2) * plate_rigidity(&p);
}

static inline double clamped_square_thin(jali_context *with, int32_t n, stiffness_of *element)
{
    return clamped_square(with, n, element, 0.001);
}

static inline double clamped_square_thick(jali_context *with, int32_t n, stiffness_of *element)
{
    return clamped_square(with, n, element, 0.1);
}

// MacNeal and Harder's rectangular plates: 2 wide, 2 or 10 high, pressure 1e-4 or a force of 4e-4 in the
// middle.
static inline double harder_plate(jali_context *with, int32_t n, stiffness_of *element, double high,
                                  bool clamped, bool point)
{
    // Their thickness is 1e-4; thin plates go with its cube, and 1e-2 is better for the solver.
    facet_material p = {1.7472e7, 0.3, 1e-2};
    int edge_x = clamped ? HOLD_ALL : HOLD_Z | HOLD_RX, edge_y = clamped ? HOLD_ALL : HOLD_Z | HOLD_RY;
    shell_model m = quarter_plate(n, 1, high / 2, p, edge_x, edge_y);
    if (point)
        m.load[node_at(&m, 0, 0)][2] = 4e-4 / 4;
    else
        load_area(&m, 1e-4, NULL);
    return solved(with, &m, element, 0, 0, 2) * 1e6;
}

#define HARDER_PLATE(name, high, clamped, point)                                                             \
    static inline double name(jali_context *with, int32_t n, stiffness_of *element)                          \
    {                                                                                                        \
        return harder_plate(with, n, element, high, clamped, point);                                         \
    }
HARDER_PLATE(simple_square_pressure, 2, false, false)
HARDER_PLATE(simple_square_point, 2, false, true)
HARDER_PLATE(simple_long_pressure, 10, false, false)
HARDER_PLATE(simple_long_point, 10, false, true)
HARDER_PLATE(clamped_square_point, 2, true, true)
HARDER_PLATE(clamped_long_pressure, 10, true, false)
HARDER_PLATE(clamped_long_point, 10, true, true)

// Centre deflection over q a^4 / (64 D) + q a^2 / (4 (5/6) G t).
static inline double clamped_disc(jali_context *with, int32_t n, stiffness_of *element, double thickness)
{
    facet_material p = {1e4, 0.3, thickness};
    shell_model m = fan_model(n, p);
    hold(&m, 0, 1, HOLD_ALL);
    hold(&m, 1, 0, MIDDLE_Y);
    hold(&m, 1, 1, MIDDLE_X);
    m.held[0] |= MIDDLE_X | MIDDLE_Y;
    // The pressure on the disc itself: its polygon has a little less area.
    load_area(&m, 1, NULL);
    double exact = 1 / (64 * plate_rigidity(&p)) + 1 / (4 * 5. / 6 * thickness * p.e_mpa / (2 * (1 + p.nu)));
    return solved(with, &m, element, 0, 0, 2) / exact;
}

static inline double clamped_disc_thin(jali_context *with, int32_t n, stiffness_of *element)
{
    return clamped_disc(with, n, element, 0.01);
}

static inline double clamped_disc_thick(jali_context *with, int32_t n, stiffness_of *element)
{
    return clamped_disc(with, n, element, 0.2);
}

// Morley's rhombus, acute angle 30 degrees, edges held down softly: centre deflection in q L^4 / D.
static inline double skew_plate(jali_context *with, int32_t n, stiffness_of *element)
{
    facet_material p = {1e7, 0.3, 0.001};
    shell_model m = grid_model(n, n, FALLING, p); // the cut joins the obtuse corners
    for (int32_t i = 0; i < m.node_count; i++) {
        m.node[i][0] = m.place[i][0] + m.place[i][1] * cos(M_PI / 6);
        m.node[i][1] = m.place[i][1] * sin(M_PI / 6);
        m.held[i] |= HOLD_X | HOLD_Y | HOLD_RZ;
    }
    for (int side = 0; side < 4; side++) hold(&m, side / 2, side % 2, HOLD_Z);
    load_area(&m, 1, NULL);
    return solved(with, &m, element, 0.5, 0.5, 2) * plate_rigidity(&p);
}

// Beams as strips.

static inline double cook(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = grid_model(n, n, FALLING, (facet_material){1, 1. / 3, 1});
    for (int32_t i = 0; i < m.node_count; i++) {
        double s = m.place[i][0], t = m.place[i][1];
        m.node[i][0] = 48 * s;
        m.node[i][1] = 44 * (s + t) - 28 * s * t;
        m.held[i] |= HOLD_Z | HOLD_RX | HOLD_RY;
    }
    hold(&m, 0, 0, HOLD_X | HOLD_Y);
    load_edge(&m, 0, 1, (double[6]){0, 1});
    return solved(with, &m, element, 1, 0.5, 1);
}

// 4 across, n along; a unit force at the tip, in the plane.
static inline double curved_beam(jali_context *with, int32_t n, stiffness_of *element, int32_t across,
                                 int along)
{
    shell_model m = grid_model(across, n, CROSSED, (facet_material){1e7, 0.25, 0.1});
    for (int32_t i = 0; i < m.node_count; i++) {
        double r = 4.12 + 0.2 * m.place[i][0], angle = m.place[i][1] * M_PI / 2;
        m.node[i][0] = r * cos(angle);
        m.node[i][1] = r * sin(angle);
    }
    hold(&m, 1, 0, HOLD_ALL);
    double force[6] = {0};
    force[along] = 1;
    load_edge(&m, 1, 1, force);
    return solved(with, &m, element, 0.5, 1, along);
}

static inline double curved_beam_in_plane(jali_context *with, int32_t n, stiffness_of *element)
{
    // Along the tip's radius, which points along y; with 4 across.
    return curved_beam(with, n, element, 4, 1);
}

static inline double curved_beam_out(jali_context *with, int32_t n, stiffness_of *element)
{
    return curved_beam(with, n, element, 4, 2);
}

static inline double twisted_beam(jali_context *with, int32_t n, stiffness_of *element, int along)
{
    shell_model m = grid_model(4, n, CROSSED, (facet_material){29e6, 0.22, 0.32});
    for (int32_t i = 0; i < m.node_count; i++) {
        double across = 1.1 * (m.place[i][0] - 0.5), angle = m.place[i][1] * M_PI / 2;
        m.node[i][0] = 12 * m.place[i][1];
        m.node[i][1] = across * cos(angle);
        m.node[i][2] = across * sin(angle);
    }
    hold(&m, 1, 0, HOLD_ALL);
    double force[6] = {0};
    force[along] = 1;
    load_edge(&m, 1, 1, force);
    return solved(with, &m, element, 0.5, 1, along);
}

// At the tip the strip stands along z.
static inline double twisted_beam_in_plane(jali_context *with, int32_t n, stiffness_of *element)
{
    return twisted_beam(with, n, element, 2);
}

static inline double twisted_beam_out(jali_context *with, int32_t n, stiffness_of *element)
{
    return twisted_beam(with, n, element, 1);
}

// MacNeal and Harder's straight cantilever, 6 x 0.2 x 0.1, one row of 6: rectangles, trapezoids,
// parallelograms.
typedef enum beam_shape { RECTANGLES, TRAPEZOIDS, PARALLELOGRAMS } beam_shape;

static inline double straight_beam(jali_context *with, int32_t n, stiffness_of *element, beam_shape shape,
                                   int along)
{
    // Twist needs cells that are not too long: five times as many.
    shell_model m = grid_model(along == 3 ? 30 * n : 6 * n, n, CROSSED, (facet_material){1e7, 0.3, 0.1});
    for (int32_t i = 0; i < m.node_count; i++) {
        double s = m.place[i][0] * 6, t = m.place[i][1] - 0.5, lean = 0;
        int32_t k = (int32_t)floor(s);
        // Cell walls lean by 45 degrees; inside a cell the lean is shared.
        double left = k == 0 ? 0 : shape == TRAPEZOIDS ? (k % 2 ? 1 : -1) : 1;
        double right = k >= 5 ? 0 : shape == TRAPEZOIDS ? (k % 2 ? -1 : 1) : 1;
        if (shape != RECTANGLES && k < 6) lean = left + (right - left) * (s - k);
        m.node[i][0] = s + 0.2 * t * lean;
        m.node[i][1] = 0.2 * t;
    }
    hold(&m, 0, 0, HOLD_ALL);
    double force[6] = {0};
    force[along] = 1;
    load_edge(&m, 0, 1, force);
    return solved(with, &m, element, 1, 0.5, along);
}

#define STRAIGHT_BEAM(name, shape, along)                                                                    \
    static inline double name(jali_context *with, int32_t n, stiffness_of *element)                          \
    {                                                                                                        \
        return straight_beam(with, n, element, shape, along);                                                \
    }
STRAIGHT_BEAM(beam_stretched, TRAPEZOIDS, 0)
STRAIGHT_BEAM(beam_in_plane, RECTANGLES, 1)
STRAIGHT_BEAM(beam_in_plane_trapezoids, TRAPEZOIDS, 1)
STRAIGHT_BEAM(beam_in_plane_parallelograms, PARALLELOGRAMS, 1)
STRAIGHT_BEAM(beam_out, RECTANGLES, 2)
STRAIGHT_BEAM(beam_out_trapezoids, TRAPEZOIDS, 2)
STRAIGHT_BEAM(beam_out_parallelograms, PARALLELOGRAMS, 2)
STRAIGHT_BEAM(beam_twist, RECTANGLES, 3)

// Raasch's hook: two arcs, 20 wide; unit force across at the tip. 2 n along each 30 degrees.
static inline double raasch_hook(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = grid_model(n, 7 * n, CROSSED, (facet_material){3300, 0.35, 2});
    for (int32_t i = 0; i < m.node_count; i++) {
        double angle = m.place[i][1] * 210 * M_PI / 180, first = MIN(angle, M_PI / 3), x, y;
        x = 14 * sin(first);
        y = 14 * cos(first);
        if (angle > M_PI / 3) { // the second arc turns the other way about a centre on the same radius
            double back = M_PI / 3 - (angle - M_PI / 3);
            x = 60 * sin(M_PI / 3) - 46 * sin(back);
            y = 60 * cos(M_PI / 3) - 46 * cos(back);
        }
        m.node[i][0] = x;
        m.node[i][1] = y;
        m.node[i][2] = 20 * m.place[i][0];
    }
    hold(&m, 1, 0, HOLD_ALL);
    load_edge(&m, 1, 1, (double[6]){0, 0, 1});
    return solved(with, &m, element, 0.5, 1, 2);
}

// A strip an eighth as wide as it is thick, 40 widths long, 4 cells across: the tip, over that of the beam
// with shear (5/6), or of Saint-Venant's torsion, with its root free to warp.
static inline double strip(jali_context *with, int32_t n, stiffness_of *element, int along)
{
    facet_material p = {1000, 0.3, 1};
    double wide = 0.125, length = 40 * wide, shear = p.e_mpa / (2 * (1 + p.nu)), torsion = 0, force[6] = {0};
    shell_model m = grid_model(40 * n, n, CROSSED, p);
    stretch_grid(&m, length, wide);
    for (int32_t i = 0; i < m.node_count; i++) m.node[i][1] -= wide / 2;
    hold(&m, 0, 0, along == 3 ? HOLD_ALL - HOLD_RY : HOLD_ALL);
    m.held[node_at(&m, 0, 0.5)] = HOLD_ALL;
    force[along] = 1;
    load_edge(&m, 0, 1, force);
    for (int k = 1; k < 60; k += 2) torsion += tanh(k * M_PI / (2 * wide)) / pow(k, 5);
    torsion = wide * wide * wide / 3 * (1 - 192 * wide / pow(M_PI, 5) * torsion);
    double inertia = along == 1 ? wide * wide * wide / 12 : wide / 12;
    double exact =
        along == 3 ? length / (shear * torsion)
                   : length * length * length / (3 * p.e_mpa * inertia) + length / (5. / 6 * shear * wide);
    return solved(with, &m, element, 1, 0.5, along) / exact;
}

static inline double strip_in_plane(jali_context *with, int32_t n, stiffness_of *element)
{
    return strip(with, n, element, 1);
}

static inline double strip_out(jali_context *with, int32_t n, stiffness_of *element)
{
    return strip(with, n, element, 2);
}

static inline double strip_twist(jali_context *with, int32_t n, stiffness_of *element)
{
    return strip(with, n, element, 3);
}

// Stress at round holes: half a plane out to 40 radii, n cells a quarter turn, as many again outwards as
// keeps them square.

static inline shell_model half_plane_with_hole(int32_t n, double thickness)
{
    int32_t out = (int32_t)ceil(log(40) / log(1 + M_PI / 2 / n));
    shell_model m = grid_model(2 * n, out, CROSSED, (facet_material){1000, 0.3, thickness});
    for (int32_t i = 0; i < m.node_count; i++) {
        double r = pow(40, m.place[i][1]), angle = M_PI * (1 - m.place[i][0]);
        m.node[i][0] = r * cos(angle);
        m.node[i][1] = r * sin(angle);
    }
    hold(&m, 0, 0, MIDDLE_Y);
    hold(&m, 0, 1, MIDDLE_Y);
    return m;
}

// The stress at the top of the hole as the library recovers it; frees the model.
static inline double stress_at_top(jali_context *with, shell_model *m, int layer)
{
    stresses s;
    jali_sheet sheet = model_sheet(m);
    double value = NAN;
    if (solve_model(with, m) == JALI_OK &&
        recover_stresses(with, &sheet, &m->made_of, (const double(*)[6])m->u, 0, &s) == JALI_OK) {
        value = s.von_mises[node_at(m, 0.5, 0)][layer];
        stresses_free(with, &s);
    }
    free(sheet.thickness_mm);
    model_free(m);
    return value;
}

// Loads on the outer circle, from a function of the angle.
static inline void load_far(shell_model *m, void load(double angle, double force[6]))
{
    for (int32_t t = 0; t < m->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            int32_t end[2] = {m->triangle[t][i], m->triangle[t][(i + 1) % 3]};
            if (m->place[end[0]][1] < 1 || m->place[end[1]][1] < 1) continue;
            double length = 40 * M_PI * fabs(m->place[end[0]][0] - m->place[end[1]][0]);
            for (int e = 0; e < 2; e++) {
                double force[6] = {0};
                load(M_PI * (1 - m->place[end[e]][0]), force);
                for (int k = 0; k < 6; k++) m->load[end[e]][k] += 0.5 * length * force[k];
            }
        }
}

// Kirsch's own stresses there, for 1 MPa along x and a thickness of 1.
static inline void kirsch_load(double angle, double force[6])
{
    double k = 1 / 1600., radial = 0.5 * (1 - k) + 0.5 * (1 - 4 * k + 3 * k * k) * cos(2 * angle);
    double along = -0.5 * (1 + 2 * k - 3 * k * k) * sin(2 * angle);
    force[0] = radial * cos(angle) - along * sin(angle);
    force[1] = radial * sin(angle) + along * cos(angle);
}

static inline void bending_load(double angle, double force[6])
{
    force[4] = cos(angle);
}

static inline double kirsch(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = half_plane_with_hole(n, 1);
    m.element = element;
    for (int32_t i = 0; i < m.node_count; i++) m.held[i] |= HOLD_Z | HOLD_RX | HOLD_RY;
    m.held[node_at(&m, 0.5, 1)] |= HOLD_X;
    load_far(&m, kirsch_load);
    return stress_at_top(with, &m, MIDDLE);
}

static inline double bent_hole(jali_context *with, int32_t n, stiffness_of *element, double ratio)
{
    double thickness = 2 / ratio;
    shell_model m = half_plane_with_hole(n, thickness);
    m.element = element;
    for (int32_t i = 0; i < m.node_count; i++) m.held[i] |= HOLD_X | HOLD_Y | HOLD_RZ;
    m.held[node_at(&m, 0, 1)] |= HOLD_Z;
    m.held[node_at(&m, 1, 1)] |= HOLD_Z;
    load_far(&m, bending_load);
    return stress_at_top(with, &m, OUTER_FACE) * thickness * thickness / 6;
}

static inline double bent_hole_10(jali_context *with, int32_t n, stiffness_of *element)
{
    return bent_hole(with, n, element, 10);
}

static inline double bent_hole_1(jali_context *with, int32_t n, stiffness_of *element)
{
    return bent_hole(with, n, element, 1);
}

static inline double bent_hole_quarter(jali_context *with, int32_t n, stiffness_of *element)
{
    return bent_hole(with, n, element, 0.25);
}

#define ROARK(q) (1.79 + 0.25 / (0.39 + (q)) + 0.81 / (1 + (q) * (q)) - 0.26 / (1 + (q) * (q) * (q)))

// Curved shells.

// A pipe under pressure, free to lengthen: the hoop stress at its free end over p R / t.
static inline double pipe(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = grid_model(n, n, CROSSED, (facet_material){2000, 0.35, 0.2});
    m.element = element;
    for (int32_t i = 0; i < m.node_count; i++) {
        double angle = m.place[i][0] * M_PI / 2;
        m.node[i][0] = 10 * sin(angle);
        m.node[i][1] = 10 * m.place[i][1];
        m.node[i][2] = 10 * cos(angle);
    }
    hold(&m, 0, 0, HOLD_X | HOLD_RY | HOLD_RZ);
    hold(&m, 0, 1, HOLD_Z | HOLD_RX | HOLD_RY);
    hold(&m, 1, 0, HOLD_Y | HOLD_RX | HOLD_RZ);
    for (int32_t t = 0; t < m.triangle_count; t++) {
        double at[3][3], load[3][6];
        corners_of(&m, t, at);
        facet_pressure((const double(*)[3])at, 1, load);
        for (int i = 0; i < 18; i++) m.load[m.triangle[t][i / 6]][i % 6] += load[i / 6][i % 6];
    }
    int32_t middle = node_at(&m, 0.5, 1);
    stresses s;
    jali_sheet sheet = model_sheet(&m);
    double value = NAN;
    if (solve_model(with, &m) == JALI_OK &&
        recover_stresses(with, &sheet, &m.made_of, (const double(*)[6])m.u, 0, &s) == JALI_OK) {
        value = s.von_mises[middle][MIDDLE] * 0.2 / 10;
        stresses_free(with, &s);
    }
    free(sheet.thickness_mm);
    model_free(&m);
    return value;
}

static inline double scordelis_lo(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = grid_model(n, n, FALLING, (facet_material){4.32e8, 0, 0.25});
    for (int32_t i = 0; i < m.node_count; i++) {
        double angle = m.place[i][0] * 40 * M_PI / 180; // 0 on the crown
        m.node[i][0] = 25 * sin(angle);
        m.node[i][1] = 25 * m.place[i][1]; // 0 in the middle
        m.node[i][2] = 25 * cos(angle);
    }
    hold(&m, 0, 0, HOLD_X | HOLD_RY | HOLD_RZ);
    hold(&m, 1, 0, HOLD_Y | HOLD_RX | HOLD_RZ);
    hold(&m, 1, 1, HOLD_X | HOLD_Z);
    load_area(&m, 0, (double[3]){0, 0, -90});
    return -solved(with, &m, element, 1, 0, 2);
}

static inline double pinched_cylinder(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = grid_model(n, n, FALLING, (facet_material){3e6, 0.3, 3});
    for (int32_t i = 0; i < m.node_count; i++) {
        double angle = m.place[i][0] * M_PI / 2;
        m.node[i][0] = 300 * sin(angle);
        m.node[i][1] = 300 * m.place[i][1];
        m.node[i][2] = 300 * cos(angle);
    }
    hold(&m, 0, 0, HOLD_X | HOLD_RY | HOLD_RZ);
    hold(&m, 0, 1, HOLD_Z | HOLD_RX | HOLD_RY);
    hold(&m, 1, 0, HOLD_Y | HOLD_RX | HOLD_RZ);
    hold(&m, 1, 1, HOLD_X | HOLD_Z);
    m.load[node_at(&m, 0, 0)][2] = -0.25;
    return -solved(with, &m, element, 0, 0, 2);
}

static inline double pinched_hemisphere(jali_context *with, shell_model *m, stiffness_of *element,
                                        double outward_t)
{
    int32_t pulled = node_at(m, outward_t >= 0 ? 0 : 1, 0), pushed = node_at(m, 1, outward_t >= 0 ? 0 : 1);
    m->load[pulled][0] = 1;
    m->load[pushed][1] = -1;
    m->element = element;
    double value = NAN;
    if (solve_model(with, m) == JALI_OK) value = 0.5 * (m->u[pulled][0] - m->u[pushed][1]);
    model_free(m);
    return value;
}

static inline double hemisphere_with_hole(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = grid_model(n, n, RISING, (facet_material){6.825e7, 0.3, 0.04});
    for (int32_t i = 0; i < m.node_count; i++) {
        double around = m.place[i][0] * M_PI / 2, up = m.place[i][1] * 72 * M_PI / 180;
        m.node[i][0] = 10 * cos(around) * cos(up);
        m.node[i][1] = 10 * sin(around) * cos(up);
        m.node[i][2] = 10 * sin(up);
    }
    hold(&m, 0, 0, HOLD_Y | HOLD_RX | HOLD_RZ);
    hold(&m, 0, 1, HOLD_X | HOLD_RY | HOLD_RZ);
    m.held[node_at(&m, 0, 0)] |= HOLD_Z;
    return pinched_hemisphere(with, &m, element, 0);
}

static inline double hemisphere_whole(jali_context *with, int32_t n, stiffness_of *element)
{
    shell_model m = fan_model(n, (facet_material){6.825e7, 0.3, 0.04});
    for (int32_t i = 0; i < m.node_count; i++) {
        double around = m.place[i][1] * M_PI / 2, down = m.place[i][0] * M_PI / 2;
        m.node[i][0] = 10 * cos(around) * sin(down);
        m.node[i][1] = 10 * sin(around) * sin(down);
        m.node[i][2] = 10 * cos(down);
    }
    hold(&m, 1, 0, HOLD_Y | HOLD_RX | HOLD_RZ);
    hold(&m, 1, 1, HOLD_X | HOLD_RY | HOLD_RZ);
    m.held[0] |= HOLD_X | HOLD_Y | HOLD_RX | HOLD_RY | HOLD_RZ;
    m.held[node_at(&m, 1, 0)] |= HOLD_Z;
    return pinched_hemisphere(with, &m, element, -1);
}

static const published PUBLISHED[] = {
    {"clamped square, t/a = 0.001", "Timoshenko", "16 x 16 a quarter", 16, 0.00126532, -1, 1,
     clamped_square_thin},
    {"clamped square, t/a = 0.1", "Mindlin theory", "16 x 16 a quarter", 16, 0.00150461, -0.5, 0.5,
     clamped_square_thick},
    {"clamped disc, t/R = 0.01", "closed form", "16 rings a quarter", 16, 1, -0.3, 0.3, clamped_disc_thin},
    {"clamped disc, t/R = 0.2", "closed form", "16 rings a quarter", 16, 1, -0.3, 0.3, clamped_disc_thick},
    {"Scordelis-Lo roof", "MacNeal-Harder", "16 x 16 a quarter", 16, 0.3024, -1, 1, scordelis_lo},
    {"pinched cylinder", "Belytschko", "16 x 16 an eighth", 16, 1.8248e-5, -1, 3, pinched_cylinder},
    {"hemisphere with hole", "MacNeal-Harder", "32 x 32 a quarter", 32, 0.094, -1.5, 1.5,
     hemisphere_with_hole},
    {"twisted beam, in plane", "MacNeal-Harder", "4 x 24", 24, 0.005424, -1, 1, twisted_beam_in_plane},
    {"twisted beam, out of plane", "MacNeal-Harder", "4 x 24", 24, 0.001754, -1, 1, twisted_beam_out},
    {"Cook's membrane", "Felippa", "16 x 16", 16, 23.96, -1, 1, cook},
    {"curved beam, in plane", "MacNeal-Harder", "4 x 24", 24, 0.08734, -1.5, 1.5, curved_beam_in_plane},
    {"hole in tension, stress", "Kirsch", "32 a quarter turn", 32, 3, -3, 3, kirsch},
    {"hole in bending, 2r/t = 10, stress", "Roark 17.1", "32 a quarter turn", 32, ROARK(10), -4, 4,
     bent_hole_10},
    {"hole in bending, 2r/t = 1, stress", "Roark 17.1", "32 a quarter turn", 32, ROARK(1), -4, 4,
     bent_hole_1},
    {"hole in bending, 2r/t = 0.25, stress", "Roark 17.1", "32 a quarter turn", 32, ROARK(0.25), -4, 4,
     bent_hole_quarter},
    {"strip, width/thickness 0.125, bent in plane", "beam with shear", "4 x 160", 4, 1, -0.5, 0.5,
     strip_in_plane},
    {"strip, width/thickness 0.125, bent out of plane", "beam with shear", "4 x 160", 4, 1, -0.5, 0.5,
     strip_out},
    {"strip, width/thickness 0.125, twisted", "Saint-Venant", "4 x 160", 4, 1, -5, 13, strip_twist},
    {"hemisphere, whole", "Belytschko", "32 rings a quarter", 32, 0.0924, -2, 2, hemisphere_whole},
    {"Raasch's hook", "Knight", "20 x 140", 20, 5.02, -2, 2, raasch_hook},
    {"pipe under pressure, stress", "p R / t", "16 x 16 an eighth", 16, 1, -0.5, 0.5, pipe},
    {"supported square, pressure", "MacNeal-Harder", "16 x 16 a quarter", 16, 4.062, -1, 1,
     simple_square_pressure},
    {"supported square, point force", "MacNeal-Harder", "16 x 16 a quarter", 16, 11.60, -1, 1,
     simple_square_point},
    {"supported 1 : 5, pressure", "MacNeal-Harder", "16 x 16 a quarter", 16, 12.97, -1, 1,
     simple_long_pressure},
    {"supported 1 : 5, point force", "MacNeal-Harder", "16 x 16 a quarter", 16, 16.96, -1, 1,
     simple_long_point},
    {"clamped square, point force", "MacNeal-Harder", "16 x 16 a quarter", 16, 5.60, -1, 1,
     clamped_square_point},
    {"clamped 1 : 5, pressure", "MacNeal-Harder", "16 x 16 a quarter", 16, 2.56, -3, 3,
     clamped_long_pressure},
    {"clamped 1 : 5, point force", "MacNeal-Harder", "16 x 16 a quarter", 16, 7.23, -2, 2,
     clamped_long_point},
    {"skew plate, 30 degrees", "Morley", "32 x 32", 32, 0.000408, -5, 5, skew_plate},
    {"curved beam, out of plane", "MacNeal-Harder", "4 x 120", 120, 0.5022, -5, 5, curved_beam_out},
    {"straight beam, stretched, trapezoids", "MacNeal-Harder", "1 x 6", 1, 3e-5, -1, 1, beam_stretched},
    {"straight beam, in plane", "MacNeal-Harder", "1 x 6", 1, 0.1081, -7, 7, beam_in_plane},
    {"straight beam, in plane", "MacNeal-Harder", "4 x 24", 4, 0.1081, -2, 2, beam_in_plane},
    {"straight beam, in plane, trapezoids", "MacNeal-Harder", "4 x 24", 4, 0.1081, -20, 5,
     beam_in_plane_trapezoids},
    {"straight beam, in plane, parallelograms", "MacNeal-Harder", "4 x 24", 4, 0.1081, -35, 5,
     beam_in_plane_parallelograms},
    {"straight beam, out of plane", "MacNeal-Harder", "1 x 6", 1, 0.4321, -3, 3, beam_out},
    {"straight beam, out of plane, trapezoids", "MacNeal-Harder", "1 x 6", 1, 0.4321, -3, 3,
     beam_out_trapezoids},
    {"straight beam, out of plane, parallelograms", "MacNeal-Harder", "1 x 6", 1, 0.4321, -3, 3,
     beam_out_parallelograms},
    {"straight beam, twisted", "Saint-Venant", "4 x 120", 4, 0.03408, -10, 10, beam_twist},
};
enum { PUBLISHED_COUNT = sizeof PUBLISHED / sizeof *PUBLISHED };

#endif
