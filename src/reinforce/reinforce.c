// Reinforce: connectors where they relieve the largest stress most, or by the paper's rule.
//
// Source:  Binary Image Carving for 3D Printing, section 5: "iteratively search the largest displacement
// region and add
//          connectors between the weak part and its closest neighbouring part".
// How:     a round finds the hot spots and what their stress depends on (one solution each), ranks the ways
// across
//          voids by what a connector there would do (rank.c), attaches the best of them as elements to the
//          factorised stiffness (structure/attach.h) and looks at the stresses anew. At the end connectors
//          whose absence would do no harm are withdrawn.
// Ends:    rounds are counted; each adds a connector or is the last.
// Checked: tests/test_reinforce.c
#include "structure/attach.h"
#include "structure/loads.h"
#include "structure/stiffness.h"
#include "reinforce/plank.h"
#include "reinforce/rank.h"

#include <math.h>

jali_reinforce_options jali_reinforce_defaults(void)
{
    return (jali_reinforce_options){
        .limit_mpa = 10, .phi_s_mm = 0.3, .phi_v_mm = 0.5, .most_at_once = 16, .most_rounds = 16};
}

void jali_reinforcement_free(jali_context *ctx, jali_reinforcement *r)
{
    jali_bridges_free(ctx, &r->bridges);
    release(ctx, r->round);
    *r = (jali_reinforcement){0};
}

/// A connector that is attached.
typedef struct connector {
    span span;
    plank plank;
    beam beam;
    int32_t name; // in the attachments
} connector;

typedef struct search {
    const jali_sheet *sheet;
    const jali_bitmap *mask;
    const jali_chart *chart;
    jali_reinforce_options opt;
    jali_analysis *analysis;
    structure *structure;
    borders borders;
    spans spans;
    attachments attached;
    connector *connector; // [count]
    int32_t count;
    size_t capacity, round_capacity;
    double (*u)[6];    // [node_count] of the sheet, connectors and all
    jali_sheet joined; // the sheet with its planks
    jali_analysis now; // of the joined sheet
} search;

static void search_free(jali_context *ctx, search *s)
{
    for (int32_t i = 0; i < s->count; i++) plank_free(ctx, &s->connector[i].plank);
    release(ctx, s->connector);
    attachments_free(ctx, &s->attached);
    borders_free(ctx, &s->borders);
    release(ctx, s->spans.span);
    release(ctx, s->u);
    jali_sheet_free(ctx, &s->joined);
    jali_analysis_free(ctx, &s->now);
}

static const jali_analyse_options *analysed_as(const search *s)
{
    return &s->analysis->stiffness->opt;
}

// --- With the connectors there are

static jali_status join(jali_context *ctx, search *s)
{
    jali_status status;
    plank *planks = NULL;
    jali_sheet_free(ctx, &s->joined);
    TRY(ALLOCATE(ctx, planks, s->count));
    for (int32_t i = 0; i < s->count; i++) planks[i] = s->connector[i].plank;
    TRY(join_planks(ctx, s->sheet, planks, s->count, &s->joined));
done:
    release(ctx, planks);
    return status;
}

// Displacements and stresses of the sheet with its connectors.
static jali_status look(jali_context *ctx, search *s)
{
    jali_status status;
    int32_t n = s->sheet->node_count, own = n;
    const double(*load)[6] = (const double(*)[6])s->analysis->stiffness->load;
    TRY(attached_solve(ctx, &s->attached, 1, load, (const double(*)[6])s->analysis->displacement, true,
                       s->u));
    TRY(join(ctx, s));
    TRY(room_for_results(ctx, s->joined.node_count, &s->now));
    memcpy(s->now.displacement, s->u, (size_t)n * sizeof *s->u);
    for (int32_t i = 0; i < s->count; i++) {
        own_displacements(&s->attached, s->connector[i].name, 0, (const double(*)[6])s->u,
                          s->now.displacement + own);
        own += s->connector[i].plank.node_count - s->connector[i].plank.end_count;
    }
    TRY(stresses_of(ctx, &s->joined, analysed_as(s), true, &s->now));
done:
    return status;
}

