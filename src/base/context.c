// The context: who allocates, who is told, what went wrong last.
//
// Every block carries a 64-byte head with its size, so that the peak is known and --max-memory is a sentence
// instead of a killed process.
#include "base/pool.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#ifndef JALI_VERSION
#define JALI_VERSION "0.0.0"
#endif

enum { HEAD_BYTES = 64, MESSAGE_BYTES = 512, ARENA_CHUNK_BYTES = 1 << 20 };

typedef struct block_head {
    void *raw;    // what the allocator gave
    size_t bytes; // what was asked for
} block_head;

typedef struct arena_chunk {
    struct arena_chunk *below;
    size_t used, capacity;
} arena_chunk;

struct jali_context {
    jali_context_options opt;
    jali_context *trunk; // of a branch (do_both): whose memory, limits and threads these are; else itself
    atomic_bool cancelled;
    _Atomic uint64_t held_bytes, peak_bytes; // of the trunk, as are:
    pthread_mutex_t allocating;              // the caller's allocator serves one at a time
    double deadline_seconds;                 // 0 = none
    pool *pool;
    bool sharing; // parallel() is at work; what that calls is its thread's alone
    arena_chunk *arena;
    char message[MESSAGE_BYTES];
};

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void *default_allocate(void *user, size_t bytes)
{
    (void)user;
    return malloc(bytes);
}

static void default_release(void *user, void *block)
{
    (void)user;
    free(block);
}

jali_context_options jali_context_defaults(void)
{
    return (jali_context_options){.allocate = default_allocate, .release = default_release};
}

const char *jali_version(void)
{
    return JALI_VERSION;
}

const char *jali_message(const jali_context *ctx)
{
    return ctx ? ctx->message : "";
}

void jali_cancel(jali_context *ctx)
{
    atomic_store(&ctx->cancelled, true);
}

uint64_t jali_peak_memory_bytes(const jali_context *ctx)
{
    return atomic_load(&ctx->peak_bytes);
}

jali_status fail(jali_context *ctx, jali_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(ctx->message, sizeof ctx->message, format, arguments);
    va_end(arguments);
    return status;
}

static void account(jali_context *trunk, uint64_t bytes)
{
    uint64_t held = atomic_fetch_add(&trunk->held_bytes, bytes) + bytes;
    uint64_t peak = atomic_load(&trunk->peak_bytes);
    while (held > peak && !atomic_compare_exchange_weak(&trunk->peak_bytes, &peak, held)) {
    }
}

static jali_status within_limit(jali_context *ctx, uint64_t bytes)
{
    if (ctx->opt.max_memory_bytes && atomic_load(&ctx->trunk->held_bytes) + bytes > ctx->opt.max_memory_bytes)
        return fail(ctx, JALI_LIMIT, "%.0f MB more would pass the memory limit of %.0f MB (--max-memory)",
                    (double)bytes / 1e6, (double)ctx->opt.max_memory_bytes / 1e6);
    return JALI_OK;
}

jali_status allocate_array(jali_context *ctx, void *where, size_t count, size_t size)
{
    void *none = NULL;
    memcpy(where, &none, sizeof none);
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX / 2)
        return fail(ctx, JALI_NO_MEMORY, "%zu items of %zu bytes are more than memory can address", count,
                    size);
    jali_status status = within_limit(ctx, bytes);
    if (status != JALI_OK) return status;
    pthread_mutex_lock(&ctx->trunk->allocating);
    char *raw = ctx->opt.allocate(ctx->opt.user, bytes + 2 * HEAD_BYTES);
    pthread_mutex_unlock(&ctx->trunk->allocating);
    if (!raw) return fail(ctx, JALI_NO_MEMORY, "no memory for %.3f MB more", (double)bytes / 1e6);
    char *block = raw + HEAD_BYTES + (HEAD_BYTES - (uintptr_t)raw % HEAD_BYTES);
    *(block_head *)(block - HEAD_BYTES) = (block_head){raw, bytes};
    account(ctx->trunk, bytes);
    memcpy(where, &block, sizeof block);
    return JALI_OK;
}

enum { CLEAR_BYTES = 1 << 17 }; // at a time

