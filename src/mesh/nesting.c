// How shells lie in each other.
//
// A vertical ray goes up from a vertex of the shell; each triangle it crosses counts by its orientation. The
// ray is moved aside by infinitely little, (e^2, e) in x and y, so that it meets no edge and no vertex: a
// zero determinant takes the sign of its first term in e that is not zero (simulation of simplicity).
//
// Source:  Edelsbrunner and Muecke, Simulation of Simplicity, 1990.
// Limits:  shells that cross or touch have no inside to speak of; the intersection count tells.
#include "mesh/nesting.h"

#include <math.h>

typedef const int64_t *point;

// The side of u -> v on which p lies, seen along z; 0 only when u and v fall on one point.
static int turn_of_moved(bool narrow, point u, point v, point p)
{
    int turn = turn_in_plane(narrow, 2, u, v, p);
    if (turn) return turn;
    if (v[0] != u[0]) return v[0] > u[0] ? 1 : -1;
    return (v[1] < u[1]) - (v[1] > u[1]);
}

// +1 or -1 when the ray from p crosses the triangle, by its orientation; else 0.
static int crossing(const lattice *l, const int32_t triangle[3], point p)
{
    point t[3] = {l->point[triangle[0]], l->point[triangle[1]], l->point[triangle[2]]};
    normal n = normal_of(l->narrow, t[0], t[1], t[2]);
    int up = sign_of(n.along[2]);
    if (up == 0) return 0;
    for (int k = 0; k < 3; k++)
        if (turn_of_moved(l->narrow, t[k], t[(k + 1) % 3], p) != up) return 0;
    return side_of(l->narrow, &n, t[0], p) == -up ? up : 0;
}

void shell_windings(const exact_surface *s, const topology *t, int32_t *winding)
{
    memset(winding, 0, (size_t)t->shell_count * sizeof *winding);
    if (t->shell_count < 2) return;
    int32_t done = -1; // shells are numbered by their first triangles
    for (int32_t i = 0; i < t->triangle_count; i++) {
        int32_t shell = t->shell[i];
        if (shell <= done) continue;
        done = shell;
        if (t->flawed[shell]) continue;
        point p = s->l->point[s->triangle[i][0]];
        box ray;
        for (int k = 0; k < 3; k++) {
            ray.low[k] = nextafterf((float)p[k], -INFINITY);
            ray.high[k] = k < 2 ? nextafterf((float)p[k], INFINITY) : INFINITY;
        }
        box_walk walk = box_walk_start(&s->tree, &ray, 0);
        for (int32_t place; (place = box_walk_next(&walk)) >= 0;) {
            int32_t other = s->face[s->tree.item[place]];
            if (t->shell[other] == shell || t->shell[other] < 0 || t->flawed[t->shell[other]]) continue;
            winding[shell] += crossing(s->l, s->triangle[other], p);
        }
    }
}
