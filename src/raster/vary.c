// Morphology with an element that varies from tile to tile.
//
// Method:  tiles beside each other that have one patch are one span. An erosion asks, for each word of the
//          span and row by row of the patch, whether each run of it lies in the picture: the AND of n
//          shifted copies takes log2(n) steps in a window of 128 bits, and is kept by length for all rows of
//          the patch. A dilation spreads the span's words likewise. The two are adjoint: x is in the erosion
//          if and only if x's patch lies in the picture, and the dilation paints exactly those patches.
// Source:  spatially variant mathematical morphology (Serra, Image Analysis and Mathematical Morphology II,
//          1988, ch. 2); opening by adjunction.
// Cost:    a patch of n rows costs about 10 n operations a word of 64 px and span; words without a set pixel
//          and words all around which everything is set cost nothing.
// Checked: tests/test_metric.c against the definition; the laws of openings.
#include "raster/remember.h"
#include "base/base.h"

enum { BLOCK_ROWS = 16, STRIP_ROWS = 64, MOST_TILE_ROWS = 64 };

__extension__ typedef unsigned __int128 wide;

typedef struct varying {
    const field *f;
    jali_bitmap *dst;
    uint64_t flip;  // all ones: the complement of a dilation is wanted
    uint64_t *word; // [height + above + below][pitch]: the source in a margin of what lies beyond
    uint16_t *deep; // of each such word: rows up to this one in which it and its two neighbours are all set
    int64_t pitch, lead;
    int32_t above, below;   // rows of that margin
    const uint8_t *active;  // [blocks][stride]: words of the result that are wanted, BLOCK_ROWS rows at once;
                            // the others are known. NULL: all are wanted
    const uint8_t *sources; // the same for what can paint into those
} varying;

// Row y of the padded source, at column 0.
static uint64_t *padded_row(const varying *v, int32_t y)
{
    return v->word + (int64_t)(y + v->above) * v->pitch + v->lead;
}

// Whether all pixels that the patch can reach from a word are set, and its own among them.
static bool is_deep(const varying *v, const patch *p, int32_t y, int64_t i)
{
    int32_t last = y + p->top + p->rows - 1;
    return v->deep && v->deep[(last + v->above) * v->pitch + v->lead + i] >= p->rows;
}

static jali_status measure_depth(jali_context *ctx, int32_t rows, varying *v)
{
    const field *f = v->f;
    if (!f->own_pixel || MAX(f->left, f->right) > 64) return JALI_OK; // the shortcuts would be wrong
    jali_status status = ARENA(ctx, v->deep, (int64_t)rows * v->pitch);
    if (status != JALI_OK) return status;
    for (int64_t y = 0; y < rows; y++) {
        const uint64_t *row = v->word + y * v->pitch;
        uint16_t *deep = v->deep + y * v->pitch;
        deep[0] = deep[v->pitch - 1] = 0;
        for (int64_t i = 1; i < v->pitch - 1; i++) {
            bool all = (row[i - 1] & row[i] & row[i + 1]) == ~UINT64_C(0);
            int32_t above = y > 0 ? deep[i - v->pitch] : 0;
            deep[i] = (uint16_t)(all ? MIN(above + 1, UINT16_MAX) : 0);
        }
    }
    return JALI_OK;
}

static jali_status pad_source(jali_context *ctx, const jali_bitmap *src, uint64_t flip, uint64_t beyond,
                              varying *v)
{
    const field *f = v->f;
    int32_t reach = MAX(f->left, f->right);
    v->above = v->below = MAX(f->above, f->below);
    v->lead = reach / 64 + 2;
    v->pitch = src->stride + 2 * v->lead;
    int32_t rows = src->height_px + v->above + v->below;
    jali_status status = ARENA(ctx, v->word, (int64_t)rows * v->pitch);
    if (status != JALI_OK) return status;
    for (int64_t i = 0; i < rows * v->pitch; i++) v->word[i] = beyond ^ flip;
    for (int32_t y = 0; y < src->height_px; y++) {
        const uint64_t *from = src->word + (int64_t)y * src->stride;
        uint64_t *row = padded_row(v, y);
        for (int64_t i = 0; i < src->stride; i++) {
            int64_t width = src->width_px - 64 * i;
            uint64_t inside = width >= 64 ? ~UINT64_C(0) : width > 0 ? (UINT64_C(1) << width) - 1 : 0;
            row[i] = ((from[i] & inside) | (beyond & ~inside)) ^ flip;
        }
    }
    return measure_depth(ctx, rows, v);
}

