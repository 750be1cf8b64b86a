// Connectors as strips of triangles that fit the sheet's own border nodes.
//
// Seen along the span from end 0: the chain of border nodes at end 0 is run through backwards (solid lay on
// its left, now the strip does), so it goes from the strip's left to its right; that of end 1 forwards does
// the same. Columns of nodes between them are straight mixtures; triangles zip from column to column.
// Checked: tests/test_reinforce.c: area, orientation, every end node used once, joined sheets 2-manifold.
#include "reinforce/plank.h"
#include "base/vector.h"

#include <math.h>

enum { LONGEST_CHAIN = 256 };

void plank_free(jali_context *ctx, plank *p)
{
    release(ctx, p->end);
    release(ctx, p->node);
    release(ctx, p->thickness_mm);
    release(ctx, p->triangle);
    *p = (plank){0};
}

typedef struct chain {
    int32_t count;
    int32_t node[LONGEST_CHAIN];
} chain;

// Border nodes within half a width each way along the loop, in the loop's order. False when it is too short.
static bool chain_around(const jali_sheet *sheet, const borders *b, int32_t middle, double width, chain *c)
{
    int32_t back[LONGEST_CHAIN / 2], steps[2] = {0};
    double gone[2] = {0};
    for (int32_t i = middle; gone[0] < width / 2 && steps[0] < LONGEST_CHAIN / 2; i = b->last[i]) {
        int32_t j = b->last[i];
        if (j < 0 || j == middle || !(sheet->border[j] & JALI_BORDER_VOID)) return false;
        gone[0] += distance(sheet->node[i], sheet->node[j]);
        back[steps[0]++] = j;
    }
    c->count = 0;
    for (int32_t k = steps[0]; k > 0; k--) c->node[c->count++] = back[k - 1];
    c->node[c->count++] = middle;
    for (int32_t i = middle; gone[1] < width / 2 && c->count < LONGEST_CHAIN; i = b->next[i], steps[1]++) {
        int32_t j = b->next[i];
        if (j < 0 || j == middle || !(sheet->border[j] & JALI_BORDER_VOID)) return false;
        gone[1] += distance(sheet->node[i], sheet->node[j]);
        c->node[c->count++] = j;
    }
    return gone[0] >= width / 2 && gone[1] >= width / 2;
}

static bool share_a_node(const chain *a, const chain *b)
{
    for (int32_t i = 0; i < a->count; i++)
        for (int32_t j = 0; j < b->count; j++)
            if (a->node[i] == b->node[j]) return true;
    return false;
}

static void reverse(chain *c)
{
    for (int32_t i = 0, j = c->count - 1; i < j; i++, j--) {
        int32_t swap = c->node[i];
        c->node[i] = c->node[j];
        c->node[j] = swap;
    }
}

// The place a share of the way along a chain, by nodes.
static void along_chain(const jali_sheet *sheet, const chain *c, double share, double at[3],
                        double *thickness)
{
    double place = share * (c->count - 1);
    int32_t i = MIN((int32_t)place, c->count - 2);
    const int32_t from = c->node[i], to = c->node[i + 1];
    for (int k = 0; k < 3; k++)
        at[k] = sheet->node[from][k] + (place - i) * (sheet->node[to][k] - sheet->node[from][k]);
    *thickness =
        sheet->thickness_mm[from] + (place - i) * (sheet->thickness_mm[to] - sheet->thickness_mm[from]);
}

// A column of the strip: its nodes' numbers run from first on.
typedef struct column {
    int32_t first, count;
} column;

// Between two columns: does the next triangle stand on the first one? Whichever next corner lies further
// back.
static bool zip_on_first(int32_t i, int32_t i_count, int32_t j, int32_t j_count)
{
    return j + 1 == j_count ||
           (i + 1 < i_count && (int64_t)(i + 1) * (j_count - 1) <= (int64_t)(j + 1) * (i_count - 1));
}

static void zip(plank *p, column a, column b)
{
    for (int32_t i = 0, j = 0; i + 1 < a.count || j + 1 < b.count;) {
        bool on_a = zip_on_first(i, a.count, j, b.count);
        int32_t *t = p->triangle[p->triangle_count++];
        t[0] = a.first + i;
        t[1] = on_a ? a.first + i + 1 : b.first + j + 1;
        t[2] = b.first + j;
        i += on_a;
        j += !on_a;
    }
}

static jali_status fill_plank(jali_context *ctx, const jali_sheet *sheet, const chain c[2], int32_t across,
                              int32_t columns, plank *p)
{
    jali_status status;
    p->end_count = c[0].count + c[1].count;
    p->node_count = p->end_count + columns * (across + 1);
    int32_t most = 2 * (columns + 1) * (MAX(across + 1, MAX(c[0].count, c[1].count)));
    TRY(ALLOCATE(ctx, p->end, p->end_count));
    TRY(ALLOCATE(ctx, p->node, p->node_count));
    TRY(ALLOCATE(ctx, p->thickness_mm, p->node_count));
    TRY(ALLOCATE(ctx, p->triangle, most));
    for (int32_t i = 0; i < p->end_count; i++) {
        p->end[i] = i < c[0].count ? c[0].node[i] : c[1].node[i - c[0].count];
        memcpy(p->node[i], sheet->node[p->end[i]], sizeof *p->node);
        p->thickness_mm[i] = sheet->thickness_mm[p->end[i]];
    }
    column last = {0, c[0].count};
    for (int32_t m = 0; m < columns; m++) {
        column here = {p->end_count + m * (across + 1), across + 1};
        double way = (double)(m + 1) / (columns + 1);
        for (int32_t i = 0; i <= across; i++) {
            double from[3], to[3], thickness[2];
            along_chain(sheet, &c[0], (double)i / across, from, &thickness[0]);
            along_chain(sheet, &c[1], (double)i / across, to, &thickness[1]);
            for (int k = 0; k < 3; k++) p->node[here.first + i][k] = from[k] + way * (to[k] - from[k]);
            p->thickness_mm[here.first + i] = thickness[0] + way * (thickness[1] - thickness[0]);
        }
        zip(p, last, here);
        last = here;
    }
    zip(p, last, (column){c[0].count, c[1].count});
done:
    return status;
}

