// Refinement of a constrained Delaunay triangulation by points inside, one bad triangle at a time.
//
// Source:  Chew: Guaranteed-quality mesh generation for curved surfaces (1993); Ungor: Off-centers (2009);
// Rebay:
//          Efficient unstructured mesh generation by means of Delaunay triangulation (1993). A bad triangle
//          gets a point on the bisector of its shortest side, at most at its circumcentre and at most so far
//          that the triangle made has the wished size. When a border lies before that point or next to it,
//          the border is split instead.
// Differs: on a surface, lengths and angles are those in space: the place of a new point is found in the
// plane of
//          the bad triangle, edges flip when the angles opposite sum up to more than a half turn.
// Limits:  no point is made nearer than `least` to another, which is what ends it on every input: where the
// input
//          has finer angles or gaps, small angles stay.
// Checked: tests/test_sheet.c, fuzz/fuzz_refine.c.
#include "plane/refine.h"

#include "plane/exact.h"

enum { NONE = -1, POINTS_A_STEP = 1 << 14 };

// Circumradius of an equilateral triangle is 0.58 of its side; beyond 0.75 of the size a triangle is too
// large.
static const double RADIUS_A_SIZE = 0.75;
// Circumradius against shortest side: 1 / (2 sin 25 degrees).
static const double RADIUS_A_SIDE = 1.18;
// The sides of a new triangle against its base.
static const double LEAST_LEG = 0.8, LARGEST_LEG = 1.5;
// A border edge is too near to a point when it is seen from there under an angle with a smaller cosine.
static const double TOO_NEAR_COSINE = -0.25;
// A border edge is split for the sake of size only when it is so much longer than the size.
static const double LONG_EDGE = 1.45;

void refinement_free(jali_context *ctx, refinement *r)
{
    release(ctx, r->inside);
    release(ctx, r->size);
    release(ctx, r->place);
    release(ctx, r->waiting.next);
    *r = (refinement){0};
}

// Room for one more point and the triangles it brings.
static jali_status make_room(jali_context *ctx, refinement *r, int32_t points)
{
    jali_status status;
    size_t triangles = 2 * (size_t)points + 8;
    TRY(reserve_points(ctx, r->plane, points));
    TRY(GROW(ctx, r->inside, r->inside_capacity, triangles));
    TRY(GROW(ctx, r->waiting.next, r->waiting_capacity, triangles));
    if (r->place) TRY(GROW(ctx, r->place, r->place_capacity, points));
    TRY(GROW(ctx, r->size, r->size_capacity, points));
done:
    return status;
}

jali_status refinement_begin(jali_context *ctx, refinement *r)
{
    jali_status status = make_room(ctx, r, r->plane->point_count + r->plane->point_count / 2 + 16);
    if (status != JALI_OK) return status;
    for (int32_t t = 0; t < r->plane->triangle_count; t++) r->waiting.next[t] = NOT_WAITING;
    for (int32_t p = 0; p < r->plane->point_count; p++) r->size[p] = 0;
    r->waiting.filled = 0;
    return JALI_OK;
}

// --- Lengths and forms

double squared_length(const refinement *r, int32_t a, int32_t b)
{
    if (!r->place) {
        const int32_t *from = r->plane->point[a], *to = r->plane->point[b];
        double dx = to[0] - from[0], dy = to[1] - from[1];
        return dx * dx + dy * dy;
    }
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (r->place[b][k] - r->place[a][k]) * (r->place[b][k] - r->place[a][k]);
    return sum;
}

form form_of(const refinement *r, int32_t t)
{
    const int32_t *corner = r->plane->corner + 4 * t;
    double d[3];
    int k = 0;
    for (int i = 0; i < 3; i++) d[i] = squared_length(r, corner[(i + 1) % 3], corner[(i + 2) % 3]);
    for (int i = 1; i < 3; i++)
        if (d[i] < d[k]) k = i;
    form f = {.side = 4 * t + k, .length = sqrt(d[k])};
    double last = d[(k + 2) % 3], next = d[(k + 1) % 3];
    f.x = f.length > 0 ? (d[k] + last - next) / (2 * f.length) : 0;
    f.y = sqrt(MAX(last - f.x * f.x, 1e-12 * last));
    f.radius = sqrt(next * last) / (2 * f.y);
    return f;
}

static double mean_size(const refinement *r, int32_t t)
{
    const int32_t *corner = r->plane->corner + 4 * t;
    return (r->size[corner[0]] + r->size[corner[1]] + r->size[corner[2]]) / 3;
}

static bool too_large(const form *f, double size)
{
    return f->radius > RADIUS_A_SIZE * size;
}

