// A shell: the wall between the outer skin of an object and its inner skin. Pictures are pierced through it.
#ifndef JALI_SHELL_H
#define JALI_SHELL_H

#include <jali/chart.h>
#include <jali/contours.h>
#include <jali/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The wall over the triangles of `outer`: each vertex has its place on the inner skin, and what lies between
/// is linear. {0} is valid and empty.
typedef struct jali_shell {
    jali_surface outer;
    double (*inner)[3]; // [outer.mesh.vertex_count] mm
    float (*solid)[2];  // [outer.mesh.triangle_count] the part of the wall that is solid, from 0 = inner skin
                        // to 1 = outer skin; NULL: all of it everywhere
    double unit_mm;     // a power of two; every coordinate is a multiple that float32 holds
} jali_shell;

JALI_API void jali_shell_free(jali_context *ctx, jali_shell *shell);

typedef struct jali_shell_options {
    double thickness_mm; // of the wall; 2 (default), > 0
    double least_mm; // where the wall must be thinner, because it would fold or meet itself, at least this;
                     // 0.3 (default), below it the wall is left full. Only over dents and spikes finer than
                     // the wall may it be thinner, in a point: the report's thinnest_mm says so
} jali_shell_options;

JALI_API jali_shell_options jali_shell_defaults(void);

/// How thick the wall came out.
typedef struct jali_shell_report {
    double thinnest_mm; // as thickness_mm where nothing is in the way
    double thinnest_at_mm[3];
    int32_t vertices;       // of the surface
    int32_t thinned;        // vertices with less than the thickness
    int32_t full_triangles; // of the surface, over which the wall is left full because none would do: no
                            // picture may lie there
    double full_at_mm[3];   // one of them
} jali_shell_report;

/// Hollow out a surface: give it an inner skin at the wall's thickness along the normals. Where that would
/// fold or meet a skin, the wall is thinner; where the least would too, it is left full.
///   inout  surface   moves into the shell (empty afterwards); its vertices are rounded to the shell's
///                    lattice
///          opt       NULL means the defaults
///   out    shell     neither skin meets itself or the other
///          report    may be NULL
///   fails  JALI_BAD_VALUE, JALI_NO_RESULT (neither the least wall nor a full one will do: where is in the
///          message), JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
JALI_API jali_status jali_shell_create(jali_context *ctx, jali_surface *surface,
                                       const jali_shell_options *opt, jali_shell *shell,
                                       jali_shell_report *report);

/// Which triangles of the outer skin a chart covers, and where on its lattice they lie. {0} is valid and
/// empty.
typedef struct jali_patch {
    int32_t point_count;
    int32_t (*point)[2]; // [point_count] lattice units of the chart
    int32_t *vertex;     // [point_count] of the outer skin; on both sides of a seam the same
    double *weight;      // [point_count] 1 / depth in a perspective; NULL: the map is affine on each face
    int32_t face_count;
    int32_t *face;        // [face_count] triangles of the outer skin
    int32_t (*corner)[3]; // [face_count] their corners as points, counter-clockwise on the lattice
} jali_patch;

JALI_API void jali_patch_free(jali_context *ctx, jali_patch *patch);

/// Pierce a picture through a shell: its void is taken out of the wall. Contours and the edges of the surface
/// become one exact arrangement; each of its cells lies on one triangle of the outer skin, which keeps its
/// place.
///   in     picture   contours on the chart's lattice: voids in a solid surrounding, whole inside the patch
///          backing   share of the thickness, from the inner skin, that stays solid in the voids; 0 = none
///   inout  shell     unchanged when it fails
///   fails  JALI_NO_RESULT (a void reaches beyond the patch, or the patch covers a place of the chart twice:
///          where is in the message), JALI_LIMIT, JALI_CANCELLED,
///          JALI_NO_MEMORY
///   cost   O(n log n) in points of the contours and of the patch
JALI_API jali_status jali_pierce(jali_context *ctx, const jali_contours *picture, const jali_patch *patch,
                                 double backing, jali_shell *shell);

/// The same with regions in which the wall that stays reaches from the inner skin to a share of the thickness
/// alone.
///   in     low   closed contours of the regions on the same lattice, which may cross the picture's, or NULL
JALI_API jali_status jali_pierce_stepped(jali_context *ctx, const jali_contours *picture,
                                         const jali_contours *low, double low_share, const jali_patch *patch,
                                         double backing, jali_shell *shell);

/// The solid of a shell: outer skin, inner skin, and walls along every border.
///   out    mesh    closed, 2-manifold at edges and vertices, outward when inner lies inside
///   fails  JALI_BAD_INPUT (edges or vertices shared by more than two triangles or one fan; parts that would
///          meet in an edge or a point: where is in the message), JALI_LIMIT, JALI_NO_MEMORY
JALI_API jali_status jali_shell_solid(jali_context *ctx, const jali_shell *shell, jali_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
