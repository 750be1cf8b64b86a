// Operations that are made again on pictures that hardly differ: only where they do.
//
// Method:  source and result of the last operation are kept. Blocks of the result, COLUMN words wide, reach
// as
//          far above and below the rows that differ as the element; they alone are made, the rest is the last
//          result. (raster/vary.c does the same with elements that vary, in smaller blocks.)
// Cost:    a comparison and a copy of the picture, and the blocks. Where these are most of it, all is made.
// Checked: tests/test_metric.c against fields that do not remember.
#include "raster/remember.h"
#include "base/base.h"

enum { COLUMN = 8, MOST_ROWS = 512 }; // words, a block's least width; a block's height

typedef struct field_memory {
    known last[MORPH_RULES];
} field_memory;

jali_status field_remember(jali_context *ctx, field *f)
{
    return f->memory ? JALI_OK : ALLOCATE_CLEARED(ctx, f->memory, 1);
}

known *recall(const field *f, morph_rule rule)
{
    return f->memory ? &f->memory->last[rule] : NULL;
}

bool is_known(const known *k, const jali_bitmap *src, bool outside)
{
    return k->dst.word && k->outside == outside && k->src.width_px == src->width_px &&
           k->src.height_px == src->height_px;
}

void forget(jali_context *ctx, known *k)
{
    jali_bitmap_free(ctx, &k->src);
    jali_bitmap_free(ctx, &k->dst);
}

void field_memory_free(jali_context *ctx, field_memory *m)
{
    for (int32_t rule = 0; m && rule < MORPH_RULES; rule++) forget(ctx, &m->last[rule]);
    release(ctx, m);
}

typedef struct blocks {
    word_block *block; // [count]
    int32_t count;
    size_t capacity;
    int64_t words; // in all
} blocks;

// The rows y0 .. y1-1 of a column, whose last block is *last: joined with it where they touch it, as long as
// it is not so high that one thread would have most of the work.
static jali_status add_rows(jali_context *ctx, int64_t first, int32_t y0, int32_t y1, int32_t *last,
                            blocks *b)
{
    word_block *before = *last >= 0 ? &b->block[*last] : NULL;
    int32_t from = before ? MAX(y0, before->y1) : y0;
    if (from >= y1) return JALI_OK;
    b->words += (int64_t)(y1 - from) * COLUMN;
    if (before && from == before->y1 && y1 - before->y0 <= MOST_ROWS) {
        before->y1 = y1;
        return JALI_OK;
    }
    jali_status status = GROW(ctx, b->block, b->capacity, b->count + 1);
    if (status != JALI_OK) return status;
    *last = b->count++;
    b->block[*last] = (word_block){first, COLUMN, from, y1};
    return JALI_OK;
}

static bool words_differ(const uint64_t *a, const uint64_t *b, int64_t count)
{
    return memcmp(a, b, (size_t)count * sizeof *a) != 0;
}

typedef struct comparison {
    const jali_bitmap *now, *then;
    int64_t aside; // words of the neighbouring columns that a column's words are made of
    bool *row;     // [height_px], whether anything differs
    bool *column;  // [height_px][stride / COLUMN], where it does: what the column is made of
} comparison;

enum { BAND_ROWS = 256 };

static void compare_columns(const comparison *c, int32_t y)
{
    int64_t stride = c->now->stride;
    const uint64_t *now = c->now->word + y * stride, *then = c->then->word + y * stride;
    bool *differs = c->column + y * (stride / COLUMN);
    for (int64_t column = 0; column < stride; column += COLUMN) {
        int64_t first = MAX(column - c->aside, 0), end = MIN(column + COLUMN + c->aside, stride);
        differs[column / COLUMN] = words_differ(now + first, then + first, end - first);
    }
}

static void compare_rows(void *shared, int32_t band)
{
    const comparison *c = shared;
    int64_t stride = c->now->stride;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, c->now->height_px); y++) {
        c->row[y] = words_differ(c->now->word + y * stride, c->then->word + y * stride, stride);
        if (c->row[y]) compare_columns(c, y);
    }
}

