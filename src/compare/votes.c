// What the readers of layers share: which layers count, and the majority of them.
//
// Votes are counted in bit planes: adding one is a ripple of half adders over whole words.
//
// Checked: tests/test_gcode.c and tests/test_sl1.c.
#include "compare/votes.h"
#include "base/base.h"
#include "raster/raster.h"

#include <math.h>

void jali_print_free(jali_context *ctx, jali_print *print)
{
    jali_bitmap_free(ctx, &print->solid);
    *print = (jali_print){0};
}

jali_print_options jali_print_defaults(void)
{
    return (jali_print_options){.pixel_mm = 0.02, .filament_mm = 1.75};
}

void choose_middle(int32_t layers, jali_print *print)
{
    print->layers = layers;
    print->first = layers / 4;
    print->last = MAX(print->first, (int32_t)((3 * (int64_t)layers + 3) / 4) - 1);
    print->looked_at = MIN(print->last - print->first + 1, MOST_LOOKED_AT);
}

int32_t looked_at(const jali_print *print, int32_t i)
{
    int64_t middle = print->last - print->first + 1;
    return print->first + (int32_t)((2 * i + 1) * middle / (2 * print->looked_at));
}

jali_status votes_create(jali_context *ctx, int32_t width_px, int32_t height_px, layer_votes *votes)
{
    jali_status status = JALI_OK;
    *votes = (layer_votes){0};
    for (int32_t i = 0; i < VOTE_PLANES; i++)
        TRY(jali_bitmap_create(ctx, width_px, height_px, &votes->plane[i]));
done:
    if (status != JALI_OK) votes_free(ctx, votes);
    return status;
}

void votes_free(jali_context *ctx, layer_votes *votes)
{
    for (int32_t i = 0; i < VOTE_PLANES; i++) jali_bitmap_free(ctx, &votes->plane[i]);
    *votes = (layer_votes){0};
}

void vote(jali_context *ctx, layer_votes *votes, jali_bitmap *bitmap)
{
    for (int32_t i = 0; i < VOTE_PLANES; i++) { // what the sum does not keep is carried
        combine(ctx, RULE_XOR, &votes->plane[i], bitmap, &votes->plane[i]);
        combine(ctx, RULE_AND_NOT, bitmap, &votes->plane[i], bitmap);
    }
    votes->count++;
}

// Compare with half of the votes from the highest bit on: `equal` is where no bit has decided yet.
jali_status votes_majority(jali_context *ctx, layer_votes *votes, jali_bitmap *majority)
{
    jali_status status;
    jali_bitmap equal = {0};
    const jali_bitmap *size = &votes->plane[0];
    int32_t half = votes->count / 2;
    TRY(jali_bitmap_create(ctx, size->width_px, size->height_px, majority));
    TRY(jali_bitmap_create(ctx, size->width_px, size->height_px, &equal));
    fill(ctx, &equal, true);
    for (int32_t i = VOTE_PLANES - 1; i >= 0; i--) {
        jali_bitmap *plane = &votes->plane[i];
        if (half >> i & 1) {
            combine(ctx, RULE_AND, &equal, plane, &equal);
        } else {
            combine(ctx, RULE_AND, plane, &equal, plane);
            combine(ctx, RULE_OR, majority, plane, majority);
            combine(ctx, RULE_AND_NOT, &equal, plane, &equal);
        }
    }
done:
    jali_bitmap_free(ctx, &equal);
    return status;
}

bool white_box(const jali_bitmap *a, int32_t low[2], int32_t high[2])
{
    low[0] = low[1] = INT32_MAX;
    high[0] = high[1] = 0;
    for (int32_t y = 0; y < a->height_px; y++) {
        const uint64_t *row = a->word + (int64_t)y * a->stride;
        int32_t x = next_white(row, 0, a->width_px, 0);
        if (x == a->width_px) continue;
        low[0] = MIN(low[0], x);
        for (int64_t i = a->stride - 1;; i--) {
            if (row[i] == 0) continue;
            high[0] = MAX(high[0], (int32_t)(64 * i) + 64 - __builtin_clzll(row[i]));
            break;
        }
        low[1] = MIN(low[1], y);
        high[1] = y + 1;
    }
    return high[1] > 0;
}

void measure_print(jali_print *print)
{
    int32_t low[2], high[2];
    bool any = white_box(&print->solid, low, high);
    for (int k = 0; k < 2; k++) print->size_mm[k] = any ? (high[k] - low[k]) * print->pixel_mm[k] : 0;
}
