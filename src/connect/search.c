// Grow a part, 512 pixels at a time, until it meets another.
//
// Method:  the part is drawn into a window of its bounding box and a rim, then dilated by one pixel a step (a
//          cross; for the octagonal metric 5 of 12 steps are squares, which makes a nearly regular octagon)
//          and compared with the picture. A rim that is too narrow is made four times as wide. After 8 steps
//          many are taken at once: a ball of radius a and its copies b <= a apart make the ball of radius
//          a + b. Where that meets a part the jump is halved, so a distance d costs log d passes and the
//          answer is exact all the same.
// Dead end: a breadth-first search over pixels visits the same places at 5 to 10 ns a pixel; this takes
//          0.1 to 0.3.
#include "connect/search.h"
#include "base/base.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { FIRST_RIM_PX = 14, RIM_TIMES = 4, MOST_NEAR_RIM_PX = 224 };
enum { FIRST_JUMP_PX = 8, MOST_JUMP_PX = 63, MOST_NEAR_WORDS = 1 << 15 };
enum { BAND_WORDS = 1 << 14 }; // of a window, for one thread at a time

typedef struct window {
    int32_t x0, y0;      // upper left corner in the picture, x0 a multiple of 64
    int32_t words, rows; // without the border of one word and one row on each side
} window;

// Cut off MOST_JUMP_PX beyond the picture: a jump can overshoot the part by that much and come back.
static window window_around(const jali_bitmap *solid, const int32_t box[4], int32_t rim)
{
    window w;
    w.x0 = (MAX(box[0] - rim, -MOST_JUMP_PX) & ~63);
    w.y0 = MAX(box[1] - rim, -MOST_JUMP_PX);
    w.words = (MIN(box[2] + rim, solid->width_px + MOST_JUMP_PX) - w.x0 + 63) / 64;
    w.rows = MIN(box[3] + rim, solid->height_px + MOST_JUMP_PX) - w.y0;
    return w;
}

static uint64_t *row_of(const window *w, uint64_t *words, int32_t y)
{
    return words + (int64_t)(y + 1) * (w->words + 2) + 1;
}

static void draw_part(const parts *p, int32_t root, const window *w, uint64_t *words)
{
    memset(words, 0, (size_t)(w->words + 2) * (size_t)(w->rows + 2) * sizeof *words);
    jali_bitmap view = {0, 0, w->words + 2, words};
    for (int32_t i = p->head[root]; i >= 0; i = p->run[i].next)
        paint_run(&view, p->run[i].y - w->y0 + 1, p->run[i].x0 - w->x0 + 64, p->run[i].x1 - w->x0 + 64, true);
}

static int64_t word_count(const window *w)
{
    return (int64_t)(w->words + 2) * (w->rows + 2);
}

// The picture's pixels of the window; nothing in the border.
static void draw_picture(const jali_bitmap *solid, const window *w, uint64_t *words)
{
    memset(words, 0, (size_t)word_count(w) * sizeof *words);
    int64_t first = w->x0 / 64, skip = MAX(-first, 0), count = MIN(w->words, solid->stride - first) - skip;
    for (int32_t y = MAX(-w->y0, 0); y < MIN(w->rows, solid->height_px - w->y0); y++)
        memcpy(row_of(w, words, y) + skip, solid->word + (int64_t)(w->y0 + y) * solid->stride + first + skip,
               (size_t)count * sizeof *words);
}

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

// The first pixel in raster order that a step met.
static void first_met_pixel(const window *w, uint64_t *picture, uint64_t *before, uint64_t *after,
                            int32_t pixel[2])
{
    for (int32_t y = 0; y < w->rows; y++)
        for (int32_t i = 0; i < w->words; i++) {
            uint64_t met = row_of(w, after, y)[i] & ~row_of(w, before, y)[i] & row_of(w, picture, y)[i];
            if (!met) continue;
            pixel[0] = w->x0 + i * 64 + __builtin_ctzll(met);
            pixel[1] = w->y0 + y;
            return;
        }
}

