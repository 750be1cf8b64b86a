// The solid of a shell: prisms between the two skins.
//
// Limits:  walls and skins are flat between vertices. A wall that stands askew is cut into slices of two
//          triangles, which leave the ruled surface by at most 0.01 mm, always into the solid, so that walls
//          with a narrow void between them cannot meet.
// Checked: tests/test_shell.c.
#include <jali/shell.h>

#include "carve/prisms.h"
#include "mesh/sides.h"

#include <math.h>

enum { LEVELS_LOG2 = 16, LEVELS = 1 << LEVELS_LOG2 }; // of the thickness
enum { MOST_CUTS = 7 };                               // in halves
static const double MOST_TWIST_MM = 0.01;             // as the contours' own deviation

void jali_shell_free(jali_context *ctx, jali_shell *shell)
{
    jali_surface_free(ctx, &shell->outer);
    release(ctx, shell->inner);
    release(ctx, shell->solid);
    *shell = (jali_shell){0};
}

void jali_patch_free(jali_context *ctx, jali_patch *patch)
{
    release(ctx, patch->point);
    release(ctx, patch->vertex);
    release(ctx, patch->weight);
    release(ctx, patch->face);
    release(ctx, patch->corner);
    *patch = (jali_patch){0};
}

static jali_status refuse_vertex(jali_context *ctx, const jali_shell *shell, int32_t v, const char *what)
{
    const double *at = shell->outer.mesh.vertex[v];
    return fail(ctx, JALI_BAD_INPUT, "%s at (%.3f, %.3f, %.3f) mm", what, at[0], at[1], at[2]);
}

static void fill_intervals(const jali_shell *shell, int32_t cell_count, interval *solid)
{
    int32_t triangles = shell->outer.mesh.triangle_count;
    for (int32_t t = 0; t < cell_count; t++) {
        solid[t] = (interval){0, t < triangles ? LEVELS : 0};
        if (shell->solid && t < triangles)
            solid[t] = (interval){(int32_t)lrint(shell->solid[t][0] * LEVELS),
                                  (int32_t)lrint(shell->solid[t][1] * LEVELS)};
    }
}

// A place between the skins, on the shell's lattice.
static void place_between(const jali_shell *shell, int32_t vertex, int32_t level, double at[3])
{
    const double *outer = shell->outer.mesh.vertex[vertex], *inner = shell->inner[vertex];
    double share = (double)level / LEVELS;
    for (int k = 0; k < 3; k++) {
        double exact = level == LEVELS ? outer[k] : inner[k] + share * (outer[k] - inner[k]);
        at[k] = rint(exact / shell->unit_mm) * shell->unit_mm;
    }
}

// How the wall over the side from a to b is cut into triangles. Twice its twist is the difference of its two
// diagonals' middles: it leans so that the triangles give way to the solid on its left, and is cut into
// slices until they do so by no more than MOST_TWIST_MM.
static void shape_wall(const jali_shell *shell, int32_t a, int32_t b, uint8_t *leans, uint8_t *slices)
{
    const double *low_a = shell->inner[a], *low_b = shell->inner[b];
    const double *high_a = shell->outer.mesh.vertex[a], *high_b = shell->outer.mesh.vertex[b];
    double along[3], up[3], twist[3], right[3], across = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        along[k] = low_b[k] + high_b[k] - low_a[k] - high_a[k];
        up[k] = high_a[k] + high_b[k] - low_a[k] - low_b[k];
        twist[k] = (low_b[k] + high_a[k]) - (low_a[k] + high_b[k]);
    }
    for (int k = 0; k < 3; k++) {
        right[k] = along[(k + 1) % 3] * up[(k + 2) % 3] - along[(k + 2) % 3] * up[(k + 1) % 3];
        across += right[k] * twist[k];
        length += right[k] * right[k];
    }
    double away = length > 0 ? fabs(across) / sqrt(length) / 4 : 0; // of a triangle from the ruled surface
    *leans = across > 0;
    *slices = 0;
    for (int cuts = 0; cuts < MOST_CUTS && away > MOST_TWIST_MM; cuts++, away /= 2)
        *slices = (uint8_t)(LEVELS_LOG2 - cuts - 1);
}

jali_status jali_shell_solid(jali_context *ctx, const jali_shell *shell, jali_mesh *mesh)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const jali_mesh *outer = &shell->outer.mesh;
    sides linked = {0};
    prisms built = {0};
    interval *solid;
    uint8_t *lean, *slices;
    int32_t stuck;
    *mesh = (jali_mesh){0};
    TRY(sides_create(ctx, outer->vertex_count, outer->triangle_count, (const int32_t(*)[3])outer->triangle,
                     &linked));
    TRY(sides_close(ctx, outer->vertex_count, &linked, &stuck));
    if (stuck >= 0) TRY(refuse_vertex(ctx, shell, stuck, "the surface is not manifold"));
    TRY(ARENA(ctx, solid, linked.cell_count));
    fill_intervals(shell, linked.cell_count, solid);
    TRY(ARENA(ctx, lean, 4 * (size_t)linked.cell_count + 1));
    TRY(ARENA(ctx, slices, 4 * (size_t)linked.cell_count + 1));
    for (int32_t s = 0; s < 4 * outer->triangle_count; s++)
        if ((s & 3) != 3)
            shape_wall(shell, linked.corner[next_side(s)], linked.corner[last_side(s)], &lean[s], &slices[s]);
    cells all = {
        outer->vertex_count, linked.cell_count, linked.corner, linked.beside, linked.star, lean, slices};
    TRY(build_prisms(ctx, &all, solid, &built));
    if (built.contact >= 0)
        TRY(refuse_vertex(ctx, shell, built.contact,
                          "parts of the solid meet in no more than an edge or a point"));
    TRY(ALLOCATE(ctx, mesh->vertex, built.vertex_count + 1));
    mesh->vertex_count = built.vertex_count;
    for (int32_t i = 0; i < built.vertex_count; i++)
        place_between(shell, built.vertex[i][0], built.vertex[i][1], mesh->vertex[i]);
    mesh->triangle_count = built.triangle_count;
    mesh->triangle = built.triangle;
    built.triangle = NULL;
done:
    prisms_free(ctx, &built);
    sides_free(ctx, &linked);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    return status;
}
