// Strokes of bridges, and where none may run.
//
// A stroke of a bridge sets the solid's element on each pixel of its way. So a way is blocked where an
// element would cover a closed pixel that is black: on a part, and inside thick solid, one may go anywhere.
// Checked: tests/test_edits.c.
#include "adapt/hand.h"
#include "base/base.h"

void put_back(const jali_adapt_options *opt, jali_bitmap *mask)
{
    if (!opt->fixed) return;
    for (int64_t i = 0; i < mask->stride * mask->height_px; i++)
        mask->word[i] ^= (mask->word[i] ^ opt->kept->word[i]) & opt->fixed->word[i];
}

// Paint a bridge's stroke; returns how many black pixels it covers.
static int32_t paint_bridge(const jali_bridges *bridges, int32_t i, const field *brush, jali_bitmap *dst)
{
    int32_t from[2], to[2], covered = 0;
    for (int32_t leg = 0; jali_bridge_leg(bridges, i, leg, from, to); leg++) {
        line_walk walk = walk_line(from, to);
        do covered += cover_patch(dst, walk.x, walk.y, patch_at(brush, walk.x, walk.y));
        while (walk_on(&walk));
    }
    return covered;
}

jali_status jali_adapt_strokes(jali_context *ctx, jali_bridges *bridges, const jali_adapt_options *opt,
                               bool in_print, jali_bitmap *dst)
{
    widths w = {0};
    jali_status status = in_print ? printed_widths(ctx, opt, dst, 0, &w) : mask_widths(ctx, opt, dst, 0, &w);
    for (int32_t i = 0; status == JALI_OK && i < bridges->count; i++) {
        bridges->bridge[i].pixels = paint_bridge(bridges, i, &w.solid, dst);
        if (stopping(ctx)) status = step(ctx, "finish", 0);
    }
    widths_free(ctx, &w);
    return status;
}

jali_status jali_adapt_blocked(jali_context *ctx, const jali_adapt_options *opt, bool in_print,
                               const jali_bitmap *picture, jali_bitmap *blocked)
{
    jali_status status;
    widths w = {0};
    jali_bitmap open = {0};
    *blocked = (jali_bitmap){0};
    TRY(in_print ? printed_widths(ctx, opt, picture, 0, &w) : mask_widths(ctx, opt, picture, 0, &w));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, blocked));
    TRY(jali_bitmap_create(ctx, picture->width_px, picture->height_px, &open));
    invert(ctx, opt->closed, &open);
    combine(ctx, RULE_OR, &open, picture, &open);
    TRY(field_erode(ctx, &open, &w.solid, true, blocked));
    invert(ctx, blocked, blocked);
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, blocked);
    jali_bitmap_free(ctx, &open);
    widths_free(ctx, &w);
    return status;
}

jali_status jali_adapt_take_off(jali_context *ctx, const jali_bitmap *off, const jali_bitmap *others,
                                const jali_adapt_options *opt, jali_bitmap *mask)
{
    jali_status status;
    widths w = {0};
    jali_bitmap covered = {0}, needed = {0};
    TRY(mask_widths(ctx, opt, mask, 0, &w));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, &covered));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, &needed));
    TRY(field_dilate(ctx, off, &w.solid, false, &covered));
    TRY(field_dilate(ctx, others, &w.solid, false, &needed));
    combine(ctx, RULE_AND_NOT, &covered, &needed, &covered);
    combine(ctx, RULE_AND_NOT, mask, &covered, mask);
    put_back(opt, mask);
done:
    jali_bitmap_free(ctx, &covered);
    jali_bitmap_free(ctx, &needed);
    widths_free(ctx, &w);
    return status;
}
