// Letters of 5 x 7 dots for legends and notes in pictures. Internal.
#ifndef RASTER_GLYPHS_H
#define RASTER_GLYPHS_H

#include "base/base.h"

/// A picture that grows no further: [height][width][3].
typedef struct canvas {
    int32_t width, height;
    uint8_t *rgb;
} canvas;

void set_pixel(canvas *c, int32_t x, int32_t y, const uint8_t rgb[3]);

/// Write a line of text, its upper left corner at (x, y), each dot `scale` px; letters there are no dots for
/// are left blank.
void write_text(canvas *c, int32_t x, int32_t y, int32_t scale, const char *text, const uint8_t rgb[3]);

#endif
