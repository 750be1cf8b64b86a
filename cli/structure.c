// What is said and drawn of the structure: maps, figures, words, the report's part.
#include "structure.h"
#include "sparse/solver.h"
#include "base/bytes.h"

#include <jali/png.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

enum { MAP_PX = 1200, RENDER_PX = 640 };

jali_map_options map_of(const jali_strength *s, jali_quantity quantity)
{
    jali_map_options opt = jali_map_defaults();
    opt.quantity = quantity;
    opt.longer_px = MAP_PX;
    if (quantity == JALI_STRESS) opt.limit = s->limit_mpa;
    return opt;
}

static bool ends_in(const char *path, const char *suffix)
{
    size_t length = strlen(path), end = strlen(suffix);
    return length > end && strcasecmp(path + length - end, suffix) == 0;
}

bool is_map(const char *path)
{
    return ends_in(path, ".png") || ends_in(path, ".ply") || ends_in(path, ".vtu");
}

jali_status map_bytes(jali_context *ctx, const jali_result *r, const char *path, jali_quantity quantity,
                      jali_bytes *bytes)
{
    const jali_strength *s = &r->strength;
    jali_map_options opt = map_of(s, quantity);
    if (!s->analysis.node_count)
        return fail(ctx, JALI_BAD_VALUE, "%s: there is nothing to map without a load (--force, --weight ...)",
                    path);
    if (ends_in(path, ".vtu")) return jali_map_vtu(ctx, &s->sheet, &s->analysis, bytes);
    if (ends_in(path, ".ply")) return jali_map_ply(ctx, &s->sheet, &s->analysis, &opt, bytes);
    return jali_map_png(ctx, &s->sheet, &s->analysis, &r->chart, &opt, bytes);
}

// --- Words

static void tell_advice(const settings *set, const jali_strength *s)
{
    const jali_advice *a = &s->advice;
    if (!set->make.strengthen.advise) return;
    if (a->unpierced_mpa > s->limit_mpa)
        say(set, "even unpierced it would not hold: %.3g MPa", a->unpierced_mpa);
    say(set, "as it is it bears %.3g %% of the load", 100 * a->load_share);
    if (a->thickness_mm > 0)
        say(set, "a wall %.3g mm thick would bear it", a->thickness_mm);
    else
        say(set, "no thickness in reach would bear it");
    if (a->material)
        say(set, "%s would bear it", a->material);
    else
        say(set, "none of the listed materials would bear it");
}

void tell_structure(const settings *set, const jali_strength *s)
{
    if (!s->round_count) return;
    const jali_strength_round *first = &s->round[0], *last = &s->round[s->round_count - 1];
    say(set, "largest stress %.3g MPa (raw %.3g), limit %g MPa; it gives way by %.3g mm; %d nodes",
        last->stress_mpa, last->raw_stress_mpa, s->limit_mpa, last->moved_mm, last->nodes);
    if (s->connectors)
        say(set, "%d connector%s laid: %.3g MPa before", s->connectors, s->connectors == 1 ? "" : "s",
            first->stress_mpa);
    if (isfinite(s->change_mpa))
        say(set, "half as many elements across change the stress by %.3g MPa", s->change_mpa);
    if (s->sound) return;
    if (s->helpless) say(set, "no further connector would help");
    tell_advice(set, s);
}

// --- Figures

static json_t *vector_of(const double v[3])
{
    return json_pack("[f, f, f]", v[0], v[1], v[2]);
}

static json_t *rounds_of(const jali_strength *s)
{
    json_t *rounds = json_array();
    for (int32_t i = 0; i < s->round_count; i++) {
        const jali_strength_round *r = &s->round[i];
        json_array_append_new(rounds,
                              json_pack("{s:f, s:f, s:f, s:i, s:i}", "max_stress_mpa", r->stress_mpa,
                                        "raw_max_stress_mpa", r->raw_stress_mpa, "max_displacement_mm",
                                        r->moved_mm, "connectors", r->connectors, "nodes", r->nodes));
    }
    return rounds;
}

