// Predict: what the printer makes of a mask, and how far that is from the picture.
#ifndef JALI_PREDICT_H
#define JALI_PREDICT_H

#include <jali/bitmap.h>
#include <jali/bytes.h>
#include <jali/chart.h>
#include <jali/printer.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_predict_options {
    double picture_mm;       // width of the picture on the surface, > 0
    double phi_e_solid_mm;   // how much wider a solid bar prints than drawn; < 0: narrower, a kerf (0.1)
    double phi_e_void_mm;    // how much narrower a narrow void prints than drawn; < 0: wider (0.1)
    double narrow_mm;        // voids up to this width are narrow; 0 (default) = 4 phi_v
    double phi_s_mm;         // narrowest solid that prints, > 0 (0.3)
    double phi_v_mm;         // narrowest void that prints, > 0 (0.5)
    double hole_mm2;         // a round hole d wide prints hole_mm2 / d narrower still, >= 0 (0)
    double corner_mm;        // radius of what is drawn as a sharp corner, >= 0 (0: what phi leaves)
    const jali_chart *chart; // of the mask to come; with a metric the lengths hold on the surface. NULL: flat
    bool recall;             // also measure the medial axes (costs more than the rest); default true
} jali_predict_options;

JALI_API jali_predict_options jali_predict_defaults(void);

/// The defaults with all that a profile says.
JALI_API jali_predict_options jali_predict_of(const jali_printer *printer);

/// The picture at its own resolution, prepared once for any number of predictions.
typedef struct jali_reference {
    jali_bitmap picture;                // fine grid
    jali_bitmap axis_white, axis_black; // the picture's own resolution; empty without recall
    int32_t factor;                     // fine pixels a picture pixel
    int64_t axis_white_count, axis_black_count;
} jali_reference;

typedef struct jali_prediction {
    jali_bitmap printed;               // fine grid, the picture's area alone
    double error_rate;                 // share of fine pixels that differ from the picture, 0 .. 1
    double missing, excess;            // its two parts: solid of the picture that is void, void that is solid
    double recall_white, recall_black; // share of the picture's medial axis that prints in its tone, 0 .. 1
    int32_t pieces; // 4-connected, surroundings included; specks of the closing are none (docs/predict.md)
} jali_prediction;

/// Put the picture on the fine grid: 4 times finer than its pixels, or 2 or 1 where those are so small that
/// phi_s spans 32 fine pixels all the same, or finer until it spans 8 (and 4 where the surface is stretched
/// most).
JALI_API jali_status jali_reference_create(jali_context *ctx, const jali_bitmap *picture,
                                           const jali_predict_options *opt, jali_reference *reference);
JALI_API void jali_reference_free(jali_context *ctx, jali_reference *reference);

/// The forward model (docs/predict.md): the mask loses solid below phi_s, then voids below phi_v; round holes
/// shrink, edges move by half a phi_e, corners are rounded; exact discs throughout.
///   in     mask       any resolution; the picture lies margin_px inside its border on all sides
///          outside_solid   what surrounds the mask
///   fails  JALI_NO_MEMORY, JALI_BAD_VALUE
JALI_API jali_status jali_predict(jali_context *ctx, const jali_reference *reference, const jali_bitmap *mask,
                                  int32_t margin_px, bool outside_solid, const jali_predict_options *opt,
                                  jali_prediction *prediction);

/// How far a print is from the picture, whoever made it: error_rate, missing, excess and, when the reference
/// has its axes, both recalls.
///   inout  print   its `printed` has the size of the reference's picture
///   fails  JALI_BAD_VALUE (another size), JALI_NO_MEMORY
JALI_API jali_status jali_measure(jali_context *ctx, const jali_reference *reference, jali_prediction *print);
JALI_API void jali_prediction_free(jali_context *ctx, jali_prediction *prediction);

typedef struct jali_lost_options {
    int32_t
        least_px; // smaller parts and shorter stretches are the raster's noise; in the picture's own pixels,
                  // >= 1 (default 8)
    const jali_bitmap *bridges; // voids had to be crossed there: solid that joins the pieces, on any grid
                                // over the picture's area. NULL (default): nowhere
    int32_t margin_px;          // the picture lies so far inside the border of `bridges` (0)
    int32_t
        reach_px; // how far they, and a frame, come out further than drawn, in the picture's own pixels (0)
} jali_lost_options;

JALI_API jali_lost_options jali_lost_defaults(void);

/// Of one tone: parts (pieces, 4-connected; voids, 8-connected) of which nothing prints, and stretches
/// (8-connected) of the medial axis elsewhere that do not print.
typedef struct jali_lost_tone {
    int32_t parts, stretches;
} jali_lost_tone;

/// What of a picture a print does not show (docs/predict.md). {0} is valid and empty.
typedef struct jali_lost {
    jali_lost_tone white, black;
    jali_bitmap where; // the picture's own resolution: those parts and stretches
} jali_lost;

/// Find what is lost.
///   in     reference  with its axes
///          print      of the same picture
///          opt        NULL means the defaults
///   fails  JALI_BAD_VALUE (no axes, another size, least_px), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   O(pixels of the picture)
JALI_API jali_status jali_find_lost(jali_context *ctx, const jali_reference *reference,
                                    const jali_prediction *print, const jali_lost_options *opt,
                                    jali_lost *lost);
JALI_API void jali_lost_free(jali_context *ctx, jali_lost *lost);

/// Draw how a print differs from the picture, as a PNG: solid light, void dark; red where solid is missing,
/// yellow where there is too much.
///   in     wanted    the picture, on any grid that covers the same area as the print's
///          printed   a prediction's, or one that was measured
///          most_px   of the map's longer side, >= 1; a larger print is shrunk by the mean of whole blocks
///   out    png       appended
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_error_map(jali_context *ctx, const jali_bitmap *wanted, const jali_bitmap *printed,
                                    int32_t most_px, jali_bytes *png);

#ifdef __cplusplus
}
#endif
#endif
