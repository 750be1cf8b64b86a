// Points onto their common power-of-two lattice.
#include "mesh/exact.h"

#include <math.h>

enum { COORDINATE_BITS = 60 };

// The exponents of the lowest and highest bit that is set.
static void bit_range(double value, int *lowest, int *highest)
{
    int exponent;
    double fraction = frexp(value, &exponent); // value = fraction 2^exponent, 1/2 <= |fraction| < 1
    int64_t whole = (int64_t)ldexp(fraction, 53);
    *highest = exponent - 1;
    *lowest = exponent - 53 + __builtin_ctzll((uint64_t)whole);
}

static bool differences_are_narrow(const lattice *l)
{
    for (int k = 0; k < 3; k++) {
        int64_t low = INT64_MAX, high = INT64_MIN;
        for (int32_t i = 0; i < l->point_count; i++) {
            low = MIN(low, l->point[i][k]);
            high = MAX(high, l->point[i][k]);
        }
        if (l->point_count && high - low > INT32_MAX) return false;
    }
    return true;
}

jali_status lattice_create(jali_context *ctx, int32_t count, const double (*point)[3], lattice *l)
{
    *l = (lattice){.point_count = count, .exact = true};
    jali_status status = ALLOCATE(ctx, l->point, count);
    if (status != JALI_OK) return status;
    int lowest = INT32_MAX, highest = INT32_MIN;
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            int low, high;
            if (point[i][k] == 0) continue;
            bit_range(point[i][k], &low, &high);
            lowest = MIN(lowest, low);
            highest = MAX(highest, high);
        }
    if (highest < lowest) lowest = highest = 0; // nothing but zeros
    l->unit_log2 = lowest;
    if (highest - lowest >= COORDINATE_BITS) {
        l->unit_log2 = highest + 1 - COORDINATE_BITS;
        l->exact = false;
    }
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) l->point[i][k] = llrint(ldexp(point[i][k], -l->unit_log2));
    l->narrow = differences_are_narrow(l);
    return JALI_OK;
}

void lattice_free(jali_context *ctx, lattice *l)
{
    release(ctx, l->point);
    *l = (lattice){0};
}
