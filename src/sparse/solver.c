// Opening and closing the solver: everything that depends on the pattern alone.
//
// Checked: tests/test_solver.c.
#include "sparse/fronts.h"

#include <dlfcn.h>

// Unknowns of a subtree that one thread eliminates alone. What eight of them leave over is about 60 MB.
enum { SUBTREE = 6000 };

// Threads are ours: inside BLAS they would have to be started anew for each of a million small calls. Not
// every BLAS can be told.
static void single_blas_thread(void)
{
    void (*set_threads)(int);
    void *found = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
    memcpy(&set_threads, &found, sizeof found);
    if (found) set_threads(1);
}

static jali_status own_blocks(jali_context *ctx, solver *s)
{
    jali_status status;
    const block_matrix *a = s->a;
    const int32_t *position = s->order.position;
    TRY(ALLOCATE(ctx, s->own, a->node_count + 2));
    TRY(ALLOCATE(ctx, s->own_block, a->row[a->node_count]));
    TRY(ALLOCATE(ctx, s->own_later, a->row[a->node_count]));
    memset(s->own, 0, ((size_t)a->node_count + 2) * sizeof *s->own);
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t i = 0; i < a->node_count; i++)
            for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
                int32_t k = a->column[b], x = position[i], y = position[k];
                if (i != k && !joins(a, i, k)) continue;
                if (pass == 0) {
                    s->own[MIN(x, y) + 2]++;
                } else {
                    s->own_later[s->own[MIN(x, y) + 1]] = MAX(x, y);
                    s->own_block[s->own[MIN(x, y) + 1]++] = b;
                }
            }
        for (int32_t p = 0; pass == 0 && p < a->node_count; p++) s->own[p + 2] += s->own[p + 1];
    }
done:
    return status;
}

static int32_t unknowns_under(const solver *s, int32_t f)
{
    return s->order.start[s->order.first[f + 1]] - s->order.start[s->order.first[s->begin[f]]];
}

// The largest subtrees that are small.
static void choose_subtrees(solver *s)
{
    const elimination *e = &s->order;
    for (int32_t f = 0; f < e->front_count; f++) s->begin[f] = e->child[f] < 0 ? f : s->begin[e->child[f]];
    for (int32_t f = 0; f < e->front_count; f++)
        if (unknowns_under(s, f) <= SUBTREE &&
            (e->parent[f] < 0 || unknowns_under(s, e->parent[f]) > SUBTREE))
            s->subtree[s->subtree_count++] = f;
}

static double count_flops(const elimination *e)
{
    double flops = 0;
    for (int32_t f = 0; f < e->front_count; f++) {
        double p = pivots_of(e, f), h = e->height[f];
        flops += p * p * p / 3 + p * p * h + p * h * h;
    }
    return flops;
}

const char *solver_name(void)
{
    return "direct";
}

bool solver_leads(void)
{
    return true;
}

bool solver_serves_threads(void)
{
    return true;
}

void solver_share(int32_t node_count, int32_t *from, int32_t *to)
{
    *from = 0;
    *to = node_count;
}

jali_status solver_agree(jali_context *ctx, jali_status status)
{
    (void)ctx;
    return status;
}

jali_status solver_residual(jali_context *ctx, solver *s, const double *x, const double *b, double *r)
{
    (void)ctx;
    block_residual(s->a, x, b, r);
    return JALI_OK;
}

jali_status solver_open(jali_context *ctx, const block_matrix *a, const double (*place)[3], solver **out)
{
    jali_status status;
    solver *s = NULL;
    *out = NULL;
    TRY(step(ctx, "order", 0));
    TRY(allocate_cleared(ctx, &s, 1, sizeof *s));
    s->a = a;
    TRY(eliminate(ctx, a, place, &s->order));
    TRY(own_blocks(ctx, s));
    TRY(ALLOCATE(ctx, s->begin, s->order.front_count));
    TRY(ALLOCATE(ctx, s->subtree, s->order.front_count));
    TRY(ALLOCATE(ctx, s->left, s->order.front_count));
    choose_subtrees(s);
    for (int32_t f = 0; f < s->order.front_count; f++)
        s->most_rows = MAX(s->most_rows, (int32_t)(s->order.row[f + 1] - s->order.row[f]));
    s->flops = count_flops(&s->order);
    TRY(step(ctx, "order", 1));
    *out = s;
done:
    if (status != JALI_OK) solver_close(ctx, s);
    return status;
}

jali_status solver_factor(jali_context *ctx, solver *s, int32_t *weak_row)
{
    jali_status status = JALI_OK;
    size_t entries = (size_t)s->order.panel[s->order.front_count];
    *weak_row = -1;
    single_blas_thread();
    if (!s->factor) {
        TRY(ALLOCATE(ctx, s->factor, entries));
        ask_for_large_pages(s->factor, entries);
    }
    TRY(factor_fronts(ctx, s, weak_row));
done:
    return status;
}

solver_figures solver_cost(const solver *s)
{
    return (solver_figures){s->flops, s->order.panel[s->order.front_count], s->order.front_count};
}

void solver_close(jali_context *ctx, solver *s)
{
    if (!s) return;
    elimination_free(ctx, &s->order);
    release(ctx, s->own);
    release(ctx, s->own_block);
    release(ctx, s->own_later);
    release(ctx, s->begin);
    release(ctx, s->subtree);
    release(ctx, s->factor);
    release(ctx, s->left);
    release(ctx, s);
}
