// A multifrontal Cholesky factor.
//
// Source:  Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations, 1983; J.
// Liu, The
//          multifrontal method for sparse matrix solution: theory and practice, 1992.
// How:     small subtrees are given to threads whole, a few at a time, each on a stack of its own; the fronts
// above
//          them come one after the other, and threads share the dense work inside. What is a small subtree
//          depends on the structure alone: any number of threads gives the same bytes.
// Limits:  in memory.
// Checked: tests/test_solver.c.
#include "sparse/fronts.h"

#include <sys/mman.h>

// Subtrees a batch: what they leave over waits in memory for their parents.
enum { BATCH = 8, SPARES = 64 };

// A pivot this small against its diagonal in A is rounding alone.
static const double LEAST_PIVOT = 1e-15;

// What eliminating fronts one after the other needs beside the factor.
typedef struct desk {
    double
        *stack; // what fronts left over, of which parents take from the top; NULL: each in memory of its own
    size_t used;
    int32_t *offset; // [most rows of a front] where they are, in unknowns
    row_run *run;    // [most rows of a front]
} desk;

typedef struct batch {
    solver *s;
    const int32_t *root; // of each subtree
    desk desk[BATCH];
    double *result[BATCH]; // what the root leaves over
    int32_t weak[BATCH];   // unknown in the order of elimination; -1: none
} batch;

void ask_for_large_pages(double *block, size_t count)
{
    uintptr_t page = 1 << 21, begin = ((uintptr_t)block + page - 1) / page * page;
    uintptr_t end = (uintptr_t)(block + count) / page * page;
    if (end > begin) madvise((void *)begin, end - begin, MADV_HUGEPAGE);
}

// A block of memory that no front uses at the moment.
typedef struct spare_block {
    size_t size;
    double *block;
} spare_block;

// All that a factorisation needs beside the factor.
typedef struct workshop {
    batch batch;
    desk above; // for the fronts above the subtrees; no stack
    spare_block spare[SPARES];
    int spare_count;
} workshop;

static size_t square(int32_t n)
{
    return (size_t)n * (size_t)n;
}

// Where a front's later rows are, in unknowns from its first pivot.
static void lay_offsets(const elimination *e, int32_t f, int32_t *offset)
{
    int32_t past = pivots_of(e, f);
    for (int64_t k = e->row[f]; k < e->row[f + 1]; k++) {
        offset[k - e->row[f]] = past;
        past += e->start[e->below[k] + 1] - e->start[e->below[k]];
    }
}

static int32_t offset_of(const elimination *e, int32_t f, const int32_t *offset, int32_t position)
{
    if (position < e->first[f + 1]) return e->start[position] - e->start[e->first[f]];
    const int32_t *below = e->below + e->row[f];
    int64_t low = 0, high = e->row[f + 1] - e->row[f];
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (below[middle] < position)
            low = middle + 1;
        else
            high = middle;
    }
    return offset[low];
}

// Put a block of A where its later node has the rows and its earlier one the columns.
static void place_block(const block_matrix *a, int64_t block, bool turned, int32_t rows, int32_t columns,
                        int32_t lead, double *to)
{
    const double *value = a->value + a->entry[block];
    for (int32_t r = 0; r < rows; r++)
        for (int32_t c = 0; c < columns; c++)
            to[(size_t)c * (size_t)lead + (size_t)r] = value[turned ? c * rows + r : r * columns + c];
}

// Clear a front's panel and put A's entries there.
static void place_matrix(const solver *s, int32_t f, const front *d, int32_t *offset)
{
    const elimination *e = &s->order;
    const block_matrix *a = s->a;
    int32_t lead = d->pivots + d->height;
    memset(d->panel, 0, (size_t)lead * (size_t)d->pivots * sizeof *d->panel);
    lay_offsets(e, f, offset);
    for (int32_t p = e->first[f]; p < e->first[f + 1]; p++) {
        int32_t column = e->start[p] - e->start[e->first[f]], width = e->start[p + 1] - e->start[p];
        for (int64_t k = s->own[p]; k < s->own[p + 1]; k++) {
            int32_t later = s->own_later[k], rows = e->start[later + 1] - e->start[later];
            double *to = d->panel + (size_t)column * (size_t)lead;
            if (later != p) {
                bool turned = a->column[s->own_block[k]] == e->node[later];
                place_block(a, s->own_block[k], turned, rows, width, lead,
                            to + offset_of(e, f, offset, later));
                continue;
            }
            const double *value = a->value + a->entry[s->own_block[k]];
            for (int32_t r = 0; r < width; r++)
                for (int32_t c = 0; c <= r; c++)
                    to[(size_t)c * (size_t)lead + (size_t)(column + r)] = *value++;
        }
    }
}

