// Words that people type: the one they may have meant.
#ifndef BASE_WORDS_H
#define BASE_WORDS_H

#include "base/base.h"

/// The name in the list that is nearest to what was typed (fewest letters put in, left out or changed); NULL
/// when none is near.
const char *nearest_name(const char *typed, const char *const *name, int32_t count);

#endif
