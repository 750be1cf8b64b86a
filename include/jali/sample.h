// The built-in pictures: drawn by procedure at any size, so that the project needs no file from outside.
#ifndef JALI_SAMPLE_H
#define JALI_SAMPLE_H

#include <jali/bitmap.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_sample_info {
    const char *name;
    const char *what; // one line
} jali_sample_info;

/// The samples, in the order to show them; their number is put in `count`.
JALI_API const jali_sample_info *jali_sample_list(int32_t *count);

/// Draw a sample: square, the same on every machine, white where a pixel's centre is solid.
///   in     name     one of jali_sample_list
///          side_px  16 .. 32,768
///   out    bitmap
///   fails  JALI_BAD_VALUE (unknown name: the message lists them), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   O(words + rows x shapes met)
JALI_API jali_status jali_sample(jali_context *ctx, const char *name, int32_t side_px, jali_bitmap *bitmap);

#ifdef __cplusplus
}
#endif
#endif
