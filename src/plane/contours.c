// Contours as values.
#include <jali/contours.h>

#include "base/base.h"

void jali_contours_free(jali_context *ctx, jali_contours *contours)
{
    release(ctx, contours->first);
    release(ctx, contours->point);
    *contours = (jali_contours){0};
}