typedef struct clearing {
    char *block;
    size_t bytes;
} clearing;

static void clear_piece(void *shared, int32_t piece)
{
    const clearing *c = shared;
    size_t from = (size_t)piece * CLEAR_BYTES;
    memset(c->block + from, 0, MIN(CLEAR_BYTES, c->bytes - from));
}

jali_status allocate_cleared(jali_context *ctx, void *where, size_t count, size_t size)
{
    jali_status status = allocate_array(ctx, where, count, size);
    void *block;
    memcpy(&block, where, sizeof block);
    clearing c = {block, block ? count * size : 0};
    if (c.bytes > 2 * (size_t)CLEAR_BYTES && c.bytes / CLEAR_BYTES < INT32_MAX)
        parallel(ctx, (int32_t)((c.bytes + CLEAR_BYTES - 1) / CLEAR_BYTES), clear_piece, &c);
    else if (block)
        memset(block, 0, c.bytes);
    return status;
}

void release(jali_context *ctx, void *block)
{
    if (!block) return;
    block_head head = *(block_head *)((char *)block - HEAD_BYTES);
    atomic_fetch_sub(&ctx->trunk->held_bytes, head.bytes);
    pthread_mutex_lock(&ctx->trunk->allocating);
    ctx->opt.release(ctx->opt.user, head.raw);
    pthread_mutex_unlock(&ctx->trunk->allocating);
}

jali_status grow_array(jali_context *ctx, void *where, size_t *capacity, size_t needed, size_t size)
{
    if (needed <= *capacity) return JALI_OK;
    size_t wanted = MAX(MAX(needed, *capacity + *capacity / 2), 16);
    void *old, *larger;
    memcpy(&old, where, sizeof old);
    jali_status status = allocate_array(ctx, &larger, wanted, size);
    if (status != JALI_OK) return status;
    if (old) memcpy(larger, old, *capacity * size);
    release(ctx, old);
    memcpy(where, &larger, sizeof larger);
    *capacity = wanted;
    return JALI_OK;
}

arena_mark arena_here(jali_context *ctx)
{
    return (arena_mark){ctx->arena, ctx->arena ? ctx->arena->used : 0};
}

void arena_rewind(jali_context *ctx, arena_mark mark)
{
    while (ctx->arena != mark.chunk) {
        arena_chunk *top = ctx->arena;
        ctx->arena = top->below;
        release(ctx, top);
    }
    if (ctx->arena) ctx->arena->used = mark.used;
}

jali_status arena_take(jali_context *ctx, void *where, size_t count, size_t size)
{
    void *none = NULL;
    memcpy(where, &none, sizeof none);
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX / 2)
        return fail(ctx, JALI_NO_MEMORY, "%zu items of %zu bytes are more than memory can address", count,
                    size);
    bytes = (bytes + HEAD_BYTES - 1) / HEAD_BYTES * HEAD_BYTES;
    if (!ctx->arena || ctx->arena->capacity - ctx->arena->used < bytes) {
        arena_chunk *chunk;
        size_t capacity = MAX(bytes, (size_t)ARENA_CHUNK_BYTES);
        jali_status status = allocate_array(ctx, &chunk, HEAD_BYTES + capacity, 1);
        if (status != JALI_OK) return status;
        *chunk = (arena_chunk){ctx->arena, 0, capacity};
        ctx->arena = chunk;
    }
    char *piece = (char *)ctx->arena + HEAD_BYTES + ctx->arena->used;
    ctx->arena->used += bytes;
    memcpy(where, &piece, sizeof piece);
    return JALI_OK;
}

const jali_files *files_of(const jali_context *ctx)
{
    return ctx->opt.files;
}

void parallel(jali_context *ctx, int32_t count, void (*work)(void *shared, int32_t index), void *shared)
{
    pool_work w;
    if (count <= 1 || ctx->sharing || ctx->opt.threads == 1) {
        for (int32_t i = 0; i < count; i++) work(shared, i);
        return;
    }
    ctx->sharing = true;
    pool_offer(ctx->pool, &w, count, work, shared);
    pool_finish(ctx->pool, &w);
    ctx->sharing = false;
}

