// Dilations of a window, 512 pixels at a time: a step, or many at once.
//
// Method:  a ball of radius a and its copies b <= a apart make the ball of radius a + b. Large windows are
//          passed over by several threads, each with rows of its own.
#include "connect/grow.h"
#include "base/base.h"

#include <stdatomic.h>

enum { FIRST_JUMP_PX = 8, BAND_WORDS = 1 << 14 }; // of a window, for one thread at a time

// A step over the whole window as one array; returns whether it meets pixels of the picture that are not the
// part's. What leaks into the border words is wiped after it.
VECTORISED static bool grow_all(const uint64_t *before, const uint64_t *picture, uint64_t *after,
                                int64_t pitch, int64_t n, bool square)
{
    uint64_t met = 0;
    const uint64_t *above = before - pitch, *below = before + pitch;
    if (square)
        for (int64_t i = 0; i < n; i++) {
            uint64_t here = above[i] | before[i] | below[i];
            uint64_t left = above[i - 1] | before[i - 1] | below[i - 1],
                     right = above[i + 1] | before[i + 1] | below[i + 1];
            after[i] = here | here << 1 | here >> 1 | left >> 63 | right << 63;
            met |= after[i] & ~before[i] & picture[i];
        }
    else
        for (int64_t i = 0; i < n; i++) {
            uint64_t here = before[i];
            after[i] = above[i] | below[i] | here | here << 1 | here >> 1 | before[i - 1] >> 63 |
                       before[i + 1] << 63;
            met |= after[i] & ~here & picture[i];
        }
    return met != 0;
}

// out = a, a moved by `px` (1 .. 63) to both sides and, for a cross, the rows above and below.
VECTORISED static void spread_row(const uint64_t *a, const uint64_t *above, const uint64_t *below,
                                  uint64_t *out, int64_t n, int32_t px)
{
    int32_t rest = 64 - px;
    for (int64_t i = 0; i < n; i++)
        out[i] = a[i] | a[i] << px | a[i - 1] >> rest | a[i] >> px | a[i + 1] << rest | above[i] | below[i];
}

VECTORISED static void join_row(const uint64_t *a, const uint64_t *above, const uint64_t *below,
                                uint64_t *out, int64_t n)
{
    for (int64_t i = 0; i < n; i++) out[i] = a[i] | above[i] | below[i];
}

VECTORISED static bool meets(const uint64_t *before, const uint64_t *picture, const uint64_t *after,
                             int64_t n)
{
    uint64_t met = 0;
    for (int64_t i = 0; i < n; i++) met |= after[i] & ~before[i] & picture[i];
    return met != 0;
}

// Row y, or the empty border row beyond the window.
static const uint64_t *row_or_nothing(const window *w, uint64_t *words, int32_t y)
{
    return row_of(w, words, y < 0 || y >= w->rows ? -1 : y);
}

// A pass over the rows of a window: side by side where it is large, when nothing else is.
typedef struct pass {
    const window *w;
    uint64_t *from, *to; // planes
    const uint64_t *picture;
    int32_t px; // how far
    bool square;
    atomic_bool met;
    void (*rows)(struct pass *p, int32_t y0, int32_t y1);
    int32_t band_rows;
} pass;

static void pass_band(void *shared, int32_t band)
{
    pass *p = shared;
    p->rows(p, band * p->band_rows, MIN((band + 1) * p->band_rows, p->w->rows));
}

// Whether another part was met, where the pass looks for that.
static bool run_pass(jali_context *ctx, pass p, void (*rows)(pass *p, int32_t y0, int32_t y1))
{
    p.rows = rows;
    p.band_rows = MAX(BAND_WORDS / (p.w->words + 2), 1);
    parallel(ctx, (p.w->rows + p.band_rows - 1) / p.band_rows, pass_band, &p);
    return p.met;
}

static void grow_rows(pass *p, int32_t y0, int32_t y1)
{
    int64_t pitch = p->w->words + 2, first = (y0 + 1) * pitch + 1, n = (y1 - y0) * pitch - 2;
    if (grow_all(p->from + first, p->picture + first, p->to + first, pitch, n, p->square)) p->met = true;
    for (int32_t y = y0; y < y1; y++) row_of(p->w, p->to, y)[-1] = row_of(p->w, p->to, y)[p->w->words] = 0;
}

static void spread_rows(pass *p, int32_t y0, int32_t y1)
{
    const window *w = p->w;
    const uint64_t *nothing = row_of(w, p->from, -1);
    for (int32_t y = y0; y < y1; y++)
        spread_row(row_of(w, p->from, y), p->square ? nothing : row_or_nothing(w, p->from, y - p->px),
                   p->square ? nothing : row_or_nothing(w, p->from, y + p->px), row_of(w, p->to, y), w->words,
                   p->px);
}

static void join_rows(pass *p, int32_t y0, int32_t y1)
{
    const window *w = p->w;
    for (int32_t y = y0; y < y1; y++)
        join_row(row_of(w, p->from, y), row_or_nothing(w, p->from, y - p->px),
                 row_or_nothing(w, p->from, y + p->px), row_of(w, p->to, y), w->words);
}

static void meet_rows(pass *p, int32_t y0, int32_t y1)
{
    int64_t pitch = p->w->words + 2, first = (y0 + 1) * pitch;
    if (meets(p->from + first, p->picture + first, p->to + first, (y1 - y0) * pitch)) p->met = true;
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
    pass p = {.w = w, .from = s->grown, .to = s->next, .picture = s->picture, .square = squares > 0};
    if (jump == 1) return run_pass(ctx, p, grow_rows);
    uint64_t *crossed = s->grown;
    if (crosses > 0) {
        run_pass(ctx, (pass){.w = w, .from = crossed, .to = s->next, .px = crosses}, spread_rows);
        crossed = s->next;
    }
    if (squares > 0) {
        run_pass(ctx, (pass){.w = w, .from = crossed, .to = s->spare, .px = squares, .square = true},
                 spread_rows);
        run_pass(ctx, (pass){.w = w, .from = s->spare, .to = s->next, .px = squares}, join_rows);
    }
    return run_pass(ctx, p, meet_rows);
}
