// Read a picture: which type is it, decode it to grey, lay it right.
//
// Limits:  2^29 pixels (20,000 x 20,000 fits), 65,500 px a side, files up to 1.6 GB. A header that promises
//          more pixels than its file can hold is refused before anything is allocated.
// Checked: tests/test_read.c: every depth and type, every prefix of small files; fuzz/fuzz_png.c and its kin.
#include "read/read.h"
#include "base/file.h"

static const uint64_t max_total_px = UINT64_C(1) << 29;
static const size_t max_file_bytes = (size_t)3 << 29;

#define ACCEPTED "accepted are PNG, JPEG, WebP, PBM, PGM and PPM"

typedef jali_status decoder(jali_context *ctx, const source *from, jali_picture *picture);

typedef struct picture_type {
    const char *name;
    int32_t offset;
    const char *magic;
    int32_t magic_size;
    decoder *decode; // NULL: known, but not read
} picture_type;

#define MAGIC(text) text, sizeof(text) - 1
static const picture_type picture_types[] = {
    {"PNG", 0, MAGIC("\x89PNG\r\n\x1a\n"), decode_png},
    {"JPEG", 0, MAGIC("\xff\xd8\xff"), decode_jpeg},
    {"WebP", 8, MAGIC("WEBP"), decode_webp},
    {"PBM", 0, MAGIC("P1"), decode_pnm},
    {"PGM", 0, MAGIC("P2"), decode_pnm},
    {"PPM", 0, MAGIC("P3"), decode_pnm},
    {"PBM", 0, MAGIC("P4"), decode_pnm},
    {"PGM", 0, MAGIC("P5"), decode_pnm},
    {"PPM", 0, MAGIC("P6"), decode_pnm},
    {"PAM", 0, MAGIC("P7"), NULL},
    {"GIF", 0, MAGIC("GIF8"), NULL},
    {"TIFF", 0, MAGIC("II*\0"), NULL},
    {"TIFF", 0, MAGIC("MM\0*"), NULL},
    {"BMP", 0, MAGIC("BM"), NULL},
    {"PDF", 0, MAGIC("%PDF"), NULL},
    {"SVG", 0, MAGIC("<svg"), NULL},
    {"XML (SVG?)", 0, MAGIC("<?xml"), NULL},
    {"HEIF or AVIF", 4, MAGIC("ftyp"), NULL},
    {"JPEG 2000", 4, MAGIC("jP  "), NULL},
    {"JPEG XL", 0, MAGIC("\xff\x0a"), NULL},
    {"ZIP archive", 0, MAGIC("PK\x03\x04"), NULL},
};

jali_read_options jali_read_defaults(void)
{
    return (jali_read_options){.max_px = max_total_px};
}

void jali_picture_free(jali_context *ctx, jali_picture *picture)
{
    if (!picture) return;
    release(ctx, picture->grey);
    *picture = (jali_picture){0};
}

jali_status picture_of_size(jali_context *ctx, const source *from, uint64_t width, uint64_t height,
                            uint64_t fewest_bytes, jali_picture *picture)
{
    if (width == 0 || height == 0)
        return fail(ctx, JALI_BAD_INPUT, "%s: the picture has no pixels (%llu x %llu)", from->name,
                    (unsigned long long)width, (unsigned long long)height);
    if (width > MAX_SIDE_PX || height > MAX_SIDE_PX)
        return fail(ctx, JALI_BAD_INPUT, "%s: %llu x %llu px is too large; at most %d px a side are accepted",
                    from->name, (unsigned long long)width, (unsigned long long)height, MAX_SIDE_PX);
    if (width * height > from->max_px)
        return fail(ctx, JALI_BAD_INPUT, "%s: %llu x %llu px is too large; at most %.1f Mpixel are accepted",
                    from->name, (unsigned long long)width, (unsigned long long)height,
                    (double)from->max_px / 1e6);
    if (fewest_bytes > from->size)
        return fail(
            ctx, JALI_BAD_INPUT,
            "%s: truncated or corrupt: the header promises %llu x %llu px, for which %zu bytes are too few",
            from->name, (unsigned long long)width, (unsigned long long)height, from->size);
    jali_status status = ALLOCATE(ctx, picture->grey, width * height);
    if (status != JALI_OK) return status;
    picture->width_px = (int32_t)width;
    picture->height_px = (int32_t)height;
    return JALI_OK;
}

static const picture_type *type_of(const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < sizeof picture_types / sizeof *picture_types; i++) {
        const picture_type *type = &picture_types[i];
        if (size >= (size_t)type->offset + (size_t)type->magic_size &&
            memcmp(bytes + type->offset, type->magic, (size_t)type->magic_size) == 0)
            return type;
    }
    return NULL;
}

static jali_status check_type(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name)
{
    if (size == 0) return fail(ctx, JALI_BAD_INPUT, "%s: the file is empty", name);
    const picture_type *type = type_of(bytes, size);
    if (!type) return fail(ctx, JALI_BAD_INPUT, "%s: not a picture of a known type; " ACCEPTED, name);
    if (!type->decode)
        return fail(ctx, JALI_BAD_INPUT, "%s: this is %s, which is not read; " ACCEPTED, name, type->name);
    return JALI_OK;
}

static jali_status check_options(jali_context *ctx, const jali_read_options *opt)
{
    if (opt->max_px < 1 || opt->max_px > max_total_px)
        return fail(ctx, JALI_BAD_VALUE, "the largest picture must have 1 .. %llu pixels, not %llu",
                    (unsigned long long)max_total_px, (unsigned long long)opt->max_px);
    if (opt->quarter_turns < 0 || opt->quarter_turns > 3)
        return fail(ctx, JALI_BAD_VALUE, "quarter turns must be 0 .. 3, not %d", opt->quarter_turns);
    return JALI_OK;
}

jali_status jali_read_bytes(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                            const jali_read_options *given, jali_picture *picture)
{
    jali_status status;
    jali_read_options opt = given ? *given : jali_read_defaults();
    source from = {bytes, size, name, opt.max_px};
    int32_t file_px[2];
    *picture = (jali_picture){0};
    TRY(check_options(ctx, &opt));
    TRY(check_type(ctx, bytes, size, name));
    TRY(type_of(bytes, size)->decode(ctx, &from, picture));
    file_px[0] = picture->width_px;
    file_px[1] = picture->height_px;
    TRY(crop_picture(ctx, picture, opt.crop_px));
    TRY(turn_picture(ctx, picture, opt.quarter_turns));
    if (opt.mirror) mirror_picture(picture);
    if (opt.invert) invert_picture(picture);
    memcpy(picture->file_px, file_px, sizeof file_px);
    return JALI_OK;
done:
    jali_picture_free(ctx, picture);
    return status;
}

jali_status jali_read(jali_context *ctx, const char *path, const jali_read_options *opt,
                      jali_picture *picture)
{
    jali_status status;
    jali_bytes file = {0};
    *picture = (jali_picture){0};
    TRY(file_read(ctx, path, max_file_bytes, &file));
    TRY(jali_read_bytes(ctx, file.data, file.size, strcmp(path, "-") == 0 ? "stdin" : path, opt, picture));
done:
    jali_bytes_free(ctx, &file);
    return status;
}
