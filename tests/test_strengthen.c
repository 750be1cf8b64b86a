// strengthen: whole pictures under loads: made sound with every promise kept, or told what would do, and that
// is tried.
#include "testing.h"

#include <jali/jali.h>

#include <math.h>

enum { SIDE = 240 };

// A plate with a tongue across a void, its tip 12 px from the other side: white is solid.
static jali_picture tongue(void)
{
    jali_picture p = {.width_px = SIDE, .height_px = SIDE};
    CHECK_OK(ALLOCATE(ctx, p.grey, SIDE * SIDE));
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) {
            bool hole = x >= 30 && x < 210 && y >= 60 && y < 180, stick = x < 198 && y >= 105 && y < 135;
            p.grey[y * SIDE + x] = hole && !stick ? 0 : 255;
        }
    return p;
}

static jali_options pressed(double force_n)
{
    jali_options opt = jali_defaults();
    opt.place.width_mm = 24;
    opt.carve.thickness_mm = 1;
    opt.predict = opt.recall = false;
    opt.structure = true;
    opt.strengthen.across = 2;
    opt.strengthen.analyse.load.force_n = force_n;
    return opt;
}

static jali_result make(const jali_options *opt)
{
    jali_picture p = tongue();
    jali_result r;
    CHECK_OK(jali_make(ctx, &p, opt, &r));
    jali_picture_free(ctx, &p);
    const jali_strength *s = &r.strength; // the last round is the result as it is
    if (s->round_count) {
        CHECK(s->round[s->round_count - 1].stress_mpa == s->analysis.stress.value);
        CHECK_INT(s->round[s->round_count - 1].connectors, s->connectors);
        CHECK_INT(s->round[s->round_count - 1].nodes, s->sheet.node_count);
    }
    return r;
}

// The stress of the tongue without any connector, a newton.
static double stress_a_newton(void)
{
    jali_options opt = pressed(1);
    opt.strengthen.reinforce.rule = JALI_REINFORCE_NONE;
    opt.strengthen.advise = false;
    jali_result r = make(&opt);
    CHECK_INT(r.strength.round_count, 1);
    CHECK_INT(r.strength.connectors, 0);
    double stress = r.strength.analysis.stress.value;
    jali_result_free(ctx, &r);
    return stress;
}

TEST(what_holds_is_left_as_it_is)
{
    jali_options opt = pressed(0.9 * 10 / stress_a_newton());
    jali_result r = make(&opt);
    CHECK(r.strength.sound && r.strength.connectors == 0 && !r.strength.before.node_count);
    CHECK(isfinite(r.strength.change_mpa) && fabs(r.strength.change_mpa) < 3);
    jali_result_free(ctx, &r);
}

TEST(what_does_not_hold_gets_connectors_and_keeps_every_promise)
{
    jali_options opt = pressed(2 * 10 / stress_a_newton());
    jali_result r = make(&opt), plain;
    const jali_strength *s = &r.strength;
    CHECK(s->sound && s->connectors >= 1 && s->analysis.stress.value <= 10 && s->before.stress.value > 10);
    CHECK(r.one_piece && r.printable && r.closed);
    CHECK_INT(s->round[0].connectors, 0);
    CHECK_INT(s->round[s->round_count - 1].connectors, s->connectors);
    opt.structure = false;
    plain = make(&opt);
    CHECK(r.check.volume_mm3 > plain.check.volume_mm3);
    CHECK(!plain.strength.round_count);
    jali_result_free(ctx, &plain);
    jali_result_free(ctx, &r);
}

TEST(the_papers_rule_makes_it_sound_too)
{
    jali_options opt = pressed(1.5 * 10 / stress_a_newton());
    opt.strengthen.reinforce.rule = JALI_REINFORCE_PAPER;
    jali_result r = make(&opt);
    CHECK(r.strength.sound && r.strength.connectors >= 1 && r.one_piece && r.printable);
    jali_result_free(ctx, &r);
}

