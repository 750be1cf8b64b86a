// What a candidate bridge would change, from the flexibility at its ends alone.
//
// The structure with its bridges has, at a candidate's ends e, the flexibility Fe = Fee - Fei S (I + F S)^-1
// Fie, with i for the ends that bridges have already. The candidate then pulls with g - S y, y = (I + Fe
// S)^-1 (ue + Fe g), and c.u changes by that pull times the adjoint solution.
//
// Checked: tests/test_attach.c: against attaching it.
#include "structure/attach.h"

#include "sparse/dense.h"

// One candidate at work; all in the arena.
typedef struct trial {
    condensed bridge;
    int32_t all, *row;   // its unknowns and those of the bridges, ascending
    double *column;      // [rank of the bridge][all] entries of the inverse
    double *flexibility; // [rank][rank]
} trial;

static jali_status gather_flexibility(jali_context *ctx, const attachments *a, trial *t)
{
    jali_status status;
    condensed *c = &t->bridge;
    int32_t *own;
    TRY(ARENA(ctx, own, c->rank));
    TRY(ARENA(ctx, t->row, (size_t)a->rank + (size_t)c->rank));
    TRY(ARENA(ctx, t->flexibility, (size_t)c->rank * (size_t)c->rank));
    memcpy(own, c->row, (size_t)c->rank * sizeof *own);
    sort_rows(c->rank, own);
    if (a->rank > 0) memcpy(t->row, a->row, (size_t)a->rank * sizeof *own);
    memcpy(t->row + a->rank, own, (size_t)c->rank * sizeof *own);
    t->all = sort_rows(a->rank + c->rank, t->row);
    TRY(ARENA(ctx, t->column, (size_t)t->all * (size_t)c->rank));
    TRY(solver_inverse(ctx, a->s->solver, t->all, t->row, c->rank, own, t->column));
    for (int32_t i = 0; i < c->rank; i++) c->at[i] = index_of(c->rank, own, c->row[i]);
    for (int32_t i = 0; i < c->rank; i++)
        for (int32_t k = 0; k < c->rank; k++)
            t->flexibility[(size_t)i * (size_t)c->rank + (size_t)k] =
                t->column[(size_t)c->at[i] * (size_t)t->all + (size_t)index_of(t->all, t->row, c->row[k])];
done:
    return status;
}

// Take from the flexibility what the bridges there hold back.
static jali_status stiffen(jali_context *ctx, const attachments *a, const coupling *m, trial *t)
{
    jali_status status = JALI_OK;
    condensed *c = &t->bridge;
    size_t rank = (size_t)c->rank, others = (size_t)a->rank;
    double *across, *held, *pulled;
    if (a->rank == 0) return JALI_OK;
    TRY(ARENA(ctx, across, rank * others)); // Fei
    TRY(ARENA(ctx, held, others * rank));   // (I + F S)^-1 Fie
    TRY(ARENA(ctx, pulled, others * rank)); // S of that, with the sign changed
    for (size_t i = 0; i < rank; i++)
        for (size_t k = 0; k < others; k++) {
            double f =
                t->column[(size_t)c->at[i] * (size_t)t->all + (size_t)index_of(t->all, t->row, a->row[k])];
            across[i * others + k] = held[k * rank + i] = f;
        }
    lu_solve(a->rank, m->matrix, m->pivot, c->rank, held);
    memset(pulled, 0, others * rank * sizeof *pulled);
    for (size_t b = 0; b < a->count; b++) {
        const condensed *o = &a->bridge[b];
        for (int32_t i = 0; i < o->rank; i++)
            for (int32_t k = 0; k < o->rank; k++)
                for (size_t q = 0; q < rank; q++)
                    pulled[(size_t)o->at[i] * rank + q] -=
                        o->stiffness[(size_t)i * (size_t)o->rank + (size_t)k] *
                        held[(size_t)o->at[k] * rank + q];
    }
    add_product(c->rank, a->rank, c->rank, across, others, pulled, rank, t->flexibility, rank);
done:
    return status;
}

// The change of c.u once the candidate pulls.
static jali_status judge(jali_context *ctx, const trial *t, int32_t of_case, const double (*u)[NODE_UNKNOWNS],
                         const double (*adjoint)[NODE_UNKNOWNS], double *change)
{
    jali_status status;
    const condensed *c = &t->bridge;
    size_t rank = (size_t)c->rank;
    const double *g = c->load + (size_t)of_case * rank;
    double *matrix, *y;
    int32_t *pivot;
    *change = 0;
    TRY(ARENA(ctx, matrix, rank * rank));
    TRY(ARENA(ctx, y, rank));
    TRY(ARENA(ctx, pivot, rank));
    memset(matrix, 0, rank * rank * sizeof *matrix);
    for (size_t i = 0; i < rank; i++) {
        matrix[i * rank + i] = 1;
        y[i] = u[c->end[i][0]][c->end[i][1]];
    }
    add_product(c->rank, c->rank, c->rank, t->flexibility, rank, c->stiffness, rank, matrix, rank);
    add_product(c->rank, c->rank, 1, t->flexibility, rank, g, 1, y, 1);
    if (!lu(NULL, c->rank, matrix, pivot)) goto done; // it would pull infinitely: worth nothing
    lu_solve(c->rank, matrix, pivot, 1, y);
    for (size_t i = 0; i < rank; i++) {
        double pull = g[i];
        for (size_t k = 0; k < rank; k++) pull -= c->stiffness[i * rank + k] * y[k];
        *change += pull * adjoint[c->end[i][0]][c->end[i][1]];
    }
done:
    return status;
}

jali_status bridges_worth(jali_context *ctx, attachments *a, int32_t count, const bridge *candidate,
                          int32_t of_case, const double (*u)[NODE_UNKNOWNS],
                          const double (*adjoint)[NODE_UNKNOWNS], double *change)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    coupling m;
    trial t = {0};
    TRY(couple(ctx, a, &m));
    for (int32_t i = 0; i < count; i++) {
        arena_mark own = arena_here(ctx);
        TRY(condense(ctx, a->s, &candidate[i], a->case_count, &t.bridge));
        TRY(gather_flexibility(ctx, a, &t));
        TRY(stiffen(ctx, a, &m, &t));
        TRY(judge(ctx, &t, of_case, u, adjoint, &change[i]));
        condensed_free(ctx, &t.bridge);
        arena_rewind(ctx, own);
    }
done:
    condensed_free(ctx, &t.bridge);
    arena_rewind(ctx, mark);
    return status;
}
