// Write: pick the format, build the file in memory, put it in place safely.
#include <jali/png.h>
#include <jali/write.h>

#include "base/file.h"

#include <strings.h>

static const struct {
    const char *suffix;
    jali_format format;
} suffixes[] = {
    {".3mf", JALI_FORMAT_3MF}, {".stl", JALI_FORMAT_STL}, {".svg", JALI_FORMAT_SVG},
    {".dxf", JALI_FORMAT_DXF}, {".png", JALI_FORMAT_PNG},
};

jali_write_options jali_write_defaults(void)
{
    return (jali_write_options){0};
}

jali_format jali_format_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof suffixes / sizeof *suffixes; i++)
        if (strcasecmp(dot, suffixes[i].suffix) == 0) return suffixes[i].format;
    return JALI_FORMAT_BY_SUFFIX;
}

static jali_status need(jali_context *ctx, const void *part, const char *format, const char *what)
{
    if (part) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE, "%s needs %s, and there is none here", format, what);
}

jali_status jali_write_bytes(jali_context *ctx, jali_format format, const jali_product *p,
                             const jali_write_options *given, jali_bytes *bytes)
{
    jali_status status;
    jali_write_options opt = given ? *given : jali_write_defaults();
    switch (format) {
    case JALI_FORMAT_3MF:
        TRY(need(ctx, p->mesh, "3MF", "a solid"));
        TRY(jali_write_3mf(ctx, p->mesh, &opt, bytes));
        break;
    case JALI_FORMAT_STL:
        TRY(need(ctx, p->mesh, "STL", "a solid"));
        TRY(jali_write_stl(ctx, p->mesh, bytes));
        break;
    case JALI_FORMAT_SVG:
        TRY(need(ctx, p->contours, "SVG", "flat contours"));
        TRY(jali_write_svg(ctx, p->contours, p->width_mm, p->height_mm, &opt, bytes));
        break;
    case JALI_FORMAT_DXF:
        TRY(need(ctx, p->contours, "DXF", "flat contours"));
        TRY(jali_write_dxf(ctx, p->contours, bytes));
        break;
    case JALI_FORMAT_PNG:
        TRY(need(ctx, p->bitmap, "PNG", "a picture"));
        TRY(jali_bitmap_png(ctx, p->bitmap, p->pixel_mm, bytes));
        break;
    default: TRY(fail(ctx, JALI_BAD_VALUE, "no output format given; 3mf, stl, svg, dxf and png are known"));
    }
done:
    return status;
}

jali_status jali_write(jali_context *ctx, const char *path, const jali_product *product,
                       const jali_write_options *given)
{
    jali_status status;
    jali_write_options opt = given ? *given : jali_write_defaults();
    jali_format format = opt.format ? opt.format : jali_format_of(path);
    jali_bytes bytes = {0};
    output_file file = {0};
    if (format == JALI_FORMAT_BY_SUFFIX)
        TRY(fail(ctx, JALI_BAD_VALUE, "%s names no output format; .3mf, .stl, .svg, .dxf and .png are known",
                 path));
    TRY(output_open(ctx, path, &file)); // before the work: a bad path is known at once
    TRY(jali_write_bytes(ctx, format, product, &opt, &bytes));
    TRY(output_write(ctx, &file, bytes.data, bytes.size));
    TRY(output_commit(ctx, &file));
done:
    if (status != JALI_OK) output_abandon(ctx, &file);
    jali_bytes_free(ctx, &bytes);
    return status;
}
