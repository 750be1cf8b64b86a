// Maps: what a sheet bears and how far it moves, as pictures and for other programs.
#ifndef JALI_MAP_H
#define JALI_MAP_H

#include <jali/analyse.h>
#include <jali/bytes.h>
#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What to show of an analysis.
typedef enum jali_quantity {
    JALI_STRESS,      // mean von Mises, MPa
    JALI_DISPLACEMENT // length, mm
} jali_quantity;

typedef struct jali_map_options {
    jali_quantity quantity;
    double limit;      // values above it are red; 0 (default) = none is
    double top;        // end of the scale; 0 (default) = the largest value, or the limit when that is larger
    int32_t longer_px; // of the picture's longer side, 64 .. 8192; default 1200
} jali_map_options;

JALI_API jali_map_options jali_map_defaults(void);

/// The value at a node.
JALI_API double jali_map_value(const jali_analysis *analysis, jali_quantity quantity, int32_t node);

/// The colour of a value: from dark violet over green to yellow at the limit (or at the top), red beyond.
JALI_API void jali_map_colour(double value, double limit, double top, uint8_t rgb[3]);

/// A map on the picture as a PNG, with a legend; appended. Nodes off the chart are not shown.
///   in     opt   NULL means the defaults
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_map_png(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *analysis,
                                  const jali_chart *chart, const jali_map_options *opt, jali_bytes *png);

/// The sheet as a solid of its thickness, moved by `exaggeration` times its displacement, and the colour of
/// each of its vertices: for a render.
///   out    mesh     free with jali_mesh_free
///          colour   [mesh->vertex_count][3], from the context's allocator; jali_map_release gives it back
JALI_API jali_status jali_map_solid(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *analysis,
                                    const jali_map_options *opt, double exaggeration, jali_mesh *mesh,
                                    uint8_t (**colour)[3]);
JALI_API void jali_map_release(jali_context *ctx, uint8_t (*colour)[3]);

/// PLY, binary, little endian: the sheet's triangles; vertices with colour, stress_mpa and displacement_mm.
JALI_API jali_status jali_map_ply(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *analysis,
                                  const jali_map_options *opt, jali_bytes *ply);

/// VTU for ParaView, raw appended data: displacement, rotation, von Mises at both faces and in the middle,
/// principal stresses, the mean, the thickness.
JALI_API jali_status jali_map_vtu(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *analysis,
                                  jali_bytes *vtu);

#ifdef __cplusplus
}
#endif
#endif
