// The elements that stand for the printer's widths. Internal to adapt.
#ifndef ADAPT_WIDTHS_H
#define ADAPT_WIDTHS_H

#include <jali/adapt.h>
#include "raster/raster.h"

/// In the mask: the narrowest solid and the narrowest void.
jali_status mask_elements(jali_context *ctx, const jali_adapt_options *opt, element *solid, element *hollow);

/// In the print: the solid grown, the void shrunk by what the printer adds.
jali_status printed_elements(jali_context *ctx, const jali_adapt_options *opt, element *solid,
                             element *hollow);

/// The search counts in sixteenths of a wrong pixel, so that an axis can weigh a fraction of one.
enum { WRONG_UNITS = 16 };
/// What a lost pixel of a detail's axis weighs, in those units, from the printed elements.
int64_t axis_worth_units(const jali_adapt_options *opt, bool white, const element *solid,
                         const element *hollow);

#endif
