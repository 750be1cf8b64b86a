// From lines on a chart's lattice to triangles, and from refined triangles to a sheet.
//
// Checked: tests/test_sheet.c.
#include "sheet/arrange.h"

#include "plane/exact.h"
#include "plane/snap.h"

#include <math.h>

void drawing_free(jali_context *ctx, drawing *d)
{
    release(ctx, d->point);
    release(ctx, d->line);
    *d = (drawing){0};
}

int32_t finest_scale(int32_t most)
{
    int32_t scale = 1;
    while ((int64_t)most * scale * 2 <= COORDINATE_LIMIT) scale *= 2;
    return scale;
}

static bool are_close(const drawing *d, const int32_t a[2], const int32_t b[2])
{
    return hypot((double)b[0] - a[0], (double)b[1] - a[1]) < d->scale * d->closest;
}

// Store a polygon's points from `to` on, those close to the one before left out; returns how many were.
static int32_t keep_points(const drawing *d, const int32_t (*point)[2], int32_t count, bool all,
                           int32_t (*to)[2])
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++) to[kept][k] = d->scale * point[i][k];
        if (all || kept == 0 || !are_close(d, to[kept - 1], to[kept])) kept++;
    }
    while (!all && kept > 3 && are_close(d, to[kept - 1], to[0])) kept--;
    return kept;
}

jali_status add_polygon(jali_context *ctx, drawing *d, const int32_t (*point)[2], int32_t count, uint8_t kind)
{
    jali_status status;
    int32_t first = d->point_count;
    TRY(GROW(ctx, d->point, d->point_capacity, (size_t)first + (size_t)count));
    TRY(GROW(ctx, d->line, d->line_capacity, (size_t)d->line_count + (size_t)count));
    int32_t kept = keep_points(d, point, count, false, d->point + first);
    if (kept < 3) kept = keep_points(d, point, count, true, d->point + first);
    for (int32_t i = 0; i < kept; i++)
        d->line[d->line_count++] = (line){first + i, first + (i + 1) % kept, kind};
    d->point_count += kept;
done:
    return status;
}

// --- Triangulation

static jali_status report_contact(jali_context *ctx, const int32_t at[2], double unit_mm)
{
    return fail(ctx, JALI_BAD_INPUT, "contours touch or cross near (%.3f, %.3f) mm", at[0] * unit_mm,
                at[1] * unit_mm);
}

static jali_status insert_uncrossed(jali_context *ctx, const drawing *d, double unit_mm, triangulation *plane,
                                    int32_t *home)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t(*edge)[2];
    contact met = {0};
    TRY(ARENA(ctx, edge, d->line_count + 1));
    TRY(insert_points(ctx, plane, (const int32_t(*)[2])d->point, d->point_count));
    for (int32_t p = 0; p < plane->point_count; p++) {
        if (plane->twin[p] != p) TRY(report_contact(ctx, plane->point[p], unit_mm));
        home[p] = p;
    }
    for (int32_t i = 0, count; i < d->line_count; i += count) { // a call a kind
        for (count = 0; i + count < d->line_count && d->line[i + count].kind == d->line[i].kind; count++)
            edge[count][0] = d->line[i + count].from, edge[count][1] = d->line[i + count].to;
        TRY(insert_edges(ctx, plane, (const int32_t(*)[2])edge, count, d->line[i].kind, false, &met));
        if (met.found != NO_CONTACT) TRY(report_contact(ctx, plane->point[met.from], unit_mm));
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status insert_snapped(jali_context *ctx, const drawing *d, int32_t crossing, double unit_mm,
                                  triangulation *plane, int32_t *home)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t(*edge)[2], (*odd)[2], crossed[2], odd_count;
    contact met = {0};
    snapped s = {0};
    TRY(ARENA(ctx, edge, d->line_count + 1));
    for (int32_t i = 0; i < d->line_count; i++) edge[i][0] = d->line[i].from, edge[i][1] = d->line[i].to;
    TRY(snap_round(ctx, (const int32_t(*)[2])d->point, d->point_count, (const int32_t(*)[2])edge,
                   d->line_count, crossing, &s, crossed));
    TRY(ARENA(ctx, odd, s.piece_count + 1));
    TRY(insert_points(ctx, plane, (const int32_t(*)[2])s.point, s.point_count));
    for (int32_t i = 0, end; i < s.piece_count && plane->triangle_count > 0; i = end) {
        uint8_t kind = d->line[s.edge[i]].kind;
        for (end = i; end < s.piece_count && d->line[s.edge[end]].kind == kind;) end++;
        TRY(odd_pieces(ctx, (const int32_t(*)[2])s.piece + i, end - i, odd, &odd_count));
        TRY(insert_edges(ctx, plane, (const int32_t(*)[2])odd, odd_count, kind, false, &met));
        if (met.found != NO_CONTACT) TRY(report_contact(ctx, plane->point[met.from], unit_mm));
    }
    memcpy(home, s.home, (size_t)d->point_count * sizeof *home);
done:
    snapped_free(ctx, &s);
    arena_rewind(ctx, mark);
    return status;
}

