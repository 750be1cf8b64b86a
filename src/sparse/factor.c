// L D L^T of a sparse positive definite matrix, row by row of L.
//
// Source:  T. Davis, Direct Methods for Sparse Linear Systems, 2006, chapter 4: the elimination tree, the
//          pattern of a row of L as paths in it, and the up-looking factorisation.
// Limits:  one thread; no supernodes: about 1 Gflop/s.
// Checked: tests/test_sparse.c: against products, over seeds; every allocation refused once.
#include "sparse/sparse.h"

typedef struct factoring {
    const sparse_matrix *a;
    sparse_factor *f;
    int32_t *place;  // [size] where a row of the matrix stands in the order
    int32_t *parent; // [size] in the elimination tree; -1: root
    int32_t *seen;   // [size] the last row whose pattern held the column
    int32_t *path;   // [size] scratch: the pattern of a row, from `top` on in the order of elimination
    size_t *used;    // [size] entries of the columns that are there already
    double *dense;   // [size] zero between rows
} factoring;

void sparse_factor_free(jali_context *ctx, sparse_factor *f)
{
    release(ctx, f->order);
    release(ctx, f->first);
    release(ctx, f->row);
    release(ctx, f->value);
    release(ctx, f->diagonal);
    *f = (sparse_factor){0};
}

// The tree, and how many entries each column of L will have (in used).
static void grow_tree(factoring *w)
{
    for (int32_t k = 0; k < w->a->size; k++) {
        int32_t row = w->f->order[k];
        w->parent[k] = -1;
        w->seen[k] = k;
        w->used[k] = 0;
        for (int32_t e = w->a->first[row]; e < w->a->first[row + 1]; e++)
            for (int32_t i = w->place[w->a->column[e]]; i < k && w->seen[i] != k; i = w->parent[i]) {
                if (w->parent[i] < 0) w->parent[i] = k;
                w->used[i]++;
                w->seen[i] = k;
            }
    }
}

// The columns in which row k of L has entries, each before its ancestors; scatters the matrix's row.
static int32_t pattern(factoring *w, int32_t k)
{
    int32_t row = w->f->order[k], top = w->a->size;
    w->seen[k] = k;
    for (int32_t e = w->a->first[row]; e < w->a->first[row + 1]; e++) {
        int32_t i = w->place[w->a->column[e]], length = 0;
        if (i > k) continue;
        w->dense[i] += w->a->value[e];
        for (; w->seen[i] != k; i = w->parent[i]) {
            w->path[length++] = i;
            w->seen[i] = k;
        }
        while (length > 0) w->path[--top] = w->path[--length];
    }
    return top;
}

// One row: solve with the columns above it, keep what comes out.
static bool factor_row(factoring *w, int32_t k)
{
    sparse_factor *f = w->f;
    int32_t top = pattern(w, k);
    double d = w->dense[k], whole = d;
    w->dense[k] = 0;
    for (; top < w->a->size; top++) {
        int32_t i = w->path[top];
        double y = w->dense[i];
        w->dense[i] = 0;
        for (size_t p = f->first[i]; p < w->used[i]; p++) w->dense[f->row[p]] -= f->value[p] * y;
        double l = y / f->diagonal[i];
        d -= l * y;
        f->row[w->used[i]] = k;
        f->value[w->used[i]++] = l;
    }
    f->diagonal[k] = d;
    return d > 1e-15 * whole;
}

jali_status sparse_factorise(jali_context *ctx, const sparse_matrix *a, const int32_t *order,
                             sparse_factor *f)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    factoring w = {.a = a, .f = f};
    *f = (sparse_factor){.size = a->size};
    TRY(ALLOCATE(ctx, f->order, a->size + 1));
    TRY(ALLOCATE(ctx, f->first, a->size + 1));
    TRY(ALLOCATE(ctx, f->diagonal, a->size + 1));
    TRY(ARENA(ctx, w.place, a->size + 1));
    TRY(ARENA(ctx, w.parent, a->size + 1));
    TRY(ARENA(ctx, w.seen, a->size + 1));
    TRY(ARENA(ctx, w.path, a->size + 1));
    TRY(ARENA(ctx, w.used, a->size + 1));
    TRY(ARENA(ctx, w.dense, a->size + 1));
    for (int32_t i = 0; i < a->size; i++) {
        f->order[i] = order[i];
        w.place[order[i]] = i;
        w.dense[i] = 0;
    }
    grow_tree(&w);
    f->first[0] = 0;
    for (int32_t i = 0; i < a->size; i++) {
        f->first[i + 1] = f->first[i] + w.used[i];
        w.used[i] = f->first[i];
        w.seen[i] = -1;
    }
    TRY(ALLOCATE(ctx, f->row, f->first[a->size] + 1));
    TRY(ALLOCATE(ctx, f->value, f->first[a->size] + 1));
    for (int32_t k = 0; k < a->size; k++) {
        if (!factor_row(&w, k)) {
            status = fail(ctx, JALI_NO_RESULT, "pivot %d of %d of a sparse matrix is not positive: %.3g", k,
                          a->size, f->diagonal[k]);
            goto done;
        }
        if (k % 4096 == 0 && stopping(ctx)) TRY(step(ctx, "factor", (double)k / a->size));
    }
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) sparse_factor_free(ctx, f);
    return status;
}

void sparse_solve(const sparse_factor *f, double (*b)[2], double (*scratch)[2])
{
    for (int32_t i = 0; i < f->size; i++) memcpy(scratch[i], b[f->order[i]], sizeof *b);
    for (int32_t i = 0; i < f->size; i++)
        for (size_t p = f->first[i]; p < f->first[i + 1]; p++)
            for (int k = 0; k < 2; k++) scratch[f->row[p]][k] -= f->value[p] * scratch[i][k];
    for (int32_t i = 0; i < f->size; i++)
        for (int k = 0; k < 2; k++) scratch[i][k] /= f->diagonal[i];
    for (int32_t i = f->size; i-- > 0;)
        for (size_t p = f->first[i]; p < f->first[i + 1]; p++)
            for (int k = 0; k < 2; k++) scratch[i][k] -= f->value[p] * scratch[f->row[p]][k];
    for (int32_t i = 0; i < f->size; i++) memcpy(b[f->order[i]], scratch[i], sizeof *b);
}