static json_t *advice_of(const jali_strength *s)
{
    const jali_advice *a = &s->advice;
    if (s->sound || a->load_share == 0) return json_null();
    return json_pack("{s:f, s:o, s:o, s:f}", "load_share", a->load_share, "thickness_mm",
                     a->thickness_mm > 0 ? json_real(a->thickness_mm) : json_null(), "material",
                     a->material ? json_string(a->material) : json_null(), "unpierced_mpa", a->unpierced_mpa);
}

json_t *structure_of(const settings *set, const jali_strength *s)
{
    static const char *const support[] = {"picture", "rim", "base"};
    const jali_analyse_options *opt = &set->make.strengthen.analyse;
    const jali_analysis *a = &s->analysis;
    if (!s->round_count) return json_null();
    return json_pack("{s:{s:s, s:f, s:f, s:f}, s:s, s:{s:f, s:f, s:f, s:f, s:f}, s:f, s:f, s:o, s:o, s:o, "
                     "s:i, s:o, s:f, s:s, s:b, s:o}",
                     "material", "name", opt->material.name, "e_mpa", opt->material.e_mpa, "nu",
                     opt->material.nu, "limit_mpa", s->limit_mpa, "support", support[opt->support], "load",
                     "force_n", opt->load.force_n, "pressure_mpa", a->pressure_mpa, "weight",
                     opt->load.weight, "push_n", opt->load.push_n, "pinch_n", opt->load.pinch_n, "area_mm2",
                     a->area_mm2, "limit_mpa", s->limit_mpa, "max_stress_at_mm", vector_of(a->stress.at_mm),
                     "max_displacement_at_mm", vector_of(a->moved.at_mm), "rounds", rounds_of(s),
                     "connectors", s->connectors, "change_by_refinement_mpa",
                     isfinite(s->change_mpa) ? json_real(s->change_mpa) : json_null(), "residual",
                     a->residual, "solver", solver_name(), "sound", s->sound, "advice", advice_of(s));
}

// --- The report

static jali_status append_map(jali_context *ctx, const jali_result *r, const jali_sheet *sheet,
                              const jali_analysis *a, const jali_map_options *opt, const char *title,
                              jali_bytes *html)
{
    jali_status status;
    jali_bytes png = {0};
    TRY(jali_map_png(ctx, sheet, a, &r->chart, opt, &png));
    TRY(append_figure(ctx, &png, title, "", html));
done:
    jali_bytes_free(ctx, &png);
    return status;
}

// How many times a displacement must be drawn to be a twentieth of the sheet's size.
static double exaggeration_of(const jali_sheet *sheet, const jali_analysis *a)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, size = 0;
    for (int32_t i = 0; i < sheet->node_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], sheet->node[i][k]);
            high[k] = fmax(high[k], sheet->node[i][k]);
        }
    for (int k = 0; k < 3; k++) size = fmax(size, high[k] - low[k]);
    return a->moved.value > 0 ? size / 20 / a->moved.value : 0;
}

// The sheet as a solid, bent.
static jali_status append_solid(jali_context *ctx, const settings *set, const jali_sheet *sheet,
                                const jali_analysis *a, const jali_map_options *opt, double times,
                                const char *what, jali_bytes *html)
{
    jali_status status;
    jali_mesh mesh = {0};
    uint8_t(*colour)[3] = NULL, *rgb = NULL;
    jali_bytes png = {0};
    jali_render_options view = set->view;
    char title[128];
    snprintf(title, sizeof title, "%s (%.3g times as far)", what, times);
    TRY(jali_map_solid(ctx, sheet, a, opt, times, &mesh, &colour));
    view.width_px = view.height_px = RENDER_PX;
    view.colour = (const uint8_t(*)[3])colour;
    view.lamp = false;
    TRY(ALLOCATE(ctx, rgb, 3 * RENDER_PX * RENDER_PX));
    TRY(jali_render(ctx, &mesh, &view, rgb));
    TRY(jali_rgb_png(ctx, RENDER_PX, RENDER_PX, rgb, &png));
    TRY(append_figure(ctx, &png, title, "", html));
done:
    jali_bytes_free(ctx, &png);
    release(ctx, rgb);
    jali_map_release(ctx, colour);
    jali_mesh_free(ctx, &mesh);
    return status;
}

