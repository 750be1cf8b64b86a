// Searches made before it is their turn, side by side. Internal to connect.
#ifndef CONNECT_AHEAD_H
#define CONNECT_AHEAD_H

#include "connect/slices.h"

enum { AHEAD = 16 };

/// What a part's search found, as the picture was after `laid` bridges; root < 0: nothing.
typedef struct foresight {
    int32_t root, laid;
    int64_t area;
    bool found;
    jali_bridge bridge;
    search s;
} foresight;

typedef struct ahead {
    foresight each[AHEAD];
    search own;                        // of a part that was not foreseen
    slices large;                      // of one that is searched for in slices
    int32_t asked[AHEAD], asked_count; // those that are searched for now
    jali_context *ctx;
    const jali_bitmap *solid;
    parts *p;
    jali_metric metric;
} ahead;

/// Nothing is searched for yet; what is passed stays the caller's and is looked at by each search.
void ahead_create(jali_context *ctx, const jali_bitmap *solid, parts *p, jali_metric metric, ahead *a);
void ahead_free(ahead *a);

/// As nearest_other, for the part whose turn it is; those whose turns come next are searched for at the same
/// time. What is found is the same for any number of threads.
///   in     laid      the bridges laid so far
///   fails  JALI_NO_MEMORY, JALI_CANCELLED
jali_status nearest_in_turn(ahead *a, int32_t root, const jali_bridges *laid, jali_bridge *bridge);

#endif
