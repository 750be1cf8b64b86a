// The elements that stand for the printer's widths. Internal to adapt.
#ifndef ADAPT_WIDTHS_H
#define ADAPT_WIDTHS_H

#include <jali/adapt.h>
#include "raster/field.h"

/// Both widths where they hold: the narrowest solid and the narrowest void, as elements of each place.
typedef struct widths {
    tiling tiles;
    field solid, hollow; // they point to `tiles`: a struct of this type stays where it was made
    field near;          // in the mask alone: what makes one of cores that lie so near that no neck is thin
                         // between them; without patches where that is none but neighbours
    bool borrowed;       // from opt->elements
} widths;

/// In the mask.
///   in     grid    a bitmap of the size wanted; the chart's grid lies pad_px inside its border
jali_status mask_widths(jali_context *ctx, const jali_adapt_options *opt, const jali_bitmap *grid,
                        int32_t pad_px, widths *w);

/// In the print: the solid grown, the void shrunk by what the printer adds.
jali_status printed_widths(jali_context *ctx, const jali_adapt_options *opt, const jali_bitmap *grid,
                           int32_t pad_px, widths *w);
void widths_free(jali_context *ctx, widths *w);

/// The search counts in sixteenths of a wrong pixel, so that an axis can weigh a fraction of one.
enum { WRONG_UNITS = 16 };
/// What a lost pixel of a detail's axis weighs, in those units, from the sizes of the printed elements there.
int64_t axis_worth_units(const jali_adapt_options *opt, bool white, int32_t solid_px, int32_t void_px);

#endif
