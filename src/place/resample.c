// Resampling with edges between pixels, in whole numbers, so that every machine draws the same line.
//
// Enlarging interpolates between the four nearest input pixels: a straight edge stays exactly where it is, a
// line of any whole width keeps it, and the corners of a two-tone input's stairs are cut. Reducing takes the
// exact mean over the area of the working pixel. Either way the threshold comes last.
//
// A quadratic B-spline rounds the stairs a little more, but eats small things: at twice the input's
// resolution 1.2 instead of 0.9 % of the pixels of a dense engraving change, 2.6 instead of 1.9 % of a
// halftone.
//
// Limits:  an isolated input pixel keeps 0.6 of its area when enlarged.
// Checked: tests/test_place.c: against plain formulas, pixel by pixel; straight edges at any scale.
#include "place/resample.h"

enum { ROWS_A_BAND = 64, WORD_PX = 64, WEIGHT_ONE = 256 };

// Two neighbours, first and first + 1, and the weight of the second.
typedef struct tap {
    int32_t first;
    uint32_t second_weight; // 0 .. WEIGHT_ONE
} tap;

typedef struct resampling {
    const jali_picture *from;
    jali_bitmap *to;
    int32_t margin, columns, rows, threshold;
    tap *column;   // [columns] enlarging only
    void *scratch; // [bands * scratch_bytes] one row of samples a band
    size_t scratch_bytes;
} resampling;

// Pixel i of `count` in an input of `size` pixels: between which two centres its own centre falls. Beyond the
// outermost centres their grey goes on.
static tap tap_of(int64_t i, int64_t count, int64_t size)
{
    int64_t place = (2 * i + 1) * size - count; // in parts of 1 / (2 count), from the first pixel's centre
    int64_t first = place / (2 * count), rest = place - first * 2 * count;
    if (place < 0) return (tap){0, 0};
    if (first >= size - 1) return (tap){(int32_t)size - 1, 0};
    return (tap){(int32_t)first, (uint32_t)((rest * WEIGHT_ONE + count) / (2 * count))};
}

VECTORISED static void blend_rows(const uint8_t *restrict a, const uint8_t *restrict b, uint32_t weight_b,
                                  int32_t width, uint16_t *restrict to)
{
    uint16_t wb = (uint16_t)weight_b, wa = (uint16_t)(WEIGHT_ONE - weight_b);
    for (int32_t x = 0; x < width; x++) to[x] = (uint16_t)(a[x] * wa + b[x] * wb);
}

// One bit a column, 64 to a word, shifted past the margin.
static void put_bits(uint64_t *row, int32_t x, uint64_t bits, int32_t count)
{
    int32_t shift = x & 63;
    uint64_t *word = &row[x >> 6];
    word[0] |= bits << shift;
    if (shift + count > 64) word[1] |= bits >> (64 - shift);
}

static void sample_row(const uint16_t *blended, const tap *column, int32_t columns, uint32_t limit,
                       int32_t margin, uint64_t *row)
{
    for (int32_t x0 = 0; x0 < columns; x0 += WORD_PX) {
        int32_t count = MIN(columns - x0, WORD_PX);
        uint64_t bits = 0;
        for (int32_t i = 0; i < count; i++) {
            const tap *t = &column[x0 + i];
            const uint16_t *pair = &blended[t->first];
            uint32_t grey = pair[0] * (WEIGHT_ONE - t->second_weight) + pair[1] * t->second_weight;
            bits |= (uint64_t)(grey >= limit) << i;
        }
        put_bits(row, margin + x0, bits, count);
    }
}

static uint64_t *row_of(const resampling *job, int32_t y)
{
    return job->to->word + (int64_t)(y + job->margin) * job->to->stride;
}

static void enlarge_band(void *shared, int32_t index)
{
    const resampling *job = shared;
    const jali_picture *from = job->from;
    int64_t width = from->width_px;
    uint16_t *blended = (uint16_t *)((char *)job->scratch + (size_t)index * job->scratch_bytes);
    uint32_t limit = (uint32_t)(2 * job->threshold - 1) * (WEIGHT_ONE * WEIGHT_ONE / 2);
    int32_t last = MIN((index + 1) * ROWS_A_BAND, job->rows);
    for (int32_t y = index * ROWS_A_BAND; y < last; y++) {
        tap t = tap_of(y, job->rows, from->height_px);
        const uint8_t *first = from->grey + t.first * width,
                      *second = t.second_weight ? first + width : first;
        blend_rows(first, second, t.second_weight, (int32_t)width, blended);
        blended[width] = 0; // read with weight 0 past the last column
        sample_row(blended, job->column, job->columns, limit, job->margin, row_of(job, y));
    }
}

