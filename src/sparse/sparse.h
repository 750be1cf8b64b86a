// Sparse symmetric positive definite matrices of meshes: ordered by nested dissection, factored as L D L^T.
//
// For laying surfaces flat: one unknown a node, places in the plane to order by, and many solutions
// for two right sides with one factor. Apart from solver.h, which has several unknowns a node; what that
// would cost here has not been measured.
#ifndef SPARSE_SPARSE_H
#define SPARSE_SPARSE_H

#include "base/base.h"

/// A symmetric matrix by rows, both halves of it. Memory is the caller's.
typedef struct sparse_matrix {
    int32_t size;
    int32_t *first;  // [size + 1] row i owns the entries first[i] .. first[i+1]-1
    int32_t *column; // [first[size]] any order, each once, the diagonal among them
    double *value;
} sparse_matrix;

/// {0} is valid and empty.
typedef struct sparse_factor {
    int32_t size;
    int32_t *order;   // [size] the row of the matrix that is eliminated as the i-th
    size_t *first;    // [size + 1] column i of L owns first[i] .. first[i+1]-1
    int32_t *row;     // below the diagonal, ascending
    double *value;    // L without its diagonal of ones
    double *diagonal; // [size] D
} sparse_factor;

/// An order of elimination with little fill: the rows have places in the plane, and the neighbours of a row
/// lie near it. Halves across the longer side, what joins them last, and so on.
///   out    order   [size]
///   fails  JALI_NO_MEMORY
///   cost   O(n log^2 n)
jali_status sparse_order(jali_context *ctx, const sparse_matrix *a, const double (*place)[2], int32_t *order);

/// Factor a positive definite matrix; the order is copied.
///   fails  JALI_NO_RESULT (not positive definite), JALI_LIMIT, JALI_NO_MEMORY
///   cost   of meshes ordered as above: O(n^1.5) time, O(n log n) memory
jali_status sparse_factorise(jali_context *ctx, const sparse_matrix *a, const int32_t *order,
                             sparse_factor *f);
void sparse_factor_free(jali_context *ctx, sparse_factor *f);

/// Solve for two right sides at once.
///   inout  b         [size] right sides; the solutions
///          scratch   [size]
void sparse_solve(const sparse_factor *f, double (*b)[2], double (*scratch)[2]);

#endif
