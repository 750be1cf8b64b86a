// What of a picture a print does not show: whole parts, and stretches of fine lines.
//
// Both are features of the picture alone, at its own resolution, so that two sizes of one picture can be
// compared: the share of lost pixels never comes to nothing, since edges are smoothed and bridges must cross
// voids.
//
// Limits:  a part counts as shown when one pixel's centre of it prints; its shape is the error rate's
// subject. Checked: tests/test_smallest.c: drawn dots, gaps, hairs and bridges.
#include "predict/model.h"

typedef struct search {
    jali_lost_options opt;
    const jali_bitmap *printed; // at the picture's own resolution
    const jali_bitmap *spared;  // likewise: where solid is no loss of void
    jali_bitmap *where;
} search;

jali_lost_options jali_lost_defaults(void)
{
    return (jali_lost_options){.least_px = 8};
}

void jali_lost_free(jali_context *ctx, jali_lost *lost)
{
    jali_bitmap_free(ctx, &lost->where);
    *lost = (jali_lost){0};
}

// What is known of a component as its runs go by.
typedef struct tally {
    int64_t area, shown;
    int32_t x0, x1, y0, y1;
} tally;

static jali_status tally_up(jali_context *ctx, const components *c, const jali_bitmap *shown, bool white,
                            tally **each)
{
    tally *t;
    jali_status status = ARENA(ctx, t, c->count);
    if (status != JALI_OK) return status;
    for (int32_t k = 0; k < c->count; k++) t[k] = (tally){0, 0, INT32_MAX, 0, INT32_MAX, 0};
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++) {
            tally *one = &t[c->label[i]];
            int32_t x0 = c->span[i][0], x1 = c->span[i][1], solid = shown ? count_run(shown, y, x0, x1) : 0;
            one->area += x1 - x0;
            one->shown += white ? solid : x1 - x0 - solid;
            one->x0 = MIN(one->x0, x0);
            one->x1 = MAX(one->x1, x1);
            one->y0 = MIN(one->y0, y);
            one->y1 = y + 1;
        }
    *each = t;
    return JALI_OK;
}

// Count the components that are lost and paint them into `where`.
static void count_lost(const components *c, const bool *lost, jali_bitmap *where, int32_t *count)
{
    *count = 0;
    for (int32_t k = 0; k < c->count; k++) *count += lost[k];
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            if (lost[c->label[i]]) paint_run(where, y, c->span[i][0], c->span[i][1], true);
}

// Parts of a tone of which nothing prints.
static jali_status count_parts(jali_context *ctx, const search *s, const components *c, bool white,
                               int32_t *count)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    tally *t;
    bool *lost;
    TRY(tally_up(ctx, c, s->printed, white, &t));
    TRY(ARENA(ctx, lost, c->count));
    for (int32_t k = 0; k < c->count; k++) lost[k] = t[k].area >= s->opt.least_px && t[k].shown == 0;
    count_lost(c, lost, s->where, count);
done:
    arena_rewind(ctx, mark);
    return status;
}

// Stretches that are long enough; the axis of an even width is two pixels wide.
static jali_status count_stretches(jali_context *ctx, const search *s, const components *c, int32_t *count)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    tally *t;
    bool *lost;
    TRY(tally_up(ctx, c, NULL, false, &t));
    TRY(ARENA(ctx, lost, c->count));
    for (int32_t k = 0; k < c->count; k++)
        lost[k] = MAX(t[k].x1 - t[k].x0, t[k].y1 - t[k].y0) >= s->opt.least_px;
    count_lost(c, lost, s->where, count);
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status look_at_tone(jali_context *ctx, const search *s, const jali_bitmap *picture,
                                const jali_bitmap *axis, bool white, jali_lost_tone *tone)
{
    jali_status status;
    components parts = {0}, stretches = {0};
    jali_bitmap gone = {0};
    TRY(label_components(ctx, picture, white, white ? 4 : 8, &parts));
    TRY(count_parts(ctx, s, &parts, white, &tone->parts));
    TRY(jali_bitmap_copy(ctx, axis, &gone));
    combine(ctx, white ? RULE_AND_NOT : RULE_AND, axis, s->printed, &gone);
    if (!white) combine(ctx, RULE_AND_NOT, &gone, s->spared, &gone);
    combine(ctx, RULE_AND_NOT, &gone, s->where, &gone);
    TRY(label_components(ctx, &gone, true, 8, &stretches));
    TRY(count_stretches(ctx, s, &stretches, &tone->stretches));
done:
    components_free(ctx, &parts);
    components_free(ctx, &stretches);
    jali_bitmap_free(ctx, &gone);
    return status;
}

