// The sheet of a picture on a surface: the patch without the picture's voids, refined on the chart under the
// surface's metric, then once more by lengths in space, which is what facets have.
//
// How:     the patch's border, the picture's rectangle and its contours become one triangulation; the edges
// of the
//          surface inside the patch play no part but in where points are lifted to and in how large elements
//          may be where the surface bends.
// Limits:  creases are cut. Walls less than half solid (pictures pierced before, with a film behind) are left
// out. Checked: tests/test_sheet.c.
#include "sheet/sheet_shell.h"

#include <math.h>
#include <stdlib.h>

enum { EDGE_LOST = 16 }; // beyond it the wall is pierced

// --- The border of the patch

int32_t pieces_of_edge(const shell_sheet *s, int32_t a, int32_t b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double d = s->shell->outer.mesh.vertex[b][k] - s->shell->outer.mesh.vertex[a][k];
        sum += d * d;
    }
    return MAX((int32_t)ceil(sqrt(sum) / s->length.coarsest - 0.25), 1);
}

static uint8_t kind_of_border(const shell_sheet *s, int32_t side)
{
    int32_t beside = s->outer.beside[side];
    if (beside == NO_SIDE) return EDGE_CREASE | EDGE_OUTLINE;
    return is_solid(s->shell, beside >> 2) ? EDGE_CREASE : EDGE_CREASE | EDGE_LOST;
}

static jali_status list_border(jali_context *ctx, shell_sheet *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const jali_patch *patch = s->patch;
    int32_t(*corner)[3], *face, count = 0;
    sides linked = {0};
    TRY(ARENA(ctx, corner, patch->face_count + 1));
    TRY(ARENA(ctx, face, patch->face_count + 1));
    for (int32_t f = 0; f < patch->face_count; f++) {
        if (!is_solid(s->shell, patch->face[f])) continue;
        memcpy(corner[count], patch->corner[f], sizeof *corner);
        face[count++] = f;
    }
    TRY(sides_create(ctx, patch->point_count, count, (const int32_t(*)[3])corner, &linked));
    TRY(ALLOCATE(ctx, s->border, 3 * (size_t)count + 1));
    for (int32_t i = 0; i < 4 * count; i++) {
        if ((i & 3) == 3 || linked.beside[i] != NO_SIDE) continue;
        int32_t from = linked.corner[next_side(i)], to = linked.corner[last_side(i)], f = face[i >> 2], k = 0;
        while (patch->corner[f][k] != linked.corner[i]) k++;
        s->border[s->border_count++] =
            (patch_border){from, to, 4 * patch->face[f] + k, 0,
                           s->opt.whole ? pieces_of_edge(s, patch->vertex[from], patch->vertex[to]) : 1};
    }
done:
    sides_free(ctx, &linked);
    arena_rewind(ctx, mark);
    return status;
}

// --- What is drawn

static jali_status add_point(jali_context *ctx, drawing *d, double x, double y, int32_t *number)
{
    jali_status status = GROW(ctx, d->point, d->point_capacity, (size_t)d->point_count + 1);
    if (status != JALI_OK) return status;
    d->point[d->point_count][0] = (int32_t)lrint(x);
    d->point[d->point_count][1] = (int32_t)lrint(y);
    *number = d->point_count++;
    return JALI_OK;
}

