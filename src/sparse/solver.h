// The door to the direct solver of structures: A x = b with A symmetric and positive definite. Internal.
//
// One thing behind it today: the sequential MUMPS (mumps.c) over an order of METIS (dissect.c).
#ifndef SPARSE_SOLVER_H
#define SPARSE_SOLVER_H

#include "sparse/blocks.h"

typedef struct solver solver;

/// What the last factor cost.
typedef struct solver_figures {
    double flops;        // of the elimination
    uint64_t entries;    // of the factor
    uint64_t held_bytes; // by the solver: the factor, its workspace, the places of the matrix's entries
} solver_figures;

/// Order and analyse a pattern; the values are not looked at.
///   in     a     must live and keep its pattern as long as the solver does; each node has a block of its own
///   out    s     close with solver_close; also on failure NULL
///   fails  JALI_NO_MEMORY, JALI_LIMIT (memory, time), JALI_CANCELLED
///   cost   of surfaces: O(n log n)
jali_status solver_open(jali_context *ctx, const block_matrix *a, solver **s);

/// Factor the values that stand in the matrix now; may be called again when they have changed.
///   out    weak_row   the unknown where elimination came to an end (JALI_NO_RESULT); -1: not known
///   fails  JALI_NO_RESULT (not positive definite), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   of surfaces: O(n^1.5) time, O(n log n) memory
jali_status solver_factor(jali_context *ctx, solver *s, int32_t *weak_row);

/// Solve for dense right sides.
///   inout  x   [count][unknowns] right sides; the solutions
jali_status solver_solve(jali_context *ctx, solver *s, int32_t count, double *x);

/// Entries of the inverse where some rows meet some columns; with both the same, F = P^T A^-1 P.
///   in     row, column   unknowns, ascending, each once
///   out    f             [column_count][row_count]
///   cost   far below that of as many solutions: only the paths from the unknowns to the root are walked
jali_status solver_inverse(jali_context *ctx, solver *s, int32_t row_count, const int32_t *row,
                           int32_t column_count, const int32_t *column, double *f);

solver_figures solver_cost(const solver *s);

void solver_close(jali_context *ctx, solver *s);

/// An order of elimination with little fill: METIS's nested dissection of the nodes, expanded to unknowns.
///   out    position   [unknowns] counted from 1: when an unknown is eliminated
jali_status dissect(jali_context *ctx, const block_matrix *a, int32_t *position);

#endif
