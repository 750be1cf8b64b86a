// Stresses at the nodes of a sheet: patches of triangles, fitted and read at the node.
//
// Source:  O. C. Zienkiewicz, J. Z. Zhu, The superconvergent patch recovery and a posteriori error estimates,
//          Int. J. Numer. Meth. Engng 33 (1992) 1331-1364.
// How:     The resultants of a facet are best at its centroid. Around each node those of the two rings of
//          triangles next to it, turned into the node's tangent plane, are fitted (weighted least squares)
//          and read where the node is: by a paraboloid, as two rings are a whole strip that is four triangles
//          wide, and a plane levels what peaks inside it (stresses of a woven pattern 9 % too low against
//          solids; so 5 %); by a plane where there are few triangles. Around a hole with 16 triangles a
//          quarter it gives 0.97 of Kirsch's 3.0 where the mean of the corners gives 0.89, with 32 it
//          gives 1.00 and 0.94. A patch ends at creases and steps of thickness (fans.c); a node there has a
//          value on each side, and reports the worst.
// Limits:  at re-entrant corners the stress has no limit, so that `worst` grows with refinement; `mean` does
//          not. Principal stresses are given on the faces, not in the middle.
// Checked: tests/test_recover.c, tests/test_published.c.
#include "structure/recover.h"
#include "structure/average.h"
#include "base/vector.h"

#include <math.h>

enum { BLOCK = 512, MOST_IN_PATCH = 96, FIELDS = 8, TERMS = 6, ENOUGH_TO_CURVE = 12 };
static const double FLATTEN =
    1e-3; // of a patch's spread: holds the slopes of patches of one or two triangles
// The curvature of a fit is held back where it would be extrapolated, with the square of how far outside of
// its own triangles the node lies, 0 inside to 0.4 at a straight contour. 1.5 gives Kirsch's 3.0; 0
// gives 3.07.
static const double STIFFEN = 1.5;
static const double NEAR = 2; // weight 1 / (NEAR + squared distance in sides): nearer triangles tell more

typedef struct triangle_state {
    double frame[3][3], centroid[3], area;
    double value[FIELDS]; // n, m, q at the centroid
    double worst;         // of the layers' von Mises there
} triangle_state;

typedef struct recovering {
    const jali_sheet *sheet;
    const facet_material *made_of;
    const double (*u)[6];
    triangle_state *state; // [triangle_count]
    double (*normal)[3];   // [triangle_count]
    double *thickness;     // [triangle_count]
    fans fans;
    double *worst; // [fan_count]
    double *peak;  // [node_count] the worst of a node's triangles
    uint8_t *loud; // [node_count] a patch is fitted: its triangles, or one that touches these, are not quiet
    double radius_mm;
    stresses *out;
} recovering;

void stresses_free(jali_context *ctx, stresses *s)
{
    release(ctx, s->von_mises);
    release(ctx, s->principal);
    release(ctx, s->worst);
    release(ctx, s->mean);
    *s = (stresses){.worst_at = -1, .mean_at = -1};
}

static void read_layers(const double v[FIELDS], double t, double layer[LAYERS], double principal[2][2])
{
    for (int l = 0; l < LAYERS; l++) {
        double bend = l == OUTER_FACE ? 6 / (t * t) : l == INNER_FACE ? -6 / (t * t) : 0, square = 0;
        double x = v[0] / t + bend * v[3], y = v[1] / t + bend * v[4], xy = v[2] / t + bend * v[5];
        if (l == MIDDLE) square = 2.25 * (v[6] * v[6] + v[7] * v[7]) / (t * t);
        layer[l] = sqrt(x * x + y * y - x * y + 3 * (xy * xy + square));
        if (l == MIDDLE) continue;
        double half = sqrt(0.25 * (x - y) * (x - y) + xy * xy);
        principal[l == INNER_FACE][0] = 0.5 * (x + y) + half;
        principal[l == INNER_FACE][1] = 0.5 * (x + y) - half;
    }
}

static double worst_of(const double layer[LAYERS])
{
    return MAX(MAX(layer[OUTER_FACE], layer[INNER_FACE]), layer[MIDDLE]);
}

