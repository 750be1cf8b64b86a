// The sheet of a picture on a surface, and of what surrounds it. Internal.
#ifndef SHEET_SHEET_SHELL_H
#define SHEET_SHEET_SHELL_H

#include "sheet/arrange.h"
#include "sheet/chart_lift.h"
#include "mesh/sides.h"

/// An edge of the patch with the patch on one side only.
typedef struct patch_border {
    int32_t from, to; // points of the patch, the patch on the left
    int32_t side;     // of the outer skin, next to the patch's triangle
    int32_t first;    // its pieces are that many lines of the drawing, from this one
    int32_t pieces;
} patch_border;

typedef struct shell_sheet {
    const jali_contours *picture;
    const jali_chart *chart;
    const jali_patch *patch;
    const jali_shell *shell;
    jali_sheet_options opt;
    sides outer; // of the outer skin
    int32_t border_count;
    patch_border *border;
    drawing drawing;
    int32_t *home; // [drawing.point_count] points of the plane
    triangulation plane;
    chart_lift lift;
    refinement fine;
    sheet_lengths length; // mm
} shell_sheet;

/// In how many pieces an edge of the outer skin is split where surface and picture join.
int32_t pieces_of_edge(const shell_sheet *s, int32_t a, int32_t b);

/// Add the triangles of the outer skin that are not in the patch.
///   in     node_at   [plane.point_count] the node at each point, or -1
///   inout  sheet     that of the patch
jali_status join_rest(jali_context *ctx, const shell_sheet *s, const int32_t *node_at, jali_sheet *sheet);

#endif
