// Picture files made in memory by the formats' own libraries, for the tests of the readers.
#ifndef TESTS_PICTURES_H
#define TESTS_PICTURES_H

#include "testing.h"

#include <jpeglib.h>
#include <png.h>
#include <webp/encode.h>

enum { FILE_ROOM = 1 << 20 };

/// A file in memory.
typedef struct made {
    uint8_t bytes[FILE_ROOM];
    size_t size;
} made;

static made file; // large, so not on the stack; each test fills it anew

static inline void png_append(png_structp png, png_bytep data, size_t size)
{
    made *to = png_get_io_ptr(png);
    CHECK(to->size + size <= FILE_ROOM);
    memcpy(to->bytes + to->size, data, size);
    to->size += size;
}

static inline void png_flush_nothing(png_structp png)
{
    (void)png;
}

typedef struct png_kind {
    int32_t width, height;
    int depth, type;
    bool interlaced, transparent;
} png_kind;

/// Sample c of pixel (x, y): any rule will do that the tests can repeat.
static inline uint32_t sample_at(int32_t x, int32_t y, int32_t c, int depth)
{
    uint64_t seed = (uint64_t)(x * 7919 + y * 104729 + c * 1299709 + 1);
    return (uint32_t)(next_random(&seed) >> 40) & ((1u << depth) - 1);
}

static inline int32_t channels_of(int type)
{
    switch (type) {
    case PNG_COLOR_TYPE_RGB: return 3;
    case PNG_COLOR_TYPE_RGBA: return 4;
    case PNG_COLOR_TYPE_GRAY_ALPHA: return 2;
    default: return 1;
    }
}

static inline void palette_entry(int32_t i, uint8_t rgba[4])
{
    for (int32_t c = 0; c < 4; c++) rgba[c] = (uint8_t)sample_at(i, 99, c, 8);
}

static inline void set_palette(png_structp png, png_infop info, const png_kind *k)
{
    png_color colour[256];
    png_byte alpha[256];
    int count = 1 << k->depth;
    for (int32_t i = 0; i < count; i++) {
        uint8_t rgba[4];
        palette_entry(i, rgba);
        colour[i] = (png_color){rgba[0], rgba[1], rgba[2]};
        alpha[i] = rgba[3];
    }
    png_set_PLTE(png, info, colour, count);
    if (k->transparent) png_set_tRNS(png, info, alpha, count - count / 3, NULL);
}

/// The colour key is the colour of pixel (1, 1).
static inline void set_key(png_structp png, png_infop info, const png_kind *k)
{
    png_color_16 key = {0};
    key.gray = key.red = (png_uint_16)sample_at(1, 1, 0, k->depth);
    key.green = (png_uint_16)sample_at(1, 1, 1, k->depth);
    key.blue = (png_uint_16)sample_at(1, 1, 2, k->depth);
    png_set_tRNS(png, info, NULL, 0, &key);
}

static inline void make_png(const png_kind *k)
{
    static uint8_t row[64][8 * 64];
    uint8_t *rows[64];
    int32_t channels = channels_of(k->type);
    memset(row, 0, sizeof row);
    file.size = 0;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &file, png_append, png_flush_nothing);
    png_set_IHDR(png, info, (png_uint_32)k->width, (png_uint_32)k->height, k->depth, k->type,
                 k->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (k->type == PNG_COLOR_TYPE_PALETTE)
        set_palette(png, info, k);
    else if (k->transparent)
        set_key(png, info, k);
    for (int32_t y = 0; y < k->height; y++) {
        rows[y] = row[y];
        for (int32_t i = 0; i < k->width * channels; i++) {
            uint32_t sample = sample_at(i / channels, y, i % channels, k->depth);
            int32_t bit = i * k->depth;
            if (k->depth == 16) {
                row[y][2 * i] = (uint8_t)(sample >> 8);
                row[y][2 * i + 1] = (uint8_t)sample;
            } else
                row[y][bit / 8] |= (uint8_t)(sample << (8 - k->depth - bit % 8));
        }
    }
    png_write_info(png, info);
    png_write_image(png, rows);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
}

