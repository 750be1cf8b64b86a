// The shortest way around blocked pixels, and its corners.
//
// Method:  Dial's buckets over the pixels of a window (Dijkstra's order for small whole lengths): a step
// along
//          a row or column is 5 long, a diagonal one 7 (not in the city block metric). The way is then pulled
//          tight: from each corner on, straight as far as the walk stays free.
// Exact:   while the search came to no edge of the window nothing outside can be nearer; else it is made
// larger. Limits:  the pulled way is the shortest among 8 directions straightened, not the Euclidean
// shortest. Checked: tests/test_connect.c: walls with gaps, lengths against a plain search, rooms without a
// door.
#include "connect/detour.h"
#include "base/base.h"

enum { STRAIGHT = 5, DIAGONAL = 7, FIRST_RIM_PX = 64, SOURCE = 9, SETTLED = 16 };

// Steps 1 .. 8 of `by`: the four along rows and columns first.
static const int32_t STEP[9][2] = {{0, 0},   {0, -1}, {-1, 0}, {1, 0}, {0, 1},
                                   {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};

bool line_is_free(const jali_bitmap *solid, const jali_bitmap *blocked, const int32_t from[2],
                  const int32_t to[2])
{
    line_walk walk = walk_line(from, to);
    while (walk_on(&walk))
        if (jali_bitmap_get(blocked, walk.x, walk.y) && !jali_bitmap_get(solid, walk.x, walk.y)) return false;
    return true;
}

/// The part of the picture that is looked at.
typedef struct room {
    const jali_bitmap *solid, *blocked;
    int32_t x0, y0, width, height;
} room;

static room room_around(const jali_bitmap *solid, const jali_bitmap *blocked, const int32_t box[4],
                        int32_t rim)
{
    int32_t x0 = MAX(box[0] - rim, 0), y0 = MAX(box[1] - rim, 0), x1 = MIN(box[2] + rim, solid->width_px),
            y1 = MIN(box[3] + rim, solid->height_px);
    return (room){solid, blocked, x0, y0, x1 - x0, y1 - y0};
}

static bool inside(const room *r, int32_t x, int32_t y)
{
    return x >= r->x0 && y >= r->y0 && x < r->x0 + r->width && y < r->y0 + r->height;
}

static bool is_open(const room *r, int32_t x, int32_t y)
{
    return inside(r, x, y) && (!jali_bitmap_get(r->blocked, x, y) || jali_bitmap_get(r->solid, x, y));
}

// A diagonal step is walked over a corner: both must be open, for either may be taken.
static bool can_step(const room *r, int32_t x, int32_t y, int32_t by)
{
    int32_t u = x + STEP[by][0], v = y + STEP[by][1];
    return is_open(r, u, v) && (by < 5 || (is_open(r, u, y) && is_open(r, x, v)));
}

static jali_status push(jali_context *ctx, detour *d, int32_t count[DETOUR_QUEUES], int64_t at, int32_t pixel,
                        int32_t by)
{
    int32_t q = (int32_t)(at % DETOUR_QUEUES);
    jali_status status = GROW(ctx, d->queue[q], d->queue_capacity[q], count[q] + 1);
    if (status == JALI_OK) d->queue[q][count[q]++] = (detour_step){pixel, (uint8_t)by};
    return status;
}

// From a settled pixel to its neighbours.
static jali_status spread(jali_context *ctx, const room *r, jali_metric metric, int64_t at, int32_t pixel,
                          detour *d, int32_t count[DETOUR_QUEUES])
{
    jali_status status = JALI_OK;
    int32_t x = r->x0 + pixel % r->width, y = r->y0 + pixel / r->width;
    for (int32_t by = 1; by <= (metric == JALI_METRIC_OCTAGON ? 8 : 4); by++) {
        int32_t next = pixel + STEP[by][1] * r->width + STEP[by][0];
        if (can_step(r, x, y, by) && !d->seen[next])
            TRY(push(ctx, d, count, at + (by < 5 ? STRAIGHT : DIAGONAL), next, by));
    }
done:
    return status;
}

// The part's own pixels are settled; each way begins at its edge.
static jali_status begin(jali_context *ctx, const room *r, const parts *p, int32_t root, jali_metric metric,
                         detour *d, int32_t count[DETOUR_QUEUES])
{
    jali_status status = JALI_OK;
    memset(d->seen, 0, (size_t)r->width * (size_t)r->height);
    for (int32_t i = p->head[root]; i >= 0; i = p->run[i].next)
        memset(d->seen + (int64_t)(p->run[i].y - r->y0) * r->width + p->run[i].x0 - r->x0, SOURCE | SETTLED,
               (size_t)(p->run[i].x1 - p->run[i].x0));
    for (int32_t i = p->head[root]; i >= 0; i = p->run[i].next)
        for (int32_t x = p->run[i].x0, y = p->run[i].y; x < p->run[i].x1; x++) {
            int32_t pixel = (y - r->y0) * r->width + x - r->x0;
            bool deep = x > p->run[i].x0 && x < p->run[i].x1 - 1 && y > r->y0 && y < r->y0 + r->height - 1 &&
                        d->seen[pixel - r->width] && d->seen[pixel + r->width];
            if (!deep) TRY(spread(ctx, r, metric, 0, pixel, d, count));
        }
done:
    return status;
}

// Whether the picture goes on beyond the window there.
static bool is_at_rim(const room *r, int32_t x, int32_t y)
{
    return (x == r->x0 && x > 0) || (y == r->y0 && y > 0) ||
           (x == r->x0 + r->width - 1 && x < r->solid->width_px - 1) ||
           (y == r->y0 + r->height - 1 && y < r->solid->height_px - 1);
}

// Settle pixels in the order of their distance until one of another part comes.
//   out  reached   that pixel of the window, or -1
//        sure      nothing outside the window can be nearer: the search came to no edge of it, or not so far
static jali_status search_room(jali_context *ctx, const room *r, const parts *p, int32_t root,
                               jali_metric metric, detour *d, int32_t *reached, bool *sure)
{
    jali_status status;
    int32_t count[DETOUR_QUEUES] = {0}, idle = 0;
    *reached = -1;
    *sure = true;
    if ((int64_t)r->width * r->height > INT32_MAX)
        return fail(ctx, JALI_LIMIT,
                    "a way around what is blocked was looked for in %d x %d px; that is too much", r->width,
                    r->height);
    TRY(GROW(ctx, d->seen, d->seen_capacity, (size_t)r->width * (size_t)r->height));
    TRY(begin(ctx, r, p, root, metric, d, count));
    for (int64_t at = 0; idle < DETOUR_QUEUES; at++) {
        int32_t q = (int32_t)(at % DETOUR_QUEUES);
        idle = count[q] == 0 ? idle + 1 : 0;
        if (stopping(ctx)) TRY(step(ctx, "connect", 0));
        while (count[q] > 0) { // what is pushed from here goes into later queues: no step is 8 long
            detour_step now = d->queue[q][--count[q]];
            if (d->seen[now.pixel]) continue;
            d->seen[now.pixel] = now.by | SETTLED;
            int32_t x = r->x0 + now.pixel % r->width, y = r->y0 + now.pixel / r->width;
            *sure = *sure && !is_at_rim(r, x, y);
            if (jali_bitmap_get(r->solid, x, y)) {
                *reached = now.pixel;
                return JALI_OK;
            }
            TRY(spread(ctx, r, metric, at, now.pixel, d, count));
        }
    }
done:
    return status;
}

// The way back from where it ended, turned round.
static jali_status trace_back(jali_context *ctx, const room *r, int32_t reached, detour *d, int32_t *count)
{
    jali_status status = JALI_OK;
    *count = 0;
    for (int32_t pixel = reached;;) {
        int32_t by = d->seen[pixel] & ~SETTLED;
        TRY(GROW(ctx, d->path, d->path_capacity, *count + 1));
        d->path[*count][0] = r->x0 + pixel % r->width;
        d->path[*count][1] = r->y0 + pixel / r->width;
        ++*count;
        if (by == SOURCE) break;
        pixel -= STEP[by][1] * r->width + STEP[by][0];
    }
    for (int32_t i = 0, j = *count - 1; i < j; i++, j--)
        for (int32_t k = 0; k < 2; k++) {
            int32_t swapped = d->path[i][k];
            d->path[i][k] = d->path[j][k];
            d->path[j][k] = swapped;
        }
done:
    return status;
}

// How far along the path one can go straight from pixel i: doubled while it is free, then halved.
static int32_t straight_to(const room *r, const detour *d, int32_t i, int32_t last)
{
    int32_t good = i + 1, stride = 1;
    while (good < last) {
        int32_t next = MIN(good + stride, last);
        if (!line_is_free(r->solid, r->blocked, d->path[i], d->path[next])) break;
        good = next;
        stride *= 2;
    }
    for (stride /= 2; stride > 0; stride /= 2)
        if (good + stride <= last && line_is_free(r->solid, r->blocked, d->path[i], d->path[good + stride]))
            good += stride;
    return good;
}

static jali_status pull_tight(jali_context *ctx, const room *r, int32_t count, detour *d, jali_bridge *bridge)
{
    jali_status status = JALI_OK;
    d->corner_count = 0;
    for (int32_t i = straight_to(r, d, 0, count - 1); i < count - 1; i = straight_to(r, d, i, count - 1)) {
        TRY(GROW(ctx, d->corner, d->corner_capacity, d->corner_count + 1));
        memcpy(d->corner[d->corner_count++], d->path[i], sizeof *d->corner);
    }
    memcpy(bridge->from, d->path[0], sizeof bridge->from);
    memcpy(bridge->to, d->path[count - 1], sizeof bridge->to);
done:
    return status;
}

jali_status find_detour(jali_context *ctx, const jali_bitmap *solid, const jali_bitmap *blocked, parts *p,
                        int32_t root, jali_metric metric, detour *d, jali_bridge *bridge, bool *found)
{
    jali_status status;
    int32_t reached, count;
    bool sure;
    *found = false;
    for (int32_t rim = FIRST_RIM_PX;; rim *= 4) {
        room r = room_around(solid, blocked, p->box[root], rim);
        TRY(search_room(ctx, &r, p, root, metric, d, &reached, &sure));
        if (!sure) continue;
        if (reached < 0) return JALI_OK;
        *found = true;
        TRY(trace_back(ctx, &r, reached, d, &count));
        TRY(pull_tight(ctx, &r, count, d, bridge));
        return JALI_OK;
    }
done:
    return status;
}

void detour_free(jali_context *ctx, detour *d)
{
    release(ctx, d->seen);
    for (int32_t q = 0; q < DETOUR_QUEUES; q++) release(ctx, d->queue[q]);
    release(ctx, d->path);
    release(ctx, d->corner);
    *d = (detour){0};
}
