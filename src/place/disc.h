// A disc of faces cut out of a surface, and its flattening. Internal to the stage place.
#ifndef PLACE_DISC_H
#define PLACE_DISC_H

#include "mesh/sides.h"
#include <jali/mesh.h>

/// A topological disc: one border, a simple loop. All in an arena.
typedef struct disc {
    const jali_mesh *mesh;
    int32_t vertex_count, face_count;
    int32_t *vertex;      // [vertex_count] of the mesh
    int32_t *face;        // [face_count] of the mesh, the first one is under the centre
    int32_t (*corner)[3]; // [face_count] as vertices of the disc
    uint8_t *border; // [face_count] bit k: side k is of the border; bit 4 + k: the surface goes on there,
                     // but was not wanted
    double (*at)[2]; // [vertex_count] place in the plane, mm, x right, y up, the centre near the origin
} disc;

/// Where a disc begins, and which way is up there.
typedef struct disc_seed {
    int32_t face;
    double at[3];    // a point of the face
    double right[3]; // tangent, of length 1
    double normal[3];
} disc_seed;

/// The faces around a seed that lie in a window of the plane, as walking outwards from the seed tells: the
/// places are near those of an unrolling, but neither isometric nor one-to-one.
///   in     half_mm   of the window, about the seed
///   fails  JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(faces of the mesh + n log n) for n faces of the disc
jali_status grow_disc(jali_context *ctx, const jali_mesh *mesh, const sides *linked, const disc_seed *seed,
                      const double half_mm[2], disc *d);

/// Flatten a disc: a map one-to-one on each face that changes lengths as little as it can.
///   inout  d->at    a first guess, which may fold; the result
///   out    folded   none was found: faces so thin that rounding turns them over
///   fails  JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
jali_status flatten_disc(jali_context *ctx, disc *d, bool *folded);

#endif
