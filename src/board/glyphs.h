// Stencilled letters: no counter is cut all the way round, so nothing falls out. Internal to board.
#ifndef BOARD_GLYPHS_H
#define BOARD_GLYPHS_H

#include "base/base.h"
#include <jali/board.h>

enum { STROKES = 3, STROKE_CORNERS = 12 };

/// A stroke as a polygon, counter-clockwise, mm from the letter's lower left corner.
typedef struct stroke_outline {
    int32_t count;
    double corner[STROKE_CORNERS][2];
} stroke_outline;

/// The least height of a letter.
double least_letter(double stroke_mm, double gap_mm);

/// The width that goes with a height.
double letter_width(double stroke_mm, double gap_mm, double height_mm);

/// From one letter to the next, and how long a text is.
double letter_advance(const jali_board *board, char letter);
double label_length(const jali_board *board, const char *text);

/// The strokes of a letter; returns how many, 0 for what there is no letter for.
int32_t draw_letter(const jali_board *board, char letter, stroke_outline outline[STROKES]);

#endif
