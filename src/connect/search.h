// The nearest pixel of any other part, for a small one. Internal to connect.
#ifndef CONNECT_SEARCH_H
#define CONNECT_SEARCH_H

#include "connect/grow.h"

enum { FIRST_RIM_PX = 14, SECOND_RIM_PX = 56 };

/// The rim after one that was too narrow: twice as wide, for a window's pixels grow with its square.
static inline int32_t wider_rim(int32_t rim_px)
{
    return rim_px < SECOND_RIM_PX ? SECOND_RIM_PX : 2 * rim_px;
}

/// Scratch of the search. {0} is valid and empty.
typedef struct search {
    growing g;        // its steps: to what was found last
    plane own;        // the part alone
    int32_t near_rim; // as far as nearest_near looks
    int32_t rim;      // of the window that it is in
} search;

/// Find the white pixel outside the part `root` that is nearest to it, and the part's pixel nearest to that.
///   in     solid     the picture with all bridges so far; holds at least two parts
///   fails  JALI_NO_MEMORY, JALI_CANCELLED
jali_status nearest_other(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                          jali_metric metric, search *s, jali_bridge *bridge);

/// The same among what lies near, in scratch that is there: for threads, which allocate nothing.
///   out    false: nothing is so near, or the run was cancelled
bool nearest_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                  jali_metric metric, search *s, jali_bridge *bridge);
/// Go on where nearest_near has found nothing; the part and what lies that near are as they were.
jali_status nearest_further(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                            jali_metric metric, search *s, jali_bridge *bridge);
/// Get the scratch for nearest_near, and s->near_rim: how near; 0 where the part is too large.
jali_status make_room_near(jali_context *ctx, const jali_bitmap *solid, const parts *p, int32_t root,
                           search *s);
void search_free(jali_context *ctx, search *s);

#endif
