// What the published cases share: solve and read one value.
#ifndef TESTS_PUBLISHED_COMMON_H
#define TESTS_PUBLISHED_COMMON_H

#include "shell_model.h"

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

/// What a model shows at a place: von Mises of a layer, or the larger principal stress on the inner face.
enum { PRINCIPAL_INNER = LAYERS };

// Solve, recover, free.
static inline double stress_at(jali_context *with, shell_model *m, double s, double t, int what)
{
    stresses found;
    jali_sheet sheet = model_sheet(m);
    double value = NAN;
    if (solve_model(with, m) == JALI_OK &&
        recover_stresses(with, &sheet, &m->made_of, (const double(*)[6])m->u, 0, &found) == JALI_OK) {
        int32_t n = node_at(m, s, t);
        value = what == PRINCIPAL_INNER ? found.principal[n][1][0] : found.von_mises[n][what];
        stresses_free(with, &found);
    }
    free(sheet.thickness_mm);
    model_free(m);
    return value;
}

/// Planes of symmetry x = 0 and y = 0.
enum { MIDDLE_X = HOLD_X | HOLD_RY | HOLD_RZ, MIDDLE_Y = HOLD_Y | HOLD_RX | HOLD_RZ };

#endif
