// SVG pictures, in the command line only: the library stays free of GLib.
//
// How:     the module jali-svg.so draws them (svg/svg.c); it is loaded when there is one to draw, and stays.
// Checked: tests/test_cli.c.
#ifdef JALI_HAVE_RSVG
#include "cli.h"
#include "beside.h"
#include "svg/svg.h"
#include "base/bytes.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdlib.h>

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

static svg_draw *load_module(void)
{
    char path[PATH_MAX];
    svg_draw *draw = NULL;
    for (int32_t place = 0; !draw && path_beside(place, SVG_MODULE, path); place++) {
        void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        void *found = module ? dlsym(module, SVG_FUNCTION) : NULL;
        memcpy(&draw, &found, sizeof draw); // ISO C has no conversion between the two
    }
    return draw;
}

static jali_status as_pgm(jali_context *ctx, const svg_drawing *drawn, jali_bytes *pgm)
{
    jali_status status;
    TRY(bytes_print(ctx, pgm, "P5 %d %d 255\n", drawn->width, drawn->height));
    TRY(bytes_append(ctx, pgm, drawn->grey, (size_t)drawn->width * (size_t)drawn->height));
done:
    return status;
}

jali_status draw_svg(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                     int32_t longer_px, jali_bytes *pgm)
{
    jali_status status = JALI_OK;
    svg_drawing drawn = {0};
    svg_draw *draw = load_module();
    if (!draw)
        return fail(ctx, JALI_BAD_INPUT,
                    "%s is an SVG, and " SVG_MODULE ", which draws it by librsvg 2, cannot be loaded from "
                    "where jali lies; a PNG is accepted",
                    name);
    switch (draw(bytes, size, longer_px, &drawn)) {
    case SVG_DRAWN: status = as_pgm(ctx, &drawn, pgm); break;
    case SVG_REFUSED: status = fail(ctx, JALI_BAD_INPUT, "%s: the SVG %s", name, drawn.sentence); break;
    case SVG_NO_MEMORY:
        status = fail(ctx, JALI_NO_MEMORY, "%s: no memory for an SVG of %d x %d px", name, drawn.width,
                      drawn.height);
    }
    free(drawn.grey);
    return status;
}
#else
typedef int svg_is_not_built_in;
#endif
