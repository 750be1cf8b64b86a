// Logic and counting on whole bitmaps, in bands of rows.
#include "raster/raster.h"
#include "base/base.h"

#include <stdatomic.h>

enum { BAND_WORDS = 1 << 14 }; // 128 KiB of each operand: they fit the second-level cache

typedef struct logic_job {
    bitmap_rule rule;
    const uint64_t *a, *b;
    uint64_t *dst;
    int64_t words;
    atomic_llong count;
} logic_job;

VECTORISED static void combine_words(bitmap_rule rule, const uint64_t *a, const uint64_t *b, uint64_t *dst,
                                     int64_t n)
{
    switch (rule) {
    case RULE_AND:
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] & b[i];
        break;
    case RULE_OR:
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] | b[i];
        break;
    case RULE_XOR:
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] ^ b[i];
        break;
    case RULE_AND_NOT:
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] & ~b[i];
        break;
    case RULE_OR_NOT:
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] | ~b[i];
        break;
    }
}

VECTORISED static int64_t count_words(bitmap_rule rule, const uint64_t *a, const uint64_t *b, int64_t n)
{
    int64_t total = 0;
    switch (rule) {
    case RULE_AND:
        for (int64_t i = 0; i < n; i++) total += __builtin_popcountll(a[i] & b[i]);
        break;
    case RULE_OR:
        for (int64_t i = 0; i < n; i++) total += __builtin_popcountll(a[i] | b[i]);
        break;
    case RULE_XOR:
        for (int64_t i = 0; i < n; i++) total += __builtin_popcountll(a[i] ^ b[i]);
        break;
    case RULE_AND_NOT:
        for (int64_t i = 0; i < n; i++) total += __builtin_popcountll(a[i] & ~b[i]);
        break;
    case RULE_OR_NOT:
        for (int64_t i = 0; i < n; i++) total += __builtin_popcountll(a[i] | ~b[i]);
        break;
    }
    return total;
}

static int64_t word_count(const jali_bitmap *a)
{
    return a->stride * a->height_px;
}

static int32_t band_count(int64_t words)
{
    return (int32_t)((words + BAND_WORDS - 1) / BAND_WORDS);
}

static void combine_band(void *shared, int32_t band)
{
    const logic_job *job = shared;
    int64_t from = (int64_t)band * BAND_WORDS;
    combine_words(job->rule, job->a + from, job->b + from, job->dst + from,
                  MIN(BAND_WORDS, job->words - from));
}

void combine(jali_context *ctx, bitmap_rule rule, const jali_bitmap *a, const jali_bitmap *b,
             jali_bitmap *dst)
{
    logic_job job = {rule, a->word, b->word, dst->word, word_count(a), 0};
    parallel(ctx, band_count(job.words), combine_band, &job);
}

static void copy_band(void *shared, int32_t band)
{
    const logic_job *job = shared;
    int64_t from = (int64_t)band * BAND_WORDS;
    memcpy(job->dst + from, job->a + from, (size_t)MIN(BAND_WORDS, job->words - from) * sizeof *job->dst);
}

void copy_pixels(jali_context *ctx, const jali_bitmap *src, jali_bitmap *dst)
{
    logic_job job = {.a = src->word, .dst = dst->word, .words = word_count(src)};
    parallel(ctx, band_count(job.words), copy_band, &job);
}

// --- By rows

enum { BAND_ROWS = 256 };

typedef struct rows_job {
    const jali_bitmap *src;
    jali_bitmap *dst;
    int32_t left, top; // of the smaller one in the larger one
    bool white;
    void (*row)(const struct rows_job *job, int32_t y);
} rows_job;

static void run_band(void *shared, int32_t band)
{
    const rows_job *job = shared;
    int32_t rows = MIN(job->src->height_px, job->dst->height_px), y1 = MIN((band + 1) * BAND_ROWS, rows);
    for (int32_t y = band * BAND_ROWS; y < y1; y++) job->row(job, y);
}

static void run_rows(jali_context *ctx, rows_job job, void (*row)(const rows_job *job, int32_t y))
{
    job.row = row;
    int32_t rows = MIN(job.src->height_px, job.dst->height_px);
    parallel(ctx, (rows + BAND_ROWS - 1) / BAND_ROWS, run_band, &job);
}

// Bits beyond the width stay 0 whatever is written into them.
static void clear_padding(const jali_bitmap *a, uint64_t *row)
{
    int64_t whole = a->width_px / 64;
    if (whole < a->stride) row[whole] &= (UINT64_C(1) << a->width_px % 64) - 1;
    for (int64_t i = whole + 1; i < a->stride; i++) row[i] = 0;
}

