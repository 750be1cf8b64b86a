// The finish: nothing in the mask is thinner than the widths, and no neck either.
//
// Why cores: an opening keeps two discs that barely touch; the neck between them is thinner than any width
// and parts in the print. Where the discs' centres are joined by a stroke there is no neck. Ends: the first
// round takes thin solid off; from then on every step adds solid (strokes, filled voids, discs on details of
// types A and B), so the number of black pixels falls until nothing changes. What is left is type C. Dead
// ends: taking off in every round does not end, for a filled void can be too thin for the solid's element and
// the two undo each other for ever; thickening the tips too floods (recall of black 80 -> 76 %, 20 rounds).
#include "adapt/hand.h"
#include "base/base.h"

#include <stdlib.h>

// Whether the patch, set on (0, 0), covers (dx, dy).
static bool covers(const patch *p, int32_t dx, int32_t dy)
{
    int32_t k = dy - p->top;
    return k >= 0 && k < p->rows && dx >= p->span[k][0] && dx <= p->span[k][1];
}

// Where to set the element so that it covers (x, y): the fewest black pixels made white, less the thin ones
// covered.
static void cheapest_cover(const jali_bitmap *mask, const jali_bitmap *thin, const field *e, int32_t x,
                           int32_t y, int32_t at[2])
{
    int32_t best = INT32_MAX;
    for (int32_t dy = -e->above; dy <= e->below; dy++)
        for (int32_t dx = -e->left; dx <= e->right; dx++) {
            const patch *p = patch_at(e, x - dx, y - dy);
            if (!covers(p, dx, dy)) continue;
            int32_t cost =
                count_patch(mask, x - dx, y - dy, p, false) - count_patch(thin, x - dx, y - dy, p, true);
            if (cost >= best) continue;
            best = cost;
            at[0] = x - dx;
            at[1] = y - dy;
        }
}

// A plate without a frame ends at the bitmap's border, and so must the element.
static void move_inside(const jali_bitmap *mask, const field *e, int32_t at[2])
{
    at[0] = MAX(MIN(at[0], mask->width_px - e->right - 1), MIN(e->left, mask->width_px / 2));
    at[1] = MAX(MIN(at[1], mask->height_px - e->below - 1), MIN(e->above, mask->height_px / 2));
}

/// Where a detail is covered: the element set at `at` covers its first pixel (x, y).
typedef struct cover {
    int32_t x, y, at[2];
} cover;

typedef struct covering {
    const jali_bitmap *mask, *thin;
    const field *e;
    bool outside_solid;
    cover *cover; // [count], in raster order
    int32_t count;
} covering;

static void place_cover(const covering *job, cover *c)
{
    cheapest_cover(job->mask, job->thin, job->e, c->x, c->y, c->at);
    if (!job->outside_solid) move_inside(job->mask, job->e, c->at);
}

enum { BATCH = 16 };

static void place_batch(void *shared, int32_t batch)
{
    covering *job = shared;
    for (int32_t i = batch * BATCH; i < MIN((batch + 1) * BATCH, job->count); i++)
        place_cover(job, &job->cover[i]);
}

// Whether an element set before can have changed what cover i was chosen by.
static bool is_outdated(const covering *job, int32_t i)
{
    const field *e = job->e;
    const cover *c = &job->cover[i];
    int32_t high = e->above + e->below + 1, wide = e->left + e->right + 1;
    for (int32_t j = i - 1; j >= 0 && job->cover[j].y >= c->y - 3 * high; j--) {
        const int32_t *at = job->cover[j].at;
        if (abs(at[0] - c->x) <= 2 * wide && abs(at[1] - c->y) <= 2 * high) return true;
    }
    return false;
}

static void list_first_pixels(const components *c, covering *job)
{
    for (int32_t y = 0; y < c->height_px; y++)
        for (int32_t i = c->first[y]; i < c->first[y + 1]; i++)
            if (c->label[i] == job->count) job->cover[job->count++] = (cover){.x = c->span[i][0], .y = y};
}

