// Bit-packed pictures and everything on them. Internal.
//
// Every operator works on 64-pixel words in row bands over the context's threads and gives the same result
// for any number of threads. Pixels beyond the bitmap count as `outside`.
#ifndef RASTER_RASTER_H
#define RASTER_RASTER_H

#include <jali/bitmap.h>

// --- Whole bitmaps (logic.c). Bitmaps of one call have one size; dst may be one of the operands.

typedef enum bitmap_rule { RULE_AND, RULE_OR, RULE_XOR, RULE_AND_NOT, RULE_OR_NOT } bitmap_rule;

/// dst = a rule b.
void combine(jali_context *ctx, bitmap_rule rule, const jali_bitmap *a, const jali_bitmap *b,
             jali_bitmap *dst);
void copy_pixels(jali_context *ctx, const jali_bitmap *src, jali_bitmap *dst);
void invert(jali_context *ctx, const jali_bitmap *a, jali_bitmap *dst);
void fill(jali_context *ctx, jali_bitmap *dst, bool white);
int64_t count_white(jali_context *ctx, const jali_bitmap *a);
/// Number of white pixels of (a rule b), without making it.
int64_t count_combined(jali_context *ctx, bitmap_rule rule, const jali_bitmap *a, const jali_bitmap *b);
bool any_white(jali_context *ctx, const jali_bitmap *a);

/// Copy src into dst with its upper left corner at (left, top); it lies wholly inside.
void paste(jali_context *ctx, const jali_bitmap *src, int32_t left, int32_t top, jali_bitmap *dst);
/// Copy the window of src that begins at (left, top) and has dst's size; it lies wholly inside.
void cut_out(jali_context *ctx, const jali_bitmap *src, int32_t left, int32_t top, jali_bitmap *dst);

// --- Morphology (morphology.c)

/// A structuring element that is convex and symmetric about its centre, row by row from the middle outwards:
/// at distance i from the middle row it reaches half[i] pixels to each side. Odd sizes have their centre on a
/// pixel, even ones on a pixel's upper left corner, so that every whole size exists.
typedef struct element {
    int32_t size;  // rows and columns it spans
    int32_t rows;  // (size + 1) / 2 entries of half
    int32_t *half; // [rows], not increasing; odd: reach beyond the centre; even: columns on each side
} element;

/// A square of `size` px, size >= 1.
jali_status element_square(jali_context *ctx, int32_t size, element *e);
/// All pixels whose centre lies within diameter_px / 2 of the centre; its size is the whole number nearest
/// to diameter_px (at least 1), so that a bar `size` px wide just holds it.
jali_status element_disc(jali_context *ctx, double diameter_px, element *e);
/// The disc of `size` px and every pixel that it touches: what a finer grid paints with a disc of that
/// diameter lies within what this paints.
jali_status element_wide_disc(jali_context *ctx, int32_t size, element *e);
/// The Minkowski sum: painting with it is painting with `a`, then with the odd element `b`.
jali_status element_sum(jali_context *ctx, const element *a, const element *b, element *sum);
/// The octagon between: square of `size` px with corners cut at 45 degrees.
jali_status element_octagon(jali_context *ctx, int32_t size, element *e);
void element_free(jali_context *ctx, element *e);

/// dst = the pixels where the element fits into src.   fails  JALI_NO_MEMORY
jali_status erode(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                  jali_bitmap *dst);
/// dst = the union of the elements centred on src (the reflected erosion of the complement).
jali_status dilate(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                   jali_bitmap *dst);
/// Opening: what the element can paint without leaving src. Closing: the opening of the complement. Elements
/// centred beyond the bitmap do not paint: a picture whose surroundings matter carries a margin of the
/// element's size. dst may be src. `scratch` has src's size.
jali_status open_by(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                    jali_bitmap *scratch, jali_bitmap *dst);
jali_status close_by(jali_context *ctx, const jali_bitmap *src, const element *e, bool outside,
                     jali_bitmap *scratch, jali_bitmap *dst);

/// The two halves of an opening, erode and dilate, and of a closing, widen and narrow. Even elements have
/// their centre aside, so they differ.
typedef enum morph_rule { MORPH_ERODE, MORPH_DILATE, MORPH_WIDEN, MORPH_NARROW, MORPH_RULES } morph_rule;

/// Words first .. first + words - 1, both multiples of 8, of the rows y0 .. y1-1.
typedef struct word_block {
    int64_t first, words;
    int32_t y0, y1;
} word_block;

