// From a mask to one that bears its load: sheet, analysis, connectors, and again.
//
// Source:  Binary Image Carving for 3D Printing, section 5.
// The search for connectors goes on a sheet with half as many elements across: a quarter of the cost, and its
// stresses differ by a share that is known (the last fine analysis tells it) and reckoned with. Connectors
// are attached to that sheet's factorised stiffness, then drawn into the mask by the same rules as the image
// method's bridges, and what that gives is traced, triangulated and factorised afresh: what is said of the
// result is never an estimate. Ends:    rounds are counted, and a search that brings no connector is the
// last. Checked: tests/test_strengthen.c; docs/results.md on Table 1's pictures.
#include <jali/strengthen.h>

#include "base/base.h"
#include "sparse/solver.h"

#include <math.h>

// A search goes on until its estimate is this share of the limit: drawing a connector changes it a little.
static const double MARGIN = 0.97;
// The fine sheet's stress is at most so many times the coarse one's, as far as a search believes it.
static const double MOST_APART = 1.5;

jali_strengthen_options jali_strengthen_defaults(void)
{
    return (jali_strengthen_options){.analyse = jali_analyse_defaults(),
                                     .reinforce = jali_reinforce_defaults(),
                                     .across = jali_sheet_defaults().across,
                                     .advise = true,
                                     .refine = true};
}

void jali_strength_free(jali_context *ctx, jali_strength *s)
{
    release(ctx, s->round);
    jali_analysis_free(ctx, &s->analysis);
    jali_analysis_free(ctx, &s->before);
    jali_sheet_free(ctx, &s->sheet);
    jali_sheet_free(ctx, &s->sheet_before);
    *s = (jali_strength){0};
}

/// A sheet with its analysis. {0} is valid and empty.
typedef struct look {
    jali_sheet sheet;
    jali_analysis analysis;
} look;

static void look_free(jali_context *ctx, look *l)
{
    jali_analysis_free(ctx, &l->analysis);
    jali_sheet_free(ctx, &l->sheet);
}

/// What the passes share.
typedef struct job {
    const jali_chart *chart;
    const jali_wall *wall;
    const jali_optimise_options *optimise;
    const jali_trace_options *trace;
    jali_strengthen_options opt;
    jali_sheet_options fine, coarse;
    jali_optimised *optimised;
    jali_contours *outline;
    look draft; // of the outline as it is, on the coarse sheet; empty when there is none yet
    int32_t rounds_left;
    size_t round_capacity;
    jali_strength *s;
} job;

static jali_status make_sheet(jali_context *ctx, const job *j, const jali_contours *outline,
                              const jali_sheet_options *opt, jali_sheet *sheet)
{
    jali_status status;
    jali_contours plate = {0};
    if (!j->wall->plate)
        return jali_sheet_shell(ctx, outline, j->chart, j->wall->patch, j->wall->shell, opt, sheet);
    TRY(jali_plate(ctx, outline, j->chart, j->wall->plate, &plate));
    TRY(jali_sheet_plate(ctx, &plate, j->chart, j->wall->plate->thickness_mm, opt, sheet));
done:
    jali_contours_free(ctx, &plate);
    return status;
}

static jali_status record(jali_context *ctx, job *j, double stress, double raw, double moved,
                          int32_t connectors, int32_t nodes)
{
    jali_strength *s = j->s;
    jali_status status = GROW(ctx, s->round, j->round_capacity, s->round_count + 1);
    if (status != JALI_OK) return status;
    s->round[s->round_count++] = (jali_strength_round){stress, raw, moved, connectors, nodes};
    return JALI_OK;
}

