// Any bytes as a bitmap and parameters, through the whole pipeline: every promise is asserted on the result.
//
// Layout: 12 bytes of parameters (see settings), then pixels, a bit each; missing ones repeat a noise of the
// last byte.
#include "drawn.h"
#include "model.h"
#include "plain.h"

#include <jali/jali.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { PARAMETERS = 12, MOST_SIDE_PX = 96 };

// The longer side is 2 to 33 times the narrower width: from a picture of which almost nothing prints to one
// of which all does; the working grid stays below some 500 px.
static jali_options settings(const uint8_t *p, int32_t width_px, int32_t height_px)
{
    jali_options opt = jali_defaults();
    opt.optimise.phi_e_mm = 0.05 * (p[2] % 5);
    opt.optimise.phi_s_mm = 0.1 + 0.05 * (p[3] % 12);
    opt.optimise.phi_v_mm = 0.1 + 0.05 * (p[4] % 12);
    // Not below the widths: without a frame the plate's own corners, which no disc reaches, would be
    // features.
    opt.optimise.epsilon_mm = fmax(opt.optimise.phi_s_mm, opt.optimise.phi_v_mm) * (1 + p[5] % 10);
    opt.optimise.paper = p[6] & 1;
    opt.predict = p[6] >> 1 & 1;
    opt.optimise.details = p[6] >> 2 & 1;
    opt.recall = p[6] >> 3 & 1;
    double longer_mm = fmin(opt.optimise.phi_s_mm, opt.optimise.phi_v_mm) * (2 + p[7] % 32);
    opt.place.width_mm = longer_mm * width_px / (width_px > height_px ? width_px : height_px);
    opt.place.frame_mm = p[8] % 4 ? 0.5 * (p[8] % 4) : 0;
    opt.carve.hole_diameter_mm = p[9] % 3 == 1 ? 1 + p[9] % 5 : 0;
    opt.carve.corner_radius_mm = p[10] % 3 == 1 ? 0.5 : 0;
    return opt;
}

static void require_promises(jali_context *ctx, const jali_options *opt, const jali_result *r)
{
    plain mask = plain_of(&r->optimised.mask);
    REQUIRE(plain_pieces(&mask, true, 4) == 1);
    plain_free(&mask);
    REQUIRE(r->printable && r->closed && r->check.solid && r->check.pieces == 1);
    // The paper rounds its kernels, also downwards: what keeps to them may be too thin to print, and the
    // result says so.
    REQUIRE(r->one_piece || (opt->optimise.paper && opt->predict && r->result_print.pieces != 1));
    REQUIRE(!r->one_piece || !opt->predict || r->result_print.pieces == 1);
    require_sound(&r->mesh);
    require_read_back(ctx, &r->mesh, JALI_FORMAT_STL);
    require_read_back(ctx, &r->mesh, JALI_FORMAT_3MF);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const drawn_run run = {PARAMETERS, MOST_SIDE_PX, settings, require_promises};
    return run_drawn(&run, data, size);
}
