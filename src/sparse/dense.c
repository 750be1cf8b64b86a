// Small dense systems by rows, on LAPACK: what it calls the upper half of a matrix by columns is the lower
// one here, and right sides are its rows.
//
// Checked: tests/test_solver.c.
#include "sparse/dense.h"

#include "sparse/blas.h"

#include <math.h>

static const double ONE = 1, MINUS = -1;

// A pivot below this part of what stood in its place is what rounding left over.
static const double LEAST_PIVOT = 1e-14;

bool cholesky(int32_t n, double *a)
{
    int info;
    if (n == 0) return true;
    dpotrf_("U", &n, a, &n, &info);
    if (info != 0) return false;
    for (int32_t i = 0; i < n; i++) {
        const double *row = a + (size_t)i * (size_t)n;
        double whole = 0; // the diagonal as it was
        for (int32_t k = 0; k <= i; k++) whole += row[k] * row[k];
        if (!(row[i] * row[i] > LEAST_PIVOT * whole)) return false;
    }
    return true;
}

void cholesky_solve(int32_t n, const double *l, int32_t columns, double *b)
{
    if (n == 0 || columns == 0) return;
    dtrsm_("R", "U", "N", "N", &columns, &n, &ONE, l, &n, b, &columns);
    dtrsm_("R", "U", "T", "N", &columns, &n, &ONE, l, &n, b, &columns);
}

enum { TILE = 64 }; // columns of LAPACK's matrix

// What a panel of columns that has been eliminated does to the others, a tile of them at a time.
typedef struct panel_job {
    int32_t n, first, count; // the panel
    double *a;
    const int32_t *pivot;
} panel_job;

static void follow_panel(void *shared, int32_t tile)
{
    static const int FORWARD = 1;
    const panel_job *p = shared;
    int from = tile * TILE, columns = MIN(TILE, p->n - from), first = p->first + 1,
        last = p->first + p->count, below = p->n - last;
    double *top = p->a + (size_t)from * (size_t)p->n, *left = p->a + (size_t)p->first * (size_t)p->n;
    if (from == p->first) return;
    dlaswp_(&columns, top, &p->n, &first, &last, p->pivot, &FORWARD);
    if (from < p->first) return;
    top += p->first;
    left += p->first;
    dtrsm_("L", "L", "N", "U", &p->count, &columns, &ONE, left, &p->n, top, &p->n);
    dgemm_("N", "N", &below, &columns, &p->count, &MINUS, left + p->count, &p->n, top, &p->n, &ONE,
           top + p->count, &p->n);
}

bool lu(jali_context *ctx, int32_t n, double *a, int32_t *pivot)
{
    int info;
    int32_t tiles = (n + TILE - 1) / TILE;
    for (int32_t k = 0; k < n; k += TILE) {
        panel_job p = {n, k, MIN(TILE, n - k), a, pivot};
        int rows = n - k;
        dgetrf_(&rows, &p.count, a + (size_t)k * (size_t)n + k, &n, pivot + k, &info);
        for (int32_t i = k; i < k + p.count; i++) pivot[i] += k;
        if (ctx)
            parallel(ctx, tiles, follow_panel, &p);
        else
            for (int32_t t = 0; t < tiles; t++) follow_panel(&p, t);
    }
    for (int32_t i = 0; i < n; i++)
        if (!(fabs(a[(size_t)i * (size_t)n + (size_t)i]) > 0)) return false;
    return true;
}

static void swap_rows(int32_t count, double *a, double *b)
{
    for (int32_t i = 0; a != b && i < count; i++) {
        double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

void lu_solve(int32_t n, const double *a, const int32_t *pivot, int32_t columns, double *b)
{
    size_t width = (size_t)columns;
    if (n == 0 || columns == 0) return;
    dtrsm_("R", "U", "N", "N", &columns, &n, &ONE, a, &n, b, &columns);
    dtrsm_("R", "L", "N", "U", &columns, &n, &ONE, a, &n, b, &columns);
    for (int32_t k = n; k-- > 0;)
        swap_rows(columns, b + (size_t)k * width, b + (size_t)(pivot[k] - 1) * width);
}

void add_product(int32_t rows, int32_t inner, int32_t columns, const double *a, size_t stride_a,
                 const double *b, size_t stride_b, double *c, size_t stride_c)
{
    int lead_a = (int)stride_a, lead_b = (int)stride_b, lead_c = (int)stride_c;
    if (rows == 0 || inner == 0 || columns == 0) return;
    dgemm_("N", "N", &columns, &rows, &inner, &ONE, b, &lead_b, a, &lead_a, &ONE, c, &lead_c);
}
