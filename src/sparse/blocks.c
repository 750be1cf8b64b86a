// Symmetric matrices of structures, by blocks.
//
// Checked: tests/test_solver.c.
#include "sparse/blocks.h"

void block_matrix_free(jali_context *ctx, block_matrix *a)
{
    release(ctx, a->first);
    release(ctx, a->row);
    release(ctx, a->column);
    release(ctx, a->entry);
    release(ctx, a->value);
    *a = (block_matrix){0};
}

jali_status block_matrix_lay(jali_context *ctx, block_matrix *a, const uint8_t *width)
{
    jali_status status;
    int64_t unknowns = 0, block = 0, at = 0;
    TRY(ALLOCATE(ctx, a->first, a->node_count + 1));
    TRY(ALLOCATE(ctx, a->entry, a->row[a->node_count] + 1));
    for (int32_t i = 0; i < a->node_count; i++) {
        a->first[i] = (int32_t)unknowns;
        unknowns += width[i];
        if (unknowns >= INT32_MAX) {
            status = fail(ctx, JALI_LIMIT, "a structure of %d nodes has more than %d unknowns", a->node_count,
                          INT32_MAX - 1);
            goto done;
        }
        for (; block < a->row[i + 1]; block++) {
            int64_t w = width[i];
            a->entry[block] = at;
            at += a->column[block] == i ? w * (w + 1) / 2 : w * width[a->column[block]];
        }
    }
    a->first[a->node_count] = (int32_t)unknowns;
    a->entry[block] = at;
    TRY(ALLOCATE(ctx, a->value, at));
done:
    return status;
}

// A block below the diagonal acts twice: as it stands, and turned over.
static void beside(const double *value, int32_t rows, int32_t columns, const double *x_row,
                   const double *x_column, double *r_row, double *r_column)
{
    for (int32_t i = 0; i < rows; i++)
        for (int32_t k = 0; k < columns; k++, value++) {
            r_row[i] -= *value * x_column[k];
            r_column[k] -= *value * x_row[i];
        }
}

static void diagonal(const double *value, int32_t rows, const double *x, double *r)
{
    for (int32_t i = 0; i < rows; i++) {
        for (int32_t k = 0; k < i; k++, value++) {
            r[i] -= *value * x[k];
            r[k] -= *value * x[i];
        }
        r[i] -= *value++ * x[i];
    }
}

void block_residual(const block_matrix *a, const double *x, const double *b, double *r)
{
    memcpy(r, b, (size_t)unknowns_of(a) * sizeof *r);
    for (int32_t i = 0; i < a->node_count; i++) {
        int32_t at = a->first[i], rows = a->first[i + 1] - at;
        int64_t last = a->row[i + 1] - 1;
        for (int64_t block = a->row[i]; block < last; block++) {
            int32_t k = a->column[block];
            beside(a->value + a->entry[block], rows, a->first[k + 1] - a->first[k], x + at, x + a->first[k],
                   r + at, r + a->first[k]);
        }
        diagonal(a->value + a->entry[last], rows, x + at, r + at);
    }
}
