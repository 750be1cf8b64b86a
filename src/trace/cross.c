// The smooth curve over the polygon, and where it crosses each crack.
//
// Source:  Selinger (2003), section 2.3: between the middles of two edges runs one Bezier arc, its handles
//          longer the farther the vertex stands out; a vertex that stands out far is a corner.
// Differs: the curve is only a proposal. What counts is where it crosses the segment between the two pixel
//          centres beside each crack; the crossing is held at least a lattice unit away from both.
#include "trace/path.h"

#include <math.h>
#include <stdlib.h>

enum { ARC_STEPS = 12, LEG_POINTS = 2 * ARC_STEPS + 4, EASED_CRACKS = 3, EASING_ROUNDS = 4 };

// A curve that passes a pixel centre on the wrong side by less than this leaves no visible bump.
static const double HELD_PX = 0.05;

// The curve near one vertex: from the middle of the edge before, past the vertex, to the middle of the next.
typedef struct bend {
    double start[2], at[2], end[2];
    double reach; // how far the handles go towards the vertex: 0.55 (blunt) .. 1
    bool corner;
} bend;

// Share of the vertex's height over its neighbours that half a pixel makes up decides how sharp it is.
static bend bend_at(const outline *o, int32_t v)
{
    const double *a = o->place[v == 0 ? o->vertex_count - 1 : v - 1], *b = o->place[v];
    const double *c = o->place[v + 1 == o->vertex_count ? 0 : v + 1];
    bend here = {.corner = o->corner[v]};
    for (int k = 0; k < 2; k++) {
        here.start[k] = 0.5 * (a[k] + b[k]);
        here.at[k] = b[k];
        here.end[k] = 0.5 * (b[k] + c[k]);
    }
    double height = fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    double pixel = fabs(c[0] - a[0]) + fabs(c[1] - a[1]); // height of a pixel over the same chord
    double reach = height > pixel ? (1 - pixel / height) / 0.75 : 0;
    if (reach >= 1) here.corner = true;
    here.reach = MIN(MAX(reach, 0.55), 1);
    return here;
}

static void bend_point(const bend *b, double t, double point[2])
{
    double u = 1 - t;
    for (int k = 0; k < 2; k++) {
        double from = b->start[k] + b->reach * (b->at[k] - b->start[k]);
        double to = b->end[k] + b->reach * (b->at[k] - b->end[k]);
        point[k] = u * u * u * b->start[k] + 3 * u * t * (u * from + t * to) + t * t * t * b->end[k];
    }
}

static int arc_steps(const bend *b)
{
    double length = fabs(b->end[0] - b->start[0]) + fabs(b->end[1] - b->start[1]);
    return (int)MIN(MAX(ceil(length / 2), 2), ARC_STEPS);
}

// The curve from the vertex of `from` to that of `to`: at most LEG_POINTS points.
static int leg(const bend *from, const bend *to, double point[LEG_POINTS][2])
{
    int count = 0, steps = arc_steps(from);
    if (from->corner)
        memcpy(point[count++], from->at, sizeof from->at);
    else
        for (int i = 0; i < steps; i++) bend_point(from, 0.5 + 0.5 * i / steps, point[count++]);
    memcpy(point[count++], from->end, sizeof from->end);
    steps = arc_steps(to);
    if (to->corner)
        memcpy(point[count++], to->at, sizeof to->at);
    else
        for (int i = 1; i <= steps; i++) bend_point(to, 0.5 * i / steps, point[count++]);
    return count;
}

// A crack: its midpoint in px, its direction.
typedef struct crack {
    double x, y;
    int8_t direction;
} crack;

// Where the curve passes a crack, seen from its midpoint: how far to the left, px, and how many times longer
// a deviation is along this line than square to the curve. Beyond the ends of the leg its first and last
// pieces go on straight; `piece` moves along with the cracks.
typedef struct passage {
    double offset, stretch;
} passage;

static passage pass_crack(const double (*point)[2], int count, const crack *c, int *piece)
{
    int along = c->direction & 1, across = !along;
    double sign = c->direction < 2 ? 1 : -1, level = along ? c->y : c->x;
    while (*piece + 2 < count && (point[*piece + 1][along] - level) * sign < 0) ++*piece;
    const double *a = point[*piece], *b = point[*piece + 1];
    double run = (b[along] - a[along]) * sign, rise = b[across] - a[across];
    if (run < 1e-3 * fabs(rise) || run < 1e-9) return (passage){0, 1}; // it turns back: no leave to stray
    double offset = a[across] + (level - a[along]) * sign / run * rise - (along ? c->x : c->y);
    // Left is +y of a crack in +x, -x of a crack in +y, and so on.
    return (passage){c->direction == 0 || c->direction == 3 ? offset : -offset,
                     sqrt(run * run + rise * rise) / run};
}

