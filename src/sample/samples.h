// One function a sample: it draws on the board. Internal to the stage sample.
#ifndef SAMPLE_SAMPLES_H
#define SAMPLE_SAMPLES_H

#include "sample/draw.h"

typedef void draw_sample(board *b);

draw_sample draw_girih, draw_tree, draw_mask, draw_lettering, draw_sunflower, draw_spiral, draw_rings,
    draw_halftone, draw_stripes, draw_checkerboard;

#endif
