// Structuring elements: square, disc, octagon.
#include "raster/raster.h"
#include "base/base.h"

#include <math.h>

static jali_status element_rows(jali_context *ctx, int32_t size, element *e)
{
    *e = (element){0};
    if (size < 1 || size > 4096)
        return fail(ctx, JALI_BAD_VALUE, "a structuring element of %d px is outside 1 .. 4096 px", size);
    element made = {size, (size + 1) / 2, NULL};
    jali_status status = ALLOCATE(ctx, made.half, made.rows);
    if (status == JALI_OK) *e = made;
    return status;
}

jali_status element_square(jali_context *ctx, int32_t size, element *e)
{
    jali_status status = element_rows(ctx, size, e);
    for (int32_t i = 0; i < e->rows; i++) e->half[i] = size / 2;
    return status;
}

// Pixels whose centre is within diameter / 2, cut to `size` rows and columns. In half pixels the rows lie at
// 0, 2, 4 ... (odd sizes) or 1, 3, 5 ... (even) and so do the columns.
static jali_status disc_rows(jali_context *ctx, int32_t size, double diameter, element *e)
{
    jali_status status = element_rows(ctx, size, e);
    int32_t even = size % 2 == 0;
    for (int32_t i = 0; i < e->rows; i++) {
        double row = 2 * i + even;
        double reach = sqrt(fmax(0, diameter * diameter - row * row)); // half pixels
        int32_t half = even ? (int32_t)floor((reach + 1) / 2) : (int32_t)floor(reach / 2);
        e->half[i] = MIN(MAX(half, even), size / 2);
    }
    return status;
}

jali_status element_disc(jali_context *ctx, double diameter_px, element *e)
{
    int32_t size = (int32_t)fmax(1, fmin(floor(diameter_px + 0.5), 1e6));
    return disc_rows(ctx, size, fmax(diameter_px, size), e); // rounding up must not leave the last row empty
}

// Row i begins 2 i + even - 1 half pixels from the centre: there the disc is widest within the row.
jali_status element_wide_disc(jali_context *ctx, int32_t size, element *e)
{
    jali_status status = element_rows(ctx, size, e);
    int32_t even = size % 2 == 0;
    for (int32_t i = 0; i < e->rows; i++) {
        double row = MAX(2 * i + even - 1, 0);
        double reach = sqrt((double)size * size - row * row); // half pixels
        e->half[i] = MIN((int32_t)ceil((reach - !even) / 2), size / 2);
    }
    return status;
}

jali_status element_sum(jali_context *ctx, const element *a, const element *b, element *sum)
{
    int32_t even = a->size % 2 == 0;
    jali_status status = element_rows(ctx, a->size + b->size - 1, sum);
    for (int32_t i = 0; i < sum->rows; i++) {
        sum->half[i] = even;
        for (int32_t j = -(b->rows - 1); j < b->rows;
             j++) { // row i of the sum = row i - j of a and row j of b
            int32_t row = i - j;
            if (row < 0) row = -row - even;
            if (row < a->rows) sum->half[i] = MAX(sum->half[i], a->half[row] + b->half[j < 0 ? -j : j]);
        }
    }
    return status;
}

jali_status element_octagon(jali_context *ctx, int32_t size, element *e)
{
    jali_status status = element_rows(ctx, size, e);
    int32_t even = size % 2 == 0;
    int32_t cut = (int32_t)floor(size / (2 + sqrt(2.0)) + 0.5); // legs of the corner's right triangle
    for (int32_t i = 0; i < e->rows; i++) {
        int32_t from_edge = (size - 1 - (2 * i + even)) / 2; // rows between this one and the outermost
        int32_t lost = MAX(cut - from_edge, 0);
        e->half[i] = MAX(size / 2 - lost, even);
    }
    return status;
}

void element_free(jali_context *ctx, element *e)
{
    release(ctx, e->half);
    *e = (element){0};
}
