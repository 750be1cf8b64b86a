// Points, directions and colours of the renderer.
#ifndef RENDER_VEC_H
#define RENDER_VEC_H

#include <math.h>

typedef struct vec {
    double x, y, z;
} vec;

static inline vec add(vec a, vec b)
{
    return (vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec subtract(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec scaled(vec a, double s)
{
    return (vec){a.x * s, a.y * s, a.z * s};
}

static inline vec times(vec a, vec b)
{
    return (vec){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline vec along(vec from, vec direction, double t)
{
    return add(from, scaled(direction, t));
}

static inline vec mixed(vec a, vec b, double share_of_b)
{
    return add(scaled(a, 1 - share_of_b), scaled(b, share_of_b));
}

static inline double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double length(vec a)
{
    return sqrt(dot(a, a));
}

static inline vec unit(vec a)
{
    double l = length(a);
    return l > 0 ? scaled(a, 1 / l) : a;
}

#endif
