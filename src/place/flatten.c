// Flatten the part of a surface that a picture is wrapped on.
//
// How:     a disc of faces grows from the picture's centre until it holds the picture's window, and is
//          flattened with as little change of lengths as can be; where its own border still cuts the window,
//          a larger disc is. Then up becomes up, and the centre the origin.
// Source:  rigid.c, circle.c and relax.c, each with its own.
// Limits:  no cuts but the disc's border: a window around a handle or a hole is not covered. One-to-one on
//          each face; that no two faces overlap is checked exactly where voids are cut.
// Checked: tests/test_flatten.c: planes, cylinders, cones and caps against formulas; rough surfaces by seeds.
#include "place/disc.h"
#include "place/nearest.h"
#include "place/lay.h"
#include "base/vector.h"

#include <math.h>
#include <stdio.h>

static const double SLACK[] = {1.15, 1.5, 2.2}; // sizes of the disc over that of the window
static const double STEEPEST = 0.99;            // up along the normal, beyond: the back is up
static const double MOST_DISTORTION = 3;        // largest over least stretch
static const double OFFER_STEP = 0.85;          // from width to width, to find one that fits
static const double LEAST_OFFER = 0.1;          // of the width
enum { OFFER_HALVINGS = 3 };

typedef struct flat_work {
    const jali_surface *surface;
    const flat_window *window;
    double half_mm[2]; // of the window
    double up[3];
    sides linked;
    disc_seed seed;
    disc d;
    laid *l;
    bool folded, covered; // the disc has no flat layout; its border is out of the window
    double stretch[2];    // least and largest inside the window
    int32_t worst;        // the face where it is further from 1
} flat_work;

static void face_edges(const jali_mesh *m, int32_t face, double a[3], double b[3])
{
    for (int k = 0; k < 3; k++) {
        a[k] = m->vertex[m->triangle[face][1]][k] - m->vertex[m->triangle[face][0]][k];
        b[k] = m->vertex[m->triangle[face][2]][k] - m->vertex[m->triangle[face][0]][k];
    }
}

// --- Where the disc begins

// The mean normal over half the window, so that bumps do not tilt the picture, and the right hand of up
// there.
static void find_frame(flat_work *w)
{
    const jali_mesh *m = &w->surface->mesh;
    double a[3], b[3], own[3], sum[3], reach = MIN(w->half_mm[0], w->half_mm[1]) / 2;
    face_edges(m, w->seed.face, a, b);
    cross(a, b, own);
    memcpy(sum, own, sizeof sum);
    for (int32_t t = 0; t < m->triangle_count; t++) {
        double n[3], away = 0;
        for (int k = 0; k < 3; k++) {
            double e = m->vertex[m->triangle[t][0]][k] - w->seed.at[k];
            away += e * e;
        }
        if (away > reach * reach) continue;
        face_edges(m, t, a, b);
        cross(a, b, n);
        if (dot(n, own) > 0)
            for (int k = 0; k < 3; k++) sum[k] += n[k];
    }
    double length = sqrt(dot(sum, sum)), wide = 0;
    for (int k = 0; k < 3; k++) w->seed.normal[k] = sum[k] / length;
    memcpy(w->up, w->window->up, sizeof w->up);
    if (dot(w->up, w->up) == 0) w->up[2] = 1;
    for (int i = 0; i < 2 && !(wide > 0); i++) {
        if (i == 1) memcpy(w->up, (double[3]){0, 1, 0}, sizeof w->up);
        double along = dot(w->up, w->seed.normal) / sqrt(dot(w->up, w->up));
        cross(w->up, w->seed.normal, w->seed.right);
        wide = fabs(along) > STEEPEST && i == 0 ? 0 : sqrt(dot(w->seed.right, w->seed.right));
    }
    for (int k = 0; k < 3; k++) w->seed.right[k] /= wide;
}

// --- Where the disc lies

// Where a point of the first face lies in the plane becomes the origin.
static void centre_disc(flat_work *w)
{
    disc *d = &w->d;
    double a[3], b[3], n[3], r[3], side[3], share[3], origin[2] = {0, 0};
    face_edges(d->mesh, d->face[0], a, b);
    cross(a, b, n);
    for (int k = 0; k < 3; k++) r[k] = w->seed.at[k] - d->mesh->vertex[d->mesh->triangle[d->face[0]][0]][k];
    cross(r, b, side);
    share[1] = dot(side, n) / dot(n, n);
    cross(a, r, side);
    share[2] = dot(side, n) / dot(n, n);
    share[0] = 1 - share[1] - share[2];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) origin[i] += share[k] * d->at[d->corner[0][k]][i];
    for (int32_t v = 0; v < d->vertex_count; v++)
        for (int i = 0; i < 2; i++) d->at[v][i] -= origin[i];
}

