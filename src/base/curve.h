// Orders along space-filling curves: what is near in space comes near in memory.
#ifndef BASE_CURVE_H
#define BASE_CURVE_H

#include "base/base.h"

typedef struct keyed {
    uint64_t key;
    int32_t index;
} keyed;

/// Indices by key, ascending; equal keys keep their order.
///   in     key_bits   keys are below 2^key_bits
///   inout  item       [count] scratch afterwards
///   out    order      [count]
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(count), a pass for every 11 bits
jali_status order_by_key(jali_context *ctx, keyed *item, int32_t count, int32_t key_bits, int32_t *order);

/// The 21 low bits spread out to every third place: three of them make a Morton code.
static inline uint64_t every_third_bit(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & UINT64_C(0x001f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x001f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    x = (x | x << 2) & UINT64_C(0x1249249249249249);
    return x;
}

#endif
