// A part grows in a window, 512 pixels at a time, until it meets another.
//
// Method:  a step dilates by one pixel (a cross; for the octagonal metric 5 of 12 steps are squares, which
//          makes a nearly regular octagon) and compares with the picture. After 8 steps many are taken at
//          once: a ball of radius a and its copies b <= a apart make the ball of radius a + b. Where that
//          meets a part the jump is halved, about what it has met alone, so a distance d costs log d passes
//          and the answer is exact.
// Cost:    about 0.5 ns a word and pass.
// Dead end: a breadth-first search over pixels visits the same places at 5 to 10 ns a pixel; this takes
//          0.1 to 0.3.
#include "connect/grow.h"
#include "base/base.h"

enum { FIRST_JUMP_PX = 8 };

jali_status make_planes(jali_context *ctx, const window *w, growing *g)
{
    jali_status status;
    TRY(make_plane(ctx, w, &g->picture));
    TRY(make_plane(ctx, w, &g->grown));
    TRY(make_plane(ctx, w, &g->next));
    TRY(make_plane(ctx, w, &g->spare));
done:
    return status;
}

jali_status make_room(jali_context *ctx, const window *w, growing *g)
{
    jali_status status = make_planes(ctx, w, g);
    if (status != JALI_OK) return status;
    clear_border(w, &g->next);
    clear_border(w, &g->spare);
    return JALI_OK;
}

void growing_free(jali_context *ctx, growing *g)
{
    plane_free(ctx, &g->picture);
    plane_free(ctx, &g->grown);
    plane_free(ctx, &g->next);
    plane_free(ctx, &g->spare);
}

static void swap_planes(plane *a, plane *b)
{
    plane swap = *a;
    *a = *b;
    *b = swap;
}

// What a pass makes of the words i of `a`; what leaks into the words beside the rows is wiped after it. Those
// that look return whether `out` has pixels of the picture that `before` has not.

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

// The five copies of a ball of crosses, px (1 .. 63) apart; px rows are `away` words.
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

// The three copies of a ball of squares along its row ...
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

// From the first word of the first row to the last one of the last.
static int64_t pass_length(const window *w)
{
    return w->rows * pitch_of(w) - 2;
}

static void wipe_beside_rows(const window *w, const plane *p)
{
    uint64_t *row = row_of(w, p, 0);
    for (int32_t y = 0; y < w->rows; y++, row += pitch_of(w)) row[-1] = row[w->words] = 0;
}

// One step, from `grown` into `next`.
static bool take_step(const window *w, bool square, growing *g)
{
    bool met = grow_words(row_of(w, &g->grown, 0), pitch_of(w), square, row_of(w, &g->picture, 0),
                          row_of(w, &g->next, 0), pass_length(w));
    wipe_beside_rows(w, &g->next);
    return met;
}

// Many steps: a ball of crosses of radius a grows to a + px, px <= a, by the five copies of it px apart; one
// of squares of radius b to b + px, px <= 2 b + 1, along rows, then along columns.
static bool jump(const window *w, int32_t crosses, int32_t squares, growing *g)
{
    const uint64_t *before = row_of(w, &g->grown, 0), *picture = row_of(w, &g->picture, 0), *from = before;
    uint64_t *next = row_of(w, &g->next, 0), *spare = row_of(w, &g->spare, 0);
    int64_t pitch = pitch_of(w), n = pass_length(w);
    if (crosses > 0) {
        bool met = cross_words(from, crosses * pitch, crosses, before, picture, next, n);
        wipe_beside_rows(w, &g->next);
        if (squares == 0) return met;
        from = next;
    }
    spread_words(from, squares, spare, n);
    wipe_beside_rows(w, &g->spare);
    return stack_words(spare, squares * pitch, before, picture, next, n);
}

// Square steps among the first k; the others are crosses.
static int32_t square_steps(jali_metric metric, int32_t k)
{
    return metric == JALI_METRIC_OCTAGON ? k * 5 / 12 : 0;
}

// How many steps can be taken at once after k: dilations commute, so the crosses come first, then the
// squares.
static int32_t jump_length(jali_metric metric, int32_t k, int32_t most)
{
    int32_t squares = square_steps(metric, k), crosses = k - squares;
    for (int32_t jump = most; k >= FIRST_JUMP_PX && jump > 1; jump--) {
        int32_t more_squares = square_steps(metric, k + jump) - squares;
        if (jump - more_squares <= crosses && more_squares <= 2 * squares + 1) return jump;
    }
    return 1;
}