static void evaluate_block(void *shared, int32_t block)
{
    recovering *r = shared;
    const jali_sheet *sheet = r->sheet;
    for (int32_t t = block * BLOCK; t < MIN((block + 1) * BLOCK, sheet->triangle_count); t++) {
        triangle_state *s = &r->state[t];
        double at[3][3], u[18];
        resultants centre;
        facet_material made_of = *r->made_of;
        made_of.thickness_mm = 0;
        for (int i = 0; i < 3; i++) {
            int32_t n = sheet->triangle[t][i];
            memcpy(at[i], sheet->node[n], sizeof at[i]);
            memcpy(u + 6 * i, r->u[n], 6 * sizeof *u);
            made_of.thickness_mm += sheet->thickness_mm[n] / 3;
        }
        facet_frame((const double(*)[3])at, s->frame);
        facet_centre((const double(*)[3])at, (const double(*)[3])s->frame, &made_of, u, &centre);
        memcpy(r->normal[t], s->frame[2], sizeof r->normal[t]);
        r->thickness[t] = made_of.thickness_mm;
        s->area = 0;
        for (int k = 0; k < 3; k++) {
            s->centroid[k] = (at[0][k] + at[1][k] + at[2][k]) / 3;
            s->value[k] = centre.n[k];
            s->value[3 + k] = centre.m[k];
        }
        memcpy(s->value + 6, centre.q, sizeof centre.q);
        double wide = 0, high = 0;
        for (int k = 0; k < 3; k++) {
            wide += s->frame[0][k] * (at[1][k] - at[0][k]);
            high += s->frame[1][k] * (at[2][k] - at[0][k]);
        }
        s->area = 0.5 * wide * high;
        double layer[LAYERS], principal[2][2];
        read_layers(s->value, made_of.thickness_mm, layer, principal);
        s->worst = worst_of(layer);
    }
}

// Patches are fitted where a triangle nearby has that share of the worst: `loud`.
static void find_loud(recovering *r, double share, uint8_t *touched)
{
    const jali_sheet *sheet = r->sheet;
    double worst = 0;
    for (int32_t t = 0; t < sheet->triangle_count; t++) worst = MAX(worst, r->state[t].worst);
    memset(r->peak, 0, (size_t)sheet->node_count * sizeof *r->peak);
    memset(touched, 0, (size_t)sheet->node_count);
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            int32_t n = sheet->triangle[t][k];
            r->peak[n] = MAX(r->peak[n], r->state[t].worst);
            touched[n] |= r->state[t].worst >= share * worst;
        }
    mark_around(sheet, touched, r->loud);
}

static bool is_among(int32_t count, const int32_t *list, int32_t wanted)
{
    for (int32_t i = 0; i < count; i++)
        if (list[i] == wanted) return true;
    return false;
}

// The fan's triangles, then those that smooth sides join to them and that touch one of their nodes.
static int32_t gather_patch(const recovering *r, int32_t node, int32_t fan, int32_t patch[MOST_IN_PATCH],
                            int32_t *own_count)
{
    const fans *f = &r->fans;
    int32_t count = 0, ring[3 * MOST_IN_PATCH], ring_count = 0, (*triangle)[3] = r->sheet->triangle;
    for (int32_t i = f->first[node]; i < f->first[node + 1] && count < MOST_IN_PATCH; i++)
        if (f->fan[f->corner[i]] == fan) patch[count++] = f->corner[i] / 3;
    *own_count = count;
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            if (!is_among(ring_count, ring, triangle[patch[i]][k]))
                ring[ring_count++] = triangle[patch[i]][k];
    for (int32_t i = 0; i < count; i++)
        for (int side = 0; side < 3; side++) {
            int32_t next = f->beside[3 * patch[i] + side];
            if (next < 0 || !f->smooth[3 * patch[i] + side] || count == MOST_IN_PATCH) continue;
            if (is_among(count, patch, next)) continue;
            bool touches = false;
            for (int k = 0; k < 3 && !touches; k++) touches = is_among(ring_count, ring, triangle[next][k]);
            if (touches) patch[count++] = next;
        }
    return count;
}

