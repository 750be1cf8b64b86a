// JPEG through libjpeg: grey, colour and CMYK, baseline and progressive, turned as its EXIF data ask.
//
// libjpeg allocates by itself; the large part (the coefficients of a progressive file) is booked with the
// context as an untouched block, so that the memory limit holds and the peak is known.
//
// Limits:  a file that ends early is refused, not filled with grey; at most 100 scans (a bomb has thousands).
//          Huffman code spends a bit a block or more, a block covers at most 32 x 32 px: a header that would
//          need less is refused. Adobe's CMYK is stored inverted.
// Checked: tests/test_read.c, fuzz/fuzz_jpeg.c.
#include "read/read.h"

#include <setjmp.h>
#include <stdio.h>
#include <jpeglib.h>
#include <jerror.h>

enum { MOST_PX_A_BYTE = 8 * 16 * 4, MOST_SCANS = 100, EXIF_MARKER = JPEG_APP0 + 1 };

typedef struct jpeg_job {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf leave;
    jali_context *ctx;
    const source *from;
    jali_status status;
    jali_picture *picture;
    uint8_t *row;        // [output_width * output_components]
    void *booked;        // what libjpeg allocates by itself
    int32_t orientation; // EXIF's, 1 .. 8
} jpeg_job;

static void on_error(j_common_ptr common)
{
    jpeg_job *job = common->client_data;
    char message[JMSG_LENGTH_MAX];
    common->err->format_message(common, message);
    if (job->status == JALI_OK && common->err->msg_code == JERR_OUT_OF_MEMORY)
        job->status = fail(job->ctx, JALI_NO_MEMORY, "%s: no memory for the JPEG reader", job->from->name);
    if (job->status == JALI_OK)
        job->status = fail(job->ctx, JALI_BAD_INPUT, "%s: the JPEG is corrupt: %s", job->from->name, message);
    longjmp(job->leave, 1);
}

static void on_message(j_common_ptr common, int level)
{
    jpeg_job *job = common->client_data;
    if (level >= 0 || (common->err->msg_code != JWRN_JPEG_EOF && common->err->msg_code != JWRN_HIT_MARKER))
        return;
    if (job->status == JALI_OK)
        job->status = fail(job->ctx, JALI_BAD_INPUT,
                           "%s: the JPEG is truncated or corrupt: its data end early", job->from->name);
    longjmp(job->leave, 1);
}

static void stop_unless_ok(jpeg_job *job, jali_status status)
{
    if (status == JALI_OK) return;
    job->status = status;
    longjmp(job->leave, 1);
}

static void on_progress(j_common_ptr common)
{
    jpeg_job *job = common->client_data;
    if (job->jpeg.input_scan_number > MOST_SCANS)
        stop_unless_ok(job, fail(job->ctx, JALI_BAD_INPUT, "%s: the JPEG has more than %d scans",
                                 job->from->name, MOST_SCANS));
    if (stopping(job->ctx)) stop_unless_ok(job, step(job->ctx, "read", 0));
}

static uint32_t exif_number(const uint8_t *bytes, int32_t count, bool little)
{
    uint32_t value = 0;
    for (int32_t i = 0; i < count; i++) value = value << 8 | bytes[little ? count - 1 - i : i];
    return value;
}

// The orientation, 1 .. 8, from the first directory of the EXIF block; 1 when there is none or it is broken.
static int32_t exif_orientation(const uint8_t *exif, size_t size)
{
    enum { HEADER = 6, ENTRY = 12, ORIENTATION = 0x0112 };
    if (size < HEADER + 8 || memcmp(exif, "Exif\0\0", HEADER) != 0) return 1;
    const uint8_t *tiff = exif + HEADER;
    size -= HEADER;
    bool little = tiff[0] == 'I';
    size_t at = exif_number(tiff + 4, 4, little);
    if (at > size - 2) return 1;
    uint32_t entries = exif_number(tiff + at, 2, little);
    at += 2;
    for (uint32_t i = 0; i < entries && size - at >= ENTRY; i++, at += ENTRY) {
        uint32_t value = exif_number(tiff + at + 8, 2, little);
        if (exif_number(tiff + at, 2, little) == ORIENTATION && value >= 1 && value <= 8)
            return (int32_t)value;
    }
    return 1;
}

static int32_t find_orientation(const struct jpeg_decompress_struct *jpeg)
{
    int32_t orientation = 1;
    for (jpeg_saved_marker_ptr m = jpeg->marker_list; m && orientation == 1; m = m->next)
        if (m->marker == EXIF_MARKER) orientation = exif_orientation(m->data, m->data_length);
    return orientation;
}

