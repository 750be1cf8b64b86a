// Windows of a picture and their planes.
#include "connect/window.h"
#include "base/base.h"

#include <stdlib.h>

// Cut off MOST_JUMP_PX beyond the picture: a jump can overshoot the part by that much and come back. One that
// ends within the rim is no longer than half of it (grow.c).
window window_around(const jali_bitmap *solid, const int32_t box[4], int32_t rim)
{
    window w = {.border = MIN(rim / 2 + 1, MOST_JUMP_PX)};
    w.x0 = (MAX(box[0] - rim, -MOST_JUMP_PX) & ~63);
    w.y0 = MAX(box[1] - rim, -MOST_JUMP_PX);
    w.words = (MIN(box[2] + rim, solid->width_px + MOST_JUMP_PX) - w.x0 + 63) / 64;
    w.rows = MIN(box[3] + rim, solid->height_px + MOST_JUMP_PX) - w.y0;
    return w;
}

jali_status make_plane(jali_context *ctx, const window *w, plane *p)
{
    size_t words = (size_t)word_count(w), wanted = words + words / 2;
    if (words <= p->capacity) return JALI_OK;
    plane_free(ctx, p);
    jali_status status = ALLOCATE(ctx, p->word, wanted);
    if (status == JALI_OK) p->capacity = wanted;
    return status;
}

void plane_free(jali_context *ctx, plane *p)
{
    release(ctx, p->word);
    *p = (plane){0};
}

void clear_plane(const window *w, plane *p)
{
    memset(p->word, 0, (size_t)word_count(w) * sizeof *p->word);
}

void clear_border(const window *w, plane *p)
{
    size_t bytes = (size_t)(w->border * pitch_of(w)) * sizeof *p->word;
    memset(p->word, 0, bytes);
    memset(row_of(w, p, w->rows) - 1, 0, bytes);
}

void draw_part(const parts *p, int32_t root, const window *w, plane *own)
{
    clear_plane(w, own);
    jali_bitmap view = {0, 0, pitch_of(w), row_of(w, own, 0) - 1};
    for (int32_t i = p->head[root]; i >= 0; i = p->run[i].next)
        paint_run(&view, p->run[i].y - w->y0, p->run[i].x0 - w->x0 + 64, p->run[i].x1 - w->x0 + 64, true);
}

void draw_picture(const jali_bitmap *solid, const window *w, plane *picture)
{
    int32_t first = w->x0 / 64, left = MAX(-first, 0), right = MIN(w->words, (int32_t)solid->stride - first);
    clear_border(w, picture);
    for (int32_t y = 0; y < w->rows; y++) {
        uint64_t *row = row_of(w, picture, y);
        int64_t at = w->y0 + y;
        bool beyond = at < 0 || at >= solid->height_px;
        int32_t from = beyond ? w->words : left, to = beyond ? w->words : right;
        for (int32_t i = -1; i < from; i++) row[i] = 0;
        if (!beyond)
            memcpy(row + from, solid->word + at * solid->stride + first + from,
                   (size_t)(to - from) * sizeof *row);
        for (int32_t i = to; i <= w->words; i++) row[i] = 0;
    }
}

static int64_t distance_of(jali_metric metric, int64_t dx, int64_t dy)
{
    return metric == JALI_METRIC_CITY_BLOCK ? llabs(dx) + llabs(dy) : dx * dx + dy * dy;
}

void nearest_own(const window *w, const plane *own, jali_metric metric, int32_t reach, const int32_t to[2],
                 int32_t from[2])
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
