// Compare: a printed result against the picture it came from. The witness is the slicer's own output (G-code
// or SL1 layers), or a scan of the print.
#ifndef JALI_COMPARE_H
#define JALI_COMPARE_H

#include <jali/bitmap.h>
#include <jali/predict.h>
#include <jali/read.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What a printer lays, seen from above. {0} is valid and empty.
typedef struct jali_print {
    jali_bitmap solid;              // y down as on paper; beyond it is void
    double pixel_mm[2];             // width and height of a pixel
    double size_mm[2];              // of the box around all that is solid
    int32_t layers;                 // of the file
    int32_t first, last, looked_at; // the layers 0 .. layers-1 that were drawn: so many from first to last
} jali_print;

JALI_API void jali_print_free(jali_context *ctx, jali_print *print);

typedef struct jali_print_options {
    double pixel_mm; // G-code: of the drawing, 0.001 .. 1 mm; default 0.02. SL1: used when the archive does
                     // not say; 0 = then it is refused
    double filament_mm; // G-code: the filament's diameter where the file is silent, > 0 (1.75)
} jali_print_options;

JALI_API jali_print_options jali_print_defaults(void);

/// Draw the extrusions of G-code with their widths, as strokes with round ends. Of the layers between a
/// quarter and three quarters of the height (15 of them at most) the majority counts for walls; filling
/// counts in every layer, so that a sparse one, closed by skins, is solid. Skirt, brim, support and purging
/// are left out where the slicer's comments tell them apart. Where no comment says a width, it follows from
/// the plastic fed (docs/compare.md).
///   in     path   not a pipe: it is read twice
///          opt    NULL means the defaults
///   out    print  its centre is the centre of the box around the walls of those layers
///   fails  JALI_BAD_INPUT (no G-code, nothing laid, a line that cannot be; the message names it), JALI_IO,
///          JALI_LIMIT (the drawing would be too large), JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_CANCELLED
///   cost   two readings of the file, a line in memory; five bits a pixel
JALI_API jali_status jali_print_gcode(jali_context *ctx, const char *path, const jali_print_options *opt,
                                      jali_print *print);
/// The same from memory; `name` stands in the messages.
JALI_API jali_status jali_print_gcode_bytes(jali_context *ctx, const void *bytes, size_t size,
                                            const char *name, const jali_print_options *opt,
                                            jali_print *print);

/// The layers of an SL1 or SL1S file (Prusa's resin printers), or of another ZIP of PNG layers: white is
/// exposed from half a pixel's grey on. The majority of the layers between a quarter and three quarters
/// counts: an object without supports and pad. Which way they lie is left to jali_compare: printers expose
/// them mirrored.
///   in     bytes   the file
///          opt     NULL means the defaults
///   fails  JALI_BAD_INPUT (no archive, no layers, a damaged one, no size of a pixel), JALI_LIMIT,
///          JALI_NO_MEMORY, JALI_CANCELLED
JALI_API jali_status jali_print_sl1_bytes(jali_context *ctx, const void *bytes, size_t size, const char *name,
                                          const jali_print_options *opt, jali_print *print);
/// The same from a file.
///   fails  as well JALI_IO
JALI_API jali_status jali_print_sl1(jali_context *ctx, const char *path, const jali_print_options *opt,
                                    jali_print *print);

typedef struct jali_compare_options {
    double picture_mm[2]; // width and height of the picture on the plate, > 0
    double frame_mm;      // of the plate around it, >= 0
    double phi_s_mm;      // pieces smaller than a disc of this diameter are dirt, no pieces; >= 0 (0.3)
} jali_compare_options;

typedef struct jali_comparison {
    jali_prediction print; // what was printed, on the reference's fine grid, and its figures
    jali_bitmap plate;     // the same with the frame and 1 mm around it
    double agreement;      // correlation of print and plate, 1 = the same
    int32_t quarter_turns; // clockwise, 0 .. 3, that brought the print upright,
    bool mirrored;         // after its left and right were swapped
    double shift_mm[2];    // to the right and down, beside the place that its outline gives
} jali_comparison;

JALI_API void jali_comparison_free(jali_context *ctx, jali_comparison *comparison);

/// Lay a print on the picture and measure it. The print's box is centred on the plate's; then the whole
/// pixels are found by which the two agree best, in the best of eight ways to lie.
///   in     reference  of the picture, its pixels on the plate as opt says
///   fails  JALI_NO_RESULT (they do not fit; the message says how far they agree and both sizes),
///          JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_compare(jali_context *ctx, const jali_reference *reference, const jali_print *print,
                                  const jali_compare_options *opt, jali_comparison *comparison);

/// The same with a scan or photograph of the printed plate: found in it at any size, turn and tilt, from
/// either side, light on dark or dark on light, under uneven light.
///   in     scan   grey levels; the plate's frame and a little around it should be seen
///   out    comparison   quarter_turns and mirrored say how it lay, nearly; shift_mm is 0
///   fails  JALI_NO_RESULT (the plate is not found, part of it is not seen, or a pixel is wider than a third
///   of
///          phi_s; the message says what would do), and as jali_compare
///   cost   about three seconds; 28 bytes a pixel of the scan's part that shows the plate, up to four times
///   that
JALI_API jali_status jali_compare_scan(jali_context *ctx, const jali_reference *reference,
                                       const jali_picture *scan, const jali_compare_options *opt,
                                       jali_comparison *comparison);

#ifdef __cplusplus
}
#endif
#endif
