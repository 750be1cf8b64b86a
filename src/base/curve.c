// A radix sort by keys, least digit first.
#include "base/curve.h"

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

// One stable pass.
static void sort_digit(const keyed *from, int32_t count, int shift, keyed *to)
{
    int32_t start[DIGITS + 1] = {0};
    for (int32_t i = 0; i < count; i++) start[(from[i].key >> shift & (DIGITS - 1)) + 1]++;
    for (int32_t d = 0; d < DIGITS; d++) start[d + 1] += start[d];
    for (int32_t i = 0; i < count; i++) to[start[from[i].key >> shift & (DIGITS - 1)]++] = from[i];
}

jali_status order_by_key(jali_context *ctx, keyed *item, int32_t count, int32_t key_bits, int32_t *order)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    keyed *other;
    TRY(ARENA(ctx, other, count));
    for (int shift = 0; shift < key_bits; shift += DIGIT_BITS) {
        sort_digit(item, count, shift, other);
        keyed *swapped = item;
        item = other;
        other = swapped;
    }
    for (int32_t i = 0; i < count; i++) order[i] = item[i].index;
done:
    arena_rewind(ctx, mark);
    return status;
}
