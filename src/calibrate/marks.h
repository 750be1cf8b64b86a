// The board's five marks in a scan. Internal to calibrate.
#ifndef CALIBRATE_MARKS_H
#define CALIBRATE_MARKS_H

#include "base/base.h"
#include "scan/grey.h"
#include "scan/homography.h"

/// A way to see the five marks in a scan.
typedef struct mark_guess {
    homography map; // from shares of the rectangle through the corner marks (x right, y up) to the scan's px
    bool mirrored;  // the board is seen from behind
    bool dark;      // voids are darker than the plate
    double radius_px, size_px2; // of the first mark; of the rectangle
} mark_guess;

enum { MOST_GUESSES = 32 };

/// Round things of either tone, five of which lie as the marks do; the largest arrangements first.
///   in     g       the scan, shrunk or not
///   out    guess   [MOST_GUESSES]
///          count   0: nothing there looks like a board
///          rounds  how many round things there were
///   fails  JALI_NO_MEMORY, JALI_LIMIT
jali_status guess_marks(jali_context *ctx, const grey *g, mark_guess *guess, int32_t *count, int32_t *rounds);

#endif
