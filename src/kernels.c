// The elements' sizes in pixels, from the widths in mm.
//
// Source:  Binary Image Carving for 3D Printing, Eq. 1 and section 4.3.
// Checked: tests/test_optimise.c: all of Table 1.
#include "optimising.h"

#include <math.h>

// A width that misses a whole number of pixels by less is that number: 0.3 mm are 12 px of 0.02501 mm.
static const double WIDTH_TOLERANCE_PX = 0.01;

static int32_t odd(double n)
{
    return (int32_t)n | 1;
}

static double nearest_half_down(double x)
{
    return ceil(x - 0.5 - 1e-9);
}

// Eq. 1 and section 4.3, in the reading that gives all of Table 1: omega_c = max(3, odd(ceil(r / 2) + 2))
// with r = phi_e / pixel rounded, omega_w and omega_b = the rounded widths made odd.
void jali_paper_kernels(double phi_e_mm, double phi_s_mm, double phi_v_mm, double pixel_mm,
                        int32_t kernels_px[3])
{
    kernels_px[0] = MAX(3, odd(ceil(nearest_half_down(phi_e_mm / pixel_mm) / 2) + 2));
    kernels_px[1] = MAX(1, odd(nearest_half_down(phi_s_mm / pixel_mm)));
    kernels_px[2] = MAX(1, odd(nearest_half_down(phi_v_mm / pixel_mm)));
}

// On the working grid: the growth to the nearest pixel a side, the widths never less than asked for.
static void exact_kernels(const jali_optimise_options *opt, double pixel_mm, int32_t kernels_px[3])
{
    kernels_px[0] = 1 + 2 * (int32_t)floor(opt->phi_e_mm / 2 / pixel_mm + 0.5);
    kernels_px[1] = MAX(1, (int32_t)ceil(opt->phi_s_mm / pixel_mm - WIDTH_TOLERANCE_PX));
    kernels_px[2] = MAX(1, (int32_t)ceil(opt->phi_v_mm / pixel_mm - WIDTH_TOLERANCE_PX));
}

static jali_status check_positive(jali_context *ctx, const char *name, double mm, bool zero_allowed)
{
    if (mm > 0 && mm <= 1000) return JALI_OK;
    if (zero_allowed && mm == 0) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE, "%s is %g mm; %s 1000 mm is accepted", name, mm,
                zero_allowed ? "0 to" : "more than 0 and up to");
}

jali_status choose_kernels(jali_context *ctx, const jali_optimise_options *opt, const jali_chart *chart,
                           int32_t kernels_px[3])
{
    jali_status status;
    TRY(check_positive(ctx, "phi_e (or a kerf)", fabs(opt->phi_e_mm), true));
    if (opt->paper && opt->phi_e_mm < 0)
        return fail(ctx, JALI_BAD_VALUE,
                    "phi_e is %g mm, a kerf: the paper's method has none; leave --paper out", opt->phi_e_mm);
    TRY(check_positive(ctx, "phi_s", opt->phi_s_mm, false));
    TRY(check_positive(ctx, "phi_v", opt->phi_v_mm, false));
    TRY(check_positive(ctx, "epsilon", opt->epsilon_mm, true));
    double pixel_mm = jali_chart_pixel_mm(chart);
    if (opt->paper)
        jali_paper_kernels(opt->phi_e_mm, opt->phi_s_mm, opt->phi_v_mm, pixel_mm, kernels_px);
    else
        exact_kernels(opt, pixel_mm, kernels_px);
    for (int32_t i = 0; i < 3; i++)
        if (opt->kernels_px[i]) kernels_px[i] = opt->kernels_px[i];
    if (kernels_px[0] < -4000 || kernels_px[0] % 2 == 0 || kernels_px[1] < 1 || kernels_px[2] < 1 ||
        MAX(kernels_px[0], MAX(kernels_px[1], kernels_px[2])) > 4000)
        return fail(ctx, JALI_BAD_VALUE,
                    "kernels of %d, %d and %d px: omega_c must be odd, from -4000 px on, the others from 1; "
                    "up to 4000 "
                    "px",
                    kernels_px[0], kernels_px[1], kernels_px[2]);
done:
    return status;
}
