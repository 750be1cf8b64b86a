// The layers of an SL1 file: a ZIP with a grey PNG a layer and the settings as text.
//
// Source:  what PrusaSlicer 2.5 writes: prusaslicer.ini with display_width and display_height in mm,
//          display_pixels_x and display_pixels_y. SL1S files are the same.
// Limits:  the printed object is taken to be the layers in the middle; supports and a pad are not told apart.
// Checked: tests/test_sl1.c, fuzz/fuzz_sl1.c.
#include "base/file.h"
#include "base/number.h"
#include "compare/votes.h"
#include "mesh/archive.h"
#include "raster/raster.h"

#include <math.h>
#include <stdlib.h>
#include <strings.h>

enum { MOST_LAYERS = 100000, GREY_EXPOSED = 128 };
static const uint64_t most_settings_bytes = 1 << 20, most_layer_bytes = 1 << 28, most_layer_px = 1 << 28;
static const size_t most_file_bytes = (size_t)1 << 32;

// One unpacked entry.
typedef struct unpacking {
    jali_context *ctx;
    jali_bytes bytes;
} unpacking;

static jali_status take_piece(void *user, const char *piece, size_t size, bool last)
{
    unpacking *u = user;
    (void)last;
    return bytes_append(u->ctx, &u->bytes, piece, size);
}

// --- Settings

// The value behind "key =" at the beginning of a line; NULL when there is none.
static const char *setting(const jali_bytes *text, const char *key, const char **end)
{
    size_t length = strlen(key);
    if (text->size == 0) return NULL; // and no data
    const char *at = (const char *)text->data, *stop = at + text->size;
    while (at < stop) {
        const char *line_end = memchr(at, '\n', (size_t)(stop - at));
        if (!line_end) line_end = stop;
        if ((size_t)(line_end - at) > length && memcmp(at, key, length) == 0) {
            const char *value = at + length;
            while (value < line_end && *value == ' ') value++;
            if (value < line_end && *value == '=') {
                for (value++; value < line_end && *value == ' ';) value++;
                *end = line_end;
                return value;
            }
        }
        at = line_end + 1;
    }
    return NULL;
}

static bool number_of(const jali_bytes *text, const char *key, double *value)
{
    const char *end, *at = setting(text, key, &end);
    return at && read_decimal(&at, end, value) && *value > 0 && *value < 1e6;
}

// The picture's pixel from the display's; false when the settings do not say. A portrait picture has the
// display's columns as its rows, and yet the display's x gives its columns their width: so PrusaSlicer draws,
// and so a square comes out square where the two differ.
static bool pixel_of(const jali_bytes *text, double pixel_mm[2])
{
    double width, height, columns, rows;
    if (!number_of(text, "display_width", &width) || !number_of(text, "display_height", &height) ||
        !number_of(text, "display_pixels_x", &columns) || !number_of(text, "display_pixels_y", &rows))
        return false;
    pixel_mm[0] = width / columns;
    pixel_mm[1] = height / rows;
    return pixel_mm[0] >= 1e-4 && pixel_mm[1] >= 1e-4 && pixel_mm[0] <= 10 && pixel_mm[1] <= 10;
}

static jali_status find_pixel(jali_context *ctx, zip_t *archive, const char *name,
                              const jali_print_options *opt, jali_print *print)
{
    jali_status status = JALI_OK;
    unpacking u = {.ctx = ctx};
    bool found = false;
    if (archive_has(archive, "prusaslicer.ini")) {
        TRY(archive_unpack(ctx, archive, name, "prusaslicer.ini", most_settings_bytes, take_piece, &u));
        found = pixel_of(&u.bytes, print->pixel_mm);
    }
    if (!found && !(opt->pixel_mm >= 0.001 && opt->pixel_mm <= 1))
        TRY(fail(ctx, JALI_BAD_INPUT,
                 "%s does not say how large a pixel is: display_width, display_height, display_pixels_x and "
                 "display_pixels_y in prusaslicer.ini; --sl1-pixel gives its side in mm",
                 name));
    if (!found) print->pixel_mm[0] = print->pixel_mm[1] = opt->pixel_mm;
done:
    jali_bytes_free(ctx, &u.bytes);
    return status;
}

// --- Layers

static bool is_layer(const char *name)
{
    size_t length = strlen(name);
    return length > 4 && strcasecmp(name + length - 4, ".png") == 0 && !strchr(name, '/');
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

// Names of the layers, from below; they belong to the archive.
static jali_status list_layers(jali_context *ctx, zip_t *archive, const char *name, const char ***layer,
                               int32_t *count)
{
    jali_status status;
    int64_t entries = archive_count(archive);
    *count = 0;
    if (entries > MOST_LAYERS)
        return fail(ctx, JALI_BAD_INPUT, "%s holds %lld files; %d are accepted", name, (long long)entries,
                    MOST_LAYERS);
    TRY(ALLOCATE(ctx, *layer, entries + 1));
    for (int64_t i = 0; i < entries; i++)
        if (is_layer(archive_name(archive, i))) (*layer)[(*count)++] = archive_name(archive, i);
    if (*count == 0)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s is an archive without layers: PNG files beside its settings",
                 name));
    qsort(*layer, (size_t)*count, sizeof **layer, by_name);
