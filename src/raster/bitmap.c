// Bitmaps as values: create, copy, free.
#include "raster/raster.h"
#include "base/base.h"

static jali_status create(jali_context *ctx, int32_t width_px, int32_t height_px, bool cleared,
                          jali_bitmap *bitmap)
{
    *bitmap = (jali_bitmap){0};
    if (width_px < 0 || height_px < 0 || width_px > 1 << 20 || height_px > 1 << 20)
        return fail(ctx, JALI_BAD_VALUE, "a bitmap of %d x %d px is outside 0 .. 1048576 px a side", width_px,
                    height_px);
    int64_t stride = ((int64_t)width_px + 511) / 512 * 8;
    uint64_t *word;
    jali_status status =
        cleared ? ALLOCATE_CLEARED(ctx, word, stride * height_px) : ALLOCATE(ctx, word, stride * height_px);
    if (status == JALI_OK) *bitmap = (jali_bitmap){width_px, height_px, stride, word};
    return status;
}

jali_status jali_bitmap_create(jali_context *ctx, int32_t width_px, int32_t height_px, jali_bitmap *bitmap)
{
    return create(ctx, width_px, height_px, true, bitmap);
}

jali_status jali_bitmap_copy(jali_context *ctx, const jali_bitmap *from, jali_bitmap *to)
{
    jali_bitmap copy;
    jali_status status = create(ctx, from->width_px, from->height_px, false, &copy);
    if (status == JALI_OK) copy_pixels(ctx, from, &copy);
    *to = copy;
    return status;
}

void jali_bitmap_free(jali_context *ctx, jali_bitmap *bitmap)
{
    release(ctx, bitmap->word);
    *bitmap = (jali_bitmap){0};
}
