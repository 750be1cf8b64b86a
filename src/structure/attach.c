// Bridges on a factored structure: a correction of low rank.
//
// Source:  the matrix inversion lemma (Sherman, Morrison, Woodbury) on the unknowns at the bridges' ends.
// Limits:  above a rank of about 500 a new factor is cheaper.
// Checked: tests/test_attach.c: against a factor of the joined sheet, over seeds.
#include "structure/attach.h"

#include "sparse/dense.h"

#include <math.h>
#include <stdlib.h>

void attachments_begin(attachments *a, structure *s, int32_t case_count)
{
    *a = (attachments){.s = s, .case_count = case_count};
}

static void uncouple(jali_context *ctx, attachments *a)
{
    release(ctx, a->coupled.matrix);
    release(ctx, a->coupled.pivot);
    a->coupled = (coupling){0};
}

void attachments_free(jali_context *ctx, attachments *a)
{
    for (size_t i = 0; i < a->kept; i++) condensed_free(ctx, &a->bridge[i]);
    release(ctx, a->bridge);
    release(ctx, a->row);
    release(ctx, a->f);
    uncouple(ctx, a);
    *a = (attachments){0};
}

static void swap_bridges(attachments *a, size_t i, size_t k)
{
    condensed kept = a->bridge[i];
    a->bridge[i] = a->bridge[k];
    a->bridge[k] = kept;
}

jali_status attach(jali_context *ctx, attachments *a, const bridge *b, int32_t *name)
{
    jali_status status;
    TRY(GROW(ctx, a->bridge, a->capacity, a->kept + 1));
    TRY(condense(ctx, a->s, b, a->case_count, &a->bridge[a->kept]));
    *name = a->bridge[a->kept].name = a->next_name++;
    a->stands = false;
    swap_bridges(a, a->count++, a->kept++);
done:
    return status;
}

// Where the bridge of that name stands among [from, to); to: it does not.
static size_t named(const attachments *a, int32_t name, size_t from, size_t to)
{
    while (from < to && a->bridge[from].name != name) from++;
    return from;
}

void withdraw(attachments *a, int32_t name)
{
    size_t i = named(a, name, 0, a->count);
    if (i < a->count) swap_bridges(a, i, --a->count);
    a->stands = false;
}

void attach_again(attachments *a, int32_t name)
{
    size_t i = named(a, name, a->count, a->kept);
    if (i < a->kept) swap_bridges(a, i, a->count++);
    a->stands = false;
}

int32_t index_of(int32_t count, const int32_t *row, int32_t wanted)
{
    int32_t low = 0, high = count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (row[middle] < wanted)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && row[low] == wanted ? low : -1;
}

