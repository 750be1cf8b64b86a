// The sequential MUMPS behind the solver's door.
//
// Source:  MUMPS 5.5 Users' guide: SYM = 1, a given order (dissect.c), entries by triplets.
// Limits:  MUMPS keeps what is being called in statics of its C interface, so calls take turns; a call cannot
//          be interrupted, so limits of time and a cancel are seen before and after each. BLR stays off: at
//          1e-8 it left a residual of 2e-3. Its memory is counted in the context by its own figures.
// Checked: tests/test_solver.c.
#include "sparse/solver.h"

#include <dlfcn.h>
#include <dmumps_c.h>
#include <pthread.h>
#include <sys/mman.h>

// MUMPS's parameters by the numbers they have in its guide.
enum { USE_COMM_WORLD = -987654, START = -1, END = -2, ANALYSE = 1, FACTOR = 2, SOLVE = 3, ATTEMPTS = 6 };
#define ICNTL(n) icntl[(n)-1]
#define INFO(n)  infog[(n)-1]

struct solver {
    const block_matrix *a;
    DMUMPS_STRUC_C mumps;
    bool started;
    int32_t *row, *column; // [entries of a] counted from 1
    int32_t *position;     // [unknowns] dissect's
    double *work;          // where MUMPS keeps the factor and its fronts
    int64_t work_count;
    uint64_t counted; // bytes the context counts for the rest of MUMPS
};

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

static void call(DMUMPS_STRUC_C *m, int job)
{
    m->job = job;
    pthread_mutex_lock(&one_at_a_time);
    dmumps_c(m);
    pthread_mutex_unlock(&one_at_a_time);
}

// Threads inside BLAS gain nothing on fronts of this size. Not every BLAS can be told.
static void single_blas_thread(void)
{
    void (*set_threads)(int);
    void *found = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
    memcpy(&set_threads, &found, sizeof found);
    if (found) set_threads(1);
}

static void start(solver *s)
{
    DMUMPS_STRUC_C *m = &s->mumps;
    m->sym = 1;
    m->par = 1;
    m->comm_fortran = USE_COMM_WORLD;
    single_blas_thread();
    call(m, START);
    s->started = true;
    for (int n = 1; n <= 3; n++) m->ICNTL(n) = -1; // no words on any stream
    m->ICNTL(4) = 0;
    m->ICNTL(6) = 0;  // no row permutation
    m->ICNTL(7) = 1;  // the order is given
    m->ICNTL(8) = 0;  // no scaling: elimination without pivoting does not ask for it
    m->ICNTL(13) = 1; // no distributed root
    m->ICNTL(14) = 5; // per cent beside the estimate, which is exact without pivoting
    m->ICNTL(28) = 1;
}

// What MUMPS's codes mean to our callers.
static jali_status outcome(jali_context *ctx, const solver *s)
{
    const DMUMPS_STRUC_C *m = &s->mumps;
    int code = m->INFO(1), detail = m->INFO(2);
    switch (code) {
    case 0: return JALI_OK;
    case -5:
    case -7:
    case -13: return fail(ctx, JALI_NO_MEMORY, "no memory for the factor of %d unknowns", unknowns_of(s->a));
    case -6:
    case -10:
        return fail(ctx, JALI_NO_RESULT,
                    "a structure of %d unknowns is not held: elimination ends at the %d.", unknowns_of(s->a),
                    detail);
    case -51:
    case -52:
        return fail(ctx, JALI_LIMIT, "%d unknowns are more than the solver can index", unknowns_of(s->a));
    default:
        return code > 0 ? JALI_OK
                        : fail(ctx, JALI_LIMIT, "the solver ended with %d (%d) at %d unknowns", code, detail,
                               unknowns_of(s->a));
    }
}

// The places of the entries, in the order in which block_matrix keeps their values.
static void place_entries(const block_matrix *a, int32_t *row, int32_t *column)
{
    int64_t e = 0;
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            int32_t k = a->column[b];
            for (int32_t r = a->first[i]; r < a->first[i + 1]; r++)
                for (int32_t c = a->first[k]; c < (k == i ? r + 1 : a->first[k + 1]); c++) {
                    row[e] = r + 1;
                    column[e++] = c + 1;
                }
        }
}

