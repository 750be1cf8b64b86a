// Where a flat thing lies in a scan of it.
//
// Source:  B. D. Lucas and T. Kanade, An iterative image registration technique, 1981; S. Baker and
//          I. Matthews, Lucas-Kanade 20 years on, 2004 (forward, compositional: the increment is laid before
//          the map so far, so that only gradients of the straightened scan are needed).
// Differs: both pictures are evened out first (local mean and spread), so that light and contrast of the scan
//          play no part; residuals are weighted by Cauchy's function.
// Checked: tests/test_scan.c.
#include "scan/align.h"
#include "scan/least.h"
#include "scan/outline.h"

#include <math.h>

enum {
    UNKNOWNS = 8,
    COARSEST_PX = 100,
    MOST_ITERATIONS = 20,
    BAND_ROWS = 8,
    NEIGHBOURHOOD_PX = 12, // deviation of what is evened out
    OUTLINE_PX = 500
};

static const double SOFTEN_PX = 1; // blur before: steps become slopes
static const double DOUBT = 0.7;   // a residual that halves a pixel's weight, in units of the local spread
static const double SETTLED_PX = 0.01; // a move that ends the iterations

// One size of both pictures.
typedef struct level {
    grey reference, scan; // evened out
    grey straight;        // the scan under the reference's pixels; NAN beyond it
    double sign;          // -1: the scan is a negative
} level;

static void level_free(jali_context *ctx, level *l)
{
    grey_free(ctx, &l->reference);
    grey_free(ctx, &l->scan);
    grey_free(ctx, &l->straight);
}

static jali_status level_create(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                                const alignment *a, int32_t shrink, level *l)
{
    jali_status status;
    double middle[2] = {reference->width_px / 2.0, reference->height_px / 2.0};
    double pixel = shrink * homography_scale(&a->map, middle);
    int32_t scan_shrink = (int32_t)fmin(fmax(floor(pixel + 0.5), 1), 1 << 15);
    *l = (level){.sign = a->negative ? -1 : 1};
    TRY(grey_of_bitmap(ctx, reference, shrink, &l->reference));
    TRY(grey_of_picture(ctx, scan, scan_shrink, &l->scan));
    TRY(grey_create(ctx, l->reference.width, l->reference.height, shrink, &l->straight));
    double ratio = fmin(fmax(pixel / scan_shrink, 0.1), 50);
    TRY(grey_blur(ctx, &l->reference, SOFTEN_PX));
    TRY(grey_blur(ctx, &l->scan, SOFTEN_PX * ratio));
    TRY(grey_normalise(ctx, &l->reference, NEIGHBOURHOOD_PX));
    TRY(grey_normalise(ctx, &l->scan, NEIGHBOURHOOD_PX * ratio));
done:
    if (status != JALI_OK) level_free(ctx, l);
    return status;
}

typedef struct straightening {
    const grey *scan;
    const homography *map;
    double reach_x, reach_y, sign; // of the scan
    grey *out;
} straightening;

static void straighten_row(void *shared, int32_t y)
{
    const straightening *job = shared;
    float *row = job->out->level + (size_t)y * (size_t)job->out->width;
    for (int32_t x = 0; x < job->out->width; x++) {
        double at[2], pixel = job->out->pixel;
        homography_apply(job->map, (double[]){(x + 0.5) * pixel, (y + 0.5) * pixel}, at);
        bool inside = at[0] >= 0 && at[1] >= 0 && at[0] <= job->reach_x && at[1] <= job->reach_y;
        row[x] = inside ? (float)job->sign * grey_at(job->scan, at[0], at[1]) : NAN;
    }
}

static void straighten_into(jali_context *ctx, const grey *scan, const homography *map, double sign,
                            grey *out)
{
    straightening job = {scan, map, scan->width * scan->pixel, scan->height * scan->pixel, sign, out};
    parallel(ctx, out->height, straighten_row, &job);
}

// The reference's coordinates scaled to about -1 .. 1.
static homography unit_frame(const grey *reference)
{
    double w = reference->width * reference->pixel / 2, h = reference->height * reference->pixel / 2,
           s = 1 / fmax(w, h);
    return (homography){{s, 0, -s * w, 0, s, -s * h, 0, 0, 1}};
}

typedef struct band_sums {
    normal_equations move;
    double both, reference2, scan2; // sums of products
} band_sums;

typedef struct gathering {
    const level *l;
    const homography *map;
    homography frame;
    double inset; // so near to the scan's border its surroundings are missed: such places do not move the map
    double gain;
    band_sums *band; // [bands]
} gathering;

// How the straightened level at a place changes with each of the eight ratios of the increment.
static void slopes_of(const gathering *job, int32_t x, int32_t y, const float *at, double row[UNKNOWNS])
{
    const grey *g = &job->l->straight;
    double place[2], per_unit = 1 / (g->pixel * job->frame.m[0]); // pixels of the level a unit of the frame
    homography_apply(&job->frame, (double[]){(x + 0.5) * g->pixel, (y + 0.5) * g->pixel}, place);
    double u = place[0], v = place[1], gu = (double)(at[1] - at[-1]) / 2 * per_unit,
           gv = (double)(at[g->width] - at[-g->width]) / 2 * per_unit, radial = u * gu + v * gv;
    memcpy(row, (double[UNKNOWNS]){gu * u, gu * v, gu, gv * u, gv * v, gv, -u * radial, -v * radial},
           UNKNOWNS * sizeof *row);
}

