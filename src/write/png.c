// PNG: one bit a pixel straight from a bitmap, or 8-bit grey levels or colours.
//
// libpng allocates from the context and leaves errors by longjmp; they end as a status. No time, no text: the
// same pixels give the same bytes.
//
// Checked: tests/test_read.c and tests/test_write.c: what is written is read back, at many widths.
#include <jali/png.h>

#include "base/bytes.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>

// A mask of 2800 x 2800 px: 6 ms and 80 KB; by zlib's usual level 6 20 ms and 69 KB.
enum { BITMAP_LEVEL = 4 };

typedef struct png_job {
    jali_context *ctx;
    jali_bytes *bytes;
    jali_status status; // why libpng was left; its sentence is set
    int32_t width_px, height_px;
    const jali_bitmap *bitmap; // or
    const uint8_t *samples;    // 8 bits each, `channels` a pixel
    int32_t channels;          // 1 or 3
    double pixel_mm;
} png_job;

static void on_error(png_structp png, png_const_charp message)
{
    png_job *job = png_get_error_ptr(png);
    if (job->status == JALI_OK)
        job->status = fail(job->ctx, JALI_BAD_VALUE, "cannot write the PNG: %s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

static png_voidp on_allocate(png_structp png, png_alloc_size_t size)
{
    png_job *job = png_get_mem_ptr(png);
    void *block;
    jali_status status = allocate_array(job->ctx, &block, size, 1);
    if (status != JALI_OK) job->status = status;
    return block;
}

static void on_release(png_structp png, png_voidp block)
{
    release(((png_job *)png_get_mem_ptr(png))->ctx, block);
}

static void on_write(png_structp png, png_bytep data, size_t size)
{
    png_job *job = png_get_io_ptr(png);
    job->status = bytes_append(job->ctx, job->bytes, data, size);
    if (job->status != JALI_OK) png_error(png, "stopped");
}

static void on_flush(png_structp png)
{
    (void)png;
}

static void write_rows(png_job *job, png_structp png)
{
    for (int32_t y = 0; y < job->height_px; y++) {
        if (y % 256 == 0) {
            job->status = step(job->ctx, "write", (double)y / job->height_px);
            if (job->status != JALI_OK) png_error(png, "stopped");
        }
        // The bytes of little-endian words run as the pixels do, the bits within a byte the other way round.
        png_write_row(png, job->bitmap
                               ? (png_const_bytep)(job->bitmap->word + y * job->bitmap->stride)
                               : job->samples + (size_t)y * (size_t)job->width_px * (size_t)job->channels);
    }
}

static void write_all(png_job *job, png_structp png, png_infop info)
{
    if (setjmp(png_jmpbuf(png))) return;
    png_set_write_fn(png, job, on_write, on_flush);
    png_set_user_limits(png, 1 << 20, 1 << 20);
    bool grey = job->bitmap || job->channels == 1;
    png_set_IHDR(png, info, (png_uint_32)job->width_px, (png_uint_32)job->height_px, job->bitmap ? 1 : 8,
                 grey ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (job->bitmap) {
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
        png_set_compression_level(png, BITMAP_LEVEL);
    }
    double pixels_per_metre = job->pixel_mm > 0 ? 1000 / job->pixel_mm : 0;
    if (pixels_per_metre >= 1 && pixels_per_metre < INT32_MAX)
        png_set_pHYs(png, info, (png_uint_32)lround(pixels_per_metre), (png_uint_32)lround(pixels_per_metre),
                     PNG_RESOLUTION_METER);
    png_write_info(png, info);
    if (job->bitmap) png_set_packswap(png);
    write_rows(job, png);
    png_write_end(png, info);
}

static jali_status write_png(png_job *job)
{
    if (job->width_px < 1 || job->height_px < 1 || job->width_px > 1 << 20 || job->height_px > 1 << 20)
        return fail(job->ctx, JALI_BAD_VALUE,
                    "a PNG of %d x %d px cannot be written; a side is 1 .. 1048576 px", job->width_px,
                    job->height_px);
    png_structp png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job,
                                                on_allocate, on_release);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (info)
        write_all(job, png, info);
    else if (job->status == JALI_OK)
        job->status = fail(job->ctx, JALI_NO_MEMORY, "no memory for the PNG");
    png_destroy_write_struct(&png, &info);
    return job->status;
}

jali_status jali_bitmap_png(jali_context *ctx, const jali_bitmap *bitmap, double pixel_mm, jali_bytes *bytes)
{
    png_job job = {.ctx = ctx,
                   .bytes = bytes,
                   .width_px = bitmap->width_px,
                   .height_px = bitmap->height_px,
                   .bitmap = bitmap,
                   .pixel_mm = pixel_mm};
    return write_png(&job);
}

static jali_status samples_png(jali_context *ctx, int32_t width_px, int32_t height_px, const uint8_t *samples,
                               int32_t channels, jali_bytes *bytes)
{
    png_job job = {.ctx = ctx,
                   .bytes = bytes,
                   .width_px = width_px,
                   .height_px = height_px,
                   .samples = samples,
                   .channels = channels};
    return write_png(&job);
}

jali_status jali_rgb_png(jali_context *ctx, int32_t width_px, int32_t height_px, const uint8_t *rgb,
                         jali_bytes *bytes)
{
    return samples_png(ctx, width_px, height_px, rgb, 3, bytes);
}

jali_status jali_grey_png(jali_context *ctx, int32_t width_px, int32_t height_px, const uint8_t *grey,
                          jali_bytes *bytes)
{
    return samples_png(ctx, width_px, height_px, grey, 1, bytes);
}
