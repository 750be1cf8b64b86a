// Nested dissection of a structure's nodes.
//
// Source:  Karypis and Kumar, METIS 5.1, METIS_NodeND. The graph of the nodes is an order of magnitude
//          smaller than that of the unknowns, and keeps those of a node together.
// Limits:  METIS seeds and draws from rand(), so that calls take turns and leave its state as it was; another
//          thread of the host that draws meanwhile may change the order, and with it the last bits. It takes
//          SIGTERM for an error of its own, so what it then says is read as a wish to stop.
// Checked: tests/test_solver.c.
#include "sparse/elimination.h"

#include <metis.h>
#include <pthread.h>
#include <stdlib.h>

_Static_assert(sizeof(idx_t) == sizeof(int32_t), "METIS with 32 bits an index, as Debian has it");

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

/// What METIS sees: the nodes that join others. Held and lonely ones can go at any time, and hundreds of them
/// at once are nothing its minimum degree is made for.
typedef struct node_graph {
    idx_t count;
    idx_t *node;   // [count] of the structure
    idx_t *first;  // [count + 1]
    idx_t *beside; // [first[count]] both halves, without the loops
} node_graph;

// Neighbours of each node; then the lonely ones, first in the order.
static void name_nodes(const block_matrix *a, idx_t *degree, node_graph *g, int32_t *order)
{
    idx_t lonely = 0;
    memset(degree, 0, (size_t)a->node_count * sizeof *degree);
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            degree[i] += joins(a, i, a->column[b]);
            degree[a->column[b]] += joins(a, i, a->column[b]);
        }
    g->count = 0;
    for (int32_t i = 0; i < a->node_count; i++) {
        if (degree[i] > 0)
            g->node[g->count++] = i;
        else
            order[lonely++] = i;
    }
}

static jali_status make_graph(jali_context *ctx, const block_matrix *a, int32_t *order, node_graph *g)
{
    jali_status status;
    int64_t edges = 2 * (a->row[a->node_count] - a->node_count);
    idx_t *degree;
    if (edges >= INT32_MAX) {
        status = fail(ctx, JALI_LIMIT, "a structure of %d nodes is larger than its ordering can index",
                      a->node_count);
        goto done;
    }
    TRY(ARENA(ctx, degree, a->node_count + 1));
    TRY(ARENA(ctx, g->node, a->node_count + 1));
    TRY(ARENA(ctx, g->first, a->node_count + 1));
    TRY(ARENA(ctx, g->beside, edges + 1));
    name_nodes(a, degree, g, order);
    g->first[0] = 0;
    for (idx_t i = 0; i < g->count; i++) {
        g->first[i + 1] = g->first[i] + degree[g->node[i]];
        degree[g->node[i]] = i; // from here on: its number
    }
    idx_t *number = degree, *next = g->first;
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1]; b++) {
            int32_t k = a->column[b];
            if (!joins(a, i, k)) continue;
            g->beside[next[number[i]]++] = number[k];
            g->beside[next[number[k]]++] = number[i];
        }
    memmove(next + 1, next, (size_t)g->count * sizeof *next);
    next[0] = 0;
done:
    return status;
}

static int order_graph(node_graph *g, idx_t *order, idx_t *rank)
{
    char own_state[128];
    pthread_mutex_lock(&one_at_a_time);
    char *state_of_host = initstate(1, own_state, sizeof own_state);
    int answer = METIS_NodeND(&g->count, g->first, g->beside, NULL, NULL, order, rank);
    setstate(state_of_host);
    pthread_mutex_unlock(&one_at_a_time);
    return answer;
}

jali_status dissect(jali_context *ctx, const block_matrix *a, int32_t *node)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    node_graph g;
    idx_t *order, *rank;
    TRY(make_graph(ctx, a, node, &g));
    TRY(ARENA(ctx, order, g.count + 1));
    TRY(ARENA(ctx, rank, g.count + 1));
    int answer = g.count > 0 ? order_graph(&g, order, rank) : METIS_OK;
    if (answer == METIS_ERROR) {
        jali_cancel(ctx);
        TRY(step(ctx, "order", 0));
    }
    if (answer != METIS_OK)
        TRY(fail(ctx, JALI_NO_MEMORY, "METIS has no memory to order %d nodes", a->node_count));
    for (idx_t i = 0; i < g.count; i++) node[a->node_count - g.count + i] = g.node[order[i]];
done:
    arena_rewind(ctx, mark);
    return status;
}
