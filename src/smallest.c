// The smallest size at which nothing of a picture is lost.
//
// Fineness is lost in leaps, and not in order: a size can lose what a smaller one keeps, when a stroke falls
// between the pixels or a bridge takes another way. So this goes up until two sizes in a row keep everything,
// and says what it tried; it does not promise that all larger ones do.
//
// Differs: the way up is on a grid twice as coarse, a quarter of the time; what counts is found on the run's
// own. Checked: tests/test_smallest.c.
#include <jali/smallest.h>

#include "agreed.h"
#include "base/base.h"

#include <math.h>

static const double LADDER = 1.41421356237309505; // from one size to the next on the way up

typedef struct looking {
    jali_options opt;
    jali_smallest_options range;
    const jali_picture *picture;
    int32_t threshold;
    jali_bitmap input;
    double pixel_mm; // of a run's own grid, once one is known; 0: not yet
    jali_smallest *found;
} looking;

jali_smallest_options jali_smallest_defaults(void)
{
    return (jali_smallest_options){10, 400, 0.03, jali_lost_defaults().least_px};
}

static jali_status check_range(jali_context *ctx, const jali_smallest_options *range)
{
    if (!(range->least_mm > 0) || !(range->most_mm > range->least_mm) || !(range->most_mm <= 10000))
        return fail(ctx, JALI_BAD_VALUE, "widths from %g to %g mm cannot be tried; 0 < least < most <= 10000",
                    range->least_mm, range->most_mm);
    if (!(range->precision >= 0.001 && range->precision <= 1))
        return fail(ctx, JALI_BAD_VALUE, "a precision of %g cannot be kept; 0.001 to 1 is accepted",
                    range->precision);
    if (range->least_px < 1)
        return fail(ctx, JALI_BAD_VALUE, "details are counted from 1 px on, not from %d px", range->least_px);
    return JALI_OK;
}

static jali_status lost_on(jali_context *ctx, const looking *l, const jali_chart *chart,
                           const jali_optimised *made, jali_lost *lost)
{
    jali_status status;
    jali_reference reference = {0};
    jali_prediction print = {0};
    jali_predict_options p = jali_prediction_options(&l->opt);
    p.chart = chart;
    p.recall = true;
    p.picture_mm = jali_chart_pixel_mm(chart) * (chart->width_px - 2 * chart->margin_px);
    TRY(jali_reference_create(ctx, &l->input, &p, &reference));
    TRY(jali_predict(ctx, &reference, &made->mask, chart->margin_px, chart->outside_solid, &p, &print));
    jali_lost_options what = lost_options(&l->opt, chart, made, l->input.width_px);
    what.least_px = l->range.least_px;
    TRY(jali_find_lost(ctx, &reference, &print, &what, lost));
done:
    jali_prediction_free(ctx, &print);
    jali_reference_free(ctx, &reference);
    return status;
}

// The image stages at one width.
static jali_status make(jali_context *ctx, const looking *l, double width_mm, double pixel_mm,
                        jali_smallest_try *one)
{
    jali_status status;
    jali_chart chart = {0};
    jali_bitmap drawing = {0};
    jali_optimised made = {0};
    jali_lost lost = {0};
    jali_place_options place = l->opt.place;
    place.width_mm = width_mm;
    place.height_mm = 0;
    place.pixel_mm = pixel_mm;
    TRY(jali_place(ctx, l->picture, l->threshold, &place, &chart, &drawing));
    TRY(jali_optimise(ctx, &drawing, &chart, &l->opt.optimise, &made));
    TRY(lost_on(ctx, l, &chart, &made, &lost));
    one->pixel_mm = jali_chart_pixel_mm(&chart);
    one->white = lost.white;
    one->black = lost.black;
    one->whole = lost.white.parts + lost.white.stretches + lost.black.parts + lost.black.stretches == 0;
done:
    jali_lost_free(ctx, &lost);
    jali_optimised_free(ctx, &made);
    jali_bitmap_free(ctx, &drawing);
    jali_chart_free(ctx, &chart);
    return status;
}

// Try a width and keep it in the list. Where nothing of the picture is left, all of it is lost.
static jali_status try_width(jali_context *ctx, looking *l, double width_mm, bool coarse, bool *whole)
{
    jali_smallest *found = l->found;
    double given_mm = l->opt.place.pixel_mm;
    jali_smallest_try one = {.width_mm = width_mm, .coarse = coarse && given_mm == 0 && l->pixel_mm > 0};
    jali_status status = step(ctx, "smallest", MIN(found->try_count / 20.0, 0.99));
    if (status != JALI_OK) return status;
    if (found->try_count == JALI_MOST_TRIES)
        return fail(ctx, JALI_LIMIT, "the smallest size was not found in %d tries", JALI_MOST_TRIES);
    status = make(ctx, l, width_mm, one.coarse ? 2 * l->pixel_mm : given_mm, &one);
    if (status != JALI_OK && status != JALI_NO_RESULT) return status;
    if (l->pixel_mm == 0 && status == JALI_OK) l->pixel_mm = one.pixel_mm;
    found->tried[found->try_count++] = one;
    *whole = one.whole;
    return JALI_OK;
}