static int ascending(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

int32_t sort_rows(int32_t count, int32_t *row)
{
    int32_t kept = 0;
    qsort(row, (size_t)count, sizeof *row, ascending);
    for (int32_t i = 0; i < count; i++)
        if (kept == 0 || row[kept - 1] != row[i]) row[kept++] = row[i];
    return kept;
}

// Rows of bridges that F does not have yet.
static jali_status new_rows(jali_context *ctx, const attachments *a, int32_t *count, int32_t **row)
{
    jali_status status;
    size_t most = 0;
    *count = 0;
    for (size_t i = 0; i < a->count; i++) most += (size_t)a->bridge[i].rank;
    TRY(arena_take(ctx, row, most, sizeof **row));
    for (size_t i = 0; i < a->count; i++)
        for (int32_t k = 0; k < a->bridge[i].rank; k++)
            if (index_of(a->rank, a->row, a->bridge[i].row[k]) < 0) (*row)[(*count)++] = a->bridge[i].row[k];
    *count = sort_rows(*count, *row);
done:
    return status;
}

// Put what was known and what is new in one matrix; entries between old and new come from the new columns.
static void merge(const attachments *a, int32_t rank, const int32_t *row, int32_t fresh,
                  const int32_t *fresh_row, int32_t (*at)[2], const double *column, double *f)
{
    size_t n = (size_t)rank, old = (size_t)a->rank;
    for (int32_t r = 0; r < rank; r++) {
        at[r][0] = index_of(a->rank, a->row, row[r]);
        at[r][1] = index_of(fresh, fresh_row, row[r]);
    }
    for (size_t r = 0; r < n; r++)
        for (size_t c = 0; c < n; c++)
            f[r * n + c] = at[c][1] >= 0   ? column[(size_t)at[c][1] * n + r]
                           : at[r][1] >= 0 ? column[(size_t)at[r][1] * n + c]
                                           : a->f[(size_t)at[r][0] * old + (size_t)at[c][0]];
}

// Bring F up to the bridges that are there.
static jali_status extend(jali_context *ctx, attachments *a)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t fresh, *fresh_row, (*at)[2], *row = NULL;
    double *column, *f = NULL;
    TRY(new_rows(ctx, a, &fresh, &fresh_row));
    if (fresh == 0) goto done;
    int32_t rank = a->rank + fresh;
    TRY(ALLOCATE(ctx, row, rank));
    TRY(ALLOCATE(ctx, f, (size_t)rank * (size_t)rank));
    TRY(ARENA(ctx, column, (size_t)rank * (size_t)fresh));
    TRY(ARENA(ctx, at, rank));
    if (a->rank > 0) memcpy(row, a->row, (size_t)a->rank * sizeof *row);
    memcpy(row + a->rank, fresh_row, (size_t)fresh * sizeof *row);
    sort_rows(rank, row);
    TRY(solver_inverse(ctx, a->s->solver, rank, row, fresh, fresh_row, column));
    merge(a, rank, row, fresh, fresh_row, at, column, f);
    release(ctx, a->row);
    release(ctx, a->f);
    a->row = row;
    a->f = f;
    a->rank = rank;
    row = NULL;
    f = NULL;
done:
    release(ctx, row);
    release(ctx, f);
    arena_rewind(ctx, mark);
    return status;
}

// M = I + F S by bands of rows.
typedef struct banding {
    const attachments *a;
    size_t most;           // rank of a bridge
    double *felt, *pulled; // [rank][most]
    double *matrix;
} banding;

enum { BAND = 64 };

// A bridge's columns of F, times its S, are added to its columns of M.
static void fill_band(void *shared, int32_t band)
{
    const banding *b = shared;
    const attachments *a = b->a;
    size_t n = (size_t)a->rank, from = (size_t)band * BAND, to = MIN(from + BAND, n);
    double *felt = b->felt + from * b->most, *pulled = b->pulled + from * b->most;
    memset(b->matrix + from * n, 0, (to - from) * n * sizeof *b->matrix);
    for (size_t r = from; r < to; r++) b->matrix[r * n + r] = 1;
    for (size_t i = 0; i < a->count; i++) {
        const condensed *c = &a->bridge[i];
        size_t rank = (size_t)c->rank;
        for (size_t r = from; r < to; r++)
            for (size_t k = 0; k < rank; k++) felt[(r - from) * rank + k] = a->f[r * n + (size_t)c->at[k]];
        memset(pulled, 0, (to - from) * rank * sizeof *pulled);
        add_product((int32_t)(to - from), c->rank, c->rank, felt, rank, c->stiffness, rank, pulled, rank);
        for (size_t r = from; r < to; r++)
            for (size_t k = 0; k < rank; k++)
                b->matrix[r * n + (size_t)c->at[k]] += pulled[(r - from) * rank + k];
    }
}

