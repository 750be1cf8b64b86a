// What the fuzzers of whole runs share: bytes as a picture, and files that read back.
#ifndef FUZZ_DRAWN_H
#define FUZZ_DRAWN_H

#include "model.h"

#include <jali/jali.h>

/// A bit a pixel; missing ones repeat a noise of the last byte. free() it.
static inline uint8_t *grey_of(const uint8_t *data, size_t size, int32_t width, int32_t height)
{
    uint8_t *grey = malloc((size_t)width * (size_t)height);
    uint32_t noise = size ? data[size - 1] : 0;
    for (int32_t i = 0; i < width * height; i++) {
        noise = noise * 1664525 + 1013904223;
        bool white = (size_t)(i / 8) < size ? data[i / 8] >> i % 8 & 1 : noise >> 31;
        grey[i] = white ? 255 : 0;
    }
    return grey;
}

/// How a fuzzer of whole runs reads its bytes: parameters first, the first two of them the picture's sides.
typedef struct drawn_run {
    int32_t parameters, most_side_px;
    jali_options (*settings)(const uint8_t *parameter, int32_t width_px, int32_t height_px);
    void (*require)(jali_context *ctx, const jali_options *opt,
                    const jali_result *r); // of a run that ends well
} drawn_run;

/// Make what the bytes say. Refused, it has a sentence and leaves nothing. The last parameter picks 1 to 3
/// threads.
static inline int run_drawn(const drawn_run *run, const uint8_t *data, size_t size)
{
    size_t head = (size_t)run->parameters;
    if (size < head) return -1;
    jali_context_options own = jali_context_defaults();
    own.threads = 1 + data[head - 1] % 3;
    own.max_memory_bytes = (uint64_t)1 << 30;
    jali_context *ctx;
    REQUIRE(jali_context_create(&own, &ctx) == JALI_OK);
    int32_t width = 1 + data[0] % run->most_side_px, height = 1 + data[1] % run->most_side_px;
    jali_picture picture = {
        .width_px = width, .height_px = height, .grey = grey_of(data + head, size - head, width, height)};
    jali_options opt = run->settings(data, width, height);
    jali_result result;
    jali_status status = jali_make(ctx, &picture, &opt, &result);
    if (status == JALI_OK)
        run->require(ctx, &opt, &result);
    else {
        REQUIRE(status == JALI_BAD_INPUT || status == JALI_BAD_VALUE || status == JALI_NO_RESULT ||
                status == JALI_LIMIT);
        REQUIRE(strlen(jali_message(ctx)) > 0);
        REQUIRE(result.mesh.vertex == NULL && result.optimised.mask.word == NULL &&
                result.strength.sheet.node == NULL);
    }
    jali_result_free(ctx, &result);
    free(picture.grey);
    jali_context_free(ctx);
    return 0;
}

static inline void require_read_back(jali_context *ctx, const jali_mesh *mesh, jali_format format)
{
    jali_bytes bytes = {0};
    jali_write_options plain_file = {.no_thumbnail = true};
    REQUIRE(jali_write_bytes(ctx, format, &(jali_product){.mesh = mesh}, &plain_file, &bytes) == JALI_OK);
    REQUIRE(jali_check_readback(ctx, bytes.data, bytes.size, mesh) == JALI_OK);
    jali_bytes_free(ctx, &bytes);
}

#endif
