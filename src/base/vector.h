// Vectors of three doubles, as arrays.
#ifndef BASE_VECTOR_H
#define BASE_VECTOR_H

#include <math.h>

static inline double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// d = a - b
static inline void subtract(const double a[3], const double b[3], double d[3])
{
    for (int k = 0; k < 3; k++) d[k] = a[k] - b[k];
}

static inline void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double distance(const double a[3], const double b[3])
{
    double d[3];
    subtract(a, b, d);
    return sqrt(dot(d, d));
}

/// Normal of a triangle, counter-clockwise towards the eye, as long as its area.
static inline void area_vector(const double a[3], const double b[3], const double c[3], double n[3])
{
    double u[3], v[3];
    subtract(b, a, u);
    subtract(c, a, v);
    cross(u, v, n);
    for (int k = 0; k < 3; k++) n[k] /= 2;
}

#endif
