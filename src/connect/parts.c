// Parts as lists of runs with a queue by area: what Algorithm 2 asks for its smallest component.
#include "connect/parts.h"
#include "base/base.h"
#include "base/sets.h"

static bool before(const struct part_key *a, const struct part_key *b)
{
    return a->area != b->area ? a->area < b->area : a->root < b->root;
}

jali_status queue_part(jali_context *ctx, parts *p, int32_t root)
{
    jali_status status = GROW(ctx, p->heap, p->heap_capacity, p->heap_count + 1);
    if (status != JALI_OK) return status;
    struct part_key key = {p->area[root], root};
    int32_t i = p->heap_count++;
    for (; i > 0 && before(&key, &p->heap[(i - 1) / 2]); i = (i - 1) / 2) p->heap[i] = p->heap[(i - 1) / 2];
    p->heap[i] = key;
    return JALI_OK;
}

static struct part_key pop(parts *p)
{
    struct part_key top = p->heap[0], last = p->heap[--p->heap_count];
    int32_t i = 0;
    for (int32_t child; (child = 2 * i + 1) < p->heap_count; i = child) {
        if (child + 1 < p->heap_count && before(&p->heap[child + 1], &p->heap[child])) child++;
        if (!before(&p->heap[child], &last)) break;
        p->heap[i] = p->heap[child];
    }
    p->heap[i] = last;
    return top;
}

static bool is_stale(const parts *p, const struct part_key *key)
{
    return p->parent[key->root] != key->root || p->area[key->root] != key->area;
}

bool smallest_part(parts *p, int32_t *root)
{
    while (p->front_count + p->heap_count > 0) {
        bool in_front =
            p->front_count > 0 && (p->heap_count == 0 || before(&p->front[p->front_count - 1], &p->heap[0]));
        struct part_key key = in_front ? p->front[--p->front_count] : pop(p);
        *root = key.root;
        if (!is_stale(p, &key)) return true;
    }
    return false;
}

static void put_in_front(parts *p, struct part_key key)
{
    int32_t i = p->front_count++;
    for (; i > 0 && before(&p->front[i - 1], &key); i--) p->front[i] = p->front[i - 1];
    p->front[i] = key;
}

int32_t next_parts(parts *p, int32_t most, int32_t *root)
{
    int32_t count = 0;
    while (p->front_count < MIN(most, MOST_IN_FRONT) && p->heap_count > 0) {
        struct part_key key = pop(p);
        if (!is_stale(p, &key)) put_in_front(p, key);
    }
    for (int32_t i = p->front_count - 1; i >= 0 && count < most; i--)
        if (!is_stale(p, &p->front[i])) root[count++] = p->front[i].root;
    return count;
}

int32_t label_at(const parts *p, int32_t x, int32_t y)
{
    int32_t run = run_at(&p->c, x, y);
    if (run >= 0) return p->c.label[run];
    for (run = p->row_bridge[y]; p->run[run].x0 > x || p->run[run].x1 <= x; run = p->run[run].below) {
    }
    return p->run[run].label;
}

int32_t root_of_label(parts *p, int32_t label)
{
    return root_of(p->parent, label);
}

static void extend_box(int32_t box[4], int32_t y, int32_t x0, int32_t x1)
{
    box[0] = MIN(box[0], x0);
    box[1] = MIN(box[1], y);
    box[2] = MAX(box[2], x1);
    box[3] = MAX(box[3], y + 1);
}

// Along its row a bridge's run grows.
static bool extend_last_run(parts *p, int32_t root, int32_t label, int32_t x, int32_t y)
{
    int32_t last = p->tail[root];
    struct part_run *run = &p->run[last];
    if (last < p->c.run_count || run->y != y || run->label != label) return false;
    if (x != run->x1 && x != run->x0 - 1) return false;
    run->x0 = MIN(run->x0, x);
    run->x1 = MAX(run->x1, x + 1);
    return true;
}

