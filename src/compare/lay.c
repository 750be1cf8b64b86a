// Where a print lies on the plate it should be: agreement by counting, shifts by a pattern search.
//
// The correlation of two pictures in black and white needs three counts: white in one, in the other, in
// both. Unlike the share of equal pixels it does not prefer all solid to all void.
//
// Checked: tests/test_compare.c.
#include "compare/lay.h"
#include "raster/raster.h"

#include <math.h>

enum { BAND_ROWS = 64 };

typedef struct counts {
    int64_t all, print, plate, both;
} counts;

typedef struct sampling {
    const plate_grid *plate;
    laying l;
    int64_t *column;  // [plate width] of the print, beyond it too
    uint64_t *row;    // [bands * stride] scratch, when counting
    counts *count;    // [bands]
    jali_bitmap *out; // when sampling
} sampling;

// The print's column or row under the plate's `i`; it may lie beyond the print.
static int64_t print_index(const sampling *s, int axis, int32_t i)
{
    const jali_bitmap *plate = s->plate->bitmap, *print = s->l.print;
    int32_t from = axis == 0 ? plate->width_px : plate->height_px;
    int32_t to = axis == 0 ? print->width_px : print->height_px;
    double mm = (i + 0.5 - from / 2.0) * s->plate->pixel_mm[axis] - s->l.shift_mm[axis];
    const double hair = 1e-7; // equal grids meet, whatever rounds
    return (int64_t)floor(fmin(fmax(mm / s->l.pixel_mm[axis] + to / 2.0 + hair, -1e9), 1e9));
}

// 64 pixels of a row from column x on, which may lie beyond it.
static uint64_t word_at(const jali_bitmap *a, const uint64_t *row, int64_t x)
{
    int64_t i = x >> 6;
    int32_t shift = (int32_t)(x & 63);
    uint64_t low = i >= 0 && i < a->stride ? row[i] : 0;
    uint64_t high = shift && i + 1 >= 0 && i + 1 < a->stride ? row[i + 1] : 0;
    return shift ? low >> shift | high << (64 - shift) : low;
}

static void sample_row(const sampling *s, int32_t y, uint64_t *row)
{
    const jali_bitmap *plate = s->plate->bitmap, *print = s->l.print;
    int64_t y_print = print_index(s, 1, y);
    memset(row, 0, (size_t)plate->stride * sizeof *row);
    if (y_print < 0 || y_print >= print->height_px) return;
    const uint64_t *from = print->word + y_print * print->stride;
    if (s->column[plate->width_px - 1] - s->column[0] == plate->width_px - 1) { // pixels of one size
        for (int32_t x = 0; x < plate->width_px; x += 64)
            row[x >> 6] = word_at(print, from, s->column[0] + x);
        if (plate->width_px & 63) row[plate->width_px >> 6] &= ~(~UINT64_C(0) << (plate->width_px & 63));
        return;
    }
    for (int32_t x = 0; x < plate->width_px; x++) {
        int64_t column = s->column[x];
        if (column >= 0 && column < print->width_px)
            row[x >> 6] |= (from[column >> 6] >> (column & 63) & 1) << (x & 63);
    }
}

static void count_band(void *shared, int32_t band)
{
    const sampling *s = shared;
    const jali_bitmap *plate = s->plate->bitmap;
    uint64_t *row = s->row + band * plate->stride;
    counts *c = &s->count[band];
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, plate->height_px); y++) {
        if (y % s->l.row_step != s->l.row_step / 2) continue;
        const uint64_t *wanted = plate->word + y * plate->stride;
        sample_row(s, y, row);
        c->all += plate->width_px;
        for (int64_t i = 0; i < plate->stride; i++) {
            c->print += __builtin_popcountll(row[i]);
            c->plate += __builtin_popcountll(wanted[i]);
            c->both += __builtin_popcountll(row[i] & wanted[i]);
        }
    }
}

static void sample_band(void *shared, int32_t band)
{
    const sampling *s = shared;
    for (int32_t y = band * BAND_ROWS; y < MIN((band + 1) * BAND_ROWS, s->out->height_px); y++)
        sample_row(s, y, s->out->word + y * s->out->stride);
}

static int32_t bands_of(const plate_grid *plate)
{
    return (plate->bitmap->height_px + BAND_ROWS - 1) / BAND_ROWS;
}

static void find_columns(sampling *s)
{
    for (int32_t x = 0; x < s->plate->bitmap->width_px; x++) s->column[x] = print_index(s, 0, x);
}

