// What was measured, drawn over the straightened scan: outlines as designed, widths designed and measured.
#include "calibrate/view.h"

#include <jali/png.h>
#include <stdio.h>

#include "raster/glyphs.h"

enum {
    CELL_PX = 120,
    TEXT_SCALE = 2,
    TEXT_PX = 7 * TEXT_SCALE,
    LETTER_PX = 6 * TEXT_SCALE,
    MOST_SAMPLES = 4
};
static const double FADE = 0.45; // of the scan's contrast: outlines and figures stand before it

static const uint8_t there[3] = {0, 90, 200}, gone[3] = {220, 0, 0}, ink[3] = {20, 20, 20},
                     paper[3] = {255, 255, 255};

// The picture in the making.
typedef struct sheet {
    const jali_picture *picture;
    const jali_scan *scan;
    homography map;
    double pixel_mm;
    int32_t samples; // on each side of a pixel
    canvas c;
} sheet;

static void paint_row(void *shared, int32_t row)
{
    const sheet *s = shared;
    uint8_t *rgb = s->c.rgb + 3 * (size_t)row * (size_t)s->c.width;
    for (int32_t column = 0; column < s->c.width; column++, rgb += 3) {
        double sum = 0;
        for (int32_t i = 0; i < s->samples * s->samples; i++) {
            int32_t u = i % s->samples, v = i / s->samples;
            double x = (column + (u + 0.5) / s->samples) * s->pixel_mm;
            double y = (row + (v + 0.5) / s->samples) * s->pixel_mm;
            double level = seen_at(s->picture, &s->map, x, s->scan->board.height_mm - y);
            sum += isnan(level) ? 1 : level;
        }
        double level = 1 - FADE + FADE * sum / (s->samples * s->samples);
        rgb[0] = rgb[1] = rgb[2] = (uint8_t)lround(255 * level);
    }
}

static void place_on(const sheet *s, double x_mm, double y_mm, double at[2])
{
    at[0] = x_mm / s->pixel_mm;
    at[1] = (s->scan->board.height_mm - y_mm) / s->pixel_mm;
}

static void draw_line(sheet *s, const double from[2], const double to[2], const uint8_t rgb[3])
{
    int32_t steps = 1 + (int32_t)fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1]));
    for (int32_t i = 0; i <= steps; i++)
        set_pixel(&s->c, (int32_t)(from[0] + (to[0] - from[0]) * i / steps),
                  (int32_t)(from[1] + (to[1] - from[1]) * i / steps), rgb);
}

static void draw_ring(sheet *s, const jali_board_feature *f, const uint8_t rgb[3])
{
    enum { SIDES = 48 };
    double from[2], to[2];
    for (int k = 0; k <= SIDES; k++) {
        double angle = 2 * M_PI * k / SIDES, radius = f->width_mm / 2;
        place_on(s, f->at_mm[0] + radius * cos(angle), f->at_mm[1] + radius * sin(angle), to);
        if (k > 0) draw_line(s, from, to, rgb);
        memcpy(from, to, sizeof from);
    }
}

static void draw_bar(sheet *s, const jali_board_feature *f, const uint8_t rgb[3])
{
    static const double along[3][2] = {{1, 0}, {0, 1}, {M_SQRT1_2, M_SQRT1_2}};
    static const double side[5][2] = {{-.5, -.5}, {.5, -.5}, {.5, .5}, {-.5, .5}, {-.5, -.5}};
    const double *d = along[f->direction];
    double from[2], to[2];
    for (int k = 0; k < 5; k++) {
        double u = side[k][0] * f->length_mm, v = side[k][1] * f->width_mm;
        place_on(s, f->at_mm[0] + u * d[0] - v * d[1], f->at_mm[1] + u * d[1] + v * d[0], to);
        if (k > 0) draw_line(s, from, to, rgb);
        memcpy(from, to, sizeof from);
    }
}

// Both widths in the web below the cell.
static void write_widths(sheet *s, const jali_board_feature *f, const jali_measured *m)
{
    char designed[16], measured[16];
    double at[2];
    snprintf(designed, sizeof designed, "%.2f", f->width_mm);
    snprintf(measured, sizeof measured, m->printed ? "%.3f" : "-", m->width_mm);
    place_on(s, f->at_mm[0], f->at_mm[1] - s->scan->board.cell_mm / 2, at);
    int32_t length = (int32_t)(strlen(designed) + strlen(measured)) * LETTER_PX + LETTER_PX / 2;
    int32_t x = (int32_t)at[0] - length / 2, y = (int32_t)at[1] - TEXT_PX / 2;
    for (int32_t v = -2; v < TEXT_PX + 2; v++)
        for (int32_t u = -2; u < length; u++) set_pixel(&s->c, x + u, y + v, paper);
    write_text(&s->c, x, y, TEXT_SCALE, designed, ink);
    write_text(&s->c, x + (int32_t)strlen(designed) * LETTER_PX + LETTER_PX / 2, y, TEXT_SCALE, measured,
               m->printed ? there : gone);
}

jali_status jali_scan_map(jali_context *ctx, const jali_picture *picture, const jali_scan *scan,
                          jali_bytes *png)
{
    jali_status status;
    const jali_board *b = &scan->board;
    sheet s = {.picture = picture, .scan = scan, .pixel_mm = b->cell_mm / CELL_PX};
    memcpy(s.map.m, scan->map, sizeof s.map.m);
    s.c.width = (int32_t)ceil(b->width_mm / s.pixel_mm);
    s.c.height = (int32_t)ceil(b->height_mm / s.pixel_mm);
    s.samples = (int32_t)fmin(fmax(ceil(s.pixel_mm / scan->pixel_mm), 1), MOST_SAMPLES);
    TRY(ALLOCATE(ctx, s.c.rgb, 3 * (size_t)s.c.width * (size_t)s.c.height));
    parallel(ctx, s.c.height, paint_row, &s);
    for (int32_t i = 0; i < b->feature_count; i++) {
        const jali_board_feature *f = &b->feature[i];
        const uint8_t *rgb = scan->feature[i].printed ? there : gone;
        f->direction == JALI_BOARD_ROUND ? draw_ring(&s, f, rgb) : draw_bar(&s, f, rgb);
        write_widths(&s, f, &scan->feature[i]);
    }
    TRY(jali_rgb_png(ctx, s.c.width, s.c.height, s.c.rgb, png));
done:
    release(ctx, s.c.rgb);
    return status;
}
