// What tests and benches ask of a sheet.
#ifndef TESTS_JUDGE_SHEET_H
#define TESTS_JUDGE_SHEET_H

#include <jali/sheet.h>

#include <math.h>
#include <stdlib.h>

typedef struct sheet_quality {
    double least_degrees;  // smallest angle of all
    double share_below_20; // of the triangles
    double mean_degrees;   // of the triangles' smallest angles
    double bin[12];        // share of the triangles whose smallest angle is in 5 k .. 5 k + 5 degrees
} sheet_quality;

static inline double least_angle(const jali_sheet *sheet, int32_t t)
{
    double least = 180;
    for (int k = 0; k < 3; k++) {
        const double *a = sheet->node[sheet->triangle[t][k]],
                     *b = sheet->node[sheet->triangle[t][(k + 1) % 3]],
                     *c = sheet->node[sheet->triangle[t][(k + 2) % 3]];
        double dot = 0, bb = 0, cc = 0;
        for (int i = 0; i < 3; i++) {
            dot += (b[i] - a[i]) * (c[i] - a[i]);
            bb += (b[i] - a[i]) * (b[i] - a[i]);
            cc += (c[i] - a[i]) * (c[i] - a[i]);
        }
        least = fmin(least, acos(fmax(-1, fmin(1, dot / sqrt(bb * cc)))) * 180 / M_PI);
    }
    return least;
}

static inline sheet_quality quality_of(const jali_sheet *sheet)
{
    sheet_quality q = {.least_degrees = 180};
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        double least = least_angle(sheet, t), share = 1.0 / sheet->triangle_count;
        q.least_degrees = fmin(q.least_degrees, least);
        q.mean_degrees += least * share;
        q.bin[(int)fmin(least / 5, 11)] += share;
        if (least < 20) q.share_below_20 += share;
    }
    return q;
}

typedef struct half_edge {
    int32_t from, to, at; // at: 3 t + the corner it leaves
} half_edge;

static inline int compare_half_edges(const void *a, const void *b)
{
    const half_edge *p = a, *q = b;
    return p->from != q->from ? (p->from < q->from ? -1 : 1) : (p->to > q->to) - (p->to < q->to);
}

/// The half edge the other way at each corner's edge, -1 at a border, [3 * triangle_count]; free() it. NULL
/// when an edge is there twice the same way.
static inline int32_t *edges_beside(const jali_sheet *sheet)
{
    size_t count = 3 * (size_t)sheet->triangle_count;
    half_edge *half = malloc((count + 1) * sizeof *half);
    int32_t *beside = malloc((count + 1) * sizeof *beside);
    for (size_t i = 0; i < count; i++)
        half[i] = (half_edge){sheet->triangle[i / 3][i % 3], sheet->triangle[i / 3][(i + 1) % 3], (int32_t)i};
    qsort(half, count, sizeof *half, compare_half_edges);
    bool once = true;
    for (size_t i = 1; i < count; i++) once = once && compare_half_edges(&half[i - 1], &half[i]) != 0;
    for (size_t i = 0; i < count; i++) {
        half_edge key = {half[i].to, half[i].from, 0},
                  *found = bsearch(&key, half, count, sizeof key, compare_half_edges);
        beside[half[i].at] = found ? found->at : -1;
    }
    free(half);
    if (once) return beside;
    free(beside);
    return NULL;
}

/// Every corner in range, every edge in at most two triangles that run it both ways, one fan around every
/// node, and bits on exactly the nodes at borders.
static inline bool is_manifold(const jali_sheet *sheet)
{
    int32_t count = 3 * sheet->triangle_count,
            *degree = calloc((size_t)sheet->node_count + 1, sizeof *degree);
    bool sound = true;
    for (int32_t i = 0; i < count && sound; i++) {
        int32_t node = sheet->triangle[i / 3][i % 3];
        sound = node >= 0 && node < sheet->node_count && node != sheet->triangle[i / 3][(i + 1) % 3];
        if (sound) degree[node]++;
    }
    int32_t *beside = sound ? edges_beside(sheet) : NULL;
    uint8_t *seen = calloc((size_t)sheet->node_count + 1, 1);
    for (int32_t i = 0; i < count && beside && sound; i++) {
        int32_t node = sheet->triangle[i / 3][i % 3], turned = 1, at = i;
        if (seen[node]++) {
            seen[node] = 1;
            continue;
        }
        bool border = false;
        // The edge that enters the corner is the one that leaves the corner before it.
        for (int32_t o; (o = beside[at / 3 * 3 + (at + 2) % 3]) >= 0 && o != i; turned++) at = o;
        border = beside[at / 3 * 3 + (at + 2) % 3] < 0;
        for (int32_t o = i; border && (o = beside[o]) >= 0; turned++) o = o / 3 * 3 + (o + 1) % 3;
        sound = turned == degree[node] && border == (sheet->border[node] != 0);
    }
    for (int32_t i = 0; i < sheet->node_count; i++) sound = sound && degree[i] > 0;
    sound = sound && beside;
    free(degree);
    free(beside);
    free(seen);
    return sound;
}

static inline double area_of(const jali_sheet *sheet)
{
    double sum = 0;
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const double *a = sheet->node[sheet->triangle[t][0]], *b = sheet->node[sheet->triangle[t][1]],
                     *c = sheet->node[sheet->triangle[t][2]];
        double u[3], v[3];
        for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
        double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
        sum += 0.5 * sqrt(x * x + y * y + z * z);
    }
    return sum;
}

#endif
