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

static inline void require_read_back(jali_context *ctx, const jali_mesh *mesh, jali_format format)
{
    jali_bytes bytes = {0};
    jali_write_options plain_file = {.no_thumbnail = true};
    REQUIRE(jali_write_bytes(ctx, format, &(jali_product){.mesh = mesh}, &plain_file, &bytes) == JALI_OK);
    REQUIRE(jali_check_readback(ctx, bytes.data, bytes.size, mesh) == JALI_OK);
    jali_bytes_free(ctx, &bytes);
}

#endif