// The pixels of a row from column x on, 128 of them.
static wide window_from(const uint64_t *row, int32_t x)
{
    const uint64_t *word = row + (x >> 6);
    wide low = word[0] | (wide)word[1] << 64;
    int32_t bit = x & 63;
    return bit ? low >> bit | (wide)word[2] << (128 - bit) : low;
}

// Bit i: the columns x + i .. x + i + n - 1 are all set.
static uint64_t runs_of(const uint64_t *row, int32_t x, int32_t n, uint64_t wanted)
{
    uint64_t found = wanted;
    while (n > 0 && found) { // 64 columns at a time
        int32_t part = MIN(n, 64);
        wide w = window_from(row, x);
        for (int32_t have = 1; have < part;) {
            int32_t more = MIN(have, part - have);
            w &= w >> more;
            have += more;
        }
        found &= (uint64_t)w;
        x += part;
        n -= part;
    }
    return found;
}

// A word's bits spread over runs, kept by length: a patch has most of its lengths twice.
typedef struct spread {
    uint64_t known; // bit n-1: run[n] is made
    wide run[65];   // [n]: bits i .. i + n - 1 for each bit i, n up to 64
} spread;

static wide spread_over(spread *s, int32_t n)
{
    if (s->known >> (n - 1) & 1) return s->run[n];
    int32_t have =
        64 - __builtin_clzll(s->known & ((UINT64_C(1) << (n - 1)) - 1)); // the longest that is shorter
    wide w = s->run[have];
    while (have < n) {
        int32_t more = MIN(have, n - have);
        w |= w << more;
        have += more;
    }
    s->known |= UINT64_C(1) << (n - 1);
    return s->run[n] = w;
}

// Set the columns x + i .. x + i + n - 1 for each bit i, in the words of row y that are wanted.
static void spread_runs(const varying *v, spread *s, int32_t x, int32_t n, int32_t y)
{
    int64_t stride = v->dst->stride;
    uint64_t *row = v->dst->word + y * stride;
    const uint8_t *active = v->active ? v->active + y / BLOCK_ROWS * stride : NULL;
    while (n > 0) {
        int32_t part = MIN(n, 64), bit = x & 63;
        int64_t at = x >> 6;
        wide w = spread_over(s, part);
        uint64_t out[3] = {(uint64_t)(w << bit), (uint64_t)(w >> (64 - bit)),
                           bit ? (uint64_t)(w >> (128 - bit)) : 0};
        for (int64_t k = 0; k < 3; k++)
            if (at + k >= 0 && at + k < stride && (!active || active[at + k])) row[at + k] |= out[k];
        x += part;
        n -= part;
    }
}

// Whether a map marks word i of row y; beyond the bitmap the nearest word counts.
static bool marks(const varying *v, const uint8_t *map, int32_t y, int64_t i)
{
    if (!map) return true;
    y = MIN(MAX(y, 0), v->dst->height_px - 1);
    i = MIN(MAX(i, 0), v->dst->stride - 1);
    return map[y / BLOCK_ROWS * v->dst->stride + i];
}

// Clear the words of the rows y0 .. y1-1 that are wanted.
static void clear_rows(const varying *v, int32_t y0, int32_t y1)
{
    for (int32_t y = y0; y < y1; y++) {
        uint64_t *row = v->dst->word + (int64_t)y * v->dst->stride;
        if (!v->active)
            memset(row, 0, (size_t)v->dst->stride * sizeof *row);
        else
            for (int64_t i = 0; i < v->dst->stride; i++)
                if (marks(v, v->active, y, i)) row[i] = 0;
    }
}

// The end of the span of tiles with one patch that begins with tile i of a row of tiles.
static int32_t span_end(const field *f, int64_t first_tile, int32_t i)
{
    const patch *p = patch_of_tile(f, first_tile + i);
    for (i++; i < f->tiles->columns && patch_of_tile(f, first_tile + i) == p;) i++;
    return i;
}

