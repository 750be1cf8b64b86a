// The four sides of a flat thing in a scan. Internal.
#ifndef SCAN_OUTLINE_H
#define SCAN_OUTLINE_H

#include "scan/grey.h"

/// The four lines nearest around the largest white piece of a bitmap: its convex hull with sides taken away,
/// each time the one that costs the least area, until four are left.
///   out    corner   in turn, counter-clockwise as seen with y down; in the bitmap's pixels
///          found    false when nothing white has an area
///   cost   O(pixels + sides^2)
jali_status outline_of_bitmap(jali_context *ctx, const jali_bitmap *bitmap, double corner[4][2], bool *found);

/// The same of whatever differs most from its surroundings: from the smooth light that fits the border.
///   in     g   a scan, or a picture of what it should be
jali_status outline_of_grey(jali_context *ctx, const grey *g, double corner[4][2], bool *found);

#endif