static bool well_inside(const gathering *job, int32_t x, int32_t y)
{
    const grey *g = &job->l->straight, *scan = &job->l->scan;
    double at[2];
    homography_apply(job->map, (double[]){(x + 0.5) * g->pixel, (y + 0.5) * g->pixel}, at);
    return at[0] > job->inset && at[1] > job->inset && at[0] < scan->width * scan->pixel - job->inset &&
           at[1] < scan->height * scan->pixel - job->inset;
}

static void gather_band(void *shared, int32_t index)
{
    const gathering *job = shared;
    const grey *s = &job->l->straight, *r = &job->l->reference;
    band_sums *sums = &job->band[index];
    *sums = (band_sums){.move = {.unknowns = UNKNOWNS}};
    int32_t first = MAX(index * BAND_ROWS, 1), last = MIN((index + 1) * BAND_ROWS, s->height - 1);
    for (int32_t y = first; y < last; y++)
        for (int32_t x = 1; x + 1 < s->width; x++) {
            const float *at = s->level + (size_t)y * (size_t)s->width + x;
            double here = (double)at[0], wanted = (double)r->level[(size_t)y * (size_t)r->width + (size_t)x];
            if (isnan(at[0] + at[1] + at[-1] + at[s->width] + at[-s->width])) continue;
            if (well_inside(job, x, y)) {
                double row[UNKNOWNS], off = (job->gain * wanted - here) / DOUBT;
                slopes_of(job, x, y, at, row);
                add_equation(&sums->move, row, job->gain * wanted - here, 1 / (1 + off * off));
            }
            sums->both += here * wanted;
            sums->reference2 += wanted * wanted;
            sums->scan2 += here * here;
        }
}

static band_sums gather(jali_context *ctx, gathering *job)
{
    int32_t bands = (job->l->straight.height + BAND_ROWS - 1) / BAND_ROWS;
    band_sums all = {.move = {.unknowns = UNKNOWNS}};
    parallel(ctx, bands, gather_band, job);
    for (int32_t b = 0; b < bands; b++) {
        add_equations(&all.move, &job->band[b].move);
        all.both += job->band[b].both;
        all.reference2 += job->band[b].reference2;
        all.scan2 += job->band[b].scan2;
    }
    return all;
}

// The share of the reference that the scan shows counts too: a map that slides off it is no agreement.
static double agreement_of(const band_sums *s, double reference2)
{
    double d = sqrt(fmax(s->reference2, reference2) * s->scan2);
    return d > 0 ? s->both / d : 0;
}

// The increment as a map of the frame, brought to the reference's pixels.
static homography increment_of(const double x[UNKNOWNS], const homography *frame)
{
    homography step = {{1 + x[0], x[1], x[2], x[3], 1 + x[4], x[5], x[6], x[7], 1}}, back;
    homography_inverse(frame, &back);
    homography moved = homography_after(&step, frame);
    return homography_after(&back, &moved);
}

// How far the increment moves the reference's corners at most, in the level's pixels.
static double move_of(const homography *step, const grey *r)
{
    double most = 0, w = r->width * r->pixel, h = r->height * r->pixel;
    for (int k = 0; k < 4; k++) {
        double from[2] = {k & 1 ? w : 0, k & 2 ? h : 0}, to[2];
        homography_apply(step, from, to);
        most = fmax(most, hypot(to[0] - from[0], to[1] - from[1]) / r->pixel);
    }
    return most;
}

static double square_sum(const grey *g)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)g->width * (size_t)g->height; i++)
        sum += (double)g->level[i] * (double)g->level[i];
    return sum;
}