// A vector of a plane with normal `from`, turned with that plane onto the one with normal `to`.
static void turn_with(const double from[3], const double to[3], const double v[3], double out[3])
{
    double shift = dot(v, to) / (1 + dot(from, to));
    for (int k = 0; k < 3; k++) out[k] = v[k] - shift * (from[k] + to[k]);
}

// Axes at a node: z the mean normal of its own triangles, x as in the first of them.
static void node_frame(const recovering *r, const int32_t *patch, int32_t own_count, double frame[3][3])
{
    double *x = frame[0], *y = frame[1], *z = frame[2];
    memset(frame, 0, 3 * sizeof *frame);
    for (int32_t i = 0; i < own_count; i++) {
        const triangle_state *s = &r->state[patch[i]];
        for (int k = 0; k < 3; k++) z[k] += s->area * s->frame[2][k];
    }
    double length = sqrt(dot(z, z));
    for (int k = 0; k < 3; k++) z[k] /= length;
    const triangle_state *first = &r->state[patch[0]];
    turn_with(first->frame[2], z, first->frame[0], x);
    for (int k = 0; k < 3; k++) y[k] = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
}

// A triangle's resultants in a node's axes.
static void turned_values(const triangle_state *s, const double frame[3][3], double value[FIELDS])
{
    double x[3];
    turn_with(s->frame[2], frame[2], s->frame[0], x);
    double c = dot(x, frame[0]), d = dot(x, frame[1]);
    for (int k = 0; k < 6; k += 3) {
        const double *v = s->value + k;
        value[k] = c * c * v[0] + d * d * v[1] - 2 * c * d * v[2];
        value[k + 1] = d * d * v[0] + c * c * v[1] + 2 * c * d * v[2];
        value[k + 2] = c * d * (v[0] - v[1]) + (c * c - d * d) * v[2];
    }
    value[6] = c * s->value[6] - d * s->value[7];
    value[7] = d * s->value[6] + c * s->value[7];
}

// Solve a symmetric system of which the lower half is given, by Cholesky; it is overwritten.
static void solve_small(int n, double a[TERMS][TERMS], double b[TERMS])
{
    for (int k = 0; k < n; k++) {
        for (int l = 0; l <= k; l++) {
            double sum = a[k][l];
            for (int m = 0; m < l; m++) sum -= a[k][m] * a[l][m];
            a[k][l] = l < k ? sum / a[l][l] : sqrt(sum);
        }
        for (int m = 0; m < k; m++) b[k] -= a[k][m] * b[m];
        b[k] /= a[k][k];
    }
    for (int k = n; k-- > 0; b[k] /= a[k][k])
        for (int m = k + 1; m < n; m++) b[k] -= a[m][k] * b[m];
}

// How much each triangle of a patch counts for the fitted surface at the node: they sum to 1.
static void fit_shares(const recovering *r, const double at[3], const double frame[3][3],
                       const int32_t *patch, int32_t own_count, int32_t count, double share[MOST_IN_PATCH])
{
    double term[MOST_IN_PATCH][TERMS], scale = 0, out[2] = {0, 0}, sum = 0; // 1, x, y, xx, xy, yy
    double normal[TERMS][TERMS] = {{0}}, height[TERMS] = {1};
    int terms = count >= ENOUGH_TO_CURVE ? TERMS : 3;
    for (int32_t i = 0; i < count; i++) {
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = r->state[patch[i]].centroid[k] - at[k];
        for (int k = 0; k < 2; k++) term[i][1 + k] = dot(d, frame[k]);
        if (i >= own_count) continue;
        scale += dot(d, d) / own_count;
        for (int k = 0; k < 2; k++) out[k] += term[i][1 + k] / own_count;
    }
    double shrink = 1 / sqrt(scale);
    for (int32_t i = 0; i < count; i++) {
        double x = term[i][1] * shrink, y = term[i][2] * shrink;
        const double value[TERMS] = {1, x, y, x * x, x * y, y * y};
        memcpy(term[i], value, sizeof value);
        share[i] = r->state[patch[i]].area / (NEAR + x * x + y * y);
        for (int k = 0; k < terms; k++)
            for (int l = 0; l <= k; l++) normal[k][l] += share[i] * value[k] * value[l];
    }
    double outside = (out[0] * out[0] + out[1] * out[1]) / scale, all = normal[0][0];
    for (int k = 1; k < terms; k++) normal[k][k] += all * (FLATTEN + (k > 2 ? STIFFEN * outside : 0));
    solve_small(terms, normal, height);
    for (int32_t i = 0; i < count; i++) {
        double weight = 0;
        for (int k = 0; k < terms; k++) weight += height[k] * term[i][k];
        sum += share[i] *= weight;
    }
    for (int32_t i = 0; i < count; i++) share[i] /= sum;
}

