// What every placement needs. Internal to the stage place.
#ifndef PLACE_GRID_H
#define PLACE_GRID_H

#include "base/base.h"
#include <jali/place.h>

/// Refuse a picture without pixels, a threshold that is none, options that are no lengths.
///   fails  JALI_BAD_VALUE
jali_status check_picture(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                          const jali_place_options *opt);

/// Both sizes in mm, from one of them or from two that agree.   fails  JALI_BAD_VALUE, JALI_NO_RESULT
jali_status picture_size(jali_context *ctx, const jali_picture *picture, const jali_place_options *opt,
                         double size_mm[2]);

/// The working pixel in mm when none is asked for, on a surface stretched so many times at most.
double automatic_pixel(const jali_place_options *opt, double most_stretch);

/// Width of the margin of a picture with solid surroundings, 0 without.
double margin_mm(const jali_place_options *opt);

/// Refuse a grid that is too large.   fails  JALI_NO_RESULT
jali_status check_grid(jali_context *ctx, double columns, double rows, double pixel_mm);

/// Make the margin of a drawing white.
void whiten_margin(const jali_chart *chart, jali_bitmap *drawing);

#endif