// An element at each detail, the first one first; where the ones before leave the choice as it is, it was
// made side by side.
static jali_status cover_details(jali_context *ctx, const jali_bitmap *thin, const field *e,
                                 bool outside_solid, jali_bitmap *mask)
{
    jali_status status;
    components c = {0};
    covering job = {.mask = mask, .thin = thin, .e = e, .outside_solid = outside_solid};
    TRY(label_components(ctx, thin, true, 8, &c));
    TRY(ALLOCATE(ctx, job.cover, c.count));
    list_first_pixels(&c, &job);
    parallel(ctx, (job.count + BATCH - 1) / BATCH, place_batch, &job);
    for (int32_t i = 0; i < job.count; i++) {
        cover *here = &job.cover[i];
        if (is_outdated(&job, i)) place_cover(&job, here);
        paint_patch(mask, here->at[0], here->at[1], patch_at(e, here->at[0], here->at[1]), true);
    }
done:
    components_free(ctx, &c);
    release(ctx, job.cover);
    return status;
}

// Cover the details of types A and B. What an element leaves of a long one comes next round. What is fixed is
// left as it is.
static jali_status thicken_details(jali_context *ctx, const jali_adapt_options *opt, const field *e,
                                   jali_bitmap *mask)
{
    jali_details thin = {0};
    jali_status status;
    TRY(jali_adapt_details(ctx, mask, true, opt, &thin));
    for (int32_t type = JALI_TYPE_A; type <= JALI_TYPE_B; type++) {
        if (opt->fixed) combine(ctx, RULE_AND_NOT, &thin.type[type], opt->fixed, &thin.type[type]);
        TRY(cover_details(ctx, &thin.type[type], e, opt->outside_solid, mask));
    }
    put_back(opt, mask);
done:
    jali_details_free(ctx, &thin);
    return status;
}

// Cores that lie near each other count as one.
static jali_status merge_near(jali_context *ctx, const field *near, jali_bitmap *cores)
{
    jali_status status;
    jali_bitmap merged = {0};
    if (!near->patches) return JALI_OK;
    TRY(jali_bitmap_create(ctx, cores->width_px, cores->height_px, &merged));
    TRY(field_dilate(ctx, cores, near, false, &merged));
    jali_bitmap swap = *cores;
    *cores = merged;
    merged = swap;
done:
    jali_bitmap_free(ctx, &merged);
    return status;
}

jali_status jali_adapt_cores(jali_context *ctx, const jali_adapt_options *opt, bool thicken,
                             jali_bitmap *mask, jali_bitmap *cores)
{
    jali_status status;
    widths w = {0};
    *cores = (jali_bitmap){0};
    TRY(mask_widths(ctx, opt, mask, 0, &w));
    TRY(jali_bitmap_create(ctx, mask->width_px, mask->height_px, cores));
    if (thicken) TRY(thicken_details(ctx, opt, &w.solid, mask));
    TRY(field_erode(ctx, mask, &w.solid, opt->outside_solid, cores));
    if (!thicken) TRY(field_dilate(ctx, cores, &w.solid, false, mask));
    put_back(opt, mask);
    TRY(merge_near(ctx, &w.near, cores));
done:
    if (status != JALI_OK) jali_bitmap_free(ctx, cores);
    widths_free(ctx, &w);
    return status;
}

// What was black and is closed is black again.
static void clear_closed(const jali_adapt_options *opt, const jali_bitmap *before, jali_bitmap *mask)
{
    for (int64_t i = 0; i < mask->stride * mask->height_px; i++)
        mask->word[i] &= ~opt->closed->word[i] | before->word[i];
}

jali_status jali_adapt_lay(jali_context *ctx, jali_bridges *bridges, const jali_adapt_options *opt,
                           jali_bitmap *mask)
{
    jali_status status;
    widths w = {0};
    jali_bitmap scratch = {0};
    TRY(mask_widths(ctx, opt, mask, 0, &w));
    TRY(jali_bitmap_copy(ctx, mask, &scratch));
    TRY(jali_adapt_strokes(ctx, bridges, opt, false, mask));
    if (opt->closed) clear_closed(opt, &scratch, mask);
    TRY(field_close(ctx, mask, &w.hollow, opt->outside_solid, &scratch, mask));
    put_back(opt, mask);
done:
    jali_bitmap_free(ctx, &scratch);
    widths_free(ctx, &w);
    return status;
}
