// The report of a run: one HTML file that holds everything, its pictures included.
//
// Pictures larger than MOST_MAP_PX are shrunk by the mean colour of whole blocks, so that no thin line
// vanishes.
#include "structure.h"
#include "base/bytes.h"

#include <jali/png.h>

enum { MOST_MAP_PX = 1400, RENDER_PX = 480 };

typedef struct rgb {
    uint8_t red, green, blue;
} rgb;

static const rgb solid = {238, 234, 224}, hollow = {38, 40, 46}, bridge = {214, 69, 48};
static const rgb contested = {120, 200, 80};
static const rgb type_colour[JALI_TYPES] = {{230, 120, 30}, {240, 190, 40}, {150, 150, 160}};

/// What the maps are made from, and the colour of one of their pixels.
typedef struct map {
    const jali_result *result;
    int32_t width, height, offset; // offset: of the map's first pixel in the working grid
    rgb (*colour)(const struct map *m, int32_t x, int32_t y);
} map;

static rgb input_colour(const map *m, int32_t x, int32_t y)
{
    return jali_bitmap_get(&m->result->input, x, y) ? solid : hollow;
}

static rgb mask_colour(const map *m, int32_t x, int32_t y)
{
    x += m->offset;
    y += m->offset;
    if (!jali_bitmap_get(&m->result->optimised.mask, x, y)) return hollow;
    return jali_bitmap_get(&m->result->optimised.bridge_mask, x, y) ? bridge : solid;
}

static rgb detail_colour(const map *m, int32_t x, int32_t y)
{
    const jali_optimised *o = &m->result->optimised;
    x += m->offset;
    y += m->offset;
    if (jali_bitmap_get(&o->conflict, x, y)) return contested;
    for (int32_t t = 0; t < JALI_TYPES; t++)
        if (jali_bitmap_get(&o->white.type[t], x, y) || jali_bitmap_get(&o->black.type[t], x, y))
            return type_colour[t];
    return jali_bitmap_get(&o->mask, x, y) ? solid : hollow;
}

static void shrink(const map *m, int32_t block, int32_t columns, int32_t rows, uint8_t *to)
{
    for (int32_t row = 0; row < rows; row++)
        for (int32_t column = 0; column < columns; column++) {
            int32_t sum[3] = {0}, count = 0;
            for (int32_t y = row * block; y < MIN((row + 1) * block, m->height); y++)
                for (int32_t x = column * block; x < MIN((column + 1) * block, m->width); x++, count++) {
                    rgb c = m->colour(m, x, y);
                    sum[0] += c.red, sum[1] += c.green, sum[2] += c.blue;
                }
            for (int32_t i = 0; i < 3; i++) *to++ = (uint8_t)(sum[i] / count);
        }
}

static jali_status append_base64(jali_context *ctx, const jali_bytes *data, jali_bytes *html)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    jali_status status = bytes_reserve(ctx, html, (data->size + 2) / 3 * 4);
    if (status != JALI_OK) return status;
    for (size_t i = 0; i < data->size; i += 3) {
        size_t left = data->size - i;
        uint32_t three = (uint32_t)data->data[i] << 16;
        if (left > 1) three |= (uint32_t)data->data[i + 1] << 8;
        if (left > 2) three |= data->data[i + 2];
        for (int32_t k = 0; k < 4; k++)
            html->data[html->size++] = (size_t)k > left ? '=' : (uint8_t)digit[three >> (18 - 6 * k) & 63];
    }
    return JALI_OK;
}

jali_status append_figure(jali_context *ctx, const jali_bytes *png, const char *title, const char *legend,
                          jali_bytes *html)
{
    jali_status status;
    TRY(bytes_print(
        ctx, html,
        "<figure><figcaption><b>%s</b> %s</figcaption><img alt=\"%s\" src=\"data:image/png;base64,", title,
        legend, title));
    TRY(append_base64(ctx, png, html));
    TRY(bytes_print(ctx, html, "\"></figure>\n"));
done:
    return status;
}

static jali_status append_map(jali_context *ctx, const map *m, const char *title, const char *legend,
                              jali_bytes *html)
{
    jali_status status;
    uint8_t *pixels = NULL;
    jali_bytes png = {0};
    int32_t block = (MAX(m->width, m->height) + MOST_MAP_PX - 1) / MOST_MAP_PX;
    int32_t columns = (m->width + block - 1) / block, rows = (m->height + block - 1) / block;
    TRY(step(ctx, "report", 0));
    TRY(ALLOCATE(ctx, pixels, (size_t)columns * (size_t)rows * 3));
    shrink(m, block, columns, rows, pixels);
    TRY(jali_rgb_png(ctx, columns, rows, pixels, &png));
    TRY(append_figure(ctx, &png, title, legend, html));
done:
    jali_bytes_free(ctx, &png);
    release(ctx, pixels);
    return status;
}

