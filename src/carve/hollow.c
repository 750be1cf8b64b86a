// From a surface to a shell: the inner skin (mesh/offset) and what it came to.
//
// Checked: tests/test_shell.c, tests/test_offset.c.
#include <jali/shell.h>

#include "mesh/offset.h"
#include "mesh/sides.h"

#include <math.h>

jali_shell_options jali_shell_defaults(void)
{
    return (jali_shell_options){.thickness_mm = 2, .least_mm = 0.3};
}

static const double LATTICE_UNITS = 16777216; // 2^24: float32 holds every whole number below

static double finest_unit(const jali_mesh *mesh, double beyond_mm)
{
    double extent = beyond_mm, unit = 1;
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++) extent = MAX(extent, fabs(mesh->vertex[v][k]) + beyond_mm);
    while (extent >= unit * LATTICE_UNITS) unit *= 2;
    while (extent < unit / 2 * LATTICE_UNITS) unit /= 2;
    return unit;
}

static jali_status refuse_wall(jali_context *ctx, const jali_mesh *mesh, const jali_shell_options *opt,
                               const offset_report *found)
{
    double at[3] = {0};
    for (int c = 0; c < 3 && found->unsolved >= 0; c++)
        for (int k = 0; k < 3; k++) at[k] += mesh->vertex[mesh->triangle[found->unsolved][c]][k] / 3;
    return fail(
        ctx, JALI_NO_RESULT,
        "a wall of %g mm, the thinnest allowed, folds or meets itself at %d triangle%s, as at (%.2f, %.2f, "
        "%.2f) mm, and cannot be left full there; allow a thinner one, or give a larger or smoother surface",
        opt->least_mm, found->unsolved_triangles, found->unsolved_triangles == 1 ? "" : "s", at[0], at[1],
        at[2]);
}

// Borders that meet in a vertex, or edges of three triangles, have no wall of their own.
static jali_status check_manifold(jali_context *ctx, const jali_mesh *mesh)
{
    jali_status status;
    sides linked = {0};
    int32_t stuck;
    TRY(sides_create(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                     &linked));
    TRY(sides_close(ctx, mesh->vertex_count, &linked, &stuck));
    if (stuck >= 0)
        status =
            fail(ctx, JALI_BAD_INPUT,
                 "the surface is not manifold: rims or more than two triangles meet at (%.2f, %.2f, %.2f) mm",
                 mesh->vertex[stuck][0], mesh->vertex[stuck][1], mesh->vertex[stuck][2]);
done:
    sides_free(ctx, &linked);
    return status;
}

// No picture may lie where the wall is left full.
static jali_status mark_full(jali_context *ctx, const bool *full, jali_surface *surface)
{
    int32_t count = surface->mesh.triangle_count;
    jali_status status = JALI_OK;
    if (!surface->faulty) TRY(ALLOCATE_CLEARED(ctx, surface->faulty, count));
    for (int32_t t = 0; t < count; t++) surface->faulty[t] |= full[t];
done:
    return status;
}

jali_status jali_shell_create(jali_context *ctx, jali_surface *surface, const jali_shell_options *given,
                              jali_shell *shell, jali_shell_report *report)
{
    jali_status status;
    jali_shell_options opt = given ? *given : jali_shell_defaults();
    jali_mesh *mesh = &surface->mesh;
    offset_report found;
    bool *full = NULL;
    *shell = (jali_shell){.unit_mm = finest_unit(mesh, opt.thickness_mm)};
    if (report) *report = (jali_shell_report){.thinnest_mm = opt.thickness_mm};
    if (!(opt.thickness_mm > 0) || !(opt.least_mm > 0) || !isfinite(opt.thickness_mm))
        TRY(fail(ctx, JALI_BAD_VALUE, "the wall's thickness and its least must be above 0 mm, not %g and %g",
                 opt.thickness_mm, opt.least_mm));
    TRY(check_manifold(ctx, mesh));
    TRY(ALLOCATE(ctx, shell->inner, (size_t)mesh->vertex_count + 1));
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++)
            mesh->vertex[v][k] = rint(mesh->vertex[v][k] / shell->unit_mm) * shell->unit_mm;
    const offset_options wall = {.thickness_mm = opt.thickness_mm,
                                 .least_mm = MIN(opt.least_mm, opt.thickness_mm),
                                 .frail = surface->faulty,
                                 .unit_mm = shell->unit_mm};
    TRY(ALLOCATE(ctx, full, mesh->triangle_count));
    TRY(offset_inward(ctx, mesh, &wall, shell->inner, NULL, full, &found));
    if (found.unsolved_triangles > 0) TRY(refuse_wall(ctx, mesh, &opt, &found));
    if (found.full_triangles > 0) TRY(mark_full(ctx, full, surface));
    if (report) report->vertices = mesh->vertex_count;
    if (report && found.full_triangles > 0) {
        report->full_triangles = found.full_triangles;
        memcpy(report->full_at_mm, mesh->vertex[mesh->triangle[found.full][0]], sizeof report->full_at_mm);
    }
    if (report && found.thinnest >= 0) {
        report->thinned = found.thinned;
        report->thinnest_mm = MIN(found.thinnest_mm, opt.thickness_mm);
        memcpy(report->thinnest_at_mm, mesh->vertex[found.thinnest], sizeof report->thinnest_at_mm);
    }
    shell->outer = *surface;
    *surface = (jali_surface){0};
done:
    release(ctx, full);
    if (status != JALI_OK) jali_shell_free(ctx, shell);
    return status;
}
