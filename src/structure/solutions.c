// Displacements under loads: solutions with the factor, between nodes' and system's order.
//
// Checked: tests/test_structure.c: against a dense elimination, over seeds.
#include "structure/assemble.h"

#include <math.h>

void gather_unknowns(const structure *s, const double (*of_node)[NODE_UNKNOWNS], double *x)
{
    for (int32_t p = 0; p < s->sheet->node_count; p++) {
        int32_t node = s->node[p];
        for (int bit = 0; bit < NODE_UNKNOWNS; bit++)
            if (s->active[node] >> bit & 1) *x++ = of_node[node][bit];
    }
}

void scatter_unknowns(const structure *s, const double *x, double (*of_node)[NODE_UNKNOWNS])
{
    for (int32_t p = 0; p < s->sheet->node_count; p++) {
        int32_t node = s->node[p];
        for (int bit = 0; bit < NODE_UNKNOWNS; bit++)
            of_node[node][bit] = s->active[node] >> bit & 1 ? *x++ : 0;
    }
}

double length_of_unknowns(const double *x, int32_t count)
{
    double sum = 0;
    for (int32_t i = 0; i < count; i++) sum += x[i] * x[i];
    return sqrt(sum);
}

// One step of iterative refinement where the residual asks for it; the better of the two is kept.
static jali_status refine(jali_context *ctx, structure *s, const double *b, double *x, double *r, double *y)
{
    jali_status status;
    int32_t count = unknowns_of(&s->k);
    double whole = length_of_unknowns(b, count);
    if (!(whole > 0)) return JALI_OK;
    TRY(solver_residual(ctx, s->solver, x, b, r));
    double residual = length_of_unknowns(r, count) / whole;
    if (residual > GOOD_RESIDUAL) {
        memcpy(y, r, (size_t)count * sizeof *y);
        TRY(solver_solve(ctx, s->solver, 1, y));
        for (int32_t i = 0; i < count; i++) y[i] += x[i];
        TRY(solver_residual(ctx, s->solver, y, b, r));
        double refined = length_of_unknowns(r, count) / whole;
        if (refined < residual) {
            memcpy(x, y, (size_t)count * sizeof *x);
            residual = refined;
        }
    }
    s->residual = MAX(s->residual, residual);
done:
    return status;
}

// Right sides between nodes' and system's order, each by itself.
typedef struct sorting {
    const structure *s;
    const double (*load)[NODE_UNKNOWNS];
    double (*u)[NODE_UNKNOWNS];
    double *x;
} sorting;

static void gather_one(void *shared, int32_t i)
{
    const sorting *w = shared;
    gather_unknowns(w->s, w->load + (size_t)w->s->sheet->node_count * (size_t)i,
                    w->x + (size_t)unknowns_of(&w->s->k) * (size_t)i);
}

static void scatter_one(void *shared, int32_t i)
{
    const sorting *w = shared;
    scatter_unknowns(w->s, w->x + (size_t)unknowns_of(&w->s->k) * (size_t)i,
                     w->u + (size_t)w->s->sheet->node_count * (size_t)i);
}

// Solve side by side; each refined when `refined`.
static jali_status solve_all(jali_context *ctx, structure *s, int32_t count, bool refined,
                             const double (*load)[NODE_UNKNOWNS], double (*u)[NODE_UNKNOWNS])
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    size_t unknowns = (size_t)unknowns_of(&s->k), nodes = (size_t)s->sheet->node_count;
    double *x, *b, *r, *y;
    TRY(ARENA(ctx, x, unknowns * (size_t)count));
    TRY(ARENA(ctx, b, unknowns));
    TRY(ARENA(ctx, r, unknowns));
    TRY(ARENA(ctx, y, unknowns));
    sorting w = {s, load, u, x};
    parallel(ctx, count, gather_one, &w);
    TRY(solver_solve(ctx, s->solver, count, x));
    for (size_t i = 0; refined && i < (size_t)count; i++) {
        gather_unknowns(s, load + nodes * i, b);
        TRY(refine(ctx, s, b, x + unknowns * i, r, y));
    }
    parallel(ctx, count, scatter_one, &w);
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status structure_solve(jali_context *ctx, structure *s, int32_t count,
                            const double (*load)[NODE_UNKNOWNS], double (*u)[NODE_UNKNOWNS])
{
    s->residual = 0;
    return solve_all(ctx, s, count, true, load, u);
}

jali_status structure_influence(jali_context *ctx, structure *s, int32_t count,
                                const double (*load)[NODE_UNKNOWNS], double (*u)[NODE_UNKNOWNS])
{
    return solve_all(ctx, s, count, false, load, u);
}
