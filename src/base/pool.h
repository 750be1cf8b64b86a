// The thread pool behind parallel().
#ifndef BASE_POOL_H
#define BASE_POOL_H

#include "base/base.h"

typedef struct pool pool;

/// threads counts the caller's own, so threads - 1 are started; they sleep until pool_run.
jali_status pool_create(jali_context *ctx, int32_t threads, pool **out);
void pool_free(jali_context *ctx, pool *p);
void pool_run(pool *p, int32_t count, void (*work)(void *shared, int32_t index), void *shared);

#endif
