// What every test program shares: drawn bitmaps, checks, an allocator that refuses, seeds.
#ifndef TESTS_TESTING_H
#define TESTS_TESTING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <stdio.h>

#include <cmocka.h>
#undef fail // ours keeps a sentence; tests end by CHECK

#include <jali/bitmap.h>
#include "base/base.h"

#define TEST(name)                 static void name(void **state __attribute__((unused)))
#define CHECK(condition)           assert_true(condition)
#define CHECK_INT(got, wanted)     assert_int_equal((got), (wanted))
#define CHECK_OK(call)             check_ok((call), #call, __FILE__, __LINE__)
#define CHECK_STATUS(call, wanted) assert_int_equal((call), (wanted))

// The context of a test; a test that wants another makes its own.
static jali_context *ctx;

#ifdef __SANITIZE_THREAD__
// Ten times slower: here a program runs what is about threads, and the names of those tests say so.
__attribute__((constructor)) static void choose_tests(void)
{
    cmocka_set_test_filter("*threads*");
}
#endif

static inline void check_ok(jali_status status, const char *what, const char *file, int line)
{
    if (status != JALI_OK) print_error("%s: status %d: %s\n", what, status, jali_message(ctx));
    _assert_true(status == JALI_OK, what, file, line);
}

static inline int open_context(void **state)
{
    (void)state;
    jali_context_options opt = jali_context_defaults();
    opt.threads = 2;
    return jali_context_create(&opt, &ctx) == JALI_OK ? 0 : -1;
}

static inline int close_context(void **state)
{
    (void)state;
    jali_context_free(ctx);
    ctx = NULL;
    return 0;
}

/// A bitmap from a picture in the source: '#' is white, '.' is black, rows of `width` characters.
static inline jali_bitmap drawn_rows(int32_t width, const char *picture)
{
    jali_bitmap bitmap;
    int32_t height = (int32_t)strlen(picture) / width;
    CHECK_OK(jali_bitmap_create(ctx, width, height, &bitmap));
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) jali_bitmap_set(&bitmap, x, y, picture[y * width + x] == '#');
    return bitmap;
}

/// A small generator (xorshift64*), so that a seed names a case.
static inline uint64_t next_random(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * UINT64_C(2685821657736338717);
}

static inline jali_bitmap random_bitmap(uint64_t *seed, int32_t width, int32_t height, int32_t percent_white)
{
    jali_bitmap bitmap;
    CHECK_OK(jali_bitmap_create(ctx, width, height, &bitmap));
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            jali_bitmap_set(&bitmap, x, y, (int32_t)(next_random(seed) >> 33) % 100 < percent_white);
    return bitmap;
}

/// Blobs of `grain` px: noise that some of the printer's widths pass and some do not.
static inline jali_bitmap random_blobs(uint64_t *seed, int32_t w, int32_t h, int32_t grain, int32_t percent)
{
    jali_bitmap small = random_bitmap(seed, w / grain + 1, h / grain + 1, percent), a;
    CHECK_OK(jali_bitmap_create(ctx, w, h, &a));
    for (int32_t y = 0; y < h; y++)
        for (int32_t x = 0; x < w; x++)
            jali_bitmap_set(&a, x, y, jali_bitmap_get(&small, x / grain, y / grain));
    jali_bitmap_free(ctx, &small);
    return a;
}

static inline bool same_bitmap(const jali_bitmap *a, const jali_bitmap *b)
{
    return a->width_px == b->width_px && a->height_px == b->height_px &&
           (a->stride * a->height_px == 0 ||
            memcmp(a->word, b->word, (size_t)(a->stride * a->height_px) * sizeof *a->word) == 0);
}

/// Three contexts, with 1, 2 and 3 threads: what they make must be the same bytes.
static inline void open_thread_contexts(jali_context *by_threads[3])
{
    for (int32_t i = 0; i < 3; i++) {
        jali_context_options opt = jali_context_defaults();
        opt.threads = i + 1;
        assert_int_equal(jali_context_create(&opt, &by_threads[i]), JALI_OK);
    }
}

static inline void close_thread_contexts(jali_context *by_threads[3])
{
    for (int32_t i = 0; i < 3; i++) jali_context_free(by_threads[i]);
}

/// An allocator that refuses its n-th request (counted from 1) and counts what is not given back.
typedef struct refusing {
    int64_t request, refuse_at, outstanding;
} refusing;

static inline void *refusing_allocate(void *user, size_t bytes)
{
    refusing *r = user;
    if (++r->request == r->refuse_at) return NULL;
    r->outstanding++;
    return malloc(bytes);
}

static inline void refusing_release(void *user, void *block)
{
    ((refusing *)user)->outstanding--;
    free(block);
}

/// Run `body` once for each `stride`-th allocation it makes, that one refused: the status must be
/// JALI_NO_MEMORY and nothing may leak. Ends when a run needs no more allocations. The count is exact, for
/// threads of a pool allocate nothing, and tasks at one time (do_both) as much in any order.
static inline void refuse_allocations(jali_status (*body)(jali_context *limited, void *data), void *data,
                                      int64_t stride)
{
    for (int64_t refuse_at = 1;; refuse_at += stride) {
        refusing r = {.refuse_at = refuse_at};
        jali_context_options opt = jali_context_defaults();
        opt.threads = 2;
        opt.allocate = refusing_allocate;
        opt.release = refusing_release;
        opt.user = &r;
        jali_context *limited;
        jali_status status = jali_context_create(&opt, &limited);
        if (status == JALI_OK) {
            status = body(limited, data);
            jali_context_free(limited);
        }
        CHECK_INT(r.outstanding, 0);
        if (r.request < refuse_at) {
            CHECK_INT(status, JALI_OK);
            return;
        }
        CHECK_INT(status, JALI_NO_MEMORY);
    }
}

static inline void refuse_each_allocation(jali_status (*body)(jali_context *limited, void *data), void *data)
{
    refuse_allocations(body, data, 1);
}

#endif