// The thickness at a node: its own, unless it lies on a step, where each fan has that of its triangles.
static double thickness_at(const recovering *r, int32_t node, const int32_t *patch, int32_t own_count)
{
    const fans *f = &r->fans;
    if (f->first_fan[node + 1] - f->first_fan[node] == 1) return r->sheet->thickness_mm[node];
    double sum = 0, area = 0, most = 0, least = INFINITY;
    for (int32_t i = f->first[node]; i < f->first[node + 1]; i++) {
        most = MAX(most, r->thickness[f->corner[i] / 3]);
        least = MIN(least, r->thickness[f->corner[i] / 3]);
    }
    if (most <= 1.1 * least) return r->sheet->thickness_mm[node];
    for (int32_t i = 0; i < own_count; i++) {
        sum += r->state[patch[i]].area * r->thickness[patch[i]];
        area += r->state[patch[i]].area;
    }
    return sum / area;
}

static void recover_block(void *shared, int32_t block)
{
    recovering *r = shared;
    const fans *f = &r->fans;
    for (int32_t node = block * BLOCK; node < MIN((block + 1) * BLOCK, f->node_count); node++) {
        double worst = 0;
        if (r->loud && !r->loud[node]) {
            for (int32_t fan = f->first_fan[node]; fan < f->first_fan[node + 1]; fan++)
                r->worst[fan] = r->peak[node];
            r->out->worst[node] = r->peak[node];
            continue;
        }
        for (int32_t fan = f->first_fan[node]; fan < f->first_fan[node + 1]; fan++) {
            int32_t patch[MOST_IN_PATCH], own_count, count = gather_patch(r, node, fan, patch, &own_count);
            double frame[3][3], share[MOST_IN_PATCH], v[FIELDS] = {0}, turned[FIELDS];
            node_frame(r, patch, own_count, frame);
            fit_shares(r, r->sheet->node[node], (const double(*)[3])frame, patch, own_count, count, share);
            for (int32_t i = 0; i < count; i++) {
                turned_values(&r->state[patch[i]], (const double(*)[3])frame, turned);
                for (int k = 0; k < FIELDS; k++) v[k] += share[i] * turned[k];
            }
            double layer[LAYERS], principal[2][2];
            read_layers(v, thickness_at(r, node, patch, own_count), layer, principal);
            r->worst[fan] = worst_of(layer);
            if (fan > f->first_fan[node] && r->worst[fan] <= worst) continue;
            worst = r->worst[fan];
            memcpy(r->out->von_mises[node], layer, sizeof layer);
            memcpy(r->out->principal[node], principal, sizeof principal);
        }
        r->out->worst[node] = worst;
    }
}

static void average_block(void *shared, int32_t block)
{
    recovering *r = shared;
    for (int32_t n = block * BLOCK; n < MIN((block + 1) * BLOCK, r->fans.node_count); n++)
        r->out->mean[n] = r->radius_mm > 0 && (!r->loud || r->loud[n])
                              ? mean_around(r->sheet, &r->fans, r->worst, n, r->radius_mm)
                              : r->out->worst[n];
}

static void find_largest(stresses *s)
{
    for (int32_t n = 0; n < s->node_count; n++) {
        if (s->worst[n] > s->worst_mpa || s->worst_at < 0) s->worst_mpa = s->worst[s->worst_at = n];
        if (s->mean[n] > s->mean_mpa || s->mean_at < 0) s->mean_mpa = s->mean[s->mean_at = n];
    }
}

