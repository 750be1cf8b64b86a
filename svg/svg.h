// What jali-svg.so offers to the command line: one function, and no library of ours inside it.
#ifndef SVG_H
#define SVG_H

#include <stddef.h>
#include <stdint.h>

#define SVG_MODULE   "jali-svg.so"
#define SVG_FUNCTION "jali_svg_draw"

typedef enum svg_status { SVG_DRAWN, SVG_REFUSED, SVG_NO_MEMORY } svg_status;

/// A document in grey, or the sentence that says why not.
typedef struct svg_drawing {
    int32_t width, height;
    uint8_t *grey; // [width * height], of malloc
    char sentence[512];
} svg_drawing;

/// Draw a document on white, as large as its own width, height or viewBox make it.
///   in     longer_px   of the longer side
typedef svg_status svg_draw(const uint8_t *bytes, size_t size, int32_t longer_px, svg_drawing *out);

#endif
