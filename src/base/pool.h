// The thread pool behind parallel() and do_both().
#ifndef BASE_POOL_H
#define BASE_POOL_H

#include "base/base.h"

#include <stdatomic.h>

typedef struct pool pool;

/// Work that is open to the pool's threads. Lies with whoever offers it, until pool_finish.
typedef struct pool_work {
    void (*work)(void *shared, int32_t index);
    void *shared;
    int32_t count;
    atomic_int next;   // the first index that nobody has taken
    atomic_int inside; // workers that take part; changes under the pool's lock
    struct pool_work *next_open;
} pool_work;

/// threads counts the caller's own, so threads - 1 are started; they sleep until something is offered.
jali_status pool_create(jali_context *ctx, int32_t threads, pool **out);
void pool_free(jali_context *ctx, pool *p);

/// Let the workers begin; several works may be open at one time.
void pool_offer(pool *p, pool_work *w, int32_t count, void (*work)(void *shared, int32_t index),
                void *shared);

/// Do what nobody has begun, and wait for the rest.
void pool_finish(pool *p, pool_work *w);

#endif
