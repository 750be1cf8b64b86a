// Corners: what is drawn sharp comes out round, thin features apart.
//
// Model:   an opening by a disc of radius corner_mm takes off the slivers of convex corners, and with them
// all
//          that is narrower than the disc. Of the pieces it takes off, those that are features go back. The
//          same of the complement rounds the other corners.
// Limits:  the ends of bars narrower than 2 corner_mm stay as they are; corners sharper than 60 degrees may.
// Checked: tests/test_forward.c.
#include "predict/model.h"

#include <math.h>

// Which runs touch: the label of a piece's neighbours among the rings, or TOUCHES_MORE than one.
enum { TOUCHES_NONE = -1, TOUCHES_MORE = -2 };

static void note_contacts(const components *rings, int32_t y, int32_t x0, int32_t x1, int32_t *contact)
{
    if (y < 0 || y >= rings->height_px) return;
    int32_t low = rings->first[y], high = rings->first[y + 1];
    while (low < high) { // the first run that ends behind x0
        int32_t middle = low + (high - low) / 2;
        if (rings->span[middle][1] <= x0)
            low = middle + 1;
        else
            high = middle;
    }
    for (int32_t i = low; i < rings->first[y + 1] && rings->span[i][0] < x1; i++)
        *contact = *contact == TOUCHES_NONE || *contact == rings->label[i] ? rings->label[i] : TOUCHES_MORE;
}

/// What an opening took off, piece by piece.
typedef struct slivers {
    components pieces;
    components rings; // of what it left, the pixels beside them
    int32_t *contact; // [pieces.count]
    bool *kept;       // [pieces.count]
} slivers;

static jali_status find_slivers(jali_context *ctx, const printing *p, const jali_bitmap *lost,
                                const jali_bitmap *opened, slivers *s)
{
    jali_status status;
    element square = {0};
    jali_bitmap ring = {0};
    TRY(jali_bitmap_create(ctx, lost->width_px, lost->height_px, &ring));
    TRY(element_square(ctx, 3, &square));
    TRY(dilate(ctx, lost, &square, p->outside, &ring));
    combine(ctx, RULE_AND, &ring, opened, &ring);
    TRY(label_components(ctx, lost, true, 4, &s->pieces));
    TRY(label_components(ctx, &ring, true, 4, &s->rings));
    TRY(ARENA(ctx, s->contact, s->pieces.count));
    TRY(ARENA(ctx, s->kept, s->pieces.count));
    for (int32_t i = 0; i < s->pieces.count; i++) {
        s->contact[i] = TOUCHES_NONE;
        s->kept[i] = false;
    }
done:
    element_free(ctx, &square);
    jali_bitmap_free(ctx, &ring);
    return status;
}

// Of the pieces that an opening took off, put those back that hold a thin feature: a disc almost as wide as
// the narrowest bar; and necks, which touch what is left in two places. The slivers of corners do neither.
static jali_status keep_thin_features(jali_context *ctx, const printing *p, const jali_bitmap *lost,
                                      double thin_mm, jali_bitmap *opened)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    field disc = {0};
    slivers s = {0};
    jali_bitmap core = {0};
    TRY(disc_that_fits(ctx, p, thin_mm * 3 / 4, &disc));
    TRY(jali_bitmap_create(ctx, lost->width_px, lost->height_px, &core));
    TRY(field_erode(ctx, lost, &disc, false, &core));
    TRY(find_slivers(ctx, p, lost, opened, &s));
    const components *c = &s.pieces;
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++) {
            int32_t x0 = c->span[i][0], x1 = c->span[i][1], *contact = &s.contact[c->label[i]];
            for (int32_t row = y - 1; row <= y + 1; row++)
                note_contacts(&s.rings, row, x0 - 1, x1 + 1, contact);
            s.kept[c->label[i]] |= *contact == TOUCHES_MORE || count_run(&core, y, x0, x1) > 0;
        }
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            if (s.kept[c->label[i]]) paint_run(opened, y, c->span[i][0], c->span[i][1], true);
done:
    field_free(ctx, &disc);
    components_free(ctx, &s.pieces);
    components_free(ctx, &s.rings);
    jali_bitmap_free(ctx, &core);
    arena_rewind(ctx, mark);
    return status;
}

// Take off what a disc does not reach, thin features apart.
static jali_status open_all_but_thin(jali_context *ctx, printing *p, double diameter_mm, double thin_mm,
                                     jali_bitmap *opened)
{
    jali_status status;
    field disc = {0};
    TRY(step(ctx, "predict", 0));
    TRY(disc_that_fits(ctx, p, diameter_mm, &disc));
    TRY(field_open(ctx, p->solid, &disc, p->outside, &p->scratch, opened));
    combine(ctx, RULE_AND_NOT, p->solid, opened, &p->scratch);
    TRY(keep_thin_features(ctx, p, &p->scratch, thin_mm, opened));
    swap_bitmaps(p->solid, opened);
done:
    field_free(ctx, &disc);
    return status;
}

// Round what sticks out of the white to corner_mm. Corners have half of the narrowest bar's width as their
// radius already; from there the radius grows by steps, so that what each step takes off a corner of 60
// degrees or more, (1 / sin 30 - 1) steps thick at most, stays clear of what counts as a thin feature.
static jali_status round_white(jali_context *ctx, printing *p, double thin_mm)
{
    jali_status status = JALI_OK;
    jali_bitmap opened = {0};
    double corner_mm = p->opt->corner_mm, radius_mm = thin_mm / 2;
    if (whole_px(p, 2 * corner_mm) <= whole_px(p, thin_mm)) return status;
    TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, &opened));
    while (radius_mm < corner_mm) {
        radius_mm = fmin(radius_mm + fmax(0.7 * thin_mm, p->pixel_mm), corner_mm);
        TRY(open_all_but_thin(ctx, p, 2 * radius_mm, thin_mm, &opened));
    }
done:
    jali_bitmap_free(ctx, &opened);
    return status;
}

// Corners of the solid, then those of the voids: the same of the complement.
jali_status round_corners(jali_context *ctx, printing *p)
{
    jali_status status;
    TRY(round_white(ctx, p, p->opt->phi_s_mm + fmin(p->opt->phi_e_solid_mm, p->opt->phi_e_void_mm)));
    invert(ctx, p->solid, p->solid);
    p->outside = !p->outside;
    TRY(round_white(ctx, p, p->opt->phi_v_mm - fmax(p->opt->phi_e_solid_mm, p->opt->phi_e_void_mm)));
    invert(ctx, p->solid, p->solid);
    p->outside = !p->outside;
done:
    return status;
}
