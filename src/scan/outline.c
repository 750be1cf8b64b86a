// The four sides of a flat thing in a scan.
//
// A plate lies on something of another tone, which shows through its voids: so the border of the scan says
// what is not plate. Light is taken as a polynomial of second degree fitted to the border; what differs from
// it by more than Otsu's split is the plate.
//
// Limits:  a plate that fills the scan to its border is not found.
// Checked: tests/test_scan.c.
#include "scan/outline.h"
#include "scan/least.h"
#include "raster/raster.h"

#include <math.h>

enum { LIGHT = 6, FITS = 5, BINS = 256 };

static void light_terms(const grey *g, int32_t x, int32_t y, double term[LIGHT])
{
    double u = 2.0 * (x + 0.5) / g->width - 1, v = 2.0 * (y + 0.5) / g->height - 1;
    memcpy(term, (double[LIGHT]){1, u, v, u * u, u * v, v * v}, LIGHT * sizeof *term);
}

static double light_at(const grey *g, int32_t x, int32_t y, const double light[LIGHT])
{
    double term[LIGHT], sum = 0;
    light_terms(g, x, y, term);
    for (int k = 0; k < LIGHT; k++) sum += term[k] * light[k];
    return sum;
}

// Fit the light to the border, a few times over: what differs from the last fit counts less.
static bool fit_light(const grey *g, double light[LIGHT])
{
    static const double DOUBT = 0.03; // a difference that halves a pixel's weight
    int32_t ring = MAX(2, MIN(g->width, g->height) / 40);
    for (int32_t fit = 0; fit < FITS; fit++) {
        normal_equations sums = {.unknowns = LIGHT};
        for (int32_t y = 0; y < g->height; y++) {
            bool whole = y < ring || y >= g->height - ring;
            for (int32_t x = 0; x < g->width; x++) {
                if (!whole && x == ring) x = MAX(ring, g->width - ring);
                double term[LIGHT], level = (double)g->level[(size_t)y * (size_t)g->width + (size_t)x];
                light_terms(g, x, y, term);
                double off = fit ? (level - light_at(g, x, y, light)) / DOUBT : 0;
                add_equation(&sums, term, level, 1 / (1 + off * off));
            }
        }
        if (!solve_normal(&sums, light)) return false;
    }
    return true;
}

// Otsu's split of levels 0 .. 1.
static double split_of(const float *level, size_t size)
{
    double count[BINS] = {0}, all = (double)size, sum_all = 0, low = 0, sum_low = 0, best = 0, split = 1;
    for (size_t i = 0; i < size; i++) count[MIN((int32_t)(level[i] * BINS), BINS - 1)]++;
    for (int32_t v = 0; v < BINS; v++) sum_all += v * count[v];
    for (int32_t v = 0; v + 1 < BINS; v++) {
        low += count[v];
        sum_low += v * count[v];
        if (low == 0 || low == all) continue;
        double apart = sum_low / low - (sum_all - sum_low) / (all - low),
               between = low * (all - low) * apart * apart;
        if (between > best) {
            best = between;
            split = (v + 1.0) / BINS;
        }
    }
    return split;
}

static double turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// The convex hull of points sorted by y, then x: both chains at once. Returns its corners' number.
static int32_t hull_of(const double (*p)[2], int32_t count, double (*hull)[2])
{
    int32_t n = 0;
    for (int32_t side = 0; side < 2; side++) {
        int32_t first = n;
        for (int32_t i = 0; i < count; i++) {
            const double *q = p[side ? count - 1 - i : i];
            while (n - first >= 2 && turn(hull[n - 2], hull[n - 1], q) <= 0) n--;
            memcpy(hull[n++], q, 2 * sizeof(double));
        }
        n--; // the other chain begins with it
    }
    return n;
}

// Where the sides before and after side i (from corner i to i + 1) meet when it is taken away.
//   out    area   that is added; infinite when they do not meet beyond it
static double area_without(const double (*p)[2], int32_t n, int32_t i, double meet[2])
{
    const double *a = p[(i + n - 1) % n], *b = p[i], *c = p[(i + 1) % n], *d = p[(i + 2) % n];
    double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - d[0], vy = c[1] - d[1];
    double across = ux * vy - uy * vx;
    if (!(across < -1e-12 * hypot(ux, uy) * hypot(vx, vy))) return INFINITY;
    double t = ((c[0] - b[0]) * vy - (c[1] - b[1]) * vx) / across;
    meet[0] = b[0] + t * ux;
    meet[1] = b[1] + t * uy;
    return fabs(turn(b, meet, c)) / 2;
}

