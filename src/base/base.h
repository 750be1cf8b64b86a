// The toolbox below everything: memory, messages, threads, progress. Internal.
#ifndef BASE_BASE_H
#define BASE_BASE_H

#include <jali/base.h>
#include <string.h>

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        status = (call);                                                                                     \
        if (status != JALI_OK) goto done;                                                                    \
    } while (0)

#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))

// Functions marked so are compiled for several instruction sets and chosen at load time; the plain one is the
// portable twin. Sanitizers cannot start through such a choice, so they get the plain one alone.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(JALI_PORTABLE)
#define VECTORISED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define VECTORISED
#endif

/// Keep the sentence in the context and hand the status back.
jali_status fail(jali_context *ctx, jali_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Store a block of count * size bytes, 64-byte aligned and not cleared, in the pointer at `where`.
///   fails  JALI_NO_MEMORY (also when the product overflows), JALI_LIMIT; the pointer is then NULL
jali_status allocate_array(jali_context *ctx, void *where, size_t count, size_t size);
#define ALLOCATE(ctx, pointer, count) allocate_array((ctx), &(pointer), (size_t)(count), sizeof *(pointer))

/// The same, cleared.
jali_status allocate_cleared(jali_context *ctx, void *where, size_t count, size_t size);
#define ALLOCATE_CLEARED(ctx, pointer, count)                                                                \
    allocate_cleared((ctx), &(pointer), (size_t)(count), sizeof *(pointer))

/// Make the array at `where` hold at least `needed` items, keeping its first `*capacity` ones; grows by half.
///   fails  as allocate_array; the array is then unchanged
jali_status grow_array(jali_context *ctx, void *where, size_t *capacity, size_t needed, size_t size);
#define GROW(ctx, pointer, capacity, needed)                                                                 \
    grow_array((ctx), &(pointer), &(capacity), (size_t)(needed), sizeof *(pointer))

/// Give a block back; NULL is accepted.
void release(jali_context *ctx, void *block);

/// Scratch memory of one stage: take pieces, then rewind to where the stage began.
typedef struct arena_mark {
    void *chunk;
    size_t used;
} arena_mark;
arena_mark arena_here(jali_context *ctx);
void arena_rewind(jali_context *ctx, arena_mark mark);
jali_status arena_take(jali_context *ctx, void *where, size_t count, size_t size);
#define ARENA(ctx, pointer, count) arena_take((ctx), &(pointer), (size_t)(count), sizeof *(pointer))

/// The files of a run that may open none; NULL: the system's. What opens files asks src/base/file.h and
/// lines.h.
const jali_files *files_of(const jali_context *ctx);

/// Call work(shared, i) for i = 0 .. count-1 on the pool's threads. The order is not defined, so each i
/// writes to a place of its own; `work` allocates nothing. Items, not threads, set the split: any thread
/// count gives the same result. What `work` calls that is parallel too runs in its own thread.
void parallel(jali_context *ctx, int32_t count, void (*work)(void *shared, int32_t index), void *shared);

/// Two tasks at one time: `own` in this thread, `other` in one of the pool's or, when none is free, after it.
/// Both may allocate, fail and be parallel within; they share nothing that either changes. `other` has a
/// context of its own, which tells no progress; when `own` fails, it is cancelled.
///   fails  as `own`, else as `other`
jali_status do_both(jali_context *ctx, jali_status (*own)(jali_context *ctx, void *of_own), void *of_own,
                    jali_status (*other)(jali_context *ctx, void *of_other), void *of_other);

/// How many threads parallel() takes, the caller's own counted.
int32_t threads_of(const jali_context *ctx);

/// Report progress (fraction 0 .. 1 of this stage) and ask whether to go on.
///   fails  JALI_CANCELLED, JALI_LIMIT (time)
jali_status step(jali_context *ctx, const char *stage, double fraction);

/// A cheap test for long kernels: true once the run should stop; step() then says why.
bool stopping(const jali_context *ctx);

#endif
