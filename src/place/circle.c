// A disc laid on a circle: the layout that never folds.
//
// Source:  W. Tutte, How to Draw a Graph, 1963; M. Floater, One-to-one piecewise linear mappings over
//          triangulations, 2003: a border on a convex curve, and inside each vertex a mean of its neighbours
//          with positive weights.
// How:     weights are tangents of half angles at both ends (mean values) of the true shapes.
// Checked: tests/test_flatten.c.
#include "place/rigid.h"

#include <math.h>

// For each border vertex the next one, counter-clockwise; -1 inside. Returns a first one.
static int32_t find_border(const disc *d, const sides *linked, int32_t *next)
{
    int32_t first = -1;
    for (int32_t v = 0; v < d->vertex_count; v++) next[v] = -1;
    for (int32_t s = 0; s < 4 * d->face_count; s++) {
        if ((s & 3) == 3 || linked->beside[s] != NO_SIDE) continue;
        int32_t from = d->corner[s >> 2][((s & 3) + 1) % 3], to = d->corner[s >> 2][((s & 3) + 2) % 3];
        next[from] = to;
        if (first < 0 || from < first) first = from;
    }
    return first;
}

static double length_between(const disc *d, int32_t a, int32_t b)
{
    const double *p = d->mesh->vertex[d->vertex[a]], *q = d->mesh->vertex[d->vertex[b]];
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

// Border vertices at angles by the border's length, on a circle of the disc's area.
static void lay_border(const flattening *w, const int32_t *next, int32_t first)
{
    const disc *d = w->d;
    double around = 0, along = 0, area = 0;
    int32_t v = first;
    for (int32_t f = 0; f < d->face_count; f++) area += w->shape[f].area;
    do {
        around += length_between(d, v, next[v]);
        v = next[v];
    } while (v != first);
    double radius = sqrt(area / acos(-1));
    do {
        double angle = 2 * acos(-1) * along / around;
        d->at[v][0] = radius * cos(angle);
        d->at[v][1] = radius * sin(angle);
        along += length_between(d, v, next[v]);
        v = next[v];
    } while (v != first);
}

// The tangent of half the angle at corner k: from the lengths of the sides, never negative.
static double half_tangent(const double side[3], int k)
{
    double a = side[k], b = side[(k + 1) % 3], c = side[(k + 2) % 3];
    double over = (a - b + c) * (a + b - c), under = (a + b + c) * (-a + b + c);
    return sqrt(MAX(over, 1e-12 * a * a) / MAX(under, 1e-12 * a * a));
}

// Symmetric weights keep the matrix so: the mean of both ends' half tangents over the length.
static void fill_matrix(const disc *d, sparse_matrix *a)
{
    for (int32_t f = 0; f < d->face_count; f++) {
        double side[3];
        const int32_t *c = d->corner[f];
        for (int k = 0; k < 3; k++) side[k] = length_between(d, c[(k + 1) % 3], c[(k + 2) % 3]);
        for (int k = 0; k < 3; k++) {
            int32_t from = c[(k + 1) % 3], to = c[(k + 2) % 3];
            double weight =
                (half_tangent(side, (k + 1) % 3) + half_tangent(side, (k + 2) % 3)) / (2 * side[k]);
            *matrix_entry(a, from, from) += weight;
            *matrix_entry(a, to, to) += weight;
            *matrix_entry(a, from, to) -= weight;
            *matrix_entry(a, to, from) -= weight;
        }
    }
}

// Rows and columns of the border go to the right side, b.
static void hold_border(const disc *d, const int32_t *next, sparse_matrix *a, double (*b)[2])
{
    memset(b, 0, (size_t)d->vertex_count * sizeof *b);
    for (int32_t v = 0; v < d->vertex_count; v++)
        for (int32_t e = a->first[v]; e < a->first[v + 1]; e++) {
            int32_t other = a->column[e];
            if (next[v] < 0 && next[other] < 0) continue;
            if (next[v] < 0)
                for (int k = 0; k < 2; k++) b[v][k] -= a->value[e] * d->at[other][k];
            a->value[e] = v == other;
        }
    for (int32_t v = 0; v < d->vertex_count; v++)
        if (next[v] >= 0) memcpy(b[v], d->at[v], sizeof *b);
}

jali_status lay_on_circle(jali_context *ctx, flattening *w)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    disc *d = w->d;
    sides linked = {0};
    sparse_factor factor = {0};
    sparse_matrix a;
    int32_t *next;
    double(*b)[2];
    TRY(sides_create(ctx, d->vertex_count, d->face_count, (const int32_t(*)[3])d->corner, &linked));
    TRY(ARENA(ctx, next, d->vertex_count + 1));
    TRY(ARENA(ctx, b, d->vertex_count + 1));
    TRY(disc_matrix(ctx, d, &a));
    int32_t first = find_border(d, &linked, next);
    lay_border(w, next, first);
    fill_matrix(d, &a);
    hold_border(d, next, &a, b);
    TRY(sparse_factorise(ctx, &a, w->laplacian.order, &factor));
    sparse_solve(&factor, b, w->scratch);
    memcpy(d->at, b, (size_t)d->vertex_count * sizeof *b);
done:
    sparse_factor_free(ctx, &factor);
    sides_free(ctx, &linked);
    arena_rewind(ctx, mark);
    return status;
}
