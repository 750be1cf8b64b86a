// Calibrate: from widths measured on a printed reference board to a printer's figures (docs/calibrate.md).
#ifndef JALI_CALIBRATE_H
#define JALI_CALIBRATE_H

#include <jali/board.h>
#include <jali/bytes.h>
#include <jali/printer.h>
#include <jali/read.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Something that was printed and measured.
typedef struct jali_width {
    jali_board_kind kind;
    jali_board_direction direction; // JALI_BOARD_ROUND: round, or not said
    double designed_mm;             // > 0
    double measured_mm;             // 0: it did not print
    int32_t line;                   // of the file, or its place in the list, from 1
} jali_width;

/// {0} is valid and empty.
typedef struct jali_widths {
    jali_width *width; // [count]
    size_t count, capacity;
} jali_widths;

JALI_API void jali_widths_free(jali_context *ctx, jali_widths *widths);

/// Append one; for programs that measure themselves.
JALI_API jali_status jali_widths_add(jali_context *ctx, const jali_width *width, jali_widths *widths);

/// Read a table: designed,measured,kind[,direction] a line, in mm, separated by commas, semicolons or tabs.
///   kind       solid, void, hole, pin, solid pair, void pair
///   measured   0, - or nothing: it did not print
///   direction  horizontal, vertical, diagonal, or nothing
/// The first line may name the columns; empty lines and what follows a # do not count. Where semicolons or
/// tabs separate, decimal commas are understood.
///   in     name    of the file, for sentences
///   out    widths  appended to
///   fails  JALI_BAD_INPUT (the first bad line: what is wrong, what is accepted; the numbers of the others),
///          JALI_NO_MEMORY
JALI_API jali_status jali_widths_read(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                                      jali_widths *widths);

/// Read a list such as "solid:0.4=0.52,void:0.5=-".
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY
JALI_API jali_status jali_widths_parse(jali_context *ctx, const char *text, jali_widths *widths);

enum { JALI_ODD_WIDTHS = 8 };

/// The narrowest that prints, of one tone.
typedef struct jali_limit {
    bool found;                     // some print, and all that are wider
    bool bounded;                   // and a narrower one does not: else value_mm is an upper bound, "at most"
    double value_mm;                // narrowest that prints in every direction together with all wider ones
    double lost_mm;                 // widest that does not print; 0: none
    int32_t odd_count;              // widths narrower than that of which one printed all the same
    double odd_mm[JALI_ODD_WIDTHS]; // the widest of them
} jali_limit;

/// A figure fitted to several measurements.
typedef struct jali_fitted {
    int32_t measured; // things that printed
    int32_t kept;     // of them, the others were too far off; 0: fewer than 3 printed, nothing is fitted
    double value;
    double spread;   // standard deviation of those kept about the fit, mm
    double error_mm; // standard error of the value, with what bars have in common; holes: 0, not told
    bool doubtful;   // twice that is above 0.02 mm, or more than a fifth were too far off
} jali_fitted;

/// A plain value. {0} is valid and says nothing.
typedef struct jali_calibration {
    jali_fitted phi_e_solid, phi_e_void; // mm
    jali_limit phi_s, phi_v;
    jali_fitted hole; // mm2, its spread in mm
    jali_fitted pin;  // how much wider discs came out, mm: a check of phi_e_solid, no figure of a printer
    double corner_mm; // radius of corners; 0: not measured
    int32_t corners;  // from so many
} jali_calibration;

/// Fit a printer's figures. phi_e is the mean of measured - designed over what lies within three spreads of
/// the median, the spread from the median absolute deviation: one bad bar in ten does not count at all.
///   fails  JALI_BAD_INPUT (the same bar printed and did not, a measurement that cannot be true),
///          JALI_NO_MEMORY; what cannot be told is left out, not guessed
JALI_API jali_status jali_calibrate(jali_context *ctx, const jali_widths *widths,
                                    jali_calibration *calibration);

/// Put what was found into a profile, each figure with its source.
///   in     from     where the widths come from, for the sources
///   inout  printer  what it says already stays where nothing was found
///   fails  JALI_NO_RESULT (a figure that every profile needs is neither found nor there: what would help)
JALI_API jali_status jali_calibration_apply(jali_context *ctx, const jali_calibration *calibration,
                                            const char *from, jali_printer *printer);

/// What was found, in sentences, a line each; appended.
JALI_API jali_status jali_calibration_sentences(jali_context *ctx, const jali_calibration *calibration,
                                                jali_bytes *text);

// --- From a scan

typedef struct jali_scan_options {
    const jali_board *board; // which board it is, whatever its code says; NULL (default): the code's
    double dpi; // pixels an inch; 0 (default): the board's own size is the scale, and a print that is
                // smaller as a whole is not told from a scan that is
} jali_scan_options;

JALI_API jali_scan_options jali_scan_defaults(void);

/// A feature as it was found.
typedef struct jali_measured {
    bool printed;
    double width_mm;  // what there is, also where it does not count as printed; below 0 by chance
    double spread_mm; // standard deviation along it
    double off_mm[2]; // from where it should be, on the board; bars: across alone
} jali_measured;

/// A scan that was understood. {0} is valid and empty.
typedef struct jali_scan {
    jali_board board;
    jali_measured *feature; // [board.feature_count]
    bool code_read;         // the board's code could be read
    bool mirrored, dark;    // seen from behind; voids are darker than the plate
    double turn_deg;        // of the board's x axis, clockwise in the scan, -180 .. 180
    double map[9];          // from the board's mm to the scan's px, homogeneous, row by row
    double pixel_mm;        // a pixel of the scan on the board
    double blur_mm;         // deviation of the blur at edges
    double contrast;        // between the tones where it is least, 0 .. 1
    double residual_mm;     // places of features against the map, standard deviation
    double scale[2];        // printed over designed length along x and y; 1 without dpi
    double corner_mm;       // radius of the windows' corners; 0: too small to tell
    int32_t corners;        // from so many
} jali_scan;

JALI_API void jali_scan_free(jali_context *ctx, jali_scan *scan);

/// Find the board in a scan or photograph and measure every feature: any turn, tilt and size, from either
/// side, voids lighter or darker, under uneven light.
///   in     opt   NULL means the defaults
///   out    scan  free with jali_scan_free
///   fails  JALI_NO_RESULT (no board, not all of it, its code cannot be read, coarse, blurred, grey in grey,
///          bent: the sentence says how much and what is needed), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   under a second for 300 dpi
JALI_API jali_status jali_scan_board(jali_context *ctx, const jali_picture *picture,
                                     const jali_scan_options *opt, jali_scan *scan);

/// The widths that were measured, for jali_calibrate; appended.
JALI_API jali_status jali_scan_widths(jali_context *ctx, const jali_scan *scan, jali_widths *widths);

/// A picture of it, as a PNG: the scan straightened, each feature's outline as designed (what did not print
/// in red), its designed and its measured width.
JALI_API jali_status jali_scan_map(jali_context *ctx, const jali_picture *picture, const jali_scan *scan,
                                   jali_bytes *png);

#ifdef __cplusplus
}
#endif
#endif
