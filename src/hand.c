// Edits by hand, for the image method: what is drawn, what is fixed, and which pieces nothing may join.
//
// A drawn bridge becomes part of the drawing, as wide as it prints, so that every stage sees it; in the mask
// it is the same less what the printer adds, and stays. What is locked stays as the drawing has it. Pieces
// that no bridge may reach are taken off, for the object must be one; locked and drawn ones stay all the
// same, and then it is said that it is not one.
// Checked: tests/test_edits.c.
#include "hand.h"
#include "raster/raster.h"
#include "base/base.h"

void hand_free(jali_context *ctx, hand *h)
{
    jali_marks_free(ctx, &h->marks);
    jali_bitmap_free(ctx, &h->drawn);
    jali_bitmap_free(ctx, &h->drawn_print);
    jali_bitmap_free(ctx, &h->picture);
    jali_bitmap_free(ctx, &h->fixed);
    jali_bitmap_free(ctx, &h->kept);
    *h = (hand){0};
}

// The drawn bridges as they come out, and the mask that makes them so.
static jali_status draw_bridges(jali_context *ctx, const jali_compensate_options *compensate,
                                const jali_adapt_options *widths, hand *h)
{
    jali_status status;
    TRY(jali_bitmap_copy(ctx, &h->marks.wide, &h->drawn_print));
    TRY(jali_adapt_strokes(ctx, &h->marks.drawn, widths, true, &h->drawn_print));
    TRY(jali_compensate(ctx, &h->drawn_print, compensate, &h->drawn));
    TRY(jali_adapt_strokes(ctx, &h->marks.drawn, widths, false, &h->drawn));
done:
    return status;
}

jali_status hand_create(jali_context *ctx, const jali_edits *edits, const jali_chart *chart,
                        const jali_compensate_options *compensate, const jali_bitmap *tones,
                        jali_adapt_options *widths, hand *h)
{
    jali_status status;
    *h = (hand){0};
    if (!edits || edits->count == 0) return JALI_OK;
    h->any = true;
    TRY(jali_edits_draw(ctx, edits, chart, &h->marks));
    TRY(draw_bridges(ctx, compensate, widths, h));
    TRY(jali_bitmap_copy(ctx, tones, &h->picture));
    combine(ctx, RULE_OR, &h->picture, &h->drawn_print, &h->picture);
    TRY(jali_bitmap_copy(ctx, &h->marks.locked, &h->fixed));
    combine(ctx, RULE_OR, &h->fixed, &h->drawn, &h->fixed);
    TRY(jali_bitmap_copy(ctx, tones, &h->kept));
    combine(ctx, RULE_OR, &h->kept, &h->drawn, &h->kept);
    combine(ctx, RULE_AND, &h->kept, &h->fixed, &h->kept);
    widths->fixed = &h->fixed;
    widths->kept = &h->kept;
    widths->closed = &h->marks.closed;
done:
    if (status != JALI_OK) hand_free(ctx, h);
    return status;
}

void hand_keep(jali_context *ctx, const hand *h, bool in_print, jali_bitmap *picture)
{
    if (!h->any) return;
    const jali_bitmap *where = in_print ? &h->marks.locked : &h->fixed,
                      *tones = in_print ? &h->picture : &h->kept;
    for (int64_t i = 0; i < picture->stride * picture->height_px; i++)
        picture->word[i] ^= (picture->word[i] ^ tones->word[i]) & where->word[i];
    if (in_print) combine(ctx, RULE_OR, picture, &h->drawn_print, picture);
}

// Of each piece, whether a pixel of it is fixed.
static void find_fixed(const hand *h, const components *c, bool *fixed)
{
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            if (count_run(&h->fixed, y, c->span[i][0], c->span[i][1]) > 0) fixed[c->label[i]] = true;
}

static int32_t main_piece(const components *c, const int64_t *area, bool outside_solid)
{
    int32_t largest = 0, corner = outside_solid ? run_at(c, 0, 0) : -1;
    if (corner >= 0) return c->label[corner];
    for (int32_t i = 1; i < c->count; i++)
        if (area[i] > area[largest]) largest = i;
    return largest;
}

// Count the pieces, by their first pixels in raster order.
static void count_pieces(const components *c, int32_t main, const bool *fixed, bool last, jali_edited *edited)
{
    int32_t next = 0;
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++) {
            if (c->label[i] != next) continue;
            next++;
            if (c->label[i] == main || (fixed[c->label[i]] && !last)) continue;
            int32_t *count = fixed[c->label[i]] ? &edited->loose : &edited->left_out;
            int32_t *at = fixed[c->label[i]] ? edited->loose_at : edited->left_out_at;
            if ((*count)++ > 0) continue;
            at[0] = c->span[i][0];
            at[1] = y;
        }
}

jali_status hand_find_loose(jali_context *ctx, const hand *h, const jali_bitmap *pieces, bool outside_solid,
                            bool last, jali_bitmap *off, jali_edited *edited)
{
    jali_status status;
    components c = {0};
    int64_t *area = NULL;
    bool *fixed = NULL;
    *off = (jali_bitmap){0};
    TRY(label_components(ctx, pieces, true, 4, &c));
    if (c.count < 2) goto done;
    TRY(component_areas(ctx, &c, &area));
    TRY(ALLOCATE_CLEARED(ctx, fixed, c.count));
    TRY(jali_bitmap_create(ctx, pieces->width_px, pieces->height_px, off));
    int32_t main = main_piece(&c, area, outside_solid);
    find_fixed(h, &c, fixed);
    for (int32_t y = 0; y < c.height_px; y++)
        for (int32_t i = c.first[y]; i < c.first[y + 1]; i++)
            if (c.label[i] != main && !fixed[c.label[i]]) paint_run(off, y, c.span[i][0], c.span[i][1], true);
    count_pieces(&c, main, fixed, last, edited);
done:
    components_free(ctx, &c);
    release(ctx, area);
    release(ctx, fixed);
    return status;
}

static bool touches(const jali_bitmap *a, const components *c, int32_t y, int32_t run, int32_t reach)
{
    int32_t x0 = MAX(c->span[run][0] - reach, 0), x1 = MIN(c->span[run][1] + reach, a->width_px);
    for (int32_t v = MAX(y - reach, 0); v <= MIN(y + reach, a->height_px - 1); v++)
        if (count_run(a, v, x0, x1) > 0) return true;
    return false;
}

jali_status hand_count_locked(jali_context *ctx, const hand *h, const jali_details *details, bool white,
                              int32_t reach_px, int32_t *count)
{
    jali_status status = JALI_OK;
    components c = {0};
    bool *near = NULL;
    for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++) {
        TRY(label_components(ctx, &details->type[type], true, white ? 4 : 8, &c));
        TRY(ALLOCATE_CLEARED(ctx, near, c.count));
        for (int32_t y = 0; y < c.height_px; y++)
            for (int32_t i = c.first[y]; i < c.first[y + 1]; i++)
                near[c.label[i]] = near[c.label[i]] || touches(&h->marks.locked, &c, y, i, reach_px);
        for (int32_t i = 0; i < c.count; i++) *count += near[i];
        components_free(ctx, &c);
        release(ctx, near);
        near = NULL;
    }
done:
    components_free(ctx, &c);
    release(ctx, near);
    return status;
}
