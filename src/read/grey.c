// Grey pictures: rows of colour to grey, crop, turn, mirror, invert.
//
// Checked: tests/test_read.c: against the formulas in floating point; four quarter turns are nothing.
#include "read/read.h"

VECTORISED void grey_row(const uint8_t *samples, int32_t channels, int32_t width, uint8_t *grey)
{
    switch (channels) {
    case 1: memcpy(grey, samples, (size_t)width); break;
    case 2:
        for (int32_t x = 0; x < width; x++)
            grey[x] = (uint8_t)over_white(samples[2 * x], samples[2 * x + 1], 255);
        break;
    case 3:
        for (int32_t x = 0; x < width; x++)
            grey[x] = (uint8_t)luma(samples[3 * x], samples[3 * x + 1], samples[3 * x + 2]);
        break;
    default:
        for (int32_t x = 0; x < width; x++) {
            const uint8_t *s = &samples[4 * x];
            grey[x] = (uint8_t)over_white(luma(s[0], s[1], s[2]), s[3], 255);
        }
    }
}

jali_status crop_picture(jali_context *ctx, jali_picture *picture, const int32_t crop_px[4])
{
    int32_t left = crop_px[0], top = crop_px[1], width = crop_px[2], height = crop_px[3];
    if (left == 0 && top == 0 && width == 0 && height == 0) return JALI_OK;
    if (left < 0 || top < 0 || width < 1 || height < 1 || left > picture->width_px - width ||
        top > picture->height_px - height)
        return fail(ctx, JALI_BAD_VALUE,
                    "the crop %d,%d,%d,%d (left, top, width, height) does not lie inside "
                    "the picture of %d x %d px",
                    left, top, width, height, picture->width_px, picture->height_px);
    const uint8_t *from = picture->grey + (int64_t)top * picture->width_px + left;
    for (int64_t y = 0; y < height; y++)
        memmove(picture->grey + y * width, from + y * picture->width_px, (size_t)width);
    picture->width_px = width;
    picture->height_px = height;
    return JALI_OK;
}

static void reverse(uint8_t *grey, int64_t count)
{
    for (int64_t i = 0, j = count - 1; i < j; i++, j--) {
        uint8_t swapped = grey[i];
        grey[i] = grey[j];
        grey[j] = swapped;
    }
}

// Square tiles keep both the rows read and the rows written in the cache.
static void turn_clockwise(const jali_picture *from, jali_picture *to)
{
    enum { TILE = 64 };
    int64_t width = from->width_px, height = from->height_px;
    for (int64_t y0 = 0; y0 < height; y0 += TILE)
        for (int64_t x0 = 0; x0 < width; x0 += TILE)
            for (int64_t x = x0; x < MIN(x0 + TILE, width); x++)
                for (int64_t y = y0; y < MIN(y0 + TILE, height); y++)
                    to->grey[x * height + height - 1 - y] = from->grey[y * width + x];
}

jali_status turn_picture(jali_context *ctx, jali_picture *picture, int32_t quarter_turns)
{
    int64_t count = (int64_t)picture->width_px * picture->height_px;
    if (quarter_turns >= 2) reverse(picture->grey, count);
    if (quarter_turns % 2 == 0) return JALI_OK;
    jali_picture turned = {.width_px = picture->height_px, .height_px = picture->width_px};
    jali_status status = ALLOCATE(ctx, turned.grey, count);
    if (status != JALI_OK) return status;
    turn_clockwise(picture, &turned);
    jali_picture_free(ctx, picture);
    *picture = turned;
    return JALI_OK;
}

void mirror_picture(jali_picture *picture)
{
    for (int64_t y = 0; y < picture->height_px; y++)
        reverse(picture->grey + y * picture->width_px, picture->width_px);
}

void invert_picture(jali_picture *picture)
{
    int64_t count = (int64_t)picture->width_px * picture->height_px;
    for (int64_t i = 0; i < count; i++) picture->grey[i] = (uint8_t)(255 - picture->grey[i]);
}
