// One front: dense elimination of its pivots, and what children hand to parents. Internal.
#ifndef SPARSE_FRONT_H
#define SPARSE_FRONT_H

#include "sparse/elimination.h"

/// A front's dense matrices, by columns, the lower halves.
typedef struct front {
    int32_t pivots, height;
    double *panel; // [pivots][pivots + height] columns that are eliminated
    double *rest;  // [height][height] what is left for the parent
} front;

/// Eliminate the pivots: L11 L11^T = A11, L21 = A21 L11^-T, and rest -= L21 L21^T.
///   in     ctx     the threads to share the work of a large front; NULL: the caller's own
///          fresh   nothing was added to the rest, which is not even cleared
///   out    the first pivot that is not positive; -1: none
int32_t front_eliminate(jali_context *ctx, const front *f, bool fresh);

/// Rows of a child that come one after the other in the parent too, in unknowns.
typedef struct row_run {
    int32_t from, to, count;
} row_run;

/// Where a child's rows are in its parent.
///   out    run   [rows of the child]
///          returns how many runs
int32_t match_rows(const elimination *e, int32_t child, int32_t parent, row_run *run);

/// Add what a child left over; its columns of run number `index` alone.
void front_add(const front *f, const double *left, int32_t left_height, const row_run *run, int32_t run_count,
               int32_t index);

#endif
