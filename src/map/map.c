// Maps of a sheet: values at its nodes, linear between them, as a picture with a legend; or on a solid, for a
// render.
//
// Source:  the colours run through five of the points of viridis (van der Walt and Smith, 2015): light grows
// with the
//          value, and neither tone depends on telling red from green. Orange to dark red stand for one thing:
//          above the limit.
// Checked: tests/test_map.c; by eye.
#include <jali/map.h>
#include <jali/png.h>

#include "raster/glyphs.h"
#include "mesh/sides.h"
#include "base/vector.h"

#include <math.h>
#include <stdio.h>

enum { LEGEND_PX = 150, EDGE_PX = 16, BAR_PX = 22, TEXT_SCALE = 2, TICKS = 5 };

static const double BELOW_LIMIT = 0.6; // of the legend's bar

static const uint8_t paper[3] = {250, 249, 246}, ink[3] = {30, 32, 36};

jali_map_options jali_map_defaults(void)
{
    return (jali_map_options){.longer_px = 1200};
}

double jali_map_value(const jali_analysis *a, jali_quantity quantity, int32_t node)
{
    if (quantity == JALI_STRESS) return a->mean_mpa[node];
    const double *u = a->displacement[node];
    return sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
}

// A place among a row of colours.
static void mix(const uint8_t (*point)[3], int32_t count, double share, uint8_t rgb[3])
{
    double place = (count - 1) * fmin(fmax(share, 0), 1);
    int32_t i = MIN((int32_t)place, count - 2);
    for (int k = 0; k < 3; k++)
        rgb[k] = (uint8_t)(point[i][k] + (place - i) * (point[i + 1][k] - point[i][k]) + 0.5);
}

void jali_map_colour(double value, double limit, double top, uint8_t rgb[3])
{
    static const uint8_t within[5][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    static const uint8_t beyond[3][3] = {{252, 141, 40}, {214, 33, 32}, {90, 0, 12}};
    if (limit > 0 && value > limit)
        mix(beyond, 3, top > limit ? log(value / limit) / log(top / limit) : 0, rgb);
    else
        mix(within, 5, limit > 0 ? value / limit : top > 0 ? value / top : 0, rgb);
}

// The end of the scale.
static double top_of(const jali_analysis *a, const jali_map_options *opt)
{
    if (opt->top > 0) return opt->top;
    double top = opt->limit;
    for (int32_t i = 0; i < a->node_count; i++) top = fmax(top, jali_map_value(a, opt->quantity, i));
    return top > 0 ? top : 1;
}

typedef struct view {
    double left, high, px; // the chart's units of the picture's upper left corner; px a unit
    int32_t width, height; // of the picture on the canvas; the legend stands beside it
} view;

// One triangle, at the pixel centres it holds.
static void paint_triangle(canvas *c, const view *v, const int32_t *const at[3], const double value[3],
                           double limit, double top)
{
    double x[3], y[3], x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
    for (int i = 0; i < 3; i++) {
        x[i] = (at[i][0] - v->left) * v->px;
        y[i] = (v->high - at[i][1]) * v->px;
        x0 = fmin(x0, x[i]), x1 = fmax(x1, x[i]), y0 = fmin(y0, y[i]), y1 = fmax(y1, y[i]);
    }
    double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area == 0) return;
    for (int32_t row = MAX(0, (int32_t)ceil(y0 - 0.5)); row < v->height && row + 0.5 <= y1; row++)
        for (int32_t column = MAX(0, (int32_t)ceil(x0 - 0.5)); column < v->width && column + 0.5 <= x1;
             column++) {
            double px = column + 0.5, py = row + 0.5, w[3], least = 1, sum = 0;
            for (int i = 0; i < 3; i++) {
                int a = (i + 1) % 3, b = (i + 2) % 3;
                w[i] = ((x[a] - px) * (y[b] - py) - (x[b] - px) * (y[a] - py)) / area;
                least = fmin(least, w[i]);
                sum += w[i] * value[i];
            }
            if (least < 0) continue;
            uint8_t rgb[3];
            jali_map_colour(sum, limit, top, rgb);
            set_pixel(c, column, row, rgb);
        }
}