// Scratch memory for counting, once for any number of shifts.
static jali_status begin_counting(jali_context *ctx, sampling *s)
{
    jali_status status;
    const jali_bitmap *plate = s->plate->bitmap;
    TRY(ARENA(ctx, s->column, plate->width_px));
    TRY(ARENA(ctx, s->row, bands_of(s->plate) * plate->stride));
    TRY(ARENA(ctx, s->count, bands_of(s->plate)));
done:
    return status;
}

static double count_agreement(jali_context *ctx, sampling *s)
{
    int32_t bands = bands_of(s->plate);
    counts c = {0};
    find_columns(s);
    memset(s->count, 0, (size_t)bands * sizeof *s->count);
    parallel(ctx, bands, count_band, s);
    for (int32_t i = 0; i < bands; i++) {
        c.all += s->count[i].all;
        c.print += s->count[i].print;
        c.plate += s->count[i].plate;
        c.both += s->count[i].both;
    }
    double n = (double)c.all, a = (double)c.print, b = (double)c.plate;
    double spread = sqrt(a * (n - a)) * sqrt(b * (n - b));
    return spread > 0 ? ((double)c.both * n - a * b) / spread : 0;
}

jali_status agreement_of(jali_context *ctx, const plate_grid *plate, const laying *l, double *agreement)
{
    arena_mark mark = arena_here(ctx);
    sampling s = {.plate = plate, .l = *l};
    jali_status status = begin_counting(ctx, &s);
    *agreement = status == JALI_OK ? count_agreement(ctx, &s) : 0;
    arena_rewind(ctx, mark);
    return status;
}

jali_status sample_print(jali_context *ctx, const plate_grid *plate, const laying *l, jali_bitmap *sampled)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    sampling s = {.plate = plate, .l = *l, .out = sampled};
    TRY(jali_bitmap_create(ctx, plate->bitmap->width_px, plate->bitmap->height_px, sampled));
    TRY(ARENA(ctx, s.column, plate->bitmap->width_px));
    find_columns(&s);
    parallel(ctx, bands_of(plate), sample_band, &s);
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, sampled);
    arena_rewind(ctx, mark);
    return status;
}

// The best of the eight neighbours at a distance, when one of them is better.
static bool shift_once(jali_context *ctx, sampling *s, double step_mm, laying *l, double *agreement)
{
    static const int way[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    laying best = *l;
    bool better = false;
    for (int i = 0; i < 8; i++) {
        laying moved = *l;
        for (int k = 0; k < 2; k++) moved.shift_mm[k] += way[i][k] * step_mm;
        s->l = moved;
        double agreed = count_agreement(ctx, s);
        if (agreed <= *agreement) continue;
        *agreement = agreed;
        best = moved;
        better = true;
    }
    *l = best;
    return better;
}

jali_status shift_print(jali_context *ctx, const plate_grid *plate, double step_mm, double least_mm,
                        laying *l, double *agreement)
{
    enum { MOST_STEPS = 64 }; // of one length
    jali_status status;
    arena_mark mark = arena_here(ctx);
    sampling s = {.plate = plate, .l = *l};
    TRY(begin_counting(ctx, &s));
    *agreement = count_agreement(ctx, &s);
    for (; step_mm >= 0.99 * least_mm; step_mm /= 2)
        for (int32_t steps = 0; steps < MOST_STEPS && shift_once(ctx, &s, step_mm, l, agreement); steps++)
            TRY(step(ctx, "compare", 0));
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status turn_bitmap(jali_context *ctx, const jali_bitmap *src, int32_t quarter_turns, bool mirrored,
                        jali_bitmap *dst)
{
    bool upright = quarter_turns % 2 == 0;
    int32_t width = src->width_px, height = src->height_px;
    jali_status status = jali_bitmap_create(ctx, upright ? width : height, upright ? height : width, dst);
    if (status != JALI_OK) return status;
    for (int32_t y = 0; y < height; y++) {
        const uint64_t *row = src->word + (int64_t)y * src->stride;
        for (int32_t x = next_white(row, 0, width, 0); x < width; x = next_white(row, x + 1, width, 0)) {
            int32_t u = mirrored ? width - 1 - x : x;
            switch (quarter_turns) {
            case 0: jali_bitmap_set(dst, u, y, true); break;
            case 1: jali_bitmap_set(dst, height - 1 - y, u, true); break;
            case 2: jali_bitmap_set(dst, width - 1 - u, height - 1 - y, true); break;
            default: jali_bitmap_set(dst, y, width - 1 - u, true); break;
            }
        }
    }
    return JALI_OK;
}