// Up the ladder until nothing is lost at two widths in a row, or at the last; low: the last that loses.
static jali_status climb(jali_context *ctx, looking *l, double *low_mm, double *high_mm)
{
    jali_status status = JALI_OK;
    bool whole, above = false;
    double most_mm = l->range.most_mm;
    for (double width_mm = l->range.least_mm; !above; width_mm = MIN(width_mm * LADDER, most_mm)) {
        TRY(try_width(ctx, l, width_mm, true, &whole));
        if (!whole) {
            *low_mm = width_mm;
            *high_mm = 0;
        } else if (*high_mm == 0) {
            *high_mm = width_mm;
        } else {
            above = true;
            l->found->confirmed_mm = width_mm;
        }
        if (width_mm >= most_mm) break;
    }
done:
    return status;
}

// On the run's own grid: is nothing lost at high? Else the answer lies above it.
static jali_status settle_high(jali_context *ctx, looking *l, double *low_mm, double *high_mm)
{
    jali_status status = JALI_OK;
    bool whole = false;
    while (*high_mm > 0) {
        TRY(try_width(ctx, l, *high_mm, false, &whole));
        if (whole) break;
        *low_mm = *high_mm;
        *high_mm = *high_mm < l->range.most_mm ? MIN(*high_mm * LADDER, l->range.most_mm) : 0;
    }
    if (l->found->confirmed_mm <= *high_mm) l->found->confirmed_mm = 0;
done:
    return status;
}

// And is something lost at low? Else the answer lies below it.
static jali_status settle_low(jali_context *ctx, looking *l, double *low_mm, double *high_mm)
{
    jali_status status = JALI_OK;
    bool whole = true;
    while (*low_mm > 0 && whole) {
        TRY(try_width(ctx, l, *low_mm, false, &whole));
        if (!whole) break;
        *high_mm = *low_mm;
        *low_mm = *low_mm > l->range.least_mm ? MAX(*low_mm / LADDER, l->range.least_mm) : 0;
    }
done:
    return status;
}

static jali_status halve(jali_context *ctx, looking *l, double low_mm, double high_mm)
{
    jali_status status = JALI_OK;
    bool whole;
    while (low_mm > 0 && high_mm > low_mm * (1 + l->range.precision)) {
        double middle_mm = sqrt(low_mm * high_mm);
        TRY(try_width(ctx, l, middle_mm, false, &whole));
        *(whole ? &high_mm : &low_mm) = middle_mm;
    }
    l->found->width_mm = high_mm;
done:
    return status;
}

// A coarse try counts where no try on the run's own grid corrects it.
static bool is_monotone(const jali_smallest *s)
{
    double lowest_mm = s->width_mm;
    for (int32_t i = 0; i < s->try_count; i++)
        if (!s->tried[i].coarse && s->tried[i].width_mm >= s->width_mm / LADDER - 1e-9)
            lowest_mm = MIN(lowest_mm, s->tried[i].width_mm);
    for (int32_t i = 0; i < s->try_count; i++) {
        const jali_smallest_try *t = &s->tried[i];
        if (t->whole && t->width_mm < (t->coarse ? lowest_mm : s->width_mm)) return false;
    }
    return true;
}

jali_status jali_find_smallest(jali_context *ctx, jali_picture *picture, const jali_options *given,
                               const jali_smallest_options *range, jali_smallest *smallest)
{
    jali_status status;
    looking l = {.opt = agreed_options(given), .picture = picture, .found = smallest};
    double low_mm = 0, high_mm = 0;
    l.range = range ? *range : jali_smallest_defaults();
    l.opt.optimise.details = true; // keeps what the bridges cover
    *smallest = (jali_smallest){.monotone = true};
    TRY(check_range(ctx, &l.range));
    TRY(jali_threshold(ctx, picture, &l.opt.threshold, &l.threshold));
    TRY(jali_binarise(ctx, picture, l.threshold, &l.input));
    TRY(climb(ctx, &l, &low_mm, &high_mm));
    TRY(settle_high(ctx, &l, &low_mm, &high_mm));
    if (high_mm > 0) TRY(settle_low(ctx, &l, &low_mm, &high_mm));
    if (high_mm > 0) TRY(halve(ctx, &l, low_mm, high_mm));
    smallest->monotone = is_monotone(smallest);
done:
    jali_bitmap_free(ctx, &l.input);
    return status;
}
