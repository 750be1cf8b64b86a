// The curve that a surface of revolution is turned from, and the rows that stand for it.
#ifndef MESH_PROFILE_H
#define MESH_PROFILE_H

#include "base/base.h"

/// A dense polyline from the base to the top. {0} is valid and empty.
typedef struct profile {
    int32_t point_count;
    struct profile_point {
        double radius_mm, height_mm;
        double along_mm; // arc length from the base
        bool corner;     // the curve bends here and a row must stand here; both ends are
    } * point;           // [point_count]
} profile;

typedef struct profile_point profile_point;

void profile_free(jali_context *ctx, profile *p);

/// Measure along_mm again, after points were moved, and make both ends corners.
void profile_measure(profile *p);

/// A straight line, or half a circle from its lowest point to its highest.
jali_status profile_line(jali_context *ctx, double base_mm, double top_mm, double height_mm, profile *p);
jali_status profile_half_circle(jali_context *ctx, double radius_mm, profile *p);

/// A smooth curve through points given as (radius, height) from the base up or from the top down; a point
/// given twice is a corner.
///   fails  JALI_BAD_VALUE (too few, a radius below 0, or 0 elsewhere than at an end, the curve crosses
///          itself; the sentence begins with `what`)
jali_status profile_through(jali_context *ctx, const char *what, int32_t count, const double (*point)[2],
                            profile *p);

/// The same through the points of a text file: "radius height" in mm, one a line, # begins a comment.
///   fails  also JALI_IO, JALI_BAD_INPUT (the line that is wrong)
jali_status profile_read(jali_context *ctx, const char *path, profile *p);

/// Choose the points that become rows: no farther apart than longest_mm, the curve no farther from the chord
/// than tolerance_mm, spread as evenly as that allows.
///   out    row        [*row_count], indices of points, ascending, both ends among them; from ctx, release it
///   fails  JALI_LIMIT (more than 100,000 rows)
jali_status profile_rows(jali_context *ctx, const profile *p, double tolerance_mm, double longest_mm,
                         int32_t **row, int32_t *row_count);

/// Does the polyline of the rows, with the floor as a line from the axis to its base, cross or touch itself?
///   out    at_mm  radius and height of the first place, when it does
///   cost   O(rows^2)
bool profile_crosses(const profile *p, const int32_t *row, int32_t row_count, bool floor, double at_mm[2]);

#endif
