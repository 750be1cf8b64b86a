// Writing a ZIP archive with the same bytes every time.
#ifndef WRITE_ZIP_H
#define WRITE_ZIP_H

#include "base/bytes.h"

enum { ZIP_ENTRIES = 8 };

/// {0} is an empty archive.
typedef struct zip_writer {
    struct {
        const char *name;
        uint32_t crc, packed, size, at;
        bool deflated;
    } entry[ZIP_ENTRIES];
    int32_t entry_count;
    size_t start; // of the archive within the bytes
} zip_writer;

/// Add an entry; names must outlive the writer. Times are 1980-01-01, the first a ZIP can say.
///   in     level   0 stores, 1 .. 12 as libdeflate
///   fails  JALI_NO_MEMORY, JALI_LIMIT (4 GB)
jali_status zip_add(jali_context *ctx, zip_writer *zip, const char *name, const void *data, size_t size,
                    int level, jali_bytes *bytes);

/// Write the directory.
jali_status zip_finish(jali_context *ctx, zip_writer *zip, jali_bytes *bytes);

#endif