// A window's runs by length, as `spread` keeps them.
static wide runs_by_length(spread *s, int32_t n)
{
    if (s->known >> (n - 1) & 1) return s->run[n];
    int32_t have = 64 - __builtin_clzll(s->known & ((UINT64_C(1) << (n - 1)) - 1));
    wide w = s->run[have];
    while (have < n) {
        int32_t more = MIN(have, n - have);
        w &= w >> more;
        have += more;
    }
    s->known |= UINT64_C(1) << (n - 1);
    return s->run[n] = w;
}

// The columns that a patch spans, the first in *left.
static int32_t columns_of(const patch *p, int32_t *left)
{
    int32_t right = INT32_MIN;
    *left = INT32_MAX;
    for (int32_t k = 0; k < p->rows; k++) {
        *left = MIN(*left, p->span[k][0]);
        right = MAX(right, p->span[k][1]);
    }
    return right - *left + 1;
}

// Word i of the rows y0 .. y1-1, at most 64 of them, source row by source row: fits[y - y0] loses the pixels
// whose patch does not fit. Rows of `fits` that are 0 are decided. The patch spans at most 64 columns from
// `left` on.
static void erode_block(const varying *v, const patch *p, int32_t left, int32_t i, int32_t y0, int32_t y1,
                        uint64_t *fits)
{
    for (int32_t source = y0 + p->top; source < y1 - 1 + p->top + p->rows; source++) {
        spread runs;
        runs.known = 0;
        int32_t first = MAX(0, source - p->top - (y1 - 1)), end = MIN(p->rows, source - p->top - y0 + 1);
        for (int32_t k = first; k < end; k++) {
            uint64_t *row = &fits[source - p->top - k - y0];
            if (!*row) continue;
            if (!runs.known) {
                runs.known = 1;
                runs.run[1] = window_from(padded_row(v, source), 64 * i + left);
            }
            *row &= (uint64_t)(runs_by_length(&runs, p->span[k][1] - p->span[k][0] + 1) >>
                               (p->span[k][0] - left));
        }
    }
}

// The rows y0 .. y1-1 (one row of tiles) of the columns x0 .. x1-1.
static void erode_span(const varying *v, const patch *p, int32_t x0, int32_t x1, int32_t y0, int32_t y1)
{
    int32_t left, columns = columns_of(p, &left);
    for (int32_t i = x0 >> 6; i <= (x1 - 1) >> 6; i++) {
        uint64_t fits[MOST_TILE_ROWS], any = 0, *out = v->dst->word + (int64_t)y0 * v->dst->stride + i;
        for (int32_t y = y0; y < y1; y++) {
            uint64_t *row = &fits[y - y0], here = columns_of_word(i, x0, x1);
            if (v->f->own_pixel) here &= padded_row(v, y)[i];
            if (!marks(v, v->active, y, i)) here = 0;
            bool decided = !here || is_deep(v, p, y, i);
            if (decided) out[(y - y0) * v->dst->stride] |= here;
            *row = decided ? 0 : here;
            for (int32_t k = 0; k < p->rows && *row && columns > 64; k++) // wide patches: one by one
                *row = runs_of(padded_row(v, y + p->top + k), 64 * i + p->span[k][0],
                               p->span[k][1] - p->span[k][0] + 1, *row);
            any |= *row;
        }
        if (any && columns <= 64) erode_block(v, p, left, i, y0, y1, fits);
        for (int32_t y = y0; y < y1 && any; y++) out[(y - y0) * v->dst->stride] |= fits[y - y0];
    }
}

static void erode_tiles(void *shared, int32_t j)
{
    const varying *v = shared;
    const tiling *t = v->f->tiles;
    int32_t y0 = j * t->tile_px, y1 = MIN(y0 + t->tile_px, t->height_px);
    clear_rows(v, y0, y1);
    for (int32_t i = 0, end; i < t->columns; i = end) {
        end = span_end(v->f, (int64_t)j * t->columns, i);
        const patch *p = patch_of_tile(v->f, (int64_t)j * t->columns + i);
        erode_span(v, p, i * t->tile_px, MIN(end * t->tile_px, t->width_px), y0, y1);
    }
}

