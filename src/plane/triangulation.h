// Constrained Delaunay triangulations on the integer lattice. Internal toolbox.
#ifndef PLANE_TRIANGULATION_H
#define PLANE_TRIANGULATION_H

#include "base/base.h"

/// The third corner of the triangles outside the convex hull. With them every side has a neighbour: the
/// triangulation is a closed sphere.
enum { GHOST = -1 };

/// Kinds of constrained edges, one bit each; an edge may be several. Others can be added by later stages.
enum { EDGE_CONTOUR = 1, EDGE_CREASE = 2, EDGE_WINDOW = 4, EDGE_OUTLINE = 8 };

/// {0} is valid and empty. Triangle t has the sides 4t, 4t+1, 4t+2; side s lies opposite corner[s] and runs
/// from corner[next_side(s)] to corner[last_side(s)], counter-clockwise. 4t+3 is unused.
typedef struct triangulation {
    int32_t point_count;
    int32_t (*point)[2];    // [point_count]
    int32_t *twin;          // [point_count] itself, or the earlier point at the same place
    int32_t *star;          // [point_count] a triangle at each point that is its own twin
    int32_t triangle_count; // ghosts included
    int32_t *corner;        // [4 * triangle_count] point, or GHOST
    int32_t *beside;        // [4 * triangle_count] the same edge as a side of the neighbour
    uint8_t *kind;          // [4 * triangle_count] 0, or the kinds of a constrained edge
    int32_t *stack;         // scratch of the flips
    size_t point_capacity, side_capacity, stack_capacity;
    int32_t recent; // where the next walk begins
} triangulation;

/// What stops an edge from being inserted.
typedef struct contact {
    enum { NO_CONTACT, EDGES_CROSS, EDGE_MEETS_POINT } found;
    int32_t from, to; // the edge being inserted
    int32_t other[2]; // the constrained edge it crosses, or {point, point}
} contact;

static inline int32_t next_side(int32_t s)
{
    return (s & 3) == 2 ? s - 2 : s + 1;
}
static inline int32_t last_side(int32_t s)
{
    return (s & 3) == 0 ? s + 2 : s - 1;
}

/// True when a corner of triangle t is the ghost.
static inline bool is_ghost(const triangulation *plane, int32_t t)
{
    return plane->corner[4 * t] == GHOST || plane->corner[4 * t + 1] == GHOST ||
           plane->corner[4 * t + 2] == GHOST;
}

void triangulation_free(jali_context *ctx, triangulation *plane);

/// Add points; they take the numbers point_count .. point_count + count - 1. A point on a constrained edge
/// splits it. While all points lie on one line there are no triangles.
///   in     point   [count], |coordinate| <= 2^24
///   fails  JALI_BAD_INPUT (coordinate), JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
///   cost   expected O(n log n), 1 us a point; exact
jali_status insert_points(jali_context *ctx, triangulation *plane, const int32_t (*point)[2], int32_t count);

/// Add constrained edges between points of the triangulation; no points are added.
///   in     edge        [count] pairs of points
///          through     what to do when an edge runs through a point: true = split it there, false = report
///   out    met         the first edge that cannot be inserted, found = NO_CONTACT when all could
///   fails  JALI_CANCELLED, JALI_NO_MEMORY
///   cost   near O(degree) for an edge that is Delaunay, else O(edges crossed) flips in the mean
jali_status insert_edges(jali_context *ctx, triangulation *plane, const int32_t (*edge)[2], int32_t count,
                         uint8_t kind, bool through, contact *met);

/// The side that runs from point u to point v (its triangle lies on the left), or -1.
///   cost   the smaller of their degrees
int32_t side_between(const triangulation *plane, int32_t u, int32_t v);

/// The tone of each triangle: 0 outside, changing across each edge of a kind in `kinds`.
///   out    tone   [triangle_count] 0 or 1; ghosts 0
jali_status label_tones(jali_context *ctx, const triangulation *plane, uint8_t kinds, uint8_t *tone);

// Shared by the files that change triangulations.

/// Let side s and side o be the same edge.
static inline void join_sides(triangulation *plane, int32_t s, int32_t o)
{
    plane->beside[s] = o;
    plane->beside[o] = s;
}

/// Replace the edge of side s by the other diagonal of its two triangles. Side s afterwards lies opposite the
/// same corner; the new edge is side next_side(s).
void flip_side(triangulation *plane, int32_t s);

/// Room for `points` points and their triangles in all; the splits below take it as given.
///   fails  JALI_LIMIT, JALI_NO_MEMORY
jali_status reserve_points(jali_context *ctx, triangulation *plane, int32_t points);

/// Give triangle t, or the edge of side s, the point p as a corner, and make three or four triangles of it;
/// both halves of the edge keep its kind. Nothing is flipped: the sides opposite p are put on plane->stack
/// and their number is returned.
///   in     t, s   no ghosts; p lies strictly inside (can_split_side tells for an edge)
int32_t split_triangle(triangulation *plane, int32_t t, int32_t p);
int32_t split_side(triangulation *plane, int32_t s, int32_t p);

/// True when the edge of side s can be split at a place on it or next to it: the four triangles stay
/// counter-clockwise, so nothing crosses.
bool can_split_side(const triangulation *plane, int32_t s, const int32_t at[2]);

/// True when the four corners around side s, no ghost among them, are in strictly convex position.
bool is_convex(const triangulation *plane, int32_t s);

/// True when point p lies strictly inside the circle of triangle t; that of a ghost is the open half plane
/// beyond its hull edge, with that edge.
bool in_disc(const triangulation *plane, int32_t t, int32_t p);

#endif
