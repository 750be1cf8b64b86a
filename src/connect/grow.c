// Dilations of a window, 512 pixels at a time: a step, or many at once.
//
// Method:  a ball of radius a and its copies b <= a apart make the ball of radius a + b. Large windows are
//          passed over by several threads, each with rows of its own.
#include "connect/grow.h"
#include "base/base.h"

#include <stdatomic.h>

enum { FIRST_JUMP_PX = 8, BAND_WORDS = 1 << 14 }; // of a window, for one thread at a time

// What a pass makes of the words i of `a`, the picture's beside them; what leaks into the border is wiped
// after it. Those that look return whether `out` has pixels of the picture that `before` has not.

// A step; `a` is what was before.
VECTORISED static bool grow_words(const uint64_t *a, int64_t pitch, bool square, const uint64_t *picture,
                                  uint64_t *out, int64_t n)
{
    uint64_t met = 0;
    const uint64_t *above = a - pitch, *below = a + pitch;
    if (square)
        for (int64_t i = 0; i < n; i++) {
            uint64_t here = above[i] | a[i] | below[i];
            uint64_t left = above[i - 1] | a[i - 1] | below[i - 1],
                     right = above[i + 1] | a[i + 1] | below[i + 1];
            out[i] = here | here << 1 | here >> 1 | left >> 63 | right << 63;
            met |= out[i] & ~a[i] & picture[i];
        }
    else
        for (int64_t i = 0; i < n; i++) {
            uint64_t here = a[i];
            out[i] = above[i] | below[i] | here | here << 1 | here >> 1 | a[i - 1] >> 63 | a[i + 1] << 63;
            met |= out[i] & ~here & picture[i];
        }
    return met != 0;
}

// The five copies of a cross's ball, px (1 .. 63) apart; `away` words are px rows.
VECTORISED static bool cross_words(const uint64_t *a, int64_t away, int32_t px, const uint64_t *before,
                                   const uint64_t *picture, uint64_t *out, int64_t n)
{
    uint64_t met = 0;
    int32_t rest = 64 - px;
    const uint64_t *above = a - away, *below = a + away;
    for (int64_t i = 0; i < n; i++) {
        uint64_t here = a[i];
        out[i] = here | here << px | here >> px | a[i - 1] >> rest | a[i + 1] << rest | above[i] | below[i];
        met |= out[i] & ~before[i] & picture[i];
    }
    return met != 0;
}

// The three copies of a square's ball along its row ...
VECTORISED static void spread_words(const uint64_t *a, int32_t px, uint64_t *out, int64_t n)
{
    int32_t rest = 64 - px;
    for (int64_t i = 0; i < n; i++)
        out[i] = a[i] | a[i] << px | a[i] >> px | a[i - 1] >> rest | a[i + 1] << rest;
}

// ... and along its column.
VECTORISED static bool stack_words(const uint64_t *a, int64_t away, const uint64_t *before,
                                   const uint64_t *picture, uint64_t *out, int64_t n)
{
    uint64_t met = 0;
    const uint64_t *above = a - away, *below = a + away;
    for (int64_t i = 0; i < n; i++) {
        out[i] = a[i] | above[i] | below[i];
        met |= out[i] & ~before[i] & picture[i];
    }
    return met != 0;
}

typedef enum pass_kind { GROW_CROSS, GROW_SQUARE, JUMP_CROSS, SPREAD_SQUARE, STACK_SQUARE } pass_kind;

// A pass over the rows of a window: side by side where it is large, when nothing else is.
typedef struct pass {
    const window *w;
    pass_kind kind;
    int32_t px; // how far
    const uint64_t *from, *before, *picture;
    uint64_t *to;
    int32_t band_rows;
    atomic_bool met;
} pass;

static bool pass_words(const pass *p, int64_t first, int64_t n)
{
    int64_t pitch = p->w->words + 2, away = p->px * pitch;
    const uint64_t *from = p->from + first, *before = p->before + first, *picture = p->picture + first;
    uint64_t *to = p->to + first;
    switch (p->kind) {
    case GROW_CROSS:
    case GROW_SQUARE: return grow_words(from, pitch, p->kind == GROW_SQUARE, picture, to, n);
    case JUMP_CROSS: return cross_words(from, away, p->px, before, picture, to, n);
    case SPREAD_SQUARE: spread_words(from, p->px, to, n); return false;
    case STACK_SQUARE: return stack_words(from, away, before, picture, to, n);
    }
    return false;
}

static void pass_band(void *shared, int32_t band)
{
    pass *p = shared;
    const window *w = p->w;
    int32_t y0 = band * p->band_rows, y1 = MIN(y0 + p->band_rows, w->rows);
    int64_t pitch = w->words + 2, first = (y0 + w->border) * pitch + 1;
    if (pass_words(p, first, (y1 - y0) * pitch - 2)) p->met = true;
    uint64_t *row = p->to + first;
    for (int32_t y = y0; y < y1; y++, row += pitch) row[-1] = row[w->words] = 0;
}

static bool run_pass(jali_context *ctx, pass p)
{
    p.band_rows = MAX(BAND_WORDS / (p.w->words + 2), 1);
    parallel(ctx, (p.w->rows + p.band_rows - 1) / p.band_rows, pass_band, &p);
    return p.met;
}

// Square steps among the first k; the others are crosses.
static int32_t square_steps(jali_metric metric, int32_t k)
{
    return metric == JALI_METRIC_OCTAGON ? k * 5 / 12 : 0;
}

// How many steps can be taken at once after k: dilations commute, so the crosses come first, then the
// squares.
int32_t jump_length(jali_metric metric, int32_t k, int32_t most)
{
    int32_t squares = square_steps(metric, k), crosses = k - squares;
    for (int32_t jump = MIN(most, MOST_JUMP_PX); k >= FIRST_JUMP_PX && jump > 1; jump--) {
        int32_t more_squares = square_steps(metric, k + jump) - squares;
        if (jump - more_squares <= crosses && more_squares <= 2 * squares + 1) return jump;
    }
    return 1;
}

// A ball of crosses of radius a grows to a + px, px <= a, by the five copies of it px apart; one of squares
// of radius b to b + px, px <= 2 b + 1, along rows, then along columns.
bool take_steps(jali_context *ctx, const window *w, search *s, jali_metric metric, int32_t k, int32_t jump)
{
    int32_t squares = square_steps(metric, k + jump) - square_steps(metric, k), crosses = jump - squares;
    pass p = {.w = w, .px = 1, .from = s->grown, .before = s->grown, .picture = s->picture, .to = s->next};
    if (jump == 1) {
        p.kind = squares > 0 ? GROW_SQUARE : GROW_CROSS;
        return run_pass(ctx, p);
    }
    bool met = false;
    if (crosses > 0) {
        p.kind = JUMP_CROSS, p.px = crosses;
        met = run_pass(ctx, p);
        p.from = s->next;
    }
    if (squares > 0 && !met) {
        p.kind = SPREAD_SQUARE, p.px = squares, p.to = s->spare;
        run_pass(ctx, p);
        p.kind = STACK_SQUARE, p.from = s->spare, p.to = s->next;
        met = run_pass(ctx, p);
    }
    return met;
}
