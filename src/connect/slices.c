// A large part is cut into slices of rows, which grow side by side against the picture without the part.
//
// Why so:  what is nearest to the part is nearest to one of its slices. What one has found bounds how far the
//          others go. Passes by bands of rows instead would meet after each pass, which takes a few us.
// Dead end: tiles of 128 rows and 8 words, which fit the first cache: with their rims they are twice as many
//          words, and lion's large parts took 8.1 ms instead of 5.
// Checked: tests/test_connect.c: large parts against a plain search, with any number of threads.
#include "connect/slices.h"
#include "base/base.h"

enum { LARGE_WORDS = 1 << 11, LEAST_ROWS = 96 };

typedef struct slice_search {
    jali_context *ctx;
    const jali_bitmap *solid;
    jali_metric metric;
    window whole; // the part's own pixels'
    slices *s;
    int32_t rim;
    atomic_int least; // steps to anything found so far
} slice_search;

int32_t slices_of(jali_context *ctx, const parts *p, int32_t root)
{
    const int32_t *box = p->box[root];
    int32_t rows = box[3] - box[1], most = MIN(threads_of(ctx), MOST_SLICES);
    if ((int64_t)(box[2] - box[0]) * rows < 64 * LARGE_WORDS) return 1;
    return MAX(MIN(most, rows / LEAST_ROWS), 1);
}

// The picture without the part.
static void draw_others(const slice_search *t, const window *w, plane *picture)
{
    const window *whole = &t->whole;
    int32_t shift = (w->x0 - whole->x0) / 64;
    draw_picture(t->solid, w, picture);
    for (int32_t y = MAX(w->y0, whole->y0); y < MIN(w->y0 + w->rows, whole->y0 + whole->rows); y++) {
        const uint64_t *own = row_of(whole, &t->s->own, y - whole->y0);
        uint64_t *row = row_of(w, picture, y - w->y0);
        for (int32_t i = MAX(-shift, 0); i < MIN(w->words, whole->words - shift); i++)
            row[i] &= ~own[i + shift];
    }
}

// What of the part is the slice's.
static void draw_own(const slice_search *t, slice *s)
{
    const window *whole = &t->whole;
    clear_plane(&s->w, &s->g.grown);
    int64_t left = (whole->x0 - s->w.x0) / 64;
    for (int32_t y = s->box[1]; y < s->box[3]; y++)
        memcpy(row_of(&s->w, &s->g.grown, y - s->w.y0) + left, row_of(whole, &t->s->own, y - whole->y0),
               (size_t)whole->words * sizeof(uint64_t));
}

static void search_slice(void *shared, int32_t index)
{
    slice_search *t = shared;
    slice *s = &t->s->each[index];
    if (s->g.steps == 0) draw_own(t, s);
    draw_others(t, &s->w, &s->g.picture);
    s->met = grow_until_met(t->ctx, &s->w, t->rim, &t->least, t->metric, &s->g);
    if (!s->met) return;
    first_met_pixel(&s->w, &s->g, s->to);
    int32_t least = t->least;
    while (s->g.steps < least && !atomic_compare_exchange_weak(&t->least, &least, s->g.steps)) {
    }
}

static bool is_nearer(const slice *a, const slice *b)
{
    if (a->g.steps != b->g.steps) return a->g.steps < b->g.steps;
    return a->to[1] != b->to[1] ? a->to[1] < b->to[1] : a->to[0] < b->to[0];
}

// The nearest that was met, the first in raster order; NULL: nothing was.
static const slice *nearest_met(const slices *s)
{
    const slice *best = NULL;
    for (int32_t i = 0; i < s->count; i++)
        if (s->each[i].met && (!best || is_nearer(&s->each[i], best))) best = &s->each[i];
    return best;
}

static jali_status cut(slice_search *t, const int32_t box[4], slice *s, int32_t index)
{
    int64_t rows = box[3] - box[1], count = t->s->count;
    s->box[0] = box[0];
    s->box[1] = box[1] + (int32_t)(rows * index / count);
    s->box[2] = box[2];
    s->box[3] = box[1] + (int32_t)(rows * (index + 1) / count);
    s->w = window_around(t->solid, s->box, t->rim);
    s->g.steps = 0;
    return make_room(t->ctx, &s->w, &s->g);
}

static jali_status widen_slice(slice_search *t, slice *s)
{
    window narrow = s->w;
    s->w = window_around(t->solid, s->box, t->rim);
    jali_status status = widen(t->ctx, &narrow, &s->w, &s->g);
    return status == JALI_OK ? make_room(t->ctx, &s->w, &s->g) : status;
}

jali_status nearest_by_slices(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                              jali_metric metric, slices *s, jali_bridge *bridge)
{
    jali_status status;
    const slice *nearest = NULL;
    slice_search t = {.ctx = ctx, .solid = solid, .metric = metric, .s = s, .rim = SECOND_RIM_PX};
    t.least = INT32_MAX;
    t.whole = window_around(solid, p->box[root], 0);
    s->count = slices_of(ctx, p, root);
    TRY(make_plane(ctx, &t.whole, &s->own));
    draw_part(p, root, &t.whole, &s->own);
    for (int32_t i = 0; i < s->count; i++) TRY(cut(&t, p->box[root], &s->each[i], i));
    while (true) {
        parallel(ctx, s->count, search_slice, &t);
        if ((nearest = nearest_met(s))) break;
        if (stopping(ctx)) TRY(step(ctx, "connect", 0));
        t.rim = wider_rim(t.rim);
        for (int32_t i = 0; i < s->count; i++) TRY(widen_slice(&t, &s->each[i]));
    }
    memcpy(bridge->to, nearest->to, sizeof bridge->to);
    nearest_own(&t.whole, &s->own, metric, nearest->g.steps, nearest->to, bridge->from);
done:
    return status;
}

void slices_free(jali_context *ctx, slices *s)
{
    for (int32_t i = 0; i < MOST_SLICES; i++) growing_free(ctx, &s->each[i].g);
    plane_free(ctx, &s->own);
    *s = (slices){0};
}
