// PNG from a bitmap, through libpng: one bit a pixel, no time stamp, always the same bytes.
//
// Checked: tests/test_read.c: what is written is read back, at every width from 1 to 200.
#include <jali/png.h>
#include "base/bytes.h"

#include <png.h>
#include <setjmp.h>

enum { ZLIB_LEVEL = 6 };

typedef struct png_job {
    jali_context *ctx;
    const jali_bitmap *bitmap;
    double pixel_mm;
    jali_bytes *bytes;
    jali_status status;
    png_structp png;
    png_infop info;
    uint8_t *row;  // [stride * 8]
} png_job;

static void on_error(png_structp png, png_const_charp message)
{
    png_job *job = png_get_error_ptr(png);
    if (job->status == JALI_OK) job->status = fail(job->ctx, JALI_NO_MEMORY, "PNG: %s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_voidp on_allocate(png_structp png, png_alloc_size_t bytes)
{
    png_job *job = png_get_mem_ptr(png);
    void *block;
    jali_status status = allocate_array(job->ctx, &block, bytes, 1);
    if (status != JALI_OK) job->status = status;
    return block;
}

static void on_release(png_structp png, png_voidp block)
{
    png_job *job = png_get_mem_ptr(png);
    release(job->ctx, block);
}

static void stop_unless_ok(png_job *job, jali_status status)
{
    if (status == JALI_OK) return;
    job->status = status;
    png_error(job->png, "stopped");
}

static void on_write(png_structp png, png_bytep data, size_t size)
{
    png_job *job = png_get_io_ptr(png);
    stop_unless_ok(job, bytes_append(job->ctx, job->bytes, data, size));
}

static void on_flush(png_structp png)
{
    (void)png;
}

static uint8_t reversed(uint8_t byte)
{
    byte = (uint8_t)(byte >> 4 | byte << 4);
    byte = (uint8_t)((byte >> 2 & 0x33) | (byte & 0x33) << 2);
    return (uint8_t)((byte >> 1 & 0x55) | (byte & 0x55) << 1);
}

// PNG's first pixel is the highest bit of the first byte, ours the lowest bit of the word.
static void pack_row(const uint64_t *word, int32_t width, uint8_t *row)
{
    for (int32_t i = 0; i < (width + 7) / 8; i++) row[i] = reversed((uint8_t)(word[i >> 3] >> (i & 7) * 8));
}

static void write_rows(png_job *job)
{
    const jali_bitmap *bitmap = job->bitmap;
    png_set_IHDR(job->png, job->info, (png_uint_32)bitmap->width_px, (png_uint_32)bitmap->height_px, 1,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (job->pixel_mm > 0) {
        png_uint_32 px_a_metre = (png_uint_32)(1000 / job->pixel_mm + 0.5);
        png_set_pHYs(job->png, job->info, px_a_metre, px_a_metre, PNG_RESOLUTION_METER);
    }
    png_write_info(job->png, job->info);
    for (int32_t y = 0; y < bitmap->height_px; y++) {
        if (y % 256 == 0) stop_unless_ok(job, step(job->ctx, "write", (double)y / bitmap->height_px));
        pack_row(bitmap->word + (int64_t)y * bitmap->stride, bitmap->width_px, job->row);
        png_write_row(job->png, job->row);
    }
    png_write_end(job->png, NULL);
}

// setjmp stands alone in its frame: nothing local changes between it and the longjmp.
static void run(png_job *job)
{
    if (setjmp(png_jmpbuf(job->png))) return;
    png_set_write_fn(job->png, job, on_write, on_flush);
    png_set_user_limits(job->png, 0x7fffffff, 0x7fffffff);
    png_set_compression_level(job->png, ZLIB_LEVEL);
    png_set_filter(job->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    write_rows(job);
}

jali_status jali_bitmap_png(jali_context *ctx, const jali_bitmap *bitmap, double pixel_mm, jali_bytes *bytes)
{
    jali_status status;
    png_job *job = NULL;
    if (bitmap->width_px < 1 || bitmap->height_px < 1)
        return fail(ctx, JALI_BAD_VALUE, "a PNG needs at least one pixel");
    TRY(ALLOCATE_CLEARED(ctx, job, 1));
    job->ctx = ctx;
    job->bitmap = bitmap;
    job->pixel_mm = pixel_mm;
    job->bytes = bytes;
    TRY(ALLOCATE(ctx, job->row, bitmap->stride * 8));
    job->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job, on_allocate,
                                         on_release);
    if (job->png) job->info = png_create_info_struct(job->png);
    if (job->info)
        run(job);
    else if (job->status == JALI_OK)
        job->status = fail(ctx, JALI_NO_MEMORY, "no memory for the PNG writer");
    png_destroy_write_struct(&job->png, &job->info);
    status = job->status;
done:
    if (job) release(ctx, job->row);
    release(ctx, job);
    return status;
}
