// Small dense systems by rows, on LAPACK: what it calls the upper half of a matrix by columns is the lower
// one here, and right sides are its rows.
//
// Checked: tests/test_solver.c.
#include "sparse/dense.h"

#include "sparse/blas.h"

#include <math.h>

static const double ONE = 1;

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

bool lu(int32_t n, double *a, int32_t *pivot)
{
    int info;
    if (n == 0) return true;
    dgetrf_(&n, &n, a, &n, pivot, &info);
    for (int32_t i = 0; i < n; i++)
        if (!(fabs(a[(size_t)i * (size_t)n + (size_t)i]) > 0)) return false;
    return info == 0;
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