static jali_status fill_coupling(jali_context *ctx, const attachments *a, double *matrix)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    banding b = {.a = a, .matrix = matrix};
    for (size_t i = 0; i < a->count; i++) b.most = MAX(b.most, (size_t)a->bridge[i].rank);
    TRY(ARENA(ctx, b.felt, (size_t)a->rank * b.most));
    TRY(ARENA(ctx, b.pulled, (size_t)a->rank * b.most));
    parallel(ctx, (a->rank + BAND - 1) / BAND, fill_band, &b);
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status couple(jali_context *ctx, attachments *a, coupling *m)
{
    jali_status status = JALI_OK;
    if (a->stands) goto done;
    uncouple(ctx, a);
    TRY(extend(ctx, a));
    for (size_t i = 0; i < a->count; i++)
        for (int32_t k = 0; k < a->bridge[i].rank; k++)
            a->bridge[i].at[k] = index_of(a->rank, a->row, a->bridge[i].row[k]);
    TRY(ALLOCATE(ctx, a->coupled.matrix, (size_t)a->rank * (size_t)a->rank));
    TRY(ALLOCATE(ctx, a->coupled.pivot, a->rank));
    TRY(fill_coupling(ctx, a, a->coupled.matrix));
    if (!lu(ctx, a->rank, a->coupled.matrix, a->coupled.pivot))
        TRY(fail(ctx, JALI_NO_RESULT, "bridges at %d unknowns cannot be joined: their system is singular",
                 a->rank));
    a->stands = true;
done:
    *m = a->coupled;
    return status;
}

// v = g - S y at the rows of F: how the bridges pull. of_case -1: without g; y NULL: without S y.
static void bridge_forces(const attachments *a, int32_t of_case, const double *y, double *v)
{
    memset(v, 0, (size_t)a->rank * sizeof *v);
    for (size_t i = 0; i < a->count; i++) {
        const condensed *c = &a->bridge[i];
        for (int32_t k = 0; k < c->rank; k++) {
            double force = of_case >= 0 ? c->load[(size_t)of_case * (size_t)c->rank + (size_t)k] : 0;
            const double *s = c->stiffness + (size_t)k * (size_t)c->rank;
            for (int32_t q = 0; y && q < c->rank; q++) force -= s[q] * y[c->at[q]];
            v[c->at[k]] += force;
        }
    }
}

// How the bridges pull once joined, from the displacements x without them.
static void pull(const attachments *a, const coupling *m, int32_t of_case, const double *x, double *y,
                 double *v)
{
    for (int32_t i = 0; i < a->rank; i++) y[i] = x[a->row[i]];
    if (of_case >= 0) {
        bridge_forces(a, of_case, NULL, v);
        add_product(a->rank, a->rank, 1, a->f, (size_t)a->rank, v, 1, y, 1);
    }
    lu_solve(a->rank, m->matrix, m->pivot, 1, y);
    bridge_forces(a, of_case, y, v);
}

// Scratch of a solution.
typedef struct desk {
    double *f, *x, *r, *d; // [unknowns]
    double *y, *v;         // [rank]
} desk;

// r = f + P g - (K + P S P^T) x, and its length against that of the load.
static jali_status joint_residual(jali_context *ctx, attachments *a, int32_t of_case, const desk *w,
                                  const double *x, double *residual)
{
    jali_status status;
    int32_t count = unknowns_of(&a->s->k);
    double whole = length_of_unknowns(w->f, count);
    for (int32_t i = 0; i < a->rank; i++) w->y[i] = x[a->row[i]];
    bridge_forces(a, of_case, w->y, w->v);
    TRY(solver_residual(ctx, a->s->solver, x, w->f, w->r));
    for (int32_t i = 0; i < a->rank; i++) w->r[a->row[i]] += w->v[i];
    *residual = whole > 0 ? length_of_unknowns(w->r, count) / whole : 0;
done:
    return status;
}

