// Means that outliers do not move. Internal to calibrate.
#ifndef CALIBRATE_ROBUST_H
#define CALIBRATE_ROBUST_H

#include "base/base.h"

/// The median; reorders the values.
double median(double *value, int32_t count);

/// The mean of what lies within three scales of the median, the scale being 1.4826 times the median absolute
/// deviation and at least `least`. What lies further counts not at all.
///   inout  value    [count] reordered, those kept first
///          scratch  [count]
///   out    spread   standard deviation of those kept, 0 for one
///   returns         how many were kept
int32_t robust_mean(double *value, int32_t count, double least, double *scratch, double *mean,
                    double *spread);

/// The slope b of y = b x: that of least squares over what lies within three scales of the line whose slope
/// is the median of y / x, each weighted by x.
///   inout  point    [count] (x, y), x > 0; reordered, those kept first
///          scratch  [count]
int32_t robust_slope(double (*point)[2], int32_t count, double least, double *scratch, double *slope,
                     double *spread);

#endif