static bool take_steps(const window *w, jali_metric metric, int32_t steps, growing *g)
{
    int32_t squares = square_steps(metric, g->steps + steps) - square_steps(metric, g->steps);
    return steps == 1 ? take_step(w, squares > 0, g) : jump(w, steps - squares, squares, g);
}

static uint64_t met_word(const window *w, const growing *g, int32_t y, int32_t i)
{
    return row_of(w, &g->next, y)[i] & ~row_of(w, &g->grown, y)[i] & row_of(w, &g->picture, y)[i];
}

// Move the window's pixels of a wider one to the front; the border beside them is black.
static void move_rows(const window *wide, const window *w, plane *p)
{
    int64_t left = (w->x0 - wide->x0) / 64;
    for (int32_t y = 0; y < w->rows; y++) {
        uint64_t *row = row_of(w, p, y);
        memmove(row, row_of(wide, p, y + w->y0 - wide->y0) + left, (size_t)w->words * sizeof *row);
        row[-1] = row[w->words] = 0;
    }
}

// The last `steps` steps have met something: go on only there, before them. What is nearest is among what was
// met, and jumps that end with them look at most so many pixels away.
static void crop_to_met(window *w, int32_t steps, growing *g)
{
    int32_t x0 = w->words, x1 = 0, y0 = w->rows, y1 = 0;
    for (int32_t y = 0; y < w->rows; y++)
        for (int32_t i = 0; i < w->words; i++)
            if (met_word(w, g, y, i)) {
                x0 = MIN(x0, i);
                x1 = MAX(x1, i + 1);
                y0 = MIN(y0, y);
                y1 = y + 1;
            }
    x0 = MAX(x0 - 1, 0), x1 = MIN(x1 + 1, w->words); // steps <= MOST_JUMP_PX, less than a word
    y0 = MAX(y0 - steps, 0), y1 = MIN(y1 + steps, w->rows);
    window wide = *w;
    *w = (window){wide.x0 + 64 * x0, wide.y0 + y0, x1 - x0, y1 - y0, MIN(wide.border, steps)};
    move_rows(&wide, w, &g->grown);
    move_rows(&wide, w, &g->picture);
    clear_border(w, &g->grown);
    clear_border(w, &g->next);
    clear_border(w, &g->spare);
}

// On a copy: what others grow side by side may be in the same cache line.
bool grow_until_met(jali_context *ctx, window *w, int32_t limit, const atomic_int *least, jali_metric metric,
                    growing *given)
{
    growing g = *given;
    bool met = false;
    for (int32_t most = w->border; !stopping(ctx);) {
        if (least) limit = MIN(limit, atomic_load_explicit(least, memory_order_relaxed));
        if (g.steps >= limit) break;
        int32_t steps = jump_length(metric, g.steps, MIN(most, limit - g.steps));
        bool meets = take_steps(w, metric, steps, &g);
        if (meets && steps > 1) {
            crop_to_met(w, steps, &g);
            limit = g.steps + steps;
            most = steps / 2;
            continue;
        }
        g.steps += steps;
        if ((met = meets)) break;
        swap_planes(&g.grown, &g.next);
    }
    *given = g;
    return met;
}

void first_met_pixel(const window *w, const growing *g, int32_t pixel[2])
{
    for (int32_t y = 0; y < w->rows; y++)
        for (int32_t i = 0; i < w->words; i++) {
            uint64_t met = met_word(w, g, y, i);
            if (!met) continue;
            pixel[0] = w->x0 + i * 64 + __builtin_ctzll(met);
            pixel[1] = w->y0 + y;
            return;
        }
}

// Both windows are cut off alike at the picture, so it is what would have grown in the wider one.
jali_status widen(jali_context *ctx, const window *narrow, const window *wide, growing *g)
{
    jali_status status = make_plane(ctx, wide, &g->next);
    if (status != JALI_OK) return status;
    clear_plane(wide, &g->next);
    int64_t left = (narrow->x0 - wide->x0) / 64;
    for (int32_t y = 0; y < narrow->rows; y++)
        memcpy(row_of(wide, &g->next, y + narrow->y0 - wide->y0) + left, row_of(narrow, &g->grown, y),
               (size_t)narrow->words * sizeof(uint64_t));
    swap_planes(&g->grown, &g->next);
    return JALI_OK;
}