// What a residual r would move: two more solutions. The better of old and new is kept.
static jali_status refine(jali_context *ctx, attachments *a, const coupling *m, int32_t of_case,
                          const desk *w)
{
    jali_status status;
    int32_t count = unknowns_of(&a->s->k);
    double residual, refined;
    TRY(joint_residual(ctx, a, of_case, w, w->x, &residual));
    if (residual > GOOD_RESIDUAL) {
        memcpy(w->d, w->r, (size_t)count * sizeof *w->d);
        TRY(solver_solve(ctx, a->s->solver, 1, w->d));
        pull(a, m, -1, w->d, w->y, w->v);
        memcpy(w->d, w->r, (size_t)count * sizeof *w->d);
        for (int32_t i = 0; i < a->rank; i++) w->d[a->row[i]] += w->v[i];
        TRY(solver_solve(ctx, a->s->solver, 1, w->d));
        for (int32_t i = 0; i < count; i++) w->d[i] += w->x[i];
        TRY(joint_residual(ctx, a, of_case, w, w->d, &refined));
        if (refined < residual) {
            memcpy(w->x, w->d, (size_t)count * sizeof *w->x);
            residual = refined;
        }
    }
    a->residual = MAX(a->residual, residual);
done:
    return status;
}

// What the bridges do in all cases, side by side: x = P (g - S y) from the displacements without them.
static void pull_all(attachments *a, const coupling *m, int32_t count, bool loaded,
                     const double (*base)[NODE_UNKNOWNS], const desk *w, double *x)
{
    size_t unknowns = (size_t)unknowns_of(&a->s->k), nodes = (size_t)a->s->sheet->node_count;
    for (int32_t k = 0; k < count; k++) {
        double *here = x + unknowns * (size_t)k;
        gather_unknowns(a->s, base + nodes * (size_t)k, w->d);
        pull(a, m, loaded ? k : -1, w->d, w->y, w->v);
        memset(here, 0, unknowns * sizeof *here);
        for (int32_t i = 0; i < a->rank; i++) here[a->row[i]] = w->v[i];
    }
}

jali_status attached_solve(jali_context *ctx, attachments *a, int32_t count,
                           const double (*load)[NODE_UNKNOWNS], const double (*base)[NODE_UNKNOWNS],
                           bool loaded, double (*u)[NODE_UNKNOWNS])
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    size_t unknowns = (size_t)unknowns_of(&a->s->k), nodes = (size_t)a->s->sheet->node_count;
    coupling m;
    desk w;
    double *x;
    a->residual = 0;
    TRY(couple(ctx, a, &m));
    TRY(ARENA(ctx, x, unknowns * (size_t)count));
    TRY(ARENA(ctx, w.f, unknowns));
    TRY(ARENA(ctx, w.r, unknowns));
    TRY(ARENA(ctx, w.d, unknowns));
    TRY(ARENA(ctx, w.y, a->rank));
    TRY(ARENA(ctx, w.v, a->rank));
    pull_all(a, &m, count, loaded, base, &w, x);
    TRY(solver_solve(ctx, a->s->solver, count, x));
    for (int32_t k = 0; k < count; k++) {
        w.x = x + unknowns * (size_t)k;
        gather_unknowns(a->s, base + nodes * (size_t)k, w.d);
        for (size_t i = 0; i < unknowns; i++) w.x[i] += w.d[i];
        if (loaded && !a->rough) {
            gather_unknowns(a->s, load + nodes * (size_t)k, w.f);
            TRY(refine(ctx, a, &m, k, &w));
        }
        scatter_unknowns(a->s, w.x, u + nodes * (size_t)k);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

void own_displacements(const attachments *a, int32_t name, int32_t of_case, const double (*u)[NODE_UNKNOWNS],
                       double (*own)[NODE_UNKNOWNS])
{
    const condensed *c = &a->bridge[named(a, name, 0, a->count)];
    int width = node_width(a->s), bit = first_bit(a->s);
    for (int32_t i = 0; i < c->own_unknowns; i++) {
        double sum = of_case >= 0 ? c->own_load[(size_t)of_case * (size_t)c->own_unknowns + (size_t)i] : 0;
        const double *follow = c->follow + (size_t)i * (size_t)c->rank;
        for (int32_t k = 0; k < c->rank; k++) sum += follow[k] * u[c->end[k][0]][c->end[k][1]];
        if (i % width == 0) memset(own[i / width], 0, sizeof *own);
        own[i / width][i % width + bit] = sum;
    }
}
