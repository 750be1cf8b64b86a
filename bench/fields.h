// Two fields on two meshes of one plate, compared at the same places.
#ifndef BENCH_FIELDS_H
#define BENCH_FIELDS_H

#include <jali/sheet.h>

/// A field read at other places. free() what is inside with reader_free.
typedef struct reader {
    const jali_sheet *sheet;
    int32_t columns, rows, *first, *triangle;
    double low[2], cell;
} reader;

reader reader_of(const jali_sheet *sheet);
void reader_free(reader *r);
/// A field of the sheet's nodes at (x, y), linear in each triangle; outside, that of the nearest triangle
/// around. NAN when there is none.
double read_at(const reader *r, const float *value, int32_t stride, double x, double y);

/// Nodes where stresses are compared: further than `clamp_mm` from clamped nodes, and than `corner_mm` from
/// corners of the contour, which are where it turns into the solid by more than 60 degrees within `bend_mm`.
///   out    far   [node_count]
void far_from_corners(const jali_sheet *sheet, uint8_t held, double bend_mm, double corner_mm,
                      double clamp_mm, bool *far);

/// Means of a field of the nodes over discs around them, as jali_analyse takes them.
jali_status disc_means(jali_context *ctx, const jali_sheet *sheet, const float *value, int32_t stride,
                       double diameter_mm, float *mean);

typedef struct agreement {
    int32_t points;
    double median, p95; // ours over theirs: the median of ratios where theirs is large; of 95th percentiles
    double rms;         // of the differences, over that of theirs
    double within5, within10; // share of the points where theirs is large
} agreement;

/// Theirs is large where it is at least half of its 95th percentile.
agreement compare_fields(int32_t count, const double *ours, const double *theirs);

#endif
