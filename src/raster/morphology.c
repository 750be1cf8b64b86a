// Erosion, dilation, opening and closing by convex symmetric elements.
//
// Method:  along rows, a source row gives one eroded copy (a level) for each distinct reach of the element,
//          each made from the level before: E(a+s) = E(a) AND E(a) moved left by s AND E(a) moved right by s.
//          Levels of the last rows stand in a ring. Down the columns, BLOCK output rows are made together:
//          where the element has `count` rows of one reach in a run, the rows that all of the block need are
//          ANDed once, those before and after them one by one in registers (van Herk's and Gil's trick in a
//          block): (count + BLOCK - 1) / BLOCK reads a row instead of `count`. A dilation is the erosion of
//          the complement by the reflected element.
//          Only the blocks that are wanted are made; a whole picture is a few blocks of full rows.
// Cost:    about 7 word operations a level, and for squares 1 / BLOCK a row of the element, per word; 8 words
//          an AVX-512 instruction.
// Limits:  src and dst are different bitmaps in erode and dilate.
// Checked: tests/test_raster.c against the definition, every element up to 12 px, both values of outside.
#include "raster/raster.h"
#include "base/base.h"

#include <stdlib.h>

enum { STRIPS = 16, STRIP_ROWS = 64, MAX_LEVELS = 1024, BLOCK = 8 };

typedef uint64_t lanes __attribute__((vector_size(64), aligned(8)));

// Rows of the element that reach equally far, one below the other.
typedef struct reach_run {
    int32_t level, first, count; // rows first .. first + count - 1 of the element, 0 the topmost
} reach_run;

typedef struct plan {
    const jali_bitmap *src;
    jali_bitmap *dst;
    const element *e;
    uint64_t flip;   // all ones for a dilation: work on the complement
    uint64_t beyond; // what lies outside, already flipped
    bool reflect;
    int32_t level_count;
    int32_t level_reach[MAX_LEVELS]; // widening; helper levels stand between where a step would be too wide
    int32_t *level_of;               // [e->rows], the level of the row at that distance from the middle
    int32_t run_count;
    reach_run *run;       // [run_count], from the top of the element to its bottom
    int32_t row_count;    // rows that the runs read for a block: each its count and BLOCK - 1 more
    const uint64_t **row; // [jobs][row_count], where those rows stand in the ring
    int64_t guard;        // words on each side of a block where levels must be right
    int64_t ring_words;
    uint64_t *ring; // [jobs][ring_words]: source row, then level by level, row by row; each row has 2 guard +
                    // 2 more words on each side of a block's
    const word_block *block; // [block_count], what is wanted of dst
    int32_t block_count, jobs;
} plan;

static bool is_even(const element *e)
{
    return e->size % 2 == 0;
}

// dst[i] = a AND a moved left by the shift AND a moved right by it.
VECTORISED static void squeeze(const uint64_t *a, uint64_t *dst, int64_t n, int32_t shift_px)
{
    int64_t words = shift_px / 64;
    int32_t bits = shift_px % 64;
    const uint64_t *ahead = a + words, *behind = a - words;
    if (bits == 0)
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] & ahead[i] & behind[i];
    else
        for (int64_t i = 0; i < n; i++)
            dst[i] = a[i] & (ahead[i] >> bits | ahead[i + 1] << (64 - bits)) &
                     (behind[i] << bits | behind[i - 1] >> (64 - bits));
}

// The first level of an even element: a pixel and its left neighbour (reflected: its right one).
VECTORISED static void pair(const uint64_t *a, uint64_t *dst, int64_t n, bool reflect)
{
    if (reflect)
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] & (a[i] >> 1 | a[i + 1] << 63);
    else
        for (int64_t i = 0; i < n; i++) dst[i] = a[i] & (a[i] << 1 | a[i - 1] >> 63);
}

