// Cutting faces along segments.
//
// Each face has a frame: its plane seen along the axis that flattens it least, on a lattice 2^22 times finer
// than the face. Segments that cross there do so in a point that three faces share; all three must find it,
// or the places were too close to tell. A constrained triangulation does the rest.
//
// Checked: tests/test_merge.c.
#include "mesh/cut.h"

#include "plane/exact.h"
#include "plane/triangulation.h"

#include <math.h>
#include <stdlib.h>

enum { FRAME_LOG2 = 22, MOST_IN_A_FACE = 30000 };

// A place where three faces meet, as one of them sees it.
typedef struct triple {
    int32_t face[3]; // ascending
    int32_t seen_by;
    double at[3];
    int32_t point;
} triple;

typedef struct frame {
    int across, up; // axes; counter-clockwise seen from the front
    double origin[2], scale;
} frame;

typedef struct cutting {
    jali_context *ctx;
    const exact_surface *s;
    crossings *c;
    cut_faces *cut;
    int32_t *first, *of_face; // [triangles + 1], [2 segments]: the segments of each face
    triple *triple;
    int32_t triple_count;
    size_t triple_capacity;
    int32_t *first_piece; // [segments + 1]
} cutting;

void cut_faces_free(jali_context *ctx, cut_faces *cut)
{
    release(ctx, cut->triangle);
    release(ctx, cut->parent);
    release(ctx, cut->piece);
    *cut = (cut_faces){0};
}

static frame frame_of(const exact_surface *s, int32_t face)
{
    const int32_t *v = s->triangle[face];
    const int64_t *p[3] = {s->l->point[v[0]], s->l->point[v[1]], s->l->point[v[2]]};
    normal n = normal_of(s->l->narrow, p[0], p[1], p[2]);
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs((double)n.along[k]) > fabs((double)n.along[axis])) axis = k;
    bool front = n.along[axis] > 0;
    frame f = {(axis + (front ? 1 : 2)) % 3, (axis + (front ? 2 : 1)) % 3, {0}, 0};
    double extent = 1;
    for (int k = 0; k < 2; k++) {
        int i = k ? f.up : f.across;
        double low = (double)MIN(p[0][i], MIN(p[1][i], p[2][i]));
        double high = (double)MAX(p[0][i], MAX(p[1][i], p[2][i]));
        f.origin[k] = low;
        extent = MAX(extent, high - low);
    }
    f.scale = ldexp(1, FRAME_LOG2) / extent;
    return f;
}

static void in_frame(const frame *f, const double at[3], double place[2])
{
    place[0] = (at[f->across] - f->origin[0]) * f->scale;
    place[1] = (at[f->up] - f->origin[1]) * f->scale;
}

static void on_lattice(const frame *f, const double at[3], int32_t place[2])
{
    double exact[2];
    in_frame(f, at, exact);
    for (int k = 0; k < 2; k++) place[k] = (int32_t)lrint(exact[k]);
}

// ---- which segments a face has ----

static jali_status sort_by_face(cutting *w)
{
    jali_status status;
    int32_t triangles = 0;
    for (int32_t i = 0; i < w->s->face_count; i++) triangles = MAX(triangles, w->s->face[i] + 1);
    TRY(ARENA(w->ctx, w->first, (size_t)triangles + 2));
    TRY(ARENA(w->ctx, w->of_face, 2 * (size_t)w->c->segment_count + 1));
    memset(w->first, 0, ((size_t)triangles + 2) * sizeof *w->first);
    for (int32_t i = 0; i < w->c->segment_count; i++)
        for (int k = 0; k < 2; k++) w->first[w->c->segment[i].face[k] + 2]++;
    for (int32_t t = 0; t <= triangles; t++) w->first[t + 1] += w->first[t];
    for (int32_t i = 0; i < w->c->segment_count; i++)
        for (int k = 0; k < 2; k++) w->of_face[w->first[w->c->segment[i].face[k] + 1]++] = i;
done:
    return status;
}

// ---- where three faces meet ----

static int32_t other_face(const segment *s, int32_t face)
{
    return s->face[s->face[0] == face];
}

// Do two segments of a face cross? Sets `unclear` where rounding would decide.
static bool cross_in(const int32_t a[2][2], const int32_t b[2][2], bool *unclear)
{
    for (int k = 0; k < 2; k++)
        if (MAX(a[0][k], a[1][k]) < MIN(b[0][k], b[1][k]) || MAX(b[0][k], b[1][k]) < MIN(a[0][k], a[1][k]))
            return false;
    int64_t a0 = orientation(b[0], b[1], a[0]), a1 = orientation(b[0], b[1], a[1]);
    int64_t b0 = orientation(a[0], a[1], b[0]), b1 = orientation(a[0], a[1], b[1]);
    if ((a0 > 0 && a1 > 0) || (a0 < 0 && a1 < 0) || (b0 > 0 && b1 > 0) || (b0 < 0 && b1 < 0)) return false;
    if (!a0 || !a1 || !b0 || !b1) *unclear = true;
    return true;
}

