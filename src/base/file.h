// Files: read whole under a limit; written so that nobody ever sees half of one.
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "base/bytes.h"

/// An output file in the making. {0} is valid and means "not open".
typedef struct output_file {
    int descriptor; // valid while `open`
    bool open;
    bool in_memory;  // of a run that may open no files: what is written goes to its jali_files
    char *target;    // the file as it will be called, links followed; NULL: written straight (stdout, device)
    char *temporary; // the name it has until it is committed
    const char *name; // as the caller gave it, for sentences; must outlive the file
} output_file;

/// Open a temporary file beside `path`; "-" is stdout. A device or pipe is written straight.
///   fails  JALI_IO (the sentence names the path and the system's reason), JALI_NO_MEMORY
jali_status output_open(jali_context *ctx, const char *path, output_file *file);

/// Append; looks for a cancel between pieces.
///   fails  JALI_IO, JALI_CANCELLED, JALI_LIMIT; the caller then abandons the file
jali_status output_write(jali_context *ctx, output_file *file, const void *data, size_t size);

/// Make it durable, then give it its name in one step: readers see the earlier file or this one.
///   fails  JALI_IO; the temporary is then gone and the earlier file is as it was
jali_status output_commit(jali_context *ctx, output_file *file);

/// Drop what was not committed: the temporary goes, the earlier file stays. Harmless after a commit.
void output_abandon(jali_context *ctx, output_file *file);

/// Open, write, commit; abandon on failure.
jali_status file_write(jali_context *ctx, const char *path, const void *data, size_t size);

/// What a run that may open no files has under this name; NULL: nothing, and a sentence is kept.
///   fails  JALI_IO
const jali_file *file_in_memory(jali_context *ctx, const char *name);

/// Is there a file of that name?
bool file_exists(jali_context *ctx, const char *path);

/// Read a whole file; "-" is stdin.
///   in     limit_bytes  larger files are refused
///   out    bytes        free with jali_bytes_free; one byte of room is kept behind the last and holds 0
///   fails  JALI_IO, JALI_LIMIT, JALI_NO_MEMORY, JALI_CANCELLED
jali_status file_read(jali_context *ctx, const char *path, size_t limit_bytes, jali_bytes *bytes);

#endif
