// Pictures of grey levels with fractions, their blur and their normalised form.
//
// Source:  W. M. Wells, Efficient synthesis of Gaussian filters by cascaded uniform filters, 1986 (the blur).
// Limits:  the windows are whole pixels: the blur's deviation is within a third of a pixel of the one asked
// for. Checked: tests/test_scan.c.
#include "scan/grey.h"
#include "raster/raster.h"

#include <math.h>

jali_status grey_create(jali_context *ctx, int32_t width, int32_t height, double pixel, grey *g)
{
    *g = (grey){.width = width, .height = height, .pixel = pixel};
    jali_status status = ALLOCATE(ctx, g->level, (size_t)width * (size_t)height);
    if (status != JALI_OK) *g = (grey){0};
    return status;
}

void grey_free(jali_context *ctx, grey *g)
{
    release(ctx, g->level);
    *g = (grey){0};
}

typedef struct shrinking {
    const jali_picture *picture; // or
    const jali_bitmap *bitmap;
    int32_t width, height, shrink;
    grey *g;
} shrinking;

static void shrink_row(void *shared, int32_t y)
{
    const shrinking *job = shared;
    int32_t y0 = y * job->shrink, y1 = MIN(y0 + job->shrink, job->height);
    float *out = job->g->level + (size_t)y * (size_t)job->g->width;
    for (int32_t x = 0; x < job->g->width; x++) {
        int32_t x0 = x * job->shrink, x1 = MIN(x0 + job->shrink, job->width);
        uint64_t sum = 0;
        for (int32_t v = y0; v < y1; v++) {
            if (job->bitmap) {
                sum += (uint64_t)count_run(job->bitmap, v, x0, x1);
                continue;
            }
            const uint8_t *row = job->picture->grey + (size_t)v * (size_t)job->width;
            for (int32_t u = x0; u < x1; u++) sum += row[u];
        }
        double most = (job->bitmap ? 1.0 : 255.0) * (x1 - x0) * (y1 - y0);
        out[x] = (float)((double)sum / most);
    }
}

static jali_status shrunk(jali_context *ctx, shrinking *job, grey *g)
{
    int32_t k = job->shrink;
    jali_status status =
        grey_create(ctx, (job->width + k - 1) / k, (job->height + k - 1) / k, job->shrink, g);
    if (status != JALI_OK) return status;
    job->g = g;
    parallel(ctx, g->height, shrink_row, job);
    return JALI_OK;
}

jali_status grey_of_picture(jali_context *ctx, const jali_picture *picture, int32_t shrink, grey *g)
{
    shrinking job = {picture, NULL, picture->width_px, picture->height_px, shrink, NULL};
    return shrunk(ctx, &job, g);
}

jali_status grey_of_bitmap(jali_context *ctx, const jali_bitmap *bitmap, int32_t shrink, grey *g)
{
    shrinking job = {NULL, bitmap, bitmap->width_px, bitmap->height_px, shrink, NULL};
    return shrunk(ctx, &job, g);
}

float grey_at(const grey *g, double x, double y)
{
    double u = fmin(fmax(x / g->pixel - 0.5, 0), g->width - 1),
           v = fmin(fmax(y / g->pixel - 0.5, 0), g->height - 1);
    int32_t i = MIN((int32_t)u, MAX(g->width - 2, 0)), j = MIN((int32_t)v, MAX(g->height - 2, 0));
    int32_t right = g->width > 1, below = g->height > 1 ? g->width : 0;
    const float *at = g->level + (size_t)j * (size_t)g->width + i;
    float s = (float)(u - i), t = (float)(v - j);
    return (1 - t) * ((1 - s) * at[0] + s * at[right]) + t * ((1 - s) * at[below] + s * at[below + right]);
}

// --- Blur

typedef struct blurring {
    const grey *g;
    float *out;
    int32_t radius;
} blurring;

enum { BLOCK = 64 }; // columns that one item averages side by side

