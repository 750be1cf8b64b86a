// The large form of a path: a polygon of fitted lines, its vertices where they meet.
//
// How:     an edge is the least-squares line through the midpoints of the cracks it stands for. The vertices,
//          turns of the path, are chosen so that the squared distances, plus EDGE_COST for each edge, are
//          least (dynamic programming). The noise of the pixels adds the same whatever the edges, so it does
//          not weigh in. Vertices then move to where the lines of their edges meet, near their turns.
// Source:  the aim, and fitting lines, are those of Selinger, Potrace: a polygon-based tracing
//          algorithm (2003), section 2.3.1, from its text.
// Limits:  an edge spans at most EDGE_TURNS turns, so that the cost is linear.
#include "trace/path.h"

#include <math.h>
#include <stdlib.h>

enum {
    EDGE_TURNS = 512,
    SQUARE_RUN_PX = 3, // two perpendicular runs this long do not occur on a smooth curve of radius over 3 px
    RESEAT_TURNS = 6,
    STRAIGHT_TURNS = 8, // shorter edges need no check of their centres
};

static const double CENTRE_ROOM_PX = 0.04; // between a line and the nearest pixel centre

static const double REACH_PX = 1.5; // how far a vertex may lie from its turn

// px^2. An arc of radius r then gets edges of (150 EDGE_COST r^2)^(1/5) px: a third of a pixel of sagitta at
// r = 100 px, half a pixel at 10.
static const double EDGE_COST = 0.7;

// The most that pixels add to the squared distance of one crack from a straight line.
static const double PIXEL_NOISE = 1.0 / 8;

static inline const turn *turn_at(const outline *o, int32_t i)
{
    return &o->turn[i < o->n ? i : i - o->n];
}

static inline int32_t run_px(const outline *o, int32_t i)
{
    const turn *a = turn_at(o, i), *b = turn_at(o, i + 1);
    return abs(b->x - a->x) + abs(b->y - a->y);
}

// A corner of the drawing: four turns are a rectangle, whatever its size.
static bool is_square(const outline *o, int32_t i)
{
    return o->n == 4 ||
           (run_px(o, i) >= SQUARE_RUN_PX && run_px(o, i == 0 ? o->n - 1 : i - 1) >= SQUARE_RUN_PX);
}

// Sums over crack midpoints, px from some turn.
typedef struct sums {
    double n, x, y, xx, xy, yy;
} sums;

// Add the run from turn a to turn b, seen from `origin`.
static inline void add_run(sums *s, const turn *origin, const turn *a, const turn *b)
{
    double dx = b->x - a->x, dy = b->y - a->y, n = fabs(dx) + fabs(dy);
    double x = a->x - origin->x + 0.5 * dx, y = a->y - origin->y + 0.5 * dy;
    double spread = n * (n * n - 1) / 12; // of n midpoints one px apart about their mean
    s->n += n;
    s->x += n * x;
    s->y += n * y;
    s->xx += n * x * x + (dx != 0 ? spread : 0);
    s->yy += n * y * y + (dy != 0 ? spread : 0);
    s->xy += n * x * y;
}

// Sum of the squared distances from the least-squares line.
static inline double residual(const sums *s)
{
    double x = s->x / s->n, y = s->y / s->n;
    double xx = s->xx - x * s->x, xy = s->xy - x * s->y, yy = s->yy - y * s->y;
    return MAX(0.5 * (xx + yy - sqrt((xx - yy) * (xx - yy) + 4 * xy * xy)), 0);
}

// Find the best polygon with a vertex at turn `base`; turns are numbered on from there.
static void choose_vertices(outline *o, int32_t base)
{
    for (int32_t k = 1; k <= o->n; k++) o->cost[k] = INFINITY;
    o->cost[0] = 0;
    for (int32_t i = 0; i < o->n; i++) {
        sums s = {0};
        const turn *origin = turn_at(o, base + i), *before = origin;
        int32_t end = MIN(o->n, i + EDGE_TURNS);
        for (int32_t k = i + 1; k <= end; k++) {
            int32_t slot = base + k < o->n ? base + k : base + k - o->n;
            const turn *here = &o->turn[slot];
            add_run(&s, origin, before, here);
            before = here;
            double off = residual(&s), cost = o->cost[i] + off + EDGE_COST;
            if (cost < o->cost[k]) o->cost[k] = cost, o->from[k] = i;
            if (off > PIXEL_NOISE * s.n + 2 * EDGE_COST || o->square[slot]) break;
        }
    }
    o->vertex_count = 0;
    for (int32_t k = o->n; k > 0; k = o->from[k]) o->vertex_count++;
    for (int32_t k = o->n, slot = o->vertex_count; k > 0;) {
        k = o->from[k];
        o->vertex[--slot] = base + k < o->n ? base + k : base + k - o->n;
    }
}

