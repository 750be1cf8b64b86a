// The thread pool: a run hands out indices by an atomic counter; workers that are there take part.
//
// Why so:  a picture of a megapixel makes some hundred runs of 10 to 100 us, and a sleeper takes about as
// long to
//          wake. So a worker looks out for the next run for a while before it sleeps, and nobody waits for
//          one that comes late: who has not entered when the indices are out does not enter any more.
// Checked: every test that compares thread counts; the thread sanitizer.
#include "base/pool.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>

enum { LOOKS = 4000 }; // of a worker for the next run, about 50 us

struct pool {
    pthread_mutex_t lock;
    pthread_cond_t wake, finished;
    pthread_t *thread; // [started]
    int32_t started;
    atomic_int inside; // workers that take part in this run; changes under the lock
    atomic_uint runs;  // counts runs, so that a worker knows a new one; changes under the lock
    bool open;         // this run can still be entered
    atomic_bool busy;  // from the first index to the last; a run within a run is its caller's alone
    atomic_bool closing;
    void (*work)(void *shared, int32_t index);
    void *shared;
    int32_t count;
    atomic_int next;
};

static void drain(pool *p)
{
    int32_t index;
    while ((index = atomic_fetch_add(&p->next, 1)) < p->count) p->work(p->shared, index);
}

static inline void look_away(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

static void *worker(void *argument)
{
    pool *p = argument;
    unsigned seen = 0;
    while (!atomic_load(&p->closing)) {
        for (int32_t i = 0; i < LOOKS && atomic_load(&p->runs) == seen; i++) look_away();
        pthread_mutex_lock(&p->lock);
        while (p->runs == seen && !p->closing) pthread_cond_wait(&p->wake, &p->lock);
        seen = p->runs;
        bool enters = p->open;
        p->inside += enters;
        pthread_mutex_unlock(&p->lock);
        if (!enters) continue;
        drain(p);
        pthread_mutex_lock(&p->lock);
        if (--p->inside == 0) pthread_cond_signal(&p->finished);
        pthread_mutex_unlock(&p->lock);
    }
    return NULL;
}

// Workers take no signals: an interrupt must reach the thread that installed its handler.
static void start_workers(pool *p, int32_t wanted)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    while (p->started < wanted && pthread_create(&p->thread[p->started], NULL, worker, p) == 0) p->started++;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

void pool_run(pool *p, int32_t count, void (*work)(void *shared, int32_t index), void *shared)
{
    if (p->started == 0 || count <= 1 || p->busy) {
        for (int32_t i = 0; i < count; i++) work(shared, i);
        return;
    }
    p->busy = true;
    pthread_mutex_lock(&p->lock);
    p->work = work;
    p->shared = shared;
    p->count = count;
    p->next = 0;
    p->open = true;
    p->runs++;
    pthread_cond_broadcast(&p->wake);
    pthread_mutex_unlock(&p->lock);
    drain(p);
    pthread_mutex_lock(&p->lock);
    p->open = false;
    pthread_mutex_unlock(&p->lock);
    for (int32_t i = 0; i < LOOKS && atomic_load(&p->inside) > 0; i++) look_away();
    pthread_mutex_lock(&p->lock);
    while (p->inside > 0) pthread_cond_wait(&p->finished, &p->lock);
    pthread_mutex_unlock(&p->lock);
    p->busy = false;
}

jali_status pool_create(jali_context *ctx, int32_t threads, pool **out)
{
    jali_status status;
    pool *p = NULL;
    TRY(ALLOCATE_CLEARED(ctx, p, 1));
    TRY(ALLOCATE_CLEARED(ctx, p->thread, threads));
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->wake, NULL);
    pthread_cond_init(&p->finished, NULL);
    start_workers(p, threads - 1);
    *out = p;
    return JALI_OK;
done:
    release(ctx, p);
    return status;
}

void pool_free(jali_context *ctx, pool *p)
{
    if (!p) return;
    pthread_mutex_lock(&p->lock);
    p->closing = true;
    pthread_cond_broadcast(&p->wake);
    pthread_mutex_unlock(&p->lock);
    for (int32_t i = 0; i < p->started; i++) pthread_join(p->thread[i], NULL);
    pthread_mutex_destroy(&p->lock);
    pthread_cond_destroy(&p->wake);
    pthread_cond_destroy(&p->finished);
    release(ctx, p->thread);
    release(ctx, p);
}
