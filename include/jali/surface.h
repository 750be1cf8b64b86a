// Surfaces to carve: shapes made by formula, or meshes from files.
#ifndef JALI_SURFACE_H
#define JALI_SURFACE_H

#include <jali/bytes.h>
#include <jali/mesh.h>
#include <jali/model.h>

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
    bool textured;      // uv is the texture of a file: cut into pieces, its lengths true on the whole alone
    bool *faulty; // [mesh.triangle_count] no picture may lie there; NULL: there is no such triangle. Move
                  // a report's here
} jali_surface;

JALI_API void jali_surface_free(jali_context *ctx, jali_surface *surface);

typedef struct jali_surface_options {
    double tolerance_mm; // of shapes: how far a curve may lie from its facets, along and around each, 0.0005
                         // .. 10; default 0.02
    double unit_mm;      // of files: what a length of 1 in the file means; default 1. A 3MF has its own unit
    double height_mm;    // of files: scale to this height instead; 0 (default) = do not
    double turn_degrees; // of files: turn about the vertical, from the front to the right; default 0
    bool untextured;     // of files: leave the texture of an OBJ, so that --place wrap lays the surface flat
    int32_t up; // of files: which axis points up: 1, 2, 3 for x, y, z, negative for downwards; default 3
    jali_model_options model; // of files: limits
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
///                          exactly: the front's line upright, its base at (0, 0)
///   sphere:r=              closed; u = angle * r, v = arc length from the lowest point
///   vase:NAME,h=,r=        turned from a smooth profile; h and r (largest radius) scale it, one alone scales
///                          both; u = angle * (largest radius), v = arc length from the base
///   vase:profile=FILE,..   from a file of "radius height" pairs in mm, one a line, # begins a comment; a
///                          pair given twice is a corner
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
///          file), JALI_LIMIT, JALI_NO_MEMORY, JALI_CANCELLED
///   cost   O(triangles + rows^2)
JALI_API jali_status jali_surface_make(jali_context *ctx, const char *description,
                                       const jali_surface_options *opt, jali_surface *surface);

/// What was wrong with a mesh from a file. {0} is valid and empty; the one of a shape is empty.
typedef struct jali_surface_report {
    int32_t file_vertices, file_triangles; // as they were read
    int32_t vertices, triangles, shells;   // as they are now
    // Put right:
    int32_t welded_vertices;           // at the place of an earlier one
    jali_finding degenerate_triangles; // without area: dropped
    jali_finding repeated_triangles;   // the three vertices of an earlier one, either way round: dropped
    jali_finding turned_triangles;     // turned over, to agree with their neighbours and face outwards
    jali_finding merged;               // pairs of triangles that met where parts cross: those are one now
    // Left as it is:
    jali_finding open_edges;        // in one triangle only: rims, holes, cracks
    jali_finding crowded_edges;     // in three triangles or more
    jali_finding crowded_vertices;  // where more than one fan of triangles meets
    jali_finding misdirected_edges; // no way to turn triangles makes these agree (as on a Moebius strip)
    jali_finding intersections;     // pairs of triangles that meet outside the vertex or edge they share
    bool intersections_capped;      // there are more than that
    int64_t faulty_triangles;
    bool *faulty; // [triangles], touches a crowded edge or vertex or a misdirected edge, meets another
                  // triangle, or lies along a line where parts that crossed were made one
} jali_surface_report;

JALI_API void jali_surface_report_free(jali_context *ctx, jali_surface_report *report);

/// The report in plain sentences, a line each; appended.
JALI_API jali_status jali_surface_sentences(jali_context *ctx, const jali_surface_report *report,
                                            jali_bytes *text);

/// Read a surface from a model file and mend what needs no guessing. What is wrong beyond that is reported,
/// not refused.
///
/// The model is scaled and turned, its lowest point put on z = 0 and the middle of its box on the axis,
/// rounded to the lattice of jali_surface_make, welded. With up = 2 the file's z becomes the front, with up =
/// 3 its -y is. Triangles without area and second copies are dropped; neighbours are made to agree, shells to
/// face outwards: closed ones by how many others enclose them (an odd number: a void), open ones by their
/// volume as seen from the middle of their rim. Flat sheets stay as they are. The texture points of an OBJ
/// become uv when every corner has one, scaled so that the areas of both are the same on the whole; around_mm
/// is 0.
///   in     path     the file, "-" is stdin
///          opt      NULL means the defaults
///   out    surface  free with jali_surface_free
///          report   NULL is accepted; free with jali_surface_report_free
///   fails  what jali_read_model says; JALI_BAD_VALUE (an option, or more than 10 m), JALI_BAD_INPUT (no
///          triangle has an area)
///   cost   that of jali_check
JALI_API jali_status jali_surface_read(jali_context *ctx, const char *path, const jali_surface_options *opt,
                                       jali_surface *surface, jali_surface_report *report);

/// A surface as the command line describes it: a shape that jali_surface_make knows, or else a file, FILE or
/// FILE:key=value,...: up=x|y|z|-x|-y|-z, unit=mm|cm|m|in, scale=FACTOR (on the unit), height=MM,
/// turn=DEGREES, texture=yes|no.
JALI_API jali_status jali_surface_open(jali_context *ctx, const char *description,
                                       const jali_surface_options *opt, jali_surface *surface,
                                       jali_surface_report *report);

#ifdef __cplusplus
}
#endif
#endif
