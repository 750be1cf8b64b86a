// PBM, PGM and PPM, plain (P1, P2, P3) and raw (P4, P5, P6), any maximum up to 65,535.
//
// Differs: a sample above the header's maximum is an error, not a guess. Of a file that holds several
// pictures
//          the first is read.
// Checked: tests/test_read.c, fuzz/fuzz_pnm.c.
#include "read/read.h"

typedef struct pnm {
    jali_context *ctx;
    const source *from;
    size_t at;
    int32_t kind; // the digit of P1 .. P6
    uint32_t width, height, top;
} pnm;

static jali_status corrupt(const pnm *file, const char *what)
{
    return fail(file->ctx, JALI_BAD_INPUT, "%s: the P%d file is corrupt: %s at byte %zu", file->from->name,
                file->kind, what, file->at);
}

static jali_status truncated(const pnm *file)
{
    return fail(file->ctx, JALI_BAD_INPUT, "%s: the P%d file is truncated: it ends after %zu bytes",
                file->from->name, file->kind, file->from->size);
}

static bool is_space(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

// A comment runs from # to the end of its line and counts as white space.
static void skip_space(pnm *file)
{
    const uint8_t *bytes = file->from->bytes;
    size_t size = file->from->size;
    for (; file->at < size; file->at++) {
        if (bytes[file->at] == '#')
            while (file->at < size && bytes[file->at] != '\n') file->at++;
        else if (!is_space(bytes[file->at]))
            return;
    }
}

static jali_status read_number(pnm *file, uint32_t *number)
{
    const uint8_t *bytes = file->from->bytes;
    size_t first;
    skip_space(file);
    if (file->at >= file->from->size) return truncated(file);
    first = file->at;
    *number = 0;
    while (file->at < file->from->size && bytes[file->at] >= '0' && bytes[file->at] <= '9') {
        if (*number > 99999999) return corrupt(file, "a number has too many digits");
        *number = *number * 10 + (uint32_t)(bytes[file->at++] - '0');
    }
    return file->at > first ? JALI_OK : corrupt(file, "a number is missing");
}

static jali_status read_header(pnm *file)
{
    jali_status status;
    file->kind = file->from->bytes[1] - '0';
    file->at = 2;
    file->top = 1;
    TRY(read_number(file, &file->width));
    TRY(read_number(file, &file->height));
    if (file->kind % 3 != 1) TRY(read_number(file, &file->top));
    if (file->top < 1 || file->top > 65535) return corrupt(file, "the largest sample is not in 1 .. 65535");
    if (file->at >= file->from->size) return truncated(file);
    if (!is_space(file->from->bytes[file->at++])) return corrupt(file, "white space is missing");
done:
    return status;
}

// What is left after the header cannot be shorter than this.
static uint64_t fewest_bytes(const pnm *file)
{
    uint64_t pixels = (uint64_t)file->width * file->height, wide = file->top > 255 ? 2 : 1;
    switch (file->kind) {
    case 1: return pixels;
    case 2: return 2 * pixels - 1;
    case 3: return 6 * pixels - 1;
    case 4: return (uint64_t)((file->width + 7) / 8) * file->height;
    case 5: return wide * pixels;
    default: return 3 * wide * pixels;
    }
}

// The plain bitmap's digits need no space between them.
static jali_status read_digit(pnm *file, uint32_t *sample)
{
    skip_space(file);
    if (file->at >= file->from->size) return truncated(file);
    uint8_t digit = file->from->bytes[file->at];
    if (digit != '0' && digit != '1') return corrupt(file, "a pixel is neither 0 nor 1");
    file->at++;
    *sample = digit == '0'; // 1 is black
    return JALI_OK;
}

static jali_status read_sample(pnm *file, uint32_t *sample)
{
    jali_status status;
    const uint8_t *bytes = file->from->bytes;
    if (file->kind == 1) return read_digit(file, sample);
    if (file->kind <= 3)
        TRY(read_number(file, sample));
    else if (file->top <= 255)
        *sample = bytes[file->at++];
    else {
        *sample = (uint32_t)bytes[file->at] << 8 | bytes[file->at + 1];
        file->at += 2;
    }
    status = *sample <= file->top ? JALI_OK : corrupt(file, "a sample is above the header's maximum");
done:
    return status;
}

// Colours of a small maximum are widened first, or their luma would be rounded to it.
static uint32_t widened(uint32_t sample, uint32_t top)
{
    return (sample * 65535 + top / 2) / top;
}

static jali_status read_pixel(pnm *file, uint8_t *grey)
{
    jali_status status = JALI_OK;
    uint32_t sample[3] = {0}, top = file->top;
    bool coloured = file->kind % 3 == 0;
    for (int32_t i = 0; i < (coloured ? 3 : 1); i++) TRY(read_sample(file, &sample[i]));
    *grey =
        coloured
            ? to_grey(luma(widened(sample[0], top), widened(sample[1], top), widened(sample[2], top)), 65535)
            : to_grey(sample[0], top);
done:
    return status;
}

static void unpack_row(const uint8_t *packed, int32_t width, uint8_t *grey)
{
    for (int32_t x = 0; x < width; x++) grey[x] = packed[x >> 3] >> (7 - (x & 7)) & 1 ? 0 : 255;
}

static jali_status read_row(pnm *file, int32_t width, uint8_t *grey)
{
    jali_status status = JALI_OK;
    const uint8_t *row = file->from->bytes + file->at;
    if (file->kind == 4) {
        unpack_row(row, width, grey);
        file->at += ((size_t)width + 7) / 8;
    } else if (file->kind >= 5 && file->top == 255) {
        int32_t channels = file->kind == 5 ? 1 : 3;
        grey_row(row, channels, width, grey);
        file->at += (size_t)width * (size_t)channels;
    } else
        for (int32_t x = 0; x < width; x++) TRY(read_pixel(file, &grey[x]));
done:
    return status;
}

jali_status decode_pnm(jali_context *ctx, const source *from, jali_picture *picture)
{
    jali_status status;
    pnm file = {.ctx = ctx, .from = from};
    TRY(read_header(&file));
    TRY(picture_of_size(ctx, from, file.width, file.height, fewest_bytes(&file), picture));
    if (from->size - file.at < fewest_bytes(&file)) {
        status = truncated(&file);
        goto done;
    }
    for (int64_t y = 0; y < picture->height_px; y++) {
        if (y % 256 == 0) TRY(step(ctx, "read", (double)y / picture->height_px));
        TRY(read_row(&file, picture->width_px, picture->grey + y * picture->width_px));
    }
done:
    if (status != JALI_OK) jali_picture_free(ctx, picture);
    return status;
}