// What is up on the surface, on the mean over the middle of the window, is turned upwards.
static void turn_upright(flat_work *w)
{
    disc *d = &w->d;
    double sum[2] = {0, 0}, reach = MIN(w->half_mm[0], w->half_mm[1]) / 2;
    for (int32_t f = 0; f < d->face_count; f++) {
        const double *p[3] = {d->at[d->corner[f][0]], d->at[d->corner[f][1]], d->at[d->corner[f][2]]};
        double a[3], b[3], x_mean = (p[0][0] + p[1][0] + p[2][0]) / 3,
                           y_mean = (p[0][1] + p[1][1] + p[2][1]) / 3;
        double share = f == 0 ? 1 : 1 - hypot(x_mean, y_mean) / reach; // less further out
        if (share <= 0) continue;
        face_edges(d->mesh, d->face[f], a, b);
        double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), ua = dot(w->up, a), ub = dot(w->up, b);
        double area = sqrt(MAX(aa * bb - ab * ab, 1e-30)); // up = (x a + y b) / area^2, and a normal part
        double x = (ua * bb - ub * ab) / area, y = (ub * aa - ua * ab) / area;
        for (int i = 0; i < 2; i++) sum[i] += share * (x * (p[1][i] - p[0][i]) + y * (p[2][i] - p[0][i]));
    }
    double length = hypot(sum[0], sum[1]);
    if (!(length > 0)) return;
    for (int32_t v = 0; v < d->vertex_count; v++) {
        double x = d->at[v][0], y = d->at[v][1];
        d->at[v][0] = (x * sum[1] - y * sum[0]) / length;
        d->at[v][1] = (x * sum[0] + y * sum[1]) / length;
    }
}

// The scale of the window at which it reaches a box of two or three places.
static double reached(const flat_work *w, const double *const p[], int count)
{
    double scale = 0;
    for (int i = 0; i < 2; i++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < count; k++) {
            low = MIN(low, p[k][i]);
            high = MAX(high, p[k][i]);
        }
        scale = MAX(scale, MAX(low, -high) / w->half_mm[i]);
    }
    return scale;
}

// Does a side of the border come into the window? `which` is 4 for those where more of the surface could have
// been taken, 0 for all.
static bool ends_inside(const flat_work *w, int which)
{
    const disc *d = &w->d;
    for (int32_t f = 0; f < d->face_count; f++)
        for (int k = 0; k < 3; k++) {
            const double *p[2] = {d->at[d->corner[f][(k + 1) % 3]], d->at[d->corner[f][(k + 2) % 3]]};
            if (d->border[f] >> (which + k) & 1 && reached(w, p, 2) < 1) return true;
        }
    return false;
}

// --- How much it is stretched

// The metric of each face with those around it, so that a single sliver does not count: the mean over its
// corners of the means there, by area. In `metric`, [face_count].
static jali_status mean_metrics(jali_context *ctx, const laid *l, const disc *d, double (*metric)[3])
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    double(*sum)[4];
    TRY(ARENA(ctx, sum, d->vertex_count + 1));
    memset(sum, 0, (size_t)d->vertex_count * sizeof *sum);
    for (int32_t f = 0; f < d->face_count; f++) {
        const double(*p)[2] = (const double(*)[2])l->at[d->face[f]];
        double g[3],
            area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        if (!face_metric(l, d->face[f], g)) continue;
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++) sum[d->corner[f][k]][i] += area * g[i];
            sum[d->corner[f][k]][3] += area;
        }
    }
    for (int32_t f = 0; f < d->face_count; f++)
        for (int i = 0; i < 3; i++) {
            metric[f][i] = 0;
            for (int k = 0; k < 3; k++) metric[f][i] += sum[d->corner[f][k]][i] / sum[d->corner[f][k]][3] / 3;
        }
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status measure(jali_context *ctx, flat_work *w)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const disc *d = &w->d;
    double(*metric)[3];
    int32_t face[2] = {0, 0};
    w->stretch[0] = INFINITY;
    w->stretch[1] = 0;
    TRY(ARENA(ctx, metric, d->face_count + 1));
    TRY(mean_metrics(ctx, w->l, d, metric));
    for (int32_t f = 0; f < d->face_count; f++) {
        const double *p[3] = {d->at[d->corner[f][0]], d->at[d->corner[f][1]], d->at[d->corner[f][2]]};
        if (f > 0 && reached(w, p, 3) >= 1) continue;
        double mean = (metric[f][0] + metric[f][2]) / 2;
        double apart = hypot((metric[f][0] - metric[f][2]) / 2, metric[f][1]);
        double here[2] = {sqrt(MAX(mean - apart, 0)), sqrt(mean + apart)};
        if (here[0] < w->stretch[0]) face[0] = f;
        if (here[1] > w->stretch[1]) face[1] = f;
        w->stretch[0] = MIN(w->stretch[0], here[0]);
        w->stretch[1] = MAX(w->stretch[1], here[1]);
    }
    w->worst = d->face[face[w->stretch[0] * w->stretch[1] > 1]];
