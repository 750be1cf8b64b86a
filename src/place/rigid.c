// Flatten a disc: a first layout, turned faces, then a minimum that no fold can reach.
//
// Source:  L. Liu et al., A Local/Global Approach to Mesh Parameterization, 2008 (turn_faces);
//          W. Tutte, How to Draw a Graph, 1963, and M. Floater, One-to-one piecewise linear mappings over
//          triangulations, 2003 (in circle.c); relax.c has its own.
// How:     the Laplacian of the surface is factored once and serves all rounds. Should turned faces fold, all
//          begins again from the circle, which never folds, and relaxing alone does the work.
// Checked: tests/test_flatten.c.
#include "place/rigid.h"

#include <math.h>
#include <stdlib.h>

enum { TURNING_ROUNDS = 8, TURNING_ROUNDS_CIRCLE = 40 };
static const double FLATTEST = 1e-5; // height over longest edge that a face is given at least

static face_shape shape_of(const jali_mesh *m, int32_t face)
{
    const int32_t *corner = m->triangle[face];
    double a[3], b[3], aa = 0, ab = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        a[k] = m->vertex[corner[1]][k] - m->vertex[corner[0]][k];
        b[k] = m->vertex[corner[2]][k] - m->vertex[corner[0]][k];
        aa += a[k] * a[k];
        ab += a[k] * b[k];
        bb += b[k] * b[k];
    }
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double base = sqrt(aa), foot = ab / base, height = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / base;
    height = MAX(height, FLATTEST * sqrt(MAX(aa, bb)));
    return (face_shape){{1 / base, -foot / (base * height), 1 / height}, base * height / 2};
}

// --- The matrix

static int compare_columns(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

jali_status disc_matrix(jali_context *ctx, const disc *d, sparse_matrix *a)
{
    jali_status status;
    size_t most = (size_t)d->vertex_count + 6 * (size_t)d->face_count;
    int32_t *last; // where the next entry of a row goes
    *a = (sparse_matrix){.size = d->vertex_count};
    if (most > INT32_MAX) return fail(ctx, JALI_LIMIT, "%d faces are too many to flatten", d->face_count);
    TRY(ARENA(ctx, a->first, d->vertex_count + 2));
    TRY(ARENA(ctx, a->column, most + 1));
    TRY(ARENA(ctx, a->value, most + 1));
    TRY(ARENA(ctx, last, d->vertex_count + 1));
    for (int32_t v = 0; v < d->vertex_count; v++) last[v] = 1; // the diagonal
    for (int32_t f = 0; f < d->face_count; f++)
        for (int k = 0; k < 3; k++) last[d->corner[f][k]] += 2;
    a->first[0] = 0;
    for (int32_t v = 0; v < d->vertex_count; v++) {
        a->first[v + 1] = a->first[v] + last[v];
        last[v] = a->first[v];
        a->column[last[v]++] = v;
    }
    for (int32_t f = 0; f < d->face_count; f++)
        for (int k = 0; k < 3; k++)
            for (int i = 1; i < 3; i++) a->column[last[d->corner[f][k]]++] = d->corner[f][(k + i) % 3];
    int32_t kept = 0; // an inner side came from both of its faces
    for (int32_t v = 0; v < d->vertex_count; v++) {
        int32_t from = a->first[v], end = last[v];
        a->first[v] = kept;
        qsort(a->column + from, (size_t)(end - from), sizeof *a->column, compare_columns);
        for (int32_t e = from; e < end; e++)
            if (e == from || a->column[e] != a->column[e - 1]) a->column[kept++] = a->column[e];
    }
    a->first[d->vertex_count] = kept;
    memset(a->value, 0, (size_t)kept * sizeof *a->value);
done:
    return status;
}

double *matrix_entry(const sparse_matrix *a, int32_t row, int32_t column)
{
    int32_t low = a->first[row], high = a->first[row + 1] - 1;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (a->column[middle] < column)
            low = middle + 1;
        else
            high = middle;
    }
    return &a->value[low];
}

// The Laplacian (that of cotangents), its constants held by the first vertex.
static jali_status factor_laplacian(jali_context *ctx, flattening *w)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const disc *d = w->d;
    sparse_matrix a;
    int32_t *order;
    TRY(disc_matrix(ctx, d, &a));
    TRY(ARENA(ctx, order, d->vertex_count + 1));
    for (int32_t f = 0; f < d->face_count; f++) {
        const double *b = w->shape[f].inverse;
        double slope[3][2] = {{-b[0], -b[1] - b[2]}, {b[0], b[1]}, {0, b[2]}}; // of the corners' hats
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                *matrix_entry(&a, d->corner[f][i], d->corner[f][k]) +=
                    w->shape[f].area * (slope[i][0] * slope[k][0] + slope[i][1] * slope[k][1]);
    }
    *matrix_entry(&a, 0, 0) *= 2;
    TRY(sparse_order(ctx, &a, (const double(*)[2])d->at, order));
    TRY(sparse_factorise(ctx, &a, order, &w->laplacian));
done:
    arena_rewind(ctx, mark);
    return status;
}

// --- Turned faces

void turn_faces(flattening *w, int rounds)
{
    disc *d = w->d;
    for (int round = 0; round < rounds; round++) {
        double(*sum)[2] = w->scratch;
        memset(sum, 0, (size_t)d->vertex_count * sizeof *sum);
        for (int32_t f = 0; f < d->face_count; f++) {
            double j[4];
            face_derivative(&w->shape[f], d->corner[f], (const double(*)[2])d->at, j);
            double c = j[0] + j[3], s = j[2] - j[1], length = hypot(c, s); // the nearest rotation
            double share = length > 0 ? w->shape[f].area / length : 0;
            double turned[4] = {share * c, -share * s, share * s, share * c};
            spread_derivative(&w->shape[f], d->corner[f], turned, sum);
        }
        sparse_solve(&w->laplacian, sum, d->at);
        memcpy(d->at, sum, (size_t)d->vertex_count * sizeof *sum);
    }
}

bool unfolded(const flattening *w)
{
    for (int32_t f = 0; f < w->d->face_count; f++) {
        double j[4];
        face_derivative(&w->shape[f], w->d->corner[f], (const double(*)[2])w->d->at, j);
        if (!(j[0] * j[3] - j[1] * j[2] > 0)) return false;
    }
    return true;
}

jali_status flatten_disc(jali_context *ctx, disc *d, bool *folded)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    flattening w = {.d = d};
    TRY(ARENA(ctx, w.shape, d->face_count + 1));
    TRY(ARENA(ctx, w.scratch, d->vertex_count + 1));
    for (int32_t f = 0; f < d->face_count; f++) w.shape[f] = shape_of(d->mesh, d->face[f]);
    TRY(factor_laplacian(ctx, &w));
    turn_faces(&w, TURNING_ROUNDS);
    if (!unfolded(&w)) {
        TRY(lay_on_circle(ctx, &w));
        turn_faces(&w, TURNING_ROUNDS_CIRCLE);
        if (!unfolded(&w)) TRY(lay_on_circle(ctx, &w));
    }
    *folded = !unfolded(&w);
    if (!*folded) TRY(relax(ctx, &w));
done:
    sparse_factor_free(ctx, &w.laplacian);
    arena_rewind(ctx, mark);
    return status;
}
