// Relax a flat layout: the least mean of s^2 + 1/s^2 over both stretches s of every face, which grows without
// bound towards a fold, so that none can come.
//
// Source:  J. Smith, S. Schaefer, Bijective Parameterization with Free Boundaries, 2015 (the energy, and the
//          longest step before a face folds); Y. Zhu, R. Bridson, D. Kaufman, Blended Cured Quasi-Newton for
//          Distortion Optimization, 2018 (the Laplacian as the first guess of L-BFGS).
// Limits:  the border may meet itself: the caller checks places, exactly.
// Checked: tests/test_flatten.c.
#include "place/rigid.h"

#include <math.h>

enum { MEMORY = 6, MOST_ROUNDS = 200, MOST_HALVINGS = 30 };
static const double FIRST_SCALE = 0.25; // the energy is about four times as stiff as the Laplacian
static const double ENOUGH = 1e-6;      // of the energy above that of a true map, in a round: the end
static const double NEXT_TO_FOLD = 0.8; // of the way to the first fold
static const double ARMIJO = 1e-4;

typedef struct relaxing {
    flattening *w;
    int32_t count;                    // numbers: two a vertex
    double *at, *slope, *way, *trial; // [count]
    double *moved[MEMORY], *turned[MEMORY], along[MEMORY];
    int32_t kept, newest;
} relaxing;

static double product(const double *a, const double *b, int32_t count)
{
    double sum = 0;
    for (int32_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

// The energy above that of a map without any stretch, and its slope.
static double energy(const flattening *w, const double *at, double *slope)
{
    double sum = 0;
    if (slope) memset(slope, 0, 2 * (size_t)w->d->vertex_count * sizeof *slope);
    for (int32_t f = 0; f < w->d->face_count; f++) {
        double j[4], pull[4];
        face_derivative(&w->shape[f], w->d->corner[f], (const double(*)[2])at, j);
        double det = j[0] * j[3] - j[1] * j[2];
        double squares = j[0] * j[0] + j[1] * j[1] + j[2] * j[2] + j[3] * j[3];
        if (!(det > 0)) return INFINITY;
        double one = 1 / (det * det), area = w->shape[f].area;
        sum += area * (squares * (1 + one) - 4);
        if (!slope) continue;
        double own = 2 * area * (1 + one), cofactor = -2 * area * squares * one / det;
        pull[0] = own * j[0] + cofactor * j[3];
        pull[1] = own * j[1] - cofactor * j[2];
        pull[2] = own * j[2] - cofactor * j[1];
        pull[3] = own * j[3] + cofactor * j[0];
        spread_derivative(&w->shape[f], w->d->corner[f], pull, (double(*)[2])slope);
    }
    return sum;
}

// How far along the way the first face loses its area: the least positive root of its determinant.
static double way_to_fold(const flattening *w, const double *at, const double *way)
{
    double least = INFINITY;
    for (int32_t f = 0; f < w->d->face_count; f++) {
        double j[4], d[4];
        face_derivative(&w->shape[f], w->d->corner[f], (const double(*)[2])at, j);
        face_derivative(&w->shape[f], w->d->corner[f], (const double(*)[2])way, d);
        double a = d[0] * d[3] - d[1] * d[2], c = j[0] * j[3] - j[1] * j[2];
        double b = j[0] * d[3] + d[0] * j[3] - j[1] * d[2] - d[1] * j[2], under = b * b - 4 * a * c;
        if (under < 0 || (a >= 0 && b >= 0)) continue;
        double root = 2 * c / (sqrt(under) - b); // the smaller positive one, of either sign of a
        if (root > 0) least = MIN(least, root);
    }
    return least;
}

// Down the slope as the last rounds say it bends (the two loops of L-BFGS), into way.
static void choose_way(relaxing *r)
{
    double share[MEMORY];
    for (int32_t i = 0; i < r->count; i++) r->way[i] = -r->slope[i];
    for (int32_t i = 0; i < r->kept; i++) {
        int32_t m = (r->newest - i + MEMORY) % MEMORY;
        share[m] = product(r->moved[m], r->way, r->count) / r->along[m];
        for (int32_t n = 0; n < r->count; n++) r->way[n] -= share[m] * r->turned[m][n];
    }
    sparse_solve(&r->w->laplacian, (double(*)[2])r->way, r->w->scratch);
    for (int32_t n = 0; n < r->count; n++) r->way[n] *= FIRST_SCALE;
    for (int32_t i = r->kept; i-- > 0;) {
        int32_t m = (r->newest - i + MEMORY) % MEMORY;
        double back = share[m] - product(r->turned[m], r->way, r->count) / r->along[m];
        for (int32_t n = 0; n < r->count; n++) r->way[n] += back * r->moved[m][n];
    }
}

// Go as far as the energy falls; false when it does not.
static bool go(relaxing *r, double *now)
{
    double fall = product(r->slope, r->way, r->count);
    if (!(fall < 0)) return false;
    double far = MIN(1, NEXT_TO_FOLD * way_to_fold(r->w, r->at, r->way));
    for (int i = 0; i < MOST_HALVINGS; i++, far /= 2) {
        for (int32_t n = 0; n < r->count; n++) r->trial[n] = r->at[n] + far * r->way[n];
        double here = energy(r->w, r->trial, NULL);
        if (!(here <= *now + ARMIJO * far * fall)) continue;
        *now = here;
        return true;
    }
    return false;
}

// Remember the step and what it did to the slope, when that curves as a valley does.
static void keep(relaxing *r)
{
    int32_t m = (r->newest + 1) % MEMORY;
    for (int32_t n = 0; n < r->count; n++) {
        r->moved[m][n] = r->trial[n] - r->at[n];
        r->turned[m][n] = -r->slope[n];
        r->at[n] = r->trial[n];
    }
    energy(r->w, r->at, r->slope);
    for (int32_t n = 0; n < r->count; n++) r->turned[m][n] += r->slope[n];
    r->along[m] = product(r->moved[m], r->turned[m], r->count);
    if (!(r->along[m] > 0)) return;
    r->newest = m;
    r->kept = MIN(r->kept + 1, MEMORY);
}

jali_status relax(jali_context *ctx, flattening *w)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    relaxing r = {.w = w, .count = 2 * w->d->vertex_count, .at = &w->d->at[0][0]};
    TRY(ARENA(ctx, r.slope, r.count));
    TRY(ARENA(ctx, r.way, r.count));
    TRY(ARENA(ctx, r.trial, r.count));
    for (int m = 0; m < MEMORY; m++) {
        TRY(ARENA(ctx, r.moved[m], r.count));
        TRY(ARENA(ctx, r.turned[m], r.count));
    }
    double now = energy(w, r.at, r.slope), area = 0;
    for (int32_t f = 0; f < w->d->face_count; f++) area += w->shape[f].area;
    int quiet = 0; // one short round may be chance
    for (int round = 0; round < MOST_ROUNDS && quiet < 2; round++) {
        double before = now;
        TRY(step(ctx, "flatten", (double)round / MOST_ROUNDS));
        choose_way(&r);
        if (!go(&r, &now)) {
            if (r.kept == 0) break;
            r.kept = 0; // what was remembered misleads
            continue;
        }
        keep(&r);
        quiet = before - now < ENOUGH * (now + 1e-3 * area) ? quiet + 1 : 0;
    }

done:
    arena_rewind(ctx, mark);
    return status;
}
