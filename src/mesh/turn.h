// A profile turned around the z axis: the surface of revolution, unrolled.
#ifndef MESH_TURN_H
#define MESH_TURN_H

#include "mesh/profile.h"

#include <jali/surface.h>

enum { LEAST_FACETS = 8, MOST_FACETS = 4096, MOST_TRIANGLES = 20000000 };

static const double longest_facets = 5; // height of a row of triangles, in widths of its widest facet

typedef struct turned {
    const char *name; // in sentences
    profile curve;    // from the base up
    double tolerance_mm;
    int32_t facets; // around the widest place; 0 = as the tolerance asks
    int32_t floor;  // 1 = with a disc at the base
    // What is unrolled: u = angle * largest radius, v = along the profile; or, with sector > 0, a cone.
    double sector;       // angle of the unrolled cone by the angle around its axis, below 1
    double cone_base_mm; // along the cone from its base to its apex; negative when the apex lies below
} turned;

/// Make the surface; the curve is the caller's. See jali_surface_make.
///   fails  JALI_BAD_VALUE (the profile crosses itself), JALI_LIMIT, JALI_NO_MEMORY; the surface may then be
///          half made, the caller frees it
jali_status turn_profile(jali_context *ctx, const turned *t, jali_surface *surface);

/// Allocate mesh and uv.
///   fails  JALI_LIMIT, JALI_NO_MEMORY
jali_status surface_allocate(jali_context *ctx, int64_t vertices, int64_t triangles, jali_surface *surface);

/// Which shape a description names; -1: none of them.
int32_t shape_named(const char *description);

/// The profile's largest radius.
double widest_mm(const profile *p);

#endif
