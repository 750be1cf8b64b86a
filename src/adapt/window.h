// A small window of a picture in registers: 128 columns, up to 128 rows. Internal to adapt.
//
// The search looks at hundreds of thousands of places and changes a few pixels at each; whole-picture
// operators would cost a picture a place, a window costs a microsecond.
#ifndef ADAPT_WINDOW_H
#define ADAPT_WINDOW_H

#include "raster/raster.h"

enum { WINDOW_COLUMNS = 128, WINDOW_ROWS = 128, WINDOW_MAX_ELEMENT = 32 };

/// Row k: bit i of left[k] is column i, bit i of right[k] is column 64 + i.
typedef struct window {
    uint64_t left[WINDOW_ROWS], right[WINDOW_ROWS];
} window;

/// An element prepared for windows.
typedef struct window_element {
    int32_t size;
    int32_t level_count;
    int32_t step[WINDOW_MAX_ELEMENT];     // how far level i reaches beyond level i-1
    int32_t level_of[WINDOW_MAX_ELEMENT]; // by distance from the middle row
} window_element;

/// e->size <= WINDOW_MAX_ELEMENT.
window_element window_element_of(const element *e);

/// The `rows` rows of `a` from (x0, y0) on, 128 columns; all of it lies inside the bitmap.
void window_read(const jali_bitmap *a, int32_t x0, int32_t y0, int32_t rows, window *w);
/// Flip the pixels of `a` that are set in `change`.
void window_flip(jali_bitmap *a, int32_t x0, int32_t y0, int32_t rows, const window *change);

/// Where the element fits into `a`; beyond the window counts as set.
void window_erode(const window *a, int32_t rows, const window_element *e, window *fits);
/// What the element paints when it is centred on each pixel of `a`.
void window_dilate(const window *a, int32_t rows, const window_element *e, window *painted);

#endif
