// Building a block of bytes piece by piece.
#include "base/bytes.h"

#include <stdarg.h>
#include <stdio.h>

void jali_bytes_free(jali_context *ctx, jali_bytes *bytes)
{
    release(ctx, bytes->data);
    *bytes = (jali_bytes){0};
}

jali_status bytes_reserve(jali_context *ctx, jali_bytes *bytes, size_t extra)
{
    if (extra > SIZE_MAX / 2 - bytes->size)
        return fail(ctx, JALI_NO_MEMORY, "%zu bytes more are more than memory can address", extra);
    return GROW(ctx, bytes->data, bytes->capacity, bytes->size + extra);
}

jali_status bytes_append(jali_context *ctx, jali_bytes *bytes, const void *data, size_t size)
{
    jali_status status = bytes_reserve(ctx, bytes, size);
    if (status != JALI_OK || size == 0) return status;
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    return JALI_OK;
}

jali_status bytes_print(jali_context *ctx, jali_bytes *bytes, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    jali_status status = bytes_reserve(ctx, bytes, (size_t)length + 1);
    if (status == JALI_OK) {
        vsnprintf((char *)bytes->data + bytes->size, (size_t)length + 1, format, again);
        bytes->size += (size_t)length;
    }
    va_end(again);
    va_end(arguments);
    return status;
}
