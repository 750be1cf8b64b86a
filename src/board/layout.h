// What a board follows from. Internal to board.
#ifndef BOARD_LAYOUT_H
#define BOARD_LAYOUT_H

#include "base/base.h"
#include <jali/board.h>

enum { FEWEST_COLUMNS = 9, MOST_COLUMNS = 15, CELL_STEPS = 3 };

/// The four figures that its code holds.
typedef struct board_figures {
    int32_t phi_s, phi_v; // hundredths of a mm
    int32_t columns, cell_step;
} board_figures;

/// Is each within its range?
bool possible(const board_figures *f);

/// Lay out the board of these figures; thickness_mm is the usual one.
///   fails  JALI_NO_MEMORY
jali_status lay_out(jali_context *ctx, const board_figures *f, jali_board *board);

void write_code(const board_figures *f, bool code[JALI_BOARD_CODE_BITS]);

#endif
