// What is kept of an analysis, and what is read off its displacements.
#include "structure/stiffness.h"

#include "structure/recover.h"

#include <math.h>

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

jali_status room_for_results(jali_context *ctx, int32_t nodes, jali_analysis *a)
{
    jali_status status;
    jali_analysis_free(ctx, a);
    a->node_count = nodes;
    TRY(ALLOCATE_CLEARED(ctx, a->displacement, nodes));
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
                        bool peaks_only, jali_analysis *a)
{
    jali_status status;
    stresses s = {0};
    facet_material made_of = {opt->material.e_mpa, opt->material.nu, 0};
    TRY((peaks_only ? recover_peaks : recover_stresses)(
        ctx, sheet, &made_of, (const double(*)[6])a->displacement, opt->phi_s_mm / 2, &s));
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
