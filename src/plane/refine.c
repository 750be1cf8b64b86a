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
static const double LEAST_LEG = 0.8, LARGEST_LEG = 2;
// A border edge is too near to a point when it is seen from there under an angle with a smaller cosine.
static const double TOO_NEAR_COSINE = -0.25;
// A border edge is split for the sake of size only when it is so much longer than the size.
static const double LONG_EDGE = 1.45;

void refinement_free(jali_context *ctx, refinement *r)
{
    release(ctx, r->inside);
    release(ctx, r->size);
    release(ctx, r->spot);
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
    if (r->measure != BY_LATTICE) TRY(GROW(ctx, r->spot, r->spot_capacity, points));
    TRY(GROW(ctx, r->size, r->size_capacity, points));
done:
    return status;
}

jali_status refinement_begin(jali_context *ctx, refinement *r, int32_t *astray)
{
    triangulation *plane = r->plane;
    *astray = NONE;
    jali_status status = make_room(ctx, r, plane->point_count + plane->point_count / 2 + 16);
    if (status != JALI_OK) return status;
    for (int32_t p = 0; p < plane->point_count; p++) r->size[p] = INFINITY;
    if (r->spot) memset(r->spot, 0, (size_t)plane->point_count * sizeof *r->spot);
    for (int32_t t = 0; t < plane->triangle_count; t++) {
        r->waiting.next[t] = NOT_WAITING;
        for (int k = 0; k < 3 && r->inside[t] && r->spot; k++) {
            int32_t p = plane->corner[4 * t + k];
            if (r->spot[p].metric[0] > 0) continue;
            if (!r->lifting.lift(r->lifting.shared, plane->point[p], &r->spot[p], &r->size[p])) *astray = p;
        }
    }
    r->waiting.filled = 0;
    return JALI_OK;
}

// --- Lengths and forms

static const spot *spot_of(const refinement *r, int32_t p)
{
    return r->spot ? &r->spot[p] : NULL;
}

static double squared_gap(const refinement *r, const int32_t from[2], const spot *from_spot,
                          const int32_t to[2], const spot *to_spot)
{
    double dx = to[0] - from[0], dy = to[1] - from[1], sum = 0;
    if (r->measure == BY_LATTICE) return dx * dx + dy * dy;
    if (r->measure == BY_METRIC) {
        const double *a = from_spot->metric, *b = to_spot->metric;
        return 0.5 * ((a[0] + b[0]) * dx * dx + 2 * (a[1] + b[1]) * dx * dy + (a[2] + b[2]) * dy * dy);
    }
    for (int k = 0; k < 3; k++) {
        double d = to_spot->place[k] - from_spot->place[k];
        sum += d * d;
    }
    return sum;
}

