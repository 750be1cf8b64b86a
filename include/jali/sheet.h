// The sheet: the middle of a pierced wall as triangles fit for finite elements.
#ifndef JALI_SHEET_H
#define JALI_SHEET_H

#include <jali/chart.h>
#include <jali/contours.h>
#include <jali/shell.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Where a node of a sheet lies, a bit each. The outline of a picture that ends in void is a rim and a
/// contour, and on the picture's boundary within half a pixel of it.
enum {
    JALI_BORDER_VOID = 1,    // on a contour of the picture or the hanging hole: material on one side only
    JALI_BORDER_PICTURE = 2, // on the picture's boundary, where the paper holds the model
    JALI_BORDER_RIM = 4      // on the outline of a plate, or on an open border of a surface
};

/// {0} is valid and empty. Triangles are counter-clockwise seen from the outer side (a plate's top) and form
/// one surface or several, 2-manifold with borders.
typedef struct jali_sheet {
    int32_t node_count, triangle_count;
    double (*node)[3];      // [node_count] mm, halfway between the skins
    double *thickness_mm;   // [node_count] from skin to skin
    int32_t (*triangle)[3]; // [triangle_count]
    uint8_t *border;        // [node_count] JALI_BORDER_..., 0 inside
    int32_t (*at)[2];       // [node_count] place on the chart, lattice units; INT32_MIN off the chart
    bool flat;              // z is the same everywhere: a plate
} jali_sheet;

JALI_API void jali_sheet_free(jali_context *ctx, jali_sheet *sheet);

typedef struct jali_sheet_options {
    double phi_s_mm; // narrowest solid feature, > 0 (0.3)
    int32_t across;  // elements across that feature, 1 .. 16; 4 (default), 2 for previews
    bool whole;      // the frame of a plate, the rest of a surface too; false (default) = the picture alone
} jali_sheet_options;

JALI_API jali_sheet_options jali_sheet_defaults(void);

/// The sheet of a plate, at z = half its thickness. Clipped to the picture it may fall into pieces: all stay.
/// Points of contours nearer than phi_s / across / 8 to the one before are dropped.
///   in     plate     contours from jali_plate (outline, holes, picture)
///          opt       NULL means the defaults
///   out    sheet     free with jali_sheet_free; coordinates as in jali_carve's mesh
///   fails  JALI_BAD_VALUE, JALI_BAD_INPUT (contours that meet), JALI_NO_RESULT (nothing solid in the
///   picture),
///          JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
///   cost   O(n log n)
JALI_API jali_status jali_sheet_plate(jali_context *ctx, const jali_contours *plate, const jali_chart *chart,
                                      double thickness_mm, const jali_sheet_options *opt, jali_sheet *sheet);

/// The sheet of a plate that is given as a mesh: what lies between two planes z = low and high, its walls
/// square to them. All of it.
///   in     opt            NULL means the defaults; `whole` plays no part
///   out    chart          a grid over it, for maps; its origin is the mesh's lower left corner
///          thickness_mm   high - low
///          sheet          free with jali_sheet_free
///   fails  as jali_sheet_plate, and JALI_NO_RESULT (the mesh is no such plate), JALI_BAD_INPUT (its outline
///   is
///          open or meets itself: where)
JALI_API jali_status jali_sheet_plate_model(jali_context *ctx, const jali_mesh *mesh,
                                            const jali_sheet_options *opt, jali_chart *chart,
                                            double *thickness_mm, jali_sheet *sheet);

/// The sheet of a picture on a surface, halfway between the skins. Creases of the surface are cut; walls less
/// than half solid are left out. With `whole` the other triangles of the surface are joined to it node by
/// node.
///   in     picture   as for jali_pierce
///          shell     before this picture is pierced
///          opt       NULL means the defaults
///   out    sheet     free with jali_sheet_free
///   fails  as jali_sheet_plate, and JALI_NO_RESULT (the picture reaches beyond the surface: where)
JALI_API jali_status jali_sheet_shell(jali_context *ctx, const jali_contours *picture,
                                      const jali_chart *chart, const jali_patch *patch,
                                      const jali_shell *shell, const jali_sheet_options *opt,
                                      jali_sheet *sheet);

#ifdef __cplusplus
}
#endif
#endif