// The outline as it is, finely: what counts. The stiffness is of no further use.
static jali_status judge_fine(jali_context *ctx, void *of_job)
{
    jali_status status;
    job *j = of_job;
    jali_strength *s = j->s;
    const jali_analysis *a = &s->analysis;
    TRY(make_sheet(ctx, j, j->outline, &j->fine, &s->sheet));
    TRY(jali_analyse(ctx, &s->sheet, &j->opt.analyse, &s->analysis));
    jali_stiffness_drop(ctx, &s->analysis);
    TRY(record(ctx, j, a->stress.value, a->raw_stress.value, a->moved.value, s->connectors,
               s->sheet.node_count));
    s->sound = a->stress.value <= s->limit_mpa;
done:
    return status;
}

static jali_status make_draft(jali_context *ctx, void *of_job)
{
    jali_status status;
    job *j = of_job;
    jali_analyse_options opt = j->opt.analyse;
    opt.rough = true;
    look_free(ctx, &j->draft);
    TRY(make_sheet(ctx, j, j->outline, &j->coarse, &j->draft.sheet));
    TRY(jali_analyse(ctx, &j->draft.sheet, &opt, &j->draft.analysis));
done:
    return status;
}

// The draft of the same outline, when it is asked for and not there, is made meanwhile.
static jali_status judge(jali_context *ctx, job *j)
{
    bool drafts = j->opt.refine && !j->draft.sheet.node_count;
    if (drafts && solver_serves_threads()) return do_both(ctx, judge_fine, j, make_draft, j);
    jali_status status = judge_fine(ctx, j);
    return status == JALI_OK && drafts ? make_draft(ctx, j) : status;
}

// What was judged becomes "before" when it is the first, and goes otherwise.
static void set_aside(jali_context *ctx, jali_strength *s)
{
    if (!s->before.node_count) {
        s->before = s->analysis;
        s->sheet_before = s->sheet;
    } else {
        jali_analysis_free(ctx, &s->analysis);
        jali_sheet_free(ctx, &s->sheet);
    }
    s->analysis = (jali_analysis){0};
    s->sheet = (jali_sheet){0};
}

static jali_status draw(jali_context *ctx, job *j, const jali_bridges *bridges)
{
    jali_status status;
    TRY(jali_optimise_add(ctx, bridges, j->chart, j->optimise, j->optimised));
    jali_contours_free(ctx, j->outline);
    TRY(jali_trace(ctx, &j->optimised->mask, j->chart, j->trace, j->outline));
done:
    return status;
}

// One search on the draft, and what it found drawn. True when it found something.
static jali_status search(jali_context *ctx, job *j, double limit, bool *found)
{
    jali_status status;
    jali_strength *s = j->s;
    jali_reinforcement r = {0};
    jali_bitmap blocked = {0};
    jali_reinforce_options opt = j->opt.reinforce;
    opt.limit_mpa = limit;
    opt.most_rounds = j->rounds_left;
    TRY(jali_optimise_blocked(ctx, j->chart, j->optimise, j->optimised, &blocked));
    if (blocked.word) opt.blocked = &blocked;
    TRY(jali_reinforce(ctx, &j->draft.sheet, &j->optimised->mask, j->chart, &opt, &j->draft.analysis, &r));
    j->rounds_left -= r.round_count;
    s->helpless = r.helpless;
    *found = r.bridges.count > 0;
    if (*found) { // of a search in vain there is nothing to tell
        for (int32_t i = 0; i < r.round_count; i++)
            TRY(record(ctx, j, r.round[i].stress_mpa, r.round[i].raw_stress_mpa, r.round[i].moved_mm,
                       s->connectors + r.round[i].connectors, j->draft.sheet.node_count));
        s->connectors += r.connectors;
        TRY(draw(ctx, j, &r.bridges));
        look_free(ctx, &j->draft);
        if (j->rounds_left > 0) TRY(make_draft(ctx, j)); // else judge() does
    }
done:
    jali_bitmap_free(ctx, &blocked);
    jali_reinforcement_free(ctx, &r);
    return status;
}