// A small angle; not one that two edges which must stay enclose.
static bool too_sharp(const refinement *r, const form *f)
{
    return f->radius > RADIUS_A_SIDE * f->length && f->length > r->least &&
           !(r->plane->kind[next_side(f->side)] && r->plane->kind[last_side(f->side)]);
}

// Let triangle t wait if it is bad.
static void put(refinement *r, int32_t t)
{
    if (!r->inside[t]) return;
    form f = form_of(r, t);
    if (too_large(&f, mean_size(r, t)) || too_sharp(r, &f))
        wait_in(&r->waiting, t, ilogb(f.length / r->least));
}

// --- New points

// The sum of the angles opposite the edge of side s exceeds a half turn, in space.
static bool flips_in_space(const refinement *r, int32_t s)
{
    int32_t o = r->plane->beside[s], a = r->plane->corner[next_side(s)], b = r->plane->corner[last_side(s)];
    double cotangents = 0, edge = squared_length(r, a, b);
    for (int k = 0; k < 2; k++, s = o) {
        int32_t apex = r->plane->corner[s];
        double to_a = squared_length(r, apex, a), to_b = squared_length(r, apex, b), dot = to_a + to_b - edge;
        double area = 4 * to_a * to_b - dot * dot; // 16 times the squared area
        cotangents += dot / sqrt(MAX(area, 1e-24 * to_a * to_b));
    }
    return cotangents < -1e-9 && is_convex(r->plane, r->plane->beside[o]);
}

static void settle(refinement *r, int32_t p, int32_t depth)
{
    triangulation *plane = r->plane;
    while (depth > 0) {
        int32_t s = plane->stack[--depth];
        if (plane->kind[s] != 0) continue;
        bool flips =
            r->place && r->inside[s >> 2] ? flips_in_space(r, s) : in_disc(plane, plane->beside[s] >> 2, p);
        if (!flips) continue;
        int32_t other = last_side(plane->beside[s]);
        flip_side(plane, s);
        plane->stack[depth++] = s;
        plane->stack[depth++] = other;
    }
}

static void put_around(refinement *r, int32_t p)
{
    int32_t s = 4 * r->plane->star[p];
    while (r->plane->corner[s] != p) s++;
    int32_t first = s;
    do {
        put(r, s >> 2);
        s = next_side(r->plane->beside[next_side(s)]);
    } while (s != first);
}

// Store a point at a place that is known to be free; it has no triangles yet.
static jali_status add_point(jali_context *ctx, refinement *r, const int32_t at[2], int32_t near, double size,
                             int32_t *p)
{
    triangulation *plane = r->plane;
    double place[3];
    *p = -1;
    if (r->place && !r->lifting.lift(r->lifting.shared, at, near, place)) return JALI_OK;
    int32_t points = plane->point_count;
    if ((size_t)points + 1 > r->size_capacity || (size_t)points + 1 > plane->point_capacity) {
        jali_status status = make_room(ctx, r, points + points / 2 + 16);
        if (status != JALI_OK) return status;
    }
    *p = plane->point_count++;
    memcpy(plane->point[*p], at, sizeof *plane->point);
    plane->twin[*p] = *p;
    r->size[*p] = size;
    if (r->place) memcpy(r->place[*p], place, sizeof place);
    if (*p % POINTS_A_STEP == 0) return step(ctx, "mesh", 0.5);
    return JALI_OK;
}

// The two triangles that a split has made take after those they were made from.
static void note_triangles(refinement *r, int32_t from_first, int32_t from_second)
{
    int32_t made = r->plane->triangle_count - 2;
    r->inside[made] = r->inside[from_first];
    r->inside[made + 1] = r->inside[from_second];
    r->waiting.next[made] = r->waiting.next[made + 1] = NOT_WAITING;
}

static jali_status split_at(jali_context *ctx, refinement *r, int32_t s, const int32_t at[2], double size,
                            int32_t *p)
{
    *p = -1;
    if (!can_split_side(r->plane, s, at)) return JALI_OK;
    int32_t t = s >> 2, o = r->plane->beside[s] >> 2;
    jali_status status = add_point(ctx, r, at, r->plane->corner[next_side(s)], size, p);
    if (status != JALI_OK || *p < 0) return status;
    int32_t depth = split_side(r->plane, s, *p);
    note_triangles(r, t, o);
    settle(r, *p, depth);
    return JALI_OK;
}

