// The order in which points enter a triangulation.
#ifndef PLANE_ORDER_H
#define PLANE_ORDER_H

#include "base/base.h"

/// A biased randomised insertion order: rounds that double in size, each along a Hilbert curve.
///   in     point   [count]
///   out    order   [count], a permutation of 0 .. count-1; the same for the same count and points
///   fails  JALI_NO_MEMORY
///   cost   O(count) time and scratch
jali_status insertion_order(jali_context *ctx, const int32_t (*point)[2], int32_t count, int32_t *order);

#endif
