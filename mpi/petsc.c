// The solver's door over PETSc: the same program on several processes, which share assembly, factor and
// solutions.
//
// Every process runs the whole program on the same input. The nodes' rows are dealt out in runs along the
// Morton curve; a process assembles those of its own (every element that touches them), and only matrix
// entries between runs are sent. Right sides and solutions are whole on each process.
//
// How:     MPIAIJ with equal blocks, 6 or 3 unknowns a node; what supports hold is a row of the identity.
// MUMPS's LDL^T
//          over SCOTCH's order first; when memory would not do, conjugate gradients with BoomerAMG. To choose
//          by hand: PETSC_OPTIONS="-jali_solver direct" or "multigrid".
// Limits:  geometry and pattern are whole on each process: about 300 bytes a node.
// Checked: mpi/test.sh: against the sequential solver, on 1 and 2 processes; mpi/cli.sh: through jali
// analyse.
#include "sparse/solver.h"

#include <petscksp.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

// A factor needs about this much (docs/analyse.md).
static const double FACTOR_BYTES = 2600;
static const double TOLERANCE = 1e-11;

struct solver {
    const block_matrix *a;
    int32_t from, to; // nodes of this process
    int32_t width;    // unknowns a node in the PETSc matrix
    Mat matrix;
    KSP ksp;
    Vec b, x;
    bool direct;
};

#define PETSC(call)                                                                                          \
    do {                                                                                                     \
        PetscErrorCode code_ = (call);                                                                       \
        if (code_ != 0) {                                                                                    \
            status = fail(ctx, JALI_NO_RESULT, "PETSc ended with %d in %s", (int)code_, #call);              \
            goto done;                                                                                       \
        }                                                                                                    \
    } while (0)

static void end_petsc(void)
{
    PetscFinalize();
}

static void begin_petsc(void)
{
    PetscBool begun;
    if (PetscInitialized(&begun) == 0 && begun) return;
    if (PetscInitializeNoArguments() != 0) abort(); // nothing can be said without MPI
    PetscPopSignalHandler();                        // signals are the program's
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    atexit(end_petsc);
}

static int rank_of_process(int *processes)
{
    int rank;
    begin_petsc();
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    MPI_Comm_size(PETSC_COMM_WORLD, processes);
    return rank;
}

const char *solver_name(void)
{
    return "petsc";
}

bool solver_leads(void)
{
    int processes;
    return rank_of_process(&processes) == 0;
}

static int32_t first_node_of(int32_t node_count, int rank, int processes)
{
    return (int32_t)((int64_t)node_count * rank / processes);
}

bool solver_serves_threads(void)
{
    return false;
}

void solver_share(int32_t node_count, int32_t *from, int32_t *to)
{
    int processes, rank = rank_of_process(&processes);
    *from = first_node_of(node_count, rank, processes);
    *to = first_node_of(node_count, rank + 1, processes);
}

// A broken promise is the least of all failures: what ended another process's run says more.
static int gravity_of(jali_status status)
{
    return status == JALI_OK ? 0 : status == JALI_BROKEN ? 1 : 2 + (int)status;
}

jali_status solver_agree(jali_context *ctx, jali_status status)
{
    static bool parted; // a process that failed asks no more: the others must not wait for it
    struct {
        int gravity, rank;
    } own = {.gravity = gravity_of(status)}, worst;
    struct {
        jali_status status;
        char sentence[512];
    } failure = {.status = status};
    int processes;
    if (parted) return status;
    own.rank = rank_of_process(&processes);
    MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MAXLOC, PETSC_COMM_WORLD);
    if (worst.gravity == 0) return JALI_OK;
    parted = true;
    snprintf(failure.sentence, sizeof failure.sentence, "%s", jali_message(ctx));
    MPI_Bcast(&failure, sizeof failure, MPI_BYTE, worst.rank, PETSC_COMM_WORLD);
    return worst.rank == own.rank ? status : fail(ctx, failure.status, "%s", failure.sentence);
}