/// The grey level a pixel must have, in floating point.
static inline double grey_of(const png_kind *k, int32_t x, int32_t y)
{
    double rgba[4] = {0, 0, 0, 1}, top = (1u << k->depth) - 1;
    bool coloured = k->type & PNG_COLOR_MASK_COLOR;
    if (k->type == PNG_COLOR_TYPE_PALETTE) {
        uint8_t entry[4];
        int32_t index = (int32_t)sample_at(x, y, 0, k->depth), count = 1 << k->depth;
        palette_entry(index, entry);
        for (int32_t c = 0; c < 3; c++) rgba[c] = entry[c] / 255.0;
        if (k->transparent && index < count - count / 3) rgba[3] = entry[3] / 255.0;
    } else {
        bool key = k->transparent;
        int32_t colours = coloured ? 3 : 1;
        for (int32_t c = 0; c < 3; c++) rgba[c] = sample_at(x, y, coloured ? c : 0, k->depth) / top;
        for (int32_t c = 0; c < colours; c++)
            key &= sample_at(x, y, c, k->depth) == sample_at(1, 1, c, k->depth);
        if (k->type & PNG_COLOR_MASK_ALPHA) rgba[3] = sample_at(x, y, colours, k->depth) / top;
        if (key) rgba[3] = 0;
    }
    double grey = 0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2];
    return 255 * (1 - (1 - grey) * rgba[3]);
}

/// A JPEG of width x height whose left half is light and whose top quarter is dark; `channels` 1, 3 or 4
/// (CMYK, stored inverted as Adobe does); orientation 0 = no EXIF.
static inline void make_jpeg(int32_t width, int32_t height, int32_t channels, bool progressive,
                             int32_t orientation)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *out = NULL;
    unsigned long size = 0;
    uint8_t row[4 * 256];
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &out, &size);
    jpeg.image_width = (JDIMENSION)width;
    jpeg.image_height = (JDIMENSION)height;
    jpeg.input_components = channels;
    jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    if (channels == 4) jpeg.write_Adobe_marker = TRUE;
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    if (orientation) {
        uint8_t exif[] = {'E', 'x', 'i', 'f', 0,    0, 'M', 'M', 0, 42, 0, 0, 0,
                          8,   0,   1,   1,   0x12, 0, 3,   0,   0, 0,  1, 0, (uint8_t)orientation,
                          0,   0,   0,   0,   0,    0};
        jpeg_write_marker(&jpeg, JPEG_APP0 + 1, exif, sizeof exif);
    }
    for (int32_t y = 0; y < height; y++) {
        uint8_t *rows[1] = {row};
        for (int32_t x = 0; x < width; x++)
            for (int32_t c = 0; c < channels; c++)
                row[x * channels + c] = c == 3 ? 255 : y < height / 4 ? 40 : x < width / 2 ? 220 : 120;
        jpeg_write_scanlines(&jpeg, rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    CHECK(size <= FILE_ROOM);
    memcpy(file.bytes, out, size);
    file.size = size;
    free(out);
}

static inline void make_webp(int32_t width, int32_t height, bool lossless, bool alpha)
{
    static uint8_t pixel[256 * 256 * 4];
    uint8_t *out = NULL;
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) {
            uint8_t *p = &pixel[(y * width + x) * 4];
            p[0] = p[1] = p[2] = y < height / 4 ? 40 : x < width / 2 ? 220 : 120;
            p[3] = alpha && x % 32 < 16 ? 0 : 255;
        }
    size_t size = lossless ? WebPEncodeLosslessRGBA(pixel, width, height, 4 * width, &out)
                           : WebPEncodeRGBA(pixel, width, height, 4 * width, 95, &out);
    CHECK(size > 0 && size <= FILE_ROOM);
    memcpy(file.bytes, out, size);
    file.size = size;
    WebPFree(out);
}

#endif
