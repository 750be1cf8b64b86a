// Solutions with a multifrontal factor, and entries of the inverse.
//
// Right sides stand side by side: x[unknown in the order of elimination][right side]. For BLAS, which counts
// by columns, that is a matrix of `count` rows.
//
// Checked: tests/test_solver.c.
#include "sparse/blas.h"
#include "sparse/fronts.h"

#include <stdlib.h>

enum { SIDE_BY_SIDE = 32 }; // right sides that are solved at one time

static const double ONE = 1, MINUS = -1, NONE = 0;
static const int UNIT = 1;

// What the rows below a front's pivots lose to `lost`: those up to `end` in x, those above it where the
// subtree keeps account of them, `rows` ascending positions.
static void spread(const elimination *e, int32_t f, int count, const double *lost, double *x, int32_t end,
                   const int32_t *rows, double *account)
{
    for (int64_t k = e->row[f]; k < e->row[f + 1]; k++) {
        int32_t p = e->below[k], width = (e->start[p + 1] - e->start[p]) * count;
        double *to = x + (size_t)e->start[p] * (size_t)count;
        if (p >= end) {
            for (; *rows < p; rows++) account += (e->start[*rows + 1] - e->start[*rows]) * count;
            to = account;
        }
        for (int32_t i = 0; i < width; i++) to[i] -= *lost++;
    }
}

static void collect(const elimination *e, int32_t f, int count, const double *x, double *below)
{
    for (int64_t k = e->row[f]; k < e->row[f + 1]; k++) {
        int32_t p = e->below[k];
        size_t width = (size_t)(e->start[p + 1] - e->start[p]) * (size_t)count;
        memcpy(below, x + (size_t)e->start[p] * (size_t)count, width * sizeof *below);
        below += width;
    }
}

// x = L11^-1 x, below = L21 x.
static void forward(const front *d, int count, double *x, double *below)
{
    int lead = d->pivots + d->height;
    if (count == 1) {
        dtrsv_("L", "N", "N", &d->pivots, d->panel, &lead, x, &UNIT);
        dgemv_("N", &d->height, &d->pivots, &ONE, d->panel + d->pivots, &lead, x, &UNIT, &NONE, below, &UNIT);
        return;
    }
    dtrsm_("R", "L", "T", "N", &count, &d->pivots, &ONE, d->panel, &lead, x, &count);
    dgemm_("N", "T", &count, &d->height, &d->pivots, &ONE, x, &count, d->panel + d->pivots, &lead, &NONE,
           below, &count);
}

// x = L11^-T (x - L21^T below).
static void backward(const front *d, int count, const double *below, double *x)
{
    int lead = d->pivots + d->height;
    if (count == 1) {
        dgemv_("T", &d->height, &d->pivots, &MINUS, d->panel + d->pivots, &lead, below, &UNIT, &ONE, x,
               &UNIT);
        dtrsv_("L", "T", "N", &d->pivots, d->panel, &lead, x, &UNIT);
        return;
    }
    dgemm_("N", "N", &count, &d->pivots, &d->height, &MINUS, below, &count, d->panel + d->pivots, &lead, &ONE,
           x, &count);
    dtrsm_("R", "L", "N", "N", &count, &d->pivots, &ONE, d->panel, &lead, x, &count);
}

// Between the caller's columns and the order of elimination, a run of positions at a time.
typedef struct carrying {
    const solver *s;
    int32_t count;
    bool in; // towards the order of elimination
    double *by_column, *x;
} carrying;

enum { CARRIED = 2048 };

static void carry_run(void *shared, int32_t run)
{
    const carrying *c = shared;
    const elimination *e = &c->s->order;
    size_t size = (size_t)unknowns_of(c->s->a), count = (size_t)c->count;
    for (int32_t p = run * CARRIED; p < MIN((run + 1) * CARRIED, c->s->a->node_count); p++) {
        int32_t from = c->s->a->first[e->node[p]];
        for (int32_t i = e->start[p]; i < e->start[p + 1]; i++, from++)
            for (size_t k = 0; k < count; k++) {
                double *outside = &c->by_column[k * size + (size_t)from];
                double *inside = &c->x[(size_t)i * count + k];
                *(c->in ? inside : outside) = *(c->in ? outside : inside);
            }
    }
}

