// The pieces that flattening a disc is made of. Internal to the stage place.
#ifndef PLACE_RIGID_H
#define PLACE_RIGID_H

#include "place/disc.h"
#include "sparse/sparse.h"

/// The true shape of a face, corner 0 at the origin and corner 1 to its right: with the columns of X the two
/// edges from corner 0 in the plane, X inverse is the derivative of the map from the surface to the plane.
typedef struct face_shape {
    double inverse[3]; // upper triangle of the inverse: (0,0), (0,1), (1,1)
    double area;
} face_shape;

/// The derivative of the map on a face, {dx/du, dx/dv, dy/du, dy/dv}.
static inline void face_derivative(const face_shape *s, const int32_t corner[3], const double (*at)[2],
                                   double j[4])
{
    for (int i = 0; i < 2; i++) {
        double a = at[corner[1]][i] - at[corner[0]][i], b = at[corner[2]][i] - at[corner[0]][i];
        j[2 * i] = a * s->inverse[0];
        j[2 * i + 1] = a * s->inverse[1] + b * s->inverse[2];
    }
}

/// What faces would do to the derivative is added to their corners: the adjoint of the above.
static inline void spread_derivative(const face_shape *s, const int32_t corner[3], const double j[4],
                                     double (*sum)[2])
{
    for (int i = 0; i < 2; i++) {
        double a = j[2 * i] * s->inverse[0] + j[2 * i + 1] * s->inverse[1], b = j[2 * i + 1] * s->inverse[2];
        sum[corner[0]][i] -= a + b;
        sum[corner[1]][i] += a;
        sum[corner[2]][i] += b;
    }
}

/// A disc being flattened. Memory is in an arena but for the factor.
typedef struct flattening {
    disc *d;
    face_shape *shape; // [face_count]
    sparse_factor laplacian;
    double (*scratch)[2]; // [vertex_count]
} flattening;

/// The matrix of a disc with entries where vertices share a side, all zero; in an arena.
jali_status disc_matrix(jali_context *ctx, const disc *d, sparse_matrix *a);
/// Entry (row, column), which must be there.
double *matrix_entry(const sparse_matrix *a, int32_t row, int32_t column);

/// Lay the border on a circle and each vertex inside into the mean of its neighbours: one-to-one for every
/// disc (Tutte; Floater 2003), with lengths far from true.
jali_status lay_on_circle(jali_context *ctx, flattening *w);

/// As rigid as possible: each face wants to be turned only. Fast from a fair guess; may fold faces.
void turn_faces(flattening *w, int rounds);

/// Is every face counter-clockwise?
bool unfolded(const flattening *w);

/// From a map that folds no face to one, still without folds, with the least mean of s^2 + 1/s^2 over both
/// stretches s.
jali_status relax(jali_context *ctx, flattening *w);

#endif