double squared_length(const refinement *r, int32_t a, int32_t b)
{
    return squared_gap(r, r->plane->point[a], spot_of(r, a), r->plane->point[b], spot_of(r, b));
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

// A small angle; not one that two edges which must stay enclose. Metrics leap at creases and make angles that
// are not there: under them sizes alone count.
static bool too_sharp(const refinement *r, const form *f)
{
    if (r->measure == BY_METRIC) return false;
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

// The sum of the angles opposite the edge of side s exceeds a half turn, on the surface.
static bool flips_on_surface(const refinement *r, int32_t s)
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

static bool flips(const refinement *r, int32_t s)
{
    if (r->plane->kind[s] != 0) return false;
    if (r->measure != BY_LATTICE && r->inside[s >> 2]) return flips_on_surface(r, s);
    return in_disc(r->plane, r->plane->beside[s] >> 2, r->plane->corner[s]);
}

// Lawson's flips, from the sides opposite a new point.
static void settle(refinement *r, int32_t depth)
{
    triangulation *plane = r->plane;
    while (depth > 0) {
        int32_t s = plane->stack[--depth];
        if (!flips(r, s)) continue;
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

// A place under consideration: where it lies, and which size is allowed there.
typedef struct candidate {
    int32_t at[2];
    spot spot;
    double most;
} candidate;

// False where the surface does not lie.
static bool lift(const refinement *r, candidate *c)
{
    c->most = INFINITY;
    return !r->spot || r->lifting.lift(r->lifting.shared, c->at, &c->spot, &c->most);
}

// Store a point at a place that is known to be free; it has no triangles yet.
static jali_status add_point(jali_context *ctx, refinement *r, const candidate *c, double size, int32_t *p)
{
    triangulation *plane = r->plane;
    *p = -1;
    int32_t points = plane->point_count;
    if ((size_t)points + 1 > r->size_capacity || (size_t)points + 1 > plane->point_capacity) {
        jali_status status = make_room(ctx, r, points + points / 2 + 16);
        if (status != JALI_OK) return status;
    }
    *p = plane->point_count++;
    memcpy(plane->point[*p], c->at, sizeof *plane->point);
    plane->twin[*p] = *p;
    r->size[*p] = MIN(size, c->most);
    if (r->spot) r->spot[*p] = c->spot;
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

static jali_status split_at(jali_context *ctx, refinement *r, int32_t s, const candidate *c, double size,
                            int32_t *p)
{
    *p = -1;
    if (!can_split_side(r->plane, s, c->at)) return JALI_OK;
    int32_t t = s >> 2, o = r->plane->beside[s] >> 2;
    jali_status status = add_point(ctx, r, c, size, p);
    if (status != JALI_OK || *p < 0) return status;
    int32_t depth = split_side(r->plane, s, *p);
    note_triangles(r, t, o);
    settle(r, depth);
    return JALI_OK;
}

jali_status split_border(jali_context *ctx, refinement *r, int32_t s, double share, int32_t *p)
{
    int32_t a = r->plane->corner[next_side(s)], b = r->plane->corner[last_side(s)];
    candidate c;
    for (int k = 0; k < 2; k++)
        c.at[k] = (int32_t)lrint((1 - share) * r->plane->point[a][k] + share * r->plane->point[b][k]);
    *p = -1;
    if ((r->plane->kind[s] & r->fixed) || !lift(r, &c)) return JALI_OK;
    return split_at(ctx, r, s, &c, (1 - share) * r->size[a] + share * r->size[b], p);
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

static double squared_to(const refinement *r, const candidate *c, int32_t p)
{
    return squared_gap(r, c->at, &c->spot, r->plane->point[p], spot_of(r, p));
}

// Side s is constrained and seen from the place under a wide angle.
static bool too_near(const refinement *r, const candidate *c, int32_t s)
{
    if (!r->plane->kind[s]) return false;
    int32_t a = r->plane->corner[next_side(s)], b = r->plane->corner[last_side(s)];
    double to_a = squared_to(r, c, a), to_b = squared_to(r, c, b);
    return to_a + to_b - squared_length(r, a, b) < 2 * TOO_NEAR_COSINE * sqrt(to_a * to_b);
}

// A constrained edge of triangle t, or of its neighbours, that is too near to a place.
static int32_t near_border(const refinement *r, int32_t t, const candidate *c)
{
    for (int32_t s = 4 * t; s < 4 * t + 3; s++) {
        int32_t o = r->plane->beside[s];
        if (too_near(r, c, s)) return s;
        if (r->plane->kind[s]) continue;
        if (too_near(r, c, next_side(o))) return next_side(o);
        if (too_near(r, c, last_side(o))) return last_side(o);
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
static jali_status add_inside(jali_context *ctx, refinement *r, int32_t t, const candidate *c, int32_t *p)
{
    double share[3], size = 0;
    const int32_t *corner = r->plane->corner + 4 * t;
    shares_at(r->plane, t, c->at, share);
    *p = -1;
    for (int k = 0; k < 3; k++) size += share[k] * r->size[corner[k]];
    for (int k = 0; k < 3; k++)
        if (share[k] <= 0) {
            if (r->plane->kind[4 * t + k]) return JALI_OK;
            return split_at(ctx, r, 4 * t + k, c, size, p);
        }
    jali_status status = add_point(ctx, r, c, size, p);
    if (status != JALI_OK || *p < 0) return status;
    int32_t depth = split_triangle(r->plane, t, *p);
    note_triangles(r, t, t);
    settle(r, depth);
    return JALI_OK;
}

// No corner of triangle t and none opposite it is nearer than that.
static bool is_clear(const refinement *r, int32_t t, const candidate *c, double least)
{
    for (int32_t s = 4 * t; s < 4 * t + 3; s++) {
        if (squared_to(r, c, r->plane->corner[s]) < least * least) return false;
        if (!r->plane->kind[s] && squared_to(r, c, r->plane->corner[r->plane->beside[s]]) < least * least)
            return false;
    }
    return true;
}

static jali_status improve(jali_context *ctx, refinement *r, int32_t t)
{
    form f = form_of(r, t);
    double size = mean_size(r, t);
    bool sharp = too_sharp(r, &f);
    candidate c;
    int32_t blocked, p;
    if (!sharp && !too_large(&f, size)) return JALI_OK;
    choose_place(r, &f, size, c.at);
    int32_t holder = walk(r->plane, t, c.at, &blocked);
    if (holder >= 0) {
        if (!lift(r, &c)) return JALI_OK;
        blocked = near_border(r, holder, &c);
        if (!is_clear(r, holder, &c, MAX(r->least, 0.5 * f.length))) return JALI_OK;
    }
    jali_status status = JALI_OK;
    if (blocked != NONE)
        status = give_way(ctx, r, blocked, sharp, &p);
    else if (holder >= 0)
        status = add_inside(ctx, r, holder, &c, &p);
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

// Flip what the measure asks for, everywhere. Flips could go round in a ring where a surface bends within a
// triangle: there is an end to them.
static void flip_all(refinement *r)
{
    triangulation *plane = r->plane;
    int64_t left = 8 * (int64_t)plane->triangle_count;
    int32_t t;
    for (t = 0; t < plane->triangle_count; t++)
        if (r->inside[t]) wait_in(&r->waiting, t, 0);
    while ((t = next_waiting(&r->waiting)) != NONE_WAITING)
        for (int32_t s = 4 * t; s < 4 * t + 3; s++) {
            if (left == 0 || !flips(r, s)) continue;
            int32_t other = plane->beside[s] >> 2;
            flip_side(plane, s);
            left--;
            wait_in(&r->waiting, t, 0);
            wait_in(&r->waiting, other, 0);
            break;
        }
}

jali_status refine_triangles(jali_context *ctx, refinement *r)
{
    jali_status status;
    int32_t t;
    if (r->measure != BY_LATTICE) flip_all(r);
    TRY(split_borders(ctx, r));
    TRY(step(ctx, "mesh", 0.3));
    for (t = 0; t < r->plane->triangle_count; t++) put(r, t);
    while ((t = next_waiting(&r->waiting)) != NONE_WAITING) TRY(improve(ctx, r, t));
    TRY(step(ctx, "mesh", 0.9));
done:
    return status;
}
