// Two fields on two meshes of one plate.
#include "fields.h"
#include "calculix.h"
#include "judge_sheet.h"

#include "structure/average.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

reader reader_of(const jali_sheet *sheet)
{
    reader r = {.sheet = sheet, .low = {INFINITY, INFINITY}};
    double high[2] = {-INFINITY, -INFINITY};
    for (int32_t i = 0; i < sheet->node_count; i++)
        for (int k = 0; k < 2; k++) {
            r.low[k] = fmin(r.low[k], sheet->node[i][k]);
            high[k] = fmax(high[k], sheet->node[i][k]);
        }
    r.cell = sqrt((high[0] - r.low[0]) * (high[1] - r.low[1]) / sheet->node_count);
    r.columns = (int32_t)((high[0] - r.low[0]) / r.cell) + 1;
    r.rows = (int32_t)((high[1] - r.low[1]) / r.cell) + 1;
    r.first = calloc((size_t)r.columns * r.rows + 2, sizeof *r.first);
    for (int pass = 0; pass < 2; pass++) { // count, then place
        for (int32_t t = 0; t < sheet->triangle_count; t++) {
            int32_t from[2] = {INT32_MAX, INT32_MAX}, to[2] = {0, 0};
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 2; k++) {
                    int32_t c = (int32_t)((sheet->node[sheet->triangle[t][i]][k] - r.low[k]) / r.cell);
                    from[k] = c < from[k] ? c : from[k];
                    to[k] = c > to[k] ? c : to[k];
                }
            for (int32_t y = from[1]; y <= to[1]; y++)
                for (int32_t x = from[0]; x <= to[0]; x++) {
                    int32_t *slot = &r.first[y * r.columns + x + (pass ? 1 : 2)];
                    if (pass) r.triangle[*slot] = t;
                    (*slot)++;
                }
        }
        if (pass) break;
        for (int32_t i = 0; i < r.columns * r.rows; i++) r.first[i + 2] += r.first[i + 1];
        r.triangle = malloc(((size_t)r.first[r.columns * r.rows + 1] + 1) * sizeof *r.triangle);
    }
    return r;
}

void reader_free(reader *r)
{
    free(r->first);
    free(r->triangle);
    *r = (reader){0};
}

double read_at(const reader *r, const float *value, int32_t stride, double x, double y)
{
    int32_t column = (int32_t)((x - r->low[0]) / r->cell), row = (int32_t)((y - r->low[1]) / r->cell);
    if (column < 0 || row < 0 || column >= r->columns || row >= r->rows) return NAN;
    double best = -INFINITY, found = NAN;
    for (int32_t i = r->first[row * r->columns + column]; i < r->first[row * r->columns + column + 1]; i++) {
        const int32_t *c = r->sheet->triangle[r->triangle[i]];
        double share[3], least = INFINITY, sum = 0, area = 0;
        for (int k = 0; k < 3; k++) {
            const double *p = r->sheet->node[c[(k + 1) % 3]], *q = r->sheet->node[c[(k + 2) % 3]];
            share[k] = (p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y);
            area += share[k];
        }
        for (int k = 0; k < 3; k++) {
            share[k] /= area;
            least = fmin(least, share[k]);
        }
        if (least <= best) continue;
        for (int k = 0; k < 3; k++) sum += share[k] * value[(size_t)c[k] * stride];
        best = least;
        found = sum;
    }
    return found;
}

// The next node along the border, solid on the left; -1 inside.
static int32_t *next_on_border(const jali_sheet *sheet)
{
    int32_t *next = malloc((size_t)sheet->node_count * sizeof *next), *beside = edges_beside(sheet);
    for (int32_t i = 0; i < sheet->node_count; i++) next[i] = -1;
    for (int32_t i = 0; beside && i < 3 * sheet->triangle_count; i++)
        if (beside[i] < 0) next[sheet->triangle[i / 3][i % 3]] = sheet->triangle[i / 3][(i + 1) % 3];
    free(beside);
    return next;
}

