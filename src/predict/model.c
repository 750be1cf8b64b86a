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
// Discs:   A disc has whole diameter floor(phi / pixel), so that a bar of exactly phi prints wherever it
// lies.
//          With a metric they are ellipses of the place, nowhere larger than the disc.
// Checked: tests/test_predict.c on bars, holes and corners of known size.
#include "predict/model.h"

#include <math.h>

static const double TOLERANCE_PX = 1e-9; // phi / pixel is often a whole number that floating point misses

// Narrow is a void that a disc of so many phi_v does not fit into.
static const double NARROW_PHI_V = 4;

// An element has at most 4096 px.
static const double LARGEST_DISC_PX = 4000;

// A hole counts as round while its second moment is at most this times a disc's of its area: an ellipse of 2
// to 1 has 1.25, a square 1.05, a bar of 4 to 1 2.2.
static const double ROUND_MOMENT = 1.25;

/// A mask on its way through the printer.
typedef struct printing {
    const jali_predict_options *opt;
    const tiling *tiles;
    double pixel_mm;
    bool outside;
    jali_bitmap *solid;  // what is solid so far
    jali_bitmap scratch; // of its size, for the operators
} printing;

// --- Discs

// Whole pixels of a width, so that a bar of that width holds the disc.
static double whole_px(const printing *p, double mm)
{
    return fmax(1, floor(mm / p->pixel_mm + TOLERANCE_PX));
}

static jali_status disc_that_fits(jali_context *ctx, const printing *p, double mm, field *f)
{
    return field_of_discs(ctx, p->tiles, whole_px(p, mm), 0, false, true, f);
}

// Half of a growth, to the nearest pixel: how far each edge moves.
static int32_t edge_px(const printing *p, double growth_mm)
{
    return (int32_t)floor(fabs(growth_mm) / 2 / p->pixel_mm + 0.5);
}

// Move all edges by so many pixels: outwards, or inwards when `back`.
static jali_status move_edges(jali_context *ctx, const printing *p, const jali_bitmap *from, int32_t px,
                              bool back, jali_bitmap *to)
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

static void swap_bitmaps(jali_bitmap *a, jali_bitmap *b)
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

// --- Round holes

/// Sums over a component's pixels, for its area and how far it spreads.
typedef struct moments {
    double count, x, y, xx, xy, yy;
    bool at_border; // it goes on beyond the bitmap
} moments;

// Whole sums over the columns x0 .. x1-1 of a row.
static void add_run(moments *m, int32_t y, int32_t x0, int32_t x1)
{
    double n = x1 - x0, first = x0, last = x1 - 1.0;
    double x = n * (first + last) / 2;
    double xx = (last * (last + 1) * (2 * last + 1) - (first - 1) * first * (2 * first - 1)) / 6;
    m->count += n;
    m->x += x;
    m->y += n * y;
    m->xx += xx;
    m->xy += x * y;
    m->yy += n * y * (double)y;
}

// The diameter in mm of the disc that has a round hole's area on the surface; 0 for what is not round.
static double round_hole_mm(const printing *p, const moments *m)
{
    double x = m->x / m->count, y = m->y / m->count;
    const double *g = metric_at(p->tiles, (int32_t)x, (int32_t)y);
    double area = m->count * sqrt(g[0] * g[2] - g[1] * g[1]);
    double own = 1.0 / 12; // a pixel's own spread
    double spread = g[0] * (m->xx / m->count - x * x + own) + 2 * g[1] * (m->xy / m->count - x * y) +
                    g[2] * (m->yy / m->count - y * y + own);
    if (m->at_border || spread * 2 * M_PI > ROUND_MOMENT * area) return 0;
    return 2 * sqrt(area / M_PI) * p->pixel_mm;
}

// By how many pixels each hole's rim moves inwards: rim[label], 0 for none. -1: the hole closes.
static jali_status measure_holes(jali_context *ctx, const printing *p, const components *voids, int32_t *rim,
                                 int32_t *most)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    moments *hole;
    *most = 0;
    TRY(ARENA(ctx, hole, voids->count));
    memset(hole, 0, (size_t)voids->count * sizeof *hole);
    for (int32_t y = 0; y < voids->height_px; y++)
        for (int32_t i = voids->first[y]; i < voids->first[y + 1]; i++) {
            moments *m = &hole[voids->label[i]];
            const int32_t *span = voids->span[i];
            add_run(m, y, span[0], span[1]);
            m->at_border |= y == 0 || y == voids->height_px - 1 || span[0] == 0 || span[1] == voids->width_px;
        }
    for (int32_t i = 0; i < voids->count; i++) {
        double d_mm = round_hole_mm(p, &hole[i]);
        double more_mm = d_mm > 0 ? p->opt->hole_mm2 / d_mm : 0;
        rim[i] = more_mm >= d_mm && d_mm > 0 ? -1 : edge_px(p, more_mm);
        *most = MAX(*most, rim[i]);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static void paint_holes(const components *voids, const int32_t *rim, int32_t which, bool white,
                        jali_bitmap *dst)
{
    for (int32_t y = 0; y < voids->height_px; y++)
        for (int32_t i = voids->first[y]; i < voids->first[y + 1]; i++)
            if (rim[voids->label[i]] == which) paint_run(dst, y, voids->span[i][0], voids->span[i][1], white);
}

// Holes whose rims move equally far are done at once: those voids alone, grown into, joined with the rest.
static jali_status narrow_holes(jali_context *ctx, printing *p)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    components voids = {0};
    jali_bitmap alone = {0};
    int32_t *rim, most;
    TRY(label_components(ctx, p->solid, false, 8, &voids));
    TRY(ARENA(ctx, rim, voids.count));
    TRY(measure_holes(ctx, p, &voids, rim, &most));
    paint_holes(&voids, rim, -1, true, p->solid);
    TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, &alone));
    for (int32_t px = 1; px <= most; px++) {
        bool any = false;
        for (int32_t i = 0; i < voids.count && !any; i++) any = rim[i] == px;
        if (!any) continue;
        TRY(step(ctx, "predict", 0));
        fill(ctx, &alone, true);
        paint_holes(&voids, rim, px, false, &alone);
        TRY(move_edges(ctx, p, &alone, px, false, &p->scratch));
        combine(ctx, RULE_AND_NOT, &p->scratch, &alone, &p->scratch); // the rims
        combine(ctx, RULE_OR, p->solid, &p->scratch, p->solid);
    }
