// The thread pool: works hand out their indices by an atomic counter; workers that are free take part.
//
// Why so:  a picture of a megapixel makes some hundred runs of 10 to 100 us, and a sleeper takes about as
// long to
//          wake. So a worker looks out for the next work for a while before it sleeps, and nobody waits for
//          one that comes late: who has not entered when the indices are out does not enter any more. Of
//          several works that are open the oldest comes first: it is the coarsest.
// Checked: tests/test_base.c; every test that compares thread counts; the thread sanitizer.
#include "base/pool.h"

#include <pthread.h>
#include <signal.h>

enum { LOOKS = 4000 }; // of a worker for the next run, about 50 us

struct pool {
    pthread_mutex_t lock;
    pthread_cond_t wake, finished;
    pthread_t *thread; // [started]
    int32_t started;
    atomic_uint offers; // counts them, so that a worker knows a new one; changes under the lock
    pool_work *open;    // the oldest; under the lock
    atomic_bool closing;
};

static void drain(pool_work *w)
{
    int32_t index;
    while ((index = atomic_fetch_add(&w->next, 1)) < w->count) w->work(w->shared, index);
}

static inline void look_away(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

// The oldest work that has indices left.
static pool_work *oldest(const pool *p)
{
    pool_work *w = p->open;
    while (w && atomic_load(&w->next) >= w->count) w = w->next_open;
    return w;
}

static void *worker(void *argument)
{
    pool *p = argument;
    unsigned seen = 0;
    while (!atomic_load(&p->closing)) {
        for (int32_t i = 0; i < LOOKS && atomic_load(&p->offers) == seen; i++) look_away();
        pthread_mutex_lock(&p->lock);
        while (p->offers == seen && !p->closing) pthread_cond_wait(&p->wake, &p->lock);
        seen = p->offers;
        for (pool_work *w; (w = oldest(p));) {
            w->inside++;
            pthread_mutex_unlock(&p->lock);
            drain(w);
            pthread_mutex_lock(&p->lock);
            if (--w->inside == 0) pthread_cond_broadcast(&p->finished);
        }
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

void pool_offer(pool *p, pool_work *w, int32_t count, void (*work)(void *shared, int32_t index), void *shared)
{
    w->work = work;
    w->shared = shared;
    w->count = count;
    w->next_open = NULL;
    atomic_init(&w->next, 0);
    atomic_init(&w->inside, 0);
    if (p->started == 0) return;
    pthread_mutex_lock(&p->lock);
    pool_work **last = &p->open;
    while (*last) last = &(*last)->next_open;
    *last = w;
    p->offers++;
    pthread_cond_broadcast(&p->wake);
    pthread_mutex_unlock(&p->lock);
}

void pool_finish(pool *p, pool_work *w)
{
    drain(w);
    if (p->started == 0) return;
    pthread_mutex_lock(&p->lock);
    pool_work **at = &p->open;
    while (*at != w) at = &(*at)->next_open;
    *at = w->next_open;
    pthread_mutex_unlock(&p->lock);
    for (int32_t i = 0; i < LOOKS && atomic_load(&w->inside) > 0; i++) look_away();
    pthread_mutex_lock(&p->lock);
    while (w->inside > 0) pthread_cond_wait(&p->finished, &p->lock);
    pthread_mutex_unlock(&p->lock);
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
