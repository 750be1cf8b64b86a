// Surfaces as values.
#include <jali/surface.h>

#include "base/base.h"

void jali_surface_free(jali_context *ctx, jali_surface *surface)
{
    jali_mesh_free(ctx, &surface->mesh);
    release(ctx, surface->uv);
    *surface = (jali_surface){0};
}