done:
    jali_bitmap_free(ctx, &alone);
    components_free(ctx, &voids);
    arena_rewind(ctx, mark);
    return status;
}

// --- Growth

// Where voids are narrow, with the edges beside them as far as any edge moves.
static jali_status narrow_places(jali_context *ctx, printing *p, int32_t reach_px, jali_bitmap *narrow)
{
    jali_status status;
    field disc = {0};
    double narrow_mm = p->opt->narrow_mm > 0 ? p->opt->narrow_mm : NARROW_PHI_V * p->opt->phi_v_mm;
    narrow_mm = fmin(narrow_mm, LARGEST_DISC_PX * p->pixel_mm);
    TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, narrow));
    TRY(disc_that_fits(ctx, p, narrow_mm, &disc));
    TRY(field_close(ctx, p->solid, &disc, p->outside, &p->scratch, narrow));
    combine(ctx, RULE_AND_NOT, narrow, p->solid, &p->scratch);
    TRY(move_edges(ctx, p, &p->scratch, reach_px, false, narrow));
done:
    field_free(ctx, &disc);
    return status;
}

static jali_status grow(jali_context *ctx, printing *p)
{
    jali_status status;
    jali_bitmap narrow = {0}, by_void = {0};
    double of_solid = p->opt->phi_e_solid_mm, of_void = p->opt->phi_e_void_mm;
    int32_t solid_px = edge_px(p, of_solid), void_px = edge_px(p, of_void);
    if (of_solid != of_void) {
        TRY(narrow_places(ctx, p, MAX(solid_px, void_px), &narrow));
        TRY(jali_bitmap_create(ctx, p->solid->width_px, p->solid->height_px, &by_void));
        TRY(move_edges(ctx, p, p->solid, void_px, of_void < 0, &by_void));
    }
    TRY(move_edges(ctx, p, p->solid, solid_px, of_solid < 0, &p->scratch));
    swap_bitmaps(p->solid, &p->scratch);
    if (of_solid != of_void) { // solid = narrow ? by_void : solid
        combine(ctx, RULE_AND, &by_void, &narrow, &by_void);
        combine(ctx, RULE_AND_NOT, p->solid, &narrow, p->solid);
        combine(ctx, RULE_OR, p->solid, &by_void, p->solid);
    }
done:
    jali_bitmap_free(ctx, &narrow);
    jali_bitmap_free(ctx, &by_void);
    return status;
}

// --- Corners

// Of the pieces that an opening took off, keep those that hold a thin feature: a disc almost as wide as the
// narrowest bar. The slivers of corners hold none.
static jali_status keep_thin_features(jali_context *ctx, const printing *p, const jali_bitmap *lost,
                                      double thin_mm, jali_bitmap *opened)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    field disc = {0};
    components pieces = {0};
    jali_bitmap core = {0};
    bool *kept;
    TRY(disc_that_fits(ctx, p, thin_mm * 3 / 4, &disc));
    TRY(jali_bitmap_create(ctx, lost->width_px, lost->height_px, &core));
    TRY(field_erode(ctx, lost, &disc, false, &core));
    TRY(label_components(ctx, lost, true, 4, &pieces));
    TRY(ARENA(ctx, kept, pieces.count));
    memset(kept, 0, (size_t)pieces.count * sizeof *kept);
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t y = 0; y < pieces.height_px; y++)
            for (int32_t i = pieces.first[y]; i < pieces.first[y + 1]; i++) {
                const int32_t *span = pieces.span[i];
                if (pass == 0)
                    kept[pieces.label[i]] |= count_run(&core, y, span[0], span[1]) > 0;
                else if (kept[pieces.label[i]])
                    paint_run(opened, y, span[0], span[1], true);
            }
done:
    field_free(ctx, &disc);
    components_free(ctx, &pieces);
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
static jali_status round_corners(jali_context *ctx, printing *p)
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

jali_status print_mask(jali_context *ctx, const jali_predict_options *opt, const tiling *tiles,
                       double pixel_mm, bool outside, jali_bitmap *mask, jali_bitmap *laid)
{
    jali_status status;
    printing p = {.opt = opt, .tiles = tiles, .pixel_mm = pixel_mm, .outside = outside, .solid = mask};
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, &p.scratch));
    TRY(lay_down(ctx, &p, laid));
    if (opt->hole_mm2 > 0) TRY(narrow_holes(ctx, &p));
    TRY(grow(ctx, &p));
    if (opt->corner_mm > 0) TRY(round_corners(ctx, &p));
done:
    jali_bitmap_free(ctx, &p.scratch);
    return status;
}