static bool four_sides(double (*p)[2], int32_t n, double corner[4][2])
{
    while (n > 4) {
        double least = INFINITY, best[2] = {0}, meet[2];
        int32_t side = -1;
        for (int32_t i = 0; i < n; i++) {
            double area = area_without((const double(*)[2])p, n, i, meet);
            if (area >= least) continue;
            least = area;
            side = i;
            memcpy(best, meet, sizeof best);
        }
        if (side < 0) return false;
        memcpy(p[side], best, sizeof best); // both ends of the side become the meeting point
        int32_t gone = (side + 1) % n;
        memmove(p + gone, p + gone + 1, (size_t)(n - gone - 1) * sizeof *p);
        n--;
    }
    if (n == 4) memcpy(corner, p, 4 * sizeof *p);
    return n == 4;
}

static int32_t largest_of(const int64_t *area, int32_t count)
{
    int32_t best = 0;
    for (int32_t i = 1; i < count; i++)
        if (area[i] > area[best]) best = i;
    return best;
}

jali_status outline_of_bitmap(jali_context *ctx, const jali_bitmap *bitmap, double corner[4][2], bool *found)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    components pieces = {0};
    int64_t *area = NULL;
    double(*end)[2], (*hull)[2];
    int32_t count = 0, largest;
    *found = false;
    TRY(label_components(ctx, bitmap, true, 4, &pieces));
    if (pieces.count == 0) goto done;
    TRY(component_areas(ctx, &pieces, &area));
    largest = largest_of(area, pieces.count);
    TRY(ARENA(ctx, end, 4 * (size_t)bitmap->height_px));
    TRY(ARENA(ctx, hull, 8 * (size_t)bitmap->height_px + 2));
    for (int32_t y = 0; y < bitmap->height_px; y++) {
        int32_t left = INT32_MAX, right = -1;
        for (int32_t i = pieces.first[y]; i < pieces.first[y + 1]; i++)
            if (pieces.label[i] == largest) {
                left = MIN(left, pieces.span[i][0]);
                right = MAX(right, pieces.span[i][1]);
            }
        for (int32_t k = 0; right >= 0 && k < 2; k++) { // the corners of the row's first and last pixel
            memcpy(end[count++], (double[]){left, y + k}, sizeof *end);
            memcpy(end[count++], (double[]){right, y + k}, sizeof *end);
        }
    }
    *found = four_sides(hull, hull_of((const double(*)[2])end, count, hull), corner);
done:
    release(ctx, area);
    components_free(ctx, &pieces);
    arena_rewind(ctx, mark);
    return status;
}

jali_status outline_of_grey(jali_context *ctx, const grey *g, double corner[4][2], bool *found)
{
    jali_status status;
    size_t size = (size_t)g->width * (size_t)g->height;
    double light[LIGHT], split;
    grey apart = {0};
    jali_bitmap object = {0};
    *found = false;
    TRY(grey_create(ctx, g->width, g->height, g->pixel, &apart));
    TRY(jali_bitmap_create(ctx, g->width, g->height, &object));
    if (!fit_light(g, light)) goto done;
    for (int32_t y = 0; y < g->height; y++)
        for (int32_t x = 0; x < g->width; x++) {
            size_t i = (size_t)y * (size_t)g->width + (size_t)x;
            apart.level[i] = (float)fmin(fabs((double)g->level[i] - light_at(g, x, y, light)), 1);
        }
    split = split_of(apart.level, size);
    for (int32_t y = 0; y < g->height; y++)
        for (int32_t x = 0; x < g->width; x++)
            jali_bitmap_set(&object, x, y,
                            (double)apart.level[(size_t)y * (size_t)g->width + (size_t)x] > split);
    TRY(outline_of_bitmap(ctx, &object, corner, found));
    for (int k = 0; k < 8; k++) corner[k / 2][k % 2] *= g->pixel;
done:
    grey_free(ctx, &apart);
    jali_bitmap_free(ctx, &object);
    return status;
}
