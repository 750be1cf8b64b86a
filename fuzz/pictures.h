// What the fuzzers of the picture readers share: read the bytes as one format and check the result, not only
// survival: a picture has as many grey levels as its sizes say, a refusal has a sentence and no picture.
#ifndef FUZZ_PICTURES_H
#define FUZZ_PICTURES_H

#include <jali/read.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline void require(bool truth, const char *what)
{
    if (truth) return;
    fprintf(stderr, "broken: %s\n", what);
    abort();
}

static inline void require_picture(jali_context *ctx, jali_picture *picture, uint64_t most_px)
{
    uint64_t sum = 0, count = (uint64_t)picture->width_px * (uint64_t)picture->height_px;
    int32_t threshold;
    require(picture->width_px > 0 && picture->height_px > 0 && count <= most_px, "size");
    for (uint64_t i = 0; i < count; i++) sum += picture->grey[i]; // every level is there to be read
    require(sum <= 255 * count, "levels");
    if (jali_threshold(ctx, picture, NULL, &threshold) == JALI_OK)
        require(threshold >= 1 && threshold <= 255, "threshold");
}

/// Bytes that do not begin with `magic` are passed over, so that each fuzzer stays with its reader.
static inline int fuzz_reader(const uint8_t *data, size_t size, const char *magic, size_t magic_size)
{
    enum { MEMORY_BYTES = 256 << 20, MOST_PX = 1 << 20 };
    jali_context_options own = jali_context_defaults();
    jali_read_options opt = jali_read_defaults();
    jali_context *ctx;
    jali_picture picture;
    own.threads = 1;
    own.max_memory_bytes = MEMORY_BYTES;
    opt.max_px = MOST_PX;
    if (size < magic_size || memcmp(data, magic, magic_size) != 0) return 0;
    if (jali_context_create(&own, &ctx) != JALI_OK) return 0;
    jali_status status = jali_read_bytes(ctx, data, size, "fuzz", &opt, &picture);
    if (status == JALI_OK)
        require_picture(ctx, &picture, MOST_PX);
    else {
        require(picture.grey == NULL && picture.width_px == 0, "a refused picture is empty");
        require(strlen(jali_message(ctx)) > 0, "a refusal has a sentence");
        require(status == JALI_BAD_INPUT || status == JALI_LIMIT || status == JALI_NO_MEMORY, "status");
    }
    jali_picture_free(ctx, &picture);
    jali_context_free(ctx);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
