// Where the picture lies on a surface: the view or the unrolling, the patch of faces, the grid, the metric.
//
// Source:  Binary Image Carving for 3D Printing, section 3: the picture is placed by an inverse perspective,
//          and a surface that hides part of itself inside the picture's window is refused.
// Limits:  the lattice of a surface's chart is 1/256 of a working pixel, coarser for pictures of more than
// 16,000 px. Checked: tests/test_place_on.c.
#include <jali/place.h>

#include "place/grid.h"
#include "place/lay.h"
#include "place/patch.h"
#include "place/resample.h"
#include "plane/exact.h"

#include <math.h>
#include <stdio.h>

enum {
    MOST_PIXEL_UNITS = 256,
    LEAST_PIXEL_UNITS = 16,
    HIDDEN_SAMPLES = 400,
    SCALE_STEPS = 24,
    OFFER_BYTES = 320
};
static const double REACH = 4; // sides of the picture that faces under it may reach beyond its middle
static const double COVERED = 1 - 1e-6; // places are rounded to the lattice; voids are checked exactly later
static const double MOST_STRETCH = 4;   // for which the working pixel is made finer
static const double HIDDEN_TOLERANCE = 1e-4; // of the window: samples on edges

typedef struct placing_work {
    const jali_picture *picture;
    const jali_surface *surface;
    jali_place_options opt;
    double size_mm[2];
    double ring_mm[2]; // protected zone beside and above the picture
    camera view;
    laid plane;
    int32_t first, turns; // the face under the picture's centre
    jali_chart *chart;
    growth grown;
    jali_placed placed;
} placing_work;

void jali_chart_free(jali_context *ctx, jali_chart *chart)
{
    release(ctx, chart->metric);
    *chart = (jali_chart){0};
}

// --- The plane of the picture

// The face nearest to the viewer at the plane's origin, or -1; the shift of a wrapped one in turns.
static jali_status face_at_origin(jali_context *ctx, const laid *l, int32_t *face, int32_t *turns)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    static const double origin[2] = {0, 0};
    view v;
    *face = -1;
    *turns = 0;
    for (int32_t shift = -1; shift <= 1 && *face < 0; shift++) {
        int32_t *all = NULL;
        if (shift != 0 && l->around_mm == 0) continue;
        TRY(view_create(ctx, origin, origin, 1, l->depth != NULL, &v));
        TRY(ARENA(ctx, all, l->surface->mesh.triangle_count + 1));
        for (int32_t t = 0; t < l->surface->mesh.triangle_count; t++) all[t] = shift;
        draw_faces(l, NULL, all, &v);
        *face = v.face[0];
        *turns = shift;
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static void point_on_face(const laid *l, int32_t face, double turns, double at[3])
{
    const double(*p)[2] = (const double(*)[2])l->at[face];
    double x[3], sum = 0, share[3];
    for (int k = 0; k < 3; k++) x[k] = p[k][0] + turns * l->around_mm;
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        share[k] = x[a] * p[b][1] - x[b] * p[a][1];
        if (l->perspective) share[k] /= l->depth[l->surface->mesh.triangle[face][k]];
        sum += share[k];
    }
    for (int k = 0; k < 3; k++) {
        at[k] = 0;
        for (int i = 0; i < 3; i++)
            at[k] += share[i] / sum * l->surface->mesh.vertex[l->surface->mesh.triangle[face][i]][k];
    }
}

static void middle_of_box(const jali_mesh *mesh, double middle[3])
{
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (int32_t v = 0; v < mesh->vertex_count; v++) {
            low = MIN(low, mesh->vertex[v][k]);
            high = MAX(high, mesh->vertex[v][k]);
        }
        middle[k] = (low + high) / 2;
    }
}