// Before the first connector: as the sheet was analysed.
static jali_status look_back(jali_context *ctx, search *s)
{
    jali_status status;
    const jali_analysis *was = s->analysis;
    size_t n = (size_t)s->sheet->node_count;
    TRY(room_for_results(ctx, s->sheet->node_count, &s->now));
    memcpy(s->u, was->displacement, n * sizeof *s->u);
    memcpy(s->now.mean_mpa, was->mean_mpa, n * sizeof *was->mean_mpa);
    s->now.stress = was->stress;
done:
    return status;
}

static jali_status record(jali_context *ctx, search *s, jali_reinforcement *r)
{
    jali_status status = GROW(ctx, r->round, s->round_capacity, r->round_count + 1);
    if (status != JALI_OK) return status;
    r->round[r->round_count++] =
        (jali_reinforce_round){s->now.stress.value, s->now.raw_stress.value, s->now.moved.value, s->count};
    return JALI_OK;
}

// The load that a plank carries, by its own nodes.
static jali_status plank_load(jali_context *ctx, const search *s, const plank *p, double (**load)[6])
{
    jali_sheet sheet = {.node_count = p->node_count,
                        .triangle_count = p->triangle_count,
                        .node = p->node,
                        .thickness_mm = p->thickness_mm,
                        .triangle = p->triangle,
                        .flat = s->sheet->flat};
    jali_status status = ALLOCATE_CLEARED(ctx, *load, p->node_count);
    if (status == JALI_OK) carried_load(&sheet, analysed_as(s), s->analysis->pressure_mpa, *load);
    return status;
}

// Attach a plank along a span; where there is no room for one, nothing is.
static jali_status lay_connector(jali_context *ctx, search *s, const span *way)
{
    jali_status status;
    connector c = {.span = *way};
    double(*load)[6] = NULL;
    TRY(plank_create(ctx, s->sheet, &s->borders, way, &c.plank));
    if (c.plank.end_count == 0) return JALI_OK;
    TRY(plank_load(ctx, s, &c.plank, &load));
    TRY(GROW(ctx, s->connector, s->capacity, s->count + 1));
    int32_t ends = c.plank.end_count;
    bridge b = {.end_count = ends,
                .own_count = c.plank.node_count - ends,
                .triangle_count = c.plank.triangle_count,
                .end = c.plank.end,
                .own = (const double(*)[3])c.plank.node + ends,
                .thickness_mm = c.plank.thickness_mm + ends,
                .triangle = (const int32_t(*)[3])c.plank.triangle,
                .load = (const double(*)[6])load};
    TRY(attach(ctx, &s->attached, &b, &c.name));
    beam_along(s->sheet, &s->borders, way, &analysed_as(s)->material, s->structure->bending_only, &c.beam);
    s->connector[s->count++] = c;
    c.plank = (plank){0};
done:
    release(ctx, load);
    plank_free(ctx, &c.plank);
    return status;
}

// --- The best

typedef struct gradient_job {
    const search *s;
    const outlook *now;
    const int32_t *node;   // of the hot spots
    double (*gradient)[6]; // [hotspot_count * node_count]
} gradient_job;

static void find_gradient(void *shared, int32_t h)
{
    const gradient_job *job = shared;
    const jali_analyse_options *opt = analysed_as(job->s);
    stress_gradient(job->s->sheet, &opt->material, job->now->u, job->node[h], opt->phi_s_mm / 2,
                    job->gradient + (size_t)h * job->s->sheet->node_count);
}

// Hot spots of the sheet, and K^-1 times the gradient of each.
static jali_status know_outlook(jali_context *ctx, search *s, double (*adjoint)[6], outlook *now)
{
    jali_status status;
    int32_t n = s->sheet->node_count, node[MOST_HOTSPOTS];
    double(*gradient)[6] = NULL;
    const jali_analyse_options *opt = analysed_as(s);
    *now = (outlook){.u = (const double(*)[6])s->u};
    now->hotspot_count = find_hotspots(s->sheet, s->now.mean_mpa, 8 * opt->phi_s_mm, node);
    TRY(ALLOCATE(ctx, gradient, (size_t)now->hotspot_count * (size_t)n));
    for (int32_t h = 0; h < now->hotspot_count; h++) {
        now->stress_mpa[h] = s->now.mean_mpa[node[h]];
        now->adjoint[h] = (const double(*)[6])adjoint + (size_t)h * n;
    }
    parallel(ctx, now->hotspot_count, find_gradient, &(gradient_job){s, now, node, gradient});
    const double(*loads)[6] = (const double(*)[6])gradient;
    TRY(structure_influence(ctx, s->structure, now->hotspot_count, loads, adjoint));
    if (s->count > 0)
        TRY(attached_solve(ctx, &s->attached, now->hotspot_count, loads, (const double(*)[6])adjoint, false,
                           adjoint));
    for (int32_t i = 0; i < n; i++) {
        const double *f = s->analysis->stiffness->load[i];
        now->load_n += fabs(f[0]) + fabs(f[1]) + fabs(f[2]);
    }
done:
    release(ctx, gradient);
    return status;
}

