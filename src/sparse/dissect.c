// Nested dissection of a structure's nodes.
//
// Source:  Karypis and Kumar, METIS 5.1, METIS_NodeND. The graph of the nodes is an order of magnitude
//          smaller than that of the unknowns, and keeps those of a node together.
// Limits:  METIS draws from rand(): two orders made at one time in one process could differ. The caller holds
//          the solver's lock.
// Checked: tests/test_solver.c.
#include "sparse/solver.h"

#include <metis.h>

_Static_assert(sizeof(idx_t) == sizeof(int32_t), "METIS with 32 bits an index, as Debian has it");

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
        for (int64_t b = a->row[i]; b < a->row[i + 1] - 1; b++) {
            f[i + 2]++;
            f[a->column[b] + 2]++;
        }
    for (int32_t i = 0; i < a->node_count; i++) f[i + 2] += f[i + 1];
    for (int32_t i = 0; i < a->node_count; i++)
        for (int64_t b = a->row[i]; b < a->row[i + 1] - 1; b++) {
            (*beside)[f[i + 1]++] = a->column[b];
            (*beside)[f[a->column[b] + 1]++] = i;
        }
done:
    return status;
}

jali_status dissect(jali_context *ctx, const block_matrix *a, int32_t *position)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    idx_t *first, *beside, *order, *rank, count = a->node_count, at = 0;
    TRY(whole_graph(ctx, a, &first, &beside));
    TRY(ARENA(ctx, order, count + 1));
    TRY(ARENA(ctx, rank, count + 1));
    for (idx_t i = 0; i < count; i++) order[i] = i;
    // Without an edge there is nothing to cut, and METIS will not have it.
    if (first[count] > 0) {
        int answer = METIS_NodeND(&count, first, beside, NULL, NULL, order, rank);
        if (answer != METIS_OK) {
            status = fail(ctx, answer == METIS_ERROR_MEMORY ? JALI_NO_MEMORY : JALI_LIMIT,
                          "the order of %d nodes could not be found: METIS ends with %d", count, answer);
            goto done;
        }
    }
    for (idx_t i = 0; i < count; i++)
        for (int32_t k = a->first[order[i]]; k < a->first[order[i] + 1]; k++) position[k] = ++at;
done:
    arena_rewind(ctx, mark);
    return status;
}
