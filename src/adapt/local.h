// Erosion and dilation of a window (window.h) by an element that varies from tile to tile. Internal to adapt.
#ifndef ADAPT_LOCAL_H
#define ADAPT_LOCAL_H

#include "adapt/window.h"
#include "raster/field.h"

/// A patch prepared for windows; rows and columns it spans are at most WINDOW_MAX_ELEMENT.
typedef struct window_patch {
    int32_t top, rows, left; // left: its first column, any row's
    int32_t area;
    int32_t level_count;
    int32_t length[WINDOW_MAX_ELEMENT]; // of the runs of level i, growing, at most twice the one before
    int32_t level_of[WINDOW_MAX_ELEMENT], first[WINDOW_MAX_ELEMENT]; // [rows], first column
    uint64_t row[WINDOW_MAX_ELEMENT];                                // [rows], its pixels from `left` on
} window_patch;

typedef struct window_field {
    const field *f;
    window_patch *patch; // [f->patches]
} window_field;

/// The field for windows; no patch may span more than WINDOW_MAX_ELEMENT rows or columns.
jali_status window_field_create(jali_context *ctx, const field *f, window_field *w);
void window_field_free(jali_context *ctx, window_field *w);
const window_patch *window_patch_at(const window_field *w, int32_t x, int32_t y);

/// The square of 2 half x 2 half pixels in the middle of a window whose first pixel is (x0, y0) of the
/// bitmap: in it the pixels whose own patch fits into `a`; beyond the window nothing is set. half <= 64, 2
/// half <= rows.
void local_erode(const window_field *w, const window *a, int32_t x0, int32_t y0, int32_t rows, int32_t half,
                 window *fits);
/// What the patches set on the pixels of `a` in that square paint in the window.
void local_dilate(const window_field *w, const window *a, int32_t x0, int32_t y0, int32_t rows, int32_t half,
                  window *painted);

#endif
