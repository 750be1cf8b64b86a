// The order of elimination and its fronts.
//
// Source:  J. Liu, The role of elimination trees in sparse factorization, 1990; T. Davis, Direct Methods for
// Sparse
//          Linear Systems, 2006, chapter 4. Fronts that nearly fit are joined as in CHOLMOD (Chen, Davis,
//          Hager and Rajamanickam 2008, section 3.4): larger dense matrices for a few zeros. All of it on
//          nodes; unknowns come in at the end as widths.
// Checked: tests/test_solver.c.
#include "sparse/elimination.h"

#include <stdlib.h>

// The pattern by rows of the order: row i holds the earlier positions it touches.
typedef struct ordered_pattern {
    int32_t count;
    int32_t *first;  // [count + 1]
    int32_t *column; // [first[count]]
} ordered_pattern;

void elimination_free(jali_context *ctx, elimination *e)
{
    release(ctx, e->node);
    release(ctx, e->position);
    release(ctx, e->start);
    release(ctx, e->first);
    release(ctx, e->parent);
    release(ctx, e->child);
    release(ctx, e->next);
    release(ctx, e->row);
    release(ctx, e->below);
    release(ctx, e->height);
    release(ctx, e->panel);
    *e = (elimination){0};
}

static void place_nodes(elimination *e, int32_t count)
{
    for (int32_t i = 0; i < count; i++) e->position[e->node[i]] = i;
}

// From the matrix, in the order that stands in e.
static void order_pattern(const block_matrix *a, const elimination *e, ordered_pattern *p)
{
    memset(p->first, 0, ((size_t)p->count + 2) * sizeof *p->first);
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t i = 0; i < a->node_count; i++)
            for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
                int32_t k = a->column[b], x = e->position[i], y = e->position[k];
                if (!joins(a, i, k)) continue;
                if (pass == 0)
                    p->first[MAX(x, y) + 2]++;
                else
                    p->column[p->first[MAX(x, y) + 1]++] = MIN(x, y);
            }
        for (int32_t i = 0; pass == 0 && i < p->count; i++) p->first[i + 2] += p->first[i + 1];
    }
}

// Liu's algorithm: parents in the elimination tree; shortcuts in `ancestor`.
static void grow_tree(const ordered_pattern *p, int32_t *parent, int32_t *ancestor)
{
    for (int32_t i = 0; i < p->count; i++) {
        parent[i] = ancestor[i] = -1;
        for (int32_t e = p->first[i]; e < p->first[i + 1]; e++)
            for (int32_t k = p->column[e], next; k >= 0 && k < i; k = next) {
                next = ancestor[k];
                ancestor[k] = i;
                if (next < 0) parent[k] = i;
            }
    }
}

// Number the tree so that each subtree is a run and ends with its root: rank[i] is when i comes. Runs are
// handed out from the back: `left` is where the run that a node's other children share ends.
static void postorder(int32_t count, const int32_t *parent, int32_t *size, int32_t *left, int32_t *rank)
{
    int32_t all_left = count;
    for (int32_t i = 0; i < count; i++) size[i] = 1;
    for (int32_t i = 0; i < count; i++)
        if (parent[i] >= 0) size[parent[i]] += size[i];
    for (int32_t i = count; i-- > 0;) {
        int32_t *from = parent[i] >= 0 ? &left[parent[i]] : &all_left;
        rank[i] = left[i] = *from - 1;
        *from -= size[i];
    }
}

// How many rows each column of the factor has below its diagonal: row i is met along the paths from its
// columns up to i.
static void count_rows(const ordered_pattern *p, const int32_t *parent, int32_t *seen, int32_t *rows)
{
    for (int32_t i = 0; i < p->count; i++) {
        seen[i] = i;
        rows[i] = 0;
        for (int32_t e = p->first[i]; e < p->first[i + 1]; e++)
            for (int32_t k = p->column[e]; seen[k] != i; k = parent[k]) {
                rows[k]++;
                seen[k] = i;
            }
    }
}

// A front while fronts are being joined, in unknowns.
typedef struct draft {
    int32_t first, last; // positions
    double pivots, below, zeros;
} draft;

static double entries_of(const draft *d)
{
    return d->pivots * (d->pivots + 1) / 2 + d->pivots * d->below;
}

