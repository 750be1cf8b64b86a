// One process that does one job, as the server sees it.
#ifndef SERVE_CHILD_H
#define SERVE_CHILD_H

#include "frames.h"
#include "serve.h"

enum {
    CHILD_INPUTS = 4, // picture, mesh, printer, edits
    CHILD_FRAMES = 2 + CHILD_INPUTS,
    MOST_PARTS = 3 * CHILD_FRAMES
};

/// What is still to be written to it: bytes that lie elsewhere.
typedef struct part {
    const void *data;
    size_t size;
} part;

/// {0} is none.
typedef struct child {
    pid_t pid;             // 0 = none
    int to, from;          // pipes; to = -1 once all is written
    char job[TOKEN_BYTES]; // "" = waits for one
    double until;          // when it has taken too long
    // The request.
    part part[MOST_PARTS]; // [part_count], the first `written` done, and so much of the next
    int32_t part_count, written;
    size_t written_of_part;
    frame_head head[CHILD_FRAMES];
    char *request;
    blob *held[CHILD_INPUTS];
    // The frame that comes in.
    uint8_t *frame; // [frame_capacity]
    size_t frame_size, frame_capacity;
} child;

/// Start a process that waits for a job. False: the system refuses; errno says why.
bool child_start(child *c, const settings *set);

/// Give it a job; under the lock.
void child_give(child *c, task *t, double most_seconds);

/// Write what the pipe takes. False: it is gone.
bool child_feed(child *c);

/// Read what there is, up to whole frames, and hand each to `frame`. False: no more comes, or it says what no
/// worker of ours would, or `frame` said false.
bool child_listen(child *c,
                  bool (*frame)(void *user, const frame_head *head, const char *name, const uint8_t *data),
                  void *user);

/// End it now, if it has not; its wait status.
int child_end(child *c);

#endif
