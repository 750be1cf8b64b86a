// A judge of widths: which pixels of a tone does no disc of a given diameter cover, by exact Euclidean
// distances?
//
// Independent: own distance transform, own flood fill, bytes for bits, discs that may lie anywhere on the
// lattice of
//          half pixels (the library's lie on whole ones, row by row in words).
// Method:  a disc lies inside a tone when no pixel centre of the other tone is within its radius; a pixel is
// covered
//          when such a disc reaches into it (its centre is within the radius and half a pixel). Both are
//          distance transforms (Felzenszwalb and Huttenlocher 2012: lower envelope of parabolas), on doubled
//          coordinates in whole numbers. Centres of discs: pixel centres and pixel corners.
// Types:   uncovered pixels are grouped (white 4-, black 8-connected). A: the pixels of the other tone around
// the
//          group are in more than one part. B: one part, and longer than epsilon from end to end (geodesic,
//          8-connected) or touching no larger area of its tone. C: the rest.
// Limits:  pictures up to about 20,000 px a side (squared doubled distances in 32 bits); about 10 bytes a
// pixel.
#ifndef TESTS_JUDGE_WIDTHS_H
#define TESTS_JUDGE_WIDTHS_H

#include "plain.h"

#include <jali/optimise.h>

typedef struct judge_verdict {
    int64_t uncovered_px;
    int32_t type[3]; // groups of type A, B, C
    int32_t at[2];   // a pixel of the first A or B, in the picture; (-1, -1): none
} judge_verdict;

static const int32_t JUDGE_FAR = 1 << 30;

/// In place along a line: out(p) = min over q of in(q) + (doubled distance from q + from_half to p +
/// to_half)^2.
///   in     n      samples, `stride` apart; in(q) may be JUDGE_FAR
///          shift  doubled: 2 p - 2 q + shift is the doubled distance
///          place, value, edge   scratch [n + 1]
static inline void judge_envelope(int32_t *line, int32_t n, int64_t stride, int32_t shift, int32_t *place,
                                  int64_t *value, double *edge)
{
    int32_t count = 0;
    for (int32_t q = 0; q < n; q++) {
        int64_t f = line[q * stride];
        if (f >= JUDGE_FAR) continue;
        // Parabolas f + (x - 2 q)^2 over doubled x; where the new one passes below the last one.
        double x = -1e18;
        while (count > 0) {
            int64_t dq = 2 * ((int64_t)q - place[count - 1]), sum = 2 * ((int64_t)q + place[count - 1]);
            x = ((double)(f - value[count - 1]) + (double)(dq * sum)) / (2.0 * (double)dq);
            if (x > edge[count - 1]) break;
            count--;
            x = -1e18;
        }
        place[count] = q;
        value[count] = f;
        edge[count++] = x;
    }
    for (int32_t p = 0, k = 0; p < n; p++) {
        double x = 2.0 * p + shift;
        while (k + 1 < count && edge[k + 1] < x) k++;
        int64_t d = count ? 2 * ((int64_t)p - place[k]) + shift : 0;
        line[p * stride] =
            count ? (int32_t)(value[k] + d * d < JUDGE_FAR ? value[k] + d * d : JUDGE_FAR) : JUDGE_FAR;
    }
}

/// Squared doubled distances from each lattice point (x + shift / 2, y + shift / 2) to the nearest (x, y) of
/// the set.
///   in,out squared   [h * w], 0 in the set, JUDGE_FAR elsewhere
static inline void judge_distances(int32_t *squared, int32_t w, int32_t h, int32_t shift)
{
    int32_t n = w > h ? w : h;
    int32_t *place = malloc(((size_t)n + 1) * sizeof *place);
    int64_t *value = malloc(((size_t)n + 1) * sizeof *value);
    double *edge = malloc(((size_t)n + 1) * sizeof *edge);
    for (int32_t y = 0; y < h; y++) judge_envelope(squared + (int64_t)y * w, w, 1, shift, place, value, edge);
    for (int32_t x = 0; x < w; x++) judge_envelope(squared + x, h, w, shift, place, value, edge);
    free(place);
    free(value);
    free(edge);
}

/// A picture in a margin of its surroundings.
static inline plain judge_padded(const jali_bitmap *a, bool outside, int32_t pad)
{
    plain p = plain_create(a->width_px + 2 * pad, a->height_px + 2 * pad);
    for (int32_t y = 0; y < p.h; y++)
        for (int32_t x = 0; x < p.w; x++) {
            int32_t u = x - pad, v = y - pad;
            bool inside = u >= 0 && v >= 0 && u < a->width_px && v < a->height_px;
            p.white[(int64_t)y * p.w + x] = inside ? jali_bitmap_get(a, u, v) : outside;
        }
    return p;
}