// Joining pays while few zeros come in: bounds on their share by width, as CHOLMOD has them.
static bool worth_joining(const draft *child, const draft *next, draft *joined)
{
    *joined = (draft){.first = child->first,
                      .last = next->last,
                      .pivots = child->pivots + next->pivots,
                      .below = next->below};
    joined->zeros =
        entries_of(joined) - (entries_of(child) - child->zeros) - (entries_of(next) - next->zeros);
    double share = joined->zeros / (entries_of(joined) + 1), width = joined->pivots;
    return width <= 12 || (width <= 24 && share < 0.6) || (width <= 64 && share < 0.15) || share < 0.05;
}

// Columns of one pattern make a front; then fronts are joined with the one that follows, where it is the
// parent.
static int32_t draft_fronts(const elimination *e, int32_t count, const int32_t *parent, const int32_t *rows,
                            draft *fronts)
{
    int32_t made = 0;
    for (int32_t i = 0; i < count; i++) {
        double width = e->start[i + 1] - e->start[i], below = 0;
        if (parent[i] >= 0) below = (double)rows[i] * (e->start[count] - e->start[i + 1]) / (count - i - 1);
        bool same = i > 0 && parent[i - 1] == i && rows[i - 1] == rows[i] + 1;
        if (!same) fronts[made++] = (draft){.first = i};
        fronts[made - 1].last = i;
        fronts[made - 1].pivots += width;
        fronts[made - 1].below = below;
    }
    int32_t kept = 0;
    for (int32_t f = 0; f < made; f++) {
        fronts[kept++] = fronts[f];
        draft joined;
        while (kept > 1 && parent[fronts[kept - 2].last] >= fronts[kept - 1].first &&
               parent[fronts[kept - 2].last] <= fronts[kept - 1].last &&
               worth_joining(&fronts[kept - 2], &fronts[kept - 1], &joined))
            fronts[--kept - 1] = joined;
    }
    return kept;
}

static void link_fronts(elimination *e, const int32_t *parent, const draft *fronts, int32_t *front_of)
{
    for (int32_t f = 0; f < e->front_count; f++) {
        e->first[f] = fronts[f].first;
        e->child[f] = e->next[f] = -1;
        for (int32_t i = fronts[f].first; i <= fronts[f].last; i++) front_of[i] = f;
    }
    for (int32_t f = e->front_count; f-- > 0;) {
        int32_t above = parent[fronts[f].last];
        e->parent[f] = above < 0 ? -1 : front_of[above];
        if (above < 0) continue;
        e->next[f] = e->child[front_of[above]];
        e->child[front_of[above]] = f;
    }
}

