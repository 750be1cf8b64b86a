// A block of bytes: the contents of a file before it is written or after it was read.
#ifndef JALI_BYTES_H
#define JALI_BYTES_H

#include <jali/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// {0} is valid and empty.
typedef struct jali_bytes {
    uint8_t *data; // [capacity], the first `size` are in use
    size_t size, capacity;
} jali_bytes;

JALI_API void jali_bytes_free(jali_context *ctx, jali_bytes *bytes);

#ifdef __cplusplus
}
#endif
#endif
