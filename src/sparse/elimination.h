// How a structure is eliminated: the order of its nodes, and the fronts. Internal.
//
// A front is a run of nodes in the order of elimination whose columns in the factor have (nearly) one
// pattern: they are eliminated together, in dense matrices. Fronts form a forest: what a front leaves over
// goes to its parent.
#ifndef SPARSE_ELIMINATION_H
#define SPARSE_ELIMINATION_H

#include "sparse/blocks.h"

/// {0} is valid and empty. Positions are those of nodes in the order of elimination, a postorder of the
/// forest.
typedef struct elimination {
    int32_t *node;     // [node_count] which node comes as the i-th
    int32_t *position; // [node_count] when a node comes
    int32_t *start;    // [node_count + 1] unknowns before a position
    int32_t front_count;
    int32_t *first;  // [front_count + 1] front f eliminates the positions first[f] .. first[f+1]-1
    int32_t *parent; // [front_count] a later front; -1: none
    int32_t *child;  // [front_count] the first of its children; -1: none
    int32_t *next;   // [front_count] the next child of the same parent; -1: it is the last
    int64_t *row;    // [front_count + 1] front f has the rows below its pivots: row[f] .. row[f+1]-1
    int32_t *below;  // [row[front_count]] positions, ascending
    int32_t *height; // [front_count] unknowns of these rows
    int64_t *panel;  // [front_count + 1] where a front's columns begin in the factor
} elimination;

static inline int32_t pivots_of(const elimination *e, int32_t front)
{
    return e->start[e->first[front + 1]] - e->start[e->first[front]];
}

/// Order a pattern and find its fronts.
///   in     place   [node_count] of the nodes: what lies near is joined
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   of surfaces: O(n log n)
jali_status eliminate(jali_context *ctx, const block_matrix *a, const double (*place)[3], elimination *e);
void elimination_free(jali_context *ctx, elimination *e);

/// An order of elimination with little fill: nested dissection of the nodes.
///   in     place   [node_count]
///   out    node    [node_count] which node comes as the i-th
jali_status dissect(jali_context *ctx, const block_matrix *a, const double (*place)[3], int32_t *node);

/// Nodes without unknowns join nothing.
static inline bool joins(const block_matrix *a, int32_t i, int32_t k)
{
    return i != k && a->first[i + 1] > a->first[i] && a->first[k + 1] > a->first[k];
}

#endif
