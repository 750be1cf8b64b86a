// Analyse: from a sheet and a load to displacements and stresses.
//
// Source:  Binary Image Carving for 3D Printing, section 5: shell elements, the picture's boundary held,
// uniform
//          pressure against the normals. Elements, solver and stresses: docs/analyse.md.
// Limits:  linear; thin or moderately thick walls. How far the model holds where strips are narrower than the
//          wall is thick stands in docs/analyse.md, with figures against solids.
// Checked: tests/test_analyse.c, tests/test_published.c; make judge: CalculiX.
#include "structure/stiffness.h"

#include "structure/loads.h"

#include <math.h>

jali_analyse_options jali_analyse_defaults(void)
{
    int32_t count;
    return (jali_analyse_options){
        .material = jali_material_list(&count)[0], .load = {.spot_mm = 3}, .phi_s_mm = 0.3};
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

// Supports and forces at the nodes.
static jali_status lay_load(jali_context *ctx, const jali_sheet *sheet, uint8_t *held, jali_analysis *a)
{
    jali_status status;
    const jali_analyse_options *opt = &a->stiffness->opt;
    memset(a->stiffness->load, 0, (size_t)sheet->node_count * sizeof *a->stiffness->load);
    TRY(support_nodes(ctx, sheet, opt->support, held));
    TRY(load_nodes(ctx, sheet, opt, held, a->stiffness->load, &a->pressure_mpa));
done:
    return status;
}

// Displacements and stresses, with the stiffness factored.
static jali_status respond(jali_context *ctx, const jali_sheet *sheet, jali_analysis *a)
{
    jali_status status;
    structure *s = &a->stiffness->structure;
    bool rough = a->stiffness->opt.rough;
    TRY((rough ? structure_influence : structure_solve)(ctx, s, 1, (const double(*)[6])a->stiffness->load,
                                                        a->displacement));
    a->residual = rough ? NAN : s->residual;
    TRY(stresses_of(ctx, sheet, &a->stiffness->opt, rough, a));
done:
    return status;
}

jali_status jali_analyse(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *given,
                         jali_analysis *a)
{
    jali_status status;
    jali_analyse_options opt = given ? *given : jali_analyse_defaults();
    uint8_t *held = NULL;
    facet_material made_of = {opt.material.e_mpa, opt.material.nu, 0};
    *a = (jali_analysis){0};
    TRY(check_options(ctx, sheet, &opt));
    TRY(room_for_results(ctx, sheet->node_count, a));
    TRY(ALLOCATE_CLEARED(ctx, a->stiffness, 1));
    TRY(ALLOCATE(ctx, a->stiffness->load, sheet->node_count));
    TRY(ALLOCATE(ctx, held, sheet->node_count));
    a->stiffness->opt = opt;
    TRY(lay_load(ctx, sheet, held, a));
    for (int32_t i = 0; i < sheet->node_count; i++) held[i] = held[i] ? HELD_ALL : 0;
    a->area_mm2 = sheet_area(sheet);
    TRY(structure_create(ctx, sheet, &made_of, held, bends_only(sheet, &opt.load), &a->stiffness->structure));
    TRY(respond(ctx, sheet, a));
done:
    release(ctx, held);
    if (status != JALI_OK) jali_analysis_free(ctx, a);
    return status;
}

jali_status jali_analyse_again(jali_context *ctx, const jali_sheet *sheet, jali_analysis *a)
{
    jali_status status;
    uint8_t *held = NULL;
    TRY(check_options(ctx, sheet, &a->stiffness->opt));
    TRY(ALLOCATE(ctx, held, sheet->node_count));
    TRY(lay_load(ctx, sheet, held, a));
    TRY(structure_refactor(ctx, &a->stiffness->structure));
    TRY(respond(ctx, sheet, a));
done:
    release(ctx, held);
    if (status != JALI_OK) jali_analysis_free(ctx, a);
    return status;
}
