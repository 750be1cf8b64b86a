// Small least squares by their normal equations. Internal.
#ifndef SCAN_LEAST_H
#define SCAN_LEAST_H

#include <stdbool.h>
#include <stdint.h>

enum { MOST_UNKNOWNS = 10 };

/// Sums over equations row . x = value; {.unknowns = n} is empty.
typedef struct normal_equations {
    int32_t unknowns;                              // 1 .. MOST_UNKNOWNS
    double product[MOST_UNKNOWNS * MOST_UNKNOWNS]; // row row^T, lower triangle, [i * unknowns + j]
    double right[MOST_UNKNOWNS];
} normal_equations;

void add_equation(normal_equations *e, const double *row, double value, double weight);
void add_equations(normal_equations *e, const normal_equations *more);
/// False when they do not tell all unknowns apart.
bool solve_normal(const normal_equations *e, double *x);

#endif