static int64_t distance_of(jali_metric metric, int64_t dx, int64_t dy)
{
    return metric == JALI_METRIC_CITY_BLOCK ? llabs(dx) + llabs(dy) : dx * dx + dy * dy;
}

// The part's pixel nearest to `to`, at most `reach` rows and columns away; the first in raster order.
static void nearest_own(const window *w, uint64_t *own, jali_metric metric, int32_t reach,
                        const int32_t to[2], int32_t from[2])
{
    int64_t best = INT64_MAX;
    int32_t y_end = MIN(to[1] + reach, w->y0 + w->rows - 1),
            x_end = MIN(to[0] + reach, w->x0 + 64 * w->words - 1);
    for (int32_t y = MAX(to[1] - reach, w->y0); y <= y_end; y++) {
        const uint64_t *row = row_of(w, own, y - w->y0);
        int32_t x_first = MAX(to[0] - reach, w->x0) - w->x0;
        for (int32_t x = next_white(row, x_first, x_end - w->x0 + 1, 0); x <= x_end - w->x0;
             x = next_white(row, x + 1, x_end - w->x0 + 1, 0)) {
            int64_t distance = distance_of(metric, x + w->x0 - to[0], y - to[1]);
            if (distance >= best) continue;
            best = distance;
            from[0] = x + w->x0;
            from[1] = y;
        }
    }
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
    for (int32_t jump = MIN(most, MOST_JUMP_PX); k >= FIRST_JUMP_PX && jump > 1; jump--) {
        int32_t more_squares = square_steps(metric, k + jump) - squares;
        if (jump - more_squares <= crosses && more_squares <= 2 * squares + 1) return jump;
    }
    return 1;
}

// `jump` steps after the first k, from `grown` into `next`; returns whether they meet another part. A ball of
// crosses of radius a grows to a + px, px <= a, by the five copies of it px apart; one of squares of radius b
// to b + px, px <= 2 b + 1, along rows, then along columns.
static bool take_steps(jali_context *ctx, const window *w, search *s, jali_metric metric, int32_t k,
                       int32_t jump)
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

static void swap_grown(search *s)
{
    uint64_t *swap = s->grown;
    size_t capacity = s->grown_capacity;
    s->grown = s->next, s->grown_capacity = s->next_capacity;
    s->next = swap, s->next_capacity = capacity;
}

// The rim is too narrow: what has grown so far goes into a wider window. Both are cut off alike at the
// picture, so it is what would have grown there.
static jali_status widen(jali_context *ctx, const window *narrow, const window *wide, search *s)
{
    size_t count = (size_t)word_count(wide);
    jali_status status = GROW(ctx, s->next, s->next_capacity, count);
    if (status != JALI_OK) return status;
    memset(s->next, 0, count * sizeof *s->next);
    int64_t left = (narrow->x0 - wide->x0) / 64;
    for (int32_t y = 0; y < narrow->rows; y++)
        memcpy(row_of(wide, s->next, y + narrow->y0 - wide->y0) + left, row_of(narrow, s->grown, y),
               (size_t)narrow->words * sizeof *s->next);
    swap_grown(s);
    return JALI_OK;
}

static jali_status reserve(jali_context *ctx, search *s, const window *w)
{
    jali_status status;
    int64_t count = word_count(w);
    TRY(GROW(ctx, s->picture, s->picture_capacity, count));
    TRY(GROW(ctx, s->grown, s->grown_capacity, count));
    TRY(GROW(ctx, s->next, s->next_capacity, count));
    TRY(GROW(ctx, s->spare, s->spare_capacity, count));
done:
    return status;
}

