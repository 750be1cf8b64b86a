// SVG pictures through librsvg.
//
// Why so:  librsvg brings forty libraries with it, whose loading takes as long as a small picture's whole
//          image method; so this is a module that the command line loads when there is an SVG to draw.
// Limits:  nothing is loaded from outside: the document has no base address.
#include "svg.h"

#include <librsvg/rsvg.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// GLib's messages may run over several lines; a sentence has one.
static svg_status refused(svg_drawing *out, const char *what, GError *error)
{
    const char *reason = error ? error->message : "no reason given";
    snprintf(out->sentence, sizeof out->sentence, "%s: %.*s", what, (int)strcspn(reason, "\n"), reason);
    g_clear_error(&error);
    return SVG_REFUSED;
}

static bool shape_of(RsvgHandle *svg, double size[2])
{
    gboolean has_width, has_height, has_box;
    RsvgLength width, height;
    RsvgRectangle box;
    if (rsvg_handle_get_intrinsic_size_in_pixels(svg, &size[0], &size[1]) && size[0] > 0 && size[1] > 0)
        return true;
    rsvg_handle_get_intrinsic_dimensions(svg, &has_width, &width, &has_height, &height, &has_box, &box);
    size[0] = has_box ? box.width : 0;
    size[1] = has_box ? box.height : 0;
    return isfinite(size[0]) && isfinite(size[1]) && size[0] > 0 && size[1] > 0;
}

static svg_status take_grey(cairo_surface_t *surface, svg_drawing *out)
{
    int32_t stride = cairo_image_surface_get_stride(surface);
    const uint8_t *data = cairo_image_surface_get_data(surface);
    out->grey = malloc((size_t)out->width * (size_t)out->height);
    if (!out->grey) return SVG_NO_MEMORY;
    for (int32_t y = 0; y < out->height; y++)
        for (int32_t x = 0; x < out->width; x++) {
            uint32_t pixel;
            memcpy(&pixel, data + (int64_t)y * stride + 4 * (int64_t)x, sizeof pixel);
            uint32_t red = pixel >> 16 & 255, green = pixel >> 8 & 255, blue = pixel & 255;
            out->grey[(size_t)y * (size_t)out->width + (size_t)x] =
                (uint8_t)((13933 * red + 46871 * green + 4732 * blue + 32768) >> 16);
        }
    return SVG_DRAWN;
}

static svg_status paint(RsvgHandle *svg, svg_drawing *out)
{
    GError *error = NULL;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, out->width, out->height);
    cairo_t *cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    RsvgRectangle viewport = {0, 0, out->width, out->height};
    svg_status status = SVG_NO_MEMORY;
    if (!rsvg_handle_render_document(svg, cairo, &viewport, &error))
        status = refused(out, "cannot be drawn", error);
    else if (cairo_surface_flush(surface), cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS)
        status = take_grey(surface, out);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return status;
}

__attribute__((visibility("default"))) svg_draw jali_svg_draw;

svg_status jali_svg_draw(const uint8_t *bytes, size_t size, int32_t longer_px, svg_drawing *out)
{
    double shape[2];
    GError *error = NULL;
    *out = (svg_drawing){0};
    RsvgHandle *svg = rsvg_handle_new_from_data(bytes, size, &error);
    if (!svg) return refused(out, "is corrupt", error);
    svg_status status = SVG_REFUSED;
    if (shape_of(svg, shape)) {
        double scale = longer_px / fmax(shape[0], shape[1]);
        out->width = (int32_t)fmax(floor(shape[0] * scale + 0.5), 1);
        out->height = (int32_t)fmax(floor(shape[1] * scale + 0.5), 1);
        status = paint(svg, out);
    } else {
        snprintf(out->sentence, sizeof out->sentence, "has neither a size nor a viewBox");
    }
    g_object_unref(svg);
    return status;
}