static void carry(jali_context *ctx, const solver *s, int32_t count, bool in, double *by_column, double *x)
{
    carrying c = {s, count, in, by_column, x};
    parallel(ctx, (s->a->node_count + CARRIED - 1) / CARRIED, carry_run, &c);
}

// Subtrees are solved side by side, what they take from rows above them kept apart; the fronts above come one
// after the other. The order of all sums is that of the structure, for any number of threads.
typedef struct solving {
    const solver *s;
    int count;
    double *x;
    double *desk;   // of the subtrees: account, then below
    int64_t *begin; // [subtree_count] where a subtree's begins
    int64_t *below; // [subtree_count] and the second part of it
    double *above;  // [tallest * count] below, for the fronts above
} solving;

static bool all_zero(const double *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (x[i] != 0) return false;
    return true;
}

// Where right sides are zero so far, nothing is to be done: loads at a few places leave most fronts alone.
static void forward_front(const solving *v, int32_t f, double *below, int32_t root, double *account)
{
    const elimination *e = &v->s->order;
    front d = front_of(v->s, f);
    double *x = v->x + (size_t)e->start[e->first[f]] * (size_t)v->count;
    if (all_zero(x, (size_t)d.pivots * (size_t)v->count)) return;
    forward(&d, v->count, x, below);
    spread(e, f, v->count, below, v->x, root < 0 ? INT32_MAX : e->first[root + 1],
           root < 0 ? NULL : e->below + e->row[root], account);
}

static void backward_front(const solving *v, int32_t f, double *below)
{
    const elimination *e = &v->s->order;
    front d = front_of(v->s, f);
    if (d.pivots == 0) return;
    collect(e, f, v->count, v->x, below);
    backward(&d, v->count, below, v->x + (size_t)e->start[e->first[f]] * (size_t)v->count);
}

static void forward_subtree(void *shared, int32_t index)
{
    const solving *v = shared;
    int32_t root = v->s->subtree[index];
    double *account = v->desk + v->begin[index];
    memset(account, 0, (size_t)v->s->order.height[root] * (size_t)v->count * sizeof *account);
    for (int32_t f = v->s->begin[root]; f <= root; f++)
        forward_front(v, f, v->desk + v->below[index], root, account);
}

static void backward_subtree(void *shared, int32_t index)
{
    const solving *v = shared;
    int32_t root = v->s->subtree[index];
    for (int32_t f = root; f >= v->s->begin[root]; f--) backward_front(v, f, v->desk + v->below[index]);
}

// What subtrees took from the rows above them.
static void settle_accounts(const solving *v)
{
    const elimination *e = &v->s->order;
    for (int32_t i = 0; i < v->s->subtree_count; i++) {
        int32_t root = v->s->subtree[i];
        const double *account = v->desk + v->begin[i];
        for (int64_t k = e->row[root]; k < e->row[root + 1]; k++) {
            int32_t p = e->below[k], width = (e->start[p + 1] - e->start[p]) * v->count;
            double *to = v->x + (size_t)e->start[p] * (size_t)v->count;
            for (int32_t w = 0; w < width; w++) to[w] += *account++;
        }
    }
}

static void solve_together(jali_context *ctx, solving *v)
{
    const solver *s = v->s;
    int32_t next = 0;
    parallel(ctx, s->subtree_count, forward_subtree, v);
    settle_accounts(v);
    for (int32_t f = 0; f < s->order.front_count; f++)
        if (next < s->subtree_count && f == s->begin[s->subtree[next]])
            f = s->subtree[next++];
        else
            forward_front(v, f, v->above, -1, NULL);
    next = s->subtree_count;
    for (int32_t f = s->order.front_count; f-- > 0;)
        if (next > 0 && f == s->subtree[next - 1])
            f = s->begin[s->subtree[--next]];
        else
            backward_front(v, f, v->above);
    parallel(ctx, s->subtree_count, backward_subtree, v);
}

static int32_t tallest(const elimination *e, int32_t from, int32_t to)
{
    int32_t most = 0;
    for (int32_t f = from; f < to; f++) most = MAX(most, e->height[f]);
    return most;
}

