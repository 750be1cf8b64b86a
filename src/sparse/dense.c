// Small dense systems: Cholesky and LU by rows, so that every inner loop runs along memory.
//
// Limits:  a few hundred rows; no blocking: 2 to 5 Gflop/s.
// Checked: tests/test_solver.c.
#include "sparse/dense.h"

#include <math.h>

VECTORISED static double dot(int32_t n, const double *a, const double *b)
{
    double sum[8] = {0}, all = 0;
    int32_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (int k = 0; k < 8; k++) sum[k] += a[i + k] * b[i + k];
    for (; i < n; i++) all += a[i] * b[i];
    for (int k = 0; k < 8; k++) all += sum[k];
    return all;
}

VECTORISED static void add_scaled(int32_t n, double factor, const double *a, double *b)
{
    for (int32_t i = 0; i < n; i++) b[i] += factor * a[i];
}

bool cholesky(int32_t n, double *a)
{
    for (int32_t i = 0; i < n; i++) {
        double *row = a + (size_t)i * (size_t)n;
        for (int32_t k = 0; k < i; k++) {
            const double *above = a + (size_t)k * (size_t)n;
            row[k] = (row[k] - dot(k, row, above)) / above[k];
        }
        double pivot = row[i] - dot(i, row, row);
        if (!(pivot > 1e-14 * row[i])) return false;
        row[i] = sqrt(pivot);
    }
    return true;
}

void cholesky_solve(int32_t n, const double *l, int32_t columns, double *b)
{
    size_t width = (size_t)columns;
    for (int32_t i = 0; i < n; i++) {
        const double *row = l + (size_t)i * (size_t)n;
        double *x = b + (size_t)i * width;
        for (int32_t k = 0; k < i; k++) add_scaled(columns, -row[k], b + (size_t)k * width, x);
        for (int32_t c = 0; c < columns; c++) x[c] /= row[i];
    }
    for (int32_t i = n; i-- > 0;) {
        const double *row = l + (size_t)i * (size_t)n;
        double *x = b + (size_t)i * width;
        for (int32_t c = 0; c < columns; c++) x[c] /= row[i];
        for (int32_t k = 0; k < i; k++) add_scaled(columns, -row[k], x, b + (size_t)k * width);
    }
}

static void swap_rows(int32_t count, double *a, double *b)
{
    for (int32_t i = 0; a != b && i < count; i++) {
        double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

bool lu(int32_t n, double *a, int32_t *pivot)
{
    size_t width = (size_t)n;
    for (int32_t k = 0; k < n; k++) {
        double *top = a + (size_t)k * width;
        int32_t best = k;
        for (int32_t i = k + 1; i < n; i++)
            if (fabs(a[(size_t)i * width + (size_t)k]) > fabs(a[(size_t)best * width + (size_t)k])) best = i;
        pivot[k] = best;
        swap_rows(n, top, a + (size_t)best * width);
        if (!(fabs(top[k]) > 0)) return false;
        for (int32_t i = k + 1; i < n; i++) {
            double *row = a + (size_t)i * width;
            row[k] /= top[k];
            add_scaled(n - k - 1, -row[k], top + k + 1, row + k + 1);
        }
    }
    return true;
}

void lu_solve(int32_t n, const double *a, const int32_t *pivot, int32_t columns, double *b)
{
    size_t width = (size_t)columns;
    for (int32_t k = 0; k < n; k++) swap_rows(columns, b + (size_t)k * width, b + (size_t)pivot[k] * width);
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = 0; k < i; k++)
            add_scaled(columns, -a[(size_t)i * (size_t)n + (size_t)k], b + (size_t)k * width,
                       b + (size_t)i * width);
    for (int32_t i = n; i-- > 0;) {
        const double *row = a + (size_t)i * (size_t)n;
        double *x = b + (size_t)i * width;
        for (int32_t k = i + 1; k < n; k++) add_scaled(columns, -row[k], b + (size_t)k * width, x);
        for (int32_t c = 0; c < columns; c++) x[c] /= row[i];
    }
}

void add_product(int32_t rows, int32_t inner, int32_t columns, const double *a, size_t stride_a,
                 const double *b, size_t stride_b, double *c, size_t stride_c)
{
    for (int32_t i = 0; i < rows; i++)
        for (int32_t k = 0; k < inner; k++)
            add_scaled(columns, a[(size_t)i * stride_a + (size_t)k], b + (size_t)k * stride_b,
                       c + (size_t)i * stride_c);
}
