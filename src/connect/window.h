// The part of a picture that a search looks at. Internal to connect.
#ifndef CONNECT_WINDOW_H
#define CONNECT_WINDOW_H

#include "connect/parts.h"
#include <jali/connect.h>

enum { MOST_JUMP_PX = 63 };

/// Its planes have a border, which stays black: a word on either side, and as many rows above and below as a
/// jump is long, so that a pass is one loop over all words.
typedef struct window {
    int32_t x0, y0;      // upper left corner in the picture, x0 a multiple of 64
    int32_t words, rows; // without the border
    int32_t border;      // rows
} window;

/// A bit a pixel of a window. {0} is valid and empty.
typedef struct plane {
    uint64_t *word;
    size_t capacity;
} plane;

static inline int64_t pitch_of(const window *w)
{
    return w->words + 2;
}

static inline uint64_t *row_of(const window *w, const plane *p, int32_t y)
{
    return p->word + (y + w->border) * pitch_of(w) + 1;
}

static inline int64_t word_count(const window *w)
{
    return pitch_of(w) * (w->rows + 2 * w->border);
}

/// The box (x0, y0, x1, y1) and `rim` pixels around it, cut off a little beyond the picture.
window window_around(const jali_bitmap *solid, const int32_t box[4], int32_t rim);

/// Room for a window's pixels, which are lost where there was less of it.
jali_status make_plane(jali_context *ctx, const window *w, plane *p);
void plane_free(jali_context *ctx, plane *p);
void clear_plane(const window *w, plane *p);
/// The rows above and below alone: a pass wipes the words beside the rows that it writes.
void clear_border(const window *w, plane *p);

/// The part alone; the window holds all of it.
void draw_part(const parts *p, int32_t root, const window *w, plane *own);
/// The picture's pixels, and nothing in the border.
void draw_picture(const jali_bitmap *solid, const window *w, plane *picture);
/// The pixel of the plane nearest to `to`, at most `reach` rows and columns away; the first in raster order.
void nearest_own(const window *w, const plane *own, jali_metric metric, int32_t reach, const int32_t to[2],
                 int32_t from[2]);

#endif