// Room for `count` right sides at a time.
static jali_status lay_desks(jali_context *ctx, const solver *s, int32_t count, solving *v)
{
    jali_status status;
    const elimination *e = &s->order;
    int64_t all = 0;
    *v = (solving){.s = s};
    TRY(ARENA(ctx, v->begin, s->subtree_count + 1));
    TRY(ARENA(ctx, v->below, s->subtree_count + 1));
    for (int32_t i = 0; i < s->subtree_count; i++) {
        int32_t root = s->subtree[i];
        v->begin[i] = all;
        v->below[i] = all + (int64_t)count * e->height[root];
        all = v->below[i] + (int64_t)count * tallest(e, s->begin[root], root + 1);
    }
    TRY(ARENA(ctx, v->desk, (size_t)all + 1));
    TRY(ARENA(ctx, v->above, (size_t)tallest(e, 0, e->front_count) * (size_t)count));
    TRY(ARENA(ctx, v->x, (size_t)unknowns_of(s->a) * (size_t)count));
done:
    return status;
}

jali_status solver_solve(jali_context *ctx, solver *s, int32_t count, double *x)
{
    jali_status status = JALI_OK;
    arena_mark mark = arena_here(ctx);
    size_t size = (size_t)unknowns_of(s->a);
    solving v;
    TRY(lay_desks(ctx, s, MIN(count, SIDE_BY_SIDE), &v));
    for (int32_t i = 0; i < count; i += SIDE_BY_SIDE) {
        v.count = MIN(SIDE_BY_SIDE, count - i);
        TRY(step(ctx, "solve", (double)i / count));
        carry(ctx, s, v.count, true, x + (size_t)i * size, v.x);
        solve_together(ctx, &v);
        carry(ctx, s, v.count, false, x + (size_t)i * size, v.x);
    }
    TRY(step(ctx, "solve", 1));
done:
    arena_rewind(ctx, mark);
    return status;
}

// An unknown whose column of the inverse is asked for.
typedef struct chosen {
    int32_t eliminated; // its place in the order of elimination
    int32_t unknown;
} chosen;

static int by_place(const void *a, const void *b)
{
    int32_t x = ((const chosen *)a)->eliminated, y = ((const chosen *)b)->eliminated;
    return (x > y) - (x < y);
}