static jali_status lay_best(jali_context *ctx, search *s)
{
    jali_status status;
    double(*adjoint)[6] = NULL;
    beam *laid = NULL;
    span *chosen = NULL;
    outlook now;
    rank_options opt = {.width_mm = s->opt.phi_s_mm,
                        .apart_mm = s->opt.phi_v_mm,
                        .pixel_mm = jali_chart_pixel_mm(s->chart),
                        .limit_mpa = s->opt.limit_mpa,
                        .most = s->opt.most_at_once};
    int32_t count = 0;
    TRY(ALLOCATE(ctx, adjoint, MOST_HOTSPOTS * (size_t)s->sheet->node_count));
    TRY(ALLOCATE(ctx, laid, s->count));
    TRY(ALLOCATE(ctx, chosen, opt.most));
    for (int32_t i = 0; i < s->count; i++) laid[i] = s->connector[i].beam;
    TRY(know_outlook(ctx, s, adjoint, &now));
    TRY(rank_spans(ctx, s->structure, s->sheet, &s->borders, &s->spans, laid, s->count,
                   &analysed_as(s)->material, &now, &opt, chosen, &count));
    for (int32_t i = 0; i < count; i++) TRY(lay_connector(ctx, s, &chosen[i]));
done:
    release(ctx, adjoint);
    release(ctx, laid);
    release(ctx, chosen);
    return status;
}

// --- The paper's rule

// The most displaced region: nodes joined to the one that moved most which moved at least 0.8 times as far.
static jali_status weakest_region(jali_context *ctx, const search *s, uint8_t *inside)
{
    jali_status status;
    const double share = 0.8;
    int32_t n = s->sheet->node_count;
    double *moved = NULL, most = 0;
    int32_t top = 0;
    bool grown = true;
    TRY(ALLOCATE(ctx, moved, n));
    for (int32_t i = 0; i < n; i++) {
        moved[i] = hypot(hypot(s->u[i][0], s->u[i][1]), s->u[i][2]);
        if (moved[i] > most) most = moved[top = i];
        inside[i] = 0;
    }
    inside[top] = 1;
    while (grown) { // by sweeps to and fro over the triangles
        grown = false;
        for (int32_t k = 0; k < 2 * s->sheet->triangle_count; k++) {
            int32_t t = k < s->sheet->triangle_count ? k : 2 * s->sheet->triangle_count - 1 - k;
            const int32_t *c = s->sheet->triangle[t];
            if (!inside[c[0]] && !inside[c[1]] && !inside[c[2]]) continue;
            for (int i = 0; i < 3; i++)
                if (!inside[c[i]] && moved[c[i]] >= share * most) inside[c[i]] = grown = 1;
        }
    }
done:
    release(ctx, moved);
    return status;
}

// The shortest way from the weakest region to solid outside it.
static jali_status lay_by_the_paper(jali_context *ctx, search *s)
{
    jali_status status;
    uint8_t *inside = NULL;
    const span *best = NULL;
    TRY(ALLOCATE(ctx, inside, s->sheet->node_count));
    TRY(weakest_region(ctx, s, inside));
    for (int32_t i = 0; i < s->spans.count; i++) {
        span *way = &s->spans.span[i];
        way->width_mm = s->opt.phi_s_mm;
        if (inside[way->node[0]] == inside[way->node[1]] || (best && way->length_mm >= best->length_mm))
            continue;
        bool taken = !plank_has_room(s->sheet, &s->borders, way);
        for (int32_t k = 0; k < s->count && !taken; k++)
            taken = spans_apart(s->sheet, way, &s->connector[k].span) < s->opt.phi_s_mm + s->opt.phi_v_mm;
        if (!taken) best = way;
    }
    if (best) TRY(lay_connector(ctx, s, best));
done:
    release(ctx, inside);
    return status;
}

