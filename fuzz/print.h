// What a print that was read must satisfy, whatever the bytes were.
#ifndef FUZZ_PRINT_H
#define FUZZ_PRINT_H

#include <jali/compare.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REQUIRE(condition)                                                                                   \
    do {                                                                                                     \
        if (!(condition)) abort();                                                                           \
    } while (0)

static inline jali_context *fuzz_context(void)
{
    jali_context *ctx;
    jali_context_options opt = jali_context_defaults();
    opt.threads = 1;
    opt.max_memory_bytes = (uint64_t)1 << 28;
    REQUIRE(jali_context_create(&opt, &ctx) == JALI_OK);
    return ctx;
}

/// Refused with a sentence and an empty print; or layers in order, a size, and something solid within it.
static inline void require_print(jali_context *ctx, jali_status status, const jali_print *p)
{
    if (status != JALI_OK) {
        REQUIRE(p->solid.word == NULL && strlen(jali_message(ctx)) > 0);
        return;
    }
    REQUIRE(p->solid.width_px > 0 && p->solid.height_px > 0 && p->pixel_mm[0] > 0 && p->pixel_mm[1] > 0);
    REQUIRE(0 <= p->first && p->first <= p->last && p->last < p->layers);
    REQUIRE(1 <= p->looked_at && p->looked_at <= p->last - p->first + 1);
    const int32_t side[2] = {p->solid.width_px, p->solid.height_px};
    for (int k = 0; k < 2; k++)
        REQUIRE(isfinite(p->size_mm[k]) && p->size_mm[k] >= 0 && p->size_mm[k] <= side[k] * p->pixel_mm[k]);
    uint64_t beyond = 0; // bits at and beyond the width
    for (int32_t y = 0; y < p->solid.height_px && p->solid.width_px % 64; y++)
        beyond |= p->solid.word[y * p->solid.stride + p->solid.width_px / 64] >> (p->solid.width_px % 64);
    REQUIRE(beyond == 0);
}

#endif