static int by_unknown(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

// Rows and columns that are asked for, each once, in the order of elimination.
static int32_t choose(const solver *s, int32_t count, int32_t *unknown, chosen *list)
{
    int32_t kept = 0, node = 0;
    qsort(unknown, (size_t)count, sizeof *unknown, by_unknown);
    for (int32_t i = 0; i < count; i++) {
        if (i > 0 && unknown[i] == unknown[i - 1]) continue;
        while (s->a->first[node + 1] <= unknown[i]) node++;
        int32_t place = s->order.start[s->order.position[node]] + unknown[i] - s->a->first[node];
        list[kept++] = (chosen){place, unknown[i]};
    }
    qsort(list, (size_t)kept, sizeof *list, by_place);
    return kept;
}

// W = L^-1 P goes up the forest front by front. A subtree is a run of the order: the columns of P that have
// begun in it are a run of the list, [from, to), and the others are zero there. What F = W^T W gets from a
// front is its pivots' part.
typedef struct climb {
    const solver *s;
    const chosen *list;
    int32_t count;
    double *f;          // [count][count] by columns, lower half
    double **left;      // [front_count] what a front leaves for its parent: [height][to - from]
    int32_t (*part)[2]; // [front_count] from, to
    row_run *run;
} climb;

static jali_status climb_front(jali_context *ctx, climb *w, int32_t f)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const elimination *e = &w->s->order;
    front d = front_of(w->s, f);
    int32_t from = w->part[f][0], count = w->part[f][1] - from, base = e->start[e->first[f]];
    size_t rows = (size_t)d.pivots + (size_t)d.height, width = (size_t)count;
    double *x;
    TRY(ARENA(ctx, x, rows * width));
    TRY(ALLOCATE(ctx, w->left[f], (size_t)d.height * width));
    memset(x, 0, rows * width * sizeof *x);
    for (int32_t c = from; c < from + count; c++)
        if (w->list[c].eliminated >= base)
            x[(size_t)(w->list[c].eliminated - base) * width + (size_t)(c - from)] = 1;
    for (int32_t c = e->child[f]; c >= 0; c = e->next[c]) {
        if (!w->left[c]) continue;
        int32_t runs = match_rows(e, c, f, w->run), some = w->part[c][1] - w->part[c][0];
        const double *value = w->left[c];
        for (int32_t r = 0; r < runs; r++)
            for (int32_t i = 0; i < w->run[r].count; i++) {
                double *to = x + (size_t)(w->run[r].to + i) * width + (w->part[c][0] - from);
                for (int32_t k = 0; k < some; k++) to[k] -= *value++;
            }
        release(ctx, w->left[c]);
        w->left[c] = NULL;
    }
    forward(&d, count, x, w->left[f]);
    // forward gives L21 x: what the children handed up is taken from it.
    for (size_t i = 0; i < (size_t)d.height * width; i++) w->left[f][i] -= x[(size_t)d.pivots * width + i];
    dsyrk_("L", "N", &count, &d.pivots, &ONE, x, &count, &ONE, w->f + (size_t)from * (size_t)w->count + from,
           &w->count);
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status climb_all(jali_context *ctx, climb *w)
{
    jali_status status = JALI_OK;
    const elimination *e = &w->s->order;
    int32_t begun = 0;
    for (int32_t f = 0; f < e->front_count; f++) {
        int32_t end = e->start[e->first[f + 1]];
        w->part[f][0] = begun;
        while (begun < w->count && w->list[begun].eliminated < end) begun++;
        if (e->child[f] >= 0) w->part[f][0] = w->part[e->child[f]][0];
        w->part[f][1] = begun;
        if (w->part[f][0] < begun) TRY(climb_front(ctx, w, f));
    }
done:
    for (int32_t f = 0; f < e->front_count; f++) release(ctx, w->left[f]);
    return status;
}

// Where in the list each of the wanted unknowns is.
static void find_places(const chosen *list, int32_t count, int32_t wanted_count, const int32_t *wanted,
                        int32_t *place)
{
    for (int32_t i = 0; i < wanted_count; i++)
        for (int32_t k = 0; k < count; k++)
            if (list[k].unknown == wanted[i]) place[i] = k;
}

jali_status solver_inverse(jali_context *ctx, solver *s, int32_t row_count, const int32_t *row,
                           int32_t column_count, const int32_t *column, double *f)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const elimination *e = &s->order;
    size_t all = (size_t)row_count + (size_t)column_count;
    int32_t *unknown, *at_row, *at_column;
    chosen *list;
    climb w = {.s = s};
    TRY(step(ctx, "solve", 0));
    TRY(ARENA(ctx, unknown, all));
    TRY(ARENA(ctx, list, all));
    TRY(ARENA(ctx, at_row, row_count));
    TRY(ARENA(ctx, at_column, column_count));
    memcpy(unknown, row, (size_t)row_count * sizeof *row);
    memcpy(unknown + row_count, column, (size_t)column_count * sizeof *column);
    w.count = choose(s, (int32_t)all, unknown, list);
    w.list = list;
    TRY(ARENA(ctx, w.f, (size_t)w.count * (size_t)w.count));
    TRY(ARENA(ctx, w.left, e->front_count));
    TRY(ARENA(ctx, w.part, e->front_count));
    TRY(ARENA(ctx, w.run, tallest(e, 0, e->front_count)));
    memset(w.f, 0, (size_t)w.count * (size_t)w.count * sizeof *w.f);
    memset(w.left, 0, (size_t)e->front_count * sizeof *w.left);
    TRY(climb_all(ctx, &w));
    find_places(list, w.count, row_count, row, at_row);
    find_places(list, w.count, column_count, column, at_column);
    for (int32_t c = 0; c < column_count; c++)
        for (int32_t r = 0; r < row_count; r++) {
            size_t low = (size_t)MAX(at_row[r], at_column[c]), high = (size_t)MIN(at_row[r], at_column[c]);
            f[(size_t)c * (size_t)row_count + (size_t)r] = w.f[high * (size_t)w.count + low];
        }
    TRY(step(ctx, "solve", 1));
done:
    arena_rewind(ctx, mark);
    return status;
}
