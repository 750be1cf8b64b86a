// Frames over a pipe.
#include "frames.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

enum { MOST_FRACTION_BYTES = 32, MOST_SENTENCE_BYTES = 2048 };

bool frame_is_sound(const frame_head *head, bool from_worker)
{
    if (head->name_size >= FRAME_NAME_BYTES) return false;
    switch (head->kind) {
    case FRAME_JOB: return !from_worker && head->size <= 1 << 24;
    case FRAME_FILE: return !from_worker && head->size <= UINT64_C(1) << 31;
    case FRAME_RUN: return !from_worker && head->size == 0;
    case FRAME_PROGRESS: return from_worker && head->size <= MOST_FRACTION_BYTES;
    case FRAME_PIECE: return from_worker && head->size <= PIECE_BYTES;
    case FRAME_COMPLETE: return from_worker && head->size == 0;
    case FRAME_END: return from_worker && head->size <= MOST_SENTENCE_BYTES;
    default: return false;
    }
}

static bool write_whole(int descriptor, const void *from, size_t size)
{
    for (const char *at = from; size > 0;) {
        ssize_t written = write(descriptor, at, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        at += written;
        size -= (size_t)written;
    }
    return true;
}

bool read_whole(int descriptor, void *to, size_t size)
{
    for (char *at = to; size > 0;) {
        ssize_t got = read(descriptor, at, size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        size -= (size_t)got;
    }
    return true;
}

bool frame_write(int descriptor, frame_kind kind, const char *name, const void *data, size_t size)
{
    frame_head head = {.kind = kind, .name_size = (uint32_t)strlen(name), .size = size};
    return write_whole(descriptor, &head, sizeof head) && write_whole(descriptor, name, head.name_size) &&
           write_whole(descriptor, data, size);
}
