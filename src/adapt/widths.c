// The printer's widths as elements that fit together.
//
// A print painted with `printed` elements must survive as a mask under the `mask` ones: with G the growth,
//     printed solid = mask solid (+) G        a solid disc of the print, eroded by G, holds the mask's
//     mask void = printed void (+) G          a void disc of the print, widened by G, holds the mask's
// Where the printer takes away (a laser's kerf), mask and print change places. Of a tone's two elements one
// is the smaller, and the other is its sum with G. Separate digital discs of the right sizes do not do that:
// their corners differ, and half the details die.
#include "adapt/widths.h"
#include "base/base.h"

#include <math.h>
#include <stdlib.h>

jali_adapt_options jali_adapt_defaults(void)
{
    return (jali_adapt_options){.shape = JALI_SHAPE_DISC,
                                .solid_px = 12,
                                .void_px = 20,
                                .epsilon_px = 40,
                                .isolated_matters = true,
                                .outside_solid = true,
                                .growth_px = 1,
                                .axis_worth_white = 0.22,
                                .axis_worth_black = 0.27};
}

static jali_status check_widths(jali_context *ctx, const jali_adapt_options *opt)
{
    if (opt->solid_px < 1 || opt->void_px < 1 || opt->solid_px > 4096 || opt->void_px > 4096)
        return fail(ctx, JALI_BAD_VALUE, "widths of %d px (solid) and %d px (void) are outside 1 .. 4096 px",
                    opt->solid_px, opt->void_px);
    if (opt->growth_px < -4095 || opt->growth_px > 4096 || opt->growth_px % 2 == 0)
        return fail(ctx, JALI_BAD_VALUE, "omega_c is %d px; an odd number from -4095 to 4095 is accepted",
                    opt->growth_px);
    return JALI_OK;
}

// What the printer adds to a solid's width, or takes from it.
static int32_t added_px(const jali_adapt_options *opt)
{
    return opt->growth_px - 1;
}

// Whether the larger of a tone's two elements is the one in the print.
static bool is_larger_in_print(const jali_adapt_options *opt, bool white)
{
    return white ? added_px(opt) >= 0 : added_px(opt) < 0;
}

// The size of the smaller one. What would be nothing in the print is one pixel.
static int32_t smaller_px(const jali_adapt_options *opt, bool white)
{
    int32_t mask_px = white ? opt->solid_px : opt->void_px;
    return is_larger_in_print(opt, white) ? mask_px : MAX(mask_px - abs(added_px(opt)), 1);
}

static jali_status flat_element(jali_context *ctx, const jali_adapt_options *opt, bool white, bool in_print,
                                field *f)
{
    jali_status status;
    element growth = {0}, smaller = {0}, larger = {0};
    if (opt->shape == JALI_SHAPE_SQUARE && !in_print) {
        TRY(element_square(ctx, white ? opt->solid_px : opt->void_px, &smaller));
        TRY(field_of_element(ctx, &smaller, f));
        goto done;
    }
    TRY(white ? element_wide_disc(ctx, smaller_px(opt, white), &smaller)
              : element_disc(ctx, smaller_px(opt, white), &smaller));
    TRY(element_disc(ctx, abs(added_px(opt)) + 1, &growth));
    TRY(element_sum(ctx, &smaller, &growth, &larger));
    TRY(field_of_element(ctx, in_print == is_larger_in_print(opt, white) ? &larger : &smaller, f));
done:
    element_free(ctx, &growth);
    element_free(ctx, &smaller);
    element_free(ctx, &larger);
    return status;
}

static jali_status flat(jali_context *ctx, const jali_adapt_options *opt, bool in_print, widths *w)
{
    jali_status status;
    TRY(flat_element(ctx, opt, true, in_print, &w->solid));
    TRY(flat_element(ctx, opt, false, in_print, &w->hollow));
done:
    return status;
}

// --- On a curved surface: the same sums of ellipses, kind by kind

typedef struct kind_patches {
    patch growth, solid[2], hollow[2]; // [in the print]
} kind_patches;

