// The nearest pixel of any other part, for a large one, by several threads. Internal to connect.
#ifndef CONNECT_SLICES_H
#define CONNECT_SLICES_H

#include "connect/search.h"

enum { MOST_SLICES = 16 };

/// Some rows of a part.
typedef struct slice {
    int32_t box[4];
    window w; // around them
    growing g;
    bool met;
    int32_t to[2]; // what it met
} slice;

/// Scratch of the search. {0} is valid and empty.
typedef struct slices {
    slice each[MOST_SLICES];
    int32_t count;
    plane own; // the part alone
} slices;

/// How many slices the part is worth; 1: nearest_other is as fast.
int32_t slices_of(jali_context *ctx, const parts *p, int32_t root);

/// As nearest_other. What is found does not depend on the number of slices.
jali_status nearest_by_slices(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                              jali_metric metric, slices *s, jali_bridge *bridge);
void slices_free(jali_context *ctx, slices *s);

#endif
