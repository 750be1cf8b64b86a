// Building a block of bytes piece by piece.
#ifndef BASE_BYTES_H
#define BASE_BYTES_H

#include "base/base.h"
#include <jali/bytes.h>

/// Make room for `extra` bytes behind the ones in use; the caller writes there and raises size.
jali_status bytes_reserve(jali_context *ctx, jali_bytes *bytes, size_t extra);
jali_status bytes_append(jali_context *ctx, jali_bytes *bytes, const void *data, size_t size);

/// Append formatted text. Numbers with a fraction go through number.h: printf follows the locale.
jali_status bytes_print(jali_context *ctx, jali_bytes *bytes, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
