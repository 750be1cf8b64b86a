// reinforce: spans across voids of a known width, planks that fit, gradients against differences, what a
// ranking foretells against what comes out, and searches that end.
#include "testing.h"
#include "structure/attach.h"
#include "structure/stiffness.h"
#include "reinforce/hotspots.h"
#include "reinforce/plank.h"
#include "reinforce/rank.h"

#include <jali/carve.h>
#include <jali/reinforce.h>
#include <jali/sheet.h>
#include <jali/trace.h>

#include <math.h>

enum { SIDE_PX = 200, MARGIN_PX = 10 };

static const jali_chart CHART = {.width_px = SIDE_PX + 2 * MARGIN_PX,
                                 .height_px = SIDE_PX + 2 * MARGIN_PX,
                                 .margin_px = MARGIN_PX,
                                 .outside_solid = true,
                                 .pixel_units = 64,
                                 .unit_mm = 1.0 / 640}; // 0.1 mm a pixel, 20 mm in all

// A plate of 20 mm in a frame of 1 mm, with a tongue 3 mm wide that hangs into a void from the left and ends
// `gap` px before the right.
typedef struct tongue {
    jali_bitmap mask;
    jali_contours outline, plate;
    jali_sheet sheet;
    jali_analysis analysis;
} tongue;

static void set_box(jali_bitmap *a, int32_t x0, int32_t y0, int32_t x1, int32_t y1, bool white)
{
    for (int32_t y = y0; y < y1; y++)
        for (int32_t x = x0; x < x1; x++) jali_bitmap_set(a, MARGIN_PX + x, MARGIN_PX + y, white);
}

static void make_tongue_of(tongue *t, int32_t gap_px, double force_n, double phi_s_mm)
{
    jali_carve_options carve = jali_carve_defaults();
    jali_sheet_options opt = jali_sheet_defaults();
    jali_analyse_options load = jali_analyse_defaults();
    *t = (tongue){0};
    CHECK_OK(jali_bitmap_create(ctx, CHART.width_px, CHART.height_px, &t->mask));
    set_box(&t->mask, -MARGIN_PX, -MARGIN_PX, SIDE_PX + MARGIN_PX, SIDE_PX + MARGIN_PX, true);
    set_box(&t->mask, 20, 60, 180, 140, false);
    set_box(&t->mask, 20, 85, 180 - gap_px, 115, true);
    carve.frame_mm = 1;
    CHECK_OK(jali_trace(ctx, &t->mask, &CHART, NULL, &t->outline));
    CHECK_OK(jali_plate(ctx, &t->outline, &CHART, &carve, &t->plate));
    opt.across = 2;
    opt.phi_s_mm = phi_s_mm;
    CHECK_OK(jali_sheet_plate(ctx, &t->plate, &CHART, 1, &opt, &t->sheet));
    load.load.force_n = force_n;
    load.phi_s_mm = 1;
    CHECK_OK(jali_analyse(ctx, &t->sheet, &load, &t->analysis));
}

static void make_tongue(tongue *t, int32_t gap_px, double force_n)
{
    make_tongue_of(t, gap_px, force_n, 1);
}

static void free_tongue(tongue *t)
{
    jali_bitmap_free(ctx, &t->mask);
    jali_contours_free(ctx, &t->outline);
    jali_contours_free(ctx, &t->plate);
    jali_analysis_free(ctx, &t->analysis);
    jali_sheet_free(ctx, &t->sheet);
}

static jali_reinforce_options options(double limit_mpa)
{
    jali_reinforce_options opt = jali_reinforce_defaults();
    opt.limit_mpa = limit_mpa;
    opt.phi_s_mm = 0.5;
    opt.phi_v_mm = 0.5;
    return opt;
}

