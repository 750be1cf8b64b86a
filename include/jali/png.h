// A bitmap, or grey levels or colours, as a PNG file in memory.
#ifndef JALI_PNG_H
#define JALI_PNG_H

#include <jali/bitmap.h>
#include <jali/bytes.h>

#ifdef __cplusplus
extern "C" {
#endif

/// One bit a pixel; the same bytes for the same bitmap.
///   in     pixel_mm  written into the file, so that programs know the size; 0 = unknown
///   out    png       appended to
///   fails  JALI_BAD_VALUE (no pixels), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   O(words)
JALI_API jali_status jali_bitmap_png(jali_context *ctx, const jali_bitmap *bitmap, double pixel_mm,
                                     jali_bytes *png);

/// Append a PNG file of 8-bit colours: maps, overlays, thumbnails.
///   in     rgb    [height_px][width_px][3], rows from the top
///   fails  JALI_BAD_VALUE (a side outside 1 .. 2^20 px), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_rgb_png(jali_context *ctx, int32_t width_px, int32_t height_px, const uint8_t *rgb,
                                  jali_bytes *bytes);

/// The same of 8-bit grey levels, [height_px][width_px].
JALI_API jali_status jali_grey_png(jali_context *ctx, int32_t width_px, int32_t height_px,
                                   const uint8_t *grey, jali_bytes *bytes);

#ifdef __cplusplus
}
#endif
#endif
