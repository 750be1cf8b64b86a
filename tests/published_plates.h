// Published plates: clamped, supported, round, skew.
#ifndef TESTS_PUBLISHED_PLATES_H
#define TESTS_PUBLISHED_PLATES_H

#include "published_common.h"

// A quarter, x = 0 and y = 0 in the middle.
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

static inline double supported_pressure(jali_context *with, int32_t n, stiffness_of *element, double high)
{
    return harder_plate(with, n, element, high, false, false);
}

static inline double supported_point(jali_context *with, int32_t n, stiffness_of *element, double high)
{
    return harder_plate(with, n, element, high, false, true);
}

static inline double clamped_pressure(jali_context *with, int32_t n, stiffness_of *element, double high)
{
    return harder_plate(with, n, element, high, true, false);
}

static inline double clamped_point(jali_context *with, int32_t n, stiffness_of *element, double high)
{
    return harder_plate(with, n, element, high, true, true);
}

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

// A rhombus with sides of 1 and an acute angle of 30 degrees, held down all around, free to slope.
static inline void bend_to_rhombus(shell_model *m)
{
    for (int32_t i = 0; i < m->node_count; i++) {
        m->node[i][0] = m->place[i][0] + m->place[i][1] * cos(M_PI / 6);
        m->node[i][1] = m->place[i][1] * sin(M_PI / 6);
        m->held[i] |= HOLD_X | HOLD_Y | HOLD_RZ;
    }
    for (int side = 0; side < 4; side++) hold(m, side / 2, side % 2, HOLD_Z);
}

// Morley's: centre deflection in q L^4 / D.
static inline double skew_plate(jali_context *with, int32_t n, stiffness_of *element, double thickness)
{
    facet_material p = {1e7, 0.3, thickness};
    shell_model m = grid_model(n, n, FALLING, p); // the cut joins the obtuse corners
    bend_to_rhombus(&m);
    load_area(&m, 1, NULL);
    return solved(with, &m, element, 0.5, 0.5, 2) * plate_rigidity(&p);
}

// NAFEMS LE6: the same shape, sides of 1 m, 0.01 thick, -700 Pa: the larger principal stress below, MPa.
static inline double nafems_le6(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
    shell_model m = grid_model(n, n, FALLING, (facet_material){210e9, 0.3, 0.01});
    m.element = element;
    bend_to_rhombus(&m);
    load_area(&m, -700, NULL);
    return 1e-6 * stress_at(with, &m, 0.5, 0.5, PRINCIPAL_INNER);
}

#endif
