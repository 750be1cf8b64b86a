// The sheet of a plate: its contours, clipped to the picture when that is all that is wanted, as triangles.
//
// How:     contours and the picture's rectangle become one exact triangulation on a lattice as fine as its
//          predicates allow (arrange.c); what is solid and in the picture is refined (plane/refine.h).
// Limits:  pieces that a clipped plate falls into all stay, those that touch nothing too.
// Checked: tests/test_sheet.c, fuzz/fuzz_refine.c.
#include <jali/sheet.h>

#include "sheet/arrange.h"

#include <math.h>
#include <stdlib.h>

// Neighbouring elements differ by about that much of their size.
const double SHEET_GROWTH = 0.35;
// Elements are never larger than this share of the picture's longer side.
const double SHEET_COARSEST = 1.0 / 40;
// No two nodes are nearer than this share of the finest size.
const double SHEET_LEAST = 0.125;

void jali_sheet_free(jali_context *ctx, jali_sheet *sheet)
{
    release(ctx, sheet->node);
    release(ctx, sheet->thickness_mm);
    release(ctx, sheet->triangle);
    release(ctx, sheet->border);
    release(ctx, sheet->at);
    *sheet = (jali_sheet){0};
}

jali_sheet_options jali_sheet_defaults(void)
{
    return (jali_sheet_options){.phi_s_mm = 0.3, .across = 4};
}

jali_status check_sheet_options(jali_context *ctx, const jali_sheet_options *opt)
{
    if (!(opt->phi_s_mm > 0 && opt->phi_s_mm <= 1e6))
        return fail(ctx, JALI_BAD_VALUE,
                    "a narrowest solid of %g mm: more than 0 and up to 1e6 mm is accepted", opt->phi_s_mm);
    if (opt->across < 1 || opt->across > 16)
        return fail(ctx, JALI_BAD_VALUE, "%d elements across: 1 to 16 are accepted", opt->across);
    return JALI_OK;
}

picture_window window_of(const jali_chart *chart)
{
    int32_t margin = chart->margin_px * chart->pixel_units;
    return (picture_window){
        {margin, margin},
        {chart->width_px * chart->pixel_units - margin, chart->height_px * chart->pixel_units - margin}};
}

jali_status draw_window(jali_context *ctx, drawing *d, const picture_window *w)
{
    const int32_t corner[4][2] = {
        {w->low[0], w->low[1]}, {w->high[0], w->low[1]}, {w->high[0], w->high[1]}, {w->low[0], w->high[1]}};
    return add_polygon(ctx, d, corner, 4, EDGE_WINDOW);
}

typedef struct plate_sheet {
    const jali_contours *plate;
    const jali_chart *chart;
    double thickness_mm;
    picture_window window;
    bool clipped;
    drawing drawing;
    triangulation plane;
    refinement fine;
} plate_sheet;

// --- What is drawn

static jali_status check_plate(jali_context *ctx, const plate_sheet *p)
{
    if (!(p->thickness_mm > 0 && p->thickness_mm <= 1e6))
        return fail(ctx, JALI_BAD_VALUE, "a plate of %g mm: a thickness of more than 0 is accepted",
                    p->thickness_mm);
    if (p->window.low[0] >= p->window.high[0] || p->window.low[1] >= p->window.high[1])
        return fail(ctx, JALI_BAD_VALUE, "a margin of %d px leaves nothing of %d x %d px",
                    p->chart->margin_px, p->chart->width_px, p->chart->height_px);
    return JALI_OK;
}

static bool turns_left(const jali_contours *contours, int32_t c)
{
    double area = 0;
    int32_t first = contours->first[c], end = contours->first[c + 1];
    for (int32_t i = first; i < end; i++) {
        const int32_t *a = contours->point[i], *b = contours->point[i + 1 < end ? i + 1 : first];
        area += (double)a[0] * b[1] - (double)b[0] * a[1];
    }
    return area > 0;
}

// Outlines are what turns to the left and is not an island in a void: of a plate the first, of a picture that
// ends in void all that are solid. The latter are contours of the picture as well.
static jali_status draw_plate_lines(jali_context *ctx, plate_sheet *p)
{
    jali_status status = JALI_OK;
    int32_t most = 1;
    for (int32_t i = 0; i < p->plate->point_count; i++)
        most = MAX(most, MAX(abs(p->plate->point[i][0]), abs(p->plate->point[i][1])));
    for (int k = 0; k < 2; k++) most = MAX(most, MAX(abs(p->window.low[k]), abs(p->window.high[k])));
    p->drawing.scale = finest_scale(most);
    if (p->clipped) TRY(draw_window(ctx, &p->drawing, &p->window));
    for (int32_t c = 0; c < p->plate->contour_count; c++) {
        bool outline = p->chart->outside_solid ? c == 0 : turns_left(p->plate, c);
        TRY(add_polygon(ctx, &p->drawing, (const int32_t(*)[2])p->plate->point + p->plate->first[c],
                        p->plate->first[c + 1] - p->plate->first[c],
                        (uint8_t)(EDGE_CONTOUR | (outline ? EDGE_OUTLINE : 0))));
    }
done:
    return status;
}