done:
    arena_rewind(ctx, mark);
    return status;
}

static bool too_stretched(const flat_work *w)
{
    return w->stretch[1] > MOST_DISTORTION * w->stretch[0];
}

// --- Steps

static void publish(const flat_work *w)
{
    for (int32_t t = 0; t < w->surface->mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++) w->l->at[t][k][0] = w->l->at[t][k][1] = NAN;
    for (int32_t f = 0; f < w->d.face_count; f++)
        for (int k = 0; k < 3; k++)
            memcpy(w->l->at[w->d.face[f]][k], w->d.at[w->d.corner[f][k]], sizeof *w->d.at);
}

// Flatten for a picture of a share of the size: with as large a disc as it takes.
static jali_status try_scale(jali_context *ctx, flat_work *w, double scale)
{
    jali_status status = JALI_OK;
    arena_mark mark = arena_here(ctx);
    for (int k = 0; k < 2; k++) w->half_mm[k] = scale * w->window->size_mm[k] / 2 + w->window->ring_mm[k];
    find_frame(w);
    for (size_t i = 0; i < sizeof SLACK / sizeof *SLACK; i++) {
        double half[2] = {SLACK[i] * w->half_mm[0], SLACK[i] * w->half_mm[1]};
        arena_rewind(ctx, mark);
        TRY(grow_disc(ctx, &w->surface->mesh, &w->linked, &w->seed, half, &w->d));
        TRY(flatten_disc(ctx, &w->d, &w->folded));
        if (w->folded) break;
        centre_disc(w);
        turn_upright(w);
        publish(w);
        TRY(measure(ctx, w));
        w->covered = !ends_inside(w, 0);
        if (too_stretched(w) || !ends_inside(w, 4)) break;
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static bool fits(const flat_work *w)
{
    return !w->folded && w->covered && !too_stretched(w);
}

// The largest share of the picture that fits, nearly; 0: none does.
static jali_status largest_fit(jali_context *ctx, flat_work *w, double *scale)
{
    jali_status status;
    double good = 1, bad = 1;
    *scale = 0;
    do {
        bad = good;
        good *= OFFER_STEP;
        if (good < LEAST_OFFER) return JALI_OK;
        TRY(try_scale(ctx, w, good));
    } while (!fits(w));
    for (int i = 0; i < OFFER_HALVINGS; i++) {
        double middle = (good + bad) / 2;
        TRY(try_scale(ctx, w, middle));
        *(fits(w) ? &good : &bad) = middle;
    }
    *scale = good;
done:
    return status;
}

static jali_status refuse(jali_context *ctx, flat_work *w)
{
    jali_status status;
    char fault[200], offer[128] = "another place (--at) is needed";
    double scale;
    const double *at = w->surface->mesh.vertex[w->surface->mesh.triangle[w->worst][0]];
    if (w->folded)
        snprintf(fault, sizeof fault, "the %d triangles around the picture do not lie flat without folds",
                 w->d.face_count);
    else if (too_stretched(w))
        snprintf(fault, sizeof fault,
                 "laid flat, the surface is stretched %.2f to %.2f times, worst at (%.4g, %.4g, %.4g) mm; at "
                 "most %g to one is accepted",
                 w->stretch[0], w->stretch[1], at[0], at[1], at[2], MOST_DISTORTION);
    else
        snprintf(fault, sizeof fault,
                 "laid flat, the surface ends within the picture's window of %.4g x %.4g mm",
                 2 * w->half_mm[0], 2 * w->half_mm[1]);
    TRY(largest_fit(ctx, w, &scale));
    if (scale > 0)
        snprintf(offer, sizeof offer, "a width of %.4g mm fits at (%.4g, %.4g, %.4g) mm",
                 floor(scale * w->window->size_mm[0] * 100) / 100, w->seed.at[0], w->seed.at[1],
                 w->seed.at[2]);
    status = fail(ctx, JALI_NO_RESULT, "%s; %s", fault, offer);
done:
    return status;
}

jali_status lay_by_flattening(jali_context *ctx, const jali_surface *surface, const flat_window *window,
                              laid *l)
{
    jali_status status;
    const jali_mesh *mesh = &surface->mesh;
    flat_work w = {.surface = surface, .window = window, .l = l};
    TRY(laid_create(ctx, surface, l));
    TRY(sides_create(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                     &w.linked));
    w.seed.face = nearest_face(w.surface, w.window->at_mm, w.seed.at);
    TRY(try_scale(ctx, &w, 1));
    if (!fits(&w)) TRY(refuse(ctx, &w));
done:
    sides_free(ctx, &w.linked);
    if (status != JALI_OK) laid_free(ctx, l);
    return status;
}