TEST(rays_find_the_ways_across_a_void_and_no_others)
{
    tongue t;
    borders b;
    spans found;
    make_tongue(&t, 20, 1);
    CHECK_OK(borders_create(ctx, &t.sheet, &CHART, &b));
    CHECK_OK(find_spans(ctx, &t.sheet, &b, &t.mask, NULL, &CHART, 0.5, 4, &found));
    CHECK(found.count > 50);
    bool at_tip = false;
    for (int32_t i = 0; i < found.count; i++) {
        const span *s = &found.span[i];
        const double *p = t.sheet.node[s->node[0]], *q = t.sheet.node[s->node[1]];
        CHECK(s->length_mm <= 4 && s->length_mm > 0.1);
        for (int k = 1; k < 8; k++) { // the way itself is void
            int32_t x = (int32_t)floor((p[0] + (q[0] - p[0]) * k / 8) * 10),
                    y = CHART.height_px - 1 - (int32_t)floor((p[1] + (q[1] - p[1]) * k / 8) * 10);
            CHECK(!jali_bitmap_get(&t.mask, x, y));
        }
        at_tip |= fabs(s->length_mm - 2) < 0.1 && fabs(p[1] - q[1]) < 0.1;
    }
    CHECK(at_tip);
    release(ctx, found.span);
    borders_free(ctx, &b);
    free_tongue(&t);
}

static double area_of_sheet(const jali_sheet *s)
{
    double sum = 0;
    for (int32_t t = 0; t < s->triangle_count; t++) {
        const double *a = s->node[s->triangle[t][0]], *b = s->node[s->triangle[t][1]],
                     *c = s->node[s->triangle[t][2]];
        double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        CHECK(twice > 0); // wound as the sheet
        sum += twice / 2;
    }
    return sum;
}

TEST(planks_fit_between_the_borders)
{
    tongue t;
    borders b;
    spans found;
    int32_t laid = 0;
    make_tongue(&t, 20, 1);
    CHECK_OK(borders_create(ctx, &t.sheet, &CHART, &b));
    CHECK_OK(find_spans(ctx, &t.sheet, &b, &t.mask, NULL, &CHART, 0.5, 4, &found));
    double before = area_of_sheet(&t.sheet);
    for (int32_t i = 0; i < found.count; i++) {
        plank p;
        jali_sheet joined;
        found.span[i].width_mm = 0.5;
        CHECK_OK(plank_create(ctx, &t.sheet, &b, &found.span[i], &p));
        if (p.end_count == 0) continue;
        CHECK(plank_has_room(&t.sheet, &b, &found.span[i]));
        laid++;
        CHECK_OK(join_planks(ctx, &t.sheet, &p, 1, &joined));
        double gained = area_of_sheet(&joined) - before, plain = 0.5 * found.span[i].length_mm;
        CHECK(gained > 0.5 * plain && gained < 4 * plain);
        jali_sheet_free(ctx, &joined);
        plank_free(ctx, &p);
    }
    CHECK(laid > 20);
    release(ctx, found.span);
    borders_free(ctx, &b);
    free_tongue(&t);
}

// The mean stress that the gradient belongs to, after moving one unknown a little.
static double stress_with(const tongue *t, double (*u)[6], int32_t hot, double (*step_u)[6], double step)
{
    double sum = 0;
    for (int32_t i = 0; i < t->sheet.node_count; i++)
        for (int k = 0; k < 6; k++) u[i][k] += step * step_u[i][k];
    // By homogeneity a von Mises stress is its own gradient times the displacements.
    double(*g)[6] = calloc((size_t)t->sheet.node_count, sizeof *g);
    stress_gradient(&t->sheet, &t->analysis.stiffness->opt.material, (const double(*)[6])u, hot, 0.5, g);
    for (int32_t i = 0; i < t->sheet.node_count; i++)
        for (int k = 0; k < 6; k++) sum += g[i][k] * u[i][k];
    for (int32_t i = 0; i < t->sheet.node_count; i++)
        for (int k = 0; k < 6; k++) u[i][k] -= step * step_u[i][k];
    free(g);
    return sum;
}

