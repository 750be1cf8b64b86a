// From the grey of a straightened scan to the share of solid.
//
// About each place scan = void + (solid - void) * drawn is fitted by weighted least squares over a Gaussian
// neighbourhood: five blurred moments, O(pixels). Where a neighbourhood holds one tone alone the contrast of
// the whole picture stands in.
//
// Source:  K. He, J. Sun, X. Tang, Guided image filtering, 2010 (the same local linear model).
// Checked: tests/test_scan.c.
#include "scan/align.h"

#include <math.h>

enum { WEIGHT, SCAN, DRAWN, DRAWN2, BOTH, MOMENTS };

static const double BORROWED = 0.05; // weight of the whole picture's contrast in a neighbourhood's variance
static const double DOUBT = 0.25;    // a share that is off by so much counts half

typedef struct fit {
    const grey *drawn;
    grey *scan;
    grey moment[MOMENTS];
    double contrast, variance; // of the whole picture
    bool again;                // weigh by how well the last fit did
} fit;

static void fill_moments(fit *f)
{
    size_t size = (size_t)f->scan->width * (size_t)f->scan->height;
    for (size_t i = 0; i < size; i++) {
        double s = (double)f->scan->level[i], d = (double)f->drawn->level[i], w = 1;
        if (f->again) {
            double solid = (double)f->moment[SCAN].level[i], hollow = (double)f->moment[DRAWN].level[i];
            double off = ((s - hollow) / (solid - hollow) - d) / DOUBT;
            w = 1 / (1 + off * off);
        }
        if (!isfinite(s) || !isfinite(w)) s = d = w = 0;
        const double value[MOMENTS] = {w, w * s, w * d, w * d * d, w * s * d};
        for (int k = 0; k < MOMENTS; k++) f->moment[k].level[i] = (float)value[k];
    }
}

// Contrast and variance of the whole picture, as the moments have them.
static void whole_picture(fit *f)
{
    double sum[MOMENTS] = {0};
    size_t size = (size_t)f->scan->width * (size_t)f->scan->height;
    for (int k = 0; k < MOMENTS; k++)
        for (size_t i = 0; i < size; i++) sum[k] += (double)f->moment[k].level[i];
    double w = fmax(sum[WEIGHT], 1e-9), drawn = sum[DRAWN] / w;
    f->variance = fmax(sum[DRAWN2] / w - drawn * drawn, 1e-9);
    f->contrast = (sum[BOTH] / w - drawn * sum[SCAN] / w) / f->variance;
}

// The levels of both tones take the place of the moments: SCAN holds solid, DRAWN holds void.
static void solve_levels(fit *f)
{
    size_t size = (size_t)f->scan->width * (size_t)f->scan->height;
    for (size_t i = 0; i < size; i++) {
        double w = fmax((double)f->moment[WEIGHT].level[i], 1e-6),
               scan = (double)f->moment[SCAN].level[i] / w, drawn = (double)f->moment[DRAWN].level[i] / w,
               variance = (double)f->moment[DRAWN2].level[i] / w - drawn * drawn,
               both = (double)f->moment[BOTH].level[i] / w - drawn * scan;
        double borrowed = BORROWED * f->variance;
        double contrast = (both + borrowed * f->contrast) / (fmax(variance, 0) + borrowed);
        f->moment[DRAWN].level[i] = (float)(scan - contrast * drawn);
        f->moment[SCAN].level[i] = (float)(scan + contrast * (1 - drawn));
    }
}

jali_status share_of_solid(jali_context *ctx, const grey *drawn, double deviation_px, grey *straight)
{
    jali_status status;
    fit f = {.drawn = drawn, .scan = straight};
    size_t size = (size_t)straight->width * (size_t)straight->height;
    for (int k = 0; k < MOMENTS; k++)
        TRY(grey_create(ctx, straight->width, straight->height, straight->pixel, &f.moment[k]));
    for (int pass = 0; pass < 2; pass++) {
        TRY(step(ctx, "light", pass / 2.0));
        f.again = pass > 0;
        fill_moments(&f);
        whole_picture(&f);
        for (int k = 0; k < MOMENTS; k++) TRY(grey_blur(ctx, &f.moment[k], deviation_px));
        solve_levels(&f);
    }
    for (size_t i = 0; i < size; i++) {
        float solid = f.moment[SCAN].level[i], hollow = f.moment[DRAWN].level[i];
        straight->level[i] = (straight->level[i] - hollow) / (solid - hollow);
    }
done:
    for (int k = 0; k < MOMENTS; k++) grey_free(ctx, &f.moment[k]);
    return status;
}
