// The medial axis of a tone, by Lantuejoul's formula on 3 x 3 squares.
//
// Method:  strips of rows with as many rows around them as there are rounds stay in the cache for all rounds;
// a strip
//          that has run empty stops. With no limit on the rounds the strips would need the whole picture
//          around them, so then the whole picture goes through the rounds together.
// Cost:    about 20 word operations a word and round.
#include "raster/raster.h"
#include "base/base.h"

enum { STRIP_ROWS = 64, SLOTS = 16, MOST_STRIP_ROUNDS = 64 };

typedef struct axis_job {
    const jali_bitmap *a;
    uint64_t flip, beyond; // all ones to look at black; what lies outside, as seen after the flip
    int32_t rounds;
    jali_bitmap *axis;
    int64_t pitch, plane; // words a row with guards; words of a plane of strip and surroundings
    uint64_t *scratch;    // [SLOTS][2 planes]
} axis_job;

// out = the pixels of the middle row whose 3 x 3 are all set.
VECTORISED static void erode_row(const uint64_t *above, const uint64_t *row, const uint64_t *below,
                                 uint64_t *out, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        uint64_t here = above[i] & row[i] & below[i];
        uint64_t left = above[i - 1] & row[i - 1] & below[i - 1],
                 right = above[i + 1] & row[i + 1] & below[i + 1];
        out[i] = here & (here << 1 | left >> 63) & (here >> 1 | right << 63);
    }
}

// axis |= row less what the 3 x 3 around the eroded pixels cover. Returns whether anything was eroded to.
VECTORISED static uint64_t gather_row(const uint64_t *above, const uint64_t *middle, const uint64_t *below,
                                      const uint64_t *row, uint64_t *axis, int64_t n)
{
    uint64_t any = 0;
    for (int64_t i = 0; i < n; i++) {
        uint64_t here = above[i] | middle[i] | below[i];
        uint64_t left = above[i - 1] | middle[i - 1] | below[i - 1],
                 right = above[i + 1] | middle[i + 1] | below[i + 1];
        uint64_t covered = here | here << 1 | left >> 63 | here >> 1 | right << 63;
        axis[i] |= row[i] & ~covered;
        any |= middle[i];
    }
    return any;
}

// Row y of a plane: its guard words, its columns beyond the width and, when y is no row of the picture, all
// of it.
static void set_beyond(const axis_job *job, int32_t y, uint64_t beyond, uint64_t *row)
{
    int64_t n = job->pitch - 2;
    int32_t width = y >= 0 && y < job->a->height_px ? job->a->width_px : 0;
    row[-1] = row[n] = beyond;
    for (int64_t i = width / 64; i < n; i++) {
        uint64_t real = i == width / 64 ? (UINT64_C(1) << width % 64) - 1 : 0;
        row[i] = (row[i] & real) | (beyond & ~real);
    }
}

static void load_row(const axis_job *job, int32_t y, uint64_t *row)
{
    if (y >= 0 && y < job->a->height_px)
        for (int64_t i = 0; i < job->a->stride; i++)
            row[i] = job->a->word[(int64_t)y * job->a->stride + i] ^ job->flip;
    set_beyond(job, y, job->beyond, row);
}