void best_polygon(outline *o)
{
    int32_t square = -1;
    for (int32_t i = 0; i < o->n; i++)
        if ((o->square[i] = is_square(o, i)) && square < 0) square = i;
    choose_vertices(o, MAX(square, 0));
    // Without a corner the start was arbitrary: begin again at the vertex farthest from it.
    if (square < 0) choose_vertices(o, o->vertex[o->vertex_count / 2]);
}

// A quadratic form: squared distance from a line, as v^T Q v with v = (x, y, 1).
typedef struct form {
    double xx, xy, yy, x, y, c;
} form;

// The least-squares line of the cracks between turns i and end, seen from turn i: a middle point and a
// direction, of unit length.
static void fit_line(const outline *o, int32_t i, int32_t end, double middle[2], double along[2])
{
    sums s = {0};
    for (int32_t j = i; j < end; j++) add_run(&s, turn_at(o, i), turn_at(o, j), turn_at(o, j + 1));
    middle[0] = s.x / s.n, middle[1] = s.y / s.n;
    double a = s.xx / s.n - middle[0] * middle[0], b = s.xy / s.n - middle[0] * middle[1];
    double c = s.yy / s.n - middle[1] * middle[1];
    double largest = 0.5 * (a + c + sqrt((a - c) * (a - c) + 4 * b * b));
    const turn *from = turn_at(o, i), *to = turn_at(o, end);
    double chord[2] = {to->x - from->x, to->y - from->y}, length;
    // The principal axis; a single crack has none, its chord serves.
    if (largest - c >= largest - a)
        along[0] = largest - c, along[1] = b;
    else
        along[0] = b, along[1] = largest - a;
    length = hypot(along[0], along[1]);
    if (length < 1e-6) along[0] = chord[0], along[1] = chord[1], length = hypot(chord[0], chord[1]);
    if (along[0] * chord[0] + along[1] * chord[1] < 0) length = -length;
    along[0] /= length;
    along[1] /= length;
}

// In the frame of a line: how the room between the solid centres on its left and the void ones on its right
// lies once the line is turned by `tilt`.
typedef struct room {
    double left, right, left_at, right_at;
} room; // heights over the line, and where along it

static inline void narrow(room *r, const double middle[2], const double along[2], double tilt, double x,
                          double y, double side)
{
    x -= middle[0], y -= middle[1];
    double u = along[0] * x + along[1] * y;
    double w = along[0] * y - along[1] * x - tilt * u;
    if (side > 0 && w < r->left) r->left = w, r->left_at = u;
    if (side < 0 && w > r->right) r->right = w, r->right_at = u;
}

static room room_beside(const outline *o, int32_t i, int32_t end, const double middle[2],
                        const double along[2], double tilt)
{
    room r = {INFINITY, -INFINITY, 0, 0};
    const turn *from = turn_at(o, i);
    for (int32_t j = i; j < end; j++) { // the first and the last crack of each run
        const turn *a = turn_at(o, j), *b = turn_at(o, j + 1);
        double dx = (b->x > a->x) - (b->x < a->x), dy = (b->y > a->y) - (b->y < a->y);
        double ax = a->x - from->x + 0.5 * dx, ay = a->y - from->y + 0.5 * dy;
        double bx = b->x - from->x - 0.5 * dx, by = b->y - from->y - 0.5 * dy;
        narrow(&r, middle, along, tilt, ax - 0.5 * dy, ay + 0.5 * dx, 1);
        narrow(&r, middle, along, tilt, bx - 0.5 * dy, by + 0.5 * dx, 1);
        narrow(&r, middle, along, tilt, ax + 0.5 * dy, ay - 0.5 * dx, -1);
        narrow(&r, middle, along, tilt, bx + 0.5 * dy, by - 0.5 * dx, -1);
    }
    return r;
}

// Pixels of a straight edge leave a narrow band of lines that keep every centre on its side; the
// least-squares line can miss it. Then take the middle of the band, if there is one. The room is a concave
// function of the tilt, so bisection finds its largest.
static void keep_centres(const outline *o, int32_t i, int32_t end, double middle[2], double along[2])
{
    if (end - i < STRAIGHT_TURNS) return;
    room r = room_beside(o, i, end, middle, along, 0);
    if (r.left > CENTRE_ROOM_PX && r.right < -CENTRE_ROOM_PX) return;
    const turn *from = turn_at(o, i), *to = turn_at(o, end);
    double most = 2 / hypot(to->x - from->x, to->y - from->y), low = -most, high = most, best = 0,
           best_tilt = 0;
    double best_height = 0;
    for (int step = 0; step < 14; step++) {
        double tilt = 0.5 * (low + high);
        r = room_beside(o, i, end, middle, along, tilt);
        if (r.left - r.right > best)
            best = r.left - r.right, best_tilt = tilt, best_height = 0.5 * (r.left + r.right);
        if (r.right_at > r.left_at)
            low = tilt;
        else
            high = tilt;
    }
    if (best <= 0) return;
    double x = along[0] - best_tilt * along[1], y = along[1] + best_tilt * along[0], length = hypot(x, y);
    middle[0] -= best_height * along[1];
    middle[1] += best_height * along[0];
    along[0] = x / length;
    along[1] = y / length;
}

