// Looking at a scan through a map from the board. Internal to calibrate.
#ifndef CALIBRATE_VIEW_H
#define CALIBRATE_VIEW_H

#include "base/base.h"
#include "scan/homography.h"

#include <jali/calibrate.h>
#include <math.h>

/// The level 0 .. 1 at a place of the picture, between the four nearest pixel centres; beyond it NAN.
static inline double level_at(const jali_picture *p, double x, double y)
{
    x -= 0.5;
    y -= 0.5;
    if (!(x >= 0 && y >= 0 && x < p->width_px - 1 && y < p->height_px - 1)) return NAN;
    int32_t column = (int32_t)x, row = (int32_t)y;
    double u = x - column, v = y - row;
    const uint8_t *at = p->grey + (size_t)row * (size_t)p->width_px + (size_t)column;
    return ((1 - v) * ((1 - u) * at[0] + u * at[1]) +
            v * ((1 - u) * at[p->width_px] + u * at[p->width_px + 1])) /
           255;
}

/// The same at a place of the board, mm.
static inline double seen_at(const jali_picture *p, const homography *map, double x, double y)
{
    double at[2];
    homography_apply(map, (const double[2]){x, y}, at);
    return level_at(p, at[0], at[1]);
}

#endif
