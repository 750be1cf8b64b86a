// Symmetric matrices of structures: a small dense block for each pair of nodes that share an element.
#ifndef SPARSE_BLOCKS_H
#define SPARSE_BLOCKS_H

#include "base/base.h"

enum { BLOCK_WIDTH = 6 }; // most unknowns of a node

/// The lower half by rows of blocks. {0} is valid and empty.
typedef struct block_matrix {
    int32_t node_count;
    int32_t *first; // [node_count + 1] node i owns the unknowns first[i] .. first[i+1]-1: none to BLOCK_WIDTH
    int64_t *row;   // [node_count + 1] node i owns the blocks row[i] .. row[i+1]-1
    int32_t *column; // [row[node_count]] nodes, ascending; the last one of row i is i itself
    int64_t *entry;  // [row[node_count] + 1] where a block's values begin: rows one after the other, of
                     // the blocks on the diagonal the lower half alone
    double *value;   // [entry[row[node_count]]]
} block_matrix;

/// Set first, entry and the (unset) values, once row and column are there.
///   in     width   [node_count] unknowns of each node
///   fails  JALI_LIMIT (more than 2^31 unknowns), JALI_NO_MEMORY
jali_status block_matrix_lay(jali_context *ctx, block_matrix *a, const uint8_t *width);

void block_matrix_free(jali_context *ctx, block_matrix *a);

static inline int32_t unknowns_of(const block_matrix *a)
{
    return a->node_count > 0 ? a->first[a->node_count] : 0;
}

/// r = b - A x.
void block_residual(const block_matrix *a, const double *x, const double *b, double *r);

#endif