jali_status split_border(jali_context *ctx, refinement *r, int32_t s, double share, int32_t *p)
{
    int32_t a = r->plane->corner[next_side(s)], b = r->plane->corner[last_side(s)], at[2];
    for (int k = 0; k < 2; k++)
        at[k] = (int32_t)lrint((1 - share) * r->plane->point[a][k] + share * r->plane->point[b][k]);
    *p = -1;
    if (r->plane->kind[s] & r->fixed) return JALI_OK;
    return split_at(ctx, r, s, at, (1 - share) * r->size[a] + share * r->size[b], p);
}

// --- One bad triangle

// The triangle that holds a place, walking from t; or the constrained side before it, *blocked.
static int32_t walk(const triangulation *plane, int32_t t, const int32_t at[2], int32_t *blocked)
{
    *blocked = NONE;
    for (int32_t from = NONE, steps = 0; steps < 64; steps++) {
        int k;
        for (k = 0; k < 3; k++) {
            int32_t s = 4 * t + k;
            if (s == from) continue;
            if (orientation(plane->point[plane->corner[next_side(s)]],
                            plane->point[plane->corner[last_side(s)]], at) >= 0)
                continue;
            if (plane->kind[s]) {
                *blocked = s;
                return NONE;
            }
            from = plane->beside[s];
            t = from >> 2;
            break;
        }
        if (k == 3) return t;
    }
    return NONE;
}

// A constrained edge around triangle t, or around its neighbours, that is too near to a place.
static int32_t near_border(const refinement *r, int32_t t, const double place[3])
{
    const triangulation *plane = r->plane;
    for (int32_t i = 0; i < 9; i++) {
        int32_t s = 4 * t + i / 3;
        if (!plane->kind[s]) {
            if (i % 3 == 0) continue;
            s = i % 3 == 1 ? next_side(plane->beside[s]) : last_side(plane->beside[s]);
        } else if (i % 3 > 0)
            continue;
        if (!plane->kind[s]) continue;
        int32_t a = plane->corner[next_side(s)], b = plane->corner[last_side(s)];
        double dot = 0, to_a = 0, to_b = 0;
        for (int k = 0; k < 3; k++) {
            double da = (r->place ? r->place[a][k] : k < 2 ? plane->point[a][k] : 0) - place[k];
            double db = (r->place ? r->place[b][k] : k < 2 ? plane->point[b][k] : 0) - place[k];
            dot += da * db;
            to_a += da * da;
            to_b += db * db;
        }
        if (dot < 0 && dot * dot > TOO_NEAR_COSINE * TOO_NEAR_COSINE * to_a * to_b) return s;
    }
    return NONE;
}

// Where the new point for a triangle goes.
static void choose_place(const refinement *r, const form *f, double size, int32_t at[2])
{
    double leg = MIN(MAX(size, LEAST_LEG * f->length), LARGEST_LEG * f->length);
    double height = (f->x * f->x + f->y * f->y - f->length * f->x) / (2 * f->y); // of the circumcentre
    height = MIN(height, sqrt(leg * leg - 0.25 * f->length * f->length));
    double of_apex = height / f->y, of_end = (0.5 * f->length - of_apex * f->x) / f->length;
    const int32_t *from = r->plane->point[r->plane->corner[next_side(f->side)]];
    const int32_t *end = r->plane->point[r->plane->corner[last_side(f->side)]];
    const int32_t *apex = r->plane->point[r->plane->corner[f->side]];
    for (int k = 0; k < 2; k++) {
        double x = from[k] + of_end * (end[k] - from[k]) + of_apex * (apex[k] - from[k]);
        at[k] = (int32_t)lrint(MIN(MAX(x, -COORDINATE_LIMIT), COORDINATE_LIMIT));
    }
}

// Shares of the corners of triangle t at a place, for what is given at its corners.
static void shares_at(const triangulation *plane, int32_t t, const int32_t at[2], double share[3])
{
    const int32_t *corner = plane->corner + 4 * t, (*point)[2] = (const int32_t(*)[2])plane->point;
    double whole = (double)orientation(point[corner[0]], point[corner[1]], point[corner[2]]);
    for (int k = 0; k < 3; k++)
        share[k] = (double)orientation(point[corner[(k + 1) % 3]], point[corner[(k + 2) % 3]], at) / whole;
}

// Split the border edge of side s in the way of a triangle, if it may be.
static jali_status give_way(jali_context *ctx, refinement *r, int32_t s, bool sharp, int32_t *p)
{
    int32_t a = r->plane->corner[next_side(s)], b = r->plane->corner[last_side(s)];
    double length = sqrt(squared_length(r, a, b)), size = 0.5 * (r->size[a] + r->size[b]);
    *p = -1;
    if (length < 2 * r->least || (!sharp && length < LONG_EDGE * size)) return JALI_OK;
    return split_border(ctx, r, s, 0.5, p);
}

