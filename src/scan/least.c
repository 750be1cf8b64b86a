// Small least squares by their normal equations, solved by Cholesky's factor.
//
// Limits:  the condition of the unknowns is squared: scale them to about 1 first.
// Checked: tests/test_scan.c.
#include "scan/least.h"

#include <math.h>
#include <string.h>

void add_equation(normal_equations *e, const double *row, double value, double weight)
{
    int32_t n = e->unknowns;
    for (int32_t i = 0; i < n; i++) {
        double scaled = weight * row[i];
        for (int32_t j = 0; j <= i; j++) e->product[i * n + j] += scaled * row[j];
        e->right[i] += scaled * value;
    }
}

void add_equations(normal_equations *e, const normal_equations *more)
{
    for (int32_t i = 0; i < e->unknowns * e->unknowns; i++) e->product[i] += more->product[i];
    for (int32_t i = 0; i < e->unknowns; i++) e->right[i] += more->right[i];
}

bool solve_normal(const normal_equations *e, double *x)
{
    int32_t n = e->unknowns;
    double factor[MOST_UNKNOWNS * MOST_UNKNOWNS];
    memcpy(factor, e->product, sizeof factor);
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j <= i; j++) {
            double sum = factor[i * n + j];
            for (int32_t k = 0; k < j; k++) sum -= factor[i * n + k] * factor[j * n + k];
            if (j < i)
                factor[i * n + j] = sum / factor[j * n + j];
            else if (sum > 1e-13 * e->product[i * n + i])
                factor[i * n + i] = sqrt(sum);
            else
                return false;
        }
    for (int32_t i = 0; i < n; i++) {
        x[i] = e->right[i];
        for (int32_t k = 0; k < i; k++) x[i] -= factor[i * n + k] * x[k];
        x[i] /= factor[i * n + i];
    }
    for (int32_t i = n - 1; i >= 0; i--) {
        for (int32_t k = i + 1; k < n; k++) x[i] -= factor[k * n + i] * x[k];
        x[i] /= factor[i * n + i];
    }
    return true;
}
