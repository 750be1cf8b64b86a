// Few points: each chord reaches as far as it keeps every crossing within its limits.
//
// The limits are the two pixel centres of the crack or lie between them; they are passed strictly, and the
// test is exact: the argument in trace.c for why contours cannot touch needs no more than this.
#include "trace/path.h"

typedef struct wedge {
    int64_t right[2], left[2];
    bool open;
} wedge;

static inline int64_t cross(const int64_t a[2], const int64_t b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

// Narrow the directions from `from` to those that cross `c` within its limits. False when none is left.
static bool pass(wedge *w, const int32_t from[2], const crossing *c)
{
    int across = !(c->direction & 1);
    int64_t left[2] = {(int64_t)c->at[0] - from[0], (int64_t)c->at[1] - from[1]},
            right[2] = {left[0], left[1]};
    left[across] = (int64_t)c->left - from[across];
    right[across] = (int64_t)c->right - from[across];
    if (w->open) {
        memcpy(w->left, left, sizeof left);
        memcpy(w->right, right, sizeof right);
        w->open = false;
    }
    if (cross(w->left, left) < 0) memcpy(w->left, left, sizeof left);
    if (cross(w->right, right) > 0) memcpy(w->right, right, sizeof right);
    return cross(w->right, w->left) > 0;
}

static bool sees(const wedge *w, const int32_t from[2], const int32_t to[2])
{
    int64_t d[2] = {(int64_t)to[0] - from[0], (int64_t)to[1] - from[1]};
    return w->open || (cross(w->right, d) > 0 && cross(d, w->left) > 0);
}

// The last point that a chord from point i may end at; points are numbered around, up to `end`.
static int32_t farthest(const crossing *fine, int32_t count, int32_t i, int32_t end)
{
    wedge w = {.open = true};
    const int32_t *from = fine[i % count].at;
    int32_t good = i + 1;
    for (int32_t k = i + 1; k <= end; k++) {
        const crossing *c = &fine[k % count];
        if (sees(&w, from, c->at)) good = k;
        // Waiting for a later point to come into view must not make the walk quadratic.
        if (c->direction == CORNER || k - good > 64 + 2 * (good - i) || !pass(&w, from, c)) break;
    }
    return good;
}

int32_t simplify(const crossing *fine, int32_t count, int32_t (*point)[2])
{
    int32_t start = 0, kept = 0;
    while (start < count && fine[start].direction != CORNER) start++;
    if (start == count) start = farthest(fine, count, 0, count); // a point that a chord would end at anyway
    start %= count;
    for (int32_t i = start; i < start + count; i = farthest(fine, count, i, start + count))
        memcpy(point[kept++], fine[i % count].at, sizeof point[0]);
    return kept;
}