// The squared distance from the line of edge v, seen from `centre`.
static void add_line(const outline *o, int32_t v, const turn *centre, form *q)
{
    const double *line = o->line[v];
    const turn *from = &o->turn[o->vertex[v]];
    double nx = -line[3], ny = line[2];
    double offset = -(nx * (line[0] + from->x - centre->x) + ny * (line[1] + from->y - centre->y));
    q->xx += nx * nx, q->xy += nx * ny, q->yy += ny * ny;
    q->x += nx * offset, q->y += ny * offset, q->c += offset * offset;
}

static double form_at(const form *q, double x, double y)
{
    return q->xx * x * x + 2 * q->xy * x * y + q->yy * y * y + 2 * (q->x * x + q->y * y) + q->c;
}

// The least value of the form within REACH_PX each way.
static void least_within_reach(const form *q, double place[2])
{
    double det = q->xx * q->yy - q->xy * q->xy, least = INFINITY;
    if (det > 1e-9) {
        double x = (q->xy * q->y - q->yy * q->x) / det, y = (q->xy * q->x - q->xx * q->y) / det;
        if (fabs(x) <= REACH_PX && fabs(y) <= REACH_PX) {
            place[0] = x, place[1] = y;
            return;
        }
    }
    for (int side = 0; side < 4; side++) {
        double edge = side & 1 ? REACH_PX : -REACH_PX, x, y;
        if (side < 2)
            x = edge, y = q->yy > 1e-9 ? -(q->y + q->xy * x) / q->yy : 0;
        else
            y = edge, x = q->xx > 1e-9 ? -(q->x + q->xy * y) / q->xx : 0;
        x = MIN(MAX(x, -REACH_PX), REACH_PX), y = MIN(MAX(y, -REACH_PX), REACH_PX);
        if (form_at(q, x, y) < least) least = form_at(q, x, y), place[0] = x, place[1] = y;
    }
}

// Let the vertex be the turn nearest to its place, so that corners stand in their own cells. It does not pass
// the vertices beside it.
static int32_t nearest_turn(const outline *o, int32_t before, int32_t here, int32_t after,
                            const double place[2])
{
    int32_t best = here;
    double least = INFINITY;
    int32_t back = (here - before + o->n - 1) % o->n, ahead = (after - here + o->n - 1) % o->n;
    for (int32_t j = -MIN(back / 2, RESEAT_TURNS); j <= MIN(ahead / 2, RESEAT_TURNS); j++) {
        int32_t slot = (here + j + o->n) % o->n;
        double distance = hypot(o->turn[slot].x - place[0], o->turn[slot].y - place[1]);
        if (distance < least - 1e-9) least = distance, best = slot;
    }
    return best;
}

void fit_vertices(outline *o)
{
    for (int32_t v = 0; v < o->vertex_count; v++) {
        int32_t from = o->vertex[v], to = o->vertex[v + 1 == o->vertex_count ? 0 : v + 1];
        if (to <= from) to += o->n;
        fit_line(o, from, to, o->line[v], o->line[v] + 2);
        keep_centres(o, from, to, o->line[v], o->line[v] + 2);
    }
    for (int32_t v = 0; v < o->vertex_count; v++) {
        int32_t here = o->vertex[v];
        const turn *centre = &o->turn[here];
        form q = {0};
        add_line(o, v == 0 ? o->vertex_count - 1 : v - 1, centre, &q);
        add_line(o, v, centre, &q);
        double place[2] = {0, 0};
        least_within_reach(&q, place);
        o->place[v][0] = centre->x + place[0];
        o->place[v][1] = centre->y + place[1];
        o->corner[v] = o->square[here];
    }
    // Each stays on its own half of the turns between it and the next, so the order is kept.
    int32_t first = o->vertex[0], before = o->vertex[o->vertex_count - 1];
    for (int32_t v = 0; v < o->vertex_count; v++) {
        int32_t here = o->vertex[v], after = v + 1 == o->vertex_count ? first : o->vertex[v + 1];
        if (!o->corner[v]) o->vertex[v] = nearest_turn(o, before, here, after, o->place[v]);
        before = here;
    }
}