/// Make of dst the blocks alone, which have no word in common; NULL: all of it. `outside` is what lies around
/// src, solid around what a closing widened.
jali_status morph_blocks(jali_context *ctx, morph_rule rule, const jali_bitmap *src, const element *e,
                         bool outside, const word_block *block, int32_t count, jali_bitmap *dst);

// --- Size (resize.c)

/// Each pixel of dst takes the pixel of src's window that its centre falls on.
void resize_nearest(jali_context *ctx, const jali_bitmap *src, int32_t left, int32_t top, int32_t width,
                    int32_t height, jali_bitmap *dst);

// --- Smoothing (majority.c)

/// dst = the tone that most pixels of the 7 x 7 around each pixel have; dst is not src.   fails
/// JALI_NO_MEMORY
jali_status majority(jali_context *ctx, const jali_bitmap *src, bool outside, jali_bitmap *dst);

// --- Medial axis (axis.c)

/// The centres of the maximal squares inside the white (or black) pixels: the ridge of the chessboard
/// distance. Source: Lantuejoul's formula, the union over k of E_k - opening(E_k), E_k the k-fold 3 x 3
/// erosion.
///   in     outside  whether what lies beyond the bitmap is of that tone too
///          rounds   stop after so many erosions: the axis of features up to 2 * rounds px wide; 0 = of all
jali_status medial_axis(jali_context *ctx, const jali_bitmap *a, bool white, bool outside, int32_t rounds,
                        jali_bitmap *axis);

// --- Distance (distance.c)

enum { DISTANCE_NONE = INT32_MAX }; // there is no such pixel

/// The squared Euclidean distance from each pixel's centre to that of the nearest pixel of a tone; pixels
/// beyond the bitmap have none.
///   in     first_row, rows   the band of rows that is wanted; the whole bitmap is looked at all the same
///   out    squared           [rows * width_px]; DISTANCE_NONE where the bitmap has no pixel of the tone, and
///                            DISTANCE_NONE - 1 at most (46,340 px)
///   fails  JALI_NO_MEMORY
///   cost   O(pixels) time, two looks at each; 4 bytes a pixel of the band and 384 a column
jali_status squared_distances(jali_context *ctx, const jali_bitmap *a, bool white, int32_t first_row,
                              int32_t rows, int32_t *squared);

// --- Components (components.c)

/// First column x .. end whose bit in the row, xored with flip, is set; `end` when there is none.
int32_t next_white(const uint64_t *row, int32_t x, int32_t end, uint64_t flip);

/// Maximal horizontal runs of one tone, labelled by connected component.
typedef struct components {
    int32_t width_px, height_px;
    int32_t run_count,
        count;          // count: number of components, labels 0 .. count-1 by first pixel in raster order
    int32_t *first;     // [height_px + 1], row y owns runs first[y] .. first[y+1]-1
    int32_t (*span)[2]; // [run_count], columns x0 .. x1-1
    int32_t *label;     // [run_count]
} components;

/// Label the components of one tone with 4- or 8-connectivity.
jali_status label_components(jali_context *ctx, const jali_bitmap *a, bool white, int32_t connectivity,
                             components *out);
void components_free(jali_context *ctx, components *c);
/// The run that holds (x, y), or -1.
int32_t run_at(const components *c, int32_t x, int32_t y);
/// area[label] = pixels.
jali_status component_areas(jali_context *ctx, const components *c, int64_t **area);
/// Those of the columns x0 .. x1-1 that lie in word i of a row; some do.
static inline uint64_t columns_of_word(int32_t i, int32_t x0, int32_t x1)
{
    uint64_t columns = ~UINT64_C(0);
    if (i == x0 >> 6) columns &= ~UINT64_C(0) << (x0 & 63);
    if (i == (x1 - 1) >> 6) columns &= ~UINT64_C(0) >> (63 - ((x1 - 1) & 63));
    return columns;
}

/// Set the run's pixels in dst.
void paint_run(jali_bitmap *dst, int32_t y, int32_t x0, int32_t x1, bool white);
/// White pixels in the row's columns x0 .. x1-1.
int32_t count_run(const jali_bitmap *a, int32_t y, int32_t x0, int32_t x1);
/// The 64 pixels of row y from column x (a multiple of 64, may be negative) on; `outside` beyond the bitmap.
uint64_t window_word(const jali_bitmap *a, int32_t x, int32_t y, bool outside);
/// A walk from one pixel to another along the 4-connected path nearest to the straight line.
typedef struct line_walk {
    int32_t x, y; // where it is
    int32_t step_x, step_y;
    int64_t wide, high, gone_x, gone_y;
} line_walk;
line_walk walk_line(const int32_t from[2], const int32_t to[2]);
/// One step on; false at the end.
bool walk_on(line_walk *w);

#endif