static jali_status project_picture(jali_context *ctx, placing_work *w)
{
    jali_status status;
    double room, centre[3], half[2] = {w->size_mm[0] / 2, w->size_mm[1] / 2};
    double wanted = 1 + MAX(w->ring_mm[0], w->ring_mm[1]) / MIN(half[0], half[1]);
    memcpy(centre, w->opt.at_mm, sizeof centre);
    if (!w->opt.at_given) middle_of_box(&w->surface->mesh, centre);
    if (!w->opt.at_given && !w->opt.camera.perspective) {
        TRY(find_view(ctx, w->surface, &w->opt, half, wanted, &w->view, &room));
    } else {
        jali_camera look = w->opt.camera;
        if (!look.perspective && look.direction[0] == 0 && look.direction[1] == 0 && look.direction[2] == 0)
            look.direction[1] = 1; // the front
        TRY(aim(ctx, &look, centre, &w->view));
        if (look.perspective) { // lengths are true where the view meets the surface, not at the middle of it
            TRY(lay_by_camera(ctx, w->surface, &w->view, &w->plane));
            TRY(face_at_origin(ctx, &w->plane, &w->first, &w->turns));
            if (w->first >= 0) {
                point_on_face(&w->plane, w->first, 0, centre);
                TRY(aim(ctx, &look, centre, &w->view));
            }
            laid_free(ctx, &w->plane);
        }
    }
    if (w->opt.camera.fov_deg > 0) { // now that the distance is known
        double wide = 2 * w->view.distance * tan(w->opt.camera.fov_deg * acos(-1) / 360);
        w->size_mm[1] *= wide / w->size_mm[0];
        w->size_mm[0] = wide;
    }
    memcpy(w->placed.direction, w->view.forward, sizeof w->placed.direction);
    TRY(lay_by_camera(ctx, w->surface, &w->view, &w->plane));
done:
    return status;
}

// The place that a wrapped picture's centre goes to when the shape does not say: the given one, or where a
// projected picture would have most room.
static jali_status choose_place(jali_context *ctx, placing_work *w, double at[3])
{
    jali_status status = JALI_OK;
    double room, half[2] = {w->size_mm[0] / 2, w->size_mm[1] / 2};
    double wanted = 1 + MAX(w->ring_mm[0], w->ring_mm[1]) / MIN(half[0], half[1]);
    memcpy(at, w->opt.at_mm, sizeof w->opt.at_mm);
    if (w->opt.at_given) return JALI_OK;
    TRY(find_view(ctx, w->surface, &w->opt, half, wanted, &w->view, &room));
    memcpy(at, w->view.centre, sizeof w->view.centre);
done:
    return status;
}

// A surface that does not come unrolled is flattened around the picture's centre.
static jali_status flatten_picture(jali_context *ctx, placing_work *w)
{
    jali_status status;
    flat_window window = {.size_mm = {w->size_mm[0], w->size_mm[1]},
                          .ring_mm = {w->ring_mm[0], w->ring_mm[1]}};
    memcpy(window.up, w->opt.camera.up, sizeof window.up);
    TRY(choose_place(ctx, w, window.at_mm));
    TRY(lay_by_flattening(ctx, w->surface, &window, &w->plane));
done:
    return status;
}

// Turn the plane until the surface's seam is at both ends of the way around.
static void turn_back(const jali_surface *surface, laid *plane)
{
    double low = INFINITY;
    int32_t triangles = surface->mesh.triangle_count;
    for (int32_t i = 0; i < 3 * triangles; i++)
        if (!isnan(plane->at[i / 3][i % 3][0])) low = MIN(low, plane->at[i / 3][i % 3][0]);
    for (int32_t i = 0; i < 3 * triangles; i++) plane->at[i / 3][i % 3][0] -= low + plane->around_mm / 2;
}