TEST(the_gradient_of_the_stress_agrees_with_differences)
{
    tongue t;
    uint64_t seed = 7;
    make_tongue(&t, 20, 5);
    int32_t n = t.sheet.node_count, hot = t.analysis.stress.node;
    double(*gradient)[6] = calloc((size_t)n, sizeof *gradient), (*away)[6] = calloc((size_t)n, sizeof *away);
    double predicted = 0;
    stress_gradient(&t.sheet, &t.analysis.stiffness->opt.material,
                    (const double(*)[6])t.analysis.displacement, hot, 0.5, gradient);
    for (int32_t i = 0; i < n; i++)
        for (int k = 2; k < 5; k++) {
            away[i][k] = (double)(next_random(&seed) >> 40) / (1 << 24) - 0.5;
            predicted += gradient[i][k] * away[i][k];
        }
    double step = 1e-7;
    double up = stress_with(&t, t.analysis.displacement, hot, away, step),
           down = stress_with(&t, t.analysis.displacement, hot, away, -step);
    CHECK(fabs((up - down) / (2 * step) / predicted - 1) < 1e-3);
    double here = stress_with(&t, t.analysis.displacement, hot, away, 0);
    CHECK(fabs(here / t.analysis.stress.value - 1) < 0.6); // another mean of the same stresses
    free(gradient);
    free(away);
    free_tongue(&t);
}

// A beam's modes see no rigid motion.
TEST(beams_are_blind_to_rigid_motion)
{
    tongue t;
    borders b;
    spans found;
    make_tongue(&t, 20, 1);
    int32_t n = t.sheet.node_count;
    double(*u)[6] = calloc((size_t)n, sizeof *u), mode[BEAM_MODES];
    CHECK_OK(borders_create(ctx, &t.sheet, &CHART, &b));
    CHECK_OK(find_spans(ctx, &t.sheet, &b, &t.mask, NULL, &CHART, 2, 4, &found));
    int32_t blind = 0;
    for (int motion = 0; motion < 6; motion++) {
        for (int32_t i = 0; i < n; i++) {
            const double *x = t.sheet.node[i];
            memset(u[i], 0, sizeof u[i]);
            u[i][motion] = 1;
            int axis = motion - 3, p = (axis + 1) % 3, q = (axis + 2) % 3;
            if (motion >= 3) u[i][q] = x[p], u[i][p] = -x[q];
        }
        for (int32_t i = 0; i < found.count; i++) {
            beam it;
            found.span[i].width_mm = 0.5;
            beam_along(&t.sheet, &b, &found.span[i], jali_material_find("pla"), false, &it);
            // An end moves as the mean of its three nodes; where they lie unevenly that mean is a little
            // aside.
            double aside = 0;
            for (int end = 0; end < 2; end++) {
                const double *mid = t.sheet.node[it.node[3 * end]],
                             *next = t.sheet.node[it.node[3 * end + 1]],
                             *last = t.sheet.node[it.node[3 * end + 2]];
                aside += hypot(next[0] + last[0] - 2 * mid[0], next[1] + last[1] - 2 * mid[1]) / 4;
            }
            beam_deformation(&it, (const double(*)[6])u, mode);
            for (int m = 0; m < it.mode_count; m++) CHECK(fabs(mode[m]) <= aside + 1e-9);
            blind += aside < 0.02;
        }
    }
    CHECK(blind > 20); // ends on even borders are among them
    free(u);
    release(ctx, found.span);
    borders_free(ctx, &b);
    free_tongue(&t);
}