// A run of `count` rows for BLOCK output rows: output b is the AND of row[b] .. row[b + count - 1] at words
// i .. i + 7.
static inline void and_run(const uint64_t *const *row, int32_t count, int64_t i, lanes all[BLOCK])
{
#define AT(k) (*(const lanes *)(row[k] + i))
    if (count < BLOCK) {
        for (int32_t k = 0; k < count; k++)
            for (int32_t b = 0; b < BLOCK; b++) all[b] &= AT(b + k);
        return;
    }
    lanes common = AT(BLOCK - 1);
    for (int32_t k = BLOCK; k < count; k++) common &= AT(k);
    lanes before = common, after = ~(lanes){0};
    all[BLOCK - 1] &= common;
    for (int32_t b = BLOCK - 2; b >= 0; b--) all[b] &= before &= AT(b);
    for (int32_t b = 1; b < BLOCK; b++) all[b] &= after &= AT(count + b - 1);
#undef AT
}

// `words` words, a multiple of 8, of `rows` output rows, at most BLOCK, from `out` on.
VECTORISED static void and_block(const reach_run *run, int32_t run_count, const uint64_t *const *row,
                                 uint64_t flip, uint64_t *out, int64_t words, int64_t pitch, int32_t rows)
{
    for (int64_t i = 0; i < words; i += 8) {
        lanes all[BLOCK];
        for (int32_t b = 0; b < BLOCK; b++) all[b] = ~(lanes){0};
        const uint64_t *const *next = row;
        for (int32_t r = 0; r < run_count; r++) {
            and_run(next, run[r].count, i, all);
            next += run[r].count + BLOCK - 1;
        }
        for (int32_t b = 0; b < rows; b++) *(lanes *)(out + b * pitch + i) = all[b] ^ flip;
    }
}

VECTORISED static void xor_copy(uint64_t *dst, const uint64_t *a, uint64_t flip, int64_t n)
{
    for (int64_t i = 0; i < n; i++) dst[i] = a[i] ^ flip;
}

static int64_t ring_pitch(const plan *p, const word_block *b)
{
    return b->words + 2 * (2 * p->guard + 2);
}

static uint64_t *ring_row(const plan *p, const word_block *b, uint64_t *ring, int32_t level, int32_t y)
{
    int32_t slots = p->e->size + BLOCK - 1, slot = (y + slots) % slots;
    return ring + (1 + (int64_t)level * slots + slot) * ring_pitch(p, b);
}

// Rows of the element above the pixel that it is centred on.
static int32_t rows_above(const plan *p)
{
    return p->e->size / 2 - (is_even(p->e) && p->reflect);
}

// A source row around the block's words, flipped, with what lies beyond the bitmap; base[0] is the block's
// first word.
static void read_source(const plan *p, const word_block *b, int32_t y, uint64_t *base)
{
    int64_t lead = 2 * p->guard + 2, stride = p->src->stride, whole = p->src->width_px / 64;
    int64_t first = MAX(b->first - lead, 0), end = MIN(b->first + b->words + lead, stride);
    uint64_t inside = (UINT64_C(1) << p->src->width_px % 64) - 1;
    xor_copy(base + first - b->first, p->src->word + y * stride + first, p->flip, end - first);
    if (whole >= first && whole < end) {
        uint64_t *partial = &base[whole - b->first];
        *partial = (*partial & inside) | (p->beyond & ~inside);
    }
    for (int64_t i = MAX(whole + 1, first); i < end; i++) base[i - b->first] = p->beyond;
}