static jali_status wrap_picture(jali_context *ctx, placing_work *w)
{
    jali_status status;
    double at[3], around = w->surface->around_mm;
    if (!w->surface->uv) return flatten_picture(ctx, w);
    if (w->opt.around > 0) w->ring_mm[0] = 0;
    if (w->opt.around == 0 && around > 0 &&
        w->size_mm[0] + 2 * w->ring_mm[0] > around) { // the zones on both sides become one
        w->ring_mm[0] = (around - w->size_mm[0]) / 2;
        if (w->ring_mm[0] < w->opt.phi_s_mm / 2)
            return fail(
                ctx, JALI_NO_RESULT,
                "the picture is %.2f mm wide and the surface %.2f mm around: a bar of phi_s, %g mm, must "
                "stay, so that at most %.2f mm fit",
                w->size_mm[0], around, w->opt.phi_s_mm, around - w->opt.phi_s_mm);
    }
    if (w->surface->textured || w->opt.at_given) TRY(choose_place(ctx, w, at));
    TRY(lay_by_unrolling(ctx, w->surface, w->surface->textured || w->opt.at_given ? at : NULL, &w->plane));
    if (w->opt.around > 0) turn_back(w->surface, &w->plane);
done:
    return status;
}

// --- The grid

static jali_status choose_surface_grid(jali_context *ctx, placing_work *w, double pixel_mm)
{
    jali_status status;
    double margin = ceil(margin_mm(&w->opt) / pixel_mm) + 2;
    double parts = MAX(w->opt.around, 1);
    double columns =
        w->opt.paper ? w->picture->width_px : parts * MAX(floor(w->size_mm[0] / parts / pixel_mm + 0.5), 1);
    double rows = w->opt.paper ? w->picture->height_px
                               : MAX(floor(columns * w->picture->height_px / w->picture->width_px + 0.5), 1);
    TRY(check_grid(ctx, columns + 2 * margin, rows + 2 * margin, pixel_mm));
    int32_t units = MOST_PIXEL_UNITS;
    while (units > LEAST_PIXEL_UNITS && REACH * MAX(columns, rows) * units > COORDINATE_LIMIT) units /= 2;
    jali_chart_free(ctx, w->chart);
    *w->chart = (jali_chart){
        .width_px = (int32_t)(columns + 2 * margin),
        .height_px = (int32_t)(rows + 2 * margin),
        .margin_px = (int32_t)margin,
        .outside_solid = true,
        .pixel_units = units,
        .unit_mm = w->size_mm[0] / columns / units,
    };
done:
    return status;
}

// --- Does the surface have room there, and is it seen?

static void window(const placing_work *w, double scale, double low[2], double high[2])
{
    double middle[2] = {w->chart->width_px * (w->chart->pixel_units / 2.0),
                        w->chart->height_px * (w->chart->pixel_units / 2.0)};
    for (int i = 0; i < 2; i++) {
        double half = (scale * w->size_mm[i] / 2 + w->ring_mm[i]) / w->chart->unit_mm;
        low[i] = middle[i] - half;
        high[i] = middle[i] + half;
    }
}

static double cover(const placing_work *w, double scale)
{
    double low[2], high[2];
    window(w, scale, low, high);
    return covered_area(&w->grown.patch, low, high) / ((high[0] - low[0]) * (high[1] - low[1]));
}

// Which ninth of the window is covered least.
static const char *worst_part(const placing_work *w)
{
    static const char *const name[9] = {"lower left", "lower middle", "lower right",  "left",       "middle",
                                        "right",      "upper left",   "upper middle", "upper right"};
    double low[2], high[2], least = INFINITY;
    int worst = 4;
    window(w, 1, low, high);
    for (int n = 0; n < 9; n++) {
        double from[2], to[2];
        int at[2] = {n % 3, n / 3};
        for (int i = 0; i < 2; i++) {
            from[i] = low[i] + at[i] * (high[i] - low[i]) / 3;
            to[i] = from[i] + (high[i] - low[i]) / 3;
        }
        double covered = covered_area(&w->grown.patch, from, to);
        if (covered >= least) continue;
        least = covered;
        worst = n;
    }
    return name[worst];
}

static double largest_scale(const placing_work *w)
{
    double fits = 0, fails = 1;
    for (int i = 0; i < SCALE_STEPS; i++) {
        double middle = (fits + fails) / 2;
        if (cover(w, middle) >= COVERED)
            fits = middle;
        else
            fails = middle;
    }
    return fits;
}

