// Crossings of triangles in general position.
//
// Every decision is the exact sign of a determinant of vertices; only the places of the points are rounded,
// to 1e-15 of the mesh's size. Which end of a segment a point is, follows from the way its edge goes through
// the triangle: an edge of a face, run with the face on its left, that comes from the front of another leaves
// the face along the product of their normals.
//
// Checked: tests/test_merge.c.
#include "mesh/crossings.h"

#include <stdlib.h>

enum { MOST_PAIRS = 4000000 };

// An edge of a face through the other face of a pair, before equal ones are made one.
typedef struct event {
    int32_t low, high, face;
    int32_t segment, end;
    double along;
} event;

typedef struct finding_crossings {
    jali_context *ctx;
    const exact_surface *s;
    crossings *c;
    size_t segment_capacity, event_capacity;
    event *event;
    int32_t event_count;
} finding_crossings;

void crossings_free(jali_context *ctx, crossings *c)
{
    release(ctx, c->point);
    release(ctx, c->edge_point);
    release(ctx, c->segment);
    *c = (crossings){0};
}

// ---- pairs ----

static int compare_segments(const void *left, const void *right)
{
    const segment *a = left, *b = right;
    if (a->face[0] != b->face[0]) return a->face[0] < b->face[0] ? -1 : 1;
    return a->face[1] < b->face[1] ? -1 : a->face[1] > b->face[1];
}

static int shared_vertices(const int32_t a[3], const int32_t b[3], int32_t *one)
{
    int count = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (a[i] == b[j]) *one = a[i], count++;
    return count;
}

static jali_status list_pairs(finding_crossings *f, const bool *met)
{
    jali_status status = JALI_OK;
    const exact_surface *s = f->s;
    crossings *c = f->c;
    for (int32_t place = 0; place < s->face_count; place++) {
        int32_t a = s->face[s->tree.item[place]];
        if (!met[a]) continue;
        box b = box_of_triangle(s->l, s->triangle[a]);
        box_walk walk = box_walk_start(&s->tree, &b, place + 1);
        for (int32_t other; (other = box_walk_next(&walk)) >= 0;) {
            int32_t d = s->face[s->tree.item[other]];
            if (!met[d] || !triangles_meet(s->l, s->triangle[a], s->triangle[d])) continue;
            if (c->segment_count == MOST_PAIRS)
                TRY(fail(f->ctx, JALI_LIMIT, "more than %d pairs of triangles intersect", MOST_PAIRS));
            TRY(GROW(f->ctx, c->segment, f->segment_capacity, c->segment_count + 1));
            c->segment[c->segment_count++] = (segment){{MIN(a, d), MAX(a, d)}, {-1, -1}};
        }
    }
    if (c->segment_count) qsort(c->segment, (size_t)c->segment_count, sizeof *c->segment, compare_segments);
done:
    return status;
}

// ---- edges through triangles ----

// +1 when the edge goes through the triangle from its front to its back, -1 the other way, 0 not at all.
static int goes_through(const lattice *l, const int64_t *p, const int64_t *q, const int64_t *const t[3],
                        const normal *n, bool *degenerate)
{
    int before = side_of(l->narrow, n, t[0], p), behind = side_of(l->narrow, n, t[0], q), turn = 0;
    if (before == 0 || behind == 0) *degenerate = true;
    if (before == behind) return 0;
    for (int k = 0; k < 3; k++) {
        int here = turn_in_space(l->narrow, p, q, t[k], t[(k + 1) % 3]);
        if (turn * here < 0) return 0;
        if (here)
            turn = here;
        else
            *degenerate = true;
    }
    return before;
}

static double share_before(const normal *n, const int64_t *a, const int64_t *p, const int64_t *q)
{
    int128 whole = 0, part = 0;
    for (int k = 0; k < 3; k++) {
        part += n->along[k] * (p[k] - a[k]);
        whole += n->along[k] * (p[k] - q[k]);
    }
    return (double)((long double)part / (long double)whole);
}