static jali_status draw_border(jali_context *ctx, shell_sheet *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    drawing *d = &s->drawing;
    int32_t *number; // of each patch point in the drawing
    TRY(ARENA(ctx, number, s->patch->point_count + 1));
    for (int32_t p = 0; p < s->patch->point_count; p++) number[p] = -1;
    for (int32_t i = 0; i < s->border_count; i++) {
        patch_border *b = &s->border[i];
        const int32_t *ends[2] = {s->patch->point[b->from], s->patch->point[b->to]};
        for (int k = 0; k < 2; k++) {
            int32_t *at = &number[k ? b->to : b->from];
            if (*at < 0)
                TRY(add_point(ctx, d, (double)d->scale * ends[k][0], (double)d->scale * ends[k][1], at));
        }
        uint8_t kind = kind_of_border(s, b->side);
        b->first = d->line_count;
        TRY(GROW(ctx, d->line, d->line_capacity, (size_t)d->line_count + (size_t)b->pieces));
        int32_t last = number[b->from];
        for (int32_t k = 1; k <= b->pieces; k++) {
            double share = d->scale * (double)k / b->pieces, rest = d->scale - share;
            int32_t next = number[b->to];
            if (k < b->pieces)
                TRY(add_point(ctx, d, rest * ends[0][0] + share * ends[1][0],
                              rest * ends[0][1] + share * ends[1][1], &next));
            d->line[d->line_count++] = (line){last, next, kind};
            last = next;
        }
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status draw_shell_lines(jali_context *ctx, shell_sheet *s, int32_t *crossing)
{
    jali_status status;
    picture_window window = window_of(s->chart);
    int64_t most = 1;
    for (int32_t i = 0; i < s->patch->point_count; i++)
        for (int k = 0; k < 2; k++) most = MAX(most, llabs(s->patch->point[i][k]));
    for (int32_t i = 0; i < s->picture->point_count; i++)
        for (int k = 0; k < 2; k++) most = MAX(most, llabs(s->picture->point[i][k]));
    for (int k = 0; k < 2; k++) most = MAX(most, MAX(llabs(window.low[k]), llabs(window.high[k])));
    s->drawing.scale = finest_scale((int32_t)MIN(most, INT32_MAX));
    if (!s->opt.whole) TRY(draw_window(ctx, &s->drawing, &window));
    TRY(draw_border(ctx, s));
    *crossing = s->drawing.line_count;
    for (int32_t c = 0; c < s->picture->contour_count; c++)
        TRY(add_polygon(ctx, &s->drawing, (const int32_t(*)[2])s->picture->point + s->picture->first[c],
                        s->picture->first[c + 1] - s->picture->first[c], EDGE_CONTOUR));
done:
    return status;
}

static jali_status label_inside(jali_context *ctx, shell_sheet *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t triangles = s->plane.triangle_count;
    int64_t count = 0;
    double unit_mm = s->chart->unit_mm / s->drawing.scale;
    uint8_t *in_void, *in_window;
    TRY(ALLOCATE(ctx, s->fine.inside, triangles + 1));
    s->fine.inside_capacity = (size_t)triangles + 1;
    TRY(ARENA(ctx, in_void, triangles + 1));
    TRY(ARENA(ctx, in_window, triangles + 1));
    TRY(label_lines(ctx, &s->plane, EDGE_CREASE, unit_mm, s->fine.inside));
    TRY(label_lines(ctx, &s->plane, EDGE_CONTOUR, unit_mm, in_void));
    TRY(label_lines(ctx, &s->plane, EDGE_WINDOW, unit_mm, in_window));
    for (int32_t t = 0; t < triangles; t++) {
        s->fine.inside[t] &= !in_void[t] && (in_window[t] || s->opt.whole);
        count += s->fine.inside[t];
    }
    if (count == 0) status = fail(ctx, JALI_NO_RESULT, "there is nothing solid in the picture");
done:
    arena_rewind(ctx, mark);
    return status;
}

// --- The nodes

typedef struct naming {
    const shell_sheet *s;
    int32_t *node_at; // [plane.point_count]
    int32_t count;
} naming;

static void locate_on_wall(void *shared, int32_t point, double node[3], double *thickness_mm)
{
    naming *n = shared;
    const shell_sheet *s = n->s;
    lift_to_wall(&s->lift, s->plane.point[point], node, thickness_mm);
    n->node_at[point] = n->count++;
}

// Where the patch ends and the surface goes on, the paper holds the picture; the whole is joined there.
static uint8_t border_on_wall(void *shared, uint8_t kind, int32_t point)
{
    const naming *n = shared;
    uint8_t border = 0;
    (void)point;
    if (kind & EDGE_OUTLINE) border |= JALI_BORDER_RIM;
    if (kind & (EDGE_CONTOUR | EDGE_LOST)) border |= JALI_BORDER_VOID;
    if (kind & EDGE_WINDOW) border |= JALI_BORDER_PICTURE;
    if ((kind & EDGE_CREASE) && border == 0 && !n->s->opt.whole) border |= JALI_BORDER_PICTURE;
    return border;
}

static jali_status refine_patch(jali_context *ctx, shell_sheet *s)
{
    jali_status status;
    int32_t astray;
    s->fine.plane = &s->plane;
    s->fine.lifting = (lifting){lift_spot, &s->lift};
    s->fine.measure = BY_METRIC;
    s->fine.fixed = s->opt.whole ? EDGE_CREASE : 0;
    TRY(refinement_begin(ctx, &s->fine, &astray));
    if (astray >= 0)
        return fail(ctx, JALI_NO_RESULT, "the picture reaches beyond the surface at (%.2f, %.2f) mm",
                    s->plane.point[astray][0] * s->chart->unit_mm / s->drawing.scale,
                    s->plane.point[astray][1] * s->chart->unit_mm / s->drawing.scale);
    TRY(refine_sizes(ctx, &s->fine, s->opt.across, s->length.finest, s->length.coarsest, SHEET_GROWTH));
    TRY(refine_triangles(ctx, &s->fine));
    s->fine.measure = BY_SPACE;
    TRY(refine_triangles(ctx, &s->fine));
done:
    return status;
}

static jali_status name_nodes(jali_context *ctx, shell_sheet *s, jali_sheet *sheet)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    naming n = {.s = s};
    TRY(ARENA(ctx, n.node_at, s->plane.point_count + 1));
    for (int32_t p = 0; p < s->plane.point_count; p++) n.node_at[p] = -1;
    TRY(gather_sheet(ctx, &s->fine, s->drawing.scale, &(node_source){locate_on_wall, border_on_wall, &n},
                     sheet));
    if (s->opt.whole) TRY(join_rest(ctx, s, n.node_at, sheet));
done:
    arena_rewind(ctx, mark);
    return status;
}

// As for plates.
static jali_status arrange_patch(jali_context *ctx, shell_sheet *s, double closest)
{
    jali_status status;
    int32_t crossing;
    s->drawing = (drawing){.closest = closest};
    TRY(draw_shell_lines(ctx, s, &crossing));
    TRY(ALLOCATE(ctx, s->home, s->drawing.point_count + 1));
    TRY(triangulate_drawing(ctx, &s->drawing, crossing, s->chart->unit_mm, &s->plane, s->home));
    TRY(label_inside(ctx, s));
done:
    if (status == JALI_OK) return status;
    refinement_free(ctx, &s->fine);
    triangulation_free(ctx, &s->plane);
    drawing_free(ctx, &s->drawing);
    release(ctx, s->home);
    s->home = NULL;
    return status == JALI_BAD_INPUT && closest > 0 ? arrange_patch(ctx, s, 0) : status;
}

jali_status jali_sheet_shell(jali_context *ctx, const jali_contours *picture, const jali_chart *chart,
                             const jali_patch *patch, const jali_shell *shell,
                             const jali_sheet_options *given, jali_sheet *sheet)
{
    jali_status status;
    shell_sheet s = {.picture = picture, .chart = chart, .patch = patch, .shell = shell};
    const jali_mesh *outer = &shell->outer.mesh;
    s.opt = given ? *given : jali_sheet_defaults();
    *sheet = (jali_sheet){0};
    TRY(step(ctx, "mesh", 0));
    TRY(check_sheet_options(ctx, &s.opt));
    double extent_mm = MAX(chart->width_px, chart->height_px) * jali_chart_pixel_mm(chart);
    set_lengths(&s.fine, &s.opt, extent_mm, 1, &s.length);
    TRY(sides_create(ctx, outer->vertex_count, outer->triangle_count, (const int32_t(*)[3])outer->triangle,
                     &s.outer));
    TRY(list_border(ctx, &s));
    TRY(arrange_patch(ctx, &s, SHEET_LEAST * s.length.finest / chart->unit_mm));
    s.fine.least = SHEET_LEAST * s.length.finest;
    TRY(chart_lift_create(ctx, patch, shell, s.drawing.scale, 0.25 * s.drawing.scale * chart->pixel_units,
                          s.length.finest, &s.lift));
    TRY(refine_patch(ctx, &s));
    TRY(name_nodes(ctx, &s, sheet));
    TRY(number_along_curve(ctx, sheet));
    TRY(step(ctx, "mesh", 1));
done:
    refinement_free(ctx, &s.fine);
    chart_lift_free(ctx, &s.lift);
    triangulation_free(ctx, &s.plane);
    drawing_free(ctx, &s.drawing);
    sides_free(ctx, &s.outer);
    release(ctx, s.border);
    release(ctx, s.home);
    if (status != JALI_OK) jali_sheet_free(ctx, sheet);
    return status;
}