/// The pixels of a tone that no disc covers, as a picture.
static inline plain judge_uncovered(const plain *p, bool white, double diameter_px)
{
    int64_t n = (int64_t)p->w * p->h;
    double least = diameter_px * diameter_px,
           most = (diameter_px + 1) * (diameter_px + 1); // squared doubled distances
    plain bare = plain_create(p->w, p->h);
    int32_t *squared = malloc((size_t)n * sizeof *squared);
    for (int64_t i = 0; i < n; i++) bare.white[i] = p->white[i] == white;
    for (int32_t corner = 0; corner < 2; corner++) {
        for (int64_t i = 0; i < n; i++) squared[i] = p->white[i] == white ? JUDGE_FAR : 0;
        judge_distances(squared, p->w, p->h,
                        corner); // at corners: the one to the lower right of pixel (x, y)
        // A corner is half a pixel aside from every centre: its distance from a straight edge is that much
        // shorter.
        for (int64_t i = 0; i < n; i++) squared[i] = (double)squared[i] - corner > least ? 0 : JUDGE_FAR;
        judge_distances(squared, p->w, p->h, -corner);
        for (int64_t i = 0; i < n; i++)
            if ((double)squared[i] <= most) bare.white[i] = 0;
    }
    free(squared);
    return bare;
}

/// The same for the paper's squares of an odd size, by definition: where the square fits, and what it then
/// covers.
static inline plain judge_uncovered_by_squares(const plain *p, bool white, int32_t size_px)
{
    plain bare = plain_create(p->w, p->h), fits = plain_create(p->w, p->h);
    int32_t half = size_px / 2;
    for (int64_t i = 0; i < (int64_t)p->w * p->h; i++) bare.white[i] = p->white[i] == white;
    // run: side of the largest square of the tone whose lower right corner is here.
    int32_t *run = calloc((size_t)p->w * (size_t)p->h + 1, sizeof *run);
    for (int32_t y = 0; y < p->h; y++)
        for (int32_t x = 0; x < p->w; x++) {
            int64_t i = (int64_t)y * p->w + x;
            if (!bare.white[i]) continue;
            int32_t least = x && y ? run[i - p->w - 1] : 0;
            if (x && y && run[i - p->w] < least) least = run[i - p->w];
            if (x && y && run[i - 1] < least) least = run[i - 1];
            run[i] = 1 + least;
            if (run[i] >= size_px) fits.white[i - (int64_t)half * p->w - half] = 1;
        }
    for (int32_t y = half; y < p->h - half; y++)
        for (int32_t x = half; x < p->w - half; x++)
            if (fits.white[(int64_t)y * p->w + x])
                for (int32_t v = y - half; v <= y + half; v++)
                    memset(&bare.white[(int64_t)v * p->w + x - half], 0, (size_t)size_px);
    free(run);
    plain_free(&fits);
    return bare;
}

typedef struct judge_group {
    const plain *p;
    bool white;
    const int32_t *label; // of the uncovered pixels
    int32_t *mark;        // [h * w], scratch: 0 between groups
    int32_t *queue;       // [h * w]
    int32_t *ring;        // [h * w]
} judge_group;

/// Breadth first over the group's pixels from `start`; returns the last one reached, its distance in *steps.
static inline int32_t judge_farthest(judge_group *g, int32_t start, int32_t *count, int32_t *steps)
{
    int32_t w = g->p->w, head = 0, tail = 0, last = start;
    g->queue[tail++] = start;
    g->mark[start] = 1;
    while (head < tail) {
        last = g->queue[head++];
        for (int32_t dy = -1; dy <= 1; dy++)
            for (int32_t dx = -1; dx <= 1; dx++) {
                int32_t x = last % w + dx, y = last / w + dy, j = y * w + x;
                if (!plain_inside(g->p, x, y) || g->label[j] != g->label[start] || g->mark[j]) continue;
                g->mark[j] = g->mark[last] + 1;
                g->queue[tail++] = j;
            }
    }
    *count = tail;
    *steps = g->mark[last];
    return last;
}

/// Parts of the other tone around the group; whether the group touches more of its own.
static inline int32_t judge_ring_parts(judge_group *g, int32_t count, bool *touches_own)
{
    int32_t w = g->p->w, ring_count = 0, parts = 0;
    *touches_own = false;
    for (int32_t k = 0; k < count; k++)
        for (int32_t dy = -1; dy <= 1; dy++)
            for (int32_t dx = -1; dx <= 1; dx++) {
                int32_t i = g->queue[k], x = i % w + dx, y = i / w + dy, j = y * w + x;
                if (!plain_inside(g->p, x, y) || g->mark[j]) continue;
                bool own = g->p->white[j] == g->white;
                if (own && !(g->white && dx && dy)) *touches_own = true;
                if (own) continue;
                g->mark[j] = -1;
                g->ring[ring_count++] = j;
            }
    // Flood the ring, in its tone's connectivity, turning -1 to -2.
    for (int32_t k = 0; k < ring_count; k++) {
        if (g->mark[g->ring[k]] != -1) continue;
        parts++;
        int32_t *stack = malloc((size_t)ring_count * sizeof *stack), depth = 0;
        stack[depth++] = g->ring[k];
        g->mark[g->ring[k]] = -2;
        while (depth > 0) {
            int32_t i = stack[--depth];
            for (int32_t dy = -1; dy <= 1; dy++)
                for (int32_t dx = -1; dx <= 1; dx++) {
                    int32_t x = i % w + dx, y = i / w + dy, j = y * w + x;
                    if ((!g->white && dx && dy) || !plain_inside(g->p, x, y) || g->mark[j] != -1) continue;
                    g->mark[j] = -2;
                    stack[depth++] = j;
                }
        }
        free(stack);
    }
    for (int32_t k = 0; k < ring_count; k++) g->mark[g->ring[k]] = 0;
    return parts;
}

