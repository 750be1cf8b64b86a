// Pictures as one byte a pixel: the oracle's side of the tests. Slow, obvious, and nothing of it is the
// library's.
#ifndef TESTS_PLAIN_H
#define TESTS_PLAIN_H

#include <jali/bitmap.h>

#include <stdlib.h>
#include <string.h>

typedef struct plain {
    int32_t w, h;
    uint8_t *white; // [h * w], 0 or 1
} plain;

static inline plain plain_create(int32_t w, int32_t h)
{
    return (plain){w, h, calloc((size_t)w * (size_t)h + 1, 1)};
}

static inline plain plain_of(const jali_bitmap *a)
{
    plain p = plain_create(a->width_px, a->height_px);
    for (int32_t y = 0; y < p.h; y++)
        for (int32_t x = 0; x < p.w; x++) p.white[y * p.w + x] = jali_bitmap_get(a, x, y);
    return p;
}

static inline void plain_free(plain *p)
{
    free(p->white);
    *p = (plain){0};
}

static inline bool plain_inside(const plain *p, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < p->w && y < p->h;
}

static inline bool plain_at(const plain *p, int32_t x, int32_t y, bool outside)
{
    return plain_inside(p, x, y) ? p->white[y * p->w + x] : outside;
}

static inline bool plain_equals(const plain *p, const jali_bitmap *a)
{
    if (p->w != a->width_px || p->h != a->height_px) return false;
    for (int32_t y = 0; y < p->h; y++)
        for (int32_t x = 0; x < p->w; x++)
            if (p->white[y * p->w + x] != jali_bitmap_get(a, x, y)) return false;
    return true;
}

static inline int64_t plain_count(const plain *p, bool white)
{
    int64_t count = 0;
    for (int64_t i = 0; i < (int64_t)p->w * p->h; i++) count += p->white[i] == white;
    return count;
}

/// Connected components of a tone, numbered by first pixel in raster order; label -1 is the other tone.
///   out    label   [h * w]
static inline int32_t plain_label(const plain *p, bool white, int32_t connectivity, int32_t *label)
{
    int32_t n = p->w * p->h, count = 0;
    int32_t *stack = malloc(((size_t)n + 1) * sizeof *stack);
    for (int32_t i = 0; i < n; i++) label[i] = -1;
    for (int32_t first = 0; first < n; first++) {
        if (p->white[first] != white || label[first] >= 0) continue;
        int32_t depth = 0;
        label[first] = count;
        stack[depth++] = first;
        while (depth > 0) {
            int32_t i = stack[--depth];
            for (int32_t dy = -1; dy <= 1; dy++)
                for (int32_t dx = -1; dx <= 1; dx++) {
                    int32_t x = i % p->w + dx, y = i / p->w + dy;
                    if ((connectivity == 4 && dx && dy) || !plain_inside(p, x, y)) continue;
                    int32_t j = y * p->w + x;
                    if (p->white[j] != white || label[j] >= 0) continue;
                    label[j] = count;
                    stack[depth++] = j;
                }
        }
        count++;
    }
    free(stack);
    return count;
}

static inline int32_t plain_pieces(const plain *p, bool white, int32_t connectivity)
{
    int32_t *label = malloc(((size_t)p->w * (size_t)p->h + 1) * sizeof *label);
    int32_t count = plain_label(p, white, connectivity, label);
    free(label);
    return count;
}

#endif
