// Read a picture: which type is it, decode it to grey, lay it right.
//
// Limits:  2^29 pixels (20,000 x 20,000 fits), 65,500 px a side, files up to 4 GiB. A header that promises
//          more pixels than its file can hold is refused before anything is allocated.
// Checked: tests/test_read.c: every depth and type, every prefix of small files; fuzz/fuzz_png.c and its kin.
#include "read/read.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static const uint64_t max_total_px = UINT64_C(1) << 29;
static const uint64_t max_file_bytes = UINT64_C(1) << 32;
enum { SNIFF_BYTES = 64 };

#define ACCEPTED "accepted are PNG, JPEG, WebP, PBM, PGM and PPM"

typedef jali_status decoder(jali_context *ctx, const source *from, jali_picture *picture);

typedef struct picture_type {
    const char *name;
    int32_t offset;
    const char *magic;
    int32_t magic_size;
    decoder *decode;  // NULL: known, but not read
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
        return fail(ctx, JALI_BAD_INPUT,
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
        if (size >= (size_t)(type->offset + type->magic_size) &&
            memcmp(bytes + type->offset, type->magic, (size_t)type->magic_size) == 0)
            return type;
    }
    return NULL;
}

// Before the whole of a stream is read, its first bytes must look like a picture.
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
    *picture = (jali_picture){0};
    TRY(check_options(ctx, &opt));
    TRY(check_type(ctx, bytes, size, name));
    TRY(type_of(bytes, size)->decode(ctx, &from, picture));
    TRY(crop_picture(ctx, picture, opt.crop_px));
    TRY(turn_picture(ctx, picture, opt.quarter_turns));
    if (opt.mirror) mirror_picture(picture);
    if (opt.invert) invert_picture(picture);
    return JALI_OK;
done:
    jali_picture_free(ctx, picture);
    return status;
}

// Everything up to the end of the file, which may be a pipe of unknown length.
static jali_status read_all(jali_context *ctx, int file, const char *name, uint8_t **bytes, size_t *size)
{
    jali_status status;
    struct stat about;
    size_t capacity = 0;
    *bytes = NULL;
    *size = 0;
    bool sized = fstat(file, &about) == 0 && S_ISREG(about.st_mode);
    if (sized && (uint64_t)about.st_size > max_file_bytes)
        return fail(ctx, JALI_BAD_INPUT, "%s: the file has %.1f GB; at most %.1f GB are accepted", name,
                    (double)about.st_size / 1e9, (double)max_file_bytes / 1e9);
    for (;;) {
        size_t room = *size == 0 ? (sized ? (size_t)about.st_size + 1 : 1 << 16) : *size + 1;
        TRY(GROW(ctx, *bytes, capacity, room));
        ssize_t got = read(file, *bytes + *size, capacity - *size);
        if (got < 0 && errno == EINTR) {
            TRY(step(ctx, "read", 0));
            continue;
        }
        if (got < 0) {
            status = fail(ctx, JALI_IO, "%s: cannot be read: %s", name, strerror(errno));
            goto done;
        }
        if (got == 0) break;
        *size += (size_t)got;
        if (*size >= SNIFF_BYTES) TRY(check_type(ctx, *bytes, *size, name));
        if (*size > max_file_bytes) {
            status = fail(ctx, JALI_BAD_INPUT, "%s: more than %.1f GB came; that is too much", name,
                          (double)max_file_bytes / 1e9);
            goto done;
        }
        TRY(step(ctx, "read", 0));
    }
    return JALI_OK;
done:
    release(ctx, *bytes);
    *bytes = NULL;
    return status;
}

jali_status jali_read(jali_context *ctx, const char *path, const jali_read_options *opt, jali_picture *picture)
{
    jali_status status;
    uint8_t *bytes = NULL;
    size_t size;
    bool standard = strcmp(path, "-") == 0;
    const char *name = standard ? "standard input" : path;
    *picture = (jali_picture){0};
    int file = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return fail(ctx, JALI_IO, "%s: cannot be opened: %s", name, strerror(errno));
    TRY(read_all(ctx, file, name, &bytes, &size));
    TRY(jali_read_bytes(ctx, bytes, size, name, opt, picture));
done:
    if (!standard) close(file);
    release(ctx, bytes);
    return status;
}
