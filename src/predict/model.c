// The forward model of the printer: what becomes of a mask.
//
// Source:  Binary Image Carving for 3D Printing, section 4.2: solids below phi_s and voids below phi_v do not
//          appear, solids come out wider than drawn and voids narrower. Beyond it: the two may differ, a kerf
//          is a negative growth, small round holes shrink by more, corners come out round.
// Model:   solid = close(open(mask, phi_s), phi_v)
//          solid = solid and the rims of its round holes, hole_mm2 / d / 2 wide
//          print = solid grown by phi_e_solid / 2; where voids are narrow, by phi_e_void / 2
//          print = its corners rounded to corner_mm, convex ones first, thin features left as they are
//          Lengths that are 0 or equal leave their step out.
// Discs:   A disc has whole diameter floor(phi / pixel): a bar of exactly phi prints wherever it lies.
//          With a metric they are ellipses of the place, nowhere larger than the disc.
// Checked: tests/test_forward.c on bars, holes and corners of known size.
#include "predict/model.h"

#include <math.h>

static const double TOLERANCE_PX = 1e-9; // phi / pixel is often a whole number that floating point misses

// --- Discs

double whole_px(const printing *p, double mm)
{
    return fmax(1, floor(mm / p->pixel_mm + TOLERANCE_PX));
}

jali_status disc_that_fits(jali_context *ctx, const printing *p, double mm, field *f)
{
    return field_of_discs(ctx, p->tiles, whole_px(p, mm), 0, false, true, f);
}

int32_t edge_px(const printing *p, double growth_mm)
{
    return (int32_t)floor(fabs(growth_mm) / 2 / p->pixel_mm + 0.5);
}

jali_status move_edges(jali_context *ctx, const printing *p, const jali_bitmap *from, int32_t px, bool back,
                       jali_bitmap *to)
{
    jali_status status;
    field disc = {0};
    TRY(field_of_discs(ctx, p->tiles, 2 * px, 0.5, true, false, &disc));
    TRY(back ? field_erode(ctx, from, &disc, p->outside, to)
             : field_dilate(ctx, from, &disc, p->outside, to));
done:
    field_free(ctx, &disc);
    return status;
}

void swap_bitmaps(jali_bitmap *a, jali_bitmap *b)
{
    jali_bitmap kept = *a;
    *a = *b;
    *b = kept;
}

// --- What appears at all

static jali_status lay_down(jali_context *ctx, printing *p, jali_bitmap *laid)
{
    jali_status status;
    field solid = {0}, hollow = {0};
    TRY(disc_that_fits(ctx, p, p->opt->phi_s_mm, &solid));
    TRY(disc_that_fits(ctx, p, p->opt->phi_v_mm, &hollow));
    TRY(field_open(ctx, p->solid, &solid, p->outside, &p->scratch, p->solid));
    TRY(jali_bitmap_copy(ctx, p->solid, laid));
    TRY(field_close(ctx, p->solid, &hollow, p->outside, &p->scratch, p->solid));
done:
    field_free(ctx, &solid);
    field_free(ctx, &hollow);
    return status;
}

// --- Growth

static bool growths_differ(const printing *p)
{
    return p->opt->phi_e_solid_mm != p->opt->phi_e_void_mm;
}

//   in   narrow   where voids are, when the growths differ
static jali_status grow(jali_context *ctx, printing *p, const jali_bitmap *narrow)
{
    jali_status status;
    jali_bitmap by_void = {0};
    double of_solid = p->opt->phi_e_solid_mm, of_void = p->opt->phi_e_void_mm;
    if (growths_differ(p)) {
        TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, &by_void));
        TRY(move_edges(ctx, p, p->solid, edge_px(p, of_void), of_void < 0, &by_void));
    }
    TRY(move_edges(ctx, p, p->solid, edge_px(p, of_solid), of_solid < 0, &p->scratch));
    swap_bitmaps(p->solid, &p->scratch);
    if (growths_differ(p)) { // solid = narrow ? by_void : solid
        combine(ctx, RULE_AND, &by_void, narrow, &by_void);
        combine(ctx, RULE_AND_NOT, p->solid, narrow, p->solid);
        combine(ctx, RULE_OR, p->solid, &by_void, p->solid);
    }
done:
    jali_bitmap_free(ctx, &by_void);
    return status;
}

// What was laid loses to the kerf as well: a filled void can leave a thread between two others, and of that a
// kerf leaves specks.
static jali_status wear_laid(jali_context *ctx, printing *p, jali_bitmap *laid)
{
    double kerf_mm = -fmin(p->opt->phi_e_solid_mm, p->opt->phi_e_void_mm);
    if (kerf_mm <= 0) return JALI_OK;
    jali_status status = move_edges(ctx, p, laid, edge_px(p, kerf_mm), true, &p->scratch);
    if (status == JALI_OK) swap_bitmaps(laid, &p->scratch);
    return status;
}

jali_status print_mask(jali_context *ctx, const jali_predict_options *opt, const tiling *tiles,
                       double pixel_mm, bool outside, jali_bitmap *mask, jali_bitmap *laid)
{
    jali_status status;
    printing p = {.opt = opt, .tiles = tiles, .pixel_mm = pixel_mm, .outside = outside, .solid = mask};
    jali_bitmap narrow = {0};
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, &p.scratch));
    TRY(lay_down(ctx, &p, laid));
    if (growths_differ(&p))
        TRY(narrow_places(ctx, &p, edge_px(&p, fmax(fabs(opt->phi_e_solid_mm), fabs(opt->phi_e_void_mm))),
                          &narrow));
    if (opt->hole_mm2 > 0) TRY(narrow_holes(ctx, &p));
    TRY(grow(ctx, &p, &narrow));
    TRY(wear_laid(ctx, &p, laid));
    if (opt->corner_mm > 0) TRY(round_corners(ctx, &p));
done:
    jali_bitmap_free(ctx, &p.scratch);
    jali_bitmap_free(ctx, &narrow);
    return status;
}