// Put the crossing of a crack `offset` units to the left of its midpoint, or as near to that as its pixel
// centres allow.
static void place_crossing(crossing *fine, double offset, int32_t half)
{
    int across = !(fine->direction & 1), left = fine->direction == 0 || fine->direction == 3 ? 1 : -1;
    int32_t most = half - 1, at = (int32_t)lround(MIN(MAX(offset, -most), most)), middle = fine->middle;
    fine->at[across] = middle + left * at;
    fine->left = middle + left * MIN(at + fine->room, half);
    fine->right = middle + left * MAX(at - fine->room, -half);
}

static crossing cross_one(const crack *c, passage p, int32_t unit, int32_t slack)
{
    crossing fine = {.at = {(int32_t)lround(c->x * unit), (int32_t)lround(c->y * unit)},
                     .direction = c->direction};
    fine.room = (int32_t)MIN(slack * p.stretch, unit) + 1;
    fine.middle = fine.at[!(c->direction & 1)];
    fine.held = fabs(p.offset) > 0.5 + HELD_PX * p.stretch;
    place_crossing(&fine, p.offset * unit, unit / 2);
    return fine;
}

// Move a crossing onto the straight line between its neighbours, as far as its pixel centres allow.
static void straighten(crossing *c, const crossing *before, const crossing *after, int32_t unit)
{
    if (c->direction == CORNER) return;
    int along = c->direction & 1, across = !along;
    double run = after->at[along] - before->at[along];
    if (run * (c->direction < 2 ? 1 : -1) <= 0) return;
    double share = (c->at[along] - before->at[along]) / run;
    double target = before->at[across] + share * (after->at[across] - before->at[across]);
    place_crossing(c, (target - c->middle) * (c->direction == 0 || c->direction == 3 ? 1 : -1), unit / 2);
}

// Where the curve was held back it would leave a bump: pull the crossings around straight.
static void ease_bumps(crossing *fine, int32_t count, int32_t unit)
{
    if (count < 4 * EASED_CRACKS) return;
    for (int32_t k = 0; k < count; k++) {
        if (!fine[k].held) continue;
        int32_t first = k;
        for (int32_t next = k + 1; next <= k + EASED_CRACKS && next < count; next++)
            if (fine[next].held) k = next;
        for (int round = 0; round < EASING_ROUNDS; round++)
            for (int32_t j = first - EASED_CRACKS; j <= k + EASED_CRACKS; j++) {
                crossing *here = &fine[j < 0 ? j + count : j < count ? j : j - count];
                const crossing *before = here == fine ? fine + count - 1 : here - 1;
                straighten(here, before, here + 1 == fine + count ? fine : here + 1, unit);
            }
    }
}

// A corner stays in its pixel-sized cell, which no other path enters unless two solids meet there.
static bool corner_point(const outline *o, int32_t v, int32_t unit, crossing *fine)
{
    const turn *here = &o->turn[o->vertex[v]];
    if (here->apart) return false;
    double dx = o->place[v][0] - here->x, dy = o->place[v][1] - here->y;
    double size = sqrt(dx * dx + dy * dy), most = 0.5 - 1.5 / unit, shrink = size > most ? most / size : 1;
    *fine = (crossing){.at = {here->x * unit + (int32_t)lround(dx * shrink * unit),
                              here->y * unit + (int32_t)lround(dy * shrink * unit)},
                       .direction = CORNER};
    return true;
}

int32_t cross_cracks(const outline *o, int32_t unit, int32_t slack, crossing *fine)
{
    int32_t count = 0;
    bend from = bend_at(o, 0);
    for (int32_t v = 0; v < o->vertex_count; v++) {
        int32_t after = v + 1 == o->vertex_count ? 0 : v + 1;
        bend to = bend_at(o, after);
        double point[LEG_POINTS][2];
        int points = leg(&from, &to, point), piece = 0;
        if (from.corner && corner_point(o, v, unit, &fine[count])) count++;
        for (int32_t i = o->vertex[v]; i != o->vertex[after]; i = i + 1 == o->n ? 0 : i + 1) {
            const turn *a = &o->turn[i], *b = &o->turn[i + 1 == o->n ? 0 : i + 1];
            int32_t dx = (b->x > a->x) - (b->x < a->x), dy = (b->y > a->y) - (b->y < a->y);
            int8_t direction = (int8_t)(dx > 0 ? 0 : dy > 0 ? 1 : dx < 0 ? 2 : 3);
            int32_t length = abs(b->x - a->x) + abs(b->y - a->y);
            for (int32_t j = 0; j < length; j++) {
                crack c = {a->x + (j + 0.5) * dx, a->y + (j + 0.5) * dy, direction};
                fine[count++] =
                    cross_one(&c, pass_crack((const double(*)[2])point, points, &c, &piece), unit, slack);
            }
        }
        from = to;
    }
    ease_bumps(fine, count, unit);
    return count;
}