// How far the border turns into the solid from the side before `from` until `length` is walked; rad, > 0.
static double turn_along(const jali_sheet *sheet, const int32_t *next, int32_t from, double length,
                         int32_t *sharpest)
{
    double turned = 0, most = -INFINITY;
    *sharpest = from;
    for (int32_t a = from, walked = 0; length > 0 && walked < 1000; a = next[a], walked++) {
        const double *p = sheet->node[a], *q = sheet->node[next[a]], *r = sheet->node[next[next[a]]];
        double u[2] = {q[0] - p[0], q[1] - p[1]}, v[2] = {r[0] - q[0], r[1] - q[1]};
        double turn = -atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
        turned += turn;
        if (turn > most) *sharpest = next[a];
        most = fmax(most, turn);
        length -= hypot(v[0], v[1]);
    }
    return turned;
}

void far_from_corners(const jali_sheet *sheet, uint8_t held, double bend_mm, double corner_mm,
                      double clamp_mm, bool *far)
{
    int32_t n = sheet->node_count, counts[2] = {0, 0}, *next = next_on_border(sheet), sharpest;
    double(*place[2])[3] = {malloc((size_t)n * sizeof *place[0]), malloc((size_t)n * sizeof *place[1])};
    for (int32_t i = 0; i < n; i++) {
        if (sheet->border[i] & held) memcpy(place[0][counts[0]++], sheet->node[i], sizeof *sheet->node);
        if (next[i] >= 0 && turn_along(sheet, next, i, bend_mm, &sharpest) > M_PI / 3)
            memcpy(place[1][counts[1]++], sheet->node[sharpest], sizeof *sheet->node);
    }
    near_index clamps = near_index_of(counts[0], (const double(*)[3])place[0]),
               corners = near_index_of(counts[1], (const double(*)[3])place[1]);
    for (int32_t i = 0; i < n; i++) {
        const double *at = sheet->node[i];
        far[i] = nearest_within(&clamps, at[0], at[1], clamp_mm) < 0 &&
                 nearest_within(&corners, at[0], at[1], corner_mm) < 0;
    }
    free(clamps.order), free(corners.order), free(next), free(place[0]), free(place[1]);
}

jali_status disc_means(jali_context *ctx, const jali_sheet *sheet, const float *value, int32_t stride,
                       double diameter_mm, float *mean)
{
    jali_status status;
    fans f = {0};
    double(*normal)[3] = NULL, *thickness = NULL, *at_fan = NULL;
    TRY(ALLOCATE_CLEARED(ctx, normal, sheet->triangle_count));
    TRY(ALLOCATE(ctx, thickness, sheet->triangle_count));
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        normal[t][2] = 1;
        thickness[t] = sheet->thickness_mm[0];
    }
    TRY(fans_of(ctx, sheet, (const double(*)[3])normal, thickness, NULL, &f));
    TRY(ALLOCATE(ctx, at_fan, f.fan_count));
    for (int32_t i = 0; i < sheet->node_count; i++)
        for (int32_t k = f.first_fan[i]; k < f.first_fan[i + 1]; k++) at_fan[k] = value[(size_t)i * stride];
    for (int32_t i = 0; i < sheet->node_count; i++)
        mean[i] = (float)mean_around(sheet, &f, at_fan, i, diameter_mm / 2);
done:
    fans_free(ctx, &f);
    release(ctx, normal), release(ctx, thickness), release(ctx, at_fan);
    return status;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double at_share(double *value, int32_t count, double share)
{
    if (count == 0) return NAN;
    qsort(value, (size_t)count, sizeof *value, ascending);
    return value[(int32_t)(share * (count - 1))];
}

agreement compare_fields(int32_t count, const double *ours, const double *theirs)
{
    agreement a = {.points = count};
    double *sorted = malloc(((size_t)count + 1) * sizeof *sorted), off = 0, all = 0;
    memcpy(sorted, theirs, (size_t)count * sizeof *sorted);
    double top = at_share(sorted, count, 0.95);
    memcpy(sorted, ours, (size_t)count * sizeof *sorted);
    a.p95 = at_share(sorted, count, 0.95) / top;
    int32_t large = 0;
    for (int32_t i = 0; i < count; i++) {
        off += (ours[i] - theirs[i]) * (ours[i] - theirs[i]);
        all += theirs[i] * theirs[i];
        if (!(theirs[i] >= top / 2)) continue;
        sorted[large++] = ours[i] / theirs[i];
        a.within5 += fabs(ours[i] / theirs[i] - 1) <= 0.05;
        a.within10 += fabs(ours[i] / theirs[i] - 1) <= 0.10;
    }
    a.median = at_share(sorted, large, 0.5);
    a.rms = sqrt(off / all);
    a.within5 /= large;
    a.within10 /= large;
    free(sorted);
    return a;
}
