// Board: the reference board, a plate of bars, holes and pins of stepped widths, from which a printer's
// figures are measured (docs/board.md).
#ifndef JALI_BOARD_H
#define JALI_BOARD_H

#include <jali/bitmap.h>
#include <jali/contours.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_board_options {
    double phi_s_mm;     // narrowest solid expected to print, 0.05 .. 3; 0.3 (default); rounded to 0.01
    double phi_v_mm;     // narrowest void, likewise; 0.5 (default)
    double most_mm;      // the longest side may be so long; 200 (default), 40 .. 200
    double thickness_mm; // 2 (default), > 0
} jali_board_options;

JALI_API jali_board_options jali_board_defaults(void);

typedef enum jali_board_kind {
    JALI_BOARD_SOLID,      // a bar across a window
    JALI_BOARD_VOID,       // a slot
    JALI_BOARD_SOLID_PAIR, // the thin solid between a pair of slots
    JALI_BOARD_VOID_PAIR,  // the thin void between a pair of bars
    JALI_BOARD_HOLE,       // round
    JALI_BOARD_PIN,        // a disc that stands in a window on a stem
    JALI_BOARD_KINDS
} jali_board_kind;

/// "solid", "void", "solid pair", "void pair", "hole", "pin".
JALI_API const char *jali_board_kind_name(jali_board_kind kind);

typedef enum jali_board_direction {
    JALI_BOARD_HORIZONTAL,
    JALI_BOARD_VERTICAL,
    JALI_BOARD_DIAGONAL, // rising to the right
    JALI_BOARD_ROUND
} jali_board_direction;

/// Something of a designed width. Places are mm from the plate's lower left corner, x right, y up.
typedef struct jali_board_feature {
    jali_board_kind kind;
    jali_board_direction direction;
    double width_mm;  // of the bar, or the diameter
    double at_mm[2];  // its centre
    double length_mm; // of the bar; of a pin, from its centre to the foot of its stem, which points down
    double window_mm; // it is measured along so much of its length, in the middle; 0 for what is round
    double reach_mm;  // and across from the centre line: within, there is only it and the other tone
    double
        beside_mm; // width of what stands on either side: of a pair's slots or bars, of a pin's stem; else 0
} jali_board_feature;

/// Digits, letters and points cut through, read upwards or to the right.
typedef struct jali_board_label {
    char text[8];
    double at_mm[2]; // the lower left corner of the first letter as it is read
    bool upwards;
} jali_board_label;

enum {
    JALI_BOARD_MARKS = 5, // round voids: the corners, lower left first, counter-clockwise; the odd one last
    JALI_BOARD_CODE_BITS = 36
};

/// A board. {0} is valid and empty. From (phi_s, phi_v, columns, cell_step) all else follows.
typedef struct jali_board {
    double phi_s_mm, phi_v_mm;
    int32_t columns;   // of cells, a width each
    int32_t cell_step; // cells are so many times smaller than the roomiest
    double cell_mm, width_mm, height_mm, thickness_mm;
    double mark_mm[JALI_BOARD_MARKS][2]; // centres
    double mark_diameter_mm;
    bool code[JALI_BOARD_CODE_BITS]; // true: a square void
    double code_mm[JALI_BOARD_CODE_BITS][2], code_side_mm;
    double stroke_mm, gap_mm, glyph_mm[2]; // of labels: the slots, the solid between them, width and height
    int32_t feature_count, label_count;
    jali_board_feature *feature; // [feature_count]
    jali_board_label *label;     // [label_count]
} jali_board;

JALI_API void jali_board_free(jali_context *ctx, jali_board *board);

/// Lay out a board: widths from less than half to three times those expected, in steps of a tenth near them.
///   in     opt    NULL means the defaults
///   out    board  the same for the same options; free with jali_board_free. When a board for these widths
///                is too large for most_mm, the coarser of both widths is brought down, to half at most; the
///                steps above it still reach what was asked for
///   fails  JALI_BAD_VALUE, JALI_NO_RESULT (even so it does not fit: how much is needed), JALI_NO_MEMORY
JALI_API jali_status jali_board_layout(jali_context *ctx, const jali_board_options *opt, jali_board *board);

/// Where marks and code lie, as shares of the rectangle through the centres of the four corner marks: from
/// the lower left one, x right, y up. The same on every board, so that a scan can be read before it is known
/// which board it shows.
JALI_API void jali_board_mark_share(int32_t mark, double share[2]);
JALI_API void jali_board_code_share(int32_t bit, double share[2]);

/// The board that a code stands for.
///   fails  JALI_BAD_INPUT (the checksum fails, or it stands for no board), JALI_NO_MEMORY
JALI_API jali_status jali_board_decode(jali_context *ctx, const bool code[JALI_BOARD_CODE_BITS],
                                       jali_board *board);

/// The board's contours: outline, marks, code, labels, features. A width is exact to a lattice unit, less
/// than 16 nm; what is round has 128 sides and the area of its circle.
///   fails  JALI_NO_MEMORY
JALI_API jali_status jali_board_contours(jali_context *ctx, const jali_board *board, jali_contours *contours);

/// The board as a picture, white where it is solid, without a margin.
///   in     pixel_mm  0.002 .. 10
///   out    pixel_mm  rounded to the lattice
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT
JALI_API jali_status jali_board_bitmap(jali_context *ctx, const jali_board *board, double *pixel_mm,
                                       jali_bitmap *bitmap);

#ifdef __cplusplus
}
#endif
#endif
