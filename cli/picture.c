// jali place PICTURE, and how every verb gets its picture.
#include "outputs.h"
#include "base/file.h"

#include <math.h>

const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strcmp(path, "-") == 0 ? "stdin" : slash ? slash + 1 : path;
}

static const size_t max_svg_bytes = (size_t)1 << 28;

#ifdef JALI_HAVE_RSVG
// An SVG has no pixels of its own: it is drawn with one pixel a working pixel, up to a limit.
static int32_t svg_longer_px(const settings *set)
{
    enum { LEAST = 256, MOST = 16384 };
    const jali_place_options *place = &set->make.place;
    const jali_optimise_options *printer = &set->make.optimise;
    double pixel_mm = place->pixel_mm > 0 ? place->pixel_mm : MIN(printer->phi_s_mm, printer->phi_v_mm) / 8;
    double px = ceil(MAX(place->width_mm, place->height_mm) / pixel_mm);
    return (int32_t)MIN(MAX(px, LEAST), MOST);
}
#endif

static jali_status decode(jali_context *ctx, const settings *set, const char *name, const jali_bytes *file,
                          jali_picture *picture)
{
#ifdef JALI_HAVE_RSVG
    if (looks_like_svg(file->data, file->size)) {
        jali_status status;
        jali_bytes pgm = {0};
        if (files_of(ctx))
            return fail(ctx, JALI_BAD_INPUT,
                        "%s is an SVG; to draw it fonts may be needed, and this run opens no files: a PNG is "
                        "accepted",
                        name);
        TRY(draw_svg(ctx, file->data, MIN(file->size, max_svg_bytes), name, svg_longer_px(set), &pgm));
        TRY(jali_read_bytes(ctx, pgm.data, pgm.size, name, &set->read, picture));
    done:
        jali_bytes_free(ctx, &pgm);
        return status;
    }
#endif
    return jali_read_bytes(ctx, file->data, file->size, name, &set->read, picture);
}

jali_status load_picture(jali_context *ctx, const settings *set, jali_picture *picture)
{
    jali_status status;
    jali_bytes file = {0};
    *picture = (jali_picture){0};
    const char *name = strcmp(set->operand, "-") == 0 ? "stdin" : set->operand;
    TRY(file_read(ctx, set->operand, (size_t)3 << 29, &file));
    TRY(decode(ctx, set, name, &file, picture));
done:
    jali_bytes_free(ctx, &file);
    if (status != JALI_OK) jali_picture_free(ctx, picture);
    return status;
}

jali_status run_place(jali_context *ctx, const settings *set)
{
    jali_status status;
    jali_picture picture = {0};
    jali_chart chart;
    jali_bitmap drawing = {0};
    int32_t threshold;
    jali_place_options place = set->make.place;
    place.phi_e_mm = set->make.optimise.phi_e_mm;
    place.phi_s_mm = set->make.optimise.phi_s_mm;
    place.phi_v_mm = set->make.optimise.phi_v_mm;
    place.paper = set->make.optimise.paper;
    TRY(load_picture(ctx, set, &picture));
    TRY(jali_threshold(ctx, &picture, &set->make.threshold, &threshold));
    TRY(jali_place(ctx, &picture, threshold, &place, &chart, &drawing));
    TRY(write_bitmaps(ctx, set, &drawing, jali_chart_pixel_mm(&chart)));
    say(set, "%d x %d px at threshold %d, on a grid of %d x %d px of %.4g mm", picture.width_px,
        picture.height_px, threshold, chart.width_px, chart.height_px, jali_chart_pixel_mm(&chart));
done:
    jali_bitmap_free(ctx, &drawing);
    jali_picture_free(ctx, &picture);
    return status;
}
