// Which board a scan shows, and how it lies there. Internal to calibrate.
#ifndef CALIBRATE_REGISTER_H
#define CALIBRATE_REGISTER_H

#include "calibrate/view.h"

/// Find the board and read its code.
///   in     given  the board to take whatever the code says; NULL: the code's
///   out    scan   board, code_read, mirrored, dark, turn_deg, pixel_mm
///          map    from the board's mm to the picture
///   fails  JALI_NO_RESULT, JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
jali_status find_board(jali_context *ctx, const jali_picture *picture, const jali_board *given,
                       jali_scan *scan, homography *map);

/// Bring the map nearer to where the features were found: the eight ratios of least squares, without
/// outliers.
///   inout  map
///   out    residual_mm  what is left
///   fails  JALI_NO_MEMORY
jali_status refine_map(jali_context *ctx, const jali_board *board, const jali_measured *feature,
                       homography *map, double *residual_mm);

#endif