// Does a triangle face the way `up` does, and is no thinner than a hundredth of its longest side?
static bool well_shaped(const double *a, const double *b, const double *c, const double up[3])
{
    double n[3], longest = fmax(distance(a, b), fmax(distance(b, c), distance(c, a)));
    area_vector(a, b, c, n);
    return dot(n, up) > 0 && 2 * sqrt(dot(n, n)) >= 0.01 * longest * longest;
}

static bool all_well_shaped(const plank *p)
{
    double up[3];
    for (int32_t t = 0; t < p->triangle_count; t++) {
        const int32_t *c = p->triangle[t];
        if (t == 0) area_vector(p->node[c[0]], p->node[c[1]], p->node[c[2]], up);
        if (!well_shaped(p->node[c[0]], p->node[c[1]], p->node[c[2]], up)) return false;
    }
    return true;
}

// Both chains, from the strip's left to its right.
static bool find_chains(const jali_sheet *sheet, const borders *b, const span *s, chain c[2])
{
    if (!chain_around(sheet, b, s->node[0], s->width_mm, &c[0]) ||
        !chain_around(sheet, b, s->node[1], s->width_mm, &c[1]) || share_a_node(&c[0], &c[1]))
        return false;
    reverse(&c[0]);
    return true;
}

bool plank_has_room(const jali_sheet *sheet, const borders *b, const span *s)
{
    chain c[2];
    double up[3];
    if (!find_chains(sheet, b, s, c)) return false;
    // The strip without columns of its own: if that is wound as it should be all along, so is the strip.
    for (int32_t i = 0, j = 0; i + 1 < c[0].count || j + 1 < c[1].count;) {
        bool on_a = zip_on_first(i, c[0].count, j, c[1].count);
        const double *p = sheet->node[c[0].node[i]], *q = sheet->node[c[1].node[j]],
                     *r = sheet->node[on_a ? c[0].node[i + 1] : c[1].node[j + 1]];
        if (i + j == 0) area_vector(p, r, q, up);
        if (!well_shaped(p, r, q, up)) return false;
        i += on_a;
        j += !on_a;
    }
    return true;
}

jali_status plank_create(jali_context *ctx, const jali_sheet *sheet, const borders *b, const span *s,
                         plank *p)
{
    chain c[2];
    *p = (plank){0};
    if (!find_chains(sheet, b, s, c)) return JALI_OK;
    int32_t across = MAX(2, MIN(MAX(c[0].count, c[1].count) - 1, 8));
    int32_t columns = MAX(1, MIN(32, (int32_t)ceil(s->length_mm * across / s->width_mm) - 1));
    jali_status status = fill_plank(ctx, sheet, c, across, columns, p);
    if (status != JALI_OK || !all_well_shaped(p)) plank_free(ctx, p);
    return status;
}

jali_status join_planks(jali_context *ctx, const jali_sheet *sheet, const plank *planks, int32_t count,
                        jali_sheet *joined)
{
    jali_status status;
    int64_t nodes = sheet->node_count, triangles = sheet->triangle_count;
    *joined = (jali_sheet){.flat = sheet->flat};
    for (int32_t i = 0; i < count; i++) {
        nodes += planks[i].node_count - planks[i].end_count;
        triangles += planks[i].triangle_count;
    }
    if (MAX(nodes, triangles) > INT32_MAX / 6)
        return fail(ctx, JALI_LIMIT, "a sheet of %lld nodes is too large", (long long)nodes);
    TRY(ALLOCATE(ctx, joined->node, nodes));
    TRY(ALLOCATE(ctx, joined->thickness_mm, nodes));
    TRY(ALLOCATE(ctx, joined->triangle, triangles));
    TRY(ALLOCATE_CLEARED(ctx, joined->border, nodes));
    memcpy(joined->node, sheet->node, (size_t)sheet->node_count * sizeof *joined->node);
    memcpy(joined->thickness_mm, sheet->thickness_mm,
           (size_t)sheet->node_count * sizeof *joined->thickness_mm);
    memcpy(joined->border, sheet->border, (size_t)sheet->node_count);
    memcpy(joined->triangle, sheet->triangle, (size_t)sheet->triangle_count * sizeof *joined->triangle);
    joined->node_count = sheet->node_count;
    joined->triangle_count = sheet->triangle_count;
    for (int32_t i = 0; i < count; i++) {
        const plank *p = &planks[i];
        int32_t own = joined->node_count - p->end_count; // number of the plank's node k >= end_count, less k
        for (int32_t k = p->end_count; k < p->node_count; k++) {
            memcpy(joined->node[own + k], p->node[k], sizeof *p->node);
            joined->thickness_mm[own + k] = p->thickness_mm[k];
            joined->border[own + k] = JALI_BORDER_VOID;
        }
        for (int32_t t = 0; t < p->triangle_count; t++)
            for (int c = 0; c < 3; c++) {
                int32_t k = p->triangle[t][c];
                joined->triangle[joined->triangle_count + t][c] = k < p->end_count ? p->end[k] : own + k;
            }
        joined->node_count += p->node_count - p->end_count;
        joined->triangle_count += p->triangle_count;
    }
done:
    if (status != JALI_OK) jali_sheet_free(ctx, joined);
    return status;
}
