// The least separator between two ends of a graph, by paths that share no node.
//
// Source:  K. Menger, 1927: as many paths without a common node as the least separator has nodes. Found
//          in phases, in which each place is tried once, until one finds no path.
// How:     Each node is entered and left, one path through it at most. A new path that enters a used node
//          goes back along the path there, which is cut and goes on another way.
// Checked: tests/test_sparse.c: against all sets of nodes, on small graphs.
#include "sparse/separate.h"

enum { NOBODY = -1, OUTSIDE = -2, UNSEEN = -1 };

typedef struct walk {
    const node_graph *g;
    int32_t count;
    const int32_t *node, *number, *side;
    const separate_desk *desk;
} walk;

// A node as it is entered, 2 i, and as it is left, 2 i + 1.
static inline int32_t entering(int32_t i)
{
    return 2 * i;
}

static inline int32_t leaving(int32_t i)
{
    return 2 * i + 1;
}

static bool touches(const walk *w, int32_t i, int32_t side)
{
    for (int32_t e = w->g->first[w->node[i]]; e < w->g->first[w->node[i] + 1]; e++)
        if (w->side[w->g->beside[e]] == side) return true;
    return false;
}

// Where a state leads but to neighbours: through a free node; from a used one back along its path; -1:
// nowhere.
static int32_t own_way(const walk *w, int32_t state)
{
    int32_t i = state / 2, last = w->desk->last[i];
    if (state == leaving(i)) return last != NOBODY ? entering(i) : -1;
    return last == NOBODY ? leaving(i) : last >= 0 ? leaving(last) : -1;
}

// How far each node is from the high end; UNSEEN: no way leads there.
static void find_distances(const walk *w)
{
    const separate_desk *d = w->desk;
    int32_t reached = 0;
    for (int32_t i = 0; i < w->count; i++) d->distance[i] = UNSEEN;
    for (int32_t i = 0; i < w->count; i++) {
        if (!touches(w, i, HIGH)) continue;
        d->distance[i] = 0;
        d->state[reached++] = i;
    }
    for (int32_t q = 0; q < reached; q++) {
        int32_t i = d->state[q];
        for (int32_t e = w->g->first[w->node[i]]; e < w->g->first[w->node[i] + 1]; e++) {
            int32_t beside = w->g->beside[e];
            if (w->side[beside] != MIDDLE || d->distance[w->number[beside]] != UNSEEN) continue;
            d->distance[w->number[beside]] = d->distance[i] + 1;
            d->state[reached++] = w->number[beside];
        }
    }
}

// The next state on a way, one that no way has come to in this phase; -1: there is none. Neighbours nearer to
// the high end are tried first.
static int32_t advance(const walk *w, int32_t state)
{
    const separate_desk *d = w->desk;
    int32_t i = state / 2, own = own_way(w, state);
    if (own >= 0 && !d->seen[own]) return own;
    if (state == entering(i)) return -1;
    int32_t first = w->g->first[w->node[i]], degree = w->g->first[w->node[i] + 1] - first;
    while (d->edge[i] < 2 * degree) {
        bool nearer = d->edge[i] < degree;
        int32_t beside = w->g->beside[first + d->edge[i]++ % degree], to = w->number[beside];
        if (w->side[beside] != MIDDLE || d->seen[entering(to)]) continue;
        if (d->distance[to] < d->distance[i] || !nearer) return entering(to);
    }
    return -1;
}

// What a way through states changes: paths are cut where it goes back, and laid where it goes on.
static void lay_path(const separate_desk *d, const int32_t *state, int32_t count)
{
    for (int32_t k = 1; k < count; k++) {
        int32_t from = state[k - 1] / 2, to = state[k] / 2;
        if (from != to && state[k] == leaving(to)) d->next[to] = d->last[from] = NOBODY;
    }
    for (int32_t k = 1; k < count; k++) {
        int32_t from = state[k - 1] / 2, to = state[k] / 2;
        if (from == to || state[k] == leaving(to)) continue;
        d->next[from] = to;
        d->last[to] = from;
    }
    d->last[state[0] / 2] = OUTSIDE;
    d->next[state[count - 1] / 2] = OUTSIDE;
}

// One more path from a node at the low end, depth first.
static bool add_path(const walk *w, int32_t from)
{
    const separate_desk *d = w->desk;
    int32_t *state = d->state, count = 0;
    state[count++] = entering(from);
    while (count > 0) {
        int32_t s = state[count - 1], i = s / 2, to;
        d->seen[s] = true;
        if (s == leaving(i) && d->next[i] != OUTSIDE && d->distance[i] == 0) {
            lay_path(d, state, count);
            return true;
        }
        to = advance(w, s);
        if (to >= 0)
            state[count++] = to;
        else
            count--;
    }
    return false;
}

// Paths until each state has been tried; how many.
static int32_t run_phase(const walk *w)
{
    const separate_desk *d = w->desk;
    int32_t added = 0;
    memset(d->seen, 0, 2 * (size_t)w->count * sizeof *d->seen);
    memset(d->edge, 0, (size_t)w->count * sizeof *d->edge);
    for (int32_t i = 0; i < w->count; i++)
        if (!d->seen[entering(i)] && d->distance[i] != UNSEEN && touches(w, i, LOW)) added += add_path(w, i);
    return added;
}

void separate(const node_graph *g, int32_t count, const int32_t *node, const int32_t *number, int32_t *side,
              const separate_desk *desk)
{
    walk w = {g, count, node, number, side, desk};
    for (int32_t i = 0; i < count; i++) desk->last[i] = desk->next[i] = NOBODY;
    find_distances(&w);
    while (run_phase(&w) > 0) {
    }
    // What the low end reaches is LOW; what it enters and cannot leave parts the two.
    for (int32_t i = 0; i < count; i++) {
        bool entered = desk->seen[entering(i)], left = desk->seen[leaving(i)] || desk->distance[i] == UNSEEN;
        side[node[i]] = left ? LOW : entered ? MIDDLE : HIGH;
    }
}