// --- Which were of use

// The largest stress in a connector's own nodes.
static double stress_in(const search *s, int32_t which)
{
    int32_t first = s->sheet->node_count;
    double most = 0;
    for (int32_t i = 0; i < which; i++)
        first += s->connector[i].plank.node_count - s->connector[i].plank.end_count;
    int32_t own = s->connector[which].plank.node_count - s->connector[which].plank.end_count;
    for (int32_t i = first; i < first + own; i++) most = fmax(most, s->now.mean_mpa[i]);
    return most;
}

static void swap_connectors(search *s, int32_t i, int32_t k)
{
    connector kept = s->connector[i];
    s->connector[i] = s->connector[k];
    s->connector[k] = kept;
}

// Those that bear little to the end of the list; returns how many bear more. Goes by what was seen last.
static jali_status set_idle_apart(jali_context *ctx, search *s, int32_t *bearing)
{
    const double little = 0.25;
    jali_status status;
    double *stress = NULL;
    *bearing = 0;
    TRY(ALLOCATE(ctx, stress, s->count));
    for (int32_t i = 0; i < s->count; i++) stress[i] = stress_in(s, i);
    for (int32_t i = 0; i < s->count; i++)
        if (stress[i] > little * s->now.stress.value) swap_connectors(s, i, (*bearing)++);
done:
    release(ctx, stress);
    return status;
}

// Take back connectors that bear little and without which the stress is no larger than it may be, or than it
// is. Half of them first: without all it nearly always is. Then twice as many, or half as many when that did
// harm; one alone that does is kept. So many trials, each a solution, and no more.
static jali_status take_back_useless(jali_context *ctx, search *s, jali_reinforcement *r)
{
    enum { MOST_TRIALS = 3 };
    jali_status status;
    int32_t bearing, all = s->count, trial = 0;
    double allowed = fmax(s->opt.limit_mpa, 1.001 * s->now.stress.value);
    TRY(set_idle_apart(ctx, s, &bearing));
    int32_t idle = all - bearing;
    for (int32_t some = MIN(idle, MAX(1, idle / 2)); some > 0 && trial < MOST_TRIALS; trial++) {
        TRY(step(ctx, "reinforce", 0.9));
        all = s->count;
        while (s->count > all - some) withdraw(&s->attached, s->connector[--s->count].name);
        TRY(look(ctx, s));
        if (s->now.stress.value <= allowed) {
            r->withdrawn += some;
            for (int32_t i = s->count; i < all; i++) plank_free(ctx, &s->connector[i].plank);
            some = MIN(2 * some, s->count - bearing);
            continue;
        }
        while (s->count < all) attach_again(&s->attached, s->connector[s->count++].name);
        if (some == 1) swap_connectors(s, s->count - 1, bearing++);
        some = MIN(MAX(1, some / 2), s->count - bearing);
    }
done:
    if (status != JALI_OK) s->count = all; // for search_free
    return status;
}

// --- From connectors to strokes

static void pixel_of(const search *s, const double at[2], int32_t pixel[2])
{
    pixel[0] = MAX(0, MIN((int32_t)floor(at[0] / s->chart->pixel_units), s->mask->width_px - 1));
    pixel[1] = MAX(0, MIN(s->chart->height_px - 1 - (int32_t)floor(at[1] / s->chart->pixel_units),
                          s->mask->height_px - 1));
}

// Strokes side by side, phi_s apart, each half a width into the solid at both ends.
static jali_status draw_strokes(jali_context *ctx, const search *s, jali_reinforcement *r)
{
    jali_status status = JALI_OK;
    size_t capacity = 0;
    for (int32_t i = 0; i < s->count; i++) {
        const span *way = &s->connector[i].span;
        const int32_t *from = s->sheet->at[way->node[0]], *to = s->sheet->at[way->node[1]];
        double x = to[0] - from[0], y = to[1] - from[1], units = hypot(x, y), scale = units / way->length_mm;
        int32_t strokes = MAX(1, (int32_t)lround(way->width_mm / s->opt.phi_s_mm));
        if (units == 0) continue;
        for (int32_t k = 0; k < strokes; k++) {
            double aside = (k - (strokes - 1) / 2.0) * s->opt.phi_s_mm * scale,
                   in = s->opt.phi_s_mm / 2 * scale;
            double a[2] = {from[0] - aside * y / units - in * x / units,
                           from[1] + aside * x / units - in * y / units};
            double b[2] = {to[0] - aside * y / units + in * x / units,
                           to[1] + aside * x / units + in * y / units};
            TRY(GROW(ctx, r->bridges.bridge, capacity, r->bridges.count + 1));
            jali_bridge *stroke = &r->bridges.bridge[r->bridges.count++];
            *stroke = (jali_bridge){.part = {-1, -1}};
            pixel_of(s, a, stroke->from);
            pixel_of(s, b, stroke->to);
        }
    }
    r->connectors = s->count;
done:
    return status;
}