typedef struct branch {
    jali_context ctx;
    jali_status (*task)(jali_context *ctx, void *of_task);
    void *of_task;
    jali_status status;
} branch;

static void run_branch(void *shared, int32_t index)
{
    branch *b = shared;
    (void)index;
    b->status = b->task(&b->ctx, b->of_task);
}

jali_status do_both(jali_context *ctx, jali_status (*own)(jali_context *ctx, void *of_own), void *of_own,
                    jali_status (*other)(jali_context *ctx, void *of_other), void *of_other)
{
    pool_work w;
    branch b = {.ctx = {.opt = ctx->opt,
                        .trunk = ctx->trunk,
                        .deadline_seconds = ctx->deadline_seconds,
                        .pool = ctx->pool,
                        .sharing = ctx->sharing},
                .task = other,
                .of_task = of_other};
    b.ctx.opt.progress = NULL; // which is told on the caller's thread
    bool alone = ctx->sharing || ctx->opt.threads == 1;
    if (!alone) pool_offer(ctx->pool, &w, 1, run_branch, &b);
    jali_status status = own(ctx, of_own);
    if (status != JALI_OK) atomic_store(&b.ctx.cancelled, true);
    if (!alone)
        pool_finish(ctx->pool, &w);
    else
        run_branch(&b, 0);
    arena_rewind(&b.ctx, (arena_mark){0});
    if (status != JALI_OK || b.status == JALI_OK) return status;
    return fail(ctx, b.status, "%s", b.ctx.message);
}

int32_t threads_of(const jali_context *ctx)
{
    return ctx->opt.threads;
}

static bool is_cancelled(const jali_context *ctx)
{
    return atomic_load_explicit(&ctx->cancelled, memory_order_relaxed) ||
           atomic_load_explicit(&ctx->trunk->cancelled, memory_order_relaxed);
}

bool stopping(const jali_context *ctx)
{
    return is_cancelled(ctx) || (ctx->deadline_seconds > 0 && now_seconds() > ctx->deadline_seconds);
}

jali_status step(jali_context *ctx, const char *stage, double fraction)
{
    if (is_cancelled(ctx)) return fail(ctx, JALI_CANCELLED, "interrupted during %s", stage);
    if (ctx->deadline_seconds > 0 && now_seconds() > ctx->deadline_seconds)
        return fail(ctx, JALI_LIMIT, "the time limit of %g s was reached during %s (--timeout)",
                    ctx->opt.timeout_seconds, stage);
    if (ctx->opt.progress) ctx->opt.progress(ctx->opt.user, stage, fraction);
    return JALI_OK;
}

jali_status jali_context_create(const jali_context_options *given, jali_context **out)
{
    *out = NULL;
    jali_context_options opt = given ? *given : jali_context_defaults();
    if (opt.threads < 0 || opt.threads > 1024 || !(opt.timeout_seconds >= 0)) return JALI_BAD_VALUE;
    if (!opt.allocate) opt.allocate = default_allocate;
    if (!opt.release) opt.release = default_release;
    if (opt.threads == 0) opt.threads = (int32_t)MAX(sysconf(_SC_NPROCESSORS_ONLN), 1);
    jali_context *ctx = opt.allocate(opt.user, sizeof *ctx);
    if (!ctx) return JALI_NO_MEMORY;
    memset(ctx, 0, sizeof *ctx);
    ctx->opt = opt;
    ctx->trunk = ctx;
    pthread_mutex_init(&ctx->allocating, NULL);
    if (opt.timeout_seconds > 0) ctx->deadline_seconds = now_seconds() + opt.timeout_seconds;
    jali_status status = pool_create(ctx, opt.threads, &ctx->pool);
    if (status != JALI_OK) {
        pthread_mutex_destroy(&ctx->allocating);
        opt.release(opt.user, ctx);
        return status;
    }
    *out = ctx;
    return JALI_OK;
}

void jali_context_free(jali_context *ctx)
{
    if (!ctx) return;
    arena_rewind(ctx, (arena_mark){0});
    pool_free(ctx, ctx->pool);
    jali_context_options opt = ctx->opt;
    pthread_mutex_destroy(&ctx->allocating);
    opt.release(opt.user, ctx);
}
