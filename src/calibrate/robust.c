// Source:  F. R. Hampel, The breakdown points of the mean combined with some rejection rules, 1985; the
// median
//          absolute deviation times 1.4826 is the standard deviation of a normal distribution.
// Checked: tests/test_calibrate.c: an outlier among ten changes nothing, however far off.
#include "calibrate/robust.h"

#include <math.h>
#include <stdlib.h>

static const double NORMAL = 1.4826, REJECT = 3;

static int by_value(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return *p < *q ? -1 : *p > *q;
}

static int by_slope(const void *a, const void *b)
{
    const double *p = a, *q = b; // y / x, x > 0
    double left = p[1] * q[0], right = q[1] * p[0];
    return left < right ? -1 : left > right;
}

double median(double *value, int32_t count)
{
    qsort(value, (size_t)count, sizeof *value, by_value);
    return (value[(count - 1) / 2] + value[count / 2]) / 2;
}

// How far off the others is too far, from their distances.
static double bound_of(double *distance, int32_t count, double least)
{
    return REJECT * fmax(NORMAL * median(distance, count), least);
}

static double spread_of(double sum_of_squares, int32_t count)
{
    return count > 1 ? sqrt(sum_of_squares / (count - 1)) : 0;
}

int32_t robust_mean(double *value, int32_t count, double least, double *scratch, double *mean, double *spread)
{
    double centre = median(value, count), sum = 0, squares = 0;
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) scratch[i] = fabs(value[i] - centre);
    double bound = bound_of(scratch, count, least);
    for (int32_t i = 0; i < count; i++) {
        if (fabs(value[i] - centre) > bound) continue;
        double keep = value[i];
        value[i] = value[kept];
        value[kept++] = keep;
        sum += keep;
    }
    *mean = sum / kept;
    for (int32_t i = 0; i < kept; i++) squares += (value[i] - *mean) * (value[i] - *mean);
    *spread = spread_of(squares, kept);
    return kept;
}

static double weighted_median_slope(double (*point)[2], int32_t count)
{
    double all = 0, below = 0;
    int32_t middle = 0;
    qsort(point, (size_t)count, sizeof *point, by_slope);
    for (int32_t i = 0; i < count; i++) all += point[i][0];
    for (; middle < count - 1; middle++)
        if ((below += point[middle][0]) >= all / 2) break;
    return point[middle][1] / point[middle][0];
}

int32_t robust_slope(double (*point)[2], int32_t count, double least, double *scratch, double *slope,
                     double *spread)
{
    double first = weighted_median_slope(point, count), products = 0, squares = 0, rest = 0;
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) scratch[i] = fabs(point[i][1] - first * point[i][0]);
    double bound = bound_of(scratch, count, least);
    for (int32_t i = 0; i < count; i++) {
        double x = point[i][0], y = point[i][1];
        if (fabs(y - first * x) > bound) continue;
        memcpy(point[i], point[kept], sizeof *point);
        point[kept][0] = x;
        point[kept++][1] = y;
        products += x * y;
        squares += x * x;
    }
    *slope = products / squares;
    for (int32_t i = 0; i < kept; i++) {
        double residual = point[i][1] - *slope * point[i][0];
        rest += residual * residual;
    }
    *spread = spread_of(rest, kept);
    return kept;
}
