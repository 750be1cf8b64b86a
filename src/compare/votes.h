// What the readers of layers share: which layers count, and the majority of them. Internal to compare.
#ifndef COMPARE_VOTES_H
#define COMPARE_VOTES_H

#include <jali/compare.h>

enum { VOTE_PLANES = 4, MOST_LOOKED_AT = 15 }; // so many votes fit four bits

/// Of so many layers those between a quarter and three quarters count, 15 of them at most: fills in layers,
/// first, last, looked_at.
void choose_middle(int32_t layers, jali_print *print);
/// The i-th layer to look at, of looked_at.
int32_t looked_at(const jali_print *print, int32_t i);

/// How many of some bitmaps are white at each pixel. {0} is valid and empty.
typedef struct layer_votes {
    int32_t count;
    jali_bitmap plane[VOTE_PLANES]; // the number's bits, the lowest first
} layer_votes;

jali_status votes_create(jali_context *ctx, int32_t width_px, int32_t height_px, layer_votes *votes);
void votes_free(jali_context *ctx, layer_votes *votes);
/// One more bitmap, of MOST_LOOKED_AT; it is used up.
void vote(jali_context *ctx, layer_votes *votes, jali_bitmap *bitmap);
/// Where more than half of them are white; the votes are used up.
jali_status votes_majority(jali_context *ctx, layer_votes *votes, jali_bitmap *majority);

/// The box around what is white, high exclusive; false when nothing is.
bool white_box(const jali_bitmap *a, int32_t low[2], int32_t high[2]);
/// Fill in size_mm: the box around what is white.
void measure_print(jali_print *print);

#endif
