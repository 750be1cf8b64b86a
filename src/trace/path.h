// Crack paths and the steps that turn one into a contour. Internal to trace.
//
// A crack is the unit edge between a solid and a void pixel. A path follows the cracks around, solid on its
// left, in pixel corners with y up; it is stored by its turns, each between two straight runs of cracks.
#ifndef TRACE_PATH_H
#define TRACE_PATH_H

#include "base/base.h"
#include <jali/bitmap.h>
#include <jali/chart.h>

typedef struct turn {
    int32_t x, y; // pixel corner
    bool apart;   // two solid pixels meet here by their corners alone: two paths pass, each turning left
} turn;

/// {0} is valid and empty.
typedef struct crack_paths {
    int32_t path_count;
    int64_t turn_count;
    int64_t *first;     // [path_count + 1], path i owns the turns first[i] .. first[i+1]-1
    int32_t *length_px; // [path_count], cracks of the path
    turn *turn;         // [turn_count]
    size_t path_capacity, length_capacity, turn_capacity;
} crack_paths;

void crack_paths_free(jali_context *ctx, crack_paths *paths);

/// Follow every crack once.
///   out    paths   in order of the topmost row, then the leftmost column, of their downward cracks
///   fails  JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
jali_status follow_cracks(jali_context *ctx, const jali_bitmap *solid, bool outside_solid,
                          crack_paths *paths);

/// Scratch of one path of n turns and its result in the large.
typedef struct outline {
    const turn *turn; // [n]
    int32_t n;
    bool *square;         // [n] whether a turn is a corner of the drawing
    double *cost;         // [n + 1] least cost of reaching a turn
    int32_t *from;        // [n + 1] and from which turn
    int32_t *vertex;      // [vertex_count] turns that are vertices of the polygon, in order
    double (*line)[4];    // [vertex_count] line of the edge after each vertex: a point, px from the vertex's
                          // turn, and a direction
    double (*place)[2];   // [vertex_count] where each vertex lies, px
    bool *corner;         // [vertex_count] whether the contour has a corner there
    int32_t vertex_count; // <= n
} outline;

/// Choose the vertices: few edges, close to the cracks.
void best_polygon(outline *o);

/// Move the vertices to where the lines fitted to their edges meet, and say which are corners.
void fit_vertices(outline *o);

/// A point of the fine contour: where it crosses the segment between the two pixel centres beside a crack, or
/// a corner of its own.
typedef struct crossing {
    int32_t at[2];       // lattice
    int32_t left, right; // where else the contour may cross: strictly between these, the solid's side first
    int32_t middle;      // midpoint of the crack, along the same line
    int32_t room;        // how far left and right may lie from `at`
    int8_t direction;    // of the crack: 0 = +x, 1 = +y, 2 = -x, 3 = -y; CORNER = no crack
    bool held;           // the smooth curve would pass on the wrong side of a pixel centre
} crossing;

enum { CORNER = 4 };

/// Cross every crack where the smooth curve does.
///   in     unit, slack     lattice units: a pixel, and the deviation allowed
///   out    fine            [cracks + corners]
///   returns  the number of points
int32_t cross_cracks(const outline *o, int32_t unit, int32_t slack, crossing *fine);

/// Keep few of the points: each chord passes all the crossings it skips within their limits.
///   out    point     [count]
///   returns  the number of points
int32_t simplify(const crossing *fine, int32_t count, int32_t (*point)[2]);

#endif
