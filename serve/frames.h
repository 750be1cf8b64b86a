// What server and worker say to each other over a pipe: frames, their lengths checked before anything is
// kept.
//
// A frame is a head, a name without end mark, and data. To the worker: JOB (data: the request as JSON), FILE
// (one each of what it may read), RUN. From it: PROGRESS (name: stage, data: the fraction as text), PIECE and
// COMPLETE of a file, END (name: the exit code, data: the sentence).
#ifndef SERVE_FRAMES_H
#define SERVE_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum frame_kind {
    FRAME_JOB = 1,
    FRAME_FILE,
    FRAME_RUN,
    FRAME_PROGRESS,
    FRAME_PIECE,
    FRAME_COMPLETE,
    FRAME_END,
    FRAME_KINDS
} frame_kind;

enum { FRAME_NAME_BYTES = 256, PIECE_BYTES = 1 << 20 };

typedef struct frame_head {
    uint32_t kind, name_size; // name_size < FRAME_NAME_BYTES
    uint64_t size;            // of the data
} frame_head;

/// Is this a head that the other side may send? Nothing from a worker is larger than a piece.
bool frame_is_sound(const frame_head *head, bool from_worker);

/// Write a whole frame to a pipe that may block. False: the other side is gone.
bool frame_write(int descriptor, frame_kind kind, const char *name, const void *data, size_t size);

/// Read exactly so many bytes. False: the other side is gone.
bool read_whole(int descriptor, void *to, size_t size);

#endif
