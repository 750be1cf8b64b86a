// The structures' solver: solutions and inverses against products, over random structures.
#include "testing.h"

#include "sparse/dense.h"
#include "sparse/solver.h"

#include <math.h>
#include <pthread.h>

static double random_in(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// A matrix, and where each of its values stands.
typedef struct random_matrix {
    block_matrix a;
    int32_t (*at)[2];   // [entries] row and column, row >= column
    double (*place)[3]; // [node_count] of the nodes
} random_matrix;

static int64_t entries_of(const block_matrix *a)
{
    return a->entry[a->row[a->node_count]];
}

// How many unknowns a node of a grid has; NULL: none to `widest`, at random.
typedef int32_t (*holding)(int32_t side, int32_t x, int32_t y);

static jali_status lay_grid(jali_context *limited, int32_t side, int32_t widest, holding left_free,
                            uint64_t *seed, block_matrix *a)
{
    jali_status status;
    uint8_t *width;
    a->node_count = side * side;
    TRY(ARENA(limited, width, a->node_count + 1));
    TRY(ALLOCATE(limited, a->row, a->node_count + 1));
    TRY(ALLOCATE(limited, a->column, 4 * a->node_count));
    a->row[0] = 0;
    for (int32_t i = 0; i < a->node_count; i++) {
        int64_t e = a->row[i];
        width[i] = (uint8_t)(left_free ? left_free(side, i % side, i / side)
                                       : (int32_t)(next_random(seed) >> 40) % (widest + 1));
        if (i >= side && i % side > 0) a->column[e++] = i - side - 1;
        if (i >= side) a->column[e++] = i - side;
        if (i % side > 0) a->column[e++] = i - 1;
        a->column[e++] = i;
        a->row[i + 1] = e;
    }
    TRY(block_matrix_lay(limited, a, width));
done:
    return status;
}

// A grid of nodes with none to `widest` unknowns each; random values, and a diagonal that outweighs them.
static jali_status make_held(jali_context *limited, int32_t side, int32_t widest, holding left_free,
                             uint64_t seed, random_matrix *m)
{
    jali_status status;
    arena_mark mark = arena_here(limited);
    block_matrix *a = &m->a;
    double *sum;
    int64_t e = 0;
    *m = (random_matrix){0};
    TRY(lay_grid(limited, side, widest, left_free, &seed, a));
    TRY(ALLOCATE(limited, m->at, entries_of(a)));
    TRY(ALLOCATE_CLEARED(limited, m->place, a->node_count));
    for (int32_t i = 0; i < a->node_count; i++) {
        m->place[i][0] = i % side;
        m->place[i][1] = i / side;
    }
    TRY(ARENA(limited, sum, unknowns_of(a)));
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++)
            for (int32_t k = a->column[b], r = a->first[i]; r < a->first[i + 1]; r++)
                for (int32_t c = a->first[k]; c < a->first[k + 1] && c <= r; c++, e++) {
                    m->at[e][0] = r;
                    m->at[e][1] = c;
                }
    CHECK(e == entries_of(a));
    for (int32_t i = 0; i < unknowns_of(a); i++) sum[i] = 0.1;
    for (e = 0; e < entries_of(a); e++) {
        a->value[e] = random_in(&seed, -1, 1);
        for (int k = 0; k < 2; k++) sum[m->at[e][k]] += fabs(a->value[e]);
    }
    for (e = 0; e < entries_of(a); e++)
        if (m->at[e][0] == m->at[e][1]) a->value[e] = sum[m->at[e][0]];
done:
    arena_rewind(limited, mark);
    return status;
}

static jali_status make_matrix(jali_context *limited, int32_t side, int32_t widest, uint64_t seed,
                               random_matrix *m)
{
    return make_held(limited, side, widest, NULL, seed, m);
}

static void matrix_free(jali_context *limited, random_matrix *m)
{
    block_matrix_free(limited, &m->a);
    release(limited, m->at);
    release(limited, m->place);
}

// b = A x for `count` random x, of seed 77.
static void product(const random_matrix *m, int32_t count, double *x, double *b)
{
    uint64_t seed = 77;
    int32_t n = unknowns_of(&m->a);
    for (int32_t i = 0; i < count * n; i++) {
        x[i] = random_in(&seed, -1, 1);
        b[i] = 0;
    }
    for (int32_t k = 0; k < count; k++)
        for (int64_t e = 0; e < entries_of(&m->a); e++) {
            int32_t r = m->at[e][0] + k * n, c = m->at[e][1] + k * n;
            b[r] += m->a.value[e] * x[c];
            if (r != c) b[c] += m->a.value[e] * x[r];
        }
}

