// From places of a chart to the middle of a wall. Internal.
#ifndef SHEET_CHART_LIFT_H
#define SHEET_CHART_LIFT_H

#include "plane/refine.h"
#include <jali/shell.h>

/// Finds the triangle of a patch at a place, and where that lies in space. {0} is valid and empty.
typedef struct chart_lift {
    const jali_patch *patch;
    const jali_shell *shell;
    int32_t scale;    // units of the finer lattice a unit of the chart
    double step;      // finer units over which slopes are taken
    double finest_mm; // sizes are not less than that
    double *most;     // [outer.mesh.vertex_count] largest size that the curvature allows, mm
    int32_t low[2], columns, rows, cell; // a grid of cells over the patch, finer units
    int32_t *first; // [columns * rows + 1] cell c owns face[first[c]] .. face[first[c + 1] - 1]
    int32_t *face;  // faces of the patch whose boxes meet each cell
} chart_lift;

void chart_lift_free(jali_context *ctx, chart_lift *l);

/// True for triangles of the outer skin whose wall is at least half solid.
static inline bool is_solid(const jali_shell *shell, int32_t triangle)
{
    return !shell->solid || shell->solid[triangle][1] - shell->solid[triangle][0] >= 0.5F;
}

jali_status chart_lift_create(jali_context *ctx, const jali_patch *patch, const jali_shell *shell,
                              int32_t scale, double step, double finest_mm, chart_lift *l);

/// The place in the middle of the wall above a place of the chart.
///   out    thickness_mm   between the skins; may be NULL
///   fails  false where the patch does not lie
bool lift_to_wall(const chart_lift *l, const int32_t at[2], double place[3], double *thickness_mm);

/// The same with the metric and the size allowed there, as a lifting's function; `shared` is a chart_lift.
bool lift_spot(void *shared, const int32_t at[2], spot *to, double *most);

#endif