// Where solid is no loss of void: the bridges at the picture's own resolution, as wide as they come out and a
// pixel more, and as much along the border, into which a frame grows.
static jali_status find_spared(jali_context *ctx, const jali_lost_options *opt, jali_bitmap *spared)
{
    jali_status status;
    jali_bitmap drawn = {0};
    element around = {0};
    const jali_bitmap *from = opt->bridges;
    int32_t margin = opt->margin_px;
    if (from) {
        TRY(jali_bitmap_create(ctx, spared->width_px, spared->height_px, &drawn));
        resize_nearest(ctx, from, margin, margin, from->width_px - 2 * margin, from->height_px - 2 * margin,
                       &drawn);
        TRY(element_square(ctx, 2 * opt->reach_px + 3, &around));
        TRY(dilate(ctx, &drawn, &around, false, spared));
    }
    for (int32_t y = 0; y < spared->height_px; y++) {
        int32_t edge = opt->reach_px + 1, width = spared->width_px;
        bool inside = y >= edge && y < spared->height_px - edge && width > 2 * edge;
        paint_run(spared, y, 0, inside ? edge : width, true);
        if (inside) paint_run(spared, y, width - edge, width, true);
    }
    status = JALI_OK;
done:
    element_free(ctx, &around);
    jali_bitmap_free(ctx, &drawn);
    return status;
}

jali_status jali_find_lost(jali_context *ctx, const jali_reference *reference, const jali_prediction *print,
                           const jali_lost_options *given, jali_lost *lost)
{
    jali_status status;
    jali_bitmap picture = {0}, printed = {0}, spared = {0};
    search s = {given ? *given : jali_lost_defaults(), &printed, &spared, &lost->where};
    int32_t width = reference->axis_white.width_px, height = reference->axis_white.height_px;
    const jali_bitmap *fine = &reference->picture;
    *lost = (jali_lost){0};
    if (width == 0 || print->printed.width_px != fine->width_px ||
        print->printed.height_px != fine->height_px)
        return fail(ctx, JALI_BAD_VALUE,
                    "what is lost is found by a reference with its axes and a print of it");
    if (s.opt.least_px < 1 || s.opt.reach_px < 0 || s.opt.margin_px < 0)
        return fail(ctx, JALI_BAD_VALUE, "details are counted from %d px on; 1 px and more is accepted",
                    s.opt.least_px);
    TRY(jali_bitmap_create(ctx, width, height, &picture));
    TRY(jali_bitmap_create(ctx, width, height, &printed));
    TRY(jali_bitmap_create(ctx, width, height, &lost->where));
    resize_nearest(ctx, fine, 0, 0, fine->width_px, fine->height_px, &picture);
    resize_nearest(ctx, &print->printed, 0, 0, fine->width_px, fine->height_px, &printed);
    TRY(jali_bitmap_create(ctx, width, height, &spared));
    TRY(find_spared(ctx, &s.opt, &spared));
    TRY(look_at_tone(ctx, &s, &picture, &reference->axis_white, true, &lost->white));
    TRY(look_at_tone(ctx, &s, &picture, &reference->axis_black, false, &lost->black));
done:
    if (status != JALI_OK) jali_lost_free(ctx, lost);
    jali_bitmap_free(ctx, &picture);
    jali_bitmap_free(ctx, &printed);
    jali_bitmap_free(ctx, &spared);
    return status;
}
