// One truth for what several stages need to know.
#ifndef AGREED_H
#define AGREED_H

#include <jali/jali.h>

/// The options of a run, or the defaults, with the printer's figures where they are wanted.
jali_options agreed_options(const jali_options *given);

/// How what is lost of a picture so many px wide is found in what was made of it, with its details kept:
/// bridges are no loss.
jali_lost_options lost_options(const jali_options *opt, const jali_chart *chart, const jali_optimised *made,
                               int32_t picture_px);

#endif
