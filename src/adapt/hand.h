// What was laid down by hand, in the finish. Internal to adapt.
#ifndef ADAPT_HAND_H
#define ADAPT_HAND_H

#include "adapt/widths.h"

/// What is fixed has the tones that are kept again.
void put_back(const jali_adapt_options *opt, jali_bitmap *mask);

#endif