done:
    return status;
}

static jali_status read_layer(jali_context *ctx, zip_t *archive, const char *name, const char *layer,
                              jali_bitmap *bitmap)
{
    jali_status status;
    unpacking u = {.ctx = ctx};
    jali_picture picture = {0};
    jali_read_options opt = jali_read_defaults();
    opt.max_px = most_layer_px;
    TRY(archive_unpack(ctx, archive, name, layer, most_layer_bytes, take_piece, &u));
    TRY(jali_read_bytes(ctx, u.bytes.data, u.bytes.size, layer, &opt, &picture));
    TRY(jali_binarise(ctx, &picture, GREY_EXPOSED, bitmap));
done:
    jali_bytes_free(ctx, &u.bytes);
    jali_picture_free(ctx, &picture);
    return status;
}

static jali_status vote_layers(jali_context *ctx, zip_t *archive, const char *name, const char *const *layer,
                               jali_print *print)
{
    jali_status status = JALI_OK;
    jali_bitmap bitmap = {0};
    layer_votes votes = {0};
    for (int32_t i = 0; i < print->looked_at; i++) {
        const char *entry = layer[looked_at(print, i)];
        TRY(step(ctx, "read", (double)i / print->looked_at));
        TRY(read_layer(ctx, archive, name, entry, &bitmap));
        if (i == 0) TRY(votes_create(ctx, bitmap.width_px, bitmap.height_px, &votes));
        if (bitmap.width_px != votes.plane[0].width_px || bitmap.height_px != votes.plane[0].height_px)
            TRY(fail(ctx, JALI_BAD_INPUT, "%s: layer %s has %d x %d px, others have %d x %d", name, entry,
                     bitmap.width_px, bitmap.height_px, votes.plane[0].width_px, votes.plane[0].height_px));
        vote(ctx, &votes, &bitmap);
        jali_bitmap_free(ctx, &bitmap);
    }
    TRY(votes_majority(ctx, &votes, &print->solid));
done:
    jali_bitmap_free(ctx, &bitmap);
    votes_free(ctx, &votes);
    return status;
}

// Keep the box around what is exposed: its centre is that of the print.
static jali_status crop_print(jali_context *ctx, const char *name, jali_print *print)
{
    jali_status status;
    jali_bitmap cropped = {0};
    int32_t low[2], high[2];
    if (!white_box(&print->solid, low, high))
        return fail(ctx, JALI_BAD_INPUT, "%s exposes nothing in its layers %d to %d of %d", name,
                    print->first + 1, print->last + 1, print->layers);
    TRY(jali_bitmap_create(ctx, high[0] - low[0], high[1] - low[1], &cropped));
    cut_out(ctx, &print->solid, low[0], low[1], &cropped);
    jali_bitmap_free(ctx, &print->solid);
    print->solid = cropped;
    measure_print(print);
done:
    return status;
}

jali_status jali_print_sl1_bytes(jali_context *ctx, const void *bytes, size_t size, const char *name,
                                 const jali_print_options *given, jali_print *print)
{
    jali_status status;
    jali_print_options opt = {0};
    zip_t *archive = NULL;
    const char **layer = NULL;
    int32_t count;
    if (given) opt = *given;
    *print = (jali_print){0};
    if (size < 4 || memcmp(bytes, "PK", 2) != 0)
        return fail(ctx, JALI_BAD_INPUT, "%s is no SL1 file, which is a ZIP archive of layers", name);
    TRY(archive_open(ctx, bytes, size, name, &archive));
    TRY(list_layers(ctx, archive, name, &layer, &count));
    TRY(find_pixel(ctx, archive, name, &opt, print));
    choose_middle(count, print);
    TRY(vote_layers(ctx, archive, name, layer, print));
    TRY(crop_print(ctx, name, print));
done:
    if (status != JALI_OK) jali_print_free(ctx, print);
    release(ctx, layer);
    archive_close(archive);
    return status;
}

jali_status jali_print_sl1(jali_context *ctx, const char *path, const jali_print_options *opt,
                           jali_print *print)
{
    jali_bytes file = {0};
    *print = (jali_print){0};
    jali_status status = file_read(ctx, path, most_file_bytes, &file);
    if (status == JALI_OK) status = jali_print_sl1_bytes(ctx, file.data, file.size, path, opt, print);
    jali_bytes_free(ctx, &file);
    return status;
}
