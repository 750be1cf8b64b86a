// Finding five round voids that lie as a board's marks do.
//
// A piece is round when it has the area of the ellipse with its second moments: 1 for discs and their views
// in perspective, 0.955 for squares and parallelograms, less for all else. Four corners give a map of the
// plane, and the map says where the fifth must be.
//
// Checked: tests/test_scan_board.c.
#include "calibrate/marks.h"
#include "raster/raster.h"

#include <jali/board.h>
#include <math.h>
#include <stdlib.h>

static const double SOFTEN_PX = 1;        // blur before: noise does not fray edges
enum { MOST_ROUNDS = 64 };                // the largest ones of either tone
static const double NEIGHBOURHOOD = 0.04; // of the longer side: deviation of what is evened out; above a mark
static const double EDGE_LEVEL = 0.2;     // in local spreads: flat noise is below
static const double LEAST_ROUND = 0.97, MOST_ROUND = 1.04;
static const double MOST_SQUEEZE = 2.2;    // longer over shorter axis: seen at 63 degrees
static const double LEAST_AREA_PX = 60;    // 9 px across
static const double MOST_SIZE_RATIO = 3;   // of areas of two marks: a steep perspective
static const double ODD_TOLERANCE = 0.012; // of the upper edge: where the odd mark may be off

typedef struct disc {
    double at[2], area;
} disc;

static int larger_first(const void *a, const void *b)
{
    const disc *p = a, *q = b;
    return p->area > q->area ? -1 : p->area < q->area;
}

// Sums over a component's pixels: count, x, y, xx, xy, yy.
typedef struct moments {
    double n, x, y, xx, xy, yy;
    bool border;
} moments;

static void add_run(moments *m, double y, double x0, double x1)
{
    // Pixel centres x0 + 1/2 .. x1 - 1/2: their sum and the sum of their squares.
    double n = x1 - x0, middle = (x0 + x1) / 2, sum = n * middle,
           squares = n * middle * middle + n * (n * n - 1) / 12;
    double v = y + 0.5;
    m->n += n;
    m->x += sum;
    m->y += n * v;
    m->xx += squares;
    m->xy += sum * v;
    m->yy += n * v * v;
}

static bool is_disc(const moments *m, disc *d)
{
    if (m->border || m->n < LEAST_AREA_PX) return false;
    double x = m->x / m->n, y = m->y / m->n;
    double xx = m->xx / m->n - x * x + 1.0 / 12, yy = m->yy / m->n - y * y + 1.0 / 12,
           xy = m->xy / m->n - x * y;
    double product = xx * yy - xy * xy, half = (xx + yy) / 2, spread = sqrt(fmax(half * half - product, 0));
    if (!(product > 0) || half + spread > MOST_SQUEEZE * MOST_SQUEEZE * (half - spread)) return false;
    double roundness = m->n / (4 * M_PI * sqrt(product));
    *d = (disc){{x, y}, m->n};
    return roundness >= LEAST_ROUND && roundness <= MOST_ROUND;
}

static jali_status collect_discs(jali_context *ctx, const grey *g, double sign, disc *found, int32_t *count)
{
    jali_status status;
    jali_bitmap bitmap = {0};
    components c = {0};
    moments *m = NULL;
    disc *all = NULL;
    int32_t discs = 0;
    TRY(jali_bitmap_create(ctx, g->width, g->height, &bitmap));
    for (int32_t y = 0; y < g->height; y++)
        for (int32_t x = 0; x < g->width; x++)
            if (sign * (double)g->level[(size_t)y * (size_t)g->width + (size_t)x] > EDGE_LEVEL)
                jali_bitmap_set(&bitmap, x, y, true);
    TRY(label_components(ctx, &bitmap, true, 4, &c));
    TRY(ALLOCATE_CLEARED(ctx, m, c.count + 1));
    TRY(ALLOCATE(ctx, all, c.count + 1));
    for (int32_t y = 0; y < c.height_px; y++)
        for (int32_t i = c.first[y]; i < c.first[y + 1]; i++) {
            moments *to = &m[c.label[i]];
            add_run(to, y, c.span[i][0], c.span[i][1]);
            to->border |= y == 0 || y + 1 == c.height_px || c.span[i][0] == 0 || c.span[i][1] == c.width_px;
        }
    for (int32_t i = 0; i < c.count; i++) discs += is_disc(&m[i], &all[discs]);
    qsort(all, (size_t)discs, sizeof *all, larger_first);
    *count = MIN(discs, MOST_ROUNDS);
    memcpy(found, all, (size_t)*count * sizeof *all);
done:
    release(ctx, all);
    release(ctx, m);
    components_free(ctx, &c);
    jali_bitmap_free(ctx, &bitmap);
    return status;
}

static double turn_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool similar(const disc *a, const disc *b)
{
    return a->area < MOST_SIZE_RATIO * b->area && b->area < MOST_SIZE_RATIO * a->area;
}

