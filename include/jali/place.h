// Lay a picture on a plate or on a surface: choose the working grid, resample the picture to it.
#ifndef JALI_PLACE_H
#define JALI_PLACE_H

#include <jali/bitmap.h>
#include <jali/chart.h>
#include <jali/read.h>
#include <jali/shell.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_placing {
    JALI_PLACE_AUTO,    // wrap where the surface comes unrolled, else project
    JALI_PLACE_PROJECT, // as a camera sees it: the picture looks right from there
    JALI_PLACE_WRAP     // on the unrolled surface
} jali_placing;

/// From where a projected picture looks right.
typedef struct jali_camera {
    double direction[3]; // of view; zeros (default): chosen so that the picture finds room, the front first
    double up[3];        // zeros (default): z, or y when that is the direction of view
    double from[3];      // a perspective's eye; used when perspective is set
    bool perspective;    // default: parallel
    double fov_deg;      // of a perspective: the picture's width as seen from the eye; 0 (default) = from the
                         // picture's size in mm, which holds at the depth of its centre
} jali_camera;

typedef struct jali_place_options {
    double width_mm,
        height_mm;   // size of the picture; 0 = from the other one by the picture's shape. Both
                     // may be given when they agree with it to 1 %. At least one is needed, or fov_deg
    double pixel_mm; // working pixel; 0 (default) = the coarsest of which the smaller of phi_s and
                     // phi_v holds at least `grid` (half across the steepest stretch of a surface) and phi_e
                     // / 2 a whole number
    int32_t grid;    // so many working pixels across the narrowest feature, 2 .. 64, where pixel_mm is 0; 0
                     // (default) = 8, 4 is a quick preview
    double phi_e_mm; // what the printer adds to a solid edge's two sides together; < 0: takes away (0.1)
    double phi_s_mm, phi_v_mm; // narrowest solid and narrowest void that print, > 0 (0.3, 0.5)
    double frame_mm;           // width of the solid frame, >= 0; 0 = the picture's border is the plate's
    bool paper;                // the paper's own grid: one working pixel an input pixel, no resampling
    // On surfaces alone:
    jali_placing placing;
    jali_camera camera;
    int32_t
        around; // > 0: once around a surface that closes, in so many equal parts of whole columns; width_mm
                // is the way around then, and the margins left and right show what lies beyond. Its ends
                // meet where the surface is unrolled (at the back), so that at_mm says its height alone
    bool at_given;   // the picture's centre goes to the place of the surface
    double at_mm[3]; // - projected: that lies behind this point; wrapped: nearest to it. Default: chosen
} jali_place_options;

/// Width 70 mm, phi 0.1 / 0.3 / 0.5 mm, no frame.
JALI_API jali_place_options jali_place_defaults(void);

/// Threshold a picture onto the working grid of a plate. Edges keep their place between input pixels.
/// With a frame the grid has a solid margin in which every width test near the border sees solid.
///   in     threshold  1 .. 255: white is grey >= threshold
///          opt        NULL means the defaults
///   out    chart      the grid; flat, nothing to free
///          drawing    margin included
///   fails  JALI_BAD_VALUE (a size that is no number, zero, negative, or disagrees), JALI_NO_RESULT (features
///          cannot fit, or the grid would be too large; the message says what would), JALI_NO_MEMORY,
///          JALI_LIMIT, JALI_CANCELLED
///   cost   O(input + working pixels); scratch of a few rows
JALI_API jali_status jali_place(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                                const jali_place_options *opt, jali_chart *chart, jali_bitmap *drawing);

/// The size of a surface's picture as it came about.
typedef struct jali_placed {
    jali_placing placing; // project or wrap
    double stretch[2];    // least and largest length on the surface of a mm of the picture's plane, inside it
    double direction[3];  // of view, projected
    double centre_mm[3];  // where the picture's centre lies
} jali_placed;

/// Lay a picture on a surface. Projected, only faces on which a mm of the picture is at most 4 mm count.
///   in     surface   its faces inside the picture and its frame must be free of faults
///          opt       NULL means the defaults; frame_mm is the protected zone around the picture, which the
///                    surface must have and which stays solid
///   out    chart     with the metric where lengths differ by more than 0.5 %; free with jali_chart_free
///          patch     the faces under the picture
///          drawing   margin included
///          placed    may be NULL
///   fails  as jali_place, and JALI_NO_RESULT when the surface has no room there, or hides part of it: the
///          message says where, how much, and which size would fit
///   cost   O(input + working pixels + faces)
JALI_API jali_status jali_place_on(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                                   const jali_place_options *opt, const jali_surface *surface,
                                   jali_chart *chart, jali_patch *patch, jali_bitmap *drawing,
                                   jali_placed *placed);

/// The input column under column x of the working grid split `per_px` times finer (1 = the grid itself), or
/// -1 in the margin. Rows likewise, with the heights.
static inline int32_t jali_input_column(const jali_chart *chart, int32_t input_width_px, int32_t x,
                                        int32_t per_px)
{
    int64_t columns = chart->width_px - 2 * chart->margin_px;
    int64_t twice = 2 * ((int64_t)x - (int64_t)chart->margin_px * per_px) + 1;
    if (twice < 0 || twice >= 2 * columns * per_px) return -1;
    return (int32_t)(twice * input_width_px / (2 * columns * per_px));
}

static inline int32_t jali_input_row(const jali_chart *chart, int32_t input_height_px, int32_t y,
                                     int32_t per_px)
{
    int64_t rows = chart->height_px - 2 * chart->margin_px;
    int64_t twice = 2 * ((int64_t)y - (int64_t)chart->margin_px * per_px) + 1;
    if (twice < 0 || twice >= 2 * rows * per_px) return -1;
    return (int32_t)(twice * input_height_px / (2 * rows * per_px));
}

#ifdef __cplusplus
}
#endif
#endif
