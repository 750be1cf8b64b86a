// Published beams, made of strips: straight, curved, twisted.
#ifndef TESTS_PUBLISHED_BEAMS_H
#define TESTS_PUBLISHED_BEAMS_H

#include "published_common.h"

static inline double cook(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
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

// 4 across, n along; a unit force at the tip, along an axis: 1 in the plane, 2 out of it.
static inline double curved_beam(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    int along = (int)axis;
    shell_model m = grid_model(4, n, CROSSED, (facet_material){1e7, 0.25, 0.1});
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

static inline shell_model twisted_strip(int32_t n, double thickness)
{
    shell_model m = grid_model(4, n, CROSSED, (facet_material){29e6, 0.22, thickness});
    for (int32_t i = 0; i < m.node_count; i++) {
        double across = 1.1 * (m.place[i][0] - 0.5), angle = m.place[i][1] * M_PI / 2;
        m.node[i][0] = 12 * m.place[i][1];
        m.node[i][1] = across * cos(angle);
        m.node[i][2] = across * sin(angle);
    }
    hold(&m, 1, 0, HOLD_ALL);
    return m;
}

// A unit force at the tip, where the strip stands along z: along axis 2 in its plane, 1 out of it.
static inline double twisted_beam(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    shell_model m = twisted_strip(n, 0.32);
    double force[6] = {0};
    force[(int)axis] = 1;
    load_edge(&m, 1, 1, force);
    return solved(with, &m, element, 0.5, 1, (int)axis);
}

static inline double twisted_beam_thin(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    shell_model m = twisted_strip(n, 0.05);
    double force[6] = {0};
    force[(int)axis] = 1;
    load_edge(&m, 1, 1, force);
    return solved(with, &m, element, 0.5, 1, (int)axis);
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

// A unit force along an axis, or (3) a unit moment about the first.
static inline double beam_of_rectangles(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    return straight_beam(with, n, element, RECTANGLES, (int)axis);
}

static inline double beam_of_trapezoids(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    return straight_beam(with, n, element, TRAPEZOIDS, (int)axis);
}

static inline double beam_of_parallelograms(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    return straight_beam(with, n, element, PARALLELOGRAMS, (int)axis);
}

// Raasch's hook: two arcs, 20 wide; unit force across at the tip. n cells along each 30 degrees.
static inline double raasch_hook(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
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
static inline double strip(jali_context *with, int32_t n, stiffness_of *element, double axis)
{
    int along = (int)axis;
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

#endif
