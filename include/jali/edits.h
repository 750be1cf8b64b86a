// Edits by hand: bridges drawn, places where none may run, regions that stay as they are.
#ifndef JALI_EDITS_H
#define JALI_EDITS_H

#include <jali/bitmap.h>
#include <jali/bridges.h>
#include <jali/bytes.h>
#include <jali/chart.h>
#include <jali/read.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_edit_kind {
    JALI_EDIT_BRIDGE, // becomes solid, at least as wide as the printer needs, and stays
    JALI_EDIT_FORBID, // no bridge runs there, unless it is drawn
    JALI_EDIT_LOCK,   // the picture stays as it is, pixel for pixel: nothing thickened, widened or bridged
    JALI_EDIT_KINDS
} jali_edit_kind;

/// A stroke along its points, or the region that they enclose.
typedef struct jali_edit {
    jali_edit_kind kind;
    double width; // of the stroke, >= 0; 0: of a bridge, as narrow as the printer allows; of the others,
                  // no stroke but the region enclosed (even-odd), of at least 3 points
    int32_t first, count; // its points
} jali_edit;

/// {0} is valid and empty. Lengths count in a unit of their own: `size` says how many of it the picture is
/// wide and high (its pixels, say, or 1 and its shape). They go with the picture as its file has it: before
/// crop, turn and mirror, whatever its resolution, its size in mm and the printer.
typedef struct jali_edits {
    double size[2]; // width and height of the picture
    int32_t count;
    jali_edit *edit; // [count]
    int32_t point_count;
    double (*point)[2]; // [point_count], x right, y down from the picture's upper left corner
} jali_edits;

JALI_API void jali_edits_free(jali_context *ctx, jali_edits *edits);

/// Read edits from JSON (docs/edits.md).
///   fails  JALI_BAD_INPUT (which edit, what, what is accepted), JALI_IO, JALI_NO_MEMORY, JALI_LIMIT
JALI_API jali_status jali_edits_read(jali_context *ctx, const char *path, jali_edits *edits);
/// The same from memory; `name` stands in the messages.
JALI_API jali_status jali_edits_read_bytes(jali_context *ctx, const uint8_t *bytes, size_t size,
                                           const char *name, jali_edits *edits);
/// Write them as JSON that reads back the same; appended.
JALI_API jali_status jali_edits_write(jali_context *ctx, const jali_edits *edits, jali_bytes *json);

/// Take edits along with their picture: crop, turn, mirror.
///   in     read     what was done to the picture; NULL means nothing
///          file_px  the picture's size before that, as jali_picture has it
///   inout  edits    afterwards in pixels of the picture as it was read
///   fails  JALI_BAD_INPUT (they were made for a picture of another shape)
JALI_API jali_status jali_edits_follow(jali_context *ctx, const jali_read_options *read,
                                       const int32_t file_px[2], jali_edits *edits);

/// The same edits on each of so many copies of the picture side by side.
///   in     edits    after jali_edits_follow
///   out    row      free with jali_edits_free
JALI_API jali_status jali_edits_repeat(jali_context *ctx, const jali_edits *edits, int32_t copies,
                                       jali_edits *row);

/// Bridges of a working grid as edits, the way back from jali_edits_follow.
///   in     chart     of the bridges
///          width_px  of their strokes
///          picture   as it was read
///          read      what was done to it; NULL means nothing
///          copies    of the picture on the grid, side by side: the first one's bridges are taken
///   out    edits     in pixels of the file; free with jali_edits_free
JALI_API jali_status jali_edits_of_bridges(jali_context *ctx, const jali_bridges *bridges,
                                           const jali_chart *chart, int32_t width_px,
                                           const jali_picture *picture, const jali_read_options *read,
                                           int32_t copies, jali_edits *edits);

/// Edits on a working grid. {0} is valid and empty.
typedef struct jali_marks {
    jali_bridges drawn; // ways of the bridges; their ends and corners may lie beyond the grid
    jali_bitmap wide;   // what those cover that are wider than 0
    jali_bitmap closed; // forbidden or locked
    jali_bitmap locked;
    int32_t count[JALI_EDIT_KINDS]; // edits of each kind
} jali_marks;

JALI_API void jali_marks_free(jali_context *ctx, jali_marks *marks);

/// Draw edits onto a chart's grid.
///   in     edits   after jali_edits_follow; their picture is the grid without its margin
///   out    marks   free with jali_marks_free
///   fails  JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_edits_draw(jali_context *ctx, const jali_edits *edits, const jali_chart *chart,
                                     jali_marks *marks);

#ifdef __cplusplus
}
#endif
#endif
