// Numbers that wait in queues: the lowest queue is served first, each in the order of arrival. Internal.
#ifndef PLANE_WAITING_H
#define PLANE_WAITING_H

#include "base/base.h"

enum { WAITING_QUEUES = 64, WAITING_LAST = -1, NOT_WAITING = -2, NONE_WAITING = -1 };

/// `next` belongs to the caller and holds NOT_WAITING for numbers that wait in no queue.
typedef struct waiting {
    int32_t *next; // [numbers] the next in its queue, WAITING_LAST, or NOT_WAITING
    int32_t first[WAITING_QUEUES], last[WAITING_QUEUES];
    uint64_t filled; // a bit a queue
} waiting;

static inline void wait_in(waiting *w, int32_t number, int queue)
{
    if (w->next[number] != NOT_WAITING) return;
    queue = MIN(MAX(queue, 0), WAITING_QUEUES - 1);
    w->next[number] = WAITING_LAST;
    if (w->filled >> queue & 1)
        w->next[w->last[queue]] = number;
    else
        w->first[queue] = number;
    w->last[queue] = number;
    w->filled |= UINT64_C(1) << queue;
}

/// The first of the lowest queue, or NONE_WAITING.
static inline int32_t next_waiting(waiting *w)
{
    if (!w->filled) return NONE_WAITING;
    int queue = __builtin_ctzll(w->filled);
    int32_t number = w->first[queue];
    w->first[queue] = w->next[number];
    if (w->next[number] == WAITING_LAST) w->filled &= ~(UINT64_C(1) << queue);
    w->next[number] = NOT_WAITING;
    return number;
}

#endif