static void kind_patches_free(jali_context *ctx, kind_patches *k)
{
    patch_free(ctx, &k->growth);
    for (int32_t i = 0; i < 2; i++) {
        patch_free(ctx, &k->solid[i]);
        patch_free(ctx, &k->hollow[i]);
    }
}

// Both elements of a tone. They are widened until the mask's, rounded as both are, is nowhere narrower than
// asked for.
static jali_status fit_tone(jali_context *ctx, const jali_adapt_options *opt, bool white,
                            const double metric[3], double safety, const patch *growth, patch tone[2])
{
    enum { MOST_TRIES = 200 };
    const double widening = 1.02;
    jali_status status = JALI_OK;
    bool larger_in_print = is_larger_in_print(opt, white);
    patch *smaller = &tone[!larger_in_print], *larger = &tone[larger_in_print];
    ellipse wanted = ellipse_of_disc(metric, (white ? opt->solid_px : opt->void_px) * safety, 0);
    double diameter_px = smaller_px(opt, white) * safety;
    for (int32_t i = 0; i < MOST_TRIES; i++, diameter_px *= widening) {
        ellipse e = ellipse_of_disc(metric, diameter_px, 0);
        patch_free(ctx, smaller);
        patch_free(ctx, larger);
        TRY(white ? patch_around(ctx, &e, smaller) : patch_within(ctx, &e, false, smaller));
        TRY(patch_sum(ctx, smaller, growth, larger));
        if (patch_as_wide(&tone[0], &wanted)) break;
    }
done:
    return status;
}

static jali_status patches_of_kind(jali_context *ctx, const jali_adapt_options *opt, const double metric[3],
                                   double slack, kind_patches *k)
{
    jali_status status;
    double safety = exp(slack);
    ellipse grown = ellipse_of_disc(metric, abs(added_px(opt)), 0.5);
    TRY(patch_within(ctx, &grown, true, &k->growth));
    TRY(fit_tone(ctx, opt, true, metric, safety, &k->growth, k->solid));
    TRY(fit_tone(ctx, opt, false, metric, safety, &k->growth, k->hollow));
done:
    return status;
}

static jali_status curved(jali_context *ctx, const jali_adapt_options *opt, bool in_print, widths *w)
{
    jali_status status;
    const tiling *t = &w->tiles;
    patch *solid = NULL, *hollow = NULL;
    TRY(ALLOCATE_CLEARED(ctx, solid, t->kinds));
    TRY(ALLOCATE_CLEARED(ctx, hollow, t->kinds));
    for (int32_t kind = 0; kind < t->kinds; kind++) {
        kind_patches k = {0};
        status = patches_of_kind(ctx, opt, t->metric[kind], t->slack[kind], &k);
        if (status == JALI_OK) {
            solid[kind] = k.solid[in_print];
            hollow[kind] = k.hollow[in_print];
            k.solid[in_print] = k.hollow[in_print] = (patch){0};
        }
        kind_patches_free(ctx, &k);
        if (status != JALI_OK) goto done;
    }
    TRY(field_of_patches(ctx, t, solid, &w->solid));
    TRY(field_of_patches(ctx, t, hollow, &w->hollow));
done:
    for (int32_t kind = 0; solid && kind < t->kinds; kind++) patch_free(ctx, &solid[kind]);
    for (int32_t kind = 0; hollow && kind < t->kinds; kind++) patch_free(ctx, &hollow[kind]);
    release(ctx, solid);
    release(ctx, hollow);
    return status;
}

struct jali_elements {
    jali_adapt_options made_for;
    int32_t width_px, height_px;
    widths mask, print;
};

// Whether the prepared elements are those that are asked for.
static bool are_prepared(const jali_adapt_options *opt, const jali_bitmap *grid, int32_t pad_px)
{
    const jali_elements *e = opt->elements;
    return e && pad_px == 0 && e->width_px == grid->width_px && e->height_px == grid->height_px &&
           e->made_for.chart == opt->chart && e->made_for.shape == opt->shape &&
           e->made_for.solid_px == opt->solid_px && e->made_for.void_px == opt->void_px &&
           e->made_for.growth_px == opt->growth_px;
}

