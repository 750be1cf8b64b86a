// The order in which points enter a triangulation: near each other in turn, yet random in the large.
//
// Source:  Amenta, Choi, Rote: Incremental constructions con BRIO (2003). Half of the points, picked by a
// hash
//          of their index, enter in the last round, half of the rest in the round before, and so on; inside a
//          round they follow a Hilbert curve. The rounds give the expected bounds of a random order whatever
//          the input, the curve keeps the walks and the memory local.
// Checked: tests/test_plane.c.
#include "plane/order.h"
#include "base/curve.h"

enum { HILBERT_BITS = 16, FIRST_ROUND_POINTS = 256 };

// Position of cell (x, y) on the Hilbert curve over 2^16 x 2^16 cells.
static uint64_t hilbert_position(uint32_t x, uint32_t y)
{
    uint64_t position = 0;
    for (uint32_t side = 1u << (HILBERT_BITS - 1); side > 0; side >>= 1) {
        uint32_t right = (x & side) != 0, upper = (y & side) != 0;
        position = position << 2 | ((3 * right) ^ upper);
        if (!upper) {
            uint32_t flip = right ? (1u << HILBERT_BITS) - 1 : 0, swapped = x ^ flip;
            x = y ^ flip;
            y = swapped;
        }
    }
    return position;
}

// The finaliser of splitmix64: decorrelates neighbouring indices.
static uint64_t mixed(uint64_t n)
{
    n = (n + UINT64_C(0x9e3779b97f4a7c15)) * UINT64_C(0xbf58476d1ce4e5b9);
    n = (n ^ (n >> 27)) * UINT64_C(0x94d049bb133111eb);
    return n ^ (n >> 31);
}

static void give_keys(const int32_t (*point)[2], int32_t count, keyed *item)
{
    int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = MIN(low[k], point[i][k]);
            high[k] = MAX(high[k], point[i][k]);
        }
    int64_t extent = MAX((int64_t)high[0] - low[0], (int64_t)high[1] - low[1]);
    int shift = 0;
    while (extent >> shift >= 1 << HILBERT_BITS) shift++;
    int last_round = 0;
    while (count >> last_round > FIRST_ROUND_POINTS) last_round++;
    for (int32_t i = 0; i < count; i++) {
        int before_last = __builtin_ctzll(mixed((uint64_t)i) | UINT64_C(1) << 63);
        uint64_t round = (uint64_t)MAX(last_round - before_last, 0);
        uint32_t x = (uint32_t)(((int64_t)point[i][0] - low[0]) >> shift);
        uint32_t y = (uint32_t)(((int64_t)point[i][1] - low[1]) >> shift);
        item[i] = (keyed){round << (2 * HILBERT_BITS) | hilbert_position(x, y), i};
    }
}

jali_status insertion_order(jali_context *ctx, const int32_t (*point)[2], int32_t count, int32_t *order)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    keyed *item;
    TRY(ARENA(ctx, item, count));
    give_keys(point, count, item);
    TRY(order_by_key(ctx, item, count, 2 * HILBERT_BITS + 6, order));
done:
    arena_rewind(ctx, mark);
    return status;
}
