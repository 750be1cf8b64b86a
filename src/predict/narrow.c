// Where voids are narrow.
//
// Model:   a void is narrow where a disc of narrow_mm does not fit into it. The corners of wide voids, where
// it does
//          not fit either, are not: they hold no disc of a printable void's width.
// Grid:    flat pictures are looked at on a coarser grid, on which the disc still spans COARSE_DISC_PX: how
// wide a
//          narrow void is at most is no sharp figure.
// Checked: tests/test_forward.c.
#include "predict/model.h"

#include <math.h>

// When the options do not say: four printable voids.
static const double NARROW_PHI_V = 4;
static const double COARSE_DISC_PX = 24;

// An element has at most 4096 px.
static const double LARGEST_DISC_PX = 4000;

// Of a printable void's width, a disc that every narrow void holds and the corners of wide ones, down to 90
// degrees, do not: there a disc of four such widths leaves room for 0.69.
static const double CORE_PHI_V = 0.85;

/// A narrowing on its coarse grid.
typedef struct coarse {
    int32_t times; // how much coarser
    jali_bitmap solid, narrow, scratch;
} coarse;

static void coarse_free(jali_context *ctx, coarse *c)
{
    jali_bitmap_free(ctx, &c->solid);
    jali_bitmap_free(ctx, &c->narrow);
    jali_bitmap_free(ctx, &c->scratch);
}

static jali_status coarse_create(jali_context *ctx, const printing *p, double narrow_px, coarse *c)
{
    jali_status status;
    int32_t width = p->solid->width_px, height = p->solid->height_px;
    c->times = is_flat(p->tiles) ? (int32_t)fmax(1, narrow_px / COARSE_DISC_PX) : 1;
    width = (width - 1) / c->times + 1;
    height = (height - 1) / c->times + 1;
    TRY(jali_bitmap_create(ctx, width, height, &c->solid));
    TRY(jali_bitmap_create(ctx, width, height, &c->narrow));
    TRY(jali_bitmap_create(ctx, width, height, &c->scratch));
    resize_nearest(ctx, p->solid, 0, 0, p->solid->width_px, p->solid->height_px, &c->solid);
done:
    return status;
}

// Drop the pieces that hold no core.
static jali_status drop_corners(jali_context *ctx, const printing *p, coarse *c)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    field disc = {0};
    components pieces = {0};
    bool *kept;
    double core_px = fmax(1, floor(CORE_PHI_V * whole_px(p, p->opt->phi_v_mm) / c->times));
    TRY(field_of_discs(ctx, p->tiles, core_px, 0, false, true, &disc));
    TRY(field_erode(ctx, &c->narrow, &disc, false, &c->scratch));
    TRY(label_components(ctx, &c->narrow, true, 4, &pieces));
    TRY(ARENA(ctx, kept, pieces.count));
    memset(kept, 0, (size_t)pieces.count * sizeof *kept);
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t y = 0; y < pieces.height_px; y++)
            for (int32_t i = pieces.first[y]; i < pieces.first[y + 1]; i++) {
                const int32_t *span = pieces.span[i];
                if (pass == 0)
                    kept[pieces.label[i]] |= count_run(&c->scratch, y, span[0], span[1]) > 0;
                else if (!kept[pieces.label[i]])
                    paint_run(&c->narrow, y, span[0], span[1], false);
            }
done:
    field_free(ctx, &disc);
    components_free(ctx, &pieces);
    arena_rewind(ctx, mark);
    return status;
}

jali_status narrow_places(jali_context *ctx, printing *p, int32_t reach_px, jali_bitmap *narrow)
{
    jali_status status;
    field disc = {0};
    coarse c = {0};
    double narrow_mm = p->opt->narrow_mm > 0 ? p->opt->narrow_mm : NARROW_PHI_V * p->opt->phi_v_mm;
    double narrow_px = fmin(whole_px(p, narrow_mm), LARGEST_DISC_PX);
    TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, narrow));
    TRY(coarse_create(ctx, p, narrow_px, &c));
    TRY(field_of_discs(ctx, p->tiles, floor(narrow_px / c.times), 0, false, true, &disc));
    TRY(field_close(ctx, &c.solid, &disc, p->outside, &c.scratch, &c.narrow));
    combine(ctx, RULE_AND_NOT, &c.narrow, &c.solid, &c.narrow);
    TRY(drop_corners(ctx, p, &c));
    resize_nearest(ctx, &c.narrow, 0, 0, c.narrow.width_px, c.narrow.height_px, &p->scratch);
    TRY(move_edges(ctx, p, &p->scratch, reach_px + c.times - 1, false, narrow));
done:
    field_free(ctx, &disc);
    coarse_free(ctx, &c);
    return status;
}
