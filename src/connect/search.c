// Grow a part, 512 pixels at a time, until it meets another.
//
// Method:  the part is drawn into a window of its bounding box and a rim, then dilated by one pixel a step (a
//          cross; for the octagonal metric 5 of 12 steps are squares, which makes a nearly regular octagon)
//          and compared with the picture. A rim that is too narrow is made four times as wide. After 8 steps
//          many are taken at once (grow.c). Where that meets a part the jump is halved, so a distance d costs
//          log d passes and the answer is exact all the same.
// Dead end: a breadth-first search over pixels visits the same places at 5 to 10 ns a pixel; this takes
//          0.1 to 0.3.
#include "connect/search.h"
#include "connect/grow.h"
#include "base/base.h"

#include <stdlib.h>

enum { FIRST_RIM_PX = 14, RIM_TIMES = 4, MOST_NEAR_RIM_PX = 224 };
enum { MOST_NEAR_WORDS = 1 << 13 };

// Cut off MOST_JUMP_PX beyond the picture: a jump can overshoot the part by that much and come back. One that
// ends within the rim is no longer than half of it (grow.c).
static window window_around(const jali_bitmap *solid, const int32_t box[4], int32_t rim)
{
    window w = {.border = MIN(rim / 2 + 1, MOST_JUMP_PX)};
    w.x0 = (MAX(box[0] - rim, -MOST_JUMP_PX) & ~63);
    w.y0 = MAX(box[1] - rim, -MOST_JUMP_PX);
    w.words = (MIN(box[2] + rim, solid->width_px + MOST_JUMP_PX) - w.x0 + 63) / 64;
    w.rows = MIN(box[3] + rim, solid->height_px + MOST_JUMP_PX) - w.y0;
    return w;
}

static void draw_part(const parts *p, int32_t root, const window *w, uint64_t *words)
{
    memset(words, 0, (size_t)word_count(w) * sizeof *words);
    jali_bitmap view = {0, 0, w->words + 2, row_of(w, words, 0) - 1};
    for (int32_t i = p->head[root]; i >= 0; i = p->run[i].next)
        paint_run(&view, p->run[i].y - w->y0, p->run[i].x0 - w->x0 + 64, p->run[i].x1 - w->x0 + 64, true);
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

static void swap_grown(search *s)
{
    uint64_t *swap = s->grown;
    size_t capacity = s->grown_capacity;
    s->grown = s->next, s->grown_capacity = s->next_capacity;
    s->next = swap, s->next_capacity = capacity;
}

// Room in a plane, whose pixels are then lost where it had less.
static jali_status room_in(jali_context *ctx, uint64_t **plane, size_t *capacity, int64_t words)
{
    if ((size_t)words <= *capacity) return JALI_OK;
    release(ctx, *plane);
    *plane = NULL;
    *capacity = 0;
    size_t wanted = (size_t)words + (size_t)words / 2;
    jali_status status = ALLOCATE(ctx, *plane, wanted);
    if (status == JALI_OK) *capacity = wanted;
    return status;
}

// The rim is too narrow: what has grown so far goes into a wider window. Both are cut off alike at the
// picture, so it is what would have grown there.
static jali_status widen(jali_context *ctx, const window *narrow, const window *wide, search *s)
{
    jali_status status = room_in(ctx, &s->next, &s->next_capacity, word_count(wide));
    if (status != JALI_OK) return status;
    memset(s->next, 0, (size_t)word_count(wide) * sizeof *s->next);
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
    TRY(room_in(ctx, &s->picture, &s->picture_capacity, count));
    TRY(room_in(ctx, &s->grown, &s->grown_capacity, count));
    TRY(room_in(ctx, &s->next, &s->next_capacity, count));
    TRY(room_in(ctx, &s->spare, &s->spare_capacity, count));
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
        int32_t jump = jump_length(metric, s->steps, MIN(MIN(most, limit - s->steps), w->border));
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

// Draw the part alone into the narrowest window.
static jali_status begin(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root, search *s)
{
    jali_status status;
    window first = first_window(solid, p, root);
    s->steps = 0;
    s->rim = FIRST_RIM_PX;
    TRY(make_room(ctx, s, &first));
    TRY(room_in(ctx, &s->own, &s->own_capacity, word_count(&first)));
    draw_part(p, root, &first, s->own);
    memcpy(s->grown, s->own, (size_t)word_count(&first) * sizeof *s->grown);
done:
    return status;
}

// Go on from window to window, the widest with a rim of most_rim at most; *found is false when that was all.
static jali_status go_on(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                         jali_metric metric, int32_t most_rim, search *s, jali_bridge *bridge, bool *found)
{
    jali_status status;
    int32_t longest = solid->width_px + solid->height_px;
    window first = first_window(solid, p, root), w = window_around(solid, p->box[root], s->rim);
    *found = false;
    while (!stopping(ctx)) {
        draw_picture(solid, &w, s->picture);
        if (meets_within(ctx, &w, MIN(s->rim, longest), metric, s)) {
            first_met_pixel(&w, s->picture, s->grown, s->next, bridge->to);
            nearest_own(&first, s->own, metric, s->steps, bridge->to, bridge->from);
            *found = true;
            return JALI_OK;
        }
        if (s->rim > most_rim / RIM_TIMES) return JALI_OK;
        window narrow = w;
        w = window_around(solid, p->box[root], s->rim * RIM_TIMES);
        TRY(widen(ctx, &narrow, &w, s));
        TRY(make_room(ctx, s, &w));
        s->rim *= RIM_TIMES;
    }
done:
    return status;
}

jali_status nearest_other(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                          jali_metric metric, search *s, jali_bridge *bridge)
{
    jali_status status;
    TRY(begin(ctx, solid, p, root, s));
    TRY(nearest_further(ctx, solid, p, root, metric, s, bridge));
done:
    return status;
}

jali_status nearest_further(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                            jali_metric metric, search *s, jali_bridge *bridge)
{
    bool found;
    jali_status status = go_on(ctx, solid, p, root, metric, INT32_MAX, s, bridge, &found);
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
    TRY(room_in(ctx, &s->own, &s->own_capacity, word_count(&first)));
    TRY(reserve(ctx, s, &near));
done:
    return status;
}

bool nearest_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                  jali_metric metric, search *s, jali_bridge *bridge)
{
    bool found = false;
    return begin(ctx, solid, p, root, s) == JALI_OK &&
           go_on(ctx, solid, p, root, metric, s->near_rim, s, bridge, &found) == JALI_OK && found;
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