static jali_status check_input(jali_context *ctx, const jali_sheet *sheet, const double (*u)[6],
                               double disc_mm)
{
    if (!(disc_mm >= 0) || !isfinite(disc_mm))
        return fail(ctx, JALI_BAD_VALUE, "a disc of %g mm to average stresses over; it must be 0 or more",
                    disc_mm);
    for (int32_t n = 0; n < sheet->node_count; n++) {
        if (!(sheet->thickness_mm[n] > 0))
            return fail(ctx, JALI_BAD_VALUE,
                        "the wall is %g mm thick at (%.2f, %.2f, %.2f) mm; it must be more than 0",
                        sheet->thickness_mm[n], sheet->node[n][0], sheet->node[n][1], sheet->node[n][2]);
        for (int k = 0; k < 6; k++)
            if (!isfinite(u[n][k]))
                return fail(ctx, JALI_NO_RESULT, "the displacement at (%.2f, %.2f, %.2f) mm is no number",
                            sheet->node[n][0], sheet->node[n][1], sheet->node[n][2]);
    }
    return JALI_OK;
}

static jali_status recover(jali_context *ctx, const jali_sheet *sheet, const facet_material *made_of,
                           const double (*u)[6], double disc_mm, double quiet_share, stresses *s)
{
    jali_status status;
    uint8_t *touched = NULL;
    size_t nodes = (size_t)sheet->node_count, triangles = (size_t)sheet->triangle_count;
    int32_t node_blocks = (sheet->node_count + BLOCK - 1) / BLOCK;
    recovering r = {.sheet = sheet, .made_of = made_of, .u = u, .radius_mm = 0.5 * disc_mm, .out = s};
    *s = (stresses){.node_count = sheet->node_count, .worst_at = -1, .mean_at = -1};
    TRY(check_input(ctx, sheet, u, disc_mm));
    TRY(ALLOCATE_CLEARED(ctx, s->von_mises, nodes));
    TRY(ALLOCATE_CLEARED(ctx, s->principal, nodes));
    TRY(ALLOCATE_CLEARED(ctx, s->worst, nodes));
    TRY(ALLOCATE_CLEARED(ctx, s->mean, nodes));
    TRY(ALLOCATE(ctx, r.state, triangles));
    TRY(ALLOCATE(ctx, r.normal, triangles));
    TRY(ALLOCATE(ctx, r.thickness, triangles));
    parallel(ctx, (sheet->triangle_count + BLOCK - 1) / BLOCK, evaluate_block, &r);
    TRY(step(ctx, "stress", 0.3));
    if (quiet_share > 0) {
        TRY(ALLOCATE(ctx, r.peak, nodes));
        TRY(ALLOCATE(ctx, r.loud, nodes));
        TRY(ALLOCATE(ctx, touched, nodes));
        find_loud(&r, quiet_share, touched);
    }
    TRY(fans_of(ctx, sheet, (const double(*)[3])r.normal, r.thickness, r.loud, &r.fans));
    TRY(ALLOCATE(ctx, r.worst, r.fans.fan_count));
    parallel(ctx, node_blocks, recover_block, &r);
    TRY(step(ctx, "stress", 0.7));
    parallel(ctx, node_blocks, average_block, &r);
    find_largest(s);
done:
    release(ctx, r.state);
    release(ctx, r.normal);
    release(ctx, r.thickness);
    release(ctx, r.worst);
    release(ctx, r.peak);
    release(ctx, r.loud);
    release(ctx, touched);
    fans_free(ctx, &r.fans);
    if (status != JALI_OK) stresses_free(ctx, s);
    return status;
}

jali_status recover_stresses(jali_context *ctx, const jali_sheet *sheet, const facet_material *made_of,
                             const double (*u)[6], double disc_mm, stresses *s)
{
    return recover(ctx, sheet, made_of, u, disc_mm, 0, s);
}

jali_status recover_peaks(jali_context *ctx, const jali_sheet *sheet, const facet_material *made_of,
                          const double (*u)[6], double disc_mm, stresses *s)
{
    const double quiet_share = 0.25; // a patch reads at most a few times its worst triangle at its node
    return recover(ctx, sheet, made_of, u, disc_mm, quiet_share, s);
}
