// The smallest program that goes through the library: a sample, carved and checked.
#include <jali/jali.h>
#include <stdio.h>

int main(void)
{
    jali_context *ctx;
    jali_bitmap picture;
    jali_bytes png = {0};
    jali_picture grey;
    jali_result result = {0};
    if (jali_context_create(NULL, &ctx) != JALI_OK) return 1;
    bool good = jali_sample(ctx, "rings", 128, &picture) == JALI_OK &&
                jali_bitmap_png(ctx, &picture, 0, &png) == JALI_OK &&
                jali_read_bytes(ctx, png.data, png.size, "rings", NULL, &grey) == JALI_OK &&
                jali_make(ctx, &grey, NULL, &result) == JALI_OK && result.check.solid;
    if (!good) fprintf(stderr, "jali %s: %s\n", jali_version(), jali_message(ctx));
    jali_result_free(ctx, &result);
    jali_picture_free(ctx, &grey);
    jali_bytes_free(ctx, &png);
    jali_bitmap_free(ctx, &picture);
    jali_context_free(ctx);
    return good ? 0 : 1;
}
