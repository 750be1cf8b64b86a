// From lines on a chart's lattice to triangles, and from refined triangles to a sheet. Internal.
#ifndef SHEET_ARRANGE_H
#define SHEET_ARRANGE_H

#include "plane/refine.h"
#include <jali/sheet.h>

/// A line between two places of a chart. Kinds as in triangulation.h.
typedef struct line {
    int32_t from, to; // points
    uint8_t kind;
} line;

/// Lines under construction, on a lattice `scale` times finer than the chart's, so that small triangles keep
/// their shape. {0} with a scale is ready.
typedef struct drawing {
    int32_t scale, point_count, line_count;
    double closest; // points of a polygon nearer than that to the one before are dropped; units of the chart
    int32_t (*point)[2]; // finer units
    line *line;
    size_t point_capacity, line_capacity;
} drawing;

void drawing_free(jali_context *ctx, drawing *d);

/// The largest power of two by which coordinates up to `most` may be multiplied.
int32_t finest_scale(int32_t most);

/// Add a closed polygon; coordinates of the chart.
jali_status add_polygon(jali_context *ctx, drawing *d, const int32_t (*point)[2], int32_t count,
                        uint8_t kind);

/// The constrained triangulation of a drawing. Points keep their numbers, unless lines may cross.
///   in     crossing   so many lines, from the first, may cross each other and all others; those after them
///   must
///                     not meet. They are bent by less than a finer unit
///   out    home       [point_count] where each point of the drawing is
///   fails  JALI_BAD_INPUT (lines meet that must not: where in mm), JALI_LIMIT, JALI_CANCELLED,
///   JALI_NO_MEMORY
jali_status triangulate_drawing(jali_context *ctx, const drawing *d, int32_t crossing, double unit_mm,
                                triangulation *plane, int32_t *home);

/// label_tones, checked: lines that lie on each other leave no tone that changes at each of them.
///   in     unit_mm   of the plane
///   fails  JALI_BAD_INPUT (where in mm), JALI_NO_MEMORY
jali_status label_lines(jali_context *ctx, const triangulation *plane, uint8_t kinds, double unit_mm,
                        uint8_t *tone);

/// The picture's rectangle, units of the chart.
typedef struct picture_window {
    int32_t low[2], high[2];
} picture_window;

picture_window window_of(const jali_chart *chart);
jali_status draw_window(jali_context *ctx, drawing *d, const picture_window *w);

jali_status check_sheet_options(jali_context *ctx, const jali_sheet_options *opt);

/// The sizes of elements, in the refinement's lengths; sets what is `least` there.
typedef struct sheet_lengths {
    double finest, coarsest;
} sheet_lengths;

extern const double SHEET_GROWTH; // of the size over a length
extern const double SHEET_LEAST;  // distance of nodes as a share of the finest size

void set_lengths(refinement *r, const jali_sheet_options *opt, double extent_mm, double unit_mm,
                 sheet_lengths *length);

/// What `gather_sheet` asks about each point it makes a node of.
typedef struct node_source {
    void (*locate)(void *shared, int32_t point, double node[3], double *thickness_mm);
    uint8_t (*border)(void *shared, uint8_t kind, int32_t point); // bits of a border edge's kind at a point
    void *shared;
} node_source;

/// The triangles that were refined, as a sheet. Where parts meet in a point alone, each has a node of its
/// own.
jali_status gather_sheet(jali_context *ctx, const refinement *r, int32_t scale, const node_source *source,
                         jali_sheet *sheet);

/// Number the nodes along a Morton curve, and the triangles by it.
jali_status number_along_curve(jali_context *ctx, jali_sheet *sheet);

#endif