// Iterate at one size; the best map met stays.
//   in     iterations   0: only measure the agreement
static jali_status settle(jali_context *ctx, level *l, int32_t iterations, alignment *a)
{
    jali_status status = JALI_OK;
    arena_mark mark = arena_here(ctx);
    gathering job = {.l = l, .frame = unit_frame(&l->reference), .gain = 1};
    homography map = a->map;
    job.map = &map;
    job.inset = fmin(1.5 * NEIGHBOURHOOD_PX, MIN(l->scan.width, l->scan.height) / 8.0) * l->scan.pixel;
    double reference2 = square_sum(&l->reference);
    a->agreement = -1;
    TRY(ARENA(ctx, job.band, (l->reference.height + BAND_ROWS - 1) / BAND_ROWS));
    for (int32_t i = 0; i <= iterations; i++) {
        double x[UNKNOWNS];
        TRY(step(ctx, "align", (double)i / (iterations + 1)));
        straighten_into(ctx, &l->scan, &map, l->sign, &l->straight);
        band_sums sums = gather(ctx, &job);
        double agreement = agreement_of(&sums, reference2);
        if (agreement > a->agreement) {
            a->agreement = agreement;
            a->map = map;
        }
        job.gain = sums.reference2 > 0 ? fmax(sums.both / sums.reference2, 0.1) : 1;
        if (i == iterations || !solve_normal(&sums.move, x)) break;
        homography increment = increment_of(x, &job.frame);
        double move = move_of(&increment, &l->reference);
        if (!(move < 0.2 * l->reference.width + 0.2 * l->reference.height) || move < SETTLED_PX) break;
        map = homography_after(&map, &increment);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static int32_t shrink_to(const jali_bitmap *reference, int32_t longer_px)
{
    int32_t longer = MAX(reference->width_px, reference->height_px);
    return MAX(1, (longer + longer_px - 1) / longer_px);
}

static jali_status settle_at(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                             int32_t longer_px, int32_t iterations, alignment *a)
{
    level l;
    jali_status status = level_create(ctx, scan, reference, a, shrink_to(reference, longer_px), &l);
    if (status != JALI_OK) return status;
    status = settle(ctx, &l, iterations, a);
    level_free(ctx, &l);
    return status;
}

jali_status align(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                  int32_t finest_px, alignment *a)
{
    jali_status status = JALI_OK;
    for (int32_t px = COARSEST_PX; status == JALI_OK; px *= 2) {
        status = settle_at(ctx, scan, reference, MIN(px, finest_px), MOST_ITERATIONS, a);
        if (px >= finest_px || shrink_to(reference, px) == 1) break;
    }
    return status;
}

// --- Where to begin

// Four corners of the reference onto four of the scan, begun at corner `turn`, the other way round when
// mirrored.
static bool map_of_corners(const double from[4][2], const double to[4][2], int32_t turn, bool mirrored,
                           homography *map)
{
    double target[4][2];
    for (int32_t k = 0; k < 4; k++)
        memcpy(target[k], to[(turn + (mirrored ? 4 - k : k)) % 4], sizeof target[k]);
    return homography_of_points(4, from, (const double(*)[2])target, map);
}

// The best of the eight ways to lay four corners on four, of either polarity.
static jali_status try_corners(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                               const double from[4][2], const double to[4][2], alignment *best)
{
    jali_status status = JALI_OK;
    for (int32_t way = 0; way < 16; way++) {
        alignment a = {.negative = way & 8};
        if (!map_of_corners(from, to, way & 3, way & 4, &a.map)) continue;
        TRY(settle_at(ctx, scan, reference, COARSEST_PX, MOST_ITERATIONS / 2, &a));
        if (a.agreement > best->agreement) *best = a;
    }
done:
    return status;
}

jali_status find_in_scan(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                         int32_t finest_px, alignment *a)
{
    jali_status status;
    grey small = {0}, drawn = {0};
    double from[4][2], to[4][2], w = scan->width_px, h = scan->height_px;
    const double whole[4][2] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
    bool drawn_found, found;
    *a = (alignment){.map = homography_identity(), .agreement = -1};
    TRY(grey_of_bitmap(ctx, reference, shrink_to(reference, OUTLINE_PX), &drawn));
    TRY(outline_of_grey(ctx, &drawn, from, &drawn_found));
    int32_t longer = MAX(scan->width_px, scan->height_px);
    TRY(grey_of_picture(ctx, scan, MAX(1, (longer + OUTLINE_PX - 1) / OUTLINE_PX), &small));
    TRY(outline_of_grey(ctx, &small, to, &found));
    if (!drawn_found)
        memcpy(from,
               (double[4][2]){{0, 0},
                              {reference->width_px, 0},
                              {reference->width_px, reference->height_px},
                              {0, reference->height_px}},
               sizeof from);
    if (found) TRY(try_corners(ctx, scan, reference, (const double(*)[2])from, (const double(*)[2])to, a));
    TRY(try_corners(ctx, scan, reference, (const double(*)[2])from, whole, a));
    if (a->agreement > 0) TRY(align(ctx, scan, reference, finest_px, a));
done:
    grey_free(ctx, &small);
    grey_free(ctx, &drawn);
    return status;
}

jali_status straighten(jali_context *ctx, const jali_picture *scan, const jali_bitmap *reference,
                       const homography *map, int32_t shrink, grey *out)
{
    jali_status status;
    grey levels = {0};
    *out = (grey){0};
    double middle[2] = {reference->width_px / 2.0, reference->height_px / 2.0};
    double pixel = shrink * homography_scale(map, middle);
    TRY(grey_of_picture(ctx, scan, (int32_t)fmin(fmax(floor(pixel), 1), 1 << 15), &levels));
    TRY(grey_create(ctx, (reference->width_px + shrink - 1) / shrink,
                    (reference->height_px + shrink - 1) / shrink, shrink, out));
    straighten_into(ctx, &levels, map, 1, out);
done:
    grey_free(ctx, &levels);
    return status;
}