static void invert_row(const rows_job *job, int32_t y)
{
    const uint64_t *from = job->src->word + y * job->src->stride;
    uint64_t *to = job->dst->word + y * job->dst->stride;
    for (int64_t i = 0; i < job->src->stride; i++) to[i] = ~from[i];
    clear_padding(job->dst, to);
}

void invert(jali_context *ctx, const jali_bitmap *a, jali_bitmap *dst)
{
    run_rows(ctx, (rows_job){.src = a, .dst = dst}, invert_row);
}

static void fill_row(const rows_job *job, int32_t y)
{
    uint64_t *to = job->dst->word + y * job->dst->stride;
    memset(to, job->white ? 0xff : 0, (size_t)job->dst->stride * sizeof *to);
    if (job->white) clear_padding(job->dst, to);
}

void fill(jali_context *ctx, jali_bitmap *dst, bool white)
{
    run_rows(ctx, (rows_job){.src = dst, .dst = dst, .white = white}, fill_row);
}

// --- Counts

static void count_band(void *shared, int32_t band)
{
    logic_job *job = shared;
    int64_t from = (int64_t)band * BAND_WORDS;
    int64_t found = count_words(job->rule, job->a + from, job->b + from, MIN(BAND_WORDS, job->words - from));
    atomic_fetch_add(&job->count, found);
}

int64_t count_combined(jali_context *ctx, bitmap_rule rule, const jali_bitmap *a, const jali_bitmap *b)
{
    logic_job job = {.rule = rule, .a = a->word, .b = b->word, .words = word_count(a)};
    parallel(ctx, band_count(job.words), count_band, &job);
    return job.count;
}

int64_t count_white(jali_context *ctx, const jali_bitmap *a)
{
    return count_combined(ctx, RULE_AND, a, a);
}

bool any_white(jali_context *ctx, const jali_bitmap *a)
{
    (void)ctx;
    for (int64_t i = 0; i < word_count(a); i++)
        if (a->word[i]) return true;
    return false;
}

// `count` bits (1 .. 64) of the row from column x on; bits beyond the row's words read as 0.
static uint64_t bits_at(const uint64_t *row, int64_t words, int64_t x)
{
    int64_t i = x >> 6;
    int32_t bit = (int32_t)(x & 63);
    uint64_t low = i < words ? row[i] >> bit : 0;
    return bit && i + 1 < words ? low | row[i + 1] << (64 - bit) : low;
}

static void cut_row(const rows_job *job, int32_t y)
{
    const jali_bitmap *src = job->src, *dst = job->dst;
    const uint64_t *from = src->word + (int64_t)(y + job->top) * src->stride;
    uint64_t *to = dst->word + (int64_t)y * dst->stride;
    for (int32_t x = 0; x < dst->width_px; x += 64) {
        uint64_t mask = dst->width_px - x >= 64 ? ~UINT64_C(0) : (UINT64_C(1) << (dst->width_px - x)) - 1;
        to[x >> 6] = bits_at(from, src->stride, (int64_t)job->left + x) & mask;
    }
}

void cut_out(jali_context *ctx, const jali_bitmap *src, int32_t left, int32_t top, jali_bitmap *dst)
{
    run_rows(ctx, (rows_job){.src = src, .dst = dst, .left = left, .top = top}, cut_row);
}

static void paste_row(const rows_job *job, int32_t y)
{
    const jali_bitmap *src = job->src, *dst = job->dst;
    int32_t shift = job->left & 63;
    const uint64_t *from = src->word + (int64_t)y * src->stride;
    uint64_t *to = dst->word + (int64_t)(y + job->top) * dst->stride + (job->left >> 6);
    for (int32_t x = 0; x < src->width_px; x += 64) {
        uint64_t mask = src->width_px - x >= 64 ? ~UINT64_C(0) : (UINT64_C(1) << (src->width_px - x)) - 1;
        uint64_t word = from[x >> 6];
        to[x >> 6] = (to[x >> 6] & ~(mask << shift)) | word << shift;
        if (shift && mask >> (64 - shift))
            to[(x >> 6) + 1] = (to[(x >> 6) + 1] & ~(mask >> (64 - shift))) | word >> (64 - shift);
    }
}

void paste(jali_context *ctx, const jali_bitmap *src, int32_t left, int32_t top, jali_bitmap *dst)
{
    run_rows(ctx, (rows_job){.src = src, .dst = dst, .left = left, .top = top}, paste_row);
}
