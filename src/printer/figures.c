// What a profile can say.
#include "printer/figures.h"

#include <math.h>

#define FIGURE(name) #name, offsetof(jali_printer, name)

static const figure_key own[] = {
    {FIGURE(tool_mm), 0.0001, 100, " mm", false},
    {FIGURE(layer_mm), 0.0001, 1000, " mm", false},
    {FIGURE(phi_e_solid_mm), -10, 10, " mm", true},
    {FIGURE(phi_e_void_mm), -10, 10, " mm", true},
    {FIGURE(phi_e_solid_spread_mm), 0, 10, " mm", false},
    {FIGURE(phi_e_void_spread_mm), 0, 10, " mm", false},
    {FIGURE(phi_s_mm), 0.001, 100, " mm", true},
    {FIGURE(phi_v_mm), 0.001, 100, " mm", true},
    {FIGURE(hole_mm2), 0, 100, " mm2", false},
    {FIGURE(corner_mm), 0, 100, " mm", false},
};

static const figure_key of_material[] = {
    {FIGURE(e_mpa), 1e-3, 1e7, " MPa", false},
    {FIGURE(nu), -0.999, 0.499, "", false},
    {FIGURE(density_g_cm3), 1e-3, 30, " g/cm3", false},
    {FIGURE(limit_mpa), 1e-6, 1e6, " MPa", false},
};

const figure_key *figure_keys(int32_t *count)
{
    *count = sizeof own / sizeof *own;
    return own;
}

const figure_key *material_keys(int32_t *count)
{
    *count = sizeof of_material / sizeof *of_material;
    return of_material;
}

static const jali_figure *figure_in(const jali_printer *printer, const figure_key *k)
{
    return (const jali_figure *)((const char *)printer + k->offset);
}

static jali_status check_figures(jali_context *ctx, const jali_printer *printer, const figure_key *key,
                                 int32_t count, const char *name, jali_status wrong)
{
    for (int32_t i = 0; i < count; i++) {
        const jali_figure *f = figure_in(printer, &key[i]);
        if (!*f->source && key[i].needed)
            return fail(ctx, wrong, "the printer profile %.100s does not say \"%s\", and inherits none", name,
                        key[i].key);
        if (*f->source && !(f->value >= key[i].least && f->value <= key[i].most))
            return fail(ctx, wrong, "the printer profile %.100s: \"%s\" is %g; %g to %g%s is accepted", name,
                        key[i].key, f->value, key[i].least, key[i].most, key[i].unit);
    }
    return JALI_OK;
}

// What is drawn as wide as the narrowest that prints must come out with a width.
static jali_status check_widths(jali_context *ctx, const jali_printer *p, const char *name, jali_status wrong)
{
    if (!(p->phi_s_mm.value + p->phi_e_solid_mm.value > 0))
        return fail(ctx, wrong,
                    "the printer profile %.100s: a solid of \"phi_s_mm\", %g mm, would come out %g mm wide "
                    "(\"phi_e_solid_mm\" is %g)",
                    name, p->phi_s_mm.value, p->phi_s_mm.value + p->phi_e_solid_mm.value,
                    p->phi_e_solid_mm.value);
    if (!(p->phi_v_mm.value - p->phi_e_void_mm.value > 0))
        return fail(ctx, wrong,
                    "the printer profile %.100s: a void of \"phi_v_mm\", %g mm, would come out %g mm wide "
                    "(\"phi_e_void_mm\" is %g)",
                    name, p->phi_v_mm.value, p->phi_v_mm.value - p->phi_e_void_mm.value,
                    p->phi_e_void_mm.value);
    return JALI_OK;
}

static jali_status check_material(jali_context *ctx, const jali_printer *p, const char *name,
                                  jali_status wrong)
{
    int32_t said = 0;
    for (int32_t i = 0; i < 4; i++) said += *figure_in(p, &of_material[i])->source != 0;
    if (said != 0 && said != 4)
        return fail(ctx, wrong,
                    "the printer profile %.100s: a \"material\" of its own needs \"e_mpa\", \"nu\", "
                    "\"density_g_cm3\" and \"limit_mpa\"",
                    name);
    if (said == 0 && *p->material && !jali_material_find(p->material))
        return fail(
            ctx, wrong,
            "the printer profile %.100s: there is no material \"%s\" (jali list materials), and it has no "
            "figures of its own",
            name, p->material);
    return JALI_OK;
}

jali_status check_printer(jali_context *ctx, const jali_printer *p, const char *name, jali_status wrong)
{
    jali_status status;
    if (!*p->name) return fail(ctx, wrong, "the printer profile %.100s has no \"name\"", name);
    TRY(check_figures(ctx, p, own, sizeof own / sizeof *own, name, wrong));
    TRY(check_figures(ctx, p, of_material, 4, name, wrong));
    for (int32_t k = 0; k < 3; k++)
        if (*p->bed_mm[k].source && !(p->bed_mm[k].value > 0 && p->bed_mm[k].value <= LARGEST_BED_MM))
            return fail(
                ctx, wrong,
                "the printer profile %.100s: \"bed_mm\" holds %g; more than 0 and up to %d mm is accepted",
                name, p->bed_mm[k].value, LARGEST_BED_MM);
    TRY(check_widths(ctx, p, name, wrong));
    TRY(check_material(ctx, p, name, wrong));
done:
    return status;
}