static jali_status order(jali_context *ctx, solver *s)
{
    pthread_mutex_lock(&one_at_a_time);
    jali_status status = dissect(ctx, s->a, s->position);
    pthread_mutex_unlock(&one_at_a_time);
    return status;
}

jali_status solver_open(jali_context *ctx, const block_matrix *a, solver **out)
{
    jali_status status;
    solver *s;
    int64_t entries = a->entry[a->row[a->node_count]];
    *out = NULL;
    TRY(step(ctx, "order", 0));
    TRY(allocate_cleared(ctx, &s, 1, sizeof *s));
    *out = s;
    s->a = a;
    TRY(ALLOCATE(ctx, s->row, entries));
    TRY(ALLOCATE(ctx, s->column, entries));
    TRY(ALLOCATE(ctx, s->position, unknowns_of(a)));
    if (unknowns_of(a) == 0) goto done; // everything is held: nothing to solve
    place_entries(a, s->row, s->column);
    TRY(order(ctx, s));
    start(s);
    TRY(outcome(ctx, s));
    s->mumps.n = unknowns_of(a);
    s->mumps.nnz = entries;
    s->mumps.irn = s->row;
    s->mumps.jcn = s->column;
    s->mumps.perm_in = s->position;
    TRY(step(ctx, "order", 0.5));
    call(&s->mumps, ANALYSE);
    TRY(outcome(ctx, s));
    TRY(step(ctx, "order", 1));
done:
    if (status != JALI_OK) {
        solver_close(ctx, *out);
        *out = NULL;
    }
    return status;
}

static jali_status count(jali_context *ctx, solver *s, int megabytes)
{
    uncount_bytes(ctx, s->counted);
    s->counted = 0;
    uint64_t bytes = (uint64_t)megabytes * 1000000;
    jali_status status = count_bytes(ctx, bytes);
    if (status == JALI_OK) s->counted = bytes;
    return status;
}

// Which unknown stands at a place in the order of elimination.
static int32_t eliminated_as(const solver *s, int32_t position)
{
    for (int32_t i = 0; i < unknowns_of(s->a); i++)
        if (s->mumps.sym_perm[i] == position) return i;
    return -1;
}

// Large counts come from MUMPS, and go to it, as minus their millions.
static int64_t whole(int figure)
{
    return figure >= 0 ? figure : -(int64_t)figure * 1000000;
}

// The workspace is ours, in pages of 2 MB: with the usual ones of 4 kB the kernel takes a third of the time.
static jali_status lay_out_work(jali_context *ctx, solver *s)
{
    DMUMPS_STRUC_C *m = &s->mumps;
    int64_t estimate = whole(m->info[7]), millions = (estimate + estimate / 100 * m->ICNTL(14)) / 1000000 + 1;
    if (millions * 1000000 == s->work_count) return JALI_OK;
    release(ctx, s->work);
    s->work_count = 0;
    jali_status status = ALLOCATE(ctx, s->work, millions * 1000000);
    if (status != JALI_OK) return status;
    s->work_count = millions * 1000000;
    uintptr_t page = 1 << 21, begin = ((uintptr_t)s->work + page - 1) / page * page;
    uintptr_t end = (uintptr_t)(s->work + s->work_count) / page * page;
    if (end > begin) madvise((void *)begin, end - begin, MADV_HUGEPAGE);
    m->wk_user = s->work;
    m->lwk_user = (int)-millions;
    return JALI_OK;
}