static jali_status prepare(jali_context *ctx, search *s)
{
    jali_status status;
    int32_t columns = s->chart->width_px - 2 * s->chart->margin_px,
            rows = s->chart->height_px - 2 * s->chart->margin_px;
    double longest =
        s->opt.longest_mm > 0 ? s->opt.longest_mm : MIN(columns, rows) * jali_chart_pixel_mm(s->chart) / 3;
    if (s->opt.most_at_once < 1 || s->opt.most_at_once > 64 || s->opt.most_rounds < 1 ||
        s->opt.most_rounds > 1000)
        return fail(ctx, JALI_BAD_VALUE, "%d connectors in %d rounds: 1 to 64 and 1 to 1000 are accepted",
                    s->opt.most_at_once, s->opt.most_rounds);
    if (!(s->opt.limit_mpa > 0) || !(s->opt.phi_s_mm > 0) || !(s->opt.phi_v_mm > 0) || !(longest > 0))
        return fail(ctx, JALI_BAD_VALUE, "limit, widths and length of connectors must be more than 0");
    attachments_begin(&s->attached, s->structure, 1);
    s->attached.rough = true; // what is drawn is analysed afresh
    TRY(ALLOCATE(ctx, s->u, s->sheet->node_count));
    TRY(borders_create(ctx, s->sheet, s->chart, &s->borders));
    TRY(find_spans(ctx, s->sheet, &s->borders, s->mask, s->opt.blocked, s->chart, s->opt.phi_s_mm, longest,
                   &s->spans));
    TRY(look_back(ctx, s));
done:
    return status;
}

// A factor costs more the larger the sheet is, and with it go drawing, triangles, ways and trials; a
// correction by the rank of what is attached, of which a flat sheet's connectors have half as much.
static int32_t rank_worth_a_factor(const search *s)
{
    int32_t nodes = s->sheet->node_count, most = RANK_WORTH_A_FACTOR;
    if (s->structure->bending_only) most = MAX(most, MIN(2 * RANK_WORTH_A_FACTOR, nodes / 60));
    return MAX(most, nodes / 200);
}

jali_status jali_reinforce(jali_context *ctx, const jali_sheet *sheet, const jali_bitmap *mask,
                           const jali_chart *chart, const jali_reinforce_options *given,
                           jali_analysis *analysis, jali_reinforcement *r)
{
    jali_status status;
    search s = {.sheet = sheet,
                .mask = mask,
                .chart = chart,
                .opt = given ? *given : jali_reinforce_defaults(),
                .analysis = analysis,
                .structure = &analysis->stiffness->structure};
    *r = (jali_reinforcement){0};
    TRY(prepare(ctx, &s));
    while (r->round_count < s.opt.most_rounds && s.now.stress.value > s.opt.limit_mpa &&
           s.attached.rank < rank_worth_a_factor(&s)) {
        int32_t before = s.count;
        TRY(step(ctx, "reinforce", (double)r->round_count / s.opt.most_rounds));
        TRY(s.opt.rule == JALI_REINFORCE_PAPER ? lay_by_the_paper(ctx, &s) : lay_best(ctx, &s));
        r->helpless = s.count == before;
        if (r->helpless) break;
        TRY(look(ctx, &s));
        TRY(record(ctx, &s, r));
    }
    if (s.opt.rule == JALI_REINFORCE_BEST) TRY(take_back_useless(ctx, &s, r));
    TRY(draw_strokes(ctx, &s, r));
done:
    search_free(ctx, &s);
    if (status != JALI_OK) jali_reinforcement_free(ctx, r);
    return status;
}
