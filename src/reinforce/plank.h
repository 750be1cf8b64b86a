// Planks: connectors as elements, from border chain to border chain. Internal to reinforce.
#ifndef REINFORCE_PLANK_H
#define REINFORCE_PLANK_H

#include "reinforce/spans.h"

/// A strip of triangles across a void. {0} is valid and empty. Nodes 0 .. end_count-1 are nodes of the sheet.
typedef struct plank {
    int32_t end_count, node_count, triangle_count;
    int32_t *end;           // [end_count] which nodes of the sheet
    double (*node)[3];      // [node_count] mm
    double *thickness_mm;   // [node_count]
    int32_t (*triangle)[3]; // [triangle_count] in the plank's numbers, wound as the sheet's
} plank;

/// Lay a plank of about the span's width along it. Its ends follow the borders.
///   out    p       end_count 0 when the borders leave no room: they are too short, the same, or too bent
jali_status plank_create(jali_context *ctx, const jali_sheet *sheet, const borders *b, const span *s,
                         plank *p);
/// Is there room for one? A quick look that plank_create confirms.
bool plank_has_room(const jali_sheet *sheet, const borders *b, const span *s);

void plank_free(jali_context *ctx, plank *p);

/// The sheet with planks, as one; the first nodes are the sheet's own.
jali_status join_planks(jali_context *ctx, const jali_sheet *sheet, const plank *planks, int32_t count,
                        jali_sheet *joined);

#endif
