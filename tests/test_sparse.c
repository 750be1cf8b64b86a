// Sparse factors: solutions against products, over meshes and seeds; the fill that the order promises.
#include "testing.h"

#include "sparse/separate.h"
#include "sparse/sparse.h"

#include <math.h>

// The Laplacian of a grid of side x side with random weights and a little more on the diagonal.
typedef struct grid_matrix {
    sparse_matrix a;
    double (*place)[2];
    int32_t *order;
} grid_matrix;

static double weight(uint64_t *seed)
{
    return 0.1 + (double)(next_random(seed) >> 40) / (1 << 24);
}

static jali_status make_grid(jali_context *limited, int32_t side, uint64_t seed, grid_matrix *m)
{
    jali_status status;
    static const int32_t step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int32_t count = side * side, used = 0;
    double(*beside)[2];
    *m = (grid_matrix){.a = {.size = count}};
    TRY(allocate_array(limited, &m->a.first, (size_t)count + 1, sizeof *m->a.first));
    TRY(allocate_array(limited, &m->a.column, 5 * (size_t)count, sizeof *m->a.column));
    TRY(allocate_array(limited, &m->a.value, 5 * (size_t)count, sizeof *m->a.value));
    TRY(allocate_array(limited, &m->place, (size_t)count, sizeof *m->place));
    TRY(allocate_array(limited, &m->order, (size_t)count, sizeof *m->order));
    TRY(ARENA(limited, beside, count));
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) beside[i][k] = weight(&seed);
    for (int32_t y = 0; y < side; y++)
        for (int32_t x = 0; x < side; x++) {
            int32_t here = y * side + x, own = used++;
            m->place[here][0] = x;
            m->place[here][1] = y;
            m->a.first[here] = own;
            m->a.column[own] = here;
            m->a.value[own] = 0.01;
            for (int k = 0; k < 4; k++) {
                int32_t to_x = x + step[k][0], to_y = y + step[k][1], to = to_y * side + to_x;
                if (to_x < 0 || to_y < 0 || to_x >= side || to_y >= side) continue;
                double w = beside[MIN(here, to)][k & 1];
                m->a.column[used] = to;
                m->a.value[used++] = -w;
                m->a.value[own] += w;
            }
        }
    m->a.first[count] = used;
done:
    return status;
}

static void grid_free(jali_context *limited, grid_matrix *m)
{
    release(limited, m->a.first);
    release(limited, m->a.column);
    release(limited, m->a.value);
    release(limited, m->place);
    release(limited, m->order);
}

TEST(solutions_give_back_the_right_side)
{
    static const int32_t sides[] = {1, 2, 3, 4, 7, 12, 33, 60};
    for (size_t n = 0; n < sizeof sides / sizeof *sides; n++) {
        grid_matrix m;
        sparse_factor f;
        uint64_t seed = 91 + n;
        CHECK_OK(make_grid(ctx, sides[n], 5 + n, &m));
        CHECK_OK(sparse_order(ctx, &m.a, (const double(*)[2])m.place, m.order));
        CHECK_OK(sparse_factorise(ctx, &m.a, m.order, &f));
        double(*wanted)[2] = NULL, (*b)[2] = NULL, (*scratch)[2] = NULL;
        CHECK_OK(ALLOCATE(ctx, wanted, m.a.size));
        CHECK_OK(ALLOCATE_CLEARED(ctx, b, m.a.size));
        CHECK_OK(ALLOCATE(ctx, scratch, m.a.size));
        for (int32_t i = 0; i < m.a.size; i++)
            for (int k = 0; k < 2; k++) wanted[i][k] = weight(&seed);
        for (int32_t i = 0; i < m.a.size; i++)
            for (int32_t e = m.a.first[i]; e < m.a.first[i + 1]; e++)
                for (int k = 0; k < 2; k++) b[i][k] += m.a.value[e] * wanted[m.a.column[e]][k];
        sparse_solve(&f, b, scratch);
        for (int32_t i = 0; i < m.a.size; i++)
            for (int k = 0; k < 2; k++) CHECK(fabs(b[i][k] - wanted[i][k]) < 1e-9);
        release(ctx, wanted);
        release(ctx, b);
        release(ctx, scratch);
        sparse_factor_free(ctx, &f);
        sparse_factor_free(ctx, &f);
        grid_free(ctx, &m);
    }
}

// Row after row a grid of n rows fills n^3 entries; dissected, of the order of n^2 log n.
TEST(the_order_keeps_the_fill_small)
{
    grid_matrix m;
    sparse_factor f;
    size_t fill[2];
    CHECK_OK(make_grid(ctx, 100, 1, &m));
    for (int dissected = 0; dissected < 2; dissected++) {
        for (int32_t i = 0; i < m.a.size; i++) m.order[i] = i;
        if (dissected) CHECK_OK(sparse_order(ctx, &m.a, (const double(*)[2])m.place, m.order));
        CHECK_OK(sparse_factorise(ctx, &m.a, m.order, &f));
        fill[dissected] = f.first[f.size];
        sparse_factor_free(ctx, &f);
    }
    CHECK(fill[0] > 900000);
    CHECK(fill[1] < 300000);
    grid_free(ctx, &m);
}