static void paint_sheet(canvas *c, const view *v, const jali_sheet *sheet, const jali_analysis *a,
                        const jali_map_options *opt, double top)
{
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *corner = sheet->triangle[t], *at[3];
        double value[3];
        bool shown = true;
        for (int i = 0; i < 3; i++) {
            at[i] = sheet->at[corner[i]];
            shown = shown && at[i][0] != INT32_MIN;
            value[i] = jali_map_value(a, opt->quantity, corner[i]);
        }
        if (shown) paint_triangle(c, v, at, value, opt->limit, top);
    }
}

// The value at a share of the bar's height: linear up to the limit, which stands at BELOW_LIMIT when there is
// more, then as the colours go.
static double bar_value(double share, double limit, double top)
{
    if (limit <= 0 || limit >= top) return share * top;
    if (share <= BELOW_LIMIT) return share / BELOW_LIMIT * limit;
    return limit * pow(top / limit, (share - BELOW_LIMIT) / (1 - BELOW_LIMIT));
}

static void paint_tick(canvas *c, int32_t left, int32_t y, double value, int32_t reach)
{
    char text[24];
    snprintf(text, sizeof text, "%.3g", value);
    for (int32_t x = -reach; x < BAR_PX + 6; x++) set_pixel(c, left + (x < 0 ? x : MAX(x, BAR_PX)), y, ink);
    write_text(c, left + BAR_PX + 10, y - 3 * TEXT_SCALE, TEXT_SCALE, text, ink);
}

// A bar of the colours, its values beside it, the limit with a longer mark.
static void paint_legend(canvas *c, int32_t left, int32_t height, const jali_map_options *opt, double top)
{
    const char *unit = opt->quantity == JALI_STRESS ? "MPa" : "mm";
    int32_t line = 10 * TEXT_SCALE, first = EDGE_PX + 2 * line, rows = MAX(height - first - EDGE_PX, 16);
    bool split = opt->limit > 0 && opt->limit < top;
    write_text(c, left, EDGE_PX, TEXT_SCALE, unit, ink);
    for (int32_t y = 0; y < rows; y++) {
        uint8_t rgb[3];
        jali_map_colour(bar_value((double)(rows - 1 - y) / (rows - 1), opt->limit, top), opt->limit, top,
                        rgb);
        for (int32_t x = 0; x < BAR_PX; x++) set_pixel(c, left + x, first + y, rgb);
    }
    int32_t ticks = MAX(1, MIN(TICKS, rows / (2 * line)));
    for (int32_t i = 0; i <= ticks; i++) {
        double share = (double)i / ticks;
        int32_t y = first + (int32_t)((rows - 1) * (1 - share));
        bool at_limit = split && fabs(share - BELOW_LIMIT) < 1e-9;
        paint_tick(c, left, y, bar_value(share, opt->limit, top), at_limit ? 8 : 0);
    }
}

static jali_status check_options(jali_context *ctx, const jali_map_options *opt)
{
    if (opt->longer_px < 64 || opt->longer_px > 8192)
        return fail(ctx, JALI_BAD_VALUE, "a map of %d px; its longer side may have 64 to 8192",
                    opt->longer_px);
    if (!(opt->limit >= 0) || !(opt->top >= 0))
        return fail(ctx, JALI_BAD_VALUE, "a map's limit %g and top %g must be 0 or more", opt->limit,
                    opt->top);
    return JALI_OK;
}

jali_status jali_map_png(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *a,
                         const jali_chart *chart, const jali_map_options *given, jali_bytes *png)
{
    jali_status status;
    jali_map_options opt = given ? *given : jali_map_defaults();
    canvas c = {0};
    int32_t columns = chart->width_px - 2 * chart->margin_px, rows = chart->height_px - 2 * chart->margin_px;
    TRY(check_options(ctx, &opt));
    double scale = (double)opt.longer_px / MAX(columns, rows), top = top_of(a, &opt);
    int32_t width = MAX(1, (int32_t)(columns * scale)), height = MAX(1, (int32_t)(rows * scale));
    view v = {.left = (double)chart->margin_px * chart->pixel_units,
              .high = (double)(chart->height_px - chart->margin_px) * chart->pixel_units,
              .px = scale / chart->pixel_units,
              .width = width,
              .height = height};
    c.width = width + LEGEND_PX + 4 * EDGE_PX;
    c.height = MAX(height, 160);
    TRY(step(ctx, "map", 0));
    TRY(ALLOCATE(ctx, c.rgb, 3 * (size_t)c.width * (size_t)c.height));
    for (int32_t y = 0; y < c.height; y++)
        for (int32_t x = 0; x < c.width; x++) set_pixel(&c, x, y, paper);
    paint_sheet(&c, &v, sheet, a, &opt, top);
    paint_legend(&c, width + 5 * EDGE_PX, c.height, &opt, top);
    TRY(jali_rgb_png(ctx, c.width, c.height, c.rgb, png));
done:
    release(ctx, c.rgb);
    return status;
}