jali_status solver_factor(jali_context *ctx, solver *s, int32_t *weak_row)
{
    jali_status status;
    DMUMPS_STRUC_C *m = &s->mumps;
    *weak_row = -1;
    if (!s->started) return JALI_OK;
    TRY(step(ctx, "factor", 0));
    TRY(count(ctx, s, m->INFO(16)));
    m->a = s->a->value;
    TRY(lay_out_work(ctx, s));
    for (int attempt = 0; attempt < ATTEMPTS; attempt++, m->ICNTL(14) *= 2) {
        call(m, FACTOR);
        int code = m->INFO(1);
        if (code != -8 && code != -9 && code != -14 && code != -15 && code != -17 && code != -20) break;
    }
    if (m->INFO(1) == -10) *weak_row = eliminated_as(s, m->INFO(2) + 1);
    TRY(outcome(ctx, s));
    if (m->INFO(12) > 0) {
        status = fail(ctx, JALI_NO_RESULT, "%d of %d pivots of a structure are negative", m->INFO(12),
                      unknowns_of(s->a));
        goto done;
    }
    TRY(count(ctx, s, m->INFO(18)));
    TRY(step(ctx, "factor", 1));
done:
    return status;
}

jali_status solver_solve(jali_context *ctx, solver *s, int32_t count, double *x)
{
    jali_status status = JALI_OK;
    DMUMPS_STRUC_C *m = &s->mumps;
    if (!s->started || count == 0) return JALI_OK;
    TRY(step(ctx, "solve", 0));
    m->ICNTL(20) = 0;
    m->ICNTL(30) = 0;
    m->rhs = x;
    m->nrhs = count;
    m->lrhs = m->n;
    call(m, SOLVE);
    m->rhs = NULL;
    TRY(outcome(ctx, s));
    TRY(step(ctx, "solve", 1));
done:
    return status;
}

// MUMPS wants the entries by columns of the whole matrix: all columns but the chosen ones are empty.
static void choose_entries(int32_t unknowns, int32_t row_count, const int32_t *row, int32_t column_count,
                           const int32_t *column, int32_t *first, int32_t *at)
{
    int32_t chosen = 0;
    for (int32_t i = 0; i <= unknowns; i++) {
        first[i] = chosen * row_count + 1;
        if (chosen < column_count && column[chosen] == i) chosen++;
    }
    for (int32_t c = 0; c < column_count; c++)
        for (int32_t r = 0; r < row_count; r++) at[c * row_count + r] = row[r] + 1;
}

jali_status solver_inverse(jali_context *ctx, solver *s, int32_t row_count, const int32_t *row,
                           int32_t column_count, const int32_t *column, double *f)
{
    jali_status status = JALI_OK;
    DMUMPS_STRUC_C *m = &s->mumps;
    arena_mark mark = arena_here(ctx);
    int32_t *first, *at, entries;
    if (row_count == 0 || column_count == 0) return JALI_OK;
    if (__builtin_mul_overflow(row_count, column_count, &entries))
        return fail(ctx, JALI_LIMIT, "%d x %d entries of an inverse are asked for", row_count, column_count);
    TRY(step(ctx, "solve", 0));
    TRY(ARENA(ctx, first, m->n + 1));
    TRY(ARENA(ctx, at, entries));
    choose_entries(m->n, row_count, row, column_count, column, first, at);
    m->ICNTL(20) = 1;
    m->ICNTL(30) = 1;
    m->nrhs = m->n;
    m->nz_rhs = entries;
    m->irhs_ptr = first;
    m->irhs_sparse = at;
    m->rhs_sparse = f;
    call(m, SOLVE);
    m->irhs_ptr = m->irhs_sparse = NULL;
    m->rhs_sparse = NULL;
    TRY(outcome(ctx, s));
    TRY(step(ctx, "solve", 1));
done:
    arena_rewind(ctx, mark);
    return status;
}

solver_figures solver_cost(const solver *s)
{
    if (!s->started) return (solver_figures){0};
    return (solver_figures){
        .flops = s->mumps.rinfog[2],
        .entries = (uint64_t)whole(s->mumps.INFO(29)),
        .held_bytes = s->counted + 8 * (uint64_t)s->a->entry[s->a->row[s->a->node_count]],
    };
}

void solver_close(jali_context *ctx, solver *s)
{
    if (!s) return;
    if (s->started) call(&s->mumps, END);
    uncount_bytes(ctx, s->counted);
    release(ctx, s->row);
    release(ctx, s->column);
    release(ctx, s->position);
    release(ctx, s->work);
    release(ctx, s);
}