typedef struct judge_rule {
    double width_px;   // diameter of the discs, or side of the squares
    bool squares;      // the paper's elements
    double epsilon_px; // longest tip that is let pass
    bool isolated;     // a detail on its own is type B
} judge_rule;

/// How long `steps` steps from one pixel to another are.
typedef double (*judge_length)(int32_t steps, const int32_t from[2], const int32_t to[2]);

/// Sort the groups of uncovered pixels.
///   in     p, bare   the picture and what of the tone is uncovered, both in a margin of `pad` px
///          length    what a group's steps from one place to another are long, NULL: one each
static inline judge_verdict judge_groups(const plain *p, const plain *bare, bool white, judge_rule rule,
                                         int32_t pad, judge_length length)
{
    judge_verdict v = {.at = {-1, -1}};
    size_t n = (size_t)p->w * (size_t)p->h + 1;
    int32_t *label = malloc(n * sizeof *label);
    judge_group g = {p,
                     white,
                     label,
                     calloc(n, sizeof(int32_t)),
                     malloc(n * sizeof(int32_t)),
                     malloc(n * sizeof(int32_t))};
    int32_t groups = plain_label(bare, true, white ? 4 : 8, label), next = 0;
    for (int32_t i = 0; next < groups; i++) {
        if (label[i] != next) continue; // not the group's first pixel
        next++;
        int32_t count, steps;
        bool touches_own;
        int32_t end = judge_farthest(&g, i, &count, &steps);
        for (int32_t k = 0; k < count; k++) g.mark[g.queue[k]] = 0;
        int32_t other = judge_farthest(&g, end, &count, &steps);
        int32_t parts = judge_ring_parts(&g, count, &touches_own);
        for (int32_t k = 0; k < count; k++) g.mark[g.queue[k]] = 0;
        int32_t from[2] = {end % p->w - pad, end / p->w - pad},
                to[2] = {other % p->w - pad, other / p->w - pad};
        double long_px = length ? length(steps, from, to) : steps;
        int32_t type = parts > 1 ? 0 : long_px > rule.epsilon_px || (rule.isolated && !touches_own) ? 1 : 2;
        if (type < 2 && v.at[0] < 0) {
            v.at[0] = i % p->w - pad;
            v.at[1] = i / p->w - pad;
        }
        v.type[type]++;
        v.uncovered_px += count;
    }
    free(label);
    free(g.mark);
    free(g.queue);
    free(g.ring);
    return v;
}

/// Judge one tone of a picture in endless surroundings.
static inline judge_verdict judge_widths(const jali_bitmap *a, bool outside_solid, bool white,
                                         judge_rule rule)
{
    int32_t pad = (int32_t)rule.width_px + 3;
    plain p = judge_padded(a, outside_solid, pad);
    plain bare = rule.squares ? judge_uncovered_by_squares(&p, white, (int32_t)rule.width_px)
                              : judge_uncovered(&p, white, rule.width_px);
    judge_verdict v = judge_groups(&p, &bare, white, rule, pad, NULL);
    plain_free(&bare);
    plain_free(&p);
    return v;
}

/// Judge a mask in both tones: by discs of phi_s and phi_v less a tolerance for rasterisation, or by the
/// paper's squares.
static inline void judge_mask(const jali_bitmap *mask, const jali_chart *chart,
                              const jali_optimise_options *opt, const int32_t kernels_px[3],
                              double tolerance_px, judge_verdict *white, judge_verdict *black)
{
    double pixel_mm = jali_chart_pixel_mm(chart);
    judge_rule solid = {opt->phi_s_mm / pixel_mm - tolerance_px, opt->paper, opt->epsilon_mm / pixel_mm,
                        !opt->paper};
    judge_rule hollow = solid;
    hollow.width_px = opt->phi_v_mm / pixel_mm - tolerance_px;
    if (opt->paper) solid.width_px = kernels_px[1], hollow.width_px = kernels_px[2];
    *white = judge_widths(mask, chart->outside_solid, true, solid);
    *black = judge_widths(mask, chart->outside_solid, false, hollow);
}

#endif