// Levels of source row y. `base` and each ring row start 2 guard + 2 words before the block's first column.
// Inside a picture the levels are wrong at the guard's outer end, from where an element's reach does not get
// to the block.
static void make_levels(const plan *p, const word_block *b, uint64_t *ring, int32_t y)
{
    int64_t lead = 2 * p->guard + 2;
    if (y < 0 || y >= p->src->height_px) {
        for (int32_t level = 0; level < p->level_count; level++) {
            uint64_t *row = ring_row(p, b, ring, level, y);
            for (int64_t i = 0; i < ring_pitch(p, b); i++) row[i] = p->beyond;
        }
        return;
    }
    read_source(p, b, y, ring + lead);
    const uint64_t *from = ring + lead - p->guard;
    int64_t span = b->words + 2 * p->guard;
    for (int32_t level = 0; level < p->level_count; level++) {
        uint64_t *to = ring_row(p, b, ring, level, y) + lead - p->guard;
        if (level == 0 && !is_even(p->e))
            memcpy(to, from, (size_t)span * sizeof *to);
        else if (level == 0)
            pair(from, to, span, p->reflect);
        else
            squeeze(from, to, span, p->level_reach[level] - p->level_reach[level - 1]);
        from = to;
    }
}

// Where the rows stand that the output rows from y on read, at most BLOCK of them.
static void find_rows(const plan *p, const word_block *b, uint64_t *ring, int32_t top, const uint64_t **row)
{
    int64_t lead = 2 * p->guard + 2;
    for (int32_t r = 0; r < p->run_count; r++)
        for (int32_t k = 0; k < p->run[r].count + BLOCK - 1; k++)
            *row++ = ring_row(p, b, ring, p->run[r].level, top + p->run[r].first + k) + lead;
}

static void erode_words(const plan *p, const word_block *b, uint64_t *ring, const uint64_t **row)
{
    int64_t stride = p->src->stride, whole = p->src->width_px / 64, end = b->first + b->words;
    int32_t above = rows_above(p), below = p->e->size - 1 - above;
    for (int64_t i = 0; i < p->ring_words; i++) ring[i] = p->beyond;
    for (int32_t y = b->y0 - above; y < b->y0 + below; y++) make_levels(p, b, ring, y);
    for (int32_t y = b->y0; y < b->y1; y += BLOCK) {
        int32_t rows = MIN(BLOCK, b->y1 - y);
        for (int32_t k = 0; k < rows; k++) make_levels(p, b, ring, y + k + below);
        find_rows(p, b, ring, y - above, row);
        uint64_t *out = p->dst->word + y * stride;
        and_block(p->run, p->run_count, row, p->flip, out + b->first, b->words, stride, rows);
        for (int32_t k = 0; k < rows; k++, out += stride) {
            if (whole >= b->first && whole < end) out[whole] &= (UINT64_C(1) << p->src->width_px % 64) - 1;
            for (int64_t i = MAX(whole + 1, b->first); i < end; i++) out[i] = 0;
        }
    }
}

static void erode_blocks(void *shared, int32_t job)
{
    const plan *p = shared;
    for (int32_t i = job; i < p->block_count; i += p->jobs)
        erode_words(p, &p->block[i], p->ring + job * p->ring_words, p->row + (int64_t)job * p->row_count);
}

// Reaches from the narrowest row of the element to the widest. A step s leaves no gap while it is at most the
// number of columns that the level before covers.
static jali_status plan_levels(jali_context *ctx, plan *p)
{
    const element *e = p->e;
    int32_t even = is_even(e);
    p->level_reach[0] = even;
    p->level_count = 1;
    for (int32_t i = e->rows - 1; i >= 0; i--) {
        for (int32_t reach; (reach = p->level_reach[p->level_count - 1]) < e->half[i]; p->level_count++) {
            int32_t widest = reach + 2 * reach + 1 - even;
            if (p->level_count == MAX_LEVELS)
                return fail(ctx, JALI_BAD_VALUE, "a structuring element of %d px has too many distinct rows",
                            e->size);
            p->level_reach[p->level_count] = MIN(widest, e->half[i]);
        }
        p->level_of[i] = p->level_count - 1;
    }
    return JALI_OK;
}

