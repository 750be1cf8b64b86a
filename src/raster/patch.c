// Patches:  an element's pixels as one run a row; ellipses, sums, painting.
//
// Rounding: patch_around covers its ellipse, so it is never too narrow and at most a pixel too wide along
//           rows and columns; patch_within never holds a pixel centre outside its ellipse and is at most a
//           pixel too narrow. On the surface a pixel is as long as the stretch there.
// Checked:  tests/test_metric.c: in flat places equal to the elements of raster/element.c; covers, holds,
//           sums.
#include "raster/field.h"
#include "base/base.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_SPAN_PX = 4096 };

// A width that passes a whole number of pixels by less is that number.
static const double HAIR = 1e-9;

ellipse ellipse_of_disc(const double metric[3], double diameter_px, double more_px)
{
    // The metric's eigenvalues are squared stretches; a semi-axis is the radius by the stretch, plus the
    // rest.
    double mean = (metric[0] + metric[2]) / 2, half = (metric[0] - metric[2]) / 2;
    double apart = sqrt(half * half + metric[1] * metric[1]);
    double wide = diameter_px / 2 / sqrt(mean + apart) + more_px; // across the most stretched direction
    double along = diameter_px / 2 / sqrt(mean - apart) + more_px;
    double cos2 = apart > 0 ? half / apart : 1,
           sin2 = apart > 0 ? metric[1] / apart : 0; // of twice its angle
    double sum = (wide * wide + along * along) / 2, difference = (wide * wide - along * along) / 2;
    return (ellipse){{sum + difference * cos2, difference * sin2, sum - difference * cos2}};
}

static jali_status patch_create(jali_context *ctx, int32_t top, int32_t rows, double size, patch *p)
{
    *p = (patch){0};
    jali_status status = ALLOCATE(ctx, p->span, rows);
    if (status != JALI_OK) return status;
    p->size = (int32_t)fmax(1, floor(size + 0.5));
    p->top = top;
    p->rows = rows;
    return JALI_OK;
}

void patch_free(jali_context *ctx, patch *p)
{
    release(ctx, p->span);
    *p = (patch){0};
}

jali_status patch_of_element(jali_context *ctx, const element *e, patch *p)
{
    int32_t even = e->size % 2 == 0;
    jali_status status = patch_create(ctx, -(e->size / 2), e->size, e->size, p);
    for (int32_t k = 0; k < p->rows; k++) {
        int32_t half = e->half[abs(2 * (p->top + k) + even) / 2];
        p->span[k][0] = -half;
        p->span[k][1] = half - even;
    }
    return status;
}

static jali_status check_reach(jali_context *ctx, const ellipse *e)
{
    double across = 2 * sqrt(fmax(e->shape[0], e->shape[2]));
    if (across <= MOST_SPAN_PX) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE, "a structuring element of %.0f px is outside 1 .. %d px", across,
                MOST_SPAN_PX);
}

// Twice the geometric mean of the semi-axes.
static double mean_diameter(const ellipse *e)
{
    return 2 * pow(fmax(e->shape[0] * e->shape[2] - e->shape[1] * e->shape[1], 0), 0.25);
}

// The columns between which the ellipse lies at the height y.
static void columns_at(const ellipse *e, double y, double x[2])
{
    double determinant = fmax(e->shape[0] * e->shape[2] - e->shape[1] * e->shape[1], 0);
    double half = sqrt(determinant / e->shape[2] * fmax(0, 1 - y * y / e->shape[2]));
    x[0] = y * e->shape[1] / e->shape[2] - half;
    x[1] = y * e->shape[1] / e->shape[2] + half;
}

jali_status patch_within(jali_context *ctx, const ellipse *e, bool odd, patch *p)
{
    double reach_x = sqrt(e->shape[0]), reach_y = sqrt(e->shape[2]);
    bool even_columns = !odd && (int64_t)floor(2 * reach_x + HAIR) % 2 == 0 && 2 * reach_x + HAIR >= 2;
    bool even_rows = !odd && (int64_t)floor(2 * reach_y + HAIR) % 2 == 0 && 2 * reach_y + HAIR >= 2;
    double centre_x = even_columns ? -0.5 : 0, centre_y = even_rows ? -0.5 : 0;
    int32_t top = (int32_t)ceil(centre_y - reach_y - HAIR),
            bottom = (int32_t)floor(centre_y + reach_y + HAIR);
    if (even_rows) top = MIN(top, -1), bottom = MAX(bottom, 0);
    *p = (patch){0};
    jali_status status = check_reach(ctx, e);
    if (status == JALI_OK) status = patch_create(ctx, top, bottom - top + 1, mean_diameter(e), p);
    for (int32_t k = 0; k < p->rows; k++) {
        double x[2];
        columns_at(e, top + k - centre_y, x);
        p->span[k][0] = (int32_t)ceil(centre_x + x[0] - HAIR);
        p->span[k][1] = (int32_t)floor(centre_x + x[1] + HAIR);
        if (p->span[k][0] > p->span[k][1]) // slim and slanted: it passes between two centres
            p->span[k][0] = p->span[k][1] = (int32_t)floor(centre_x + (x[0] + x[1]) / 2 + 0.5);
    }
    return status;
}

