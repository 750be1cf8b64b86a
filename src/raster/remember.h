// What a field's last operations found. Internal to raster.
#ifndef RASTER_REMEMBER_H
#define RASTER_REMEMBER_H

#include "raster/field.h"

/// Source and result of an operation; empty when nothing is known.
typedef struct known {
    jali_bitmap src, dst;
    bool outside;
} known;

/// Where the field keeps the rule's last operation; NULL without a memory.
known *recall(const field *f, morph_rule rule);
/// Whether that was of a picture of the same size and surroundings.
bool is_known(const known *k, const jali_bitmap *src, bool outside);
void forget(jali_context *ctx, known *k);

/// An operation with the one element of a flat field; with a memory, only where src has changed.
jali_status morph_flat(jali_context *ctx, morph_rule rule, const jali_bitmap *src, const field *f,
                       bool outside, jali_bitmap *dst);

#endif