// Rows of one level after another are a run: from the topmost row of the element to the last.
static jali_status plan_runs(jali_context *ctx, plan *p)
{
    jali_status status = ARENA(ctx, p->run, p->e->size);
    if (status != JALI_OK) return status;
    int32_t offset = is_even(p->e) ? (p->reflect ? -1 : 1) : 0; // twice the distance from pixel to centre
    for (int32_t k = 0; k < p->e->size; k++) {
        int32_t level = p->level_of[abs(2 * (k - rows_above(p)) + offset) / 2];
        if (p->run_count == 0 || p->run[p->run_count - 1].level != level)
            p->run[p->run_count++] = (reach_run){level, k, 0};
        p->run[p->run_count - 1].count++;
    }
    p->row_count = p->e->size + p->run_count * (BLOCK - 1);
    return JALI_OK;
}

// The whole picture as blocks of full rows, a job each.
static jali_status plan_strips(jali_context *ctx, plan *p)
{
    int32_t height = p->src->height_px, rows = MAX(STRIP_ROWS, (height + STRIPS - 1) / STRIPS);
    word_block *block;
    jali_status status = ARENA(ctx, block, (height + rows - 1) / rows);
    for (int32_t y = 0; status == JALI_OK && y < height; y += rows)
        block[p->block_count++] = (word_block){0, p->src->stride, y, MIN(y + rows, height)};
    p->block = block;
    return status;
}

static jali_status run(jali_context *ctx, plan *p)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const element *e = p->e;
    int64_t widest = 0;
    if (!p->src->word) return JALI_OK;
    TRY(ARENA(ctx, p->level_of, e->rows));
    TRY(plan_levels(ctx, p));
    TRY(plan_runs(ctx, p));
    if (!p->block) TRY(plan_strips(ctx, p));
    p->jobs = MIN(p->block_count, STRIPS);
    p->guard = 1 + (e->size / 2 + 63) / 64;
    for (int32_t i = 0; i < p->block_count; i++) widest = MAX(widest, ring_pitch(p, &p->block[i]));
    p->ring_words = (1 + (int64_t)p->level_count * (e->size + BLOCK - 1)) * widest;
    TRY(ARENA(ctx, p->row, (size_t)p->row_count * (size_t)p->jobs));
    TRY(ARENA(ctx, p->ring, p->ring_words * p->jobs));
    parallel(ctx, p->jobs, erode_blocks, p);
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status morph_blocks(jali_context *ctx, morph_rule rule, const jali_bitmap *src, const element *e,
                         bool outside, const word_block *block, int32_t count, jali_bitmap *dst)
{
    bool flip = rule == MORPH_DILATE || rule == MORPH_WIDEN;
    plan p = {.src = src,
              .dst = dst,
              .e = e,
              .flip = flip ? ~UINT64_C(0) : 0,
              .beyond = outside != flip ? ~UINT64_C(0) : 0,
              .reflect = rule == MORPH_DILATE || rule == MORPH_NARROW,
              .block = block,
              .block_count = block ? count : 0};
    return run(ctx, &p);
}

jali_status erode(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside, jali_bitmap *dst)
{
    return morph_blocks(ctx, MORPH_ERODE, src, e, outside, NULL, 0, dst);
}

jali_status dilate(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                   jali_bitmap *dst)
{
    return morph_blocks(ctx, MORPH_DILATE, src, e, outside, NULL, 0, dst);
}

jali_status open_by(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                    jali_bitmap *scratch, jali_bitmap *dst)
{
    jali_status status = erode(ctx, src, e, outside, scratch);
    return status == JALI_OK ? dilate(ctx, scratch, e, false, dst) : status;
}

jali_status close_by(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                     jali_bitmap *scratch, jali_bitmap *dst)
{
    jali_status status = morph_blocks(ctx, MORPH_WIDEN, src, e, outside, NULL, 0, scratch);
    return status == JALI_OK ? morph_blocks(ctx, MORPH_NARROW, scratch, e, true, NULL, 0, dst) : status;
}
