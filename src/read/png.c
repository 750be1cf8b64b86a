// PNG of every depth and type, through libpng.
//
// What has at most 256 levels (grey up to 8 bits, palettes) goes through a table of grey levels, transparency
// included; the rest goes through sample arithmetic. libpng allocates from the context; its errors come back
// by longjmp and end as a status, its warnings are not shown.
//
// Limits:  deflate never packs better than 1032 : 1; a header that would need more is refused (read.h).
// Checked: tests/test_read.c, fuzz/fuzz_png.c.
#include "read/read.h"

#include <png.h>
#include <setjmp.h>

enum { DEFLATE_BEST_RATIO = 1032 };

typedef struct png_job {
    jali_context *ctx;
    const source *from;
    size_t at;
    jali_status status; // why libpng was left; its sentence is set
    png_structp png;
    png_infop info;
    jali_picture *picture;
    uint8_t *packed; // [row_bytes], or [height * row_bytes] when interlaced
    size_t row_bytes;
    int32_t depth, channels;
    bool by_table, interlaced;
    uint8_t level[256];     // by_table: the grey level of each sample value
    uint8_t pixels[256][8]; // by_table and depth < 8: the grey levels of the pixels packed in a byte
} png_job;

static void on_error(png_structp png, png_const_charp message)
{
    png_job *job = png_get_error_ptr(png);
    if (job->status == JALI_OK)
        job->status = fail(job->ctx, JALI_BAD_INPUT, "%s: the PNG is corrupt: %s", job->from->name, message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_read(png_structp png, png_bytep to, size_t wanted)
{
    png_job *job = png_get_io_ptr(png);
    if (wanted > job->from->size - job->at) {
        job->status = fail(job->ctx, JALI_BAD_INPUT, "%s: the PNG is truncated: it ends after %zu bytes",
                           job->from->name, job->from->size);
        png_error(png, "truncated");
    }
    memcpy(to, job->from->bytes + job->at, wanted);
    job->at += wanted;
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

static void fill_levels(png_job *job, bool palette, int32_t depth)
{
    png_colorp colour = NULL;
    png_bytep alpha = NULL;
    png_color_16p clear = NULL;
    int colours = 0, alphas = 0;
    png_get_tRNS(job->png, job->info, &alpha, &alphas, &clear);
    if (palette) {
        png_get_PLTE(job->png, job->info, &colour, &colours);
        for (int i = 0; i < colours && i < 256; i++) {
            uint32_t sample = luma(colour[i].red, colour[i].green, colour[i].blue);
            job->level[i] = (uint8_t)over_white(sample, alpha && i < alphas ? alpha[i] : 255, 255);
        }
        return;
    }
    uint32_t top = (1u << depth) - 1;
    for (uint32_t i = 0; i <= top; i++) job->level[i] = to_grey(i, top);
    if (clear) job->level[clear->gray & top] = 255;
}

// The first pixel of a byte stands in its highest bits.
static void fill_pixels(png_job *job)
{
    int32_t depth = job->depth, count = 8 / depth;
    for (int32_t byte = 0; byte < 256; byte++)
        for (int32_t i = 0; i < count; i++)
            job->pixels[byte][i] = job->level[(byte >> (8 - depth * (i + 1))) & ((1 << depth) - 1)];
}

static void read_header(png_job *job)
{
    png_uint_32 width, height;
    int depth, type, interlace;
    png_read_info(job->png, job->info);
    png_get_IHDR(job->png, job->info, &width, &height, &depth, &type, &interlace, NULL, NULL);
    bool palette = type == PNG_COLOR_TYPE_PALETTE, grey = type == PNG_COLOR_TYPE_GRAY;
    job->interlaced = interlace != PNG_INTERLACE_NONE;
    job->by_table = palette || (grey && depth <= 8);
    if (job->by_table)
        fill_levels(job, palette, depth);
    else if (png_get_valid(job->png, job->info, PNG_INFO_tRNS))
        png_set_tRNS_to_alpha(job->png);
    if (job->interlaced) png_set_interlace_handling(job->png);
    uint64_t packed_bytes = png_get_rowbytes(job->png, job->info) * (uint64_t)height;
    stop_unless_ok(job, picture_of_size(job->ctx, job->from, width, height, packed_bytes / DEFLATE_BEST_RATIO,
                                        job->picture));
    png_read_update_info(job->png, job->info);
    job->row_bytes = png_get_rowbytes(job->png, job->info);
    job->channels = png_get_channels(job->png, job->info);
    job->depth = depth;
    if (job->by_table && depth < 8) fill_pixels(job);
    stop_unless_ok(job, ALLOCATE(job->ctx, job->packed, job->row_bytes * (job->interlaced ? height : 1)));
}

static void grey_of_packed_row(const png_job *job, const uint8_t *packed, int32_t width, uint8_t *grey)
{
    int32_t count = 8 / job->depth, whole = width / count;
    switch (job->depth) { // a copy of constant size is one store
    case 1:
        for (int32_t i = 0; i < whole; i++) memcpy(grey + 8 * i, job->pixels[packed[i]], 8);
        break;
    case 2:
        for (int32_t i = 0; i < whole; i++) memcpy(grey + 4 * i, job->pixels[packed[i]], 4);
        break;
    default:
        for (int32_t i = 0; i < whole; i++) memcpy(grey + 2 * i, job->pixels[packed[i]], 2);
        break;
    }
    if (width % count) memcpy(grey + count * whole, job->pixels[packed[whole]], (size_t)(width % count));
}

static uint32_t sample_of_16_bits(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 8 | bytes[1];
}

static void grey_of_16_bit_row(const uint8_t *row, int32_t channels, int32_t width, uint8_t *grey)
{
    for (int32_t x = 0; x < width; x++, row += 2 * channels) {
        uint32_t sample = sample_of_16_bits(row), alpha = 65535;
        if (channels >= 3) sample = luma(sample, sample_of_16_bits(row + 2), sample_of_16_bits(row + 4));
        if (channels % 2 == 0) alpha = sample_of_16_bits(row + 2 * (channels - 1));
        grey[x] = to_grey(over_white(sample, alpha, 65535), 65535);
    }
}

static void grey_of_row(const png_job *job, const uint8_t *row, int32_t width, uint8_t *grey)
{
    if (job->by_table && job->depth < 8)
        grey_of_packed_row(job, row, width, grey);
    else if (job->by_table)
        for (int32_t x = 0; x < width; x++) grey[x] = job->level[row[x]];
    else if (job->depth == 16)
        grey_of_16_bit_row(row, job->channels, width, grey);
    else
        grey_row(row, job->channels, width, grey);
}

static void report(png_job *job, int32_t rows_done)
{
    if (rows_done % 256 == 0)
        stop_unless_ok(job, step(job->ctx, "read", (double)rows_done / job->picture->height_px));
}

static void read_rows(png_job *job)
{
    int64_t width = job->picture->width_px;
    for (int32_t y = 0; y < job->picture->height_px; y++) {
        png_read_row(job->png, job->packed, NULL);
        grey_of_row(job, job->packed, (int32_t)width, job->picture->grey + y * width);
        report(job, y);
    }
}

static void read_interlaced(png_job *job)
{
    int64_t width = job->picture->width_px, height = job->picture->height_px;
    for (int32_t pass = 0; pass < 7; pass++)
        for (int32_t y = 0; y < height; y++) {
            png_read_row(job->png, job->packed + (size_t)y * job->row_bytes, NULL);
            report(job, y);
        }
    for (int32_t y = 0; y < height; y++)
        grey_of_row(job, job->packed + (size_t)y * job->row_bytes, (int32_t)width,
                    job->picture->grey + y * width);
}

// setjmp stands alone in its frame: nothing local changes between it and the longjmp.
static void run(png_job *job)
{
    if (setjmp(png_jmpbuf(job->png))) return;
    png_set_read_fn(job->png, job, on_read);
    png_set_user_limits(job->png, 0x7fffffff, 0x7fffffff); // ours are checked in picture_of_size
    read_header(job);
    if (job->interlaced)
        read_interlaced(job);
    else
        read_rows(job);
    png_read_end(job->png, NULL);
}

jali_status decode_png(jali_context *ctx, const source *from, jali_picture *picture)
{
    jali_status status;
    png_job *job = NULL;
    TRY(ALLOCATE_CLEARED(ctx, job, 1));
    job->ctx = ctx;
    job->from = from;
    job->picture = picture;
    job->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job, on_allocate,
                                        on_release);
    if (job->png) job->info = png_create_info_struct(job->png);
    if (job->info)
        run(job);
    else if (job->status == JALI_OK)
        job->status = fail(ctx, JALI_NO_MEMORY, "%s: no memory for the PNG reader", from->name);
    png_destroy_read_struct(&job->png, &job->info, NULL);
    status = job->status;
    release(ctx, job->packed);
done:
    release(ctx, job);
    if (status != JALI_OK) jali_picture_free(ctx, picture);
    return status;
}