TEST(an_order_holds_each_row_once)
{
    grid_matrix m;
    CHECK_OK(make_grid(ctx, 40, 1, &m));
    uint64_t seed = 7;
    for (int32_t i = 0; i < m.a.size; i++) // equal places too
        for (int k = 0; k < 2; k++) m.place[i][k] = (double)(next_random(&seed) >> 62);
    CHECK_OK(sparse_order(ctx, &m.a, (const double(*)[2])m.place, m.order));
    bool *seen = NULL;
    CHECK_OK(ALLOCATE_CLEARED(ctx, seen, m.a.size));
    for (int32_t i = 0; i < m.a.size; i++) {
        CHECK(m.order[i] >= 0 && m.order[i] < m.a.size && !seen[m.order[i]]);
        seen[m.order[i]] = true;
    }
    release(ctx, seen);
    grid_free(ctx, &m);
}

TEST(what_is_not_positive_is_refused)
{
    grid_matrix m;
    sparse_factor f;
    CHECK_OK(make_grid(ctx, 5, 1, &m));
    CHECK_OK(sparse_order(ctx, &m.a, (const double(*)[2])m.place, m.order));
    m.a.value[m.a.first[12]] = -1;
    CHECK_STATUS(sparse_factorise(ctx, &m.a, m.order, &f), JALI_NO_RESULT);
    CHECK(f.value == NULL && f.size == 0);
    grid_free(ctx, &m);
}

static jali_status factor_some(jali_context *limited, void *data)
{
    (void)data;
    jali_status status;
    grid_matrix m;
    sparse_factor f = {0};
    TRY(make_grid(limited, 9, 3, &m));
    TRY(sparse_order(limited, &m.a, (const double(*)[2])m.place, m.order));
    TRY(sparse_factorise(limited, &m.a, m.order, &f));
done:
    sparse_factor_free(limited, &f);
    grid_free(limited, &m);
    return status;
}

TEST(every_allocation_refused_once)
{
    refuse_each_allocation(factor_some, NULL);
}

// --- Separators

enum { BETWEEN = 9, ENDS = 4, ALL = BETWEEN + ENDS };

// A graph of nodes between two ends, edges at random; no edge from end to end.
static void random_ends(uint64_t *seed, int32_t density, bool edge[ALL][ALL], int32_t side[ALL])
{
    memset(edge, 0, ALL * sizeof *edge);
    for (int32_t i = 0; i < ALL; i++) side[i] = i < BETWEEN ? MIDDLE : i % 2 ? HIGH : LOW;
    for (int32_t i = 0; i < ALL; i++)
        for (int32_t k = 0; k < i; k++)
            if (side[i] + side[k] != LOW + HIGH || side[i] == side[k])
                edge[i][k] = edge[k][i] = (int32_t)((next_random(seed) >> 40) % 10) < density;
}

static bool parts(bool edge[ALL][ALL], const int32_t side[ALL], uint32_t without)
{
    bool low[ALL], grown = true;
    for (int32_t i = 0; i < ALL; i++) low[i] = side[i] == LOW;
    while (grown) {
        grown = false;
        for (int32_t i = 0; i < ALL; i++)
            for (int32_t k = 0; k < ALL; k++) {
                if (!low[i] || low[k] || !edge[i][k] || (k < BETWEEN && without >> k & 1)) continue;
                if (side[k] == HIGH) return false;
                low[k] = grown = true;
            }
    }
    return true;
}

TEST(no_set_of_nodes_parts_two_ends_with_fewer)
{
    uint64_t seed = 11;
    for (int32_t round = 0; round < 600; round++) {
        bool edge[ALL][ALL];
        int32_t side[ALL], was[ALL], first[ALL + 1], beside[ALL * ALL], name[ALL], count = 0, held = 0;
        int32_t last[BETWEEN], next[BETWEEN], distance[BETWEEN], tried[BETWEEN], path[2 * BETWEEN];
        uint8_t seen[2 * BETWEEN];
        random_ends(&seed, 1 + round % 6, edge, side);
        memcpy(was, side, sizeof was);
        for (int32_t i = 0; i < ALL; i++) {
            first[i] = count;
            name[i] = i;
            for (int32_t k = 0; k < ALL; k++)
                if (edge[i][k]) beside[count++] = k;
        }
        first[ALL] = count;
        node_graph g = {ALL, name, first, beside};
        separate(&g, BETWEEN, name, name, side, &(separate_desk){last, next, distance, tried, path, seen});
        for (int32_t i = 0; i < ALL; i++) {
            CHECK(i < BETWEEN ? side[i] == LOW || side[i] == HIGH || side[i] == MIDDLE : side[i] == was[i]);
            held += side[i] == MIDDLE;
            for (int32_t k = 0; k < ALL; k++) CHECK(!edge[i][k] || side[i] != LOW || side[k] != HIGH);
        }
        int32_t least = BETWEEN;
        for (uint32_t set = 0; set < 1u << BETWEEN; set++)
            if (__builtin_popcount(set) < least && parts(edge, was, set)) least = __builtin_popcount(set);
        CHECK_INT(held, least);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_set_of_nodes_parts_two_ends_with_fewer),
        cmocka_unit_test_setup_teardown(solutions_give_back_the_right_side, open_context, close_context),
        cmocka_unit_test_setup_teardown(the_order_keeps_the_fill_small, open_context, close_context),
        cmocka_unit_test_setup_teardown(an_order_holds_each_row_once, open_context, close_context),
        cmocka_unit_test_setup_teardown(what_is_not_positive_is_refused, open_context, close_context),
        cmocka_unit_test_setup_teardown(every_allocation_refused_once, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