static double largest_difference(int32_t count, const double *a, const double *b)
{
    double most = 0;
    for (int32_t i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

TEST(solutions_give_back_the_right_sides)
{
    static const int32_t sides[] = {1, 2, 3, 5, 9, 20};
    for (uint64_t n = 0; n < 24; n++) {
        random_matrix m;
        solver *s;
        enum { RIGHT_SIDES = 3 };
        CHECK_OK(make_matrix(ctx, sides[n % 6], 1 + (int32_t)n / 4, 1 + n, &m));
        int32_t size = unknowns_of(&m.a), weak;
        double *x = NULL, *b = NULL, *r = NULL;
        CHECK_OK(ALLOCATE(ctx, x, RIGHT_SIDES * size));
        CHECK_OK(ALLOCATE(ctx, b, RIGHT_SIDES * size));
        CHECK_OK(ALLOCATE(ctx, r, size));
        CHECK_OK(solver_open(ctx, &m.a, (const double(*)[3])m.place, &s));
        for (int again = 0; again < 2; again++) { // the second time with other values
            product(&m, RIGHT_SIDES, x, b);
            block_residual(&m.a, x, b, r);
            for (int32_t i = 0; i < size; i++) CHECK(fabs(r[i]) < 1e-12);
            CHECK_OK(solver_factor(ctx, s, &weak));
            CHECK_OK(solver_solve(ctx, s, RIGHT_SIDES, b));
            CHECK(largest_difference(RIGHT_SIDES * size, x, b) < 1e-10);
            for (int64_t e = 0; e < entries_of(&m.a); e++) m.a.value[e] *= m.at[e][0] == m.at[e][1] ? 3 : -2;
        }
        solver_close(ctx, s);
        release(ctx, x);
        release(ctx, b);
        release(ctx, r);
        matrix_free(ctx, &m);
    }
}

TEST(entries_of_the_inverse_are_those_of_the_solutions)
{
    for (uint64_t n = 0; n < 12; n++) {
        random_matrix m;
        solver *s;
        enum { MOST = 40 };
        int32_t row[MOST], chosen = 0, weak;
        uint64_t seed = 50 + n;
        double f[MOST * MOST], *x = NULL;
        CHECK_OK(make_matrix(ctx, 12, 1 + (int32_t)n / 2, 1 + n, &m));
        for (int32_t i = 0; i < unknowns_of(&m.a) && chosen < MOST; i++)
            if ((next_random(&seed) >> 40) % 7 == 0) row[chosen++] = i;
        CHECK_OK(ALLOCATE(ctx, x, unknowns_of(&m.a)));
        CHECK_OK(solver_open(ctx, &m.a, (const double(*)[3])m.place, &s));
        CHECK_OK(solver_factor(ctx, s, &weak));
        CHECK_OK(solver_inverse(ctx, s, chosen, row, chosen, row, f));
        for (int32_t c = 0; c < chosen; c++) {
            memset(x, 0, (size_t)unknowns_of(&m.a) * sizeof *x);
            x[row[c]] = 1;
            CHECK_OK(solver_solve(ctx, s, 1, x));
            for (int32_t r = 0; r < chosen; r++) CHECK(fabs(f[r * chosen + c] - x[row[r]]) < 1e-12);
        }
        solver_close(ctx, s);
        release(ctx, x);
        matrix_free(ctx, &m);
    }
}

TEST(what_is_not_positive_definite_is_refused)
{
    static const double wrong[] = {0, -1, -1e-3};
    for (int n = 0; n < 3; n++) {
        random_matrix m;
        solver *s;
        int32_t weak;
        CHECK_OK(make_matrix(ctx, 8, 3, 5, &m));
        for (int64_t e = 0; e < entries_of(&m.a); e++) // one unknown that nothing else touches
            if (m.at[e][0] == 20 || m.at[e][1] == 20) m.a.value[e] = m.at[e][0] == m.at[e][1] ? wrong[n] : 0;
        CHECK_OK(solver_open(ctx, &m.a, (const double(*)[3])m.place, &s));
        CHECK_STATUS(solver_factor(ctx, s, &weak), JALI_NO_RESULT);
        CHECK_INT(weak, 20);
        solver_close(ctx, s);
        matrix_free(ctx, &m);
    }
}

TEST(limits_are_kept)
{
    jali_context_options opt = jali_context_defaults();
    jali_context *small;
    random_matrix m;
    solver *s = NULL;
    int32_t weak;
    opt.max_memory_bytes = 3 << 20;
    CHECK(jali_context_create(&opt, &small) == JALI_OK);
    CHECK_OK(make_matrix(ctx, 60, 6, 5, &m));
    jali_status status = solver_open(small, &m.a, (const double(*)[3])m.place, &s);
    if (status == JALI_OK) status = solver_factor(small, s, &weak);
    CHECK_STATUS(status, JALI_LIMIT);
    solver_close(small, s);
    jali_cancel(small);
    CHECK_STATUS(solver_open(small, &m.a, (const double(*)[3])m.place, &s), JALI_CANCELLED);
    jali_context_free(small);
    matrix_free(ctx, &m);
}

static int32_t one_free(int32_t side, int32_t x, int32_t y)
{
    return x == side / 2 && y == side / 2 ? 6 : 0;
}

static int32_t two_free(int32_t side, int32_t x, int32_t y)
{
    return y == side / 2 && (x == side / 2 || x == side / 2 + 1) ? 3 : 0;
}

static int32_t lonely_free(int32_t side, int32_t x, int32_t y)
{
    return side > 0 && x % 2 == 0 && y % 2 == 0 ? 2 : 0;
}

static int32_t strips_free(int32_t side, int32_t x, int32_t y)
{
    return y % 3 == 1 && x > 0 && x < side - 1 ? 6 : 0;
}

static int32_t corner_free(int32_t side, int32_t x, int32_t y)
{
    return x > side - 8 && y > side - 9 ? 6 : 0;
}

static int32_t inner_free(int32_t side, int32_t x, int32_t y)
{
    return x > 0 && y > 0 && x < side - 1 && y < side - 1 ? 1 + (x + y) % 6 : 0;
}

// Without any unknown as well: inner_free of 1 and 2.
TEST(held_nodes_lonely_ones_and_many_pieces_are_solved)
{
    static const holding left_free[] = {one_free,    two_free,    lonely_free,
                                        strips_free, corner_free, inner_free};
    static const int32_t sides[] = {1, 2, 3, 10, 64};
    for (uint64_t n = 0; n < 30; n++) {
        random_matrix m;
        solver *s;
        int32_t weak;
        double *x = NULL, *b = NULL;
        CHECK_OK(make_held(ctx, sides[n / 6], 0, left_free[n % 6], 1 + n, &m));
        int32_t size = unknowns_of(&m.a);
        CHECK_OK(ALLOCATE(ctx, x, size));
        CHECK_OK(ALLOCATE(ctx, b, size));
        product(&m, 1, x, b);
        CHECK_OK(solver_open(ctx, &m.a, (const double(*)[3])m.place, &s));
        CHECK_OK(solver_factor(ctx, s, &weak));
        CHECK_OK(solver_solve(ctx, s, 1, b));
        CHECK(largest_difference(size, x, b) < 1e-10);
        solver_close(ctx, s);
        release(ctx, x);
        release(ctx, b);
        matrix_free(ctx, &m);
    }
}

enum { AT_ONCE = 4, HASHED = 3 };

// Solutions of a few structures, in a context of its own.
static void *solve_alone(void *shared)
{
    double(*sum)[2] = shared;
    jali_context_options opt = jali_context_defaults();
    jali_context *own;
    opt.threads = 2;
    if (jali_context_create(&opt, &own) != JALI_OK) return NULL;
    for (int32_t n = 0; n < HASHED; n++) {
        random_matrix m = {0};
        solver *s = NULL;
        int32_t weak;
        double *b = NULL;
        sum[n][0] = sum[n][1] = 0;
        if (make_matrix(own, 40, 4, 9 + (uint64_t)n, &m) == JALI_OK &&
            ALLOCATE(own, b, unknowns_of(&m.a)) == JALI_OK &&
            solver_open(own, &m.a, (const double(*)[3])m.place, &s) == JALI_OK &&
            solver_factor(own, s, &weak) == JALI_OK) {
            for (int32_t i = 0; i < unknowns_of(&m.a); i++) b[i] = 1;
            if (solver_solve(own, s, 1, b) == JALI_OK)
                for (int32_t i = 0; i < unknowns_of(&m.a); i++) sum[n][i % 2] += b[i] * (1 + i % 7);
        }
        solver_close(own, s);
        release(own, b);
        matrix_free(own, &m);
    }
    jali_context_free(own);
    return NULL;
}

TEST(threads_at_once_give_the_same_bytes)
{
    double alone[HASHED][2], sum[AT_ONCE][HASHED][2];
    pthread_t thread[AT_ONCE];
    solve_alone(alone);
    for (int32_t n = 0; n < HASHED; n++) CHECK(alone[n][0] != 0);
    for (int32_t i = 0; i < AT_ONCE; i++) CHECK_INT(pthread_create(&thread[i], NULL, solve_alone, sum[i]), 0);
    for (int32_t i = 0; i < AT_ONCE; i++) {
        CHECK_INT(pthread_join(thread[i], NULL), 0);
        assert_memory_equal(sum[i], alone, sizeof alone);
    }
}

static int32_t one_each(int32_t side, int32_t x, int32_t y)
{
    (void)side, (void)x, (void)y;
    return 1;
}

// A grid with one diagonal a cell: George proved 31/4 n log2 n for dissection by lines; the factor has 3.9.
TEST(the_order_keeps_the_factor_small)
{
    for (int32_t side = 40; side <= 160; side *= 2) {
        random_matrix m;
        solver *s = NULL;
        int32_t n = side * side;
        CHECK_OK(make_held(ctx, side, 1, one_each, 3, &m));
        CHECK_OK(solver_open(ctx, &m.a, (const double(*)[3])m.place, &s));
        CHECK((double)solver_cost(s).entries < 4.1 * n * log2(n));
        solver_close(ctx, s);
        matrix_free(ctx, &m);
    }
}

static jali_status solve_once(jali_context *limited, void *data)
{
    (void)data;
    jali_status status;
    random_matrix m = {0};
    solver *s = NULL;
    int32_t weak, row[2] = {3, 8};
    double f[4], *b = NULL;
    TRY(make_matrix(limited, 6, 3, 5, &m));
    TRY(ALLOCATE_CLEARED(limited, b, unknowns_of(&m.a)));
    TRY(solver_open(limited, &m.a, (const double(*)[3])m.place, &s));
    TRY(solver_factor(limited, s, &weak));
    TRY(solver_solve(limited, s, 1, b));
    TRY(solver_inverse(limited, s, 2, row, 2, row, f));
done:
    solver_close(limited, s);
    release(limited, b);
    matrix_free(limited, &m);
    return status;
}

TEST(every_allocation_may_fail)
{
    refuse_each_allocation(solve_once, NULL);
}

// Sizes around the tiles' width; a system that needs its pivots, solved for x = 1, 2, 3 ...
TEST(dense_systems_by_tiles_are_solved_alike_by_any_number_of_threads)
{
    const int32_t sizes[] = {1, 63, 64, 65, 200};
    jali_context *by_threads[3];
    open_thread_contexts(by_threads);
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        size_t n = (size_t)sizes[k];
        uint64_t seed = 5 + k;
        double *a = malloc(n * n * sizeof *a), *b = malloc(n * sizeof *b), *x = malloc(n * sizeof *x);
        double *first = malloc(n * n * sizeof *first), *factor = malloc(n * n * sizeof *factor);
        int32_t *pivot = malloc(n * sizeof *pivot);
        for (size_t i = 0; i < n; i++) {
            b[i] = 0;
            for (size_t j = 0; j < n; j++) {
                a[i * n + j] = i == j && n > 1 ? 0 : random_in(&seed, -1, 1);
                b[i] += a[i * n + j] * (double)(j + 1);
            }
        }
        for (int t = 0; t < 4; t++) { // the last one without a context
            memcpy(factor, a, n * n * sizeof *a);
            CHECK(lu(t < 3 ? by_threads[t] : NULL, sizes[k], factor, pivot));
            if (t == 0) memcpy(first, factor, n * n * sizeof *a);
            CHECK(memcmp(first, factor, n * n * sizeof *a) == 0);
        }
        memcpy(x, b, n * sizeof *b);
        lu_solve(sizes[k], factor, pivot, 1, x);
        for (size_t i = 0; i < n; i++) CHECK(fabs(x[i] - (double)(i + 1)) < 1e-8);
        memset(a, 0, n * n * sizeof *a);
        CHECK(!lu(by_threads[1], sizes[k], a, pivot));
        free(a), free(b), free(x), free(first), free(factor), free(pivot);
    }
    close_thread_contexts(by_threads);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_give_back_the_right_sides),
        cmocka_unit_test(entries_of_the_inverse_are_those_of_the_solutions),
        cmocka_unit_test(what_is_not_positive_definite_is_refused),
        cmocka_unit_test(limits_are_kept),
        cmocka_unit_test(held_nodes_lonely_ones_and_many_pieces_are_solved),
        cmocka_unit_test(threads_at_once_give_the_same_bytes),
        cmocka_unit_test(the_order_keeps_the_factor_small),
        cmocka_unit_test(dense_systems_by_tiles_are_solved_alike_by_any_number_of_threads),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