static jali_status append_rounds(jali_context *ctx, const jali_strength *s, jali_bytes *html)
{
    jali_status status;
    TRY(bytes_print(ctx, html,
                    "<table><tr><th>connectors<th>largest stress, MPa<th>raw, MPa<th>gives way, "
                    "mm<th>nodes</tr>"));
    for (int32_t i = 0; i < s->round_count; i++)
        TRY(bytes_print(ctx, html, "<tr><td>%d<td>%.3g<td>%.3g<td>%.3g<td>%d", s->round[i].connectors,
                        s->round[i].stress_mpa, s->round[i].raw_stress_mpa, s->round[i].moved_mm,
                        s->round[i].nodes));
    TRY(bytes_print(ctx, html, "</table>"));
done:
    return status;
}

static jali_status append_advice(jali_context *ctx, const jali_strength *s, jali_bytes *html)
{
    jali_status status;
    const jali_advice *a = &s->advice;
    if (s->sound || a->load_share == 0) return JALI_OK;
    TRY(bytes_print(ctx, html, "<p>It bears %.3g %% of the load; unpierced it would have %.3g MPa. ",
                    100 * a->load_share, a->unpierced_mpa));
    if (a->thickness_mm > 0)
        TRY(bytes_print(ctx, html, "A wall %.3g mm thick would bear it. ", a->thickness_mm));
    if (a->material) TRY(bytes_print(ctx, html, "%s would bear it.", a->material));
    TRY(bytes_print(ctx, html, "</p>"));
done:
    return status;
}

// Both maps and the bent solid of one state; `when` ends their titles.
static jali_status append_state(jali_context *ctx, const settings *set, const jali_result *r,
                                const jali_sheet *sheet, const jali_analysis *a,
                                const jali_map_options map[2], double times, const char *when,
                                jali_bytes *html)
{
    jali_status status;
    char title[3][64];
    snprintf(title[0], sizeof title[0], "Stress%s", when);
    snprintf(title[1], sizeof title[1], "Gives way%s", when);
    snprintf(title[2], sizeof title[2], "Bent%s", when);
    TRY(append_map(ctx, r, sheet, a, &map[0], title[0], html));
    TRY(append_map(ctx, r, sheet, a, &map[1], title[1], html));
    TRY(append_solid(ctx, set, sheet, a, &map[0], times, title[2], html));
done:
    return status;
}

jali_status append_structure(jali_context *ctx, const settings *set, const jali_result *r, jali_bytes *html)
{
    jali_status status;
    const jali_strength *s = &r->strength;
    const jali_material *material = &set->make.strengthen.analyse.material;
    bool changed = s->before.node_count > 0;
    const jali_sheet *first = changed ? &s->sheet_before : &s->sheet;
    const jali_analysis *worst = changed ? &s->before : &s->analysis;
    jali_map_options map[2] = {map_of(s, JALI_STRESS), map_of(s, JALI_DISPLACEMENT)};
    if (!s->round_count) return JALI_OK;
    map[0].top = fmax(worst->stress.value, s->limit_mpa); // before and after on one scale
    map[1].top = worst->moved.value;
    double times = exaggeration_of(first, worst);
    TRY(bytes_print(ctx, html,
                    "<h3>Strength</h3><p>%s (E %g MPa, &nu; %g), limit %g MPa; %.4g MPa of pressure on %.4g "
                    "cm<sup>2</sup>.</p>",
                    material->name, material->e_mpa, material->nu, s->limit_mpa, s->analysis.pressure_mpa,
                    s->analysis.area_mm2 / 100));
    TRY(append_rounds(ctx, s, html));
    TRY(append_advice(ctx, s, html));
    TRY(bytes_print(ctx, html, "<main>\n"));
    if (changed) TRY(append_state(ctx, set, r, first, worst, map, times, " before", html));
    TRY(append_state(ctx, set, r, &s->sheet, &s->analysis, map, times, changed ? " after" : "", html));
    TRY(bytes_print(ctx, html, "</main>"));
done:
    return status;
}