jali_status patch_around(jali_context *ctx, const ellipse *e, patch *p)
{
    double reach_x = sqrt(e->shape[0]), reach_y = sqrt(e->shape[2]);
    double centre_x = (int64_t)ceil(2 * reach_x - HAIR) % 2 ? 0 : -0.5;
    double centre_y = (int64_t)ceil(2 * reach_y - HAIR) % 2 ? 0 : -0.5;
    double rightmost = e->shape[1] / reach_x; // the height at which the ellipse reaches furthest to the right
    int32_t top = (int32_t)floor(centre_y - reach_y - 0.5 + HAIR) + 1;
    int32_t bottom = (int32_t)ceil(centre_y + reach_y + 0.5 - HAIR) - 1;
    *p = (patch){0};
    jali_status status = check_reach(ctx, e);
    if (status == JALI_OK) status = patch_create(ctx, top, bottom - top + 1, mean_diameter(e), p);
    for (int32_t k = 0; k < p->rows; k++) {
        double y0 = fmax(top + k - centre_y - 0.5, -reach_y), y1 = fmin(top + k - centre_y + 0.5, reach_y);
        double left[2], right[2]; // where in the pixel row the ellipse is widest to each side
        columns_at(e, fmin(fmax(-rightmost, y0), y1), left);
        columns_at(e, fmin(fmax(rightmost, y0), y1), right);
        p->span[k][0] = (int32_t)floor(centre_x + left[0] - 0.5 + HAIR) + 1;
        p->span[k][1] = (int32_t)ceil(centre_x + right[1] + 0.5 - HAIR) - 1;
    }
    return status;
}

jali_status patch_sum(jali_context *ctx, const patch *a, const patch *b, patch *sum)
{
    jali_status status =
        patch_create(ctx, a->top + b->top, a->rows + b->rows - 1, a->size + b->size - 1, sum);
    for (int32_t k = 0; k < sum->rows; k++) sum->span[k][0] = INT32_MAX, sum->span[k][1] = INT32_MIN;
    for (int32_t i = 0; i < a->rows && sum->rows; i++)
        for (int32_t j = 0; j < b->rows; j++) {
            int32_t *span = sum->span[i + j];
            span[0] = MIN(span[0], a->span[i][0] + b->span[j][0]);
            span[1] = MAX(span[1], a->span[i][1] + b->span[j][1]);
        }
    return status;
}

// From side to side across a direction, its pixels as squares.
static double width_across(const patch *p, double nx, double ny)
{
    double least = INFINITY, most = -INFINITY;
    for (int32_t k = 0; k < p->rows; k++) {
        double a = nx * p->span[k][0] + ny * (p->top + k), b = nx * p->span[k][1] + ny * (p->top + k);
        least = MIN(least, MIN(a, b));
        most = MAX(most, MAX(a, b));
    }
    return most - least + fabs(nx) + fabs(ny);
}

bool patch_as_wide(const patch *p, const ellipse *e)
{
    enum { DIRECTIONS = 32 };
    const double share = 0.999, turn_cos = cos(3.14159265358979323846 / DIRECTIONS);
    const double turn_sin = sqrt(1 - turn_cos * turn_cos);
    double nx = 1, ny = 0;
    for (int32_t i = 0; i < DIRECTIONS; i++) {
        double across = nx * nx * e->shape[0] + 2 * nx * ny * e->shape[1] + ny * ny * e->shape[2];
        double width = width_across(p, nx, ny), turned = nx * turn_cos - ny * turn_sin;
        if (width * width < share * share * 4 * across) return false;
        ny = nx * turn_sin + ny * turn_cos;
        nx = turned;
    }
    return true;
}

// The columns x0 .. x1-1 of row k of the patch set on (x, y); an empty range where it is cut off.
static bool row_inside(const jali_bitmap *a, int32_t x, int32_t y, const patch *p, int32_t k, int32_t span[2])
{
    span[0] = MAX(x + p->span[k][0], 0);
    span[1] = MIN(x + p->span[k][1] + 1, a->width_px);
    int32_t row = y + p->top + k;
    return row >= 0 && row < a->height_px && span[0] < span[1];
}

void paint_patch(jali_bitmap *dst, int32_t x, int32_t y, const patch *brush, bool white)
{
    int32_t span[2];
    for (int32_t k = 0; k < brush->rows; k++)
        if (row_inside(dst, x, y, brush, k, span))
            paint_run(dst, y + brush->top + k, span[0], span[1], white);
}

VECTORISED static int32_t count_rows(const jali_bitmap *a, int32_t x, int32_t y, const patch *p,
                                     uint64_t flip)
{
    int32_t count = 0, span[2];
    for (int32_t k = 0; k < p->rows; k++) {
        if (!row_inside(a, x, y, p, k, span)) continue;
        const uint64_t *row = a->word + (int64_t)(y + p->top + k) * a->stride;
        for (int32_t i = span[0] >> 6; i <= (span[1] - 1) >> 6; i++)
            count += __builtin_popcountll((row[i] ^ flip) & columns_of_word(i, span[0], span[1]));
    }
    return count;
}

int32_t count_patch(const jali_bitmap *a, int32_t x, int32_t y, const patch *p, bool white)
{
    return count_rows(a, x, y, p, white ? 0 : ~UINT64_C(0));
}

VECTORISED static int32_t cover_rows(jali_bitmap *dst, int32_t x, int32_t y, const patch *p)
{
    int32_t covered = 0, span[2];
    for (int32_t k = 0; k < p->rows; k++) {
        if (!row_inside(dst, x, y, p, k, span)) continue;
        uint64_t *row = dst->word + (int64_t)(y + p->top + k) * dst->stride;
        for (int32_t i = span[0] >> 6; i <= (span[1] - 1) >> 6; i++) {
            uint64_t columns = columns_of_word(i, span[0], span[1]);
            covered += __builtin_popcountll(~row[i] & columns);
            row[i] |= columns;
        }
    }
    return covered;
}

int32_t cover_patch(jali_bitmap *dst, int32_t x, int32_t y, const patch *brush)
{
    return cover_rows(dst, x, y, brush);
}