static jali_status add_run(jali_context *ctx, parts *p, int32_t root, int32_t label, int32_t x, int32_t y)
{
    jali_status status = GROW(ctx, p->run, p->run_capacity, p->run_count + 1);
    if (status != JALI_OK) return status;
    int32_t i = p->run_count++;
    p->run[i] = (struct part_run){y, x, x + 1, -1, label, p->row_bridge[y]};
    p->row_bridge[y] = i;
    p->run[p->tail[root]].next = i;
    p->tail[root] = i;
    return JALI_OK;
}

jali_status part_add_pixel(jali_context *ctx, parts *p, int32_t root, int32_t label, int32_t x, int32_t y)
{
    jali_status status = JALI_OK;
    if (!extend_last_run(p, root, label, x, y)) status = add_run(ctx, p, root, label, x, y);
    if (status != JALI_OK) return status;
    p->area[root]++;
    extend_box(p->box[root], y, x, x + 1);
    return JALI_OK;
}

int32_t unite_parts(parts *p, int32_t a, int32_t b)
{
    if (a == b) return a;
    int32_t root = MIN(a, b), child = MAX(a, b);
    p->parent[child] = root;
    p->run[p->tail[root]].next = p->head[child];
    p->tail[root] = p->tail[child];
    p->area[root] += p->area[child];
    extend_box(p->box[root], p->box[child][1], p->box[child][0], p->box[child][2]);
    p->box[root][3] = MAX(p->box[root][3], p->box[child][3]);
    p->alive--;
    return root;
}

// Runs part by part, so that walking a part's list goes on through memory.
static void fill_parts(parts *p)
{
    const components *c = &p->c;
    for (int32_t i = 0; i < c->count; i++) {
        p->parent[i] = i;
        p->tail[i] = 0;
        p->box[i][0] = p->box[i][1] = INT32_MAX;
        p->box[i][2] = p->box[i][3] = 0;
    }
    for (int32_t i = 0; i < c->run_count; i++) p->tail[c->label[i]]++;
    for (int32_t i = 0, first = 0; i < c->count; i++) {
        p->head[i] = first;
        first += p->tail[i];
        p->tail[i] = p->head[i] - 1;
    }
    for (int32_t y = 0; y < c->height_px; y++) {
        p->row_bridge[y] = -1;
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++) {
            int32_t label = c->label[i], slot = ++p->tail[label];
            p->run[slot] = (struct part_run){y, c->span[i][0], c->span[i][1], slot + 1, label, -1};
            p->area[label] += c->span[i][1] - c->span[i][0];
            extend_box(p->box[label], y, c->span[i][0], c->span[i][1]);
        }
    }
    for (int32_t i = 0; i < c->count; i++) p->run[p->tail[i]].next = -1;
}

jali_status parts_create(jali_context *ctx, const jali_bitmap *drawing, parts *out)
{
    jali_status status;
    parts p = {0};
    TRY(label_components(ctx, drawing, true, 4, &p.c));
    p.alive = p.c.count;
    if (p.alive < 2) goto done; // there is nothing to join
    p.run_count = p.c.run_count;
    size_t capacity = (size_t)p.c.run_count + (size_t)p.c.run_count / 8 + 1024; // bridges' runs follow
    TRY(ALLOCATE(ctx, p.parent, p.c.count));
    TRY(ALLOCATE_CLEARED(ctx, p.area, p.c.count));
    TRY(ALLOCATE(ctx, p.box, p.c.count));
    TRY(ALLOCATE(ctx, p.head, p.c.count));
    TRY(ALLOCATE(ctx, p.tail, p.c.count));
    TRY(ALLOCATE(ctx, p.run, capacity));
    p.run_capacity = capacity;
    TRY(ALLOCATE(ctx, p.row_bridge, drawing->height_px));
    fill_parts(&p);
    for (int32_t i = 0; i < p.c.count; i++) TRY(queue_part(ctx, &p, i));
done:
    if (status != JALI_OK) parts_free(ctx, &p);
    *out = p;
    return status;
}

void parts_free(jali_context *ctx, parts *p)
{
    components_free(ctx, &p->c);
    release(ctx, p->parent);
    release(ctx, p->area);
    release(ctx, p->box);
    release(ctx, p->head);
    release(ctx, p->tail);
    release(ctx, p->run);
    release(ctx, p->row_bridge);
    release(ctx, p->heap);
    *p = (parts){0};
}
