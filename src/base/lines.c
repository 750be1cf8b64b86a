// The lines of a text file of any length, one after the other.
//
// Limits:  of a line the first 4,095 bytes count; `cut` says that there were more.
// Checked: tests/test_lines.c: every line end, over the border of two pieces, from files and from memory.
#include "base/file.h"
#include "base/lines.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE_BYTES = 1 << 16 };

static jali_status cannot_read(jali_context *ctx, const char *name, int error)
{
    char words[128];
    return fail(ctx, JALI_IO, "cannot read %s: %s", name, strerror_r(error, words, sizeof words));
}

jali_status lines_open(jali_context *ctx, const char *path, lines *in)
{
    jali_status status = JALI_OK;
    struct stat known;
    if (files_of(ctx)) {
        const jali_file *file = file_in_memory(ctx, path);
        if (file) lines_of_bytes(file->data, file->size, path, in);
        return file ? JALI_OK : JALI_IO;
    }
    *in = (lines){.name = path};
    in->descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (in->descriptor < 0) return cannot_read(ctx, path, errno);
    in->file = true;
    if (fstat(in->descriptor, &known) != 0) TRY(cannot_read(ctx, path, errno));
    if (!S_ISREG(known.st_mode)) TRY(cannot_read(ctx, path, S_ISDIR(known.st_mode) ? EISDIR : ESPIPE));
    in->size = (size_t)known.st_size;
    TRY(ALLOCATE(ctx, in->piece, PIECE_BYTES));
done:
    if (status != JALI_OK) lines_close(ctx, in);
    return status;
}

void lines_of_bytes(const void *bytes, size_t size, const char *name, lines *in)
{
    *in = (lines){.name = name, .bytes = bytes, .size = size};
}

jali_status lines_rewind(jali_context *ctx, lines *in)
{
    in->at = in->piece_at = in->piece_size = 0;
    in->number = 0;
    if (in->file && lseek(in->descriptor, 0, SEEK_SET) != 0) return cannot_read(ctx, in->name, errno);
    return JALI_OK;
}

void lines_close(jali_context *ctx, lines *in)
{
    if (in->file) close(in->descriptor);
    release(ctx, in->piece);
    *in = (lines){0};
}

// Make at least one byte ready; none at the end.
static jali_status refill(jali_context *ctx, lines *in)
{
    if (!in->file) {
        if (in->piece_size == 0) in->piece_size = in->size;
        return JALI_OK;
    }
    ssize_t got;
    do got = read(in->descriptor, in->piece, PIECE_BYTES);
    while (got < 0 && errno == EINTR);
    if (got < 0) return cannot_read(ctx, in->name, errno);
    in->piece_at = 0;
    in->piece_size = (size_t)got;
    return JALI_OK;
}

jali_status lines_next(jali_context *ctx, lines *in, bool *more)
{
    bool carriage = false; // the byte before was a CR: an LF now belongs to it
    in->length = 0;
    in->cut = *more = false;
    for (;;) {
        if (in->piece_at == in->piece_size) {
            jali_status status = refill(ctx, in);
            if (status != JALI_OK) return status;
            if (in->piece_at == in->piece_size) break;
        }
        char c = (in->file ? in->piece : in->bytes)[in->piece_at];
        if (carriage && c != '\n') break;
        in->piece_at++;
        in->at++;
        if (!*more) in->number++;
        *more = true;
        if (c == '\n') break;
        carriage = c == '\r';
        if (carriage) continue;
        if (c == 0)
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a byte 0; this is no text", in->name,
                        (long long)in->number);
        if (in->length < LINE_BYTES - 1)
            in->text[in->length++] = c;
        else
            in->cut = true;
    }
    in->text[in->length] = 0;
    return JALI_OK;
}
