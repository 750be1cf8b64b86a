// From a surface to a shell: the inner skin.
//
// Checked: tests/test_shell.c.
#include <jali/shell.h>

#include "base/base.h"

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

jali_status jali_shell_create(jali_context *ctx, jali_surface *surface, const jali_shell_options *given,
                              jali_shell *shell, jali_shell_report *report)
{
    jali_status status;
    jali_shell_options opt = given ? *given : jali_shell_defaults();
    jali_mesh *mesh = &surface->mesh;
    *shell = (jali_shell){.unit_mm = finest_unit(mesh, opt.thickness_mm)};
    if (report) *report = (jali_shell_report){.thinnest_mm = opt.thickness_mm};
    TRY(ALLOCATE_CLEARED(ctx, shell->inner, mesh->vertex_count + 1));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *c = mesh->triangle[t];
        double u[3], v[3];
        for (int k = 0; k < 3; k++) {
            u[k] = mesh->vertex[c[1]][k] - mesh->vertex[c[0]][k];
            v[k] = mesh->vertex[c[2]][k] - mesh->vertex[c[0]][k];
        }
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                shell->inner[c[i]][k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        double *n = shell->inner[v], length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) {
            double inner = mesh->vertex[v][k] - opt.thickness_mm * n[k] / length;
            n[k] = rint(inner / shell->unit_mm) * shell->unit_mm;
            mesh->vertex[v][k] = rint(mesh->vertex[v][k] / shell->unit_mm) * shell->unit_mm;
        }
    }
    shell->outer = *surface;
    *surface = (jali_surface){0};
done:
    if (status != JALI_OK) jali_shell_free(ctx, shell);
    return status;
}
