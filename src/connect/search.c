// Grow a part, 512 pixels at a time, until it meets another.
//
// Method:  the part is drawn into a window of its bounding box and a rim, then dilated by one pixel a step (a
//          cross; for the octagonal metric 5 of 12 steps are squares, which makes a nearly regular octagon)
//          and compared with the picture. A rim that is too narrow is doubled. Small parts fit into a few
//          words.
// Dead end: a breadth-first search over pixels visits the same places at 5 to 10 ns a pixel; this takes
//          0.1 to 0.3.
#include "connect/search.h"
#include "base/base.h"

#include <stdlib.h>

enum { FIRST_RIM_PX = 14 };

typedef struct window {
    int32_t x0, y0;      // upper left corner in the picture, x0 a multiple of 64
    int32_t words, rows; // without the border of one word and one row on each side
} window;

static window window_around(const jali_bitmap *solid, const int32_t box[4], int32_t rim)
{
    window w;
    w.x0 = MAX(box[0] - rim, 0) / 64 * 64;
    w.y0 = MAX(box[1] - rim, 0);
    w.words = (MIN(box[2] + rim, solid->width_px) - w.x0 + 63) / 64;
    w.rows = MIN(box[3] + rim, solid->height_px) - w.y0;
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
    for (int32_t y = 0; y < w->rows; y++)
        memcpy(row_of(w, words, y), solid->word + (int64_t)(w->y0 + y) * solid->stride + w->x0 / 64,
               (size_t)w->words * sizeof *words);
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

static bool grow(const window *w, const uint64_t *picture, const uint64_t *before, uint64_t *after,
                 bool square)
{
    int64_t pitch = w->words + 2, first = pitch + 1, n = w->rows * pitch - 2;
    bool met = grow_all(before + first, picture + first, after + first, pitch, n, square);
    for (int32_t y = 0; y < w->rows; y++) row_of(w, after, y)[-1] = row_of(w, after, y)[w->words] = 0;
    return met;
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

static bool is_square_step(jali_metric metric, int32_t k)
{
    return metric == JALI_METRIC_OCTAGON && (k + 1) * 5 / 12 > k * 5 / 12;
}

static jali_status make_room(jali_context *ctx, search *s, const window *w)
{
    jali_status status;
    TRY(GROW(ctx, s->picture, s->picture_capacity, word_count(w)));
    TRY(GROW(ctx, s->grown, s->grown_capacity, word_count(w)));
    TRY(GROW(ctx, s->next, s->next_capacity, word_count(w)));
done:
    return status;
}

jali_status nearest_other(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                          jali_metric metric, search *s, jali_bridge *bridge)
{
    jali_status status;
    int32_t longest = solid->width_px + solid->height_px;
    for (int32_t rim = FIRST_RIM_PX;; rim *= 4) {
        window w = window_around(solid, p->box[root], rim);
        TRY(make_room(ctx, s, &w));
        draw_part(p, root, &w, s->grown);
        draw_picture(solid, &w, s->picture);
        memset(s->next, 0, (size_t)word_count(&w) * sizeof *s->next);
        for (int32_t k = 0; k < MIN(rim, longest); k++) {
            if (stopping(ctx)) TRY(step(ctx, "connect", 0));
            if (grow(&w, s->picture, s->grown, s->next, is_square_step(metric, k))) {
                first_met_pixel(&w, s->picture, s->grown, s->next, bridge->to);
                draw_part(p, root, &w, s->grown);
                nearest_own(&w, s->grown, metric, k + 1, bridge->to, bridge->from);
                return JALI_OK;
            }
            uint64_t *swap = s->grown;
            size_t capacity = s->grown_capacity;
            s->grown = s->next, s->grown_capacity = s->next_capacity;
            s->next = swap, s->next_capacity = capacity;
        }
    }
done:
    return status;
}

void search_free(jali_context *ctx, search *s)
{
    release(ctx, s->picture);
    release(ctx, s->grown);
    release(ctx, s->next);
    *s = (search){0};
}