static void average_row(void *shared, int32_t y)
{
    const blurring *job = shared;
    int32_t n = job->g->width, r = job->radius;
    const float *in = job->g->level + (size_t)y * (size_t)n;
    float *out = job->out + (size_t)y * (size_t)n;
    double sum = 0;
    for (int32_t x = 0; x < MIN(r, n); x++) sum += (double)in[x];
    for (int32_t x = 0; x < n; x++) {
        if (x + r < n) sum += (double)in[x + r];
        if (x - r - 1 >= 0) sum -= (double)in[x - r - 1];
        out[x] = (float)(sum / (MIN(x + r, n - 1) - MAX(x - r, 0) + 1));
    }
}

static void average_columns(void *shared, int32_t index)
{
    const blurring *job = shared;
    int32_t first = index * BLOCK, count = MIN(BLOCK, job->g->width - first), n = job->g->height,
            r = job->radius;
    size_t stride = (size_t)job->g->width;
    const float *in = job->g->level + first;
    float *out = job->out + first;
    double sum[BLOCK] = {0};
    for (int32_t y = 0; y < MIN(r, n); y++)
        for (int32_t k = 0; k < count; k++) sum[k] += (double)in[(size_t)y * stride + (size_t)k];
    for (int32_t y = 0; y < n; y++) {
        int32_t rows = MIN(y + r, n - 1) - MAX(y - r, 0) + 1;
        for (int32_t k = 0; k < count && y + r < n; k++)
            sum[k] += (double)in[(size_t)(y + r) * stride + (size_t)k];
        for (int32_t k = 0; k < count && y - r - 1 >= 0; k++)
            sum[k] -= (double)in[(size_t)(y - r - 1) * stride + (size_t)k];
        for (int32_t k = 0; k < count; k++) out[(size_t)y * stride + (size_t)k] = (float)(sum[k] / rows);
    }
}

jali_status grey_blur(jali_context *ctx, grey *g, double deviation_px)
{
    // Three windows of 2 r + 1 have the variance ((2 r + 1)^2 - 1) / 4.
    int32_t radius = (int32_t)fmin(floor((sqrt(4 * deviation_px * deviation_px + 1) - 1) / 2 + 0.5), 1 << 24);
    if (radius == 0) return JALI_OK;
    grey other;
    jali_status status = grey_create(ctx, g->width, g->height, g->pixel, &other);
    if (status != JALI_OK) return status;
    for (int32_t pass = 0; pass < 3; pass++) {
        blurring along = {g, other.level, radius}, down = {&other, g->level, radius};
        parallel(ctx, g->height, average_row, &along);
        parallel(ctx, (g->width + BLOCK - 1) / BLOCK, average_columns, &down);
    }
    grey_free(ctx, &other);
    return JALI_OK;
}

jali_status grey_normalise(jali_context *ctx, grey *g, double deviation_px)
{
    static const double FLAT = 0.1; // of the whole picture's variance: below this a place counts as flat
    jali_status status;
    size_t size = (size_t)g->width * (size_t)g->height;
    grey mean = {0}, square = {0};
    double sum = 0;
    TRY(grey_create(ctx, g->width, g->height, g->pixel, &mean));
    TRY(grey_create(ctx, g->width, g->height, g->pixel, &square));
    memcpy(mean.level, g->level, size * sizeof *mean.level);
    TRY(grey_blur(ctx, &mean, deviation_px));
    for (size_t i = 0; i < size; i++) {
        g->level[i] -= mean.level[i];
        square.level[i] = g->level[i] * g->level[i];
        sum += (double)square.level[i];
    }
    TRY(grey_blur(ctx, &square, deviation_px));
    sum = FLAT * sum / (double)MAX(size, 1) + 1e-12;
    for (size_t i = 0; i < size; i++) g->level[i] /= (float)sqrt((double)square.level[i] + sum);
done:
    grey_free(ctx, &mean);
    grey_free(ctx, &square);
    return status;
}