jali_status triangulate_drawing(jali_context *ctx, const drawing *d, int32_t crossing, double unit_mm,
                                triangulation *plane, int32_t *home)
{
    return crossing > 0 ? insert_snapped(ctx, d, crossing, unit_mm / d->scale, plane, home)
                        : insert_uncrossed(ctx, d, unit_mm / d->scale, plane, home);
}

jali_status label_lines(jali_context *ctx, const triangulation *plane, uint8_t kinds, double unit_mm,
                        uint8_t *tone)
{
    jali_status status = label_tones(ctx, plane, kinds, tone);
    for (int32_t s = 0; s < 4 * plane->triangle_count && status == JALI_OK; s++) {
        if ((s & 3) == 3 || is_ghost(plane, s >> 2)) continue;
        bool changes = tone[s >> 2] != tone[plane->beside[s] >> 2], drawn = (plane->kind[s] & kinds) != 0;
        if (changes != drawn)
            status = report_contact(ctx, plane->point[plane->corner[next_side(s)]], unit_mm);
    }
    return status;
}

// --- The sheet

typedef struct gathering {
    const refinement *r;
    const node_source *source;
    int32_t scale;
    int32_t *node_of; // [4 * triangle_count] at each corner, or -1
    jali_sheet *sheet;
} gathering;

// Give the fan of triangles around corner s one node, turning both ways from there.
static void name_fan(gathering *g, int32_t s)
{
    const triangulation *plane = g->r->plane;
    int32_t node = g->sheet->node_count++, point = plane->corner[s];
    uint8_t border = 0;
    for (int way = 0; way < 2; way++)
        for (int32_t at = s;;) {
            g->node_of[at] = node;
            int32_t side = way == 0 ? next_side(at) : last_side(at), beside = plane->beside[side];
            if (!g->r->inside[beside >> 2]) {
                border |= g->source->border(g->source->shared, plane->kind[side], point);
                break;
            }
            at = way == 0 ? next_side(beside) : last_side(beside);
            if (at == s) {
                way = 1; // all around
                break;
            }
        }
    g->sheet->border[node] = border;
    for (int k = 0; k < 2; k++)
        g->sheet->at[node][k] = (int32_t)lrint((double)plane->point[point][k] / g->scale);
    g->source->locate(g->source->shared, point, g->sheet->node[node], &g->sheet->thickness_mm[node]);
}

static jali_status room_for_sheet(jali_context *ctx, const gathering *g, jali_sheet *sheet)
{
    jali_status status;
    const triangulation *plane = g->r->plane;
    size_t triangles = 0, fans = 0;
    for (int32_t t = 0; t < plane->triangle_count; t++) {
        if (!g->r->inside[t]) continue;
        triangles++;
        for (int32_t s = 4 * t; s < 4 * t + 3; s++) fans += !g->r->inside[plane->beside[s] >> 2];
    }
    // A fan more than a point has ends in borders of its own.
    size_t nodes = (size_t)plane->point_count + fans;
    TRY(ALLOCATE(ctx, sheet->node, nodes + 1));
    TRY(ALLOCATE(ctx, sheet->thickness_mm, nodes + 1));
    TRY(ALLOCATE(ctx, sheet->border, nodes + 1));
    TRY(ALLOCATE(ctx, sheet->at, nodes + 1));
    TRY(ALLOCATE(ctx, sheet->triangle, triangles + 1));
done:
    return status;
}

jali_status gather_sheet(jali_context *ctx, const refinement *r, int32_t scale, const node_source *source,
                         jali_sheet *sheet)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const triangulation *plane = r->plane;
    gathering g = {r, source, scale, NULL, sheet};
    TRY(ARENA(ctx, g.node_of, 4 * (size_t)plane->triangle_count + 1));
    TRY(room_for_sheet(ctx, &g, sheet));
    for (int32_t s = 0; s < 4 * plane->triangle_count; s++) g.node_of[s] = -1;
    for (int32_t t = 0; t < plane->triangle_count; t++) {
        if (!r->inside[t]) continue;
        int32_t *triangle = sheet->triangle[sheet->triangle_count++];
        for (int32_t k = 0; k < 3; k++) {
            if (g.node_of[4 * t + k] < 0) name_fan(&g, 4 * t + k);
            triangle[k] = g.node_of[4 * t + k];
        }
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