// Orientations 1 .. 8 as clockwise quarter turns, then a mirror.
static jali_status lay_upright(const jpeg_job *job)
{
    static const int32_t turns[9] = {0, 0, 0, 2, 2, 1, 1, 3, 3};
    static const bool mirrored[9] = {0, 0, 1, 0, 1, 1, 0, 1, 0};
    jali_status status = turn_picture(job->ctx, job->picture, turns[job->orientation]);
    if (status == JALI_OK && mirrored[job->orientation]) mirror_picture(job->picture);
    return status;
}

static jali_status book_coefficients(jpeg_job *job)
{
    uint64_t blocks = 0;
    if (!jpeg_has_multiple_scans(&job->jpeg)) return JALI_OK;
    for (int i = 0; i < job->jpeg.num_components; i++)
        blocks += (uint64_t)job->jpeg.comp_info[i].width_in_blocks * job->jpeg.comp_info[i].height_in_blocks;
    return allocate_array(job->ctx, &job->booked, blocks, sizeof(JBLOCK));
}

static void read_header(jpeg_job *job)
{
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    jpeg_save_markers(jpeg, EXIF_MARKER, 0xffff);
    jpeg_read_header(jpeg, TRUE);
    job->orientation = find_orientation(jpeg);
    uint64_t fewest =
        jpeg->arith_code ? 0 : (uint64_t)jpeg->image_width * jpeg->image_height / MOST_PX_A_BYTE;
    stop_unless_ok(job, picture_of_size(job->ctx, job->from, jpeg->image_width, jpeg->image_height, fewest,
                                        job->picture));
    stop_unless_ok(job, book_coefficients(job));
    switch (jpeg->jpeg_color_space) {
    case JCS_GRAYSCALE: jpeg->out_color_space = JCS_GRAYSCALE; break;
    case JCS_CMYK:
    case JCS_YCCK: jpeg->out_color_space = JCS_CMYK; break;
    default: jpeg->out_color_space = JCS_RGB;
    }
    jpeg->dct_method = JDCT_ISLOW;
    jpeg_start_decompress(jpeg);
    stop_unless_ok(job, ALLOCATE(job->ctx, job->row, (size_t)jpeg->output_width * jpeg->output_components));
}

// Ink to light: each colour is what neither its own ink nor black takes away.
static void grey_of_inks(const uint8_t *inks, bool inverted, int32_t width, uint8_t *grey)
{
    uint32_t flip = inverted ? 0 : 255;
    for (int32_t x = 0; x < width; x++, inks += 4) {
        uint32_t light = inks[3] ^ flip;
        grey[x] = (uint8_t)((luma(inks[0] ^ flip, inks[1] ^ flip, inks[2] ^ flip) * light + 127) / 255);
    }
}

static void read_rows(jpeg_job *job)
{
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    int32_t width = job->picture->width_px;
    while (jpeg->output_scanline < jpeg->output_height) {
        uint8_t *grey = job->picture->grey + (int64_t)jpeg->output_scanline * width;
        jpeg_read_scanlines(jpeg, &job->row, 1);
        if (jpeg->out_color_space == JCS_CMYK)
            grey_of_inks(job->row, jpeg->saw_Adobe_marker, width, grey);
        else
            grey_row(job->row, jpeg->output_components, width, grey);
        if (jpeg->output_scanline % 256 == 0)
            stop_unless_ok(job, step(job->ctx, "read", (double)jpeg->output_scanline / jpeg->output_height));
    }
    jpeg_finish_decompress(jpeg);
}

// setjmp stands alone in its frame: nothing local changes between it and the longjmp.
static void run(jpeg_job *job)
{
    if (setjmp(job->leave)) return;
    jpeg_create_decompress(&job->jpeg);
    job->jpeg.progress = &job->progress;
    jpeg_mem_src(&job->jpeg, job->from->bytes, (unsigned long)job->from->size);
    read_header(job);
    read_rows(job);
    stop_unless_ok(job, lay_upright(job));
}

jali_status decode_jpeg(jali_context *ctx, const source *from, jali_picture *picture)
{
    jali_status status;
    jpeg_job *job = NULL;
    TRY(ALLOCATE_CLEARED(ctx, job, 1));
    job->ctx = ctx;
    job->from = from;
    job->picture = picture;
    job->jpeg.client_data = job;
    job->jpeg.err = jpeg_std_error(&job->errors);
    job->errors.error_exit = on_error;
    job->errors.emit_message = on_message;
    job->progress.progress_monitor = on_progress;
    run(job);
    jpeg_destroy_decompress(&job->jpeg);
    status = job->status;
    release(ctx, job->row);
    release(ctx, job->booked);
done:
    release(ctx, job);
    if (status != JALI_OK) jali_picture_free(ctx, picture);
    return status;
}
