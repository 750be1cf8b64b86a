// How light solid and void are, place by place. Internal to calibrate.
#ifndef CALIBRATE_LEVELS_H
#define CALIBRATE_LEVELS_H

#include "calibrate/view.h"

/// {0} is valid and empty.
typedef struct levels {
    int32_t columns, rows;
    double step_mm;
    double (*node)[2]; // [rows * columns] solid, void
} levels;

/// How far from a drawn edge levels are those of a tone alone.
typedef struct level_margin {
    double growth_mm; // by what edges may be off
    double edge_mm;   // and by what pixels and blur reach
} level_margin;

/// From places well within either tone: planes fitted to the neighbourhood of each node.
///   in     known   [feature_count] or NULL; bars that are known to have printed are sure within the margin,
///                  all others are kept away from
///   fails  JALI_NO_RESULT (a part of the board is not in the picture), JALI_NO_MEMORY
jali_status learn_levels(jali_context *ctx, const jali_picture *picture, const jali_board *board,
                         const jali_measured *known, const homography *map, const level_margin *margin,
                         levels *l);
void levels_free(jali_context *ctx, levels *l);

/// Solid and void at a place of the board.
void levels_at(const levels *l, double x_mm, double y_mm, double level[2]);

#endif
