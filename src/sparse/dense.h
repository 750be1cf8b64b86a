// Small dense systems, by rows. Kernels: no memory of their own. Internal.
#ifndef SPARSE_DENSE_H
#define SPARSE_DENSE_H

#include "base/base.h"

/// A = L L^T in the lower half; the upper one is neither read nor written.
///   inout  a   [n][n]
///   out    false: not positive definite
bool cholesky(int32_t n, double *a);

/// Solve L L^T X = B.
///   inout  b   [n][columns]
void cholesky_solve(int32_t n, const double *l, int32_t columns, double *b);

/// A = L U P with the largest pivot of each row.
///   in     ctx      the threads to share the work of a large system; NULL: the caller's own
///   inout  a        [n][n]
///   out    pivot    [n] for lu_solve
///          false: singular
bool lu(jali_context *ctx, int32_t n, double *a, int32_t *pivot);

/// Solve A X = B.
///   inout  b   [n][columns]
void lu_solve(int32_t n, const double *a, const int32_t *pivot, int32_t columns, double *b);

/// C += A B, with A [rows][inner], B [inner][columns] and a row of each every stride_a, stride_b, stride_c
/// values.
void add_product(int32_t rows, int32_t inner, int32_t columns, const double *a, size_t stride_a,
                 const double *b, size_t stride_b, double *c, size_t stride_c);

#endif
