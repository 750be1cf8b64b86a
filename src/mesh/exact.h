// Exact geometry on vertices: whole numbers of one common unit, and the sign of every determinant.
//
// A double is a whole number times a power of two, so the vertices of a mesh share a unit 2^k in which all
// are whole. Plates of ours need 24 bits, most float32 models fewer than 60. A mesh that spans more is
// rounded to 60 bits of its largest coordinate (2^-59 of it: 2e-15 mm at 1 m), and says so; from there on
// nothing is rounded again.
//
// Narrow: differences fit 32 bits, so a normal fits 64 and a dot product 128.
// Wide:   differences fit 62 bits, so a normal fits 128 and a dot product 192.
// Checked: tests/test_check.c: signs against rational arithmetic, both widths against each other.
#ifndef MESH_EXACT_H
#define MESH_EXACT_H

#include "mesh/mesh.h"

typedef struct lattice {
    int32_t point_count;
    int64_t (*point)[3]; // [point_count], units, |coordinate| <= 2^60
    int32_t unit_log2;   // the unit is 2^unit_log2 mm
    bool narrow;         // every difference of two coordinates of one axis is below 2^31
    bool exact;          // no coordinate was rounded
} lattice;

typedef __int128 int128;

/// Put finite points on their common lattice.
jali_status lattice_create(jali_context *ctx, int32_t count, const double (*point)[3], lattice *l);
void lattice_free(jali_context *ctx, lattice *l);

typedef struct normal {
    int128 along[3];
} normal;

static inline int sign_of(int128 value)
{
    return (value > 0) - (value < 0);
}

/// (b - a) x (c - a), exact.
static inline normal normal_of(bool narrow, const int64_t a[3], const int64_t b[3], const int64_t c[3])
{
    int64_t u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    normal n;
    if (narrow)
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            n.along[k] = u[i] * v[j] - u[j] * v[i];
        }
    else
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            n.along[k] = (int128)u[i] * v[j] - (int128)u[j] * v[i];
        }
    return n;
}

/// The sign of n . (p - a): on which side of the plane through a with normal n lies p?
static inline int side_of(bool narrow, const normal *n, const int64_t a[3], const int64_t p[3])
{
    int128 low = 0;
    if (narrow) {
        for (int k = 0; k < 3; k++) low += (int128)(int64_t)n->along[k] * (p[k] - a[k]);
        return sign_of(low);
    }
    // A 192-bit sum in two parts: low takes the lower 64 bits of each n_k, high the rest.
    int128 high = 0;
    for (int k = 0; k < 3; k++) {
        int64_t d = p[k] - a[k];
        low += (int128)(uint64_t)n->along[k] * d;
        high += (n->along[k] >> 64) * d;
    }
    high += low >> 64;
    return high ? sign_of(high) : (uint64_t)low != 0;
}

/// The sign of the volume of (a, b, c, p): positive when a, b, c turn counter-clockwise seen from p.
static inline int turn_in_space(bool narrow, const int64_t a[3], const int64_t b[3], const int64_t c[3],
                                const int64_t p[3])
{
    normal n = normal_of(narrow, a, b, c);
    return side_of(narrow, &n, a, p);
}

/// The sign of the turn a, b, c in the plane of the axes after `dropped`.
static inline int turn_in_plane(bool narrow, int dropped, const int64_t a[3], const int64_t b[3],
                                const int64_t c[3])
{
    int i = (dropped + 1) % 3, j = (dropped + 2) % 3;
    int64_t ux = b[i] - a[i], uy = b[j] - a[j], vx = c[i] - a[i], vy = c[j] - a[j];
    if (narrow) {
        int64_t cross = ux * vy - uy * vx;
        return (cross > 0) - (cross < 0);
    }
    return sign_of((int128)ux * vy - (int128)uy * vx);
}

/// An axis along which a triangle does not vanish when dropped; -1 when its points lie on one line.
static inline int axis_of(const normal *n)
{
    for (int k = 2; k >= 0; k--)
        if (n->along[k] != 0) return k;
    return -1;
}

#endif
