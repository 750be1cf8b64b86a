// The triangles around each node of a sheet, and which of them are one smooth surface. Internal.
#ifndef STRUCTURE_FANS_H
#define STRUCTURE_FANS_H

#include <jali/sheet.h>

#include "base/base.h"

/// A corner is 3 t + i: node i of triangle t. {0} is valid and empty.
typedef struct fans {
    int32_t node_count, fan_count;
    int32_t *first;     // [node_count + 1] node n has the corners first[n] .. first[n+1]-1 of the list
    int32_t *corner;    // [3 triangle_count] ascending for each node
    int32_t *beside;    // [3 triangle_count] triangle across side i (from node i to i + 1), -1 without;
                        // NOT_SOUGHT: read it through triangle_across
    bool *smooth;       // [3 triangle_count] no crease and no jump of thickness at that side
    int32_t *fan;       // [3 triangle_count] fan of each corner: joined around its node by smooth sides
    int32_t *first_fan; // [node_count + 1] node n has the fans first_fan[n] .. first_fan[n+1]-1
} fans;

void fans_free(jali_context *ctx, fans *f);

enum { NOT_SOUGHT = -2 };

/// Fans of a sheet. A side that more than two triangles share joins none of them.
///   in     normal     [triangle_count] unit vectors
///          thickness  [triangle_count]
///          wanted     [node_count] whose fans are asked for; others have one. Sides are joined for their
///                     triangles and for those that touch these. NULL: all
///   fails  JALI_LIMIT, JALI_NO_MEMORY
///   cost   O(n)
jali_status fans_of(jali_context *ctx, const jali_sheet *sheet, const double (*normal)[3],
                    const double *thickness, const uint8_t *wanted, fans *f);

/// The other triangle that has both ends of a side from its node i to the next; -1 when there is none, or
/// more than one.
int32_t triangle_across(const jali_sheet *sheet, const fans *f, int32_t t, int i);

/// Mark the nodes of every triangle that has one which is marked in `from`.
///   out    to   [node_count] written whole
void mark_around(const jali_sheet *sheet, const uint8_t *from, uint8_t *to);

#endif
