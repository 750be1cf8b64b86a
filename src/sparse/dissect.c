// Nested dissection of a structure's nodes.
//
// Source:  Karypis and Kumar, METIS 5.1, METIS_NodeND. The graph of the nodes is an order of magnitude
// smaller than
//          that of the unknowns, and keeps those of a node together.
// Limits:  METIS draws from rand(), so that calls take turns: two at a time would disturb each other's order.
// Checked: tests/test_solver.c.
#include "sparse/elimination.h"

#include <metis.h>
#include <pthread.h>

_Static_assert(sizeof(idx_t) == sizeof(int32_t), "METIS with 32 bits an index, as Debian has it");

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

// Both halves of the graph, without the loops.
static jali_status whole_graph(jali_context *ctx, const block_matrix *a, idx_t **first, idx_t **beside)
{
    jali_status status;
    int64_t edges = 2 * (a->row[a->node_count] - a->node_count);
    if (edges >= INT32_MAX) {
        status = fail(ctx, JALI_LIMIT, "a structure of %d nodes is larger than its ordering can index",
                      a->node_count);
        goto done;
    }
    TRY(arena_take(ctx, first, (size_t)a->node_count + 2, sizeof **first));
    TRY(arena_take(ctx, beside, (size_t)edges + 1, sizeof **beside));
    idx_t *f = *first;
    memset(f, 0, ((size_t)a->node_count + 2) * sizeof *f);
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            f[i + 2] += joins(a, i, a->column[b]);
            f[a->column[b] + 2] += joins(a, i, a->column[b]);
        }
    for (int32_t i = 0; i < a->node_count; i++) f[i + 2] += f[i + 1];
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            if (!joins(a, i, a->column[b])) continue;
            (*beside)[f[i + 1]++] = a->column[b];
            (*beside)[f[a->column[b] + 1]++] = i;
        }
done:
    return status;
}

jali_status dissect(jali_context *ctx, const block_matrix *a, int32_t *node)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    idx_t *first, *beside, *rank, count = a->node_count;
    TRY(whole_graph(ctx, a, &first, &beside));
    TRY(ARENA(ctx, rank, count));
    for (idx_t i = 0; i < count; i++) node[i] = i;
    if (first[count] == 0) goto done; // without an edge there is nothing to cut, and METIS will not have it
    pthread_mutex_lock(&one_at_a_time);
    int answer = METIS_NodeND(&count, first, beside, NULL, NULL, node, rank);
    pthread_mutex_unlock(&one_at_a_time);
    if (answer != METIS_OK)
        status = fail(ctx, answer == METIS_ERROR_MEMORY ? JALI_NO_MEMORY : JALI_LIMIT,
                      "the order of %d nodes could not be found: METIS ends with %d", a->node_count, answer);
done:
    arena_rewind(ctx, mark);
    return status;
}
