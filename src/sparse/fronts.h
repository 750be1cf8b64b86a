// What the solver is made of: shared by solver.c, fronts.c and solve.c alone.
#ifndef SPARSE_FRONTS_H
#define SPARSE_FRONTS_H

#include "sparse/front.h"
#include "sparse/solver.h"

struct solver {
    const block_matrix *a;
    elimination order;
    int64_t *own; // [node_count + 1] position p has the blocks own[p] .. own[p+1]-1 of A, those that couple
    int64_t *own_block; // it with itself and with later positions
    int32_t *own_later; // the later position of each
    int32_t *begin;     // [front_count] the first front of a front's subtree
    int32_t *subtree;   // [subtree_count] roots of the subtrees that are small enough for one thread
    int32_t subtree_count;
    int32_t most_rows; // of a front, in nodes
    double flops;
    double *factor; // [order.panel[front_count]] the fronts' panels
    double **left;  // [front_count] what a front left over for its parent; NULL once it is taken
};

/// Fill the factor from the values of A.
jali_status factor_fronts(jali_context *ctx, solver *s, int32_t *weak_row);

/// Pages of 2 MB where the system has them: touching large blocks costs a third of the time with those of 4
/// kB.
void ask_for_large_pages(double *block, size_t count);

static inline front front_of(const solver *s, int32_t f)
{
    return (front){.pivots = pivots_of(&s->order, f),
                   .height = s->order.height[f],
                   .panel = s->factor ? s->factor + s->order.panel[f] : NULL};
}

#endif