// Search until the draft says that the fine sheet would hold, nothing helps, or the rounds are over.
static jali_status strengthen(jali_context *ctx, job *j, bool *changed)
{
    jali_status status;
    *changed = false;
    if (!j->draft.sheet.node_count) TRY(make_draft(ctx, j));
    double apart = fmin(fmax(1, j->s->analysis.stress.value / j->draft.analysis.stress.value), MOST_APART);
    double limit = MARGIN * j->s->limit_mpa / apart;
    while (j->rounds_left > 0 && j->draft.analysis.stress.value > limit) {
        bool found;
        TRY(search(ctx, j, limit, &found));
        *changed |= found;
        if (!found) break;
    }
done:
    return status;
}

// --- What would do

// Largest stress of the draft when its thickness is `times` what it is.
static jali_status stress_when_thicker(jali_context *ctx, look *draft, double times, double *stress)
{
    jali_status status;
    jali_sheet *sheet = &draft->sheet;
    for (int32_t i = 0; i < sheet->node_count; i++) sheet->thickness_mm[i] *= times;
    TRY(jali_analyse_again(ctx, sheet, &draft->analysis));
    *stress = draft->analysis.stress.value;
done:
    for (int32_t i = 0; i < sheet->node_count; i++) sheet->thickness_mm[i] /= times;
    return status;
}

// The stress falls as a power of the thickness, nearly: a secant through the logarithms, on the safe side.
// Bent plates have -2, twisted narrow strips less: Table 1's flat pictures -1.5 to -1.8.
static jali_status thickness_that_does(jali_context *ctx, job *j)
{
    enum { MOST_TRIES = 5 };
    const double most_times = 100;
    jali_status status;
    jali_strength *s = j->s;
    double times[2] = {1, 1}, stress[2] = {0, 0}, mean = 0;
    if (!j->draft.sheet.node_count) TRY(make_draft(ctx, j));
    const jali_sheet *sheet = &j->draft.sheet;
    for (int32_t i = 0; i < sheet->node_count; i++) mean += sheet->thickness_mm[i] / sheet->node_count;
    stress[0] = j->draft.analysis.stress.value;
    double fine_by_coarse = fmax(1, s->analysis.stress.value / stress[0]), power = -1.7;
    double limit = s->limit_mpa / fine_by_coarse;
    for (int32_t i = 0; i < MOST_TRIES; i++) {
        times[1] = times[0] * pow(0.98 * limit / stress[0], 1 / power);
        if (!(times[1] <= most_times)) return JALI_OK;
        TRY(stress_when_thicker(ctx, &j->draft, times[1], &stress[1]));
        if (stress[1] <= limit && stress[1] > 0.93 * limit) break;
        if (times[1] != times[0]) power = fmin(-0.3, log(stress[1] / stress[0]) / log(times[1] / times[0]));
        times[0] = times[1];
        stress[0] = stress[1];
    }
    if (stress[1] <= limit) s->advice.thickness_mm = mean * times[1];
done:
    return status;
}

// Without the picture: the same wall, nothing pierced.
static jali_status stress_unpierced(jali_context *ctx, const job *j)
{
    jali_status status;
    jali_contours none = {0};
    jali_bitmap whole = {0};
    jali_sheet sheet = {0};
    jali_analysis a = {0};
    TRY(jali_bitmap_create(ctx, j->chart->width_px, j->chart->height_px, &whole));
    for (int32_t y = 0; y < whole.height_px; y++)
        for (int32_t x = 0; x < whole.width_px; x++) jali_bitmap_set(&whole, x, y, true);
    TRY(jali_trace(ctx, &whole, j->chart, NULL, &none));
    TRY(make_sheet(ctx, j, &none, &j->fine, &sheet));
    TRY(jali_analyse(ctx, &sheet, &j->opt.analyse, &a));
    j->s->advice.unpierced_mpa = a.stress.value;
done:
    jali_analysis_free(ctx, &a);
    jali_sheet_free(ctx, &sheet);
    jali_contours_free(ctx, &none);
    jali_bitmap_free(ctx, &whole);
    return status;
}