static jali_status make_room(jali_context *ctx, search *s, const window *w)
{
    jali_status status = reserve(ctx, s, w);
    if (status != JALI_OK) return status;
    memset(s->next, 0, (size_t)word_count(w) * sizeof *s->next);
    memset(s->spare, 0, (size_t)word_count(w) * sizeof *s->spare);
    return JALI_OK;
}

static window first_window(const jali_bitmap *solid, const parts *p, int32_t root)
{
    return window_around(solid, p->box[root], FIRST_RIM_PX);
}

// Step on until another part is met, false when the rim is used up or we are to stop.
static bool meets_within(jali_context *ctx, const window *w, int32_t limit, jali_metric metric, search *s)
{
    for (int32_t most = limit; s->steps < limit && !stopping(ctx);) {
        int32_t jump = jump_length(metric, s->steps, MIN(most, limit - s->steps));
        if (!take_steps(ctx, w, s, metric, s->steps, jump)) {
            swap_grown(s);
            s->steps += jump;
        } else if (jump > 1) {
            most = jump / 2; // a part is met within the jump: halve it
        } else {
            s->steps++;
            return true;
        }
    }
    return false;
}

// Search from window to window, the widest with a rim of most_rim at most; *found is false when that was all.
static jali_status search_within(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                                 jali_metric metric, int32_t most_rim, search *s, jali_bridge *bridge,
                                 bool *found)
{
    jali_status status;
    int32_t longest = solid->width_px + solid->height_px;
    window first = first_window(solid, p, root), w = first;
    *found = false;
    s->steps = 0;
    TRY(make_room(ctx, s, &w));
    TRY(GROW(ctx, s->own, s->own_capacity, word_count(&first)));
    draw_part(p, root, &first, s->own);
    memcpy(s->grown, s->own, (size_t)word_count(&first) * sizeof *s->grown);
    for (int32_t rim = FIRST_RIM_PX; !stopping(ctx);) {
        draw_picture(solid, &w, s->picture);
        if (meets_within(ctx, &w, MIN(rim, longest), metric, s)) {
            first_met_pixel(&w, s->picture, s->grown, s->next, bridge->to);
            nearest_own(&first, s->own, metric, s->steps, bridge->to, bridge->from);
            *found = true;
            return JALI_OK;
        }
        if (rim > most_rim / RIM_TIMES) return JALI_OK;
        window narrow = w;
        rim *= RIM_TIMES;
        w = window_around(solid, p->box[root], rim);
        TRY(widen(ctx, &narrow, &w, s));
        TRY(make_room(ctx, s, &w));
    }
done:
    return status;
}

jali_status nearest_other(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                          jali_metric metric, search *s, jali_bridge *bridge)
{
    bool found;
    jali_status status = search_within(ctx, solid, p, root, metric, INT32_MAX, s, bridge, &found);
    return status == JALI_OK && !found ? step(ctx, "connect", 0) : status;
}

jali_status make_room_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                           search *s)
{
    jali_status status;
    window first = first_window(solid, p, root), near = first;
    s->near_rim = 0;
    for (int32_t rim = FIRST_RIM_PX; rim <= MOST_NEAR_RIM_PX; rim *= RIM_TIMES) {
        window wider = window_around(solid, p->box[root], rim);
        if (word_count(&wider) > MOST_NEAR_WORDS) break;
        near = wider;
        s->near_rim = rim;
    }
    if (s->near_rim == 0) return JALI_OK;
    TRY(GROW(ctx, s->own, s->own_capacity, word_count(&first)));
    TRY(reserve(ctx, s, &near));
done:
    return status;
}

bool nearest_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                  jali_metric metric, search *s, jali_bridge *bridge)
{
    bool found;
    return search_within(ctx, solid, p, root, metric, s->near_rim, s, bridge, &found) == JALI_OK && found;
}

void search_free(jali_context *ctx, search *s)
{
    release(ctx, s->picture);
    release(ctx, s->own);
    release(ctx, s->grown);
    release(ctx, s->next);
    release(ctx, s->spare);
    *s = (search){0};
}
