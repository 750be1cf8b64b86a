// Any bytes as a bitmap and a load: what is said of the strength is asserted on the result.
//
// Layout: 14 bytes of parameters (see settings), then pixels, a bit each; missing ones repeat a noise of the
// last byte.
#include "drawn.h"
#include "model.h"

#include <jali/jali.h>
#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { PARAMETERS = 14, MOST_SIDE_PX = 48 };

static double force_of(uint8_t byte) // 0.01 N .. 10 kN, either way
{
    return (byte & 1 ? -1 : 1) * pow(10, byte / 256.0 * 6 - 2);
}

static jali_options settings(const uint8_t *p, int32_t width_px, int32_t height_px)
{
    jali_options opt = jali_defaults();
    jali_load *load = &opt.strengthen.analyse.load;
    int32_t count;
    opt.optimise.phi_s_mm = 0.3 + 0.1 * (p[2] % 4);
    opt.optimise.epsilon_mm = 4;
    opt.predict = opt.recall = false;
    opt.place.width_mm =
        opt.optimise.phi_s_mm * (4 + p[3] % 16) * width_px / (width_px > height_px ? width_px : height_px);
    opt.place.frame_mm = p[4] % 3;
    opt.carve.thickness_mm = 0.2 + 0.2 * (p[4] / 3 % 20);
    opt.structure = true;
    opt.strengthen.across = 1 + p[5] % 3;
    opt.strengthen.analyse.support = (jali_support)(p[5] / 3 % 3);
    opt.strengthen.analyse.material = jali_material_list(&count)[p[6] % 9];
    opt.strengthen.reinforce.rule = (jali_reinforcing)(p[7] % 3);
    opt.strengthen.reinforce.most_rounds = 1 + p[7] / 3 % 4;
    opt.strengthen.reinforce.most_at_once = 1 + p[7] / 12 % 16;
    if (p[8] & 1) load->force_n = force_of(p[9]);
    if (p[8] & 2) load->weight = p[10];
    if (p[8] & 4) load->push_n = force_of(p[10]);
    if (p[8] & 8) load->pinch_n = force_of(p[11]);
    if (p[8] & 16) load->gravity[0] = 1;
    for (int k = 0; k < 3; k++) load->push_at_mm[k] = p[10 + k] / 16.0;
    load->spot_mm = 0.1 + p[12] / 32.0;
    return opt;
}

static void require_strength(jali_context *ctx, const jali_options *opt, const jali_result *r)
{
    (void)ctx;
    const jali_strength *s = &r->strength;
    const jali_analysis *a = &s->analysis;
    REQUIRE(s->round_count >= 1 && a->node_count == s->sheet.node_count && a->node_count > 0);
    REQUIRE(s->sound == (a->stress.value <= s->limit_mpa));
    REQUIRE(isfinite(a->stress.value) && isfinite(a->raw_stress.value) && isfinite(a->moved.value));
    REQUIRE(a->stress.value <= a->raw_stress.value * 1.001 && a->residual < 1e-3);
    for (int32_t i = 0; i < a->node_count; i++) {
        REQUIRE(isfinite(a->mean_mpa[i]) && a->mean_mpa[i] >= 0 && a->mean_mpa[i] <= (float)a->stress.value);
        for (int k = 0; k < 6; k++) REQUIRE(isfinite(a->displacement[i][k]));
    }
    for (int32_t i = 0; i < s->round_count; i++)
        REQUIRE(isfinite(s->round[i].stress_mpa) && s->round[i].connectors >= 0);
    REQUIRE(s->connectors == 0 || opt->strengthen.reinforce.rule != JALI_REINFORCE_NONE);
    REQUIRE(r->printable && r->closed && r->one_piece);
    require_sound(&r->mesh);
    if (!s->sound) {
        REQUIRE(s->advice.load_share > 0 && s->advice.load_share < 1 && isfinite(s->advice.thickness_mm));
        REQUIRE(isfinite(s->advice.unpierced_mpa));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const drawn_run run = {PARAMETERS, MOST_SIDE_PX, settings, require_strength};
    return run_drawn(&run, data, size);
}
