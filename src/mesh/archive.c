// Looking into a ZIP archive in memory, with limits on what it unpacks to.
#include "mesh/archive.h"

#include <zip.h>

enum { PIECE_BYTES = 1 << 16, BOMB_BYTES = 1 << 24, BOMB_RATIO = 200 };

jali_status archive_open(jali_context *ctx, const void *data, size_t size, const char *name, zip_t **archive)
{
    zip_error_t error;
    zip_error_init(&error);
    *archive = NULL;
    zip_source_t *source = zip_source_buffer_create(data, size, 0, &error);
    if (source) {
        *archive = zip_open_from_source(source, ZIP_RDONLY, &error);
        if (!*archive) zip_source_free(source);
    }
    jali_status status = JALI_OK;
    if (!*archive)
        status = zip_error_code_zip(&error) == ZIP_ER_MEMORY
                     ? fail(ctx, JALI_NO_MEMORY, "no memory to open %s", name)
                     : fail(ctx, JALI_BAD_INPUT, "%s is a damaged or cut off archive: %s", name,
                            zip_error_strerror(&error));
    zip_error_fini(&error);
    return status;
}

void archive_close(zip_t *archive)
{
    if (archive) zip_discard(archive);
}

bool archive_has(zip_t *archive, const char *entry)
{
    return zip_name_locate(archive, entry, ZIP_FL_NOCASE) >= 0;
}

int64_t archive_count(zip_t *archive)
{
    return zip_get_num_entries(archive, 0);
}

const char *archive_name(zip_t *archive, int64_t index)
{
    const char *name = zip_get_name(archive, (zip_uint64_t)index, 0);
    return name ? name : "";
}

static jali_status check_size(jali_context *ctx, const char *name, const char *entry, const zip_stat_t *known,
                              uint64_t limit)
{
    if (!(known->valid & ZIP_STAT_SIZE) || !(known->valid & ZIP_STAT_COMP_SIZE))
        return fail(ctx, JALI_BAD_INPUT, "%s: the archive does not say how large %s is", name, entry);
    if (known->size > limit)
        return fail(ctx, JALI_LIMIT, "%s: %s unpacks to %.0f MB, more than the limit of %.0f MB", name, entry,
                    (double)known->size / 1e6, (double)limit / 1e6);
    if (known->size > BOMB_BYTES && known->size / BOMB_RATIO > known->comp_size)
        return fail(ctx, JALI_BAD_INPUT, "%s: %s unpacks from %.3f to %.0f MB, which no model does", name,
                    entry, (double)known->comp_size / 1e6, (double)known->size / 1e6);
    return JALI_OK;
}

jali_status archive_unpack(jali_context *ctx, zip_t *archive, const char *name, const char *entry,
                           uint64_t limit,
                           jali_status (*take)(void *user, const char *piece, size_t size, bool last),
                           void *user)
{
    jali_status status;
    zip_file_t *file = NULL;
    zip_stat_t known;
    char piece[PIECE_BYTES];
    uint64_t total = 0;
    zip_int64_t index = zip_name_locate(archive, entry, ZIP_FL_NOCASE), got;
    if (index < 0 || zip_stat_index(archive, (zip_uint64_t)index, 0, &known) != 0)
        TRY(fail(ctx, JALI_BAD_INPUT, "%s is an archive without %s", name, entry));
    TRY(check_size(ctx, name, entry, &known, limit));
    file = zip_fopen_index(archive, (zip_uint64_t)index, 0);
    if (!file) TRY(fail(ctx, JALI_BAD_INPUT, "%s: cannot unpack %s: %s", name, entry, zip_strerror(archive)));
    do {
        TRY(step(ctx, "read", known.size ? (double)total / (double)known.size : 0));
        got = zip_fread(file, piece, sizeof piece);
        if (got < 0)
            TRY(fail(ctx, JALI_BAD_INPUT, "%s: %s is damaged: %s", name, entry, zip_file_strerror(file)));
        total += (uint64_t)got;
        if (total > known.size) TRY(fail(ctx, JALI_BAD_INPUT, "%s: %s is larger than it says", name, entry));
        TRY(take(user, piece, (size_t)got, got == 0));
    } while (got > 0);
done:
    if (file) zip_fclose(file);
    return status;
}