// All rounds on the rows y0 - halo .. y1 + halo - 1. Each round the rows that are still right lose one at
// each end. What lies beyond the picture counts for the erosion but covers nothing.
static void strip_rounds(const axis_job *job, uint64_t *scratch, int32_t y0, int32_t y1, int32_t halo)
{
    int64_t n = job->pitch - 2;
    int32_t rows = y1 - y0 + 2 * halo;
    uint64_t *left = scratch + 1, *next = left + job->plane;
    for (int32_t k = 0; k < rows; k++) load_row(job, y0 - halo + k, left + k * job->pitch);
    for (int32_t round = 0; round < job->rounds; round++) {
        for (int32_t k = round + 1; k < rows - round - 1; k++) {
            const uint64_t *row = left + k * job->pitch;
            erode_row(row - job->pitch, row, row + job->pitch, next + k * job->pitch, n);
            set_beyond(job, y0 - halo + k, 0, next + k * job->pitch);
        }
        uint64_t any = 0;
        for (int32_t k = halo; k < rows - halo; k++) {
            const uint64_t *middle = next + k * job->pitch;
            set_beyond(job, y0 - halo + k, 0, left + k * job->pitch); // no axis there either
            any |= gather_row(middle - job->pitch, middle, middle + job->pitch, left + k * job->pitch,
                              job->axis->word + (int64_t)(y0 - halo + k) * job->axis->stride, n);
        }
        if (!any) return; // nothing of the strip is left
        for (int32_t k = round + 1; job->beyond && k < rows - round - 1; k++)
            set_beyond(job, y0 - halo + k, job->beyond, next + k * job->pitch);
        uint64_t *swap = left;
        left = next;
        next = swap;
    }
}

// Strip after strip with one set of planes.
static void axis_strips(void *shared, int32_t slot)
{
    const axis_job *job = shared;
    for (int32_t y0 = slot * STRIP_ROWS; y0 < job->a->height_px; y0 += SLOTS * STRIP_ROWS)
        strip_rounds(job, job->scratch + slot * 2 * job->plane, y0, MIN(y0 + STRIP_ROWS, job->a->height_px),
                     job->rounds + 1);
}

static jali_status axis_by_strips(jali_context *ctx, axis_job *job)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    job->pitch = job->a->stride + 2;
    job->plane = (STRIP_ROWS + 2 * (job->rounds + 1)) * job->pitch;
    TRY(ARENA(ctx, job->scratch, 2 * SLOTS * job->plane));
    parallel(ctx, SLOTS, axis_strips, job);
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status axis_of_all(jali_context *ctx, const jali_bitmap *a, bool white, bool outside,
                               jali_bitmap *axis)
{
    jali_status status;
    jali_bitmap left = {0}, next = {0}, opened = {0};
    element square = {0};
    TRY(jali_bitmap_copy(ctx, a, &left));
    TRY(jali_bitmap_create(ctx, a->width_px, a->height_px, &next));
    TRY(jali_bitmap_create(ctx, a->width_px, a->height_px, &opened));
    TRY(element_square(ctx, 3, &square));
    if (!white) invert(ctx, &left, &left);
    while (any_white(ctx, &left)) {
        TRY(step(ctx, "medial axis", 0));
        TRY(erode(ctx, &left, &square, outside, &next));
        if (count_combined(ctx, RULE_XOR, &left, &next) == 0) break; // all of one tone: no boundary, no axis
        TRY(dilate(ctx, &next, &square, false, &opened));
        combine(ctx, RULE_AND_NOT, &left, &opened, &opened);
        combine(ctx, RULE_OR, axis, &opened, axis);
        jali_bitmap swap = left;
        left = next;
        next = swap;
    }
done:
    jali_bitmap_free(ctx, &left);
    jali_bitmap_free(ctx, &next);
    jali_bitmap_free(ctx, &opened);
    element_free(ctx, &square);
    return status;
}

jali_status medial_axis(jali_context *ctx, const jali_bitmap *a, bool white, bool outside, int32_t rounds,
                        jali_bitmap *axis)
{
    jali_status status = jali_bitmap_create(ctx, a->width_px, a->height_px, axis);
    if (status != JALI_OK || !axis->word) return status;
    uint64_t flip = white ? 0 : ~UINT64_C(0);
    axis_job job = {
        .a = a, .flip = flip, .beyond = outside ? ~UINT64_C(0) : 0, .rounds = rounds, .axis = axis};
    bool strips = rounds > 0 && rounds <= MOST_STRIP_ROUNDS;
    status = strips ? axis_by_strips(ctx, &job) : axis_of_all(ctx, a, white, outside, axis);
    if (status != JALI_OK) jali_bitmap_free(ctx, axis);
    return status;
}
