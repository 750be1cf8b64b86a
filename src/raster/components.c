// Connected components on runs: one pass over the words finds the runs, a second joins those of adjacent
// rows.
//
// Source:  run-based two-scan labelling with union-find (He, Chao, Suzuki 2008), on packed words.
// Method:  bands of rows find and join their own runs side by side; the seams between bands come after. The
// lower
//          index is the root whatever the order, so labels do not depend on the bands.
// Cost:    O(words + runs); memory 12 bytes a run, nothing a pixel.
// Checked: tests/test_raster.c against flood fill on random bitmaps, both connectivities.
#include "raster/raster.h"
#include "base/base.h"
#include "base/sets.h"

int32_t next_white(const uint64_t *row, int32_t x, int32_t width, uint64_t flip)
{
    int32_t words = (width + 63) / 64;
    int32_t i = x >> 6;
    if (i >= words) return width;
    uint64_t word = (row[i] ^ flip) & ~UINT64_C(0) << (x & 63);
    while (!word) {
        if (++i >= words) return width;
        word = row[i] ^ flip;
    }
    return MIN(i * 64 + __builtin_ctzll(word), width);
}

typedef struct find_job {
    const jali_bitmap *a;
    uint64_t flip;
    int32_t reach; // 8-connected runs also touch one pixel further
    components *c;
} find_job;

enum { BAND_ROWS = 64 };

// Word i of a row, its tone made white and nothing beyond the width.
static inline uint64_t tone_word(const find_job *job, const uint64_t *row, int32_t i)
{
    uint64_t word = row[i] ^ job->flip;
    bool last = i == job->a->width_px / 64;
    return last ? word & ((UINT64_C(1) << job->a->width_px % 64) - 1) : word;
}

VECTORISED static void count_band(void *shared, int32_t band)
{
    find_job *job = shared;
    const jali_bitmap *a = job->a;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, a->height_px); y++) {
        const uint64_t *row = a->word + (int64_t)y * a->stride;
        uint64_t before = 0; // the pixel to the left, in bit 63
        int32_t runs = 0;
        for (int32_t i = 0; i < (a->width_px + 63) / 64; i++) {
            uint64_t word = tone_word(job, row, i);
            runs += __builtin_popcountll(word & ~(word << 1 | before >> 63));
            before = word;
        }
        job->c->first[y + 1] = runs;
    }
}

// The columns where the tone begins and ends, in turns, are the runs.
static void find_runs(const find_job *job, const uint64_t *row, int32_t *edge)
{
    uint64_t before = 0;
    for (int32_t i = 0; i < (job->a->width_px + 63) / 64; i++) {
        uint64_t word = tone_word(job, row, i);
        for (uint64_t change = word ^ (word << 1 | before >> 63); change; change &= change - 1)
            *edge++ = i * 64 + __builtin_ctzll(change);
        before = word;
    }
    if (job->a->width_px % 64 == 0 && before >> 63) *edge = job->a->width_px;
}

// Runs of two rows touch when they overlap, or for 8-connectivity when they meet at a corner.
static void join_rows(const components *c, int32_t *parent, int32_t y, int32_t reach)
{
    int32_t i = c->first[y - 1], i_end = c->first[y], j = c->first[y], j_end = c->first[y + 1];
    while (i < i_end && j < j_end) {
        if (c->span[i][0] < c->span[j][1] + reach && c->span[j][0] < c->span[i][1] + reach)
            unite(parent, i, j);
        if (c->span[i][1] < c->span[j][1])
            i++;
        else
            j++;
    }
}

static void find_band(void *shared, int32_t band)
{
    find_job *job = shared;
    const jali_bitmap *a = job->a;
    components *c = job->c;
    int32_t y0 = band * BAND_ROWS, y1 = MIN(y0 + BAND_ROWS, a->height_px);
    for (int32_t y = y0; y < y1; y++)
        if (c->first[y] < c->first[y + 1])
            find_runs(job, a->word + (int64_t)y * a->stride, c->span[c->first[y]]);
    for (int32_t i = c->first[y0]; i < c->first[y1]; i++) c->label[i] = i;
    for (int32_t y = y0 + 1; y < y1; y++) join_rows(c, c->label, y, job->reach);
}

jali_status label_components(jali_context *ctx, const jali_bitmap *a, bool white, int32_t connectivity,
                             components *out)
{
    jali_status status;
    components c = {.width_px = a->width_px, .height_px = a->height_px};
    find_job job = {a, white ? 0 : ~UINT64_C(0), connectivity == 8 ? 1 : 0, &c};
    int32_t bands = (a->height_px + BAND_ROWS - 1) / BAND_ROWS;
    TRY(ALLOCATE_CLEARED(ctx, c.first, (size_t)a->height_px + 1));
    parallel(ctx, bands, count_band, &job);
    for (int32_t y = 0; y < a->height_px; y++)
        if (__builtin_add_overflow(c.first[y + 1], c.first[y], &c.first[y + 1])) {
            status = fail(ctx, JALI_LIMIT, "the picture has more than 2^31 runs of pixels");
            goto done;
        }
    c.run_count = c.first[a->height_px];
    TRY(ALLOCATE(ctx, c.span, c.run_count));
    TRY(ALLOCATE(ctx, c.label, c.run_count));
    parallel(ctx, bands, find_band, &job);
    for (int32_t band = 1; band < bands; band++) join_rows(&c, c.label, band * BAND_ROWS, job.reach);
    // A parent comes before its children, so its entry is a label already when theirs are made.
    for (int32_t i = 0; i < c.run_count; i++) c.label[i] = c.label[i] == i ? c.count++ : c.label[c.label[i]];
done:
    if (status != JALI_OK) components_free(ctx, &c);
    *out = c;
    return status;
}

void components_free(jali_context *ctx, components *c)
{
    release(ctx, c->first);
    release(ctx, c->span);
    release(ctx, c->label);
    *c = (components){0};
}

int32_t run_at(const components *c, int32_t x, int32_t y)
{
    int32_t low = c->first[y], high = c->first[y + 1];
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (c->span[middle][1] <= x)
            low = middle + 1;
        else
            high = middle;
    }
    return low < c->first[y + 1] && c->span[low][0] <= x ? low : -1;
}

jali_status component_areas(jali_context *ctx, const components *c, int64_t **area)
{
    jali_status status = ALLOCATE_CLEARED(ctx, *area, c->count);
    if (status != JALI_OK) return status;
    for (int32_t i = 0; i < c->run_count; i++) (*area)[c->label[i]] += c->span[i][1] - c->span[i][0];
    return JALI_OK;
}
