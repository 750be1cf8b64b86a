// Spans: straight ways across a void from solid to solid, where a connector could be laid. Internal to
// reinforce.
#ifndef REINFORCE_SPANS_H
#define REINFORCE_SPANS_H

#include <jali/reinforce.h>
#include "base/base.h"

/// The borders of a sheet against void: each node's neighbours along its loop. {0} is valid and empty.
typedef struct borders {
    int32_t *next, *last; // [node_count] along the loop, solid on the left; -1 where the node is on none
    int32_t cell_units;   // a grid over the chart, to find border nodes by place
    int32_t columns, rows;
    int32_t *first; // [columns * rows + 1] cell i holds node first[i] .. first[i+1]-1
    int32_t *node;  // border nodes by cell
} borders;

jali_status borders_create(jali_context *ctx, const jali_sheet *sheet, const jali_chart *chart, borders *b);
void borders_free(jali_context *ctx, borders *b);

/// The border node nearest to a place of the chart within `reach` lattice units, or -1.
int32_t border_near(const borders *b, const jali_sheet *sheet, const double at[2], double reach);

/// From one border node straight across void to another.
typedef struct span {
    int32_t node[2];
    double length_mm; // straight, between the nodes
    double width_mm;  // of the connector
    double worth;     // as a rank sees it
} span;

typedef struct spans {
    int32_t count;
    span *span; // [count]
} spans;

/// All spans that a fan of rays finds from border nodes some way apart.
///   in     apart_mm, longest_mm
///          blocked   void pixels that no span crosses; NULL: none
///   out    found   widths are 0; release found->span
jali_status find_spans(jali_context *ctx, const jali_sheet *sheet, const borders *b, const jali_bitmap *mask,
                       const jali_bitmap *blocked, const jali_chart *chart, double apart_mm,
                       double longest_mm, spans *found);

#endif
