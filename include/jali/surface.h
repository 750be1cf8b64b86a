// Surfaces to carve: shapes made by formula, or meshes from files.
#ifndef JALI_SURFACE_H
#define JALI_SURFACE_H

#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The outer skin of an object. {0} is valid and empty.
typedef struct jali_surface {
    jali_mesh mesh;     // one index a place, counter-clockwise seen from outside; z is up, -y is the front
    double (*uv)[3][2]; // [mesh.triangle_count] where each corner lies on the unrolled surface, mm, u right,
                        // v up; NULL: it cannot be unrolled without a cut of its own. Triangles that are not
                        // part of what is unrolled (floors) have NaN
    double around_mm;   // u and u + around_mm are the same place; 0 = the unrolled surface does not close
} jali_surface;

JALI_API void jali_surface_free(jali_context *ctx, jali_surface *surface);

typedef struct jali_surface_options {
    double tolerance_mm; // how far a curve may lie from its facets, along and around each, 0.0005 .. 10;
                         // default 0.02
} jali_surface_options;

JALI_API jali_surface_options jali_surface_defaults(void);

typedef struct jali_surface_info {
    const char *name; // as jali_surface_make takes it
    const char *what; // one line, with the values it takes
} jali_surface_info;

/// The shapes, in the order to show them; their number is put in `count`.
JALI_API const jali_surface_info *jali_surface_list(int32_t *count);

/// Make a surface from its description on the command line: `name` or `name:key=value,key=value`, lengths in
/// mm.
///
///   plate:w=,h=            stands upright and faces the front; u = x, v = z. It has no inside of its own
///   cylinder:r=,h=         u = angle * r, v = height
///   cone:r=,top=,h=        radius r at the base, `top` (may be 0) above; u, v = the unrolled sector,
///   exactly: the
///                          front's line upright, its base at (0, 0)
///   sphere:r=              closed; u = angle * r, v = arc length from the lowest point
///   vase:NAME,h=,r=        turned from a smooth profile; h and r (largest radius) scale it, one alone scales
///   both;
///                          u = angle * (largest radius), v = arc length from the base
///   vase:profile=FILE,..   from a file of "radius height" pairs in mm, one a line, # begins a comment; a
///   pair given
///                          twice is a corner
///
/// All but the plate take facets= (triangles around, 8 .. 4096; else from the tolerance, a multiple of 16)
/// and tolerance=. Cylinder, cone and vase take floor=yes|no (default: vase yes, others no): a disc at the
/// base, part of the same skin, so that one rim is left, the upper one; its uv is NaN.
///
/// The base stands on z = 0, the axis is x = y = 0. Angles count from the middle of the front (-y), to the
/// right as seen from there; the seam, where u leaps by around_mm, is at the back, on edges of the mesh.
/// Towards the axis the facets around are halved from ring to ring, so that triangles stay well shaped.
/// Vertices lie on a power-of-two lattice that float32 holds exactly, within 1e-5 mm of the formula below 0.1
/// m.
///   in     opt      NULL means the defaults; keys of the description win
///   out    surface  manifold, no degenerate triangle; free with jali_surface_free
///   fails  JALI_BAD_VALUE (the message says what is accepted), JALI_BAD_INPUT and JALI_IO (the profile's
///   file),
///          JALI_LIMIT, JALI_NO_MEMORY, JALI_CANCELLED
///   cost   O(triangles + rows^2)
JALI_API jali_status jali_surface_make(jali_context *ctx, const char *description,
                                       const jali_surface_options *opt, jali_surface *surface);

#ifdef __cplusplus
}
#endif
#endif