// The advice is tried: with the thickness named it holds, with the share of the load named it is at the
// limit.
TEST(advice_is_true)
{
    double force = 4 * 10 / stress_a_newton();
    jali_options opt = pressed(force);
    opt.strengthen.reinforce.rule = JALI_REINFORCE_NONE;
    jali_result r = make(&opt);
    jali_advice a = r.strength.advice;
    CHECK(!r.strength.sound && fabs(a.load_share - 0.25) < 0.01 && a.thickness_mm > 1.2 &&
          a.thickness_mm < 10);
    CHECK(a.unpierced_mpa > 0 && a.unpierced_mpa < r.strength.analysis.stress.value);
    jali_result_free(ctx, &r);
    opt.carve.thickness_mm = a.thickness_mm;
    r = make(&opt);
    CHECK(r.strength.sound && r.strength.analysis.stress.value > 7);
    jali_result_free(ctx, &r);
    if (!a.material) return;
    opt = pressed(force);
    opt.strengthen.analyse.material = *jali_material_find(a.material);
    r = make(&opt);
    CHECK(r.strength.sound && r.strength.connectors == 0);
    jali_result_free(ctx, &r);
}

TEST(what_cannot_hold_even_unpierced_is_told_so)
{
    jali_options opt = pressed(5000);
    opt.strengthen.reinforce.most_rounds = 1;
    jali_result r = make(&opt);
    CHECK(!r.strength.sound && r.strength.advice.unpierced_mpa > 10);
    jali_result_free(ctx, &r);
}

TEST(any_number_of_threads_gives_the_same_object)
{
    jali_context *by_threads[3];
    jali_result r[3];
    jali_options opt = pressed(2 * 10 / stress_a_newton());
    open_thread_contexts(by_threads);
    for (int32_t i = 0; i < 3; i++) {
        jali_picture p = tongue();
        CHECK_INT(jali_make(by_threads[i], &p, &opt, &r[i]), JALI_OK);
        jali_picture_free(ctx, &p);
    }
    for (int32_t i = 1; i < 3; i++) {
        CHECK_INT(r[i].mesh.vertex_count, r[0].mesh.vertex_count);
        CHECK(memcmp(r[i].mesh.vertex, r[0].mesh.vertex,
                     (size_t)r[0].mesh.vertex_count * sizeof *r[0].mesh.vertex) == 0);
        CHECK(r[i].strength.analysis.stress.value == r[0].strength.analysis.stress.value);
    }
    for (int32_t i = 0; i < 3; i++) jali_result_free(by_threads[i], &r[i]);
    close_thread_contexts(by_threads);
}

// A picture wrapped around a tube, its boundary held.
TEST(surfaces_are_made_strong_too)
{
    jali_surface surface = {0};
    jali_object object;
    jali_result r;
    jali_options opt = pressed(60);
    jali_picture p = tongue();
    CHECK_OK(jali_surface_open(ctx, "cylinder:r=12,h=40", NULL, &surface, NULL));
    CHECK_OK(jali_make_on(ctx, &surface, NULL, &p, &opt, 1, &r, &object));
    CHECK(r.strength.round_count >= 1 && r.strength.sound);
    CHECK(object.closed && object.one_piece && r.printable);
    CHECK(r.strength.sheet.node_count > 500 && !r.strength.sheet.flat);
    jali_object_free(ctx, &object);
    jali_result_free(ctx, &r);
    jali_picture_free(ctx, &p);
}

static jali_status make_once(jali_context *limited, void *data)
{
    jali_picture p = tongue();
    jali_result r;
    jali_status status = jali_make(limited, &p, data, &r);
    jali_picture_free(ctx, &p);
    if (status == JALI_OK) jali_result_free(limited, &r);
    return status;
}

TEST(cancelled_and_refused_it_leaves_nothing)
{
    jali_options opt = pressed(20);
    jali_context_options limits = jali_context_defaults();
    jali_context *hurried;
    limits.max_memory_bytes = 3 << 20;
    CHECK_INT(jali_context_create(&limits, &hurried), JALI_OK);
    CHECK_STATUS(make_once(hurried, &opt), JALI_LIMIT);
    jali_context_free(hurried);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_holds_is_left_as_it_is),
        cmocka_unit_test(what_does_not_hold_gets_connectors_and_keeps_every_promise),
        cmocka_unit_test(the_papers_rule_makes_it_sound_too),
        cmocka_unit_test(advice_is_true),
        cmocka_unit_test(what_cannot_hold_even_unpierced_is_told_so),
        cmocka_unit_test(any_number_of_threads_gives_the_same_object),
        cmocka_unit_test(surfaces_are_made_strong_too),
        cmocka_unit_test(cancelled_and_refused_it_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
