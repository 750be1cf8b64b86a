// DXF R12: the oldest dialect, which every program reads. A closed POLYLINE a contour.
//
// Source:  Autodesk, DXF reference for Release 12. The drawing's unit ($INSUNITS 4, mm) is younger than R12
//          and ignored where it is not known; the numbers are mm either way.
#include <jali/write.h>

#include "base/number.h"
#include "base/bytes.h"

static const char head[] =
    "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n4\n9\n$MEASUREMENT\n70\n1\n"
    "0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n2\n"
    "0\nLAYER\n2\nOUTLINE\n70\n0\n62\n7\n6\nCONTINUOUS\n"
    "0\nLAYER\n2\nHOLES\n70\n0\n62\n1\n6\nCONTINUOUS\n"
    "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
static const char tail[] = "0\nENDSEC\n0\nEOF\n";

// Twice the signed area; positive around solid. Products of 32-bit steps fit, their sum is kept in 128.
static bool runs_around_solid(const jali_contours *c, int32_t index)
{
    __int128 area = 0;
    for (int32_t i = c->first[index]; i < c->first[index + 1]; i++) {
        int32_t next = i + 1 < c->first[index + 1] ? i + 1 : c->first[index];
        area += (__int128)c->point[i][0] * c->point[next][1] - (__int128)c->point[next][0] * c->point[i][1];
    }
    return area > 0;
}

static jali_status put_contour(jali_context *ctx, const jali_contours *c, int32_t index, jali_bytes *bytes)
{
    jali_status status;
    const char *layer = runs_around_solid(c, index) ? "OUTLINE" : "HOLES";
    TRY(bytes_print(ctx, bytes, "0\nPOLYLINE\n8\n%s\n66\n1\n10\n0\n20\n0\n30\n0\n70\n1\n", layer));
    for (int32_t i = c->first[index]; i < c->first[index + 1]; i++) {
        char x[DECIMAL_BYTES], y[DECIMAL_BYTES];
        int x_length = write_decimal(x, c->point[i][0] * c->unit_mm);
        int y_length = write_decimal(y, c->point[i][1] * c->unit_mm);
        TRY(bytes_print(ctx, bytes, "0\nVERTEX\n8\n%s\n10\n%.*s\n20\n%.*s\n30\n0\n", layer, x_length, x,
                        y_length, y));
    }
    TRY(bytes_print(ctx, bytes, "0\nSEQEND\n8\n%s\n", layer));
done:
    return status;
}

jali_status jali_write_dxf(jali_context *ctx, const jali_contours *c, jali_bytes *bytes)
{
    jali_status status;
    TRY(bytes_append(ctx, bytes, head, sizeof head - 1));
    for (int32_t i = 0; i < c->contour_count; i++) {
        if (i % 1024 == 0) TRY(step(ctx, "write", (double)i / c->contour_count));
        TRY(put_contour(ctx, c, i, bytes));
    }
    TRY(bytes_append(ctx, bytes, tail, sizeof tail - 1));
done:
    return status;
}
