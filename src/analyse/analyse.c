// Analyse: from a sheet and a load to displacements and stresses.
//
// Source:  Binary Image Carving for 3D Printing, section 5: shell elements, the picture's boundary held,
// uniform
//          pressure against the normals. Elements, solver and stresses: docs/analyse.md.
// Limits:  linear; thin or moderately thick walls. How far the model holds where strips are narrower than the
//          wall is thick stands in docs/analyse.md, with figures against solids.
// Checked: tests/test_analyse.c, tests/test_published.c; make judge: CalculiX.
#include "analyse/stiffness.h"

#include "analyse/loads.h"
#include "analyse/recover.h"

#include <math.h>

jali_analyse_options jali_analyse_defaults(void)
{
    int32_t count;
    return (jali_analyse_options){
        .material = jali_material_list(&count)[0], .load = {.spot_mm = 3}, .phi_s_mm = 0.3};
}

void jali_stiffness_drop(jali_context *ctx, jali_analysis *a)
{
    if (!a->stiffness) return;
    structure_free(ctx, &a->stiffness->structure);
    release(ctx, a->stiffness->load);
    release(ctx, a->stiffness);
    a->stiffness = NULL;
}

void jali_analysis_free(jali_context *ctx, jali_analysis *a)
{
    jali_stiffness_drop(ctx, a);
    release(ctx, a->displacement);
    release(ctx, a->face_mpa);
    release(ctx, a->principal_mpa);
    release(ctx, a->raw_mpa);
    release(ctx, a->mean_mpa);
    *a = (jali_analysis){0};
}

static jali_status check_options(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt)
{
    const jali_material *m = &opt->material;
    if (!(m->e_mpa > 0) || !isfinite(m->e_mpa))
        return fail(ctx, JALI_BAD_VALUE, "Young's modulus is %g MPa; more than 0 is accepted", m->e_mpa);
    if (!(m->nu > -1 && m->nu < 0.5))
        return fail(ctx, JALI_BAD_VALUE, "Poisson's ratio is %g; between -1 and 0.5 is accepted", m->nu);
    if (!(m->density_g_cm3 >= 0) || !isfinite(m->density_g_cm3))
        return fail(ctx, JALI_BAD_VALUE, "the density is %g g/cm3; 0 or more is accepted", m->density_g_cm3);
    if (!(opt->phi_s_mm > 0) || !isfinite(opt->phi_s_mm))
        return fail(ctx, JALI_BAD_VALUE, "the narrowest solid is %g mm; more than 0 is accepted",
                    opt->phi_s_mm);
    if (sheet->triangle_count == 0) return fail(ctx, JALI_NO_RESULT, "there is nothing solid to analyse");
    for (int32_t i = 0; i < sheet->node_count; i++)
        if (!(sheet->thickness_mm[i] > 0) || !isfinite(sheet->thickness_mm[i]))
            return fail(ctx, JALI_BAD_VALUE,
                        "the wall is %g mm thick at (%.4g, %.4g, %.4g) mm; more than 0 is accepted",
                        sheet->thickness_mm[i], sheet->node[i][0], sheet->node[i][1], sheet->node[i][2]);
    return JALI_OK;
}

static jali_status allocate_results(jali_context *ctx, int32_t nodes, jali_analysis *a)
{
    jali_status status;
    a->node_count = nodes;
    TRY(ALLOCATE_CLEARED(ctx, a->stiffness, 1));
    TRY(ALLOCATE_CLEARED(ctx, a->stiffness->load, nodes));
    TRY(ALLOCATE(ctx, a->displacement, nodes));
    TRY(ALLOCATE(ctx, a->face_mpa, nodes));
    TRY(ALLOCATE(ctx, a->principal_mpa, nodes));
    TRY(ALLOCATE(ctx, a->raw_mpa, nodes));
    TRY(ALLOCATE(ctx, a->mean_mpa, nodes));
done:
    return status;
}

static void take_peak(const jali_sheet *sheet, int32_t i, double value, jali_peak *peak)
{
    if (value <= peak->value && peak->node >= 0) return;
    *peak = (jali_peak){.value = value, .node = i};
    memcpy(peak->at_mm, sheet->node[i], sizeof peak->at_mm);
}

static void find_peaks(const jali_sheet *sheet, jali_analysis *a)
{
    a->stress.node = a->raw_stress.node = a->moved.node = -1;
    for (int32_t i = 0; i < a->node_count; i++) {
        const double *u = a->displacement[i];
        take_peak(sheet, i, a->mean_mpa[i], &a->stress);
        take_peak(sheet, i, a->raw_mpa[i], &a->raw_stress);
        take_peak(sheet, i, sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), &a->moved);
    }
}

jali_status stresses_of(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt,
                        jali_analysis *a)
{
    jali_status status;
    stresses s = {0};
    facet_material made_of = {opt->material.e_mpa, opt->material.nu, 0};
    TRY(recover_stresses(ctx, sheet, &made_of, (const double(*)[6])a->displacement, opt->phi_s_mm / 2, &s));
    for (int32_t i = 0; i < a->node_count; i++) {
        for (int k = 0; k < LAYERS; k++) a->face_mpa[i][k] = (float)s.von_mises[i][k];
        a->principal_mpa[i][0] = (float)fmax(s.principal[i][0][0], s.principal[i][1][0]);
        a->principal_mpa[i][1] = (float)fmin(s.principal[i][0][1], s.principal[i][1][1]);
        a->raw_mpa[i] = (float)s.worst[i];
        a->mean_mpa[i] = (float)s.mean[i];
    }
    find_peaks(sheet, a);
    if (!isfinite(a->stress.value) || !isfinite(a->raw_stress.value) || !isfinite(a->moved.value))
        return fail(ctx, JALI_NO_RESULT,
                    "the stiffness cannot be solved in double precision: the wall is too thin or too soft "
                    "somewhere");
done:
    stresses_free(ctx, &s);
    return status;
}

jali_status jali_analyse(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *given,
                         jali_analysis *a)
{
    jali_status status;
    jali_analyse_options opt = given ? *given : jali_analyse_defaults();
    uint8_t *held = NULL;
    double(*force)[3] = NULL;
    facet_material made_of = {opt.material.e_mpa, opt.material.nu, 0};
    *a = (jali_analysis){0};
    TRY(check_options(ctx, sheet, &opt));
    TRY(allocate_results(ctx, sheet->node_count, a));
    TRY(ALLOCATE(ctx, held, sheet->node_count));
    TRY(ALLOCATE_CLEARED(ctx, force, sheet->node_count));
    TRY(support_nodes(ctx, sheet, opt.support, held));
    TRY(load_nodes(ctx, sheet, &opt, held, force, &a->pressure_mpa));
    for (int32_t i = 0; i < sheet->node_count; i++) {
        held[i] = held[i] ? HELD_ALL : 0;
        memcpy(a->stiffness->load[i], force[i], sizeof force[i]);
    }
    a->area_mm2 = sheet_area(sheet);
    a->stiffness->opt = opt;
    structure *s = &a->stiffness->structure;
    TRY(structure_create(ctx, sheet, &made_of, held, bends_only(sheet, &opt.load), s));
    TRY(structure_solve(ctx, s, 1, (const double(*)[6])a->stiffness->load, a->displacement));
    a->residual = s->residual;
    TRY(stresses_of(ctx, sheet, &opt, a));
done:
    release(ctx, held);
    release(ctx, force);
    if (status != JALI_OK) jali_analysis_free(ctx, a);
    return status;
}
