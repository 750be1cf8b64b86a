// What a line of G-code does: the moves that lay plastic, and what the slicer says about them. Internal to
// compare.
#ifndef COMPARE_GCODE_H
#define COMPARE_GCODE_H

#include "base/lines.h"

/// What is being laid, by the slicer's comments.
typedef enum laid_kind {
    LAID_WALL,   // perimeters, gaps; everything where nothing is said
    LAID_FILL,   // infill and skins: inside the walls
    LAID_OTHERS, // skirt, brim, support, purging: no part of the object
} laid_kind;

/// The printer as far as the lines so far have set it. machine_at_rest() is the beginning.
typedef struct machine {
    double at[4];     // X, Y, Z mm and E as the file counts them
    double origin[3]; // added to X, Y, Z by G92: machine place = at + origin
    double unit_mm;   // 1, or 25.4 after G20
    bool relative, relative_e;
    laid_kind kind;
    double width_mm, height_mm; // as said by the comments; 0 = not said
    double filament_mm;         // likewise
} machine;

machine machine_at_rest(void);

/// A move that lays plastic: a straight line, or an arc in the plane.
typedef struct laid_move {
    double from[2], to[2], z_mm;
    double centre[2]; // of an arc
    double turn_rad;  // of an arc, counter-clockwise > 0; 0 = straight
    double feed_mm;   // length of filament, > 0
} laid_move;

/// Follow one line.
///   inout  m
///   out    laid   filled when *lays
///   fails  JALI_BAD_INPUT (a number that is none, a place beyond 100 m, an arc without centre)
jali_status follow_line(jali_context *ctx, const lines *line, machine *m, laid_move *laid, bool *lays);

/// The length of a move in the plane.
double laid_length(const laid_move *move);

#endif
