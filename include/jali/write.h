// Write: models, outlines and pictures as files of the usual formats.
#ifndef JALI_WRITE_H
#define JALI_WRITE_H

#include <jali/bitmap.h>
#include <jali/bytes.h>
#include <jali/contours.h>
#include <jali/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_format {
    JALI_FORMAT_BY_SUFFIX = 0,
    JALI_FORMAT_3MF, // solid: the mesh with unit, title, parameters, a small picture
    JALI_FORMAT_STL, // solid: binary, float32, no unit
    JALI_FORMAT_SVG, // flat: the contours
    JALI_FORMAT_DXF, // flat: the contours
    JALI_FORMAT_PNG  // the bitmap
} jali_format;

/// What there is to write; a format takes what it needs, the rest may be NULL.
typedef struct jali_product {
    const jali_mesh *mesh;         // STL, 3MF
    const jali_contours *contours; // SVG, DXF
    double width_mm,
        height_mm; // of the sheet the contours lie on, from their origin; 0 (default): their extent
    const jali_bitmap *bitmap; // PNG
    double pixel_mm;           // 0 (default): not known, no physical size in the PNG
} jali_product;

typedef struct jali_write_options {
    jali_format format;     // default: by the suffix of the path
    const char *title;      // 3MF, SVG; UTF-8; NULL (default): none
    const char *parameters; // 3MF, as its Description; UTF-8; NULL (default): none
    bool no_thumbnail;      // leave the small picture out of a 3MF; default false
} jali_write_options;

JALI_API jali_write_options jali_write_defaults(void);

/// The format a path's suffix asks for (any case), JALI_FORMAT_BY_SUFFIX when it is none of them.
JALI_API jali_format jali_format_of(const char *path);

/// Write a file. It appears complete under its name or not at all; an earlier file stays until then.
///   in     path  "-" is stdout and then needs opt->format
///          opt   NULL means the defaults
///   fails  JALI_BAD_VALUE (no format, or the product lacks what it needs), JALI_IO, JALI_NO_MEMORY,
///          JALI_LIMIT, JALI_CANCELLED
///   cost   see the format
JALI_API jali_status jali_write(jali_context *ctx, const char *path, const jali_product *product,
                                const jali_write_options *opt);

/// The same into memory: the bytes of the file, appended. Same input, same bytes, for any number of threads.
JALI_API jali_status jali_write_bytes(jali_context *ctx, jali_format format, const jali_product *product,
                                      const jali_write_options *opt, jali_bytes *bytes);

/// Binary STL. Coordinates are rounded to float32.
JALI_API jali_status jali_write_stl(jali_context *ctx, const jali_mesh *mesh, jali_bytes *bytes);

/// 3MF: one object in millimetres. Coordinates that are float32 values are written to be read as such
/// (slicers and jali_read_model do), others as doubles.
///   cost   O(triangles): about 0.3 s and 100 bytes of memory each for a million
JALI_API jali_status jali_write_3mf(jali_context *ctx, const jali_mesh *mesh, const jali_write_options *opt,
                                    jali_bytes *bytes);

/// SVG: one path, filled by the even-odd rule, in whole lattice units; the sheet's size in mm, y down.
JALI_API jali_status jali_write_svg(jali_context *ctx, const jali_contours *contours, double width_mm,
                                    double height_mm, const jali_write_options *opt, jali_bytes *bytes);

/// DXF (R12): a closed polyline a contour in mm, on the layers OUTLINE (around solid) and HOLES.
JALI_API jali_status jali_write_dxf(jali_context *ctx, const jali_contours *contours, jali_bytes *bytes);

#ifdef __cplusplus
}
#endif
#endif