typedef struct addition {
    const front *f;
    const double *left;
    int32_t height, run_count;
    const row_run *run;
} addition;

static void add_run(void *shared, int32_t index)
{
    const addition *d = shared;
    front_add(d->f, d->left, d->height, d->run, d->run_count, index);
}

// Add what the children left over, the first child first.
static void add_children(jali_context *ctx, const solver *s, int32_t f, const front *d, row_run *run)
{
    for (int32_t c = s->order.child[f]; c >= 0; c = s->order.next[c]) {
        addition add = {d, s->left[c], s->order.height[c], match_rows(&s->order, c, f, run), run};
        if (ctx) {
            parallel(ctx, add.run_count, add_run, &add);
        } else {
            for (int32_t i = 0; i < add.run_count; i++) add_run(&add, i);
        }
    }
}

// A pivot that is too small against what it was in A; as an unknown in the order of elimination, -1: none.
static int32_t weak_pivot(const solver *s, int32_t f, const front *d)
{
    const elimination *e = &s->order;
    size_t lead = (size_t)(d->pivots + d->height), column = 0;
    for (int32_t p = e->first[f]; p < e->first[f + 1]; p++) {
        const double *value = s->a->value + s->a->entry[s->a->row[e->node[p] + 1] - 1];
        for (int32_t r = 0; r < e->start[p + 1] - e->start[p]; r++, column++, value += r + 1) {
            double pivot = d->panel[column * lead + column];
            if (!(pivot * pivot > LEAST_PIVOT * *value)) return e->start[p] + r;
        }
    }
    return -1;
}

// One front: the weak unknown, or -1.
static int32_t eliminate_front(jali_context *ctx, solver *s, int32_t f, front *d, const desk *w)
{
    place_matrix(s, f, d, w->offset);
    bool fresh = s->order.child[f] < 0;
    if (!fresh) memset(d->rest, 0, square(d->height) * sizeof *d->rest);
    add_children(ctx, s, f, d, w->run);
    int32_t failed = front_eliminate(ctx, d, fresh);
    return failed >= 0 ? s->order.start[s->order.first[f]] + failed : weak_pivot(s, f, d);
}

// A subtree on its stack. A front is laid on top of what its children left, and moved down once these are
// taken.
static void eliminate_subtree(void *shared, int32_t index)
{
    batch *b = shared;
    solver *s = b->s;
    desk *w = &b->desk[index];
    int32_t root = b->root[index];
    for (int32_t f = s->begin[root]; f <= root && b->weak[index] < 0; f++) {
        front d = front_of(s, f);
        size_t taken = 0;
        d.rest = w->stack + w->used;
        b->weak[index] = eliminate_front(NULL, s, f, &d, w);
        for (int32_t c = s->order.child[f]; c >= 0; c = s->order.next[c]) taken += square(s->order.height[c]);
        w->used -= taken;
        s->left[f] = w->stack + w->used;
        if (taken > 0) memmove(s->left[f], d.rest, square(d.height) * sizeof *d.rest);
        w->used += square(d.height);
    }
    memcpy(b->result[index], w->stack, square(s->order.height[root]) * sizeof *w->stack);
    s->left[root] = b->result[index];
}

// The highest a subtree's stack gets.
static size_t stack_size(const solver *s, int32_t root)
{
    size_t used = 0, most = 0;
    for (int32_t f = s->begin[root]; f <= root; f++) {
        used += square(s->order.height[f]);
        most = MAX(most, used);
        for (int32_t c = s->order.child[f]; c >= 0; c = s->order.next[c]) used -= square(s->order.height[c]);
    }
    return most;
}

static jali_status lay_desk(jali_context *ctx, const solver *s, size_t stack, desk *w)
{
    jali_status status;
    *w = (desk){0};
    TRY(ARENA(ctx, w->stack, stack));
    ask_for_large_pages(w->stack, stack);
    TRY(ARENA(ctx, w->offset, s->most_rows));
    TRY(ARENA(ctx, w->run, s->most_rows));
done:
    return status;
}

// Desks for the subtrees of a batch, which all batches use, and for the fronts above them.
static jali_status lay_desks(jali_context *ctx, solver *s, workshop *w)
{
    jali_status status;
    size_t stack = 0;
    for (int32_t i = 0; i < s->subtree_count; i++) stack = MAX(stack, stack_size(s, s->subtree[i]));
    for (int32_t i = 0; i < MIN(BATCH, s->subtree_count); i++)
        TRY(lay_desk(ctx, s, stack, &w->batch.desk[i]));
    TRY(lay_desk(ctx, s, 0, &w->above));
done:
    return status;
}

// Blocks come in few sizes, so that one that was given back fits again.
static size_t block_size(int32_t height)
{
    size_t count = square(height), unit = 1;
    while (count / unit >= 8) unit *= 2;
    return (count + unit - 1) / unit * unit;
}

