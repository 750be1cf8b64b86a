// Sheets of plates from any bytes: polygons anywhere, touching, crossing, needle-sharp or a unit apart.
#include "judge_sheet.h"
#include "drawn.h"

#include <jali/sheet.h>

#include <string.h>

enum { MOST_CONTOURS = 16, MOST_POINTS = 16, PIXELS = 64 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct bytes_left {
    const uint8_t *at, *end;
} bytes_left;

static int32_t next_byte(bytes_left *in)
{
    return in->at < in->end ? *in->at++ : 0;
}

// A coordinate on a grid of a pixel, or a few units beside one.
static int32_t next_place(bytes_left *in, int32_t pixel_units)
{
    int32_t place = next_byte(in) % (PIXELS + 1) * pixel_units;
    return place + (next_byte(in) % 7 == 0 ? next_byte(in) % 9 - 4 : 0);
}

static double signed_area(const jali_contours *c)
{
    double twice = 0;
    for (int32_t i = 0; i < c->contour_count; i++)
        for (int32_t first = c->first[i], end = c->first[i + 1], k = first; k < end; k++) {
            const int32_t *a = c->point[k], *b = c->point[k + 1 < end ? k + 1 : first];
            twice += (double)a[0] * b[1] - (double)b[0] * a[1];
        }
    return 0.5 * twice * c->unit_mm * c->unit_mm;
}

static double perimeter(const jali_contours *one)
{
    double sum = 0;
    for (int32_t i = 0; i < one->point_count; i++) {
        const int32_t *a = one->point[i], *b = one->point[(i + 1) % one->point_count];
        sum += hypot(b[0] - a[0], b[1] - a[1]);
    }
    return sum * one->unit_mm;
}

static void require_sheet(jali_context *ctx, jali_status status, const jali_sheet *sheet)
{
    if (status != JALI_OK) {
        REQUIRE(status == JALI_BAD_INPUT || status == JALI_NO_RESULT);
        REQUIRE(strlen(jali_message(ctx)) > 0 && sheet->node == NULL && sheet->triangle_count == 0);
        return;
    }
    REQUIRE(sheet->triangle_count > 0 && sheet->node_count < 3 * 1000 * 1000);
    REQUIRE(is_manifold(sheet));
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const double *a = sheet->node[sheet->triangle[t][0]], *b = sheet->node[sheet->triangle[t][1]],
                     *c = sheet->node[sheet->triangle[t][2]];
        REQUIRE((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes_left in = {data, data + size};
    int32_t first[MOST_CONTOURS + 1] = {0}, point[MOST_CONTOURS * MOST_POINTS][2];
    jali_chart chart = {
        .width_px = PIXELS, .height_px = PIXELS, .margin_px = 4, .pixel_units = 64, .unit_mm = 1.0 / 512};
    jali_contours plate = {.first = first, .point = point, .unit_mm = chart.unit_mm};
    jali_sheet_options opt = jali_sheet_defaults();
    jali_context_options own = jali_context_defaults();
    jali_context *ctx;
    jali_sheet sheet;
    int32_t bits = next_byte(&in);
    chart.outside_solid = bits & 1;
    opt.whole = bits & 2;
    opt.across = 1 + (bits >> 2) % 4;
    while (in.at < in.end && plate.contour_count < MOST_CONTOURS) {
        int32_t count = 3 + next_byte(&in) % (MOST_POINTS - 2);
        for (int32_t i = 0; i < count; i++, plate.point_count++)
            for (int k = 0; k < 2; k++) point[plate.point_count][k] = next_place(&in, chart.pixel_units);
        first[++plate.contour_count] = plate.point_count;
    }
    own.threads = 1;
    REQUIRE(jali_context_create(&own, &ctx) == JALI_OK);
    jali_status status = jali_sheet_plate(ctx, &plate, &chart, 2, &opt, &sheet);
    require_sheet(ctx, status, &sheet);
    // One contour alone cannot lie inside another: what is inside it is all there is, but for points dropped.
    if (status == JALI_OK && plate.contour_count == 1 && (opt.whole || !chart.outside_solid)) {
        double least = 0.125 * opt.phi_s_mm / opt.across;
        REQUIRE(fabs(area_of(&sheet) - fabs(signed_area(&plate))) < 1e-3 + least * perimeter(&plate));
    }
    jali_sheet_free(ctx, &sheet);
    jali_context_free(ctx);
    return 0;
}