TEST(the_best_connector_holds_the_tongue_at_its_tip)
{
    tongue t;
    jali_reinforcement r;
    make_tongue(&t, 20, 10);
    jali_reinforce_options opt = options(t.analysis.stress.value / 2);
    CHECK_OK(jali_reinforce(ctx, &t.sheet, &t.mask, &CHART, &opt, &t.analysis, &r));
    CHECK(r.connectors >= 1 && r.bridges.count >= r.connectors && r.round_count >= 1);
    CHECK(r.round[r.round_count - 1].stress_mpa <= opt.limit_mpa && !r.helpless);
    for (int32_t i = 0; i < r.bridges.count; i++) { // ends lie in solid
        CHECK(jali_bitmap_get(&t.mask, r.bridges.bridge[i].from[0], r.bridges.bridge[i].from[1]));
        CHECK(jali_bitmap_get(&t.mask, r.bridges.bridge[i].to[0], r.bridges.bridge[i].to[1]));
    }
    jali_reinforcement_free(ctx, &r);
    jali_reinforcement_free(ctx, &r);
    free_tongue(&t);
}

TEST(the_papers_rule_joins_the_most_displaced_region_to_what_is_closest)
{
    tongue t;
    jali_reinforcement r;
    make_tongue(&t, 20, 10);
    jali_reinforce_options opt = options(t.analysis.stress.value / 2);
    opt.rule = JALI_REINFORCE_PAPER;
    opt.most_rounds = 1;
    CHECK_OK(jali_reinforce(ctx, &t.sheet, &t.mask, &CHART, &opt, &t.analysis, &r));
    CHECK_INT(r.connectors, 1);
    const jali_bridge *b = &r.bridges.bridge[0];
    CHECK(MAX(b->from[0], b->to[0]) >= MARGIN_PX + 179 && MIN(b->from[0], b->to[0]) >= MARGIN_PX + 140);
    jali_reinforcement_free(ctx, &r);
    free_tongue(&t);
}

TEST(what_no_connector_can_help_is_said_to_be_so)
{
    tongue t;
    jali_reinforcement r;
    make_tongue(&t, 20, 10);
    jali_reinforce_options opt = options(t.analysis.stress.value / 2);
    opt.longest_mm = 0.9; // shorter than the narrowest void
    CHECK_OK(jali_reinforce(ctx, &t.sheet, &t.mask, &CHART, &opt, &t.analysis, &r));
    CHECK(r.helpless && r.connectors == 0 && r.bridges.count == 0);
    jali_reinforcement_free(ctx, &r);
    opt.most_rounds = 0;
    CHECK_STATUS(jali_reinforce(ctx, &t.sheet, &t.mask, &CHART, &opt, &t.analysis, &r), JALI_BAD_VALUE);
    free_tongue(&t);
}

static jali_status reinforce_once(jali_context *limited, void *data)
{
    tongue *t = data;
    jali_reinforcement r;
    jali_analysis a;
    jali_analyse_options load = t->analysis.stiffness->opt;
    jali_reinforce_options opt = options(t->analysis.stress.value / 2);
    opt.most_rounds = 1;
    jali_status status = jali_analyse(limited, &t->sheet, &load, &a);
    if (status == JALI_OK) status = jali_reinforce(limited, &t->sheet, &t->mask, &CHART, &opt, &a, &r);
    if (status == JALI_OK) jali_reinforcement_free(limited, &r);
    jali_analysis_free(limited, &a);
    return status;
}

TEST(every_allocation_refused_once)
{
    tongue t;
    make_tongue_of(&t, 20, 10, 4);
    refuse_each_allocation(reinforce_once, &t);
    free_tongue(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_find_the_ways_across_a_void_and_no_others),
        cmocka_unit_test(planks_fit_between_the_borders),
        cmocka_unit_test(the_gradient_of_the_stress_agrees_with_differences),
        cmocka_unit_test(beams_are_blind_to_rigid_motion),
        cmocka_unit_test(the_best_connector_holds_the_tongue_at_its_tip),
        cmocka_unit_test(the_papers_rule_joins_the_most_displaced_region_to_what_is_closest),
        cmocka_unit_test(what_no_connector_can_help_is_said_to_be_so),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
