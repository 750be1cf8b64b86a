// Read a picture and decide which of its pixels are white.
#ifndef JALI_READ_H
#define JALI_READ_H

#include <jali/bitmap.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Grey levels, 0 = black .. 255 = white. {0} is valid and empty. Row 0 is the top row.
typedef struct jali_picture {
    int32_t width_px, height_px;
    uint8_t *grey;      // [height_px * width_px]
    int32_t file_px[2]; // width and height before crop and turn; 0 when it was not read from a file
} jali_picture;

JALI_API void jali_picture_free(jali_context *ctx, jali_picture *picture);

/// What is done to a picture on its way in, in this order: crop, turn, mirror, invert.
typedef struct jali_read_options {
    uint64_t max_px;       // refuse more pixels than this, 1 .. 2^29 (default); sides end at 65,500 px
    int32_t crop_px[4];    // left, top, width, height of the part to keep; all 0 (default) = everything
    int32_t quarter_turns; // clockwise, 0 (default) .. 3
    bool mirror;           // swap left and right
    bool invert;           // swap black and white
} jali_read_options;

JALI_API jali_read_options jali_read_defaults(void);

/// Read a picture file: PNG of every depth and type, JPEG (EXIF orientation respected), WebP, PBM, PGM, PPM
/// (P1 to P6). The type is told by the first bytes. Colour becomes grey by the Rec. 709 weights, alpha is
/// laid over white, 16 bits are rounded to 8.
///   in     path     "-" is the standard input
///          opt      NULL means the defaults
///   out    picture  free with jali_picture_free
///   fails  JALI_BAD_INPUT (empty, truncated, corrupt, too large, another type), JALI_IO, JALI_BAD_VALUE,
///          JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   one byte a pixel and the file; libjpeg (progressive) and libwebp take up to 6 and 8 bytes a pixel
JALI_API jali_status jali_read(jali_context *ctx, const char *path, const jali_read_options *opt,
                               jali_picture *picture);

/// The same from memory; `name` stands in the messages.
JALI_API jali_status jali_read_bytes(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                                     const jali_read_options *opt, jali_picture *picture);

typedef enum jali_threshold_method {
    JALI_THRESHOLD_AUTO, // Otsu's split of the histogram, halfway between the means of its two parts
    JALI_THRESHOLD_FIXED,
    JALI_THRESHOLD_LOCAL // Sauvola's: follows uneven light, for photographs and scans
} jali_threshold_method;

typedef struct jali_threshold_options {
    jali_threshold_method method;
    int32_t level;     // FIXED: 0 .. 255, white is grey >= level; more = darker picture. Default 128
    int32_t window_px; // LOCAL: side of the neighbourhood, 3 .. 4,001; 0 (default) = 1/16 of the shorter side
    double contrast;   // LOCAL: 0 .. 1, default 0.2; more = only strong edges count, flat parts stay white
} jali_threshold_options;

JALI_API jali_threshold_options jali_threshold_defaults(void);

/// Find the level at and above which a pixel is white. LOCAL rewrites the picture as the distance from its
/// local threshold, 128 at the edge, so that edges keep their place between pixels.
///   in     opt        NULL means the defaults
///   inout  picture    changed by LOCAL only
///   out    threshold  1 .. 255
///   fails  JALI_BAD_INPUT (all of one tone; the message says which levels would not be), JALI_BAD_VALUE,
///          JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(pixels); LOCAL needs a second byte a pixel
JALI_API jali_status jali_threshold(jali_context *ctx, jali_picture *picture,
                                    const jali_threshold_options *opt, int32_t *threshold);

/// How many pixels have each grey level, and where JALI_THRESHOLD_AUTO would put the threshold.
typedef struct jali_levels {
    uint64_t count[256];
    int32_t automatic; // 1 .. 255; 0 when there is one level alone, which no threshold parts
} jali_levels;

/// Count a picture's grey levels.
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(pixels)
JALI_API jali_status jali_count_levels(jali_context *ctx, const jali_picture *picture, jali_levels *levels);

/// The picture in black and white at its own resolution: white is grey >= threshold.
JALI_API jali_status jali_binarise(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                                   jali_bitmap *bitmap);

#ifdef __cplusplus
}
#endif
#endif