static void crossing_of(const frame *f, const crossings *c, const segment *a, const segment *b, double at[3])
{
    double p[2][2], q[2][2];
    for (int k = 0; k < 2; k++) {
        in_frame(f, c->point[a->end[k]], p[k]);
        in_frame(f, c->point[b->end[k]], q[k]);
    }
    double d[2] = {q[1][0] - q[0][0], q[1][1] - q[0][1]}, side[2];
    for (int k = 0; k < 2; k++) side[k] = d[0] * (p[k][1] - q[0][1]) - d[1] * (p[k][0] - q[0][0]);
    double share = side[0] / (side[0] - side[1]);
    const double *from = c->point[a->end[0]], *to = c->point[a->end[1]];
    for (int k = 0; k < 3; k++) at[k] = from[k] + share * (to[k] - from[k]);
}

static jali_status add_triple(cutting *w, int32_t face, const frame *f, const segment *a, const segment *b)
{
    int32_t x = other_face(a, face), y = other_face(b, face);
    int32_t low = MIN(face, MIN(x, y)), high = MAX(face, MAX(x, y));
    int32_t middle = (int32_t)((int64_t)face + x + y - low - high);
    jali_status status = GROW(w->ctx, w->triple, w->triple_capacity, w->triple_count + 1);
    if (status != JALI_OK) return status;
    triple *t = &w->triple[w->triple_count++];
    *t = (triple){.face = {low, middle, high}, .seen_by = face};
    crossing_of(f, w->c, a, b, t->at);
    return JALI_OK;
}

static jali_status find_triples_in(cutting *w, int32_t face)
{
    jali_status status = JALI_OK;
    arena_mark mark = arena_here(w->ctx);
    const int32_t *mine = w->of_face + w->first[face];
    int32_t count = w->first[face + 1] - w->first[face], (*end)[2][2];
    frame f = frame_of(w->s, face);
    if (count > MOST_IN_A_FACE)
        return fail(w->ctx, JALI_LIMIT, "a triangle meets %d others, more than %d", count, MOST_IN_A_FACE);
    TRY(ARENA(w->ctx, end, count));
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) on_lattice(&f, w->c->point[w->c->segment[mine[i]].end[k]], end[i][k]);
    for (int32_t i = 0; i < count; i++) {
        if (i % 1024 == 0) TRY(step(w->ctx, "merge", 0.5));
        const segment *a = &w->c->segment[mine[i]];
        for (int32_t j = i + 1; j < count; j++) {
            const segment *b = &w->c->segment[mine[j]];
            if (a->end[0] == b->end[0] || a->end[0] == b->end[1] || a->end[1] == b->end[0] ||
                a->end[1] == b->end[1])
                continue;
            if (!cross_in((const int32_t(*)[2])end[i], (const int32_t(*)[2])end[j], &w->c->degenerate))
                continue;
            if (w->c->degenerate) goto done;
            TRY(add_triple(w, face, &f, a, b));
        }
    }
done:
    arena_rewind(w->ctx, mark);
    return status;
}

static int compare_triples(const void *left, const void *right)
{
    const triple *a = left, *b = right;
    for (int k = 0; k < 3; k++)
        if (a->face[k] != b->face[k]) return a->face[k] < b->face[k] ? -1 : 1;
    return a->seen_by < b->seen_by ? -1 : a->seen_by > b->seen_by;
}

// Of each three sights one is kept, and becomes a point.
static jali_status number_triples(cutting *w)
{
    jali_status status = JALI_OK;
    crossings *c = w->c;
    int32_t kept = 0;
    if (w->triple_count) qsort(w->triple, (size_t)w->triple_count, sizeof *w->triple, compare_triples);
    TRY(GROW(w->ctx, c->point, c->point_capacity, (size_t)c->point_count + (size_t)w->triple_count / 3 + 1));
    for (int32_t i = 0; i < w->triple_count; i += 3, kept++) {
        triple *t = &w->triple[i];
        bool all = i + 2 < w->triple_count;
        for (int k = 0; k < 3 && all; k++)
            all = memcmp(t->face, t[k].face, sizeof t->face) == 0 && t[k].seen_by == t->face[k];
        if (!all) {
            c->degenerate = true;
            goto done;
        }
        w->triple[kept] = *t;
        w->triple[kept].point = c->point_count;
        memcpy(c->point[c->point_count++], w->triple[kept].at, sizeof t->at);
    }
    w->triple_count = kept;
done:
    return status;
}

// ---- pieces ----

typedef struct stop {
    double along;
    int32_t segment, point;
} stop;

