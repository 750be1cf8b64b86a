// Published curved shells and a folded one.
#ifndef TESTS_PUBLISHED_SHELLS_H
#define TESTS_PUBLISHED_SHELLS_H

#include "published_common.h"

// A pipe under pressure, free to lengthen: the hoop stress at its free end over p R / t.
static inline double pipe(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
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
    return stress_at(with, &m, 0.5, 1, MIDDLE) * 0.2 / 10;
}

static inline double scordelis_lo(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
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

static inline double pinched_cylinder(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
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

static inline double hemisphere_with_hole(jali_context *with, int32_t n, stiffness_of *element,
                                          double nothing)
{
    (void)nothing;
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

static inline double hemisphere_whole(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
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

// NAFEMS LE5: a Z-section twisted by two forces of 0.6 MN: axial stress at the flange's edge, a quarter
// along.
static inline double nafems_le5(jali_context *with, int32_t n, stiffness_of *element, double nothing)
{
    (void)nothing;
    shell_model m = grid_model(4 * n, 10 * n, CROSSED, (facet_material){210e3, 0.3, 100});
    m.element = element;
    for (int32_t i = 0; i < m.node_count; i++) {
        double along = 4 * m.place[i][0] - 2; // metres around the section, 0 in the middle of the web
        m.node[i][0] = 10e3 * m.place[i][1];
        m.node[i][1] = 1e3 * (along < -1 ? along + 1 : along > 1 ? along - 1 : 0);
        m.node[i][2] = 1e3 * MIN(MAX(along, -1), 1);
    }
    hold(&m, 1, 0, HOLD_ALL);
    for (int32_t i = 0; i < m.node_count; i++) {
        double s = m.place[i][0];
        if (m.place[i][1] < 1 || (s > 0.25 && s < 0.75)) continue;
        double share = s == 0 || s == 0.25 || s == 0.75 || s == 1 ? 0.5 : 1;
        m.load[i][1] = 0.6e6 / n * share * (s < 0.5 ? -1 : 1);
    }
    return stress_at(with, &m, 0, 0.25, MIDDLE);
}

#endif
