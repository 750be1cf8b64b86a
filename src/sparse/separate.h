// The least set of nodes that parts a graph's low end from its high end. Internal.
#ifndef SPARSE_SEPARATE_H
#define SPARSE_SEPARATE_H

#include "base/base.h"

/// Which side of a cut a node is on; nodes that separators hold already are on none.
enum { LOW, HIGH, MIDDLE, PARTED = -1 };

/// A graph by nodes: node i has the neighbours beside[first[i]] .. beside[first[i+1]-1].
typedef struct node_graph {
    int32_t count;
    int32_t *node;   // [count] of the structure
    int32_t *first;  // [count + 1]
    int32_t *beside; // [first[count]] both halves, without the loops
} node_graph;

/// Room for paths through so many nodes; by the numbers that nodes have among them.
typedef struct separate_desk {
    int32_t *last, *next; // [count] before and after a node on its path
    int32_t *distance;    // [count] to the high end
    int32_t *edge;        // [count] how many neighbours have been tried
    int32_t *state;       // [2 count] a path in the making
    uint8_t *seen;        // [2 count]
} separate_desk;

/// Part the nodes between LOW and HIGH by as few of them as can be.
///   in     node     [count] those that are MIDDLE now; none of LOW touches one of HIGH
///          number   of a node of the graph: where it stands in `node`
///   inout  side     of a node of the graph: those of `node` become LOW, HIGH or, the least set, MIDDLE
///   cost   O(edges) a phase; a few phases
void separate(const node_graph *g, int32_t count, const int32_t *node, const int32_t *number, int32_t *side,
              const separate_desk *desk);

#endif
