// Leaving a wall full.
//
// The inner skin keeps its triangles, but over the set it follows the border alone: each vertex in the middle
// of its neighbours (Tutte), found by Gauss-Seidel with over-relaxation. Around the tip of an ear that is a
// disc across the ear, under a crumpled patch a flat one behind it. What lies over it is solid, and is no
// place for a picture: its prisms may turn over.
//
// Limits:  a long limb left full from its root squeezes its triangles exponentially; below the lattice they
//          meet, and the wall stays unsolved.
// Checked: tests/test_offset.c.
#include "mesh/offset_fill.h"

#include "mesh/topology.h"

#include <math.h>

jali_status grow_full(jali_context *ctx, const jali_mesh *mesh, int32_t rings, bool *full)
{
    bool *touched;
    jali_status status = ALLOCATE(ctx, touched, mesh->vertex_count);
    if (status != JALI_OK) return status;
    for (int32_t ring = 0; ring < rings; ring++) {
        memset(touched, 0, (size_t)mesh->vertex_count * sizeof *touched);
        for (int32_t i = 0; i < 3 * mesh->triangle_count; i++)
            touched[mesh->triangle[i / 3][i % 3]] |= full[i / 3];
        for (int32_t i = 0; i < 3 * mesh->triangle_count; i++)
            full[i / 3] |= touched[mesh->triangle[i / 3][i % 3]];
    }
    release(ctx, touched);
    return JALI_OK;
}

static void find_free(const jali_mesh *mesh, const int32_t *twin, const bool *full, bool *free)
{
    for (int32_t v = 0; v < mesh->vertex_count; v++) free[v] = false;
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) free[mesh->triangle[i / 3][i % 3]] |= full[i / 3];
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        if (full[i / 3] && twin[i] >= 0) continue;
        if (!full[i / 3]) free[mesh->triangle[i / 3][i % 3]] = false;
        if (twin[i] < 0)
            free[mesh->triangle[i / 3][i % 3]] = free[mesh->triangle[i / 3][(i + 1) % 3]] = false;
    }
}

// The neighbours of the free vertices, once a side that leaves them.
typedef struct neighbours {
    int32_t count, *vertex, *first, *to; // [count], [count + 1], [first[count]]
} neighbours;

static jali_status list_neighbours(jali_context *ctx, const jali_mesh *mesh, const bool *free, neighbours *n)
{
    jali_status status;
    int32_t *number;
    TRY(ARENA(ctx, number, mesh->vertex_count + 1));
    TRY(ARENA(ctx, n->vertex, mesh->vertex_count + 1));
    TRY(ARENA(ctx, n->first, (size_t)mesh->vertex_count + 3));
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        number[v] = n->count;
        if (free[v]) n->vertex[n->count++] = v;
    }
    memset(n->first, 0, ((size_t)n->count + 3) * sizeof *n->first);
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        int32_t from = mesh->triangle[i / 3][i % 3];
        if (free[from]) n->first[number[from] + 2]++;
    }
    for (int32_t i = 0; i <= n->count; i++) n->first[i + 1] += n->first[i];
    TRY(ARENA(ctx, n->to, n->first[n->count + 1] + 1));
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        int32_t from = mesh->triangle[i / 3][i % 3];
        if (free[from]) n->to[n->first[number[from] + 1]++] = mesh->triangle[i / 3][(i + 1) % 3];
    }
done:
    return status;
}

// Returns how far a vertex moved at most, along one axis.
static double sweep(const neighbours *n, double (*at)[3])
{
    double most = 0;
    for (int32_t i = 0; i < n->count; i++) {
        double sum[3] = {0}, *here = at[n->vertex[i]];
        int32_t count = n->first[i + 1] - n->first[i];
        for (int32_t j = n->first[i]; j < n->first[i + 1]; j++)
            for (int k = 0; k < 3; k++) sum[k] += at[n->to[j]][k];
        for (int k = 0; k < 3; k++) {
            double step = sum[k] / count - here[k];
            here[k] += step;
            most = MAX(most, fabs(step));
        }
    }
    return most;
}

jali_status span_full(jali_context *ctx, const jali_mesh *mesh, const int32_t *twin, const bool *full,
                      double unit_mm, int32_t sweeps, bool *free, double (*inner)[3])
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    neighbours n = {0};
    find_free(mesh, twin, full, free);
    TRY(list_neighbours(ctx, mesh, free, &n));
    for (int32_t i = 0; i < sweeps && sweep(&n, inner) > unit_mm; i++)
        if (i % 64 == 0) TRY(step(ctx, "offset", 0.5));
    for (int32_t i = 0; i < n.count; i++)
        for (int k = 0; k < 3; k++)
            inner[n.vertex[i]][k] = rint(inner[n.vertex[i]][k] / unit_mm) * unit_mm + 0.0;
done:
    arena_rewind(ctx, mark);
    return status;
}
