// Bit-packed pictures: 64 pixels a word, white (1) is solid, black (0) is pierced.
#ifndef JALI_BITMAP_H
#define JALI_BITMAP_H

#include <jali/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// {0} is the empty bitmap. Row 0 is the top row; pixel (x, y) is bit x % 64 of word[y * stride + x / 64].
/// Bits at and beyond width_px are always 0.
typedef struct jali_bitmap {
    int32_t width_px, height_px;
    int64_t stride; // words a row, a multiple of 8 (64 bytes, one vector register)
    uint64_t *word; // [height_px * stride], 64-byte aligned
} jali_bitmap;

/// A black bitmap.
///   in     width_px, height_px   0 .. 2^20 each
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT
JALI_API jali_status jali_bitmap_create(jali_context *ctx, int32_t width_px, int32_t height_px,
                                        jali_bitmap *bitmap);
JALI_API jali_status jali_bitmap_copy(jali_context *ctx, const jali_bitmap *from, jali_bitmap *to);
JALI_API void jali_bitmap_free(jali_context *ctx, jali_bitmap *bitmap);

static inline bool jali_bitmap_get(const jali_bitmap *bitmap, int32_t x, int32_t y)
{
    return bitmap->word[(int64_t)y * bitmap->stride + (x >> 6)] >> (x & 63) & 1;
}

static inline void jali_bitmap_set(jali_bitmap *bitmap, int32_t x, int32_t y, bool white)
{
    uint64_t *word = &bitmap->word[(int64_t)y * bitmap->stride + (x >> 6)];
    uint64_t bit = (uint64_t)1 << (x & 63);
    *word = white ? *word | bit : *word & ~bit;
}

#ifdef __cplusplus
}
#endif
#endif