// What the set pixels of a row of the source paint into the rows y0 .. y1-1.
static void dilate_row(const varying *v, int32_t source, int32_t y0, int32_t y1)
{
    const tiling *t = v->f->tiles;
    const uint64_t *row = padded_row(v, source);
    int32_t beyond = 64 * (int32_t)v->lead - 64; // outermost tiles go on beyond the bitmap
    int64_t first_tile = (int64_t)MIN(MAX(source, 0) / t->tile_px, t->rows - 1) * t->columns;
    for (int32_t i = 0, end; i < t->columns; i = end) {
        end = span_end(v->f, first_tile, i);
        const patch *p = patch_of_tile(v->f, first_tile + i);
        int32_t x0 = i ? i * t->tile_px : -beyond;
        int32_t x1 = end < t->columns ? end * t->tile_px : t->width_px + beyond;
        for (int32_t w = x0 >> 6; w <= (x1 - 1) >> 6; w++) {
            uint64_t bits = row[w] & columns_of_word(w, x0, x1);
            if (!bits || !marks(v, v->sources, source, w)) continue;
            if (w >= 0 && w < v->dst->stride && is_deep(v, p, source, w)) { // it paints what is set anyway
                if (source >= y0 && source < y1 && marks(v, v->active, source, w))
                    v->dst->word[(int64_t)source * v->dst->stride + w] |= bits;
                continue;
            }
            spread runs;
            runs.known = 1;
            runs.run[1] = bits;
            for (int32_t k = MAX(0, y0 - source - p->top); k < MIN(p->rows, y1 - source - p->top); k++)
                spread_runs(v, &runs, 64 * w + p->span[k][0], p->span[k][1] - p->span[k][0] + 1,
                            source + p->top + k);
        }
    }
}

static void dilate_strip(void *shared, int32_t strip)
{
    const varying *v = shared;
    jali_bitmap *dst = v->dst;
    int32_t y0 = strip * STRIP_ROWS, y1 = MIN(y0 + STRIP_ROWS, dst->height_px);
    clear_rows(v, y0, y1);
    int32_t first = MAX(y0 - v->f->below, -v->above), last = MIN(y1 + v->f->above, dst->height_px + v->below);
    for (int32_t source = first; source < last; source++) dilate_row(v, source, y0, y1);
    int64_t whole = dst->width_px / 64;
    uint64_t inside = (UINT64_C(1) << dst->width_px % 64) - 1;
    for (int32_t y = y0; y < y1; y++) {
        uint64_t *out = dst->word + (int64_t)y * dst->stride;
        for (int64_t i = 0; i < dst->stride; i++)
            if (marks(v, v->active, y, i))
                out[i] = (out[i] ^ v->flip) & (i < whole ? ~UINT64_C(0) : i == whole ? inside : 0);
    }
}

// --- With a memory, only what changed

// Mark all words within the patches' reach of a marked one.
static void widen_marks(const field *f, const jali_bitmap *a, const uint8_t *from, uint8_t *to)
{
    int64_t blocks = (a->height_px + BLOCK_ROWS - 1) / BLOCK_ROWS,
            wide_by = (MAX(f->left, f->right) + 63) / 64;
    int64_t high_by = (MAX(f->above, f->below) + BLOCK_ROWS - 1) / BLOCK_ROWS;
    memset(to, 0, (size_t)(blocks * a->stride));
    for (int64_t b = 0; b < blocks; b++)
        for (int64_t i = 0; i < a->stride; i++) {
            if (!from[b * a->stride + i]) continue;
            int64_t first = MAX(i - wide_by, 0), count = MIN(i + wide_by, a->stride - 1) - first + 1;
            for (int64_t k = MAX(b - high_by, 0); k <= MIN(b + high_by, blocks - 1); k++)
                memset(to + k * a->stride + first, 1, (size_t)count);
        }
}

