// Elements that vary over the picture: on a curved surface a disc in mm is another ellipse at each place.
// Internal.
//
// A picture is cut into square tiles; a tile has one metric, a metric one patch. A flat picture has a
// single element for the whole of it and goes the way of raster/morphology.c.
#ifndef RASTER_FIELD_H
#define RASTER_FIELD_H

#include "raster/raster.h"
#include <jali/chart.h>

// --- Patches (patch.c)

/// The pixels an element covers when it is set on pixel (0, 0): row top + k, columns span[k][0] ..
/// span[k][1], last one included. Rows need be neither symmetric nor nested.
typedef struct patch {
    int32_t size; // the disc's diameter here: the whole number of px nearest to the mean of its two diameters
    int32_t top, rows;
    int32_t (*span)[2]; // [rows]
} patch;

/// An ellipse about the centre: the points v with v^T inverse(shape) v <= 1, shape = (xx, xy, yy).
typedef struct ellipse {
    double shape[3];
} ellipse;

/// What a disc of that diameter on the surface is in the picture, with `more_px` added on all sides after
/// that.
ellipse ellipse_of_disc(const double metric[3], double diameter_px, double more_px);

/// The element as a patch.
jali_status patch_of_element(jali_context *ctx, const element *e, patch *p);
/// All pixels whose centre lies in the ellipse, as many columns and rows as fit into it whole (at least one);
/// in flat places that is element_disc. An odd patch has its centre on a pixel, else each axis where it fits
/// best.
jali_status patch_within(jali_context *ctx, const ellipse *e, bool odd, patch *p);
/// Every pixel that the ellipse touches; in flat places that is element_wide_disc.
jali_status patch_around(jali_context *ctx, const ellipse *e, patch *p);
/// The Minkowski sum: painting with it is painting with `a`, then with `b`.
jali_status patch_sum(jali_context *ctx, const patch *a, const patch *b, patch *sum);
/// Whether a bar that the patch paints is, in every direction, at least as wide as one that the ellipse
/// paints (tried in 32 directions, to a thousandth).
bool patch_as_wide(const patch *p, const ellipse *e);
void patch_free(jali_context *ctx, patch *p);

void paint_patch(jali_bitmap *dst, int32_t x, int32_t y, const patch *brush, bool white);
/// Paint it white; returns how many of its pixels were black.
int32_t cover_patch(jali_bitmap *dst, int32_t x, int32_t y, const patch *brush);
/// How many pixels of a tone lie under the patch set on (x, y); none beyond the bitmap's border.
int32_t count_patch(const jali_bitmap *a, int32_t x, int32_t y, const patch *p, bool white);

// --- Tiles (tiling.c)

/// Which metric holds where. {0} is flat: one kind, no tiles.
typedef struct tiling {
    int32_t width_px, height_px, tile_px, columns, rows;
    uint16_t *kind; // [rows * columns]
    int32_t kinds;
    double (*metric)[3]; // [kinds], (g11, g12, g22)
    double *slack;       // [kinds], the logarithm of how far lengths in the tiles differ from it at most
    double most_stretch; // of any direction at any tile, >= 1
} tiling;

/// Tiles for a bitmap that shows the chart's grid shifted and scaled: its pixel (x, y) lies over the chart's
/// pixel
/// ((x + 0.5 - left_px) / scale, (y + 0.5 - top_px) / scale).
///   in     chart   NULL or without a metric: flat
///   fails  JALI_NO_MEMORY, JALI_BAD_VALUE (a metric that is not positive definite, or stretches over 1000
///   times)
jali_status tiling_create(jali_context *ctx, const jali_chart *chart, int32_t width_px, int32_t height_px,
                          double left_px, double top_px, double scale, tiling *t);
/// The largest stretch at the chart's knots, at least 1.
double most_stretch_of(const jali_chart *chart);
void tiling_free(jali_context *ctx, tiling *t);
bool is_flat(const tiling *t);
/// The metric at a pixel; the identity where flat.
const double *metric_at(const tiling *t, int32_t x, int32_t y);

// --- Fields (field.c)

typedef struct field {
    const tiling *tiles; // not owned
    element whole;       // of a flat field
    patch *patch;        // [patches], all different; flat: patch[0] is `whole`
    int32_t patches;
    uint16_t *which;                   // [tiles->kinds], the patch of a kind; NULL when flat
    int32_t left, right, above, below; // how far any patch reaches beyond its pixel, >= 0
    int32_t least, most;               // of the patches' sizes
    bool own_pixel;                    // every patch holds the pixel it is set on
    struct field_memory *memory;       // of the last operations, or NULL
} field;

/// Let a field keep source and result of its last erosion and dilation of either tone: the next one of a
/// picture that differs little looks at the differences alone. Same results; up to 8 bitmaps of memory.
jali_status field_remember(jali_context *ctx, field *f);
void field_memory_free(jali_context *ctx, struct field_memory *m);

/// A flat field; takes the element over.
jali_status field_of_element(jali_context *ctx, element *e, field *f);
/// A field from one patch a kind; takes those patches over that it keeps, equal ones become one.
///   in,out each   [tiles->kinds]
jali_status field_of_patches(jali_context *ctx, const tiling *tiles, patch *each, field *f);
/// Discs of a diameter on the surface, more_px wider on all sides: patch_within of each kind. Flat:
/// element_disc of diameter_px + 2 more_px.
///   in     odd      each has its centre on a pixel
///          safely   smaller by the kind's slack: nowhere in its tiles is a disc larger than asked for
jali_status field_of_discs(jali_context *ctx, const tiling *tiles, double diameter_px, double more_px,
                           bool odd, bool safely, field *f);
void field_free(jali_context *ctx, field *f);
/// The patch that is set on pixel (x, y); beyond the bitmap the nearest tile's.
const patch *patch_at(const field *f, int32_t x, int32_t y);
/// The patch of a tile, by its number in the tiling.
static inline const patch *patch_of_tile(const field *f, int64_t tile)
{
    return &f->patch[f->which ? f->which[f->tiles->kind[tile]] : 0];
}

/// Paint at each pixel of the walk from one pixel to another (raster.h) the patch of that place.
void paint_stroke(jali_bitmap *dst, const int32_t from[2], const int32_t to[2], const field *brush,
                  bool white);

// --- Morphology by fields (vary.c). Flat ones give what raster.h's operators give, at their speed.

/// dst = the pixels on which their own place's patch fits into src.   fails  JALI_NO_MEMORY
jali_status field_erode(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                        jali_bitmap *dst);
/// dst = the union of the patches set on the white pixels, each that of its own place. So dilating an erosion
/// paints exactly the patches that fit: an opening, idempotent although its element varies.
jali_status field_dilate(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                         jali_bitmap *dst);
jali_status field_open(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                       jali_bitmap *scratch, jali_bitmap *dst);
/// The opening of the complement.
jali_status field_close(jali_context *ctx, const jali_bitmap *src, const field *f, bool outside,
                        jali_bitmap *scratch, jali_bitmap *dst);

#endif
