// Looking into a ZIP archive in memory, with limits on what it unpacks to.
#ifndef MESH_ARCHIVE_H
#define MESH_ARCHIVE_H

#include "base/base.h"

typedef struct zip zip_t; // libzip's

/// Open an archive that stays in memory for as long; *archive is NULL on failure.
///   fails  JALI_BAD_INPUT, JALI_NO_MEMORY
jali_status archive_open(jali_context *ctx, const void *data, size_t size, const char *name, zip_t **archive);
void archive_close(zip_t *archive);

/// Unpack an entry piece by piece.
///   in     entry   its name; case does not matter
///          limit   refused when it unpacks to more bytes, or to 200 times its packed size and over 16 MB
///          take    gets each piece; `last` with the final one, which may be empty; stops at a bad status
///   fails  JALI_BAD_INPUT (no such entry, damaged, locked), JALI_LIMIT, and what `take` says
jali_status archive_unpack(jali_context *ctx, zip_t *archive, const char *name, const char *entry,
                           uint64_t limit,
                           jali_status (*take)(void *user, const char *piece, size_t size, bool last),
                           void *user);

/// Entries in all, and the name of each; "" where it cannot be told.
int64_t archive_count(zip_t *archive);
const char *archive_name(zip_t *archive, int64_t index);
bool archive_has(zip_t *archive, const char *entry);

#endif