// --- A solid with colours

// Normals of the sheet at its nodes, unit.
static void add_normals(const jali_sheet *sheet, double (*normal)[3])
{
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *c = sheet->triangle[t];
        double v[3];
        area_vector(sheet->node[c[0]], sheet->node[c[1]], sheet->node[c[2]], v);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) normal[c[i]][k] += v[k];
    }
    for (int32_t i = 0; i < sheet->node_count; i++) {
        double *n = normal[i], size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) n[k] = size > 0 ? n[k] / size : 0;
    }
}

void jali_map_release(jali_context *ctx, uint8_t (*colour)[3])
{
    release(ctx, colour);
}

jali_status jali_map_solid(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *a,
                           const jali_map_options *given, double exaggeration, jali_mesh *mesh,
                           uint8_t (**colour)[3])
{
    jali_status status;
    jali_map_options opt = given ? *given : jali_map_defaults();
    double(*normal)[3] = NULL;
    sides linked = {0};
    int32_t n = sheet->node_count, triangles = 0;
    size_t open_sides = 0;
    *mesh = (jali_mesh){0};
    *colour = NULL;
    TRY(check_options(ctx, &opt));
    double top = top_of(a, &opt);
    TRY(ALLOCATE_CLEARED(ctx, normal, n));
    TRY(sides_create(ctx, n, sheet->triangle_count, (const int32_t(*)[3])sheet->triangle, &linked));
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int i = 0; i < 3; i++) open_sides += linked.beside[4 * t + i] == NO_SIDE;
    TRY(ALLOCATE(ctx, mesh->vertex, 2 * (size_t)n));
    TRY(ALLOCATE(ctx, *colour, 2 * (size_t)n));
    TRY(ALLOCATE(ctx, mesh->triangle, 2 * ((size_t)sheet->triangle_count + open_sides)));
    add_normals(sheet, normal);
    for (int32_t i = 0; i < 2 * n; i++) {
        double half = (i < n ? 0.5 : -0.5) * sheet->thickness_mm[i % n];
        for (int k = 0; k < 3; k++)
            mesh->vertex[i][k] =
                sheet->node[i % n][k] + half * normal[i % n][k] + exaggeration * a->displacement[i % n][k];
        jali_map_colour(jali_map_value(a, opt.quantity, i % n), opt.limit, top, (*colour)[i]);
    }
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *c = sheet->triangle[t];
        memcpy(mesh->triangle[triangles++], (int32_t[]){c[0], c[1], c[2]}, sizeof *mesh->triangle);
        memcpy(mesh->triangle[triangles++], (int32_t[]){n + c[2], n + c[1], n + c[0]},
               sizeof *mesh->triangle);
    }
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            if (linked.beside[4 * t + i] != NO_SIDE) continue;
            int32_t from = sheet->triangle[t][(i + 1) % 3], to = sheet->triangle[t][(i + 2) % 3];
            memcpy(mesh->triangle[triangles++], (int32_t[]){to, from, n + from}, sizeof *mesh->triangle);
            memcpy(mesh->triangle[triangles++], (int32_t[]){to, n + from, n + to}, sizeof *mesh->triangle);
        }
    mesh->vertex_count = 2 * n;
    mesh->triangle_count = triangles;
done:
    if (status != JALI_OK) {
        jali_mesh_free(ctx, mesh);
        release(ctx, *colour);
        *colour = NULL;
    }
    sides_free(ctx, &linked);
    release(ctx, normal);
    return status;
}
