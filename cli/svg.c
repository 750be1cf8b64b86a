// SVG pictures through librsvg, in the command line only: the library stays free of GLib.
//
// The document is drawn on white, its size and shape from its own width, height or viewBox. Nothing is loaded
// from outside: the document has no base address.
#ifdef JALI_HAVE_RSVG
#include "cli.h"
#include "base/bytes.h"

#include <librsvg/rsvg.h>
#include <math.h>

#ifdef __SANITIZE_ADDRESS__
// Fontconfig keeps its caches until the process ends.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig";
}
#endif

bool looks_like_svg(const uint8_t *bytes, size_t size)
{
    enum { LOOK_BYTES = 4096 };
    size_t first = 0;
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) first = 3;
    while (first < size && (bytes[first] == ' ' || (bytes[first] >= '\t' && bytes[first] <= '\r'))) first++;
    if (first >= size || bytes[first] != '<') return false;
    return memmem(bytes + first, MIN(size - first, (size_t)LOOK_BYTES), "<svg", 4) != NULL;
}

// GLib's messages may run over several lines; a sentence has one.
static jali_status refused(jali_context *ctx, const char *name, const char *what, const GError *error)
{
    const char *reason = error ? error->message : "no reason given";
    return fail(ctx, JALI_BAD_INPUT, "%s: the SVG %s: %.*s", name, what, (int)strcspn(reason, "\n"), reason);
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

static jali_status append_grey(jali_context *ctx, cairo_surface_t *surface, jali_bytes *pgm)
{
    jali_status status;
    int32_t width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
    int32_t stride = cairo_image_surface_get_stride(surface);
    const uint8_t *data = cairo_image_surface_get_data(surface);
    TRY(bytes_print(ctx, pgm, "P5 %d %d 255\n", width, height));
    TRY(bytes_reserve(ctx, pgm, (size_t)width * (size_t)height));
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) {
            uint32_t pixel;
            memcpy(&pixel, data + (int64_t)y * stride + 4 * (int64_t)x, sizeof pixel);
            uint32_t red = pixel >> 16 & 255, green = pixel >> 8 & 255, blue = pixel & 255;
            pgm->data[pgm->size++] = (uint8_t)((13933 * red + 46871 * green + 4732 * blue + 32768) >> 16);
        }
done:
    return status;
}

static jali_status paint(jali_context *ctx, RsvgHandle *svg, const char *name, int32_t longer_px,
                         jali_bytes *pgm)
{
    double size[2];
    GError *error = NULL;
    if (!shape_of(svg, size))
        return fail(ctx, JALI_BAD_INPUT, "%s: the SVG has neither a size nor a viewBox", name);
    double scale = longer_px / MAX(size[0], size[1]);
    int32_t width = (int32_t)MAX(floor(size[0] * scale + 0.5), 1),
            height = (int32_t)MAX(floor(size[1] * scale + 0.5), 1);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t *cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    RsvgRectangle viewport = {0, 0, width, height};
    jali_status status = JALI_OK;
    if (!rsvg_handle_render_document(svg, cairo, &viewport, &error))
        status = refused(ctx, name, "cannot be drawn", error);
    else if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        status = fail(ctx, JALI_NO_MEMORY, "%s: no memory for an SVG of %d x %d px", name, width, height);
    cairo_surface_flush(surface);
    if (status == JALI_OK) status = append_grey(ctx, surface, pgm);
    g_clear_error(&error);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return status;
}

jali_status draw_svg(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                     int32_t longer_px, jali_bytes *pgm)
{
    GError *error = NULL;
    RsvgHandle *svg = rsvg_handle_new_from_data(bytes, size, &error);
    if (!svg) {
        jali_status status = refused(ctx, name, "is corrupt", error);
        g_clear_error(&error);
        return status;
    }
    jali_status status = paint(ctx, svg, name, longer_px, pgm);
    g_object_unref(svg);
    return status;
}
#else
typedef int svg_is_not_built_in;
#endif
