// Published stresses around holes.
#ifndef TESTS_PUBLISHED_HOLES_H
#define TESTS_PUBLISHED_HOLES_H

#include "published_common.h"

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

static inline double kirsch(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
    shell_model m = half_plane_with_hole(n, 1);
    m.element = element;
    for (int32_t i = 0; i < m.node_count; i++) m.held[i] |= HOLD_Z | HOLD_RX | HOLD_RY;
    m.held[node_at(&m, 0.5, 1)] |= HOLD_X;
    load_far(&m, kirsch_load);
    return stress_at(with, &m, 0.5, 0, MIDDLE);
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
    return stress_at(with, &m, 0.5, 0, OUTER_FACE) * thickness * thickness / 6;
}

#define ROARK(q) (1.79 + 0.25 / (0.39 + (q)) + 0.81 / (1 + (q) * (q)) - 0.26 / (1 + (q) * (q) * (q)))

// NAFEMS LE1: a quarter of an elliptic ring pulled outwards by 10 MPa: the stress at the end of its long
// axis.
static inline double nafems_le1(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
    shell_model m = grid_model(n, n, CROSSED, (facet_material){210e3, 0.3, 1});
    m.element = element;
    for (int32_t i = 0; i < m.node_count; i++) {
        double angle = (1 - m.place[i][0]) * M_PI / 2, out = m.place[i][1];
        m.node[i][0] = (2 + 1.25 * out) * cos(angle);
        m.node[i][1] = (1 + 1.75 * out) * sin(angle);
        m.held[i] |= HOLD_Z | HOLD_RX | HOLD_RY;
    }
    hold(&m, 0, 0, MIDDLE_X);
    hold(&m, 0, 1, MIDDLE_Y);
    for (int32_t t = 0; t < m.triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            int32_t a = m.triangle[t][i], b = m.triangle[t][(i + 1) % 3];
            if (m.place[a][1] < 1 || m.place[b][1] < 1) continue;
            for (int k = 0; k < 2; k++) { // the side turned by a right angle points outwards
                double half = 5 * (m.node[b][1 - k] - m.node[a][1 - k]) * (k ? -1 : 1);
                m.load[a][k] += half;
                m.load[b][k] += half;
            }
        }
    return stress_at(with, &m, 1, 0, MIDDLE);
}

#endif
