// The door to the direct solver of structures: A x = b with A symmetric and positive definite. Internal.
//
// Behind it: a multifrontal Cholesky factor (fronts.c) over a nested dissection (dissect.c). It took the
// place of the sequential MUMPS: for a pierced plate of 1.1 million unknowns that one spent 12 us of CPU an
// unknown from assembly to solution and 1.7 kB, this one 6.3 us and 1.3 kB, on any number of threads, and its
// limits of time and memory, its cancelling and the place of a weak pivot are ours.
#ifndef SPARSE_SOLVER_H
#define SPARSE_SOLVER_H

#include "sparse/blocks.h"

typedef struct solver solver;

/// What a factor costs; known from the pattern.
typedef struct solver_figures {
    double flops;
    int64_t entries; // of the factor, 8 bytes each
    int32_t fronts;
} solver_figures;

/// Which solver this is: "direct", or "petsc" (mpi/petsc.c has the same door): then several processes may
/// share the work. Each of them runs the same program on the same input and sees the same answers.
const char *solver_name(void);

/// Of several processes, the one that writes and speaks.
bool solver_leads(void);

/// Whether two threads may each have a solver at work. Processes that share theirs must all ask in one order.
bool solver_serves_threads(void);

/// Which nodes this process assembles: from .. to-1.
void solver_share(int32_t node_count, int32_t *from, int32_t *to);

/// The worst of all processes' outcomes, with its sentence, so that they go on or end together. Each of them
/// asks equally often, up to the first outcome that is not JALI_OK; its end of the run is one such question.
jali_status solver_agree(jali_context *ctx, jali_status status);

/// r = b - A x.
jali_status solver_residual(jali_context *ctx, solver *s, const double *x, const double *b, double *r);

/// Order and analyse a pattern; the values are not looked at.
///   in     a     must live and keep its pattern as long as the solver does; each node has a block of its own
///          place   [node_count] of the nodes, mm: the order goes by what lies near
///   out    s     close with solver_close; also on failure NULL
///   fails  JALI_NO_MEMORY, JALI_LIMIT (memory, time), JALI_CANCELLED
///   cost   of surfaces: O(n log n)
jali_status solver_open(jali_context *ctx, const block_matrix *a, const double (*place)[3], solver **s);

/// Factor the values that stand in the matrix now; may be called again when they have changed.
///   out    weak_row   the unknown where elimination came to an end (JALI_NO_RESULT), else -1
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

#endif
