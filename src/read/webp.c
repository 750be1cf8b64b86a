// WebP through libwebp: lossy, lossless, with and without alpha.
//
// Limits:  animations are refused; sides end at 16,383 px by the format. libwebp allocates by itself; its
//          lossless working copy (4 bytes a pixel) is booked with the context as an untouched block.
// Checked: tests/test_read.c, fuzz/fuzz_webp.c.
#include "read/read.h"

#include <webp/decode.h>

static jali_status refused(jali_context *ctx, const source *from, VP8StatusCode code)
{
    switch (code) {
    case VP8_STATUS_OUT_OF_MEMORY:
        return fail(ctx, JALI_NO_MEMORY, "%s: no memory for the WebP reader", from->name);
    case VP8_STATUS_NOT_ENOUGH_DATA:
    case VP8_STATUS_SUSPENDED:
        return fail(ctx, JALI_BAD_INPUT, "%s: the WebP is truncated: it ends after %zu bytes", from->name,
                    from->size);
    case VP8_STATUS_UNSUPPORTED_FEATURE:
        return fail(ctx, JALI_BAD_INPUT, "%s: the WebP uses a feature that libwebp does not read",
                    from->name);
    default: return fail(ctx, JALI_BAD_INPUT, "%s: the WebP is corrupt", from->name);
    }
}

static jali_status decode_colours(jali_context *ctx, const source *from, WebPDecoderConfig *config,
                                  uint8_t *colours, size_t size)
{
    config->output.colorspace = MODE_RGBA;
    config->output.is_external_memory = 1;
    config->output.u.RGBA.rgba = colours;
    config->output.u.RGBA.stride = config->input.width * 4;
    config->output.u.RGBA.size = size;
    VP8StatusCode code = WebPDecode(from->bytes, from->size, config);
    WebPFreeDecBuffer(&config->output);
    return code == VP8_STATUS_OK ? JALI_OK : refused(ctx, from, code);
}

jali_status decode_webp(jali_context *ctx, const source *from, jali_picture *picture)
{
    enum { LOSSLESS = 2, CHANNELS = 4 };
    jali_status status;
    WebPDecoderConfig config;
    uint8_t *colours = NULL;
    uint32_t *booked = NULL;
    if (!WebPInitDecoderConfig(&config))
        return fail(ctx, JALI_BAD_INPUT, "%s: libwebp is another version", from->name);
    VP8StatusCode code = WebPGetFeatures(from->bytes, from->size, &config.input);
    if (code != VP8_STATUS_OK) return refused(ctx, from, code);
    if (config.input.has_animation)
        return fail(ctx, JALI_BAD_INPUT, "%s: this WebP is an animation; a single picture is needed",
                    from->name);
    int64_t width = config.input.width, height = config.input.height;
    TRY(picture_of_size(ctx, from, (uint64_t)width, (uint64_t)height, 0, picture));
    TRY(ALLOCATE(ctx, colours, width * height * CHANNELS));
    if (config.input.format == LOSSLESS) TRY(ALLOCATE(ctx, booked, width * height));
    TRY(decode_colours(ctx, from, &config, colours, (size_t)(width * height * CHANNELS)));
    for (int64_t y = 0; y < height; y++)
        grey_row(colours + y * width * CHANNELS, CHANNELS, (int32_t)width, picture->grey + y * width);
    status = step(ctx, "read", 1);
done:
    release(ctx, booked);
    release(ctx, colours);
    if (status != JALI_OK) jali_picture_free(ctx, picture);
    return status;
}
