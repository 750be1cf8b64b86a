// A small drawing board: shapes in black and white, the later over the earlier. Internal to the stage sample.
//
// Places are in thousandths of the picture's side, x right, y down, on a square of 1000 x 1000; angles are in
// turns (1/4 turns x into y). Only + - * / and sqrt are used, so every machine draws the same picture.
#ifndef SAMPLE_DRAW_H
#define SAMPLE_DRAW_H

#include <jali/bitmap.h>
#include "base/base.h"

typedef struct spot {
    double x, y;
} spot;

typedef enum tone { BLACK, WHITE } tone;

typedef struct shape {
    tone tone;
    double radius;        // of a disc; 0 = a polygon, filled where its winding is not 0
    int32_t first, count; // points; a disc has one, its centre
    double top, bottom;
} shape;

/// The first failure to grow is kept in `status`; what is drawn after it is dropped.
typedef struct board {
    jali_context *ctx;
    jali_status status;
    spot *point;  // [point_count]
    shape *shape; // [shape_count]
    size_t point_count, point_capacity, shape_count, shape_capacity;
    int32_t largest_polygon;
    uint64_t seed; // of next_share
} board;

static inline spot at(double x, double y)
{
    return (spot){x, y};
}
static inline spot plus(spot a, spot b)
{
    return (spot){a.x + b.x, a.y + b.y};
}
static inline spot minus(spot a, spot b)
{
    return (spot){a.x - b.x, a.y - b.y};
}
static inline spot times(spot a, double f)
{
    return (spot){a.x * f, a.y * f};
}
static inline spot between(spot a, spot b, double f)
{
    return plus(a, times(minus(b, a), f));
}
static inline spot mirrored(spot a)
{
    return (spot){1000 - a.x, a.y};
}

/// The unit vector of an angle in turns: its y is the sine, its x the cosine.
spot direction(double turns);
static inline spot polar(spot centre, double radius, double turns)
{
    return plus(centre, times(direction(turns), radius));
}

double length_of(spot a);
spot bezier(spot a, spot b, spot c, spot d, double f);

/// A pseudo-random number in 0 .. 1, from the board's seed.
double next_share(board *b);

void begin_polygon(board *b, tone t);
void add_point(board *b, spot p);
void add_bezier(board *b, spot from, spot c1, spot c2, spot to); // without its first point
void end_polygon(board *b);

void draw_disc(board *b, tone t, spot centre, double radius);
void draw_ring(board *b, spot centre, double radius, double width); // white, the inside black
void draw_box(board *b, tone t, double left, double top, double right, double bottom);
void draw_polygon(board *b, tone t, const spot *p, int32_t count);
/// A straight stroke with flat ends.
void draw_bar(board *b, tone t, spot from, spot to, double width);
/// Two of them with a sharp corner between.
void draw_bent_bar(board *b, tone t, spot from, spot bend, spot to, double width);
/// A straight stroke with round ends, its width changing evenly.
void draw_limb(board *b, tone t, spot from, spot to, double width_from, double width_to);
/// The same along a cubic curve.
void draw_curve(board *b, tone t, const spot p[4], double width_from, double width_to);
/// A pointed leaf from a to b; bulge is its half width as a share of its length, bend moves its middle aside.
void draw_leaf(board *b, tone t, spot from, spot to, double bulge, double bend);

/// Fill the bitmap's square with what was drawn.
jali_status rasterise_board(board *b, jali_bitmap *bitmap);

#endif