static jali_status label_inside(jali_context *ctx, plate_sheet *p)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    uint8_t *in_window;
    int64_t count = 0;
    double unit_mm = p->chart->unit_mm / p->drawing.scale;
    int32_t triangles = p->plane.triangle_count;
    TRY(ALLOCATE(ctx, p->fine.inside, triangles + 1));
    p->fine.inside_capacity = (size_t)triangles + 1;
    TRY(label_lines(ctx, &p->plane, EDGE_CONTOUR, unit_mm, p->fine.inside));
    if (p->clipped) {
        TRY(ARENA(ctx, in_window, triangles + 1));
        TRY(label_lines(ctx, &p->plane, EDGE_WINDOW, unit_mm, in_window));
        for (int32_t t = 0; t < triangles; t++) p->fine.inside[t] &= in_window[t];
    }
    for (int32_t t = 0; t < triangles; t++) count += p->fine.inside[t];
    if (count == 0) status = fail(ctx, JALI_NO_RESULT, "there is nothing solid in the picture");
done:
    arena_rewind(ctx, mark);
    return status;
}

// --- The nodes

static void locate_on_plate(void *shared, int32_t point, double node[3], double *thickness_mm)
{
    const plate_sheet *p = shared;
    double unit_mm = p->chart->unit_mm / p->drawing.scale;
    for (int k = 0; k < 2; k++) node[k] = p->plane.point[point][k] * unit_mm;
    node[2] = 0.5 * p->thickness_mm;
    *thickness_mm = p->thickness_mm;
}

// A picture that ends in void is traced near its window's border, but not on it: half a pixel is on it.
static bool on_window(const plate_sheet *p, int32_t point)
{
    int32_t slack = p->chart->pixel_units / 2 * p->drawing.scale;
    for (int k = 0; k < 2; k++) {
        int32_t at = p->plane.point[point][k];
        if (abs(at - p->drawing.scale * p->window.low[k]) <= slack ||
            abs(at - p->drawing.scale * p->window.high[k]) <= slack)
            return true;
    }
    return false;
}

static uint8_t border_of_plate(void *shared, uint8_t kind, int32_t point)
{
    const plate_sheet *p = shared;
    uint8_t border = 0;
    if (kind & EDGE_OUTLINE) border |= JALI_BORDER_RIM;
    if ((kind & EDGE_CONTOUR) && !(kind & EDGE_OUTLINE && p->chart->outside_solid))
        border |= JALI_BORDER_VOID;
    if ((kind & EDGE_WINDOW) || (kind & EDGE_OUTLINE && on_window(p, point))) border |= JALI_BORDER_PICTURE;
    return border;
}

// --- The stage

void set_lengths(refinement *r, const jali_sheet_options *opt, double extent_mm, double unit_mm,
                 sheet_lengths *length)
{
    length->finest = opt->phi_s_mm / opt->across / unit_mm;
    length->coarsest = MAX(extent_mm * SHEET_COARSEST / unit_mm, length->finest);
    r->least = SHEET_LEAST * length->finest;
}

// Contours with points nearer than elements may be lose some; where edges would then meet, none.
static jali_status arrange_plate(jali_context *ctx, plate_sheet *p, double closest)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *home;
    p->drawing = (drawing){.closest = closest};
    TRY(draw_plate_lines(ctx, p));
    TRY(ARENA(ctx, home, p->drawing.point_count + 1));
    TRY(triangulate_drawing(ctx, &p->drawing, p->clipped ? 4 : 0, p->chart->unit_mm, &p->plane, home));
    TRY(label_inside(ctx, p));
done:
    arena_rewind(ctx, mark);
    if (status == JALI_OK) return status;
    refinement_free(ctx, &p->fine);
    triangulation_free(ctx, &p->plane);
    drawing_free(ctx, &p->drawing);
    return status == JALI_BAD_INPUT && closest > 0 ? arrange_plate(ctx, p, 0) : status;
}

jali_status jali_sheet_plate(jali_context *ctx, const jali_contours *plate, const jali_chart *chart,
                             double thickness_mm, const jali_sheet_options *given, jali_sheet *sheet)
{
    jali_status status;
    jali_sheet_options opt = given ? *given : jali_sheet_defaults();
    plate_sheet p = {plate, chart, thickness_mm, window_of(chart), !opt.whole && chart->outside_solid,
                     {0},   {0},   {0}};
    sheet_lengths length;
    int32_t astray;
    *sheet = (jali_sheet){.flat = true};
    TRY(step(ctx, "mesh", 0));
    TRY(check_sheet_options(ctx, &opt));
    TRY(check_plate(ctx, &p));
    TRY(arrange_plate(ctx, &p, SHEET_LEAST * opt.phi_s_mm / opt.across / chart->unit_mm));
    p.fine.plane = &p.plane;
    double extent =
        MAX(p.window.high[0] - p.window.low[0], p.window.high[1] - p.window.low[1]) * chart->unit_mm;
    set_lengths(&p.fine, &opt, extent, chart->unit_mm / p.drawing.scale, &length);
    TRY(refinement_begin(ctx, &p.fine, &astray));
    TRY(refine_sizes(ctx, &p.fine, opt.across, length.finest, length.coarsest, SHEET_GROWTH));
    TRY(refine_triangles(ctx, &p.fine));
    TRY(gather_sheet(ctx, &p.fine, p.drawing.scale, &(node_source){locate_on_plate, border_of_plate, &p},
                     sheet));
    TRY(number_along_curve(ctx, sheet));
    TRY(step(ctx, "mesh", 1));
done:
    refinement_free(ctx, &p.fine);
    triangulation_free(ctx, &p.plane);
    drawing_free(ctx, &p.drawing);
    if (status != JALI_OK) jali_sheet_free(ctx, sheet);
    return status;
}