// The neck between two discs of 12 px whose centres are 3 px apart is still 11.6 px wide. (At 5 px, 10.9
// wide, one of 24 real pictures came apart in the prediction.)
static jali_status near_cores(jali_context *ctx, const jali_adapt_options *opt, widths *w)
{
    enum { NECK_SHARE = 6 };
    int32_t gap = opt->solid_px / NECK_SHARE;
    return gap < 2 ? JALI_OK : field_of_discs(ctx, &w->tiles, (gap | 1) - 1, 0.5, true, false, &w->near);
}

static jali_status make_widths(jali_context *ctx, const jali_adapt_options *opt, const jali_bitmap *grid,
                               int32_t pad_px, bool in_print, widths *w)
{
    jali_status status;
    *w = (widths){0};
    TRY(check_widths(ctx, opt));
    if (are_prepared(opt, grid, pad_px)) {
        *w = in_print ? opt->elements->print : opt->elements->mask;
        w->borrowed = true;
        return JALI_OK;
    }
    TRY(tiling_create(ctx, opt->chart, grid->width_px, grid->height_px, pad_px, pad_px, 1, &w->tiles));
    if (!in_print) TRY(near_cores(ctx, opt, w));
    if (!is_flat(&w->tiles))
        TRY(curved(ctx, opt, in_print, w));
    else
        TRY(flat(ctx, opt, in_print, w));
done:
    if (status != JALI_OK) widths_free(ctx, w);
    return status;
}

jali_status mask_widths(jali_context *ctx, const jali_adapt_options *opt, const jali_bitmap *grid,
                        int32_t pad_px, widths *w)
{
    return make_widths(ctx, opt, grid, pad_px, false, w);
}

jali_status printed_widths(jali_context *ctx, const jali_adapt_options *opt, const jali_bitmap *grid,
                           int32_t pad_px, widths *w)
{
    return make_widths(ctx, opt, grid, pad_px, true, w);
}

void widths_free(jali_context *ctx, widths *w)
{
    if (!w->borrowed) {
        field_free(ctx, &w->solid);
        field_free(ctx, &w->hollow);
        field_free(ctx, &w->near);
        tiling_free(ctx, &w->tiles);
    }
    *w = (widths){0};
}

jali_status jali_elements_create(jali_context *ctx, const jali_adapt_options *opt, int32_t width_px,
                                 int32_t height_px, jali_elements **elements)
{
    jali_status status;
    jali_elements *e = NULL;
    jali_bitmap grid = {.width_px = width_px, .height_px = height_px};
    *elements = NULL;
    TRY(ALLOCATE_CLEARED(ctx, e, 1));
    e->made_for = *opt;
    e->made_for.elements = NULL;
    e->width_px = width_px;
    e->height_px = height_px;
    TRY(mask_widths(ctx, &e->made_for, &grid, 0, &e->mask));
    TRY(printed_widths(ctx, &e->made_for, &grid, 0, &e->print));
    TRY(field_remember(ctx, &e->mask.solid)); // the finish changes little from round to round
    TRY(field_remember(ctx, &e->mask.hollow));
    if (e->mask.near.patches) TRY(field_remember(ctx, &e->mask.near));
    *elements = e;
    e = NULL;
done:
    jali_elements_free(ctx, e);
    return status;
}

void jali_elements_free(jali_context *ctx, jali_elements *elements)
{
    if (!elements) return;
    widths_free(ctx, &elements->mask);
    widths_free(ctx, &elements->print);
    release(ctx, elements);
}

int64_t axis_worth_units(const jali_adapt_options *opt, bool white, int32_t solid_px, int32_t void_px)
{
    double worth = white ? opt->axis_worth_white : opt->axis_worth_black;
    return (int64_t)floor(WRONG_UNITS * worth * MIN(solid_px, void_px) + 0.5);
}
