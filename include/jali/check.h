// Check: is a mesh a solid? Closed, manifold, outward, free of self-intersections; and what it measures.
#ifndef JALI_CHECK_H
#define JALI_CHECK_H

#include <jali/bytes.h>
#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_check_options {
    bool skip_intersections; // leave out the one costly test; then `solid` says nothing of it. Default false
    bool walls; // measure walls and gaps as well, of a mesh that is closed and outward. Default false
} jali_check_options;

JALI_API jali_check_options jali_check_defaults(void);

/// How thick the walls are, or how wide the gaps, as balls that fit between two sides that face each other
/// within 20 degrees (docs/check.md).
typedef struct jali_thickness {
    bool measured;      // false: nobody looked, or the mesh has no inside; then the rest is 0
    double thinnest_mm; // smallest reading; INFINITY: there is none (of gaps: none below 10 mm)
    double at_mm[3];    // its place, in the middle of the wall or gap; 0 when there is none
    double
        percentile1_mm; // 1 % of the area that has a reading has none above this; INFINITY when there is none
} jali_thickness;

/// Vertices at exactly the same place count as one, so a triangle soup is judged by its geometry.
typedef struct jali_check_report {
    bool closed;   // no open edge
    bool manifold; // no crowded edge, no crowded vertex, no repeated triangle
    bool oriented; // no misdirected edge, no misplaced shell
    bool clean;    // no degenerate triangle
    bool apart;    // no self-intersection
    bool solid;    // all five, and not empty: it encloses a volume, everywhere once

    int32_t vertices, triangles, edges; // as given; edges after welding
    int32_t repeated_vertices;          // at the place of an earlier one (no flaw)
    int32_t pieces;                     // bodies: shells that are not voids
    int32_t shells;                     // surfaces connected through edges
    int32_t voids;                      // shells that rightly face inwards, inside a body
    int64_t euler;                      // vertices - edges + triangles, after welding
    int64_t genus;                      // handles of all shells together; -1 unless closed and manifold

    jali_finding open_edges;           // edges in one triangle only
    jali_finding crowded_edges;        // edges in three triangles or more
    jali_finding crowded_vertices;     // vertices where more than one fan of triangles meets
    jali_finding misdirected_edges;    // edges that both triangles run in the same direction
    jali_finding misplaced_shells;     // closed shells inside out, or facing outwards within solid
    jali_finding degenerate_triangles; // on a line or a point: no area
    jali_finding repeated_triangles;   // the three vertices of another triangle
    jali_finding intersections;        // pairs that meet outside the vertex or edge they share
    bool intersections_capped;         // there are more than that
    bool intersections_skipped;        // nobody looked

    double volume_mm3; // signed; of a mesh that is not closed it means little
    double area_mm2;
    double low_mm[3], high_mm[3]; // bounding box
    jali_thickness walls, gaps;
    int32_t unit_log2;      // the tests ran on whole multiples of 2^unit_log2 mm,
    bool coordinates_exact; // which hold every coordinate exactly (else: rounded to 60 bits)
} jali_check_report;

/// Check a mesh. What is wrong with it is in the report, not in the status.
///   in     opt     NULL means the defaults
///   out    report  all of it, whatever is found
///   fails  JALI_BAD_INPUT (a coordinate that is not finite, an index out of range), JALI_NO_MEMORY,
///          JALI_LIMIT, JALI_CANCELLED
///   cost   O(triangles + pairs whose boxes touch); no tolerance anywhere: every decision is exact
JALI_API jali_status jali_check(jali_context *ctx, const jali_mesh *mesh, const jali_check_options *opt,
                                jali_check_report *report);

/// The report in plain sentences, a line each, for people.
///   out    text  appended to
JALI_API jali_status jali_check_sentences(jali_context *ctx, const jali_check_report *report,
                                          jali_bytes *text);

/// The report as one JSON object (version 1), for programs; appended, without a line end.
///   version            1
///   closed, manifold, oriented, clean, apart, solid                               booleans
///   vertices, triangles, edges, repeated_vertices, pieces, shells, voids, euler   whole numbers
///   genus              whole number, null unless closed and manifold
///   open_edges, crowded_edges, crowded_vertices, misdirected_edges, misplaced_shells, degenerate_triangles,
///   repeated_triangles, self_intersections
///                      {"count": n, "first_mm": [x, y, z] or null, "at_least": true where counting stopped};
///                      self_intersections is null when the test was left out
///   volume_mm3, area_mm2   numbers
///   bounds_mm          {"low": [x, y, z], "high": [x, y, z]}
///   walls, gaps        {"thinnest_mm", "at_mm": [x, y, z], "percentile1_mm"}, numbers or null where there is
///   none;
///                      null when they were not measured
///   unit_mm            the lattice of the exact tests
///   coordinates_exact  boolean
JALI_API jali_status jali_check_json(jali_context *ctx, const jali_check_report *report, jali_bytes *json);

/// Read a written STL or 3MF back and compare it with the mesh it was made from.
///   in     data   the file, whole
///   fails  JALI_BROKEN when a triangle is gone, joins other vertices (two that fell on one place in float32,
///          too) or has moved in float32; what jali_read_model_bytes says
JALI_API jali_status jali_check_readback(jali_context *ctx, const void *data, size_t size,
                                         const jali_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