static int compare_stops(const void *left, const void *right)
{
    const stop *a = left, *b = right;
    if (a->segment != b->segment) return a->segment < b->segment ? -1 : 1;
    if (a->along != b->along) return a->along < b->along ? -1 : 1;
    return a->point < b->point ? -1 : a->point > b->point;
}

static int32_t segment_between(const crossings *c, int32_t low, int32_t high)
{
    int32_t from = 0, to = c->segment_count;
    while (from < to) {
        int32_t middle = from + (to - from) / 2;
        const int32_t *face = c->segment[middle].face;
        if (face[0] < low || (face[0] == low && face[1] < high))
            from = middle + 1;
        else
            to = middle;
    }
    bool there =
        from < c->segment_count && c->segment[from].face[0] == low && c->segment[from].face[1] == high;
    return there ? from : -1;
}

static stop stop_at(const crossings *c, int32_t i, int32_t point)
{
    const double *from = c->point[c->segment[i].end[0]], *to = c->point[c->segment[i].end[1]];
    double along = 0;
    for (int k = 0; k < 3; k++) along += (c->point[point][k] - from[k]) * (to[k] - from[k]);
    return (stop){along, i, point};
}

static jali_status cut_segments(cutting *w)
{
    jali_status status;
    crossings *c = w->c;
    stop *stops;
    int32_t count = 0, next = 0;
    TRY(ARENA(w->ctx, stops, 3 * (size_t)w->triple_count + 1));
    TRY(ARENA(w->ctx, w->first_piece, (size_t)c->segment_count + 1));
    for (int32_t i = 0; i < w->triple_count; i++)
        for (int k = 0; k < 3; k++) {
            const int32_t *face = w->triple[i].face;
            int32_t on = segment_between(c, face[k == 0 ? 1 : 0], face[k == 2 ? 1 : 2]);
            if (on < 0)
                c->degenerate = true;
            else
                stops[count++] = stop_at(c, on, w->triple[i].point);
        }
    if (count) qsort(stops, (size_t)count, sizeof *stops, compare_stops);
    TRY(GROW(w->ctx, w->cut->piece, w->cut->piece_capacity, (size_t)c->segment_count + (size_t)count));
    for (int32_t i = 0; i < c->segment_count; i++) {
        int32_t from = c->segment[i].end[0];
        w->first_piece[i] = w->cut->piece_count;
        for (; next < count && stops[next].segment == i; next++) {
            w->cut->piece[w->cut->piece_count++] = (cut_piece){from, stops[next].point, i};
            from = stops[next].point;
        }
        w->cut->piece[w->cut->piece_count++] = (cut_piece){from, c->segment[i].end[1], i};
    }
    w->first_piece[c->segment_count] = w->cut->piece_count;
done:
    return status;
}

// ---- faces ----

// The points of one face's triangulation.
typedef struct face_points {
    int32_t count, *name, (*at)[2]; // names are numbers of the crossings' points
} face_points;

static int compare_names(const void *left, const void *right)
{
    int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    return a < b ? -1 : a > b;
}

static int32_t number_of(const face_points *p, int32_t name)
{
    const int32_t *found = bsearch(&name, p->name, (size_t)p->count, sizeof name, compare_names);
    return (int32_t)(found - p->name);
}

static int32_t first_on_edge(const crossings *c, int32_t low, int32_t high)
{
    int32_t from = 0, to = c->edge_point_count;
    while (from < to) {
        int32_t middle = from + (to - from) / 2;
        const edge_point *e = &c->edge_point[middle];
        if (e->low < low || (e->low == low && e->high < high))
            from = middle + 1;
        else
            to = middle;
    }
    return from;
}

// The face's outline through the points on its edges; returns how many edges that is.
static int32_t list_outline(const cutting *w, int32_t face, int32_t (*edge)[2])
{
    const crossings *c = w->c;
    const int32_t *v = w->s->triangle[face];
    int32_t count = 0;
    for (int k = 0; k < 3; k++) {
        int32_t from = v[k], to = v[(k + 1) % 3], low = MIN(from, to), high = MAX(from, to);
        int32_t first = first_on_edge(c, low, high), end = first, last = from;
        while (end < c->edge_point_count && c->edge_point[end].low == low && c->edge_point[end].high == high)
            end++;
        for (int32_t i = first; i < end; i++) {
            int32_t point = c->edge_point[from == low ? i : first + end - 1 - i].point;
            if (edge) edge[count][0] = last, edge[count][1] = point;
            last = point;
            count++;
        }
        if (edge) edge[count][0] = last, edge[count][1] = to;
        count++;
    }
    return count;
}

