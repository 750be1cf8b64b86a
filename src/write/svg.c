// SVG: the contours as one path in whole lattice units, relative, so that it is exact and short.
#include <jali/write.h>

#include "base/number.h"
#include "write/xml.h"

#include <math.h>

static int write_signed(char *text, int64_t value)
{
    if (value >= 0) return write_whole(text, (uint64_t)value);
    text[0] = '-';
    return 1 + write_whole(text + 1, (uint64_t)-value);
}

// " 12 -3"; the y axis turns over.
static jali_status put_step(jali_context *ctx, int64_t dx, int64_t dy, jali_bytes *bytes)
{
    enum { ROOM = 48 };
    jali_status status = bytes_reserve(ctx, bytes, ROOM);
    if (status != JALI_OK) return status;
    char *start = (char *)bytes->data + bytes->size, *to = start;
    *to++ = ' ';
    to += write_signed(to, dx);
    if (dy <= 0) *to++ = ' '; // a minus sign separates, too
    to += write_signed(to, -dy);
    bytes->size += (size_t)(to - start);
    return JALI_OK;
}

static jali_status put_contour(jali_context *ctx, const jali_contours *c, int32_t index, int64_t top,
                               jali_bytes *bytes)
{
    jali_status status = JALI_OK;
    int64_t x = 0, y = 0;
    for (int32_t i = c->first[index]; i < c->first[index + 1]; i++) {
        bool start = i == c->first[index];
        int64_t px = c->point[i][0], py = (int64_t)c->point[i][1] - top;
        if (start || i == c->first[index] + 1) TRY(bytes_append(ctx, bytes, start ? "M" : "l", 1));
        TRY(put_step(ctx, px - x, py - y, bytes));
        x = px;
        y = py;
    }
    TRY(bytes_append(ctx, bytes, "z\n", 2));
done:
    return status;
}

static jali_status put_decimal(jali_context *ctx, const char *before, double value, const char *behind,
                               jali_bytes *bytes)
{
    char text[DECIMAL_BYTES];
    return bytes_print(ctx, bytes, "%s%.*s%s", before, write_decimal(text, value), text, behind);
}

jali_status jali_write_svg(jali_context *ctx, const jali_contours *c, double width_mm, double height_mm,
                           const jali_write_options *opt, jali_bytes *bytes)
{
    jali_status status;
    int64_t low[2] = {0, 0}, high[2] = {0, 0};
    bool sheet = width_mm > 0 && height_mm > 0;
    for (int32_t i = 0; i < c->point_count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = i ? MIN(low[k], c->point[i][k]) : c->point[i][k];
            high[k] = i ? MAX(high[k], c->point[i][k]) : c->point[i][k];
        }
    if (sheet) {
        low[0] = low[1] = 0;
        high[0] = llround(width_mm / c->unit_mm);
        high[1] = llround(height_mm / c->unit_mm);
    }
    long long width = high[0] - low[0], height = high[1] - low[1];
    TRY(bytes_print(ctx, bytes,
                    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" "));
    TRY(put_decimal(ctx, "width=\"", (double)width * c->unit_mm, "mm\" ", bytes));
    TRY(put_decimal(ctx, "height=\"", (double)height * c->unit_mm, "mm\" ", bytes));
    TRY(bytes_print(ctx, bytes, "viewBox=\"%lld 0 %lld %lld\">\n", (long long)low[0], width, height));
    if (opt && opt->title) {
        TRY(bytes_print(ctx, bytes, "<title>"));
        TRY(xml_text(ctx, opt->title, bytes));
        TRY(bytes_print(ctx, bytes, "</title>\n"));
    }
    TRY(bytes_print(ctx, bytes, "<path fill=\"#000\" fill-rule=\"evenodd\" d=\""));
    for (int32_t i = 0; i < c->contour_count; i++) {
        if (i % 1024 == 0) TRY(step(ctx, "write", (double)i / c->contour_count));
        TRY(put_contour(ctx, c, i, high[1], bytes));
    }
    TRY(bytes_print(ctx, bytes, "\"/>\n</svg>\n"));
done:
    return status;
}