// Could o be the odd mark between the corners a (near) and b (far)?
static bool in_line(const disc *a, const disc *b, const disc *o)
{
    double length = hypot(b->at[0] - a->at[0], b->at[1] - a->at[1]);
    double along =
        ((o->at[0] - a->at[0]) * (b->at[0] - a->at[0]) + (o->at[1] - a->at[1]) * (b->at[1] - a->at[1])) /
        (length * length);
    return length > 0 && along > 0.15 && along < 0.5 &&
           fabs(turn_of(a->at, b->at, o->at)) < ODD_TOLERANCE * length * length;
}

// The quadrangle in the order of the marks, its sides turning one way all around.
static bool convex(const disc *const corner[4], double *area)
{
    double sign = turn_of(corner[0]->at, corner[1]->at, corner[2]->at);
    *area = 0;
    for (int k = 0; k < 4; k++) {
        const double *p = corner[k]->at, *q = corner[(k + 1) % 4]->at;
        if (turn_of(p, q, corner[(k + 2) % 4]->at) * sign <= 0) return false;
        *area += (p[0] * q[1] - p[1] * q[0]) / 2;
    }
    return true;
}

static bool judge(const disc *const corner[4], const disc *odd, double pixel, bool dark, mark_guess *guess)
{
    double from[JALI_BOARD_MARKS][2], to[JALI_BOARD_MARKS][2], at[2], area, far = 0;
    if (!convex(corner, &area)) return false;
    for (int k = 0; k < JALI_BOARD_MARKS; k++) {
        jali_board_mark_share(k, from[k]);
        for (int a = 0; a < 2; a++) to[k][a] = (k < 4 ? corner[k] : odd)->at[a] * pixel;
    }
    if (!homography_of_points(4, (const double(*)[2])from, (const double(*)[2])to, &guess->map)) return false;
    homography_apply(&guess->map, from[4], at);
    far = hypot(to[3][0] - to[2][0], to[3][1] - to[2][1]);
    if (!(hypot(at[0] - to[4][0], at[1] - to[4][1]) < ODD_TOLERANCE * far)) return false;
    guess->dark = dark;
    guess->mirrored = area > 0; // y is down in the scan and up on the board
    guess->size_px2 = fabs(area) * pixel * pixel;
    guess->radius_px = sqrt(corner[0]->area / M_PI) * pixel;
    return true;
}

static void keep_guess(const mark_guess *one, mark_guess *guess, int32_t *count)
{
    int32_t place = *count < MOST_GUESSES ? (*count)++ : MOST_GUESSES;
    for (; place > 0 && guess[place - 1].size_px2 < one->size_px2; place--)
        if (place < MOST_GUESSES) guess[place] = guess[place - 1];
    if (place < MOST_GUESSES) guess[place] = *one;
}

// The other two corners of an upper edge with its odd mark.
static void complete(const disc *d, int32_t count, int32_t a, int32_t b, int32_t o, double pixel, bool dark,
                     mark_guess *guess, int32_t *guesses)
{
    for (int32_t i = 0; i < count; i++)
        for (int32_t k = 0; k < count; k++) {
            mark_guess one;
            if (i == k || i == a || i == b || i == o || k == a || k == b || k == o) continue;
            if (!similar(&d[a], &d[i]) || !similar(&d[b], &d[k])) continue;
            const disc *corner[4] = {&d[i], &d[k], &d[b], &d[a]};
            if (judge(corner, &d[o], pixel, dark, &one)) keep_guess(&one, guess, guesses);
        }
}

jali_status guess_marks(jali_context *ctx, const grey *g, mark_guess *guess, int32_t *count, int32_t *rounds)
{
    jali_status status;
    grey evened = {0};
    *count = *rounds = 0;
    TRY(grey_create(ctx, g->width, g->height, g->pixel, &evened));
    memcpy(evened.level, g->level, (size_t)g->width * (size_t)g->height * sizeof *g->level);
    TRY(grey_blur(ctx, &evened, SOFTEN_PX));
    TRY(grey_normalise(ctx, &evened, NEIGHBOURHOOD * MAX(g->width, g->height)));
    for (int dark = 0; dark < 2; dark++) {
        disc d[MOST_ROUNDS];
        int32_t discs;
        TRY(step(ctx, "calibrate", 0.1 + 0.1 * dark));
        TRY(collect_discs(ctx, &evened, dark ? -1 : 1, d, &discs));
        *rounds += discs;
        for (int32_t a = 0; a < discs; a++)
            for (int32_t b = 0; b < discs; b++)
                for (int32_t o = 0; o < discs && a != b; o++)
                    if (o != a && o != b && similar(&d[a], &d[b]) && similar(&d[a], &d[o]) &&
                        in_line(&d[a], &d[b], &d[o]))
                        complete(d, discs, a, b, o, g->pixel, dark, guess, count);
    }
done:
    grey_free(ctx, &evened);
    return status;
}
