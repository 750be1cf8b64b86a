// What the picture readers share. Internal to the stage read.
#ifndef READ_READ_H
#define READ_READ_H

#include <jali/read.h>
#include "base/base.h"

enum { MAX_SIDE_PX = 65500 }; // libjpeg's own limit; each side fits the working grid many times over

/// A file in memory, its name for messages, and the most pixels that may be made of it.
typedef struct source {
    const uint8_t *bytes;
    size_t size;
    const char *name;
    uint64_t max_px;
} source;

// One decoder a format. On failure the picture is empty and the sentence is set.
jali_status decode_png(jali_context *ctx, const source *from, jali_picture *picture);
jali_status decode_jpeg(jali_context *ctx, const source *from, jali_picture *picture);
jali_status decode_webp(jali_context *ctx, const source *from, jali_picture *picture);
jali_status decode_pnm(jali_context *ctx, const source *from, jali_picture *picture);

/// Check the size a header claims, then make room for that many pixels.
///   in     fewest_bytes   what a file of that many pixels cannot be shorter than: a bomb fails here
jali_status picture_of_size(jali_context *ctx, const source *from, uint64_t width, uint64_t height,
                            uint64_t fewest_bytes, jali_picture *picture);

jali_status crop_picture(jali_context *ctx, jali_picture *picture, const int32_t crop_px[4]);
jali_status turn_picture(jali_context *ctx, jali_picture *picture, int32_t quarter_turns);
void mirror_picture(jali_picture *picture);
void invert_picture(jali_picture *picture);

/// Luma of samples of up to 16 bits by the Rec. 709 weights 0.2126, 0.7152, 0.0722, rounded.
static inline uint32_t luma(uint32_t red, uint32_t green, uint32_t blue)
{
    return (13933 * red + 46871 * green + 4732 * blue + 32768) >> 16;
}

/// A sample of 0 .. top laid over white with alpha 0 .. top; top is 255 or 65535.
static inline uint32_t over_white(uint32_t sample, uint32_t alpha, uint32_t top)
{
    return top - (uint32_t)(((uint64_t)(top - sample) * alpha + top / 2) / top);
}

/// A sample of 0 .. top as a grey level of 0 .. 255, rounded.
static inline uint8_t to_grey(uint32_t sample, uint32_t top)
{
    return (uint8_t)((sample * 255 + top / 2) / top);
}

/// A row of 8-bit samples, 1 to 4 a pixel (grey, grey + alpha, RGB, RGB + alpha), to grey.
void grey_row(const uint8_t *samples, int32_t channels, int32_t width, uint8_t *grey);

#endif