// Memory for what a front leaves over: to touch new memory costs more than the sums that go there.
static jali_status take_block(jali_context *ctx, workshop *w, int32_t height, double **block)
{
    size_t size = block_size(height);
    for (int i = w->spare_count; i-- > 0;) {
        if (w->spare[i].size != size) continue;
        *block = w->spare[i].block;
        w->spare[i] = w->spare[--w->spare_count];
        return JALI_OK;
    }
    jali_status status = ALLOCATE(ctx, *block, size);
    if (status == JALI_OK) ask_for_large_pages(*block, size);
    return status;
}

static void give_block(jali_context *ctx, workshop *w, int32_t height, double *block)
{
    if (block && w->spare_count < SPARES)
        w->spare[w->spare_count++] = (spare_block){block_size(height), block};
    else
        release(ctx, block);
}

static jali_status run_batch(jali_context *ctx, workshop *w, int32_t first, int32_t count, int32_t *weak)
{
    jali_status status = JALI_OK;
    batch *b = &w->batch;
    solver *s = b->s;
    b->root = s->subtree + first;
    for (int32_t i = 0; i < count; i++) {
        b->weak[i] = -1;
        b->desk[i].used = 0;
        TRY(take_block(ctx, w, s->order.height[b->root[i]], &s->left[b->root[i]]));
        b->result[i] = s->left[b->root[i]];
    }
    parallel(ctx, count, eliminate_subtree, b);
    for (int32_t i = 0; i < count && *weak < 0; i++) *weak = b->weak[i];
done:
    return status;
}

static jali_status run_front(jali_context *ctx, workshop *w, int32_t f, int32_t *weak)
{
    solver *s = w->batch.s;
    front d = front_of(s, f);
    jali_status status = take_block(ctx, w, d.height, &s->left[f]);
    if (status != JALI_OK) return status;
    d.rest = s->left[f];
    *weak = eliminate_front(ctx, s, f, &d, &w->above);
    for (int32_t c = s->order.child[f]; c >= 0; c = s->order.next[c]) {
        give_block(ctx, w, s->order.height[c], s->left[c]);
        s->left[c] = NULL;
    }
    return JALI_OK;
}

// Which unknown of A comes as this one in the order of elimination.
static int32_t unknown_of(const solver *s, int32_t eliminated)
{
    int32_t p = 0;
    while (s->order.start[p + 1] <= eliminated) p++;
    return s->a->first[s->order.node[p]] + eliminated - s->order.start[p];
}

// Fronts in their order; those of small subtrees a batch ahead.
static jali_status run_fronts(jali_context *ctx, workshop *w, int32_t *weak)
{
    jali_status status = JALI_OK;
    const solver *s = w->batch.s;
    const elimination *e = &s->order;
    int32_t subtree = 0, started = 0;
    for (int32_t f = 0; f < e->front_count && *weak < 0;) {
        TRY(step(ctx, "factor", (double)e->panel[f] / (double)(e->panel[e->front_count] + 1)));
        if (subtree < s->subtree_count && s->begin[s->subtree[subtree]] == f) {
            if (subtree == started) {
                started = MIN(started + BATCH, s->subtree_count);
                TRY(run_batch(ctx, w, subtree, started - subtree, weak));
            }
            f = s->subtree[subtree++] + 1;
        } else {
            TRY(run_front(ctx, w, f++, weak));
        }
    }
done:
    return status;
}

// Roots of subtrees and the fronts above them have blocks of their own; the pointers of others lead into
// desks.
static void clear_away(jali_context *ctx, workshop *w)
{
    solver *s = w->batch.s;
    for (int32_t i = 0, f = 0; f < s->order.front_count; f++) {
        bool inside = i < s->subtree_count && f >= s->begin[s->subtree[i]];
        if (!inside || f == s->subtree[i]) release(ctx, s->left[f]);
        i += inside && f == s->subtree[i];
    }
    for (int i = 0; i < w->spare_count; i++) release(ctx, w->spare[i].block);
}

jali_status factor_fronts(jali_context *ctx, solver *s, int32_t *weak_row)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t weak = -1;
    workshop w = {.batch.s = s};
    *weak_row = -1;
    memset(s->left, 0, (size_t)s->order.front_count * sizeof *s->left);
    TRY(lay_desks(ctx, s, &w));
    TRY(run_fronts(ctx, &w, &weak));
    if (weak >= 0) {
        *weak_row = unknown_of(s, weak);
        status = fail(ctx, JALI_NO_RESULT, "a matrix of %d unknowns is not positive definite at unknown %d",
                      unknowns_of(s->a), *weak_row);
        goto done;
    }
    TRY(step(ctx, "factor", 1));
done:
    clear_away(ctx, &w);
    arena_rewind(ctx, mark);
    return status;
}
