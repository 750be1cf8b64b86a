// Grey to black and white, pixel by pixel.
#include <jali/read.h>
#include "base/base.h"

typedef struct binarise_job {
    const jali_picture *from;
    uint8_t threshold;
    jali_bitmap *to;
} binarise_job;

enum { BAND_ROWS = 64 };

VECTORISED static uint64_t word_of(const uint8_t *grey, int32_t count, uint8_t threshold)
{
    uint64_t word = 0;
    for (int32_t i = 0; i < count; i++) word |= (uint64_t)(grey[i] >= threshold) << i;
    return word;
}

static void binarise_band(void *shared, int32_t band)
{
    const binarise_job *job = shared;
    int32_t width = job->from->width_px;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, job->from->height_px); y++)
        for (int32_t x = 0; x < width; x += 64)
            job->to->word[y * job->to->stride + x / 64] =
                word_of(job->from->grey + (int64_t)y * width + x, MIN(64, width - x), job->threshold);
}

jali_status jali_binarise(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                          jali_bitmap *bitmap)
{
    jali_status status = jali_bitmap_create(ctx, picture->width_px, picture->height_px, bitmap);
    if (status != JALI_OK) return status;
    binarise_job job = {picture, (uint8_t)threshold, bitmap};
    parallel(ctx, (picture->height_px + BAND_ROWS - 1) / BAND_ROWS, binarise_band, &job);
    return JALI_OK;
}
