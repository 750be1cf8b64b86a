// The lines of a text file of any length, one after the other: never more than one of them in memory.
#ifndef BASE_LINES_H
#define BASE_LINES_H

#include "base/base.h"

enum { LINE_BYTES = 4096 };

/// {0} is valid and not open. Line ends are LF, CR LF or CR.
typedef struct lines {
    const char *name;  // in sentences; the caller's
    int descriptor;    // valid while `file`
    bool file;         // else the bytes below
    const char *bytes; // [size] the caller's
    size_t size, at;   // bytes in all, and those handed out so far
    char *piece;       // [PIECE_BYTES] read ahead of a file
    size_t piece_at, piece_size;
    int64_t number;        // of the line in `text`, counted from 1
    char text[LINE_BYTES]; // the line, without its end, closed by 0
    int32_t length;
    bool cut; // the line was longer; the rest is dropped
} lines;

/// Read a file's lines from its beginning; it must be one that can be read twice (no pipe).
///   fails  JALI_IO, JALI_NO_MEMORY
jali_status lines_open(jali_context *ctx, const char *path, lines *in);
/// The same of bytes in memory, which must outlive the lines.
void lines_of_bytes(const void *bytes, size_t size, const char *name, lines *in);
/// To the first line again.
///   fails  JALI_IO
jali_status lines_rewind(jali_context *ctx, lines *in);
/// The next line.
///   out    more   false at the end of the text
///   fails  JALI_IO, JALI_BAD_INPUT (a byte 0: this is no text; the sentence names the line)
jali_status lines_next(jali_context *ctx, lines *in, bool *more);
void lines_close(jali_context *ctx, lines *in);

#endif
