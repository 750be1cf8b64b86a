// Refinement: triangles of a wished size and of good shape, on the plane or on a surface above it. Internal
// toolbox.
#ifndef PLANE_REFINE_H
#define PLANE_REFINE_H

#include "plane/triangulation.h"
#include "plane/waiting.h"

/// Where a place of the lattice lies on a surface.
typedef struct spot {
    double place[3];  // in space
    double metric[3]; // a step (dx, dy) is sqrt(m0 dx^2 + 2 m1 dx dy + m2 dy^2) long
} spot;

typedef struct lifting {
    bool (*lift)(void *shared, const int32_t at[2], spot *to, double *most); // most: size allowed there
    void *shared;                                                            // false: it lies nowhere
} lifting;

/// {0} with a plane, `inside` and `least` set is ready, on a surface with `lifting` and `measure`, too; free
/// with refinement_free, which leaves the plane. Lengths are lattice units, or those of the surface.
typedef struct refinement {
    triangulation *plane;
    uint8_t *inside; // [plane->triangle_count] 1 = to be refined; others share constrained edges with them
    double *size;    // [plane->point_count] wished length of the edges there
    spot *spot;      // [plane->point_count]; NULL: the lattice is the surface
    lifting lifting;
    // How lengths are measured: on the lattice; by the metrics at both ends, which holds for long edges as
    // well; or straight through space, which is what a facet has.
    enum { BY_LATTICE, BY_METRIC, BY_SPACE } measure;
    double least;  // points are made no nearer to each other than that
    uint8_t fixed; // kinds of edges that are not split
    size_t inside_capacity, size_capacity, spot_capacity, waiting_capacity;
    waiting waiting; // triangles to be looked at, those with short sides first
} refinement;

void refinement_free(jali_context *ctx, refinement *r);

/// Room for what goes with each point and triangle of the plane; `inside` keeps what it has, the rest is
/// cleared.
///   fails  JALI_NO_MEMORY
jali_status refinement_begin(jali_context *ctx, refinement *r, int32_t *astray);

/// Split border edges until none is longer than the distance to what lies across, or than `finest`, whichever
/// is longer. Then tells the sizes: each `across`-th of the width there, at least `finest`, at most
/// `coarsest`, growing by at most `growth` a length.
///   fails  JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
///   cost   O(points of the borders)
jali_status refine_sizes(jali_context *ctx, refinement *r, double across, double finest, double coarsest,
                         double growth);

/// Add points inside and on border edges until triangles have their size and no small angle, but where edges
/// that were given enclose one. Edges are flipped first where the measure was changed.
///   fails  JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
///   cost   about 2 us a point
jali_status refine_triangles(jali_context *ctx, refinement *r);

// Shared by the files of the refinement.

/// What a triangle looks like with its shortest side laid on the x axis.
typedef struct form {
    int32_t side;        // the shortest
    double length, x, y; // of that side; the corner opposite, from where the side begins
    double radius;       // of the circumcircle
} form;

double squared_length(const refinement *r, int32_t a, int32_t b);
form form_of(const refinement *r, int32_t t);

/// Split the edge of side s at a share of its length.
///   out    p      the new point, or -1 when the place is taken or not safe
jali_status split_border(jali_context *ctx, refinement *r, int32_t s, double share, int32_t *p);

#endif
