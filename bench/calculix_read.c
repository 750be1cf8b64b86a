// Results of CalculiX: blocks of lines " -1", a node in 10 columns, values in 12 columns each; " -3" ends
// one.
//
// Limits:  places are written with six figures: nodes of the sheet must be further apart than that.
#include "calculix_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void calculix_free(calculix_answer *answer)
{
    free(answer->moved_mm);
    free(answer->von_mises);
    *answer = (calculix_answer){0};
}

typedef struct by_x {
    double x;
    int32_t place;
} by_x;

static int compare_x(const void *a, const void *b)
{
    const by_x *p = a, *q = b;
    return p->x != q->x ? (p->x < q->x ? -1 : 1) : (p->place > q->place) - (p->place < q->place);
}

near_index near_index_of(int32_t count, const double (*at)[3])
{
    near_index near = {count, malloc((size_t)count * sizeof *near.order + 1), at};
    by_x *item = malloc((size_t)count * sizeof *item + 1);
    for (int32_t i = 0; i < count; i++) item[i] = (by_x){at[i][0], i};
    qsort(item, (size_t)count, sizeof *item, compare_x);
    for (int32_t i = 0; i < count; i++) near.order[i] = item[i].place;
    free(item);
    return near;
}

int32_t nearest_within(const near_index *near, double x, double y, double radius)
{
    int32_t low = 0, high = near->count, best = -1;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (near->at[near->order[middle]][0] < x - radius)
            low = middle + 1;
        else
            high = middle;
    }
    double least = radius * radius;
    for (; low < near->count && near->at[near->order[low]][0] <= x + radius; low++) {
        const double *p = near->at[near->order[low]];
        double d = (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y);
        if (d > least) continue;
        least = d;
        best = near->order[low];
    }
    return best;
}

// Which node of the sheet each of the file's nodes stands over or under, and at which height.
typedef struct places {
    int32_t count, capacity;
    int32_t *node; // [count] by the file's numbers, -1: none, on a side
    double *z_mm;  // NAN: no such node
} places;

static void put_place(places *p, int32_t number, int32_t node, double z_mm)
{
    if (number >= p->capacity) {
        p->capacity = number + number / 2 + 1024;
        p->node = realloc(p->node, (size_t)p->capacity * sizeof *p->node);
        p->z_mm = realloc(p->z_mm, (size_t)p->capacity * sizeof *p->z_mm);
    }
    for (; p->count <= number; p->count++) {
        p->node[p->count] = -1;
        p->z_mm[p->count] = NAN;
    }
    p->node[number] = node;
    p->z_mm[number] = z_mm;
}

static double von_mises(const double s[6])
{
    double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    return sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

// The next line " -1": the node's number and its values; 0 at the end of the block.
static int32_t next_line(FILE *f, int count, double *value)
{
    char line[256];
    while (fgets(line, sizeof line, f)) {
        if (strncmp(line, " -3", 3) == 0) return 0;
        if (strncmp(line, " -1", 3) != 0 || strlen(line) < 13 + 12 * (size_t)count) continue;
        for (int k = count; k-- > 0;) {
            line[13 + 12 * (k + 1)] = 0; // from the last: columns touch
            value[k] = strtod(line + 13 + 12 * k, NULL);
        }
        line[13] = 0;
        return (int32_t)strtol(line + 3, NULL, 10);
    }
    return 0;
}

static void read_places(FILE *f, const jali_sheet *sheet, places *p, calculix_answer *answer)
{
    near_index near = near_index_of(sheet->node_count, (const double(*)[3])sheet->node);
    double at[3], reach = 0;
    for (int32_t i = 0; i < sheet->node_count; i++)
        reach = fmax(reach, fmax(fabs(sheet->node[i][0]), fabs(sheet->node[i][1])));
    for (int32_t number; (number = next_line(f, 3, at)) > 0; answer->nodes++)
        put_place(p, number, nearest_within(&near, at[0], at[1], 1e-5 * reach), at[2]);
    free(near.order);
}

calculix_answer calculix_read(FILE *f, const jali_sheet *sheet)
{
    char line[256];
    places p = {0};
    double t = sheet->thickness_mm[0], near = 1e-4 * t, value[6];
    calculix_answer a = {.displacement_mm = NAN,
                         .moved_mm = calloc((size_t)sheet->node_count, sizeof *a.moved_mm),
                         .von_mises = calloc((size_t)sheet->node_count, sizeof *a.von_mises)};
    while (fgets(line, sizeof line, f)) {
        if (strncmp(line, "    2C", 6) == 0) read_places(f, sheet, &p, &a);
        if (strncmp(line, " -4  DISP", 9) == 0)
            for (int32_t i; (i = next_line(f, 3, value)) > 0;) {
                a.displacement_mm = fmax(a.displacement_mm, fabs(value[2]));
                if (i < p.count && p.node[i] >= 0 && fabs(p.z_mm[i] - t / 2) < near)
                    a.moved_mm[p.node[i]] = value[2];
            }
        if (strncmp(line, " -4  STRESS", 11) == 0)
            for (int32_t i; (i = next_line(f, 6, value)) > 0;) {
                if (i >= p.count || p.node[i] < 0) continue;
                float *at = a.von_mises[p.node[i]], size = (float)von_mises(value);
                if (fabs(p.z_mm[i] - t) < near) at[0] = size;
                at[1] = fmaxf(at[1], size);
            }
    }
    free(p.node), free(p.z_mm);
    return a;
}
