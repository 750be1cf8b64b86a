// Steps of a part that grows, over the words of a window. Internal to connect.
#ifndef CONNECT_GROW_H
#define CONNECT_GROW_H

#include "connect/search.h"

enum { MOST_JUMP_PX = 63 };

/// What of a picture a search looks at. Its planes have a border, which stays black: a word on either side,
/// and as many rows above and below as a jump is long, so that a pass is one loop over all words.
typedef struct window {
    int32_t x0, y0;      // upper left corner in the picture, x0 a multiple of 64
    int32_t words, rows; // without the border
    int32_t border;      // rows
} window;

static inline uint64_t *row_of(const window *w, uint64_t *words, int32_t y)
{
    return words + (int64_t)(y + w->border) * (w->words + 2) + 1;
}

static inline int64_t word_count(const window *w)
{
    return (int64_t)(w->words + 2) * (w->rows + 2 * w->border);
}

/// How many steps can be taken at once after the first k, `most` at most.
int32_t jump_length(jali_metric metric, int32_t k, int32_t most);
/// `jump` steps after the first k, from `grown` into `next`; returns whether they meet another part.
bool take_steps(jali_context *ctx, const window *w, search *s, jali_metric metric, int32_t k, int32_t jump);

#endif