static int ascending(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

// Rows below a front's pivots: of its columns in the matrix (`later`), and of its children.
static int64_t gather_rows(const elimination *e, int32_t f, const ordered_pattern *later, int32_t *seen,
                           int32_t *row)
{
    int64_t count = 0;
    int32_t end = e->first[f + 1];
    for (int32_t i = e->first[f]; i < end; i++)
        for (int32_t k = later->first[i]; k < later->first[i + 1]; k++) {
            int32_t to = later->column[k];
            if (to < end || seen[to] == f) continue;
            seen[to] = f;
            row[count++] = to;
        }
    for (int32_t c = e->child[f]; c >= 0; c = e->next[c])
        for (int64_t k = e->row[c]; k < e->row[c + 1]; k++) {
            int32_t to = e->below[k];
            if (to < end || seen[to] == f) continue;
            seen[to] = f;
            row[count++] = to;
        }
    qsort(row, (size_t)count, sizeof *row, ascending);
    return count;
}

// The pattern by columns: position i holds the later ones it touches.
static void turn_over(const ordered_pattern *p, ordered_pattern *later)
{
    memset(later->first, 0, ((size_t)p->count + 2) * sizeof *later->first);
    for (int32_t e = 0; e < p->first[p->count]; e++) later->first[p->column[e] + 2]++;
    for (int32_t i = 0; i < p->count; i++) later->first[i + 2] += later->first[i + 1];
    for (int32_t i = 0; i < p->count; i++)
        for (int32_t e = p->first[i]; e < p->first[i + 1]; e++)
            later->column[later->first[p->column[e] + 1]++] = i;
}

static jali_status lay_fronts(jali_context *ctx, elimination *e, const ordered_pattern *p)
{
    jali_status status;
    ordered_pattern later = {.count = p->count};
    int32_t *seen, *row;
    size_t capacity = 0;
    TRY(ARENA(ctx, later.first, p->count + 2));
    TRY(ARENA(ctx, later.column, p->first[p->count]));
    TRY(ARENA(ctx, seen, p->count));
    TRY(ARENA(ctx, row, p->count));
    turn_over(p, &later);
    for (int32_t i = 0; i < p->count; i++) seen[i] = -1;
    e->row[0] = e->panel[0] = 0;
    for (int32_t f = 0; f < e->front_count; f++) {
        int64_t count = gather_rows(e, f, &later, seen, row), pivots = pivots_of(e, f);
        TRY(GROW(ctx, e->below, capacity, e->row[f] + count + 1));
        memcpy(e->below + e->row[f], row, (size_t)count * sizeof *row);
        e->row[f + 1] = e->row[f] + count;
        e->height[f] = 0;
        for (int64_t k = 0; k < count; k++) e->height[f] += e->start[row[k] + 1] - e->start[row[k]];
        e->panel[f + 1] = e->panel[f] + pivots * (pivots + e->height[f]);
    }
done:
    return status;
}

static jali_status allocate_order(jali_context *ctx, elimination *e, int32_t count)
{
    jali_status status;
    TRY(ALLOCATE(ctx, e->node, count));
    TRY(ALLOCATE(ctx, e->position, count));
    TRY(ALLOCATE(ctx, e->start, count + 1));
done:
    return status;
}

static jali_status allocate_fronts(jali_context *ctx, elimination *e, int32_t count)
{
    jali_status status;
    e->front_count = count;
    TRY(ALLOCATE(ctx, e->first, count + 1));
    TRY(ALLOCATE(ctx, e->parent, count));
    TRY(ALLOCATE(ctx, e->child, count));
    TRY(ALLOCATE(ctx, e->next, count));
    TRY(ALLOCATE(ctx, e->row, count + 1));
    TRY(ALLOCATE(ctx, e->height, count));
    TRY(ALLOCATE(ctx, e->panel, count + 1));
done:
    return status;
}

// Follow the tree of the order: the same fill, and each subtree a run.
static void reorder(const block_matrix *a, elimination *e, const int32_t *parent, int32_t *scratch[3])
{
    int32_t count = a->node_count, *rank = scratch[2];
    postorder(count, parent, scratch[0], scratch[1], rank);
    memcpy(scratch[0], e->node, (size_t)count * sizeof *e->node);
    for (int32_t i = 0; i < count; i++) e->node[rank[i]] = scratch[0][i];
    place_nodes(e, count);
    e->start[0] = 0;
    for (int32_t i = 0; i < count; i++)
        e->start[i + 1] = e->start[i] + a->first[e->node[i] + 1] - a->first[e->node[i]];
}

jali_status eliminate(jali_context *ctx, const block_matrix *a, const double (*place)[3], elimination *e)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t count = a->node_count, *parent, *scratch[3];
    ordered_pattern p = {.count = count};
    draft *fronts;
    *e = (elimination){0};
    TRY(allocate_order(ctx, e, count));
    TRY(dissect(ctx, a, place, e->node));
    TRY(ARENA(ctx, p.first, count + 2));
    TRY(ARENA(ctx, p.column, a->row[count]));
    TRY(ARENA(ctx, parent, count));
    TRY(ARENA(ctx, fronts, count));
    for (int i = 0; i < 3; i++) TRY(ARENA(ctx, scratch[i], count));
    place_nodes(e, count);
    order_pattern(a, e, &p);
    grow_tree(&p, parent, scratch[0]);
    reorder(a, e, parent, scratch);
    order_pattern(a, e, &p);
    grow_tree(&p, parent, scratch[0]);
    count_rows(&p, parent, scratch[0], scratch[1]);
    TRY(allocate_fronts(ctx, e, draft_fronts(e, count, parent, scratch[1], fronts)));
    e->first[e->front_count] = count;
    link_fronts(e, parent, fronts, scratch[2]);
    TRY(lay_fronts(ctx, e, &p));
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) elimination_free(ctx, e);
    return status;
}