// Add a point strictly inside triangle t, or on one of its free sides.
static jali_status add_inside(jali_context *ctx, refinement *r, int32_t t, const int32_t at[2], int32_t *p)
{
    double share[3], size = 0;
    const int32_t *corner = r->plane->corner + 4 * t;
    shares_at(r->plane, t, at, share);
    *p = -1;
    for (int k = 0; k < 3; k++) size += share[k] * r->size[corner[k]];
    for (int k = 0; k < 3; k++)
        if (share[k] <= 0) {
            if (r->plane->kind[4 * t + k]) return JALI_OK;
            return split_at(ctx, r, 4 * t + k, at, size, p);
        }
    jali_status status = add_point(ctx, r, at, corner[0], size, p);
    if (status != JALI_OK || *p < 0) return status;
    int32_t depth = split_triangle(r->plane, t, *p);
    note_triangles(r, t, t);
    settle(r, *p, depth);
    return JALI_OK;
}

static void place_in(const refinement *r, int32_t t, const int32_t at[2], double place[3])
{
    const int32_t *corner = r->plane->corner + 4 * t;
    double share[3];
    place[0] = at[0], place[1] = at[1], place[2] = 0;
    if (!r->place) return;
    shares_at(r->plane, t, at, share);
    for (int k = 0; k < 3; k++)
        place[k] = share[0] * r->place[corner[0]][k] + share[1] * r->place[corner[1]][k] +
                   share[2] * r->place[corner[2]][k];
}

static bool clear_of_corners(const refinement *r, int32_t t, const double place[3], double least)
{
    for (int i = 0; i < 3; i++) {
        int32_t c = r->plane->corner[4 * t + i];
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            double d = (r->place ? r->place[c][k] : k < 2 ? r->plane->point[c][k] : 0) - place[k];
            sum += d * d;
        }
        if (sum < least * least) return false;
    }
    return true;
}

static jali_status improve(jali_context *ctx, refinement *r, int32_t t)
{
    form f = form_of(r, t);
    double size = mean_size(r, t), place[3];
    bool sharp = too_sharp(r, &f);
    int32_t at[2], blocked, p;
    if (!sharp && !too_large(&f, size)) return JALI_OK;
    choose_place(r, &f, size, at);
    int32_t holder = walk(r->plane, t, at, &blocked);
    if (holder >= 0) {
        place_in(r, holder, at, place);
        blocked = near_border(r, holder, place);
        if (!clear_of_corners(r, holder, place, MAX(r->least, 0.5 * f.length))) return JALI_OK;
    }
    jali_status status = JALI_OK;
    if (blocked != NONE)
        status = give_way(ctx, r, blocked, sharp, &p);
    else if (holder >= 0)
        status = add_inside(ctx, r, holder, at, &p);
    else
        return JALI_OK;
    if (status == JALI_OK && p >= 0) {
        put_around(r, p);
        put(r, t);
    }
    return status;
}

// Split border edges into pieces of their size.
static jali_status split_borders(jali_context *ctx, refinement *r)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const triangulation *plane = r->plane;
    int32_t(*edge)[2], count = 0;
    TRY(ARENA(ctx, edge, 3 * (size_t)plane->triangle_count));
    for (int32_t s = 0; s < 4 * plane->triangle_count; s++) {
        if ((s & 3) == 3 || !plane->kind[s] || !r->inside[s >> 2]) continue;
        if (r->inside[plane->beside[s] >> 2] && plane->beside[s] < s) continue;
        edge[count][0] = plane->corner[next_side(s)];
        edge[count++][1] = plane->corner[last_side(s)];
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t from = edge[i][0], to = edge[i][1];
        double size = 0.5 * (r->size[from] + r->size[to]);
        for (int32_t pieces = (int32_t)lrint(sqrt(squared_length(r, from, to)) / size); pieces > 1;
             pieces--) {
            int32_t p;
            TRY(split_border(ctx, r, side_between(plane, from, to), 1.0 / pieces, &p));
            if (p < 0) break;
            from = p;
        }
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status refine_triangles(jali_context *ctx, refinement *r)
{
    jali_status status;
    int32_t t;
    TRY(split_borders(ctx, r));
    TRY(step(ctx, "mesh", 0.3));
    for (t = 0; t < r->plane->triangle_count; t++) put(r, t);
    while ((t = next_waiting(&r->waiting)) != NONE_WAITING) TRY(improve(ctx, r, t));
    TRY(step(ctx, "mesh", 0.9));
done:
    return status;
}
