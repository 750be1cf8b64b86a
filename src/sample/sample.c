// The built-in pictures: a table of names, a board, a fill.
//
// Checked: tests/test_sample.c.
#include <jali/sample.h>
#include "sample/samples.h"

enum { LEAST_SIDE_PX = 16, MOST_SIDE_PX = 32768 };

// The lists below stand in the same order.
static const jali_sample_info infos[] = {
    {"girih", "a lattice of twelve-fold stars, its straps woven over and under"},
    {"tree", "a tree with leaves in a round window, a moon and falling leaves"},
    {"mask", "a lion's head cut from paper, its mane in loose lobes"},
    {"lettering", "pen lettering: counters that fall out, hairlines, small text"},
    {"sunflower", "seeds in the golden angle, every one an island"},
    {"spiral", "six arms that narrow towards the middle, with loose beads"},
    {"rings", "rings within rings, each an island"},
    {"halftone", "a lit ball in dots, finer than any printer"},
    {"stripes", "stripes whose pitch falls from 40 to 2 thousandths of the side"},
    {"checkerboard", "squares that touch at their corners only"},
};

static draw_sample *const draws[] = {
    draw_girih,  draw_tree,  draw_mask,     draw_lettering, draw_sunflower,
    draw_spiral, draw_rings, draw_halftone, draw_stripes,   draw_checkerboard,
};

enum { SAMPLE_COUNT = sizeof infos / sizeof *infos };
_Static_assert(sizeof draws / sizeof *draws == SAMPLE_COUNT, "each sample has a name and a drawing");

const jali_sample_info *jali_sample_list(int32_t *count)
{
    *count = SAMPLE_COUNT;
    return infos;
}

static jali_status unknown_name(jali_context *ctx, const char *name)
{
    char names[256] = "";
    for (int32_t i = 0; i < SAMPLE_COUNT; i++) {
        if (i > 0) strcat(names, i + 1 < SAMPLE_COUNT ? ", " : " and ");
        strcat(names, infos[i].name);
    }
    return fail(ctx, JALI_BAD_VALUE, "there is no sample \"%.40s\"; there are %s", name, names);
}

jali_status jali_sample(jali_context *ctx, const char *name, int32_t side_px, jali_bitmap *bitmap)
{
    jali_status status;
    int32_t i = 0;
    board b = {.ctx = ctx, .seed = 1};
    *bitmap = (jali_bitmap){0};
    while (i < SAMPLE_COUNT && strcmp(infos[i].name, name) != 0) i++;
    if (i == SAMPLE_COUNT) return unknown_name(ctx, name);
    if (side_px < LEAST_SIDE_PX || side_px > MOST_SIDE_PX)
        return fail(ctx, JALI_BAD_VALUE, "a sample's side must be %d .. %d px, not %d", LEAST_SIDE_PX,
                    MOST_SIDE_PX, side_px);
    draws[i](&b);
    TRY(jali_bitmap_create(ctx, side_px, side_px, bitmap));
    TRY(rasterise_board(&b, bitmap));
done:
    release(ctx, b.point);
    release(ctx, b.shape);
    if (status != JALI_OK) jali_bitmap_free(ctx, bitmap);
    return status;
}