// Memory that is free on all machines together.
static double free_bytes(void)
{
    MPI_Comm machine;
    int rank;
    double own = 0, all;
    MPI_Comm_split_type(PETSC_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &rank);
    MPI_Comm_free(&machine);
    if (rank == 0) own = (double)sysconf(_SC_AVPHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    return all;
}

static bool choose_direct(int32_t unknowns)
{
    char word[32];
    PetscBool given = PETSC_FALSE;
    PetscOptionsGetString(NULL, NULL, "-jali_solver", word, sizeof word, &given);
    if (given) return strcmp(word, "multigrid") != 0;
    return FACTOR_BYTES * unknowns < free_bytes();
}

// Blocks in each row of this process, by whether their columns are its own too.
static void count_blocks(const solver *s, PetscInt *own, PetscInt *other)
{
    const block_matrix *a = s->a;
    memset(own, 0, (size_t)(s->to - s->from) * sizeof *own);
    memset(other, 0, (size_t)(s->to - s->from) * sizeof *other);
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            int32_t k = a->column[b];
            bool i_own = i >= s->from && i < s->to, k_own = k >= s->from && k < s->to;
            if (i_own) (k_own ? own : other)[i - s->from]++;
            if (k_own && k != i) (i_own ? own : other)[k - s->from]++;
        }
}