// What would do instead: a smaller picture, and for a projected one a view that has room for it as it is.
static jali_status offer_instead(jali_context *ctx, const placing_work *w, double scale,
                                 char offer[OFFER_BYTES])
{
    jali_status status = JALI_OK;
    double width = floor(scale * w->size_mm[0] * 10) / 10, room = 0, wanted;
    bool chosen = w->opt.at_given || w->opt.camera.direction[0] != 0 || w->opt.camera.direction[1] != 0 ||
                  w->opt.camera.direction[2] != 0;
    char size[64] = "no size fits there", elsewhere[OFFER_BYTES / 2] = "";
    if (scale * MIN(w->size_mm[0], w->size_mm[1]) > 1)
        snprintf(size, sizeof size, "a width of %.4g mm fits there", width);
    if (w->plane.depth && chosen && !w->opt.camera.perspective) {
        jali_place_options free_view = w->opt;
        camera c;
        memset(free_view.camera.direction, 0, sizeof free_view.camera.direction);
        double half[2] = {w->size_mm[0] / 2, w->size_mm[1] / 2};
        wanted = 1 + MAX(w->ring_mm[0], w->ring_mm[1]) / MIN(half[0], half[1]);
        TRY(find_view(ctx, w->surface, &free_view, half, wanted, &c, &room));
        if (room >= wanted)
            snprintf(elsewhere, sizeof elsewhere,
                     "; this one does around (%.4g, %.4g, %.4g) mm, seen along (%.3g, %.3g, %.3g)",
                     c.centre[0], c.centre[1], c.centre[2], c.forward[0], c.forward[1], c.forward[2]);
    }
    snprintf(offer, OFFER_BYTES, "%s%s", size, elsewhere);
done:
    return status;
}

static jali_status check_room(jali_context *ctx, const placing_work *w)
{
    double covered = cover(w, 1);
    char offer[OFFER_BYTES];
    bool textured = !w->plane.depth && w->surface->textured;
    if (covered >= COVERED) return JALI_OK;
    jali_status status = offer_instead(ctx, w, largest_scale(w), offer);
    if (status != JALI_OK) return status;
    return fail(ctx, JALI_NO_RESULT,
                "the surface %s %.3g %% of the picture's window of %.4g x %.4g mm, most at its %s; %s%s",
                w->plane.depth ? "ends or turns away within"
                : textured     ? "has the border of its texture within"
                               : "ends within",
                100 * MAX(1 - covered, 1e-9), w->size_mm[0] + 2 * w->ring_mm[0],
                w->size_mm[1] + 2 * w->ring_mm[1], worst_part(w), offer,
                textured ? "; with :texture=no behind the file's name it is laid flat instead" : "");
}

// Faults of the mesh do not matter elsewhere, but a picture cannot be pierced through them.
static jali_status check_sound(jali_context *ctx, const placing_work *w)
{
    const bool *faulty = w->surface->faulty;
    int32_t count = 0, first = -1;
    for (int32_t i = 0; faulty && i < w->grown.patch.face_count; i++) {
        int32_t face = w->grown.patch.face[i];
        if (!faulty[face]) continue;
        if (count++ == 0) first = face;
    }
    if (count == 0) return JALI_OK;
    const double *at = w->surface->mesh.vertex[w->surface->mesh.triangle[first][0]];
    return fail(
        ctx, JALI_BAD_INPUT,
        "%d triangle%s of the surface under the picture %s faulty (meeting others, or on edges of more than "
        "two), one at (%.4g, %.4g, %.4g) mm; another place (--at) or a mended model is needed",
        count, count == 1 ? "" : "s", count == 1 ? "is" : "are", at[0], at[1], at[2]);
}