// What of the result must be made anew, given the last one; then dst begins as that.
static jali_status find_active(jali_context *ctx, const field *f, const jali_bitmap *src, const known *k,
                               varying *v)
{
    jali_status status;
    uint8_t *changed, *active, *sources;
    size_t size = (size_t)((src->height_px + BLOCK_ROWS - 1) / BLOCK_ROWS * src->stride);
    TRY(ARENA(ctx, changed, size + 1));
    TRY(ARENA(ctx, active, size + 1));
    TRY(ARENA(ctx, sources, size + 1));
    memset(changed, 0, size);
    for (int32_t y = 0; y < src->height_px; y++)
        for (int64_t i = 0; i < src->stride; i++)
            changed[y / BLOCK_ROWS * src->stride + i] |=
                src->word[y * src->stride + i] != k->src.word[y * src->stride + i];
    widen_marks(f, src, changed, active);
    widen_marks(f, src, active, sources);
    v->active = active;
    v->sources = sources;
done:
    return status;
}

// Run an operation; with a memory, only where its source has changed.
static jali_status run_varying(jali_context *ctx, const jali_bitmap *src, uint64_t flip, bool outside,
                               known *k, int32_t parts, void (*work)(void *, int32_t), varying *v)
{
    jali_status status;
    jali_bitmap now = {0};
    uint64_t beyond = outside ? ~UINT64_C(0) : 0;
    TRY(pad_source(ctx, src, flip, beyond, v));
    if (k) {
        TRY(jali_bitmap_copy(ctx, src, &now)); // dst may be src
        if (is_known(k, src, outside)) {
            TRY(find_active(ctx, v->f, src, k, v));
            copy_pixels(ctx, &k->dst, v->dst);
        }
    }
    parallel(ctx, parts, work, v);
    if (k) {
        forget(ctx, k);
        k->outside = outside;
        k->src = now;
        now = (jali_bitmap){0};
        TRY(jali_bitmap_copy(ctx, v->dst, &k->dst));
    }
done:
    jali_bitmap_free(ctx, &now);
    return status;
}

// Erode src, or its complement when `flip` is set, into dst.
static jali_status erode_varying(jali_context *ctx, const jali_bitmap *src, const field *f, bool flip,
                                 bool outside, jali_bitmap *dst)
{
    arena_mark mark = arena_here(ctx);
    varying v = {.f = f, .dst = dst};
    if (!src->word) return JALI_OK;
    jali_status status =
        run_varying(ctx, src, flip ? ~UINT64_C(0) : 0, outside, recall(f, flip ? MORPH_WIDEN : MORPH_ERODE),
                    f->tiles->rows, erode_tiles, &v);
    arena_rewind(ctx, mark);
    return status;
}

// Dilate src into dst; with `flip` the complement of that.
static jali_status dilate_varying(jali_context *ctx, const jali_bitmap *src, const field *f, bool flip,
                                  bool outside, jali_bitmap *dst)
{
    arena_mark mark = arena_here(ctx);
    varying v = {.f = f, .dst = dst, .flip = flip ? ~UINT64_C(0) : 0};
    if (!src->word) return JALI_OK;
    jali_status status = run_varying(ctx, src, 0, outside, recall(f, flip ? MORPH_NARROW : MORPH_DILATE),
                                     (dst->height_px + STRIP_ROWS - 1) / STRIP_ROWS, dilate_strip, &v);
    arena_rewind(ctx, mark);
    return status;
}

jali_status field_erode(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                        jali_bitmap *dst)
{
    if (!f->which) return morph_flat(ctx, MORPH_ERODE, src, f, outside, dst);
    return erode_varying(ctx, src, f, false, outside, dst);
}

jali_status field_dilate(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                         jali_bitmap *dst)
{
    if (!f->which) return morph_flat(ctx, MORPH_DILATE, src, f, outside, dst);
    return dilate_varying(ctx, src, f, false, outside, dst);
}

jali_status field_open(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                       jali_bitmap *scratch, jali_bitmap *dst)
{
    jali_status status = field_erode(ctx, src, f, outside, scratch);
    return status == JALI_OK ? field_dilate(ctx, scratch, f, false, dst) : status;
}

jali_status field_close(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                        jali_bitmap *scratch, jali_bitmap *dst)
{
    jali_status status = f->which ? erode_varying(ctx, src, f, true, outside, scratch)
                                  : morph_flat(ctx, MORPH_WIDEN, src, f, outside, scratch);
    if (status != JALI_OK) return status;
    return f->which ? dilate_varying(ctx, scratch, f, true, false, dst)
                    : morph_flat(ctx, MORPH_NARROW, scratch, f, true, dst);
}
