// A pixel takes the tone of most pixels of the 7 x 7 around it: stairs and beads go, what is 8 px wide stays.
//
// Method:  bit-sliced counting. Seven bits are added by four full adders into a three-bit number, along the
// row
//          first, then plane by plane along the column; 49 counts fit into six planes.
// Cost:    about 150 word operations a word, whatever the picture.
// Checked: tests/test_raster.c against the definition.
#include "raster/raster.h"
#include "base/base.h"

enum { STRIP_ROWS = 64, RING = 8 };

typedef struct majority_job {
    const jali_bitmap *src;
    jali_bitmap *dst;
    uint64_t beyond;
    int64_t pitch;     // words of a ring row, with one guard word on each side
    uint64_t *scratch; // [strips][RING * 3 + 1][pitch]
} majority_job;

typedef struct sum3 {
    uint64_t one, two, four;
} sum3;

static inline uint64_t full_add(uint64_t a, uint64_t b, uint64_t c, uint64_t *carry)
{
    uint64_t half = a ^ b;
    *carry = (a & b) | (half & c);
    return half ^ c;
}

static inline sum3 add_seven(uint64_t a, uint64_t b, uint64_t c, uint64_t d, uint64_t e, uint64_t f,
                             uint64_t g)
{
    sum3 s;
    uint64_t p, q, r, low;
    low = full_add(a, b, c, &p);
    low = full_add(low, d, e, &q);
    s.one = full_add(low, f, g, &r);
    s.two = full_add(p, q, r, &s.four);
    return s;
}

// Counts of the seven pixels around each, as three planes.
VECTORISED static void sum_row(const uint64_t *row, uint64_t *one, uint64_t *two, uint64_t *four, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        uint64_t here = row[i], left = row[i - 1], right = row[i + 1];
        sum3 s = add_seven(here, here << 1 | left >> 63, here << 2 | left >> 62, here << 3 | left >> 61,
                           here >> 1 | right << 63, here >> 2 | right << 62, here >> 3 | right << 61);
        one[i] = s.one;
        two[i] = s.two;
        four[i] = s.four;
    }
}

// More than half of 49: the count is 25 or more.
VECTORISED static void decide_row(const uint64_t *const plane[3][7], uint64_t *out, int64_t n)
{
    for (int64_t i = 0; i < n; i++) {
        sum3 s[3]; // of the ones, the twos, the fours
        for (int32_t k = 0; k < 3; k++)
            s[k] = add_seven(plane[k][0][i], plane[k][1][i], plane[k][2][i], plane[k][3][i], plane[k][4][i],
                             plane[k][5][i], plane[k][6][i]);
        uint64_t bit[6], carry2, carry4, carry8, more4, more8;
        bit[0] = s[0].one;
        bit[1] = full_add(s[0].two, s[1].one, 0, &carry2);
        bit[2] = full_add(s[0].four, s[1].two, s[2].one, &carry4);
        bit[2] = full_add(bit[2], carry2, 0, &more4);
        bit[3] = full_add(s[1].four, s[2].two, carry4, &carry8);
        bit[3] = full_add(bit[3], more4, 0, &more8);
        bit[4] = s[2].four ^ carry8 ^ more8;
        bit[5] = (s[2].four & carry8) | (s[2].four & more8) | (carry8 & more8);
        out[i] = bit[5] | (bit[4] & bit[3] & (bit[2] | bit[1] | bit[0]));
    }
}

static void load_sums(const majority_job *job, uint64_t *scratch, int32_t y)
{
    const jali_bitmap *src = job->src;
    int64_t n = src->stride;
    uint64_t *row = scratch + RING * 3 * job->pitch + 1;
    bool inside = y >= 0 && y < src->height_px;
    if (inside) memcpy(row, src->word + (int64_t)y * n, (size_t)n * sizeof *row);
    row[-1] = row[n] = job->beyond;
    int32_t width = inside ? src->width_px : 0;
    for (int64_t i = width / 64; i < n; i++) {
        uint64_t real = i == width / 64 ? (UINT64_C(1) << width % 64) - 1 : 0;
        row[i] = (row[i] & real) | (job->beyond & ~real);
    }
    uint64_t *slot = scratch + (y + RING) % RING * 3 * job->pitch + 1;
    sum_row(row, slot, slot + job->pitch, slot + 2 * job->pitch, n);
}

static void majority_strip(void *shared, int32_t strip)
{
    const majority_job *job = shared;
    uint64_t *scratch = job->scratch + strip * (RING * 3 + 1) * job->pitch;
    int32_t y0 = strip * STRIP_ROWS, y1 = MIN(y0 + STRIP_ROWS, job->src->height_px);
    for (int32_t y = y0 - 3; y < y0 + 3; y++) load_sums(job, scratch, y);
    for (int32_t y = y0; y < y1; y++) {
        const uint64_t *plane[3][7];
        load_sums(job, scratch, y + 3);
        for (int32_t k = 0; k < 3; k++)
            for (int32_t dy = -3; dy <= 3; dy++)
                plane[k][dy + 3] = scratch + ((y + dy + RING) % RING * 3 + k) * job->pitch + 1;
        uint64_t *out = job->dst->word + (int64_t)y * job->dst->stride;
        decide_row(plane, out, job->dst->stride);
        int32_t width = job->dst->width_px;
        for (int64_t i = width / 64; i < job->dst->stride; i++)
            out[i] &= i == width / 64 ? (UINT64_C(1) << width % 64) - 1 : 0;
    }
}

jali_status majority(jali_context *ctx, const jali_bitmap *src, bool outside, jali_bitmap *dst)
{
    jali_status status = JALI_OK;
    arena_mark mark = arena_here(ctx);
    int32_t strips = (src->height_px + STRIP_ROWS - 1) / STRIP_ROWS;
    majority_job job = {src, dst, outside ? ~UINT64_C(0) : 0, src->stride + 2, NULL};
    if (!src->word) return JALI_OK;
    TRY(ARENA(ctx, job.scratch, (int64_t)strips * (RING * 3 + 1) * job.pitch));
    parallel(ctx, strips, majority_strip, &job);
done:
    arena_rewind(ctx, mark);
    return status;
}