// A void must be cut through one place of the surface only.
static jali_status check_once(jali_context *ctx, const placing_work *w)
{
    int32_t point;
    jali_status status = find_overlap(ctx, &w->grown.patch, &point);
    if (status != JALI_OK || point < 0) return status;
    const double *at = w->surface->mesh.vertex[w->grown.patch.vertex[point]];
    return fail(
        ctx, JALI_NO_RESULT,
        "the surface covers the picture's window twice: %s overlaps itself, as at (%.4g, %.4g, %.4g) mm; "
        "%sanother place (--at) or a smaller picture is needed",
        w->surface->textured && !w->plane.depth ? "its texture" : "what lies under the picture", at[0], at[1],
        at[2], w->surface->textured && !w->plane.depth ? ":texture=no behind the file's name, " : "");
}

// Anything of the object before the patch? A picture seen in part does not look right.
static jali_status check_hidden(jali_context *ctx, const placing_work *w)
{
    jali_status status = JALI_OK;
    arena_mark mark = arena_here(ctx);
    view v;
    int64_t hidden = 0;
    double where[2] = {0, 0}, free_scale = 1; // share of the picture from its left and bottom
    if (!w->plane.depth) return JALI_OK;
    double low[2] = {-w->size_mm[0] / 2, -w->size_mm[1] / 2}, high[2] = {-low[0], -low[1]};
    TRY(view_create(ctx, low, high, MAX(w->size_mm[0], w->size_mm[1]) / HIDDEN_SAMPLES, true, &v));
    draw_faces(&w->plane, NULL, NULL, &v);
    for (int64_t i = 0; i < (int64_t)v.columns * v.rows; i++) {
        if (v.face[i] < 0 || w->grown.taken[v.face[i]]) continue;
        double x = (double)(i % v.columns) / v.columns, y = (double)(i / v.columns) / v.rows;
        hidden++;
        where[0] += x;
        where[1] += y;
        free_scale = MIN(free_scale, 2 * MAX(fabs(x - 0.5), fabs(y - 0.5)));
    }
    double all = (double)v.columns * v.rows;
    if ((double)hidden > HIDDEN_TOLERANCE * all) {
        char offer[OFFER_BYTES];
        TRY(offer_instead(ctx, w, free_scale - 4.0 / HIDDEN_SAMPLES, offer));
        status = fail(ctx, JALI_NO_RESULT,
                      "the object hides %.2g %% of the picture from the viewer, around %.0f %% from its left "
                      "and %.0f %% "
                      "from its top; %s",
                      100 * (double)hidden / all, 100 * where[0] / (double)hidden,
                      100 - 100 * where[1] / (double)hidden, offer);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

// --- Steps

static jali_status chart_patch(jali_context *ctx, placing_work *w, double pixel_mm)
{
    jali_status status;
    TRY(choose_surface_grid(ctx, w, pixel_mm));
    jali_patch_free(ctx, &w->grown.patch);
    TRY(grow_patch(ctx, &w->plane, w->chart, MAX(w->ring_mm[0], w->ring_mm[1]), w->first, w->turns,
                   &w->grown));
    TRY(check_room(ctx, w));
    TRY(check_sound(ctx, w));
    TRY(fill_metric(ctx, &w->plane, &w->grown, w->chart, w->placed.stretch));
done:
    return status;
}

static jali_status lay_picture(jali_context *ctx, placing_work *w)
{
    jali_status status;
    bool wrap = w->opt.placing == JALI_PLACE_WRAP || (w->opt.placing == JALI_PLACE_AUTO && w->surface->uv);
    w->placed.placing = wrap ? JALI_PLACE_WRAP : JALI_PLACE_PROJECT;
    w->ring_mm[0] = w->ring_mm[1] = MAX(w->opt.frame_mm, w->opt.phi_s_mm);
    TRY(wrap ? wrap_picture(ctx, w) : project_picture(ctx, w));
    TRY(face_at_origin(ctx, &w->plane, &w->first, &w->turns));
    if (w->first < 0)
        return fail(ctx, JALI_NO_RESULT, "the picture's centre is beside the surface; --at gives another");
    point_on_face(&w->plane, w->first, w->turns, w->placed.centre_mm);
    double pixel_mm = w->opt.paper          ? w->size_mm[0] / w->picture->width_px
                      : w->opt.pixel_mm > 0 ? w->opt.pixel_mm
                                            : automatic_pixel(&w->opt, 1);
    TRY(chart_patch(ctx, w, pixel_mm));
    TRY(check_hidden(ctx, w));
    TRY(check_once(ctx, w));
    // Widths count on the surface: where it is stretched they are fewer pixels.
    double finer_mm = automatic_pixel(&w->opt, MIN(w->placed.stretch[1], MOST_STRETCH));
    if (finer_mm < pixel_mm && !w->opt.paper && w->opt.pixel_mm == 0) TRY(chart_patch(ctx, w, finer_mm));
done:
    return status;
}

static jali_status check_around(jali_context *ctx, const jali_place_options *opt, const jali_surface *surface)
{
    if (opt->around == 0) return JALI_OK;
    if (opt->around < 0)
        return fail(ctx, JALI_BAD_VALUE, "a picture goes around in 1 part or more, not %d", opt->around);
    if (opt->placing == JALI_PLACE_PROJECT || !surface->uv || !(surface->around_mm > 0))
        return fail(
            ctx, JALI_BAD_VALUE,
            "a picture can go all around a cylinder, a sphere or a vase, wrapped; this surface does not "
            "close where it is unrolled");
    return JALI_OK;
}

// Left and right of a picture that goes around, what lies beyond.
static void wrap_margin(const jali_chart *chart, jali_bitmap *drawing)
{
    int32_t margin = chart->margin_px, columns = chart->width_px - 2 * margin;
    for (int32_t y = margin; y < chart->height_px - margin; y++)
        for (int32_t i = 0; i < margin; i++) {
            jali_bitmap_set(drawing, margin - 1 - i, y,
                            jali_bitmap_get(drawing, margin + columns - 1 - i % columns, y));
            jali_bitmap_set(drawing, margin + columns + i, y,
                            jali_bitmap_get(drawing, margin + i % columns, y));
        }
}

jali_status jali_place_on(jali_context *ctx, const jali_picture *picture, int32_t threshold,
                          const jali_place_options *given, const jali_surface *surface, jali_chart *chart,
                          jali_patch *patch, jali_bitmap *drawing, jali_placed *placed)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    placing_work w = {.surface = surface, .opt = given ? *given : jali_place_defaults(), .chart = chart};
    *chart = (jali_chart){0};
    *patch = (jali_patch){0};
    *drawing = (jali_bitmap){0};
    TRY(step(ctx, "place", 0));
    TRY(check_around(ctx, &w.opt, surface));
    if (w.opt.frame_mm <= 0) w.opt.frame_mm = w.opt.phi_s_mm;   // the surroundings are solid in any case
    if (w.opt.camera.perspective && w.opt.camera.fov_deg > 0) { // the size follows when the view is known
        w.opt.width_mm = 1000;
        w.opt.height_mm = 0;
    }
    TRY(check_picture(ctx, picture, threshold, &w.opt));
    w.picture = picture;
    if (w.opt.camera.perspective && w.opt.camera.fov_deg > 0)
        w.opt.width_mm = 1000; // until the view is known
    if (w.opt.camera.perspective && w.opt.camera.fov_deg > 0) w.opt.height_mm = 0;
    TRY(picture_size(ctx, w.picture, &w.opt, w.size_mm));
    TRY(lay_picture(ctx, &w));
    TRY(step(ctx, "place", 0.5));
    TRY(jali_bitmap_create(ctx, chart->width_px, chart->height_px, drawing));
    TRY(resample(ctx, w.picture, threshold, chart->margin_px, drawing));
    whiten_margin(chart, drawing);
    if (w.opt.around > 0) wrap_margin(chart, drawing);
    *patch = w.grown.patch;
    w.grown.patch = (jali_patch){0};
    if (placed) *placed = w.placed;
done:
    jali_patch_free(ctx, &w.grown.patch);
    laid_free(ctx, &w.plane);
    arena_rewind(ctx, mark);
    if (status != JALI_OK) {
        jali_bitmap_free(ctx, drawing);
        jali_chart_free(ctx, chart);
    }
    return status;
}
