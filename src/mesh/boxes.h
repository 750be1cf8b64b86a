// A hierarchy of bounding boxes: eight children a node, found by comparing eight at a time.
//
// The items are ordered along a Morton curve; node i of level l owns the eight nodes 8 i .. 8 i + 7 of level
// l - 1, and level 0 owns the items themselves. So the tree is arithmetic: no pointers, no balance to lose.
// Boxes are float32, rounded outwards: they may report a pair that does not touch, never miss one that does.
#ifndef MESH_BOXES_H
#define MESH_BOXES_H

#include "base/base.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

enum { BOX_WIDTH = 8, BOX_LEVELS = 11 }; // 8^11 > 2^31

typedef struct box {
    float low[3], high[3];
} box;

typedef struct box_node {
    float low[3][BOX_WIDTH], high[3][BOX_WIDTH]; // of the children; those that do not exist are inside out
} box_node;

typedef struct box_tree {
    int32_t item_count;
    int32_t *item;  // [item_count], the item at each place of the curve
    box_node *node; // all levels, the lowest first
    int32_t level_count;
    int32_t first[BOX_LEVELS + 1]; // [level_count + 1], the nodes of level l
} box_tree;

/// Build the tree.
///   fails  JALI_NO_MEMORY
///   cost   O(item_count), four passes of a radix sort
jali_status box_tree_create(jali_context *ctx, int32_t item_count, const box *items, box_tree *tree);
void box_tree_free(jali_context *ctx, box_tree *tree);

/// Which of a node's children touch the box (bit i for child i)?
static inline unsigned box_touches(const box_node *node, const box *b)
{
    unsigned mask = 0;
#ifdef __SSE2__
    for (int half = 0; half < 2; half++) {
        __m128 all = _mm_castsi128_ps(_mm_set1_epi32(-1));
        for (int k = 0; k < 3; k++) {
            all =
                _mm_and_ps(all, _mm_cmple_ps(_mm_loadu_ps(&node->low[k][4 * half]), _mm_set1_ps(b->high[k])));
            all =
                _mm_and_ps(all, _mm_cmpge_ps(_mm_loadu_ps(&node->high[k][4 * half]), _mm_set1_ps(b->low[k])));
        }
        mask |= (unsigned)_mm_movemask_ps(all) << 4 * half;
    }
#else
    for (int i = 0; i < BOX_WIDTH; i++) {
        bool touches = true;
        for (int k = 0; k < 3; k++) touches &= node->low[k][i] <= b->high[k] && node->high[k][i] >= b->low[k];
        mask |= (unsigned)touches << i;
    }
#endif
    return mask;
}

/// A walk over all items whose boxes touch a given one and that lie at place `from` of the curve or later:
///     box_walk walk = box_walk_start(tree, &b, from);
///     for (int32_t place; (place = box_walk_next(&walk)) >= 0;) ... tree->item[place] ...
typedef struct box_walk {
    const box_tree *tree;
    const box *b;
    int32_t from, depth;
    struct {
        int32_t level, node;
        unsigned mask;
    } stack[BOX_LEVELS];
} box_walk;

static inline void box_walk_enter(box_walk *walk, int32_t level, int32_t node)
{
    unsigned mask = box_touches(&walk->tree->node[walk->tree->first[level] + node], walk->b);
    // Leave out the children that end before `from`.
    int64_t first = (int64_t)walk->from >> 3 * level, here = (int64_t)node * BOX_WIDTH;
    if (first > here) mask &= first - here < BOX_WIDTH ? ~0u << (first - here) : 0;
    if (mask) {
        walk->stack[walk->depth].level = level;
        walk->stack[walk->depth].node = node;
        walk->stack[walk->depth++].mask = mask;
    }
}

static inline box_walk box_walk_start(const box_tree *tree, const box *b, int32_t from)
{
    box_walk walk;
    walk.tree = tree;
    walk.b = b;
    walk.from = from;
    walk.depth = 0;
    if (tree->level_count) box_walk_enter(&walk, tree->level_count - 1, 0);
    return walk;
}

static inline int32_t box_walk_next(box_walk *walk)
{
    while (walk->depth > 0) {
        int32_t top = walk->depth - 1, level = walk->stack[top].level;
        int32_t child = walk->stack[top].node * BOX_WIDTH + __builtin_ctz(walk->stack[top].mask);
        walk->stack[top].mask &= walk->stack[top].mask - 1;
        if (!walk->stack[top].mask) walk->depth--;
        if (level == 0) return child;
        box_walk_enter(walk, level - 1, child);
    }
    return -1;
}

#endif
