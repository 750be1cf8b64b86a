// Writing a ZIP archive: an entry a file, a directory behind them, no clock.
//
// Source:  PKWARE APPNOTE 6.3, sections 4.3.7, 4.3.12 and 4.3.16.
// Limits:  4 GB in all (no ZIP64).
#include "write/zip.h"

#include <assert.h>
#include <libdeflate.h>

enum { DATE_1980_01_01 = 0x0021, VERSION = 20, UTF8_NAME = 0x0800, DEFLATE = 8 };

static void put(uint8_t **to, uint32_t value, int size)
{
    for (int i = 0; i < size; i++) *(*to)++ = (uint8_t)(value >> 8 * i);
}

// The 26 bytes that the local head and the directory have in common.
static void put_common(uint8_t **to, const zip_writer *zip, int32_t index)
{
    put(to, VERSION, 2);
    put(to, UTF8_NAME, 2);
    put(to, zip->entry[index].deflated ? DEFLATE : 0, 2);
    put(to, 0, 2);
    put(to, DATE_1980_01_01, 2);
    put(to, zip->entry[index].crc, 4);
    put(to, zip->entry[index].packed, 4);
    put(to, zip->entry[index].size, 4);
    put(to, (uint32_t)strlen(zip->entry[index].name), 2);
    put(to, 0, 2);
}

// Deflate into the room behind the bytes in use. A model packs to a fifth; when a third does not do, all is
// tried, and what will not shrink is left to be stored.
static jali_status deflate_behind(jali_context *ctx, const void *data, size_t size, int level,
                                  jali_bytes *bytes, size_t *packed)
{
    *packed = 0;
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(level);
    if (!compressor) return fail(ctx, JALI_NO_MEMORY, "no memory for the compressor");
    jali_status status = JALI_OK;
    const size_t rooms[] = {size / 3, size};
    for (int i = 0; i < 2 && *packed == 0; i++) {
        TRY(step(ctx, "write", 0.5));
        TRY(bytes_reserve(ctx, bytes, rooms[i]));
        *packed = libdeflate_deflate_compress(compressor, data, size, bytes->data + bytes->size, rooms[i]);
    }
done:
    libdeflate_free_compressor(compressor);
    return status;
}

jali_status zip_add(jali_context *ctx, zip_writer *zip, const char *name, const void *data, size_t size,
                    int level, jali_bytes *bytes)
{
    jali_status status;
    assert(zip->entry_count < ZIP_ENTRIES);
    int32_t index = zip->entry_count;
    size_t head = 30 + strlen(name), packed = 0;
    if (index == 0) zip->start = bytes->size;
    size_t at = bytes->size - zip->start;
    TRY(bytes_reserve(ctx, bytes, head));
    bytes->size += head;
    if (level > 0 && size > 0) TRY(deflate_behind(ctx, data, size, level, bytes, &packed));
    bool deflated = packed > 0;
    if (deflated)
        bytes->size += packed;
    else
        TRY(bytes_append(ctx, bytes, data, size));
    if (size > UINT32_MAX || bytes->size - zip->start > UINT32_MAX - 65536)
        TRY(fail(ctx, JALI_LIMIT, "an archive of more than 4 GB cannot be written"));
    zip->entry[index].name = name;
    zip->entry[index].crc = libdeflate_crc32(0, data, size);
    zip->entry[index].packed = (uint32_t)(deflated ? packed : size);
    zip->entry[index].size = (uint32_t)size;
    zip->entry[index].at = (uint32_t)at;
    zip->entry[index].deflated = deflated;
    zip->entry_count++;
    uint8_t *to = bytes->data + zip->start + at;
    put(&to, 0x04034b50, 4);
    put_common(&to, zip, index);
    memcpy(to, name, strlen(name));
done:
    return status;
}

jali_status zip_finish(jali_context *ctx, zip_writer *zip, jali_bytes *bytes)
{
    size_t names = 0, directory = bytes->size - zip->start;
    for (int32_t i = 0; i < zip->entry_count; i++) names += strlen(zip->entry[i].name);
    size_t room = names + 46 * (size_t)zip->entry_count + 22;
    jali_status status = bytes_reserve(ctx, bytes, room);
    if (status != JALI_OK) return status;
    uint8_t *to = bytes->data + bytes->size;
    for (int32_t i = 0; i < zip->entry_count; i++) {
        put(&to, 0x02014b50, 4);
        put(&to, VERSION, 2);
        put_common(&to, zip, i);
        put(&to, 0, 2); // comment, disk, attributes
        put(&to, 0, 2);
        put(&to, 0, 2);
        put(&to, 0, 4);
        put(&to, zip->entry[i].at, 4);
        memcpy(to, zip->entry[i].name, strlen(zip->entry[i].name));
        to += strlen(zip->entry[i].name);
    }
    put(&to, 0x06054b50, 4);
    put(&to, 0, 4);
    put(&to, (uint32_t)zip->entry_count, 2);
    put(&to, (uint32_t)zip->entry_count, 2);
    put(&to, (uint32_t)(room - 22), 4);
    put(&to, (uint32_t)directory, 4);
    put(&to, 0, 2);
    bytes->size += room;
    return JALI_OK;
}