static jali_status create_matrix(jali_context *ctx, solver *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    PetscInt *own, *other, rows = s->width * (s->to - s->from);
    TRY(ARENA(ctx, own, s->to - s->from));
    TRY(ARENA(ctx, other, s->to - s->from));
    count_blocks(s, own, other);
    PETSC(MatCreate(PETSC_COMM_WORLD, &s->matrix));
    PETSC(MatSetSizes(s->matrix, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
    PETSC(MatSetBlockSize(s->matrix, s->width));
    PETSC(MatSetType(s->matrix, MATAIJ));
    PETSC(MatXAIJSetPreallocation(s->matrix, s->width, own, other, NULL, NULL));
    PETSC(MatSetOption(s->matrix, MAT_SYMMETRIC, PETSC_TRUE));
    PETSC(MatSetOption(s->matrix, MAT_SPD, PETSC_TRUE));
    PETSC(MatCreateVecs(s->matrix, &s->x, &s->b));
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status create_method(jali_context *ctx, solver *s)
{
    jali_status status = JALI_OK;
    PC pc;
    Mat factor;
    if (s->ksp) PETSC(KSPDestroy(&s->ksp));
    PETSC(KSPCreate(PETSC_COMM_WORLD, &s->ksp));
    PETSC(KSPSetOperators(s->ksp, s->matrix, s->matrix));
    PETSC(KSPGetPC(s->ksp, &pc));
    if (s->direct) {
        PETSC(KSPSetType(s->ksp, KSPPREONLY));
        PETSC(PCSetType(pc, PCCHOLESKY));
        PETSC(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
        PETSC(PCFactorSetUpMatSolverType(pc));
        PETSC(PCFactorGetMatrix(pc, &factor));
        PETSC(MatMumpsSetIcntl(factor, 7, 3)); // SCOTCH: Debian's MUMPS has no METIS and no parallel analysis
        PETSC(MatMumpsSetIcntl(factor, 14, 40)); // per cent of room beside the estimate
    } else {
        PETSC(KSPSetType(s->ksp, KSPCG));
        PETSC(KSPSetTolerances(s->ksp, TOLERANCE, PETSC_DEFAULT, PETSC_DEFAULT, 2000));
        PETSC(PCSetType(pc, PCHYPRE));
        PETSC(PCHYPRESetType(pc, "boomeramg"));
    }
    PETSC(KSPSetFromOptions(s->ksp));
done:
    return status;
}

jali_status solver_open(jali_context *ctx, const block_matrix *a, const double (*place)[3], solver **out)
{
    jali_status status;
    solver *s;
    *out = NULL;
    (void)place; // PT-SCOTCH goes by the graph
    begin_petsc();
    TRY(solver_agree(ctx, step(ctx, "order", 0)));
    TRY(solver_agree(ctx, allocate_cleared(ctx, &s, 1, sizeof *s)));
    *out = s;
    s->a = a;
    solver_share(a->node_count, &s->from, &s->to);
    for (int32_t i = 0; i < a->node_count; i++) s->width = MAX(s->width, a->first[i + 1] - a->first[i]);
    s->width = s->width <= 3 ? 3 : BLOCK_WIDTH;
    s->direct = choose_direct(unknowns_of(a));
    TRY(create_matrix(ctx, s));
    TRY(create_method(ctx, s));
    TRY(solver_agree(ctx, step(ctx, "order", 1)));
done:
    if (status != JALI_OK) {
        solver_close(ctx, *out);
        *out = NULL;
    }
    return status;
}

// A block with all its unknowns: what is held gets the identity's row.
static void fill_block(const solver *s, int64_t block, int32_t i, int32_t k, double *full, double *turned)
{
    const block_matrix *a = s->a;
    const double *value = a->value + a->entry[block];
    int32_t w = s->width, rows = a->first[i + 1] - a->first[i], columns = a->first[k + 1] - a->first[k];
    for (int32_t e = 0; e < w * w; e++) full[e] = 0;
    for (int32_t r = 0; r < rows; r++)
        for (int32_t c = 0; c < (i == k ? r + 1 : columns); c++) {
            full[r * w + c] = *value;
            if (i == k) full[c * w + r] = *value;
            value++;
        }
    for (int32_t r = rows; i == k && r < w; r++) full[r * w + r] = 1;
    for (int32_t e = 0; e < w * w; e++) turned[e % w * w + e / w] = full[e];
}

static jali_status fill_matrix(jali_context *ctx, solver *s)
{
    jali_status status = JALI_OK;
    double full[BLOCK_WIDTH * BLOCK_WIDTH], turned[BLOCK_WIDTH * BLOCK_WIDTH];
    for (PetscInt i = s->from; i < s->to; i++)
        for (int64_t b = s->a->row[i]; b < s->a->row[i + 1]; b++) {
            PetscInt k = s->a->column[b];
            fill_block(s, b, i, k, full, turned);
            PETSC(MatSetValuesBlocked(s->matrix, 1, &i, 1, &k, full, INSERT_VALUES));
            if (k != i) PETSC(MatSetValuesBlocked(s->matrix, 1, &k, 1, &i, turned, INSERT_VALUES));
        }
    PETSC(MatAssemblyBegin(s->matrix, MAT_FINAL_ASSEMBLY));
    PETSC(MatAssemblyEnd(s->matrix, MAT_FINAL_ASSEMBLY));
done:
    return status;
}

static jali_status set_up(jali_context *ctx, solver *s, bool *failed)
{
    jali_status status = JALI_OK;
    PC pc;
    PCFailedReason reason;
    PETSC(KSPSetOperators(s->ksp, s->matrix, s->matrix));
    PETSC(KSPSetUp(s->ksp));
    PETSC(KSPGetPC(s->ksp, &pc));
    PETSC(PCGetFailedReason(pc, &reason));
    *failed = reason != PC_NOERROR;
done:
    return status;
}

jali_status solver_factor(jali_context *ctx, solver *s, int32_t *weak_row)
{
    jali_status status;
    bool failed;
    *weak_row = -1;
    TRY(solver_agree(ctx, step(ctx, "factor", 0)));
    TRY(fill_matrix(ctx, s));
    TRY(set_up(ctx, s, &failed));
    if (failed && s->direct) { // no memory, after all
        s->direct = false;
        TRY(create_method(ctx, s));
        TRY(set_up(ctx, s, &failed));
    }
    if (failed) {
        status = fail(ctx, JALI_NO_RESULT, "neither a factor nor multigrid can be made of %d unknowns",
                      unknowns_of(s->a));
        goto done;
    }
    TRY(solver_agree(ctx, step(ctx, "factor", 1)));
done:
    return status;
}

// The part of a right side that is this process's.
static jali_status put(jali_context *ctx, const solver *s, const double *from, Vec to)
{
    jali_status status = JALI_OK;
    double *value;
    PETSC(VecGetArray(to, &value));
    for (int32_t i = s->from; i < s->to; i++)
        for (int32_t k = 0; k < s->width; k++) {
            int32_t at = s->a->first[i] + k;
            *value++ = at < s->a->first[i + 1] ? from[at] : 0;
        }
    value -= (size_t)s->width * (size_t)(s->to - s->from);
    PETSC(VecRestoreArray(to, &value));
done:
    return status;
}

// The whole of a solution, on every process.
static jali_status get(jali_context *ctx, const solver *s, Vec from, double *to)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int processes, *count, *first;
    const double *value;
    rank_of_process(&processes);
    TRY(solver_agree(ctx, ARENA(ctx, count, processes)));
    TRY(solver_agree(ctx, ARENA(ctx, first, processes)));
    for (int p = 0; p < processes; p++) {
        first[p] = s->a->first[first_node_of(s->a->node_count, p, processes)];
        count[p] = s->a->first[first_node_of(s->a->node_count, p + 1, processes)] - first[p];
    }
    PETSC(VecGetArrayRead(from, &value));
    const double *next = value;
    for (int32_t i = s->from; i < s->to; i++, next += s->width)
        memcpy(to + s->a->first[i], next, (size_t)(s->a->first[i + 1] - s->a->first[i]) * sizeof *to);
    PETSC(VecRestoreArrayRead(from, &value));
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, to, count, first, MPI_DOUBLE, PETSC_COMM_WORLD);
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status solver_solve(jali_context *ctx, solver *s, int32_t count, double *x)
{
    jali_status status = JALI_OK;
    KSPConvergedReason reason;
    for (int32_t i = 0; i < count; i++) {
        double *side = x + (size_t)i * (size_t)unknowns_of(s->a);
        TRY(solver_agree(ctx, step(ctx, "solve", (double)i / count)));
        TRY(put(ctx, s, side, s->b));
        PETSC(KSPSolve(s->ksp, s->b, s->x));
        PETSC(KSPGetConvergedReason(s->ksp, &reason));
        if (reason < 0) {
            status = fail(ctx, JALI_NO_RESULT, "%d unknowns are not solved for: PETSc's reason is %d",
                          unknowns_of(s->a), (int)reason);
            goto done;
        }
        TRY(get(ctx, s, s->x, side));
    }
    TRY(solver_agree(ctx, step(ctx, "solve", 1)));
done:
    return status;
}

jali_status solver_residual(jali_context *ctx, solver *s, const double *x, const double *b, double *r)
{
    jali_status status;
    TRY(solver_agree(ctx, JALI_OK));
    TRY(put(ctx, s, x, s->x));
    PETSC(MatMult(s->matrix, s->x, s->b));
    TRY(get(ctx, s, s->b, r));
    for (int32_t i = 0; i < unknowns_of(s->a); i++) r[i] = b[i] - r[i];
done:
    return status;
}

// By solutions: what is asked for here are a few columns.
jali_status solver_inverse(jali_context *ctx, solver *s, int32_t row_count, const int32_t *row,
                           int32_t column_count, const int32_t *column, double *f)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    double *x;
    TRY(solver_agree(ctx, ARENA(ctx, x, unknowns_of(s->a))));
    for (int32_t c = 0; c < column_count; c++) {
        memset(x, 0, (size_t)unknowns_of(s->a) * sizeof *x);
        x[column[c]] = 1;
        TRY(solver_solve(ctx, s, 1, x));
        for (int32_t r = 0; r < row_count; r++) f[(size_t)c * (size_t)row_count + (size_t)r] = x[row[r]];
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

solver_figures solver_cost(const solver *s)
{
    (void)s;
    return (solver_figures){0}; // MUMPS's own, and not asked for
}

void solver_close(jali_context *ctx, solver *s)
{
    if (!s) return;
    KSPDestroy(&s->ksp);
    MatDestroy(&s->matrix);
    VecDestroy(&s->b);
    VecDestroy(&s->x);
    release(ctx, s);
}
