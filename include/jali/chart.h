// A chart: where the working pixels lie on the surface, and how long a pixel is there.
#ifndef JALI_CHART_H
#define JALI_CHART_H

#include <jali/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The working grid and its place on the surface.
///
/// Plane geometry lives on an integer lattice of unit_mm. A pixel is pixel_units wide, an even number, so
/// that pixel centres are lattice points too. On plates unit_mm is a power of two and every coordinate is
/// below 2^24 units: float32 (STL) holds each lattice point exactly (docs/decisions/0001-dyadic-lattice.md).
///
/// Lattice: the origin is the lower left corner of the bitmap (margin included), x right, y up. Pixel (x, y)
/// of the bitmap (y down) has its centre at ((2x + 1) pixel_units / 2, (2 (height_px - y) - 1) pixel_units /
/// 2).
typedef struct jali_chart {
    int32_t width_px, height_px; // working grid, margin included
    int32_t margin_px;           // pixels on each side that are not picture
    bool outside_solid;          // what lies beyond the grid: solid (a frame, a surface) or nothing
    int32_t pixel_units;         // even, >= 16
    double unit_mm;              // length of a lattice unit
    // The metric of a curved surface; NULL: flat, the identity everywhere. Knot (i, j) stands in row j of the
    // array and holds (g11, g12, g22) at the centre of the square of metric_step_px px whose upper left
    // corner is pixel (i step, j step), y down; margin included, and beyond the last knot the last one holds.
    // Between knots it is interpolated. A step of (dx, dy) pixels is sqrt(g11 dx^2 + 2 g12 dx dy + g22 dy^2)
    // flat pixels (jali_chart_pixel_mm) long on the surface. Between two knots lengths should change by less
    // than 20 %.
    float (*metric)[3]; // [metric_rows * metric_columns]
    int32_t metric_columns, metric_rows, metric_step_px;
} jali_chart;

JALI_API void jali_chart_free(jali_context *ctx, jali_chart *chart);

static inline double jali_chart_pixel_mm(const jali_chart *chart)
{
    return chart->pixel_units * chart->unit_mm;
}

#ifdef __cplusplus
}
#endif
#endif