static jali_status append_render(jali_context *ctx, const jali_mesh *mesh, const jali_render_options *view,
                                 const char *title, jali_bytes *html)
{
    jali_status status;
    jali_bytes png = {0};
    TRY(render_png(ctx, mesh, view, RENDER_PX, &png));
    TRY(append_figure(ctx, &png, title, "", html));
done:
    jali_bytes_free(ctx, &png);
    return status;
}

// By day from where the first picture is seen, a little from above; at night from the usual side.
static jali_status append_renders(jali_context *ctx, const made *m, jali_bytes *html)
{
    jali_status status;
    jali_render_options day = jali_render_defaults(), night = jali_render_defaults();
    const double *seen = m->result[0].placed.direction;
    bool projected = m->set[0].surface && m->result[0].placed.placing == JALI_PLACE_PROJECT;
    if (projected)
        for (int k = 0; k < 3; k++) day.view[k] = night.view[k] = seen[k] - (k == 2 ? 0.25 : 0);
    night.lamp = true;
    TRY(append_render(ctx, &m->object.mesh, &day, "The object", html));
    TRY(append_render(ctx, &m->object.mesh, &night, "With a lamp", html));
done:
    return status;
}

#define KEY(class, words) "<span class=\"key " class "\"></span>" words " "

static jali_status append_error_map(jali_context *ctx, const jali_result *r, const jali_prediction *print,
                                    const char *title, jali_bytes *html)
{
    jali_status status;
    jali_bytes png = {0};
    TRY(jali_error_map(ctx, &r->input, &print->printed, MOST_MAP_PX, &png));
    TRY(append_figure(ctx, &png, title,
                      KEY("lost", "solid that is missing") KEY("closed", "solid that is too much"), html));
done:
    jali_bytes_free(ctx, &png);
    return status;
}

static jali_status append_maps(jali_context *ctx, const settings *set, const jali_result *r, jali_bytes *html)
{
    jali_status status;
    int32_t margin = r->chart.margin_px;
    map input = {r, r->input.width_px, r->input.height_px, 0, input_colour};
    map mask = {r, r->chart.width_px - 2 * margin, r->chart.height_px - 2 * margin, margin, mask_colour};
    map detail = mask;
    detail.colour = detail_colour;
    TRY(append_map(ctx, &input, "The picture", "", html));
    TRY(append_map(ctx, &mask, "What is carved", KEY("lost", "bridges"), html));
    if (r->optimised.conflict.width_px > 0)
        TRY(append_map(ctx, &detail, "What was too thin",
                       KEY("a", "type A: parts something") KEY("b", "type B: long") KEY("c", "type C: a tip")
                           KEY("x", "both tones want the place"),
                       html));
    if (set->make.predict) {
        TRY(append_error_map(ctx, r, &r->connected_print, "Printed when only connected", html));
        TRY(append_error_map(ctx, r, &r->result_print, "Printed as carved here", html));
    }
done:
    return status;
}

static jali_status append_escaped(jali_context *ctx, const char *text, jali_bytes *html)
{
    jali_status status = JALI_OK;
    for (; *text; text++) {
        switch (*text) {
        case '<': TRY(bytes_append(ctx, html, "&lt;", 4)); break;
        case '&': TRY(bytes_append(ctx, html, "&amp;", 5)); break;
        case '"': TRY(bytes_append(ctx, html, "&quot;", 6)); break;
        default: TRY(bytes_append(ctx, html, text, 1));
        }
    }
done:
    return status;
}

static const char head[] =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\">"
    "<meta name=\"viewport\" content=\"width=device-width\"><title>jali report</title><style>"
    "body{font:16px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:1500px;padding:0 "
    "1rem;color:#222;background:#fff}"
    "main{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:1.5rem}"
    "figure{margin:0}img{width:100%;height:auto;display:block}figcaption{min-height:3.2em;font-size:.9rem}"
    "table{border-collapse:collapse;margin:1rem 0}td,th{padding:.2rem 1rem .2rem 0;text-align:right}"
    "th:first-child,td:first-child{text-align:left}td,th{border-bottom:1px solid #ddd}"
    ".key{display:inline-block;width:.8em;height:.8em;margin:0 .3em 0 .6em}"
    ".lost{background:#d64530}.closed{background:#facc28}.a{background:#e6781e}.b{background:#f0be28}"
    ".c{background:#9696a0}.x{background:#78c850}.no{color:#b02010;font-weight:bold}</style>";

static jali_status append_promise(jali_context *ctx, const char *words, bool kept, jali_bytes *html)
{
    return bytes_print(ctx, html, kept ? "<li>%s: kept</li>" : "<li class=\"no\">%s: not kept</li>", words);
}

