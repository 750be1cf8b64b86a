// Follow the cracks: the boundary of a bitmap as closed paths.
//
// Every path has a downward crack (the left edge of a solid pixel). A bitmap of those that have not been
// passed yet gives the starts and ends the search.
#include "trace/path.h"

enum { ROWS_A_STEP = 256 };
// A path's points and its coordinates' sums stay within 31 and 63 bits.
static const int32_t CRACK_LIMIT = 1 << 28;

typedef struct pixels {
    const jali_bitmap *solid;
    bool outside;
} pixels;

// Pixel column x, rows counted upwards.
static inline bool is_solid(const pixels *p, int32_t x, int32_t y)
{
    if ((uint32_t)x >= (uint32_t)p->solid->width_px || (uint32_t)y >= (uint32_t)p->solid->height_px)
        return p->outside;
    return jali_bitmap_get(p->solid, x, p->solid->height_px - 1 - y);
}

void crack_paths_free(jali_context *ctx, crack_paths *paths)
{
    release(ctx, paths->first);
    release(ctx, paths->length_px);
    release(ctx, paths->turn);
    *paths = (crack_paths){0};
}

// Bit x of row y: pixel x is solid, pixel x - 1 is void. One column more than the bitmap.
static void mark_downward(const pixels *p, int32_t y, const jali_bitmap *down)
{
    const uint64_t *row = p->solid->word + y * p->solid->stride;
    uint64_t *to = down->word + y * down->stride;
    int32_t width = p->solid->width_px;
    uint64_t before = p->outside;
    for (int32_t w = 0; 64 * w <= width; w++) {
        int32_t used = width - 64 * w; // pixels of the bitmap in this word; those beyond are `outside`
        uint64_t bits = used > 0 ? row[w] : 0;
        if (p->outside && used < 64) bits |= used > 0 ? ~UINT64_C(0) << used : ~UINT64_C(0);
        uint64_t here = bits & ~(bits << 1 | before);
        before = bits >> 63;
        if (used < 63) here &= (UINT64_C(2) << used) - 1;
        to[w] = here;
    }
}

// Ahead of a corner, by direction: the pixels on the left and on the right.
static const int8_t ahead_x[4] = {1, 0, -1, 0}, ahead_y[4] = {0, 1, 0, -1};
static const int8_t left_x[4] = {0, -1, -1, 0}, left_y[4] = {0, 0, -1, -1};
static const int8_t right_x[4] = {0, 0, -1, -1}, right_y[4] = {-1, 0, 0, -1};

static jali_status add_turn(jali_context *ctx, crack_paths *paths, turn here)
{
    jali_status status = GROW(ctx, paths->turn, paths->turn_capacity, paths->turn_count + 1);
    if (status == JALI_OK) paths->turn[paths->turn_count++] = here;
    return status;
}

// One path, from the turn (start_x, start_y) into a downward crack. Each such crack is taken off `down`.
static jali_status follow_one(jali_context *ctx, const pixels *p, jali_bitmap *down, int32_t start_x,
                              int32_t start_y, crack_paths *paths)
{
    jali_status status;
    int32_t x = start_x, y = start_y, direction = 3;
    int64_t first = paths->turn_count, cracks = 0;
    TRY(add_turn(ctx, paths, (turn){x, y, false}));
    for (;;) {
        if (direction == 3) jali_bitmap_set(down, x, p->solid->height_px - y, false);
        x += ahead_x[direction];
        y += ahead_y[direction];
        cracks++;
        bool left = is_solid(p, x + left_x[direction], y + left_y[direction]);
        bool right = is_solid(p, x + right_x[direction], y + right_y[direction]);
        if (left && !right) continue;
        direction = (direction + (left ? 3 : 1)) & 3;
        if (x == start_x && y == start_y && direction == 3) {
            paths->turn[first].apart = !left && right;
            break;
        }
        TRY(add_turn(ctx, paths, (turn){x, y, !left && right}));
    }
    if (cracks > CRACK_LIMIT)
        return fail(ctx, JALI_LIMIT, "one outline of the picture is %lld px long, more than %d",
                    (long long)cracks, CRACK_LIMIT);
    int32_t path = paths->path_count++;
    TRY(GROW(ctx, paths->length_px, paths->length_capacity, path + 1));
    paths->length_px[path] = (int32_t)cracks;
    TRY(GROW(ctx, paths->first, paths->path_capacity, path + 2));
    paths->first[path] = first;
    paths->first[path + 1] = paths->turn_count;
done:
    return status;
}

jali_status follow_cracks(jali_context *ctx, const jali_bitmap *solid, bool outside_solid, crack_paths *paths)
{
    jali_status status;
    pixels p = {solid, outside_solid};
    jali_bitmap down = {0};
    *paths = (crack_paths){0};
    TRY(jali_bitmap_create(ctx, solid->width_px + 1, solid->height_px, &down));
    for (int32_t y = 0; y < solid->height_px; y++) mark_downward(&p, y, &down);
    for (int32_t y = 0; y < solid->height_px; y++) {
        if (y % ROWS_A_STEP == 0) TRY(step(ctx, "trace", 0.3 * y / solid->height_px));
        for (int32_t w = 0; w < down.stride; w++) {
            const uint64_t *word = &down.word[y * down.stride + w];
            while (*word != 0)
                TRY(follow_one(ctx, &p, &down, 64 * w + __builtin_ctzll(*word), solid->height_px - y, paths));
        }
    }
done:
    jali_bitmap_free(ctx, &down);
    if (status != JALI_OK) crack_paths_free(ctx, paths);
    return status;
}