VECTORISED static void add_weighted(const uint8_t *restrict grey, uint32_t weight, int32_t width,
                                    uint32_t *restrict sum)
{
    for (int32_t x = 0; x < width; x++) sum[x] += grey[x] * weight;
}

// Lengths are counted in parts of 1 / (input size x output size): an input pixel is `count` long, an output
// pixel `size`, and every overlap is whole.
static void reduce_row(const uint32_t *sum, int64_t size, int64_t count, uint64_t limit, int32_t margin,
                       uint64_t *row)
{
    int64_t x = 0, left_of_x = count; // input pixel, and how much of it is not yet taken
    for (int32_t i = 0; i < count; i++) {
        uint64_t area = 0;
        for (int64_t wanted = size; wanted > 0;) {
            int64_t taken = MIN(wanted, left_of_x);
            area += (uint64_t)sum[x] * (uint64_t)taken;
            wanted -= taken;
            left_of_x -= taken;
            if (left_of_x == 0) x++, left_of_x = count;
        }
        if (area >= limit) row[(margin + i) >> 6] |= (uint64_t)1 << ((margin + i) & 63);
    }
}

static void reduce_band(void *shared, int32_t index)
{
    const resampling *job = shared;
    const jali_picture *from = job->from;
    int64_t width = from->width_px, size = from->height_px, count = job->rows;
    uint32_t *sum = (uint32_t *)((char *)job->scratch + (size_t)index * job->scratch_bytes);
    uint64_t limit = ((uint64_t)(2 * job->threshold - 1) * (uint64_t)width * (uint64_t)size + 1) / 2;
    int32_t last = MIN((index + 1) * ROWS_A_BAND, job->rows);
    for (int32_t y = index * ROWS_A_BAND; y < last; y++) {
        memset(sum, 0, (size_t)width * sizeof *sum);
        for (int64_t at = y * size; at < (y + 1) * size;) {
            int64_t input = at / count, end = MIN((input + 1) * count, (y + 1) * size);
            add_weighted(from->grey + input * width, (uint32_t)(end - at), (int32_t)width, sum);
            at = end;
        }
        reduce_row(sum, width, job->columns, limit, job->margin, row_of(job, y));
    }
}

static void keep_band(void *shared, int32_t index)
{
    const resampling *job = shared;
    int32_t last = MIN((index + 1) * ROWS_A_BAND, job->rows);
    for (int32_t y = index * ROWS_A_BAND; y < last; y++) {
        const uint8_t *grey = job->from->grey + (int64_t)y * job->columns;
        for (int32_t x0 = 0; x0 < job->columns; x0 += WORD_PX) {
            int32_t count = MIN(job->columns - x0, WORD_PX);
            uint64_t bits = 0;
            for (int32_t i = 0; i < count; i++) bits |= (uint64_t)(grey[x0 + i] >= job->threshold) << i;
            put_bits(row_of(job, y), job->margin + x0, bits, count);
        }
    }
}

jali_status resample(jali_context *ctx, const jali_picture *from, int32_t threshold, int32_t margin_px,
                     jali_bitmap *to)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    resampling job = {.from = from, .to = to, .margin = margin_px, .threshold = threshold};
    job.columns = to->width_px - 2 * margin_px;
    job.rows = to->height_px - 2 * margin_px;
    int32_t bands = (job.rows + ROWS_A_BAND - 1) / ROWS_A_BAND;
    bool same = job.columns == from->width_px && job.rows == from->height_px;
    bool enlarged = job.columns >= from->width_px && job.rows >= from->height_px;
    job.scratch_bytes = ((size_t)from->width_px + 1) * sizeof(uint32_t);
    TRY(step(ctx, "place", 0));
    TRY(arena_take(ctx, &job.scratch, (size_t)bands, job.scratch_bytes));
    TRY(ARENA(ctx, job.column, job.columns));
    for (int32_t x = 0; x < job.columns; x++) job.column[x] = tap_of(x, job.columns, from->width_px);
    parallel(ctx, bands, same ? keep_band : enlarged ? enlarge_band : reduce_band, &job);
    status = step(ctx, "place", 1);
done:
    arena_rewind(ctx, mark);
    return status;
}