static jali_status gather_points(const cutting *w, int32_t face, const int32_t (*edge)[2], int32_t edges,
                                 face_points *p)
{
    jali_status status;
    frame f = frame_of(w->s, face);
    int32_t kept = 0;
    TRY(ARENA(w->ctx, p->name, 2 * (size_t)edges));
    TRY(ARENA(w->ctx, p->at, 2 * (size_t)edges));
    memcpy(p->name, edge, 2 * (size_t)edges * sizeof *p->name);
    qsort(p->name, 2 * (size_t)edges, sizeof *p->name, compare_names);
    for (int32_t i = 0; i < 2 * edges; i++)
        if (kept == 0 || p->name[kept - 1] != p->name[i]) p->name[kept++] = p->name[i];
    p->count = kept;
    for (int32_t i = 0; i < kept; i++) on_lattice(&f, w->c->point[p->name[i]], p->at[i]);
done:
    return status;
}

// Triangulate; `plane` stays empty where points or edges meet that should not.
static jali_status triangulate(cutting *w, const face_points *p, int32_t (*edge)[2], int32_t outline,
                               int32_t edges, triangulation *plane)
{
    jali_status status;
    contact met;
    for (int32_t i = 0; i < edges; i++)
        for (int k = 0; k < 2; k++) edge[i][k] = number_of(p, edge[i][k]);
    TRY(insert_points(w->ctx, plane, (const int32_t(*)[2])p->at, p->count));
    w->c->degenerate = plane->triangle_count == 0;
    for (int32_t i = 0; i < p->count; i++) w->c->degenerate |= plane->twin[i] != i;
    if (w->c->degenerate) goto done;
    TRY(insert_edges(w->ctx, plane, (const int32_t(*)[2])edge, outline, EDGE_OUTLINE, false, &met));
    if (met.found == NO_CONTACT)
        TRY(insert_edges(w->ctx, plane, (const int32_t(*)[2])edge + outline, edges - outline, EDGE_CREASE,
                         false, &met));
    w->c->degenerate = met.found != NO_CONTACT;
done:
    return status;
}

static jali_status cut_face(cutting *w, int32_t face)
{
    jali_status status;
    arena_mark mark = arena_here(w->ctx);
    triangulation plane = {0};
    face_points p = {0};
    int32_t outline = list_outline(w, face, NULL), edges = outline, (*edge)[2];
    uint8_t *inside;
    for (int32_t i = w->first[face]; i < w->first[face + 1]; i++)
        edges += w->first_piece[w->of_face[i] + 1] - w->first_piece[w->of_face[i]];
    TRY(ARENA(w->ctx, edge, edges));
    edges = list_outline(w, face, edge);
    for (int32_t i = w->first[face]; i < w->first[face + 1]; i++)
        for (int32_t k = w->first_piece[w->of_face[i]]; k < w->first_piece[w->of_face[i] + 1]; k++, edges++)
            edge[edges][0] = w->cut->piece[k].from, edge[edges][1] = w->cut->piece[k].to;
    TRY(gather_points(w, face, (const int32_t(*)[2])edge, edges, &p));
    TRY(triangulate(w, &p, edge, outline, edges, &plane));
    if (w->c->degenerate) goto done;
    TRY(ARENA(w->ctx, inside, plane.triangle_count));
    TRY(label_tones(w->ctx, &plane, EDGE_OUTLINE, inside));
    size_t room = (size_t)w->cut->triangle_count + (size_t)plane.triangle_count;
    TRY(GROW(w->ctx, w->cut->triangle, w->cut->triangle_capacity, room));
    TRY(GROW(w->ctx, w->cut->parent, w->cut->parent_capacity, room));
    for (int32_t t = 0; t < plane.triangle_count; t++) {
        if (!inside[t]) continue;
        int32_t into = w->cut->triangle_count++;
        w->cut->parent[into] = face;
        for (int k = 0; k < 3; k++) w->cut->triangle[into][k] = p.name[plane.corner[4 * t + k]];
    }
done:
    triangulation_free(w->ctx, &plane);
    arena_rewind(w->ctx, mark);
    return status;
}

jali_status cut_along(jali_context *ctx, const exact_surface *s, crossings *c, cut_faces *cut)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    cutting w = {.ctx = ctx, .s = s, .c = c, .cut = cut};
    *cut = (cut_faces){0};
    TRY(sort_by_face(&w));
    for (int32_t i = 0; i < s->face_count && !c->degenerate; i++)
        if (w.first[s->face[i] + 1] > w.first[s->face[i]]) TRY(find_triples_in(&w, s->face[i]));
    if (!c->degenerate) TRY(number_triples(&w));
    if (!c->degenerate) TRY(cut_segments(&w));
    for (int32_t i = 0; i < s->face_count && !c->degenerate; i++)
        if (w.first[s->face[i] + 1] > w.first[s->face[i]]) TRY(cut_face(&w, s->face[i]));
done:
    release(ctx, w.triple);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) cut_faces_free(ctx, cut);
    return status;
}