// The edges of face `from` through face `into` of a pair.
static jali_status add_events(finding_crossings *f, int32_t pair, int from)
{
    jali_status status = JALI_OK;
    const lattice *l = f->s->l;
    const int32_t *face = f->c->segment[pair].face;
    const int32_t *a = f->s->triangle[face[from]], *b = f->s->triangle[face[1 - from]];
    const int64_t *const t[3] = {l->point[b[0]], l->point[b[1]], l->point[b[2]]};
    normal n = normal_of(l->narrow, t[0], t[1], t[2]);
    for (int k = 0; k < 3; k++) {
        int32_t p = a[k], q = a[(k + 1) % 3];
        if (p == b[0] || p == b[1] || p == b[2] || q == b[0] || q == b[1] || q == b[2]) continue;
        int through = goes_through(l, l->point[p], l->point[q], t, &n, &f->c->degenerate);
        if (through == 0 || f->c->degenerate) continue;
        int32_t low = MIN(p, q), high = MAX(p, q);
        TRY(GROW(f->ctx, f->event, f->event_capacity, f->event_count + 1));
        f->event[f->event_count++] = (event){low,
                                             high,
                                             face[1 - from],
                                             pair,
                                             (through > 0) == (from == 0),
                                             share_before(&n, t[0], l->point[low], l->point[high])};
    }
done:
    return status;
}

static int compare_events(const void *left, const void *right)
{
    const event *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    if (a->along != b->along) return a->along < b->along ? -1 : 1;
    if (a->face != b->face) return a->face < b->face ? -1 : 1;
    return a->segment < b->segment ? -1 : a->segment > b->segment;
}

static jali_status create_points(finding_crossings *f)
{
    jali_status status;
    const lattice *l = f->s->l;
    crossings *c = f->c;
    TRY(GROW(f->ctx, c->point, c->point_capacity, (size_t)l->point_count + (size_t)f->event_count));
    TRY(ALLOCATE(f->ctx, c->edge_point, f->event_count));
    for (int32_t v = 0; v < l->point_count; v++)
        for (int k = 0; k < 3; k++) c->point[v][k] = (double)l->point[v][k];
    c->point_count = l->point_count;
    for (int32_t i = 0; i < f->event_count; i++) {
        const event *e = &f->event[i], *last = i ? e - 1 : NULL;
        if (!last || last->low != e->low || last->high != e->high || last->face != e->face) {
            if (last && last->low == e->low && last->high == e->high && last->along == e->along)
                c->degenerate = true; // the order of two points on one edge is not known
            c->edge_point[c->edge_point_count++] =
                (edge_point){e->low, e->high, e->face, c->point_count, e->along};
            const int64_t *p = l->point[e->low], *q = l->point[e->high];
            for (int k = 0; k < 3; k++)
                c->point[c->point_count][k] = (double)p[k] + e->along * (double)(q[k] - p[k]);
            c->point_count++;
        }
        int32_t *end = &c->segment[e->segment].end[e->end];
        if (*end >= 0) c->degenerate = true;
        *end = c->point_count - 1;
    }
done:
    return status;
}

// A vertex that both triangles have is an end of what they share.
static void close_segments(finding_crossings *f)
{
    for (int32_t i = 0; i < f->c->segment_count; i++) {
        segment *s = &f->c->segment[i];
        int32_t vertex = -1;
        int shared = shared_vertices(f->s->triangle[s->face[0]], f->s->triangle[s->face[1]], &vertex);
        int open = (s->end[0] < 0) + (s->end[1] < 0);
        if (shared > 1 || open != shared)
            f->c->degenerate = true;
        else if (open)
            s->end[s->end[0] < 0 ? 0 : 1] = vertex;
    }
}

jali_status find_crossings(jali_context *ctx, const exact_surface *s, const bool *met, crossings *c)
{
    jali_status status;
    finding_crossings f = {.ctx = ctx, .s = s, .c = c};
    *c = (crossings){.degenerate = !s->l->narrow};
    TRY(list_pairs(&f, met));
    for (int32_t i = 0; i < c->segment_count && !c->degenerate; i++)
        for (int from = 0; from < 2; from++) TRY(add_events(&f, i, from));
    if (c->degenerate) goto done;
    if (f.event_count) qsort(f.event, (size_t)f.event_count, sizeof *f.event, compare_events);
    TRY(create_points(&f));
    close_segments(&f);
done:
    release(ctx, f.event);
    if (status != JALI_OK) crossings_free(ctx, c);
    return status;
}
