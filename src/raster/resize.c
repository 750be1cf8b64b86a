// Nearest-neighbour change of size, run by run.
#include "raster/raster.h"
#include "base/base.h"

typedef struct resize_job {
    const jali_bitmap *src;
    int32_t left, top, width, height; // the window of src
    jali_bitmap *dst;
} resize_job;

enum { BAND_ROWS = 64 };

// First of `to` pixels whose centre lies at or beyond the edge before pixel `edge` of `from` pixels.
static int32_t scaled_edge(int32_t edge, int32_t from, int32_t to)
{
    int64_t twice = 2 * (int64_t)edge * to - from; // (edge * to / from - 1/2), times 2 from
    return twice <= 0 ? 0 : (int32_t)((twice + 2 * (int64_t)from - 1) / (2 * (int64_t)from));
}

static void resize_row(const resize_job *job, int32_t y_src, int32_t y_dst)
{
    const uint64_t *row = job->src->word + (int64_t)y_src * job->src->stride;
    int32_t end = job->left + job->width;
    for (int32_t x = next_white(row, job->left, end, 0); x < end;) {
        int32_t stop = next_white(row, x, end, ~UINT64_C(0));
        int32_t x0 = scaled_edge(x - job->left, job->width, job->dst->width_px);
        int32_t x1 = scaled_edge(stop - job->left, job->width, job->dst->width_px);
        if (x0 < x1) paint_run(job->dst, y_dst, x0, x1, true);
        x = next_white(row, stop, end, 0);
    }
}

static void resize_band(void *shared, int32_t band)
{
    const resize_job *job = shared;
    jali_bitmap *dst = job->dst;
    int32_t before = -1;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, dst->height_px); y++) {
        int32_t y_src =
            job->top + (int32_t)((2 * (int64_t)y + 1) * job->height / (2 * (int64_t)dst->height_px));
        uint64_t *row = dst->word + (int64_t)y * dst->stride;
        if (y_src == before)
            memcpy(row, row - dst->stride, (size_t)dst->stride * sizeof *row);
        else {
            memset(row, 0, (size_t)dst->stride * sizeof *row);
            resize_row(job, y_src, y);
        }
        before = y_src;
    }
}

void resize_nearest(jali_context *ctx, const jali_bitmap *src, int32_t left, int32_t top, int32_t width,
                    int32_t height, jali_bitmap *dst)
{
    resize_job job = {src, left, top, width, height, dst};
    parallel(ctx, (dst->height_px + BAND_ROWS - 1) / BAND_ROWS, resize_band, &job);
}