// Stresses of a force do not depend on E; on nu hardly. Its own weight does on the density: then by that.
static const char *material_that_does(const job *j, double stress)
{
    int32_t count;
    const jali_material *list = jali_material_list(&count), *best = NULL;
    for (int32_t i = 0; i < count; i++) {
        double heavier = j->opt.analyse.load.weight != 0
                             ? fmax(1, list[i].density_g_cm3 / j->opt.analyse.material.density_g_cm3)
                             : 1;
        if (list[i].limit_mpa >= 1.02 * stress * heavier && (!best || list[i].limit_mpa < best->limit_mpa))
            best = &list[i];
    }
    return best ? best->name : NULL;
}

static jali_status advise(jali_context *ctx, job *j)
{
    jali_status status;
    jali_strength *s = j->s;
    s->advice.load_share = s->limit_mpa / s->analysis.stress.value;
    s->advice.material = material_that_does(j, s->analysis.stress.value);
    TRY(thickness_that_does(ctx, j));
    if (!s->advice.unpierced_mpa) TRY(stress_unpierced(ctx, j));
done:
    return status;
}

// Connectors fill voids, at best all of them: where that does not hold, none is laid.
static jali_status rule_out(jali_context *ctx, job *j)
{
    jali_status status;
    jali_strength *s = j->s;
    if (s->sound || j->rounds_left == 0) return JALI_OK;
    TRY(stress_unpierced(ctx, j));
    s->helpless = s->advice.unpierced_mpa > s->limit_mpa;
    if (s->helpless) j->rounds_left = 0;
done:
    return status;
}

static jali_status settle(jali_context *ctx, job *j)
{
    const jali_optimise_options *printer = j->optimise;
    jali_strengthen_options *opt = &j->opt;
    if (!(opt->analyse.material.limit_mpa > 0) || !isfinite(opt->analyse.material.limit_mpa))
        return fail(ctx, JALI_BAD_VALUE, "the limit is %g MPa; more than 0 is accepted",
                    opt->analyse.material.limit_mpa);
    opt->analyse.phi_s_mm = opt->reinforce.phi_s_mm = printer->phi_s_mm;
    opt->reinforce.phi_v_mm = printer->phi_v_mm;
    j->fine = (jali_sheet_options){.phi_s_mm = printer->phi_s_mm,
                                   .across = opt->across,
                                   .whole = opt->analyse.support != JALI_SUPPORT_PICTURE};
    j->coarse = j->fine;
    j->coarse.across = MAX(1, opt->across / 2);
    j->rounds_left = opt->reinforce.rule == JALI_REINFORCE_NONE ? 0 : opt->reinforce.most_rounds;
    j->s->limit_mpa = opt->analyse.material.limit_mpa;
    return JALI_OK;
}

jali_status jali_strengthen(jali_context *ctx, const jali_chart *chart, const jali_wall *wall,
                            const jali_optimise_options *optimise, const jali_trace_options *trace,
                            const jali_strengthen_options *given, jali_optimised *optimised,
                            jali_contours *outline, jali_strength *s)
{
    jali_status status;
    job j = {.chart = chart,
             .wall = wall,
             .optimise = optimise,
             .trace = trace,
             .opt = given ? *given : jali_strengthen_defaults(),
             .optimised = optimised,
             .outline = outline,
             .s = s};
    bool changed = true;
    *s = (jali_strength){.change_mpa = NAN};
    TRY(settle(ctx, &j));
    TRY(judge(ctx, &j));
    TRY(rule_out(ctx, &j));
    while (!s->sound && changed && j.rounds_left > 0) {
        TRY(strengthen(ctx, &j, &changed));
        if (!changed) break;
        set_aside(ctx, s);
        TRY(judge(ctx, &j));
    }
    if (j.draft.sheet.node_count) s->change_mpa = s->analysis.stress.value - j.draft.analysis.stress.value;
    if (s->sound) s->advice = (jali_advice){0};
    if (!s->sound && j.opt.advise) TRY(advise(ctx, &j));
done:
    look_free(ctx, &j.draft);
    if (status != JALI_OK) jali_strength_free(ctx, s);
    return status;
}