// What of the result can differ, as src differs from `before`.
static jali_status find_blocks(jali_context *ctx, const field *f, const jali_bitmap *before,
                               const jali_bitmap *src, blocks *b)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t reach = MAX(f->above, f->below) + 1, height = src->height_px; // + 1: even elements are reflected
    int32_t columns = (int32_t)(src->stride / COLUMN);
    int32_t *last; // [columns]
    comparison c = {.now = src, .then = before, .aside = (MAX(f->left, f->right) + 64) / 64};
    TRY(ARENA(ctx, last, columns));
    TRY(ARENA(ctx, c.row, height));
    TRY(ARENA(ctx, c.column, (size_t)height * (size_t)columns));
    parallel(ctx, (height + BAND_ROWS - 1) / BAND_ROWS, compare_rows, &c);
    for (int32_t i = 0; i < columns; i++) last[i] = -1;
    for (int32_t y = 0; y < height; y++)
        for (int32_t i = 0; c.row[y] && i < columns; i++)
            if (c.column[(int64_t)y * columns + i])
                TRY(add_rows(ctx, (int64_t)i * COLUMN, MAX(y - reach, 0), MIN(y + reach + 1, height),
                             &last[i], b));
done:
    arena_rewind(ctx, mark);
    return status;
}

static void copy_block(const jali_bitmap *from, const word_block *b, jali_bitmap *to)
{
    for (int64_t y = b->y0; y < b->y1; y++)
        memcpy(to->word + y * to->stride + b->first, from->word + y * from->stride + b->first,
               (size_t)b->words * sizeof *to->word);
}

typedef struct keeping {
    const blocks *b;
    const jali_bitmap *src, *dst;
    known *k;
} keeping;

static void keep_block(void *shared, int32_t i)
{
    const keeping *job = shared;
    copy_block(job->src, &job->b->block[i], &job->k->src);
    copy_block(job->dst, &job->b->block[i], &job->k->dst);
}

// Make all of dst, and remember it.
static jali_status morph_anew(jali_context *ctx, morph_rule rule, const jali_bitmap *src, const field *f,
                              bool outside, known *k, jali_bitmap *dst)
{
    jali_status status;
    bool same_size = is_known(k, src, k->outside);
    TRY(morph_blocks(ctx, rule, src, &f->whole, outside, NULL, 0, dst));
    k->outside = outside;
    if (same_size) {
        copy_pixels(ctx, src, &k->src);
        copy_pixels(ctx, dst, &k->dst);
    } else {
        forget(ctx, k);
        TRY(jali_bitmap_copy(ctx, src, &k->src));
        TRY(jali_bitmap_copy(ctx, dst, &k->dst));
    }
done:
    return status;
}

// Make dst from the last result, and remember what changed.
static jali_status morph_changes(jali_context *ctx, morph_rule rule, const jali_bitmap *src, const field *f,
                                 bool outside, const blocks *b, known *k, jali_bitmap *dst)
{
    copy_pixels(ctx, &k->dst, dst);
    if (b->count == 0) return JALI_OK;
    jali_status status = morph_blocks(ctx, rule, src, &f->whole, outside, b->block, b->count, dst);
    if (status == JALI_OK) parallel(ctx, b->count, keep_block, &(keeping){b, src, dst, k});
    return status;
}

jali_status morph_flat(jali_context *ctx, morph_rule rule, const jali_bitmap *src, const field *f,
                       bool outside, jali_bitmap *dst)
{
    jali_status status;
    known *k = recall(f, rule);
    blocks b = {0};
    if (!k || !src->word) return morph_blocks(ctx, rule, src, &f->whole, outside, NULL, 0, dst);
    bool by_changes = is_known(k, src, outside);
    if (by_changes) TRY(find_blocks(ctx, f, &k->src, src, &b));
    if (by_changes && b.words <= src->stride * src->height_px / 2)
        TRY(morph_changes(ctx, rule, src, f, outside, &b, k, dst));
    else
        TRY(morph_anew(ctx, rule, src, f, outside, k, dst));
done:
    release(ctx, b.block);
    return status;
}