static jali_status append_predictions(jali_context *ctx, const settings *set, const jali_result *r,
                                      jali_bytes *html)
{
    jali_status status;
    const jali_prediction *print[] = {&r->input_print, &r->connected_print, &r->result_print};
    static const char *const what[] = {"the picture as it is", "only connected", "as carved here"};
    TRY(bytes_print(ctx, html,
                    "<table><tr><th>Predicted print of<th>wrong<th>pieces<th>thin white kept"
                    "<th>thin black kept</tr>"));
    for (int32_t i = 0; i < 3; i++) {
        TRY(bytes_print(ctx, html, "<tr><td>%s<td>%.2f %%<td>%d", what[i], 100 * print[i]->error_rate,
                        print[i]->pieces));
        if (set->make.recall)
            TRY(bytes_print(ctx, html, "<td>%.0f %%<td>%.0f %%", 100 * print[i]->recall_white,
                            100 * print[i]->recall_black));
    }
    TRY(bytes_print(ctx, html, "</table>"));
done:
    return status;
}

static jali_status append_picture(jali_context *ctx, const settings *set, const jali_picture *picture,
                                  const jali_result *r, jali_bytes *html)
{
    jali_status status;
    double pixel_mm = jali_chart_pixel_mm(&r->chart);
    TRY(bytes_print(ctx, html,
                    "<p>%d x %d px in %d white pieces, %.4g x %.4g mm on a grid of %.4g mm; printer ",
                    picture->width_px, picture->height_px, r->input_pieces,
                    (r->chart.width_px - 2 * r->chart.margin_px) * pixel_mm,
                    (r->chart.height_px - 2 * r->chart.margin_px) * pixel_mm, pixel_mm));
    TRY(append_escaped(ctx, set->make.printer.name, html));
    TRY(bytes_print(ctx, html, " %g / %g / %g mm (growth, narrowest solid, narrowest void); %d bridges.</p>",
                    set->make.optimise.phi_e_mm, set->make.optimise.phi_s_mm, set->make.optimise.phi_v_mm,
                    r->optimised.bridges));
    if (set->surface)
        TRY(bytes_print(ctx, html, "<p>%s: a mm of the picture is %.3g to %.3g mm on the surface.</p>",
                        r->placed.placing == JALI_PLACE_WRAP ? "Wrapped" : "Projected", r->placed.stretch[0],
                        r->placed.stretch[1]));
    if (set->make.predict) TRY(append_predictions(ctx, set, r, html));
    TRY(bytes_print(ctx, html, "<main>\n"));
    TRY(append_maps(ctx, set, r, html));
    TRY(bytes_print(ctx, html, "</main>"));
    TRY(append_structure(ctx, set, r, html));
done:
    return status;
}

static jali_status append_object(jali_context *ctx, const made *m, jali_bytes *html)
{
    jali_status status;
    const settings *set = &m->set[0];
    bool printable = true;
    for (int32_t i = 0; i < m->count; i++) printable &= m->result[i].printable;
    TRY(bytes_print(ctx, html, "<ul>"));
    TRY(append_promise(ctx, "One piece", m->object.one_piece, html));
    TRY(append_promise(ctx, "Nothing below the printer's widths", printable, html));
    if (set->make.solid) TRY(append_promise(ctx, "A closed, manifold solid", m->object.closed, html));
    if (set->make.structure) TRY(append_promise(ctx, "Sound under the load", sound_of(m), html));
    TRY(bytes_print(ctx, html, "</ul>"));
    if (!set->make.solid) goto done;
    if (set->surface) {
        TRY(bytes_print(ctx, html, "<p>Surface "));
        TRY(append_escaped(ctx, set->surface, html));
        TRY(bytes_print(ctx, html, ", a wall of %g mm, %.3g mm where it is thinnest.</p>",
                        set->wall.thickness_mm, m->object.wall.thinnest_mm));
    }
    TRY(bytes_print(ctx, html, "<p>%d triangles, %.4g cm<sup>3</sup>.</p><main>\n",
                    m->object.mesh.triangle_count, m->object.check.volume_mm3 / 1000));
    TRY(append_renders(ctx, m, html));
    TRY(bytes_print(ctx, html, "</main>"));
done:
    return status;
}

jali_status report_html(jali_context *ctx, const made *m, jali_bytes *html)
{
    jali_status status;
    TRY(bytes_append(ctx, html, head, sizeof head - 1));
    TRY(bytes_print(ctx, html, "<h1>"));
    TRY(append_escaped(ctx, name_of(m->set[0].job ? m->set[0].job : m->set[0].operand), html));
    TRY(bytes_print(ctx, html, "</h1>"));
    TRY(append_object(ctx, m, html));
    for (int32_t i = 0; i < m->count; i++) {
        if (m->count > 1) {
            TRY(bytes_print(ctx, html, "<h2>"));
            TRY(append_escaped(ctx, name_of(m->set[i].operand), html));
            TRY(bytes_print(ctx, html, "</h2>"));
        }
        TRY(append_picture(ctx, &m->set[i], &m->picture[i], &m->result[i], html));
    }
    TRY(bytes_print(ctx, html, "<p>jali %s</p></html>\n", jali_version()));
done:
    return status;
}
