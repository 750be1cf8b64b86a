// The rest of a surface around a picture: the triangles of the outer skin that are not in the patch, those
// that are larger than the picture's largest elements in pieces, joined node by node at the patch's border.
//
// How:     an edge is split into pieces by its length alone, so both its sides agree; a triangle with split
// edges
//          is refined on a lattice of its own, its edges kept.
// Checked: tests/test_sheet.c.
#include "sheet/sheet_shell.h"

#include <math.h>

// The longest side of a triangle on the lattice it is refined on.
enum { FACE_UNITS = 1 << 20 };

typedef struct joining {
    const shell_sheet *s;
    jali_sheet *sheet;
    size_t node_room, thickness_room, border_room, at_room, triangle_room;
    uint8_t *covered; // [outer triangles] in the patch
    int32_t *vertex;  // [outer vertices] node, or -1
    int32_t *edge; // [4 * outer triangles] first of the nodes inside a side, of the lower-numbered of the two
    int32_t *same_as; // [nodes of the patch] the node to use instead: on a seam there are two
    int32_t *list;    // nodes inside edges
    int32_t list_count;
    size_t list_room;
} joining;

static const int32_t *triangle_of(const joining *j, int32_t t)
{
    return j->s->shell->outer.mesh.triangle[t];
}

// --- Nodes

static jali_status add_node(jali_context *ctx, joining *j, const double place[3], double thickness_mm,
                            int32_t *node)
{
    jali_status status;
    jali_sheet *sheet = j->sheet;
    size_t needed = (size_t)sheet->node_count + 1;
    TRY(GROW(ctx, sheet->node, j->node_room, needed));
    TRY(GROW(ctx, sheet->thickness_mm, j->thickness_room, needed));
    TRY(GROW(ctx, sheet->border, j->border_room, needed));
    TRY(GROW(ctx, sheet->at, j->at_room, needed));
    *node = sheet->node_count++;
    memcpy(sheet->node[*node], place, sizeof *sheet->node);
    sheet->thickness_mm[*node] = thickness_mm;
    sheet->border[*node] = 0;
    sheet->at[*node][0] = sheet->at[*node][1] = INT32_MIN;
done:
    return status;
}

static jali_status add_triangle(jali_context *ctx, joining *j, int32_t a, int32_t b, int32_t c)
{
    if (a == b || b == c || c == a) return JALI_OK; // a border that snapping shut
    jali_status status =
        GROW(ctx, j->sheet->triangle, j->triangle_room, (size_t)j->sheet->triangle_count + 1);
    if (status != JALI_OK) return status;
    int32_t *t = j->sheet->triangle[j->sheet->triangle_count++];
    t[0] = a, t[1] = b, t[2] = c;
    return JALI_OK;
}

// In the middle of the wall, by shares of the corners of an outer triangle.
static jali_status add_mixed(jali_context *ctx, joining *j, const int32_t *corner, const double *share,
                             int32_t *node)
{
    const jali_shell *shell = j->s->shell;
    double place[3], wall = 0;
    for (int k = 0; k < 3; k++) {
        double outer = 0, inner = 0;
        for (int i = 0; i < 3; i++) {
            outer += share[i] * shell->outer.mesh.vertex[corner[i]][k];
            inner += share[i] * shell->inner[corner[i]][k];
        }
        place[k] = 0.5 * (outer + inner);
        wall += (outer - inner) * (outer - inner);
    }
    return add_node(ctx, j, place, sqrt(wall), node);
}

static int32_t lower_side(const joining *j, int32_t side)
{
    int32_t beside = j->s->outer.beside[side];
    return beside != NO_SIDE && beside < side ? beside : side;
}

static int32_t pieces_of_side(const joining *j, int32_t side)
{
    const int32_t *corner = j->s->outer.corner;
    return pieces_of_edge(j->s, corner[next_side(side)], corner[last_side(side)]);
}

// The k-th node from the beginning of a side with n pieces, 0 < k < n.
static int32_t *node_on_side(joining *j, int32_t side, int32_t k, int32_t n)
{
    int32_t lower = lower_side(j, side);
    return &j->list[j->edge[lower] + (lower == side ? k - 1 : n - 1 - k)];
}

static jali_status room_on_side(jali_context *ctx, joining *j, int32_t side, int32_t n)
{
    int32_t lower = lower_side(j, side);
    if (j->edge[lower] >= 0) return JALI_OK;
    jali_status status = GROW(ctx, j->list, j->list_room, (size_t)j->list_count + (size_t)n);
    if (status != JALI_OK) return status;
    j->edge[lower] = j->list_count;
    for (int32_t k = 1; k < n; k++) j->list[j->list_count++] = -1;
    return JALI_OK;
}

// --- The border of the patch

// Let a node stand for a place of the surface; of two, as on a seam, the lower stays.
static void settle_node(joining *j, int32_t *place, int32_t node)
{
    if (node < 0) return;
    if (*place < 0) *place = node;
    int32_t lower = MIN(*place, node);
    j->same_as[MAX(*place, node)] = lower;
    *place = lower;
}

static jali_status name_border(jali_context *ctx, joining *j, const int32_t *node_at)
{
    jali_status status = JALI_OK;
    const shell_sheet *s = j->s;
    for (int32_t i = 0; i < s->border_count; i++) {
        const patch_border *b = &s->border[i];
        const line *piece = s->drawing.line + b->first;
        TRY(room_on_side(ctx, j, b->side, b->pieces));
        settle_node(j, &j->vertex[s->patch->vertex[b->from]], node_at[s->home[piece[0].from]]);
        for (int32_t k = 0; k < b->pieces; k++)
            settle_node(j,
                        k + 1 < b->pieces ? node_on_side(j, b->side, k + 1, b->pieces)
                                          : &j->vertex[s->patch->vertex[b->to]],
                        node_at[s->home[piece[k].to]]);
    }
done:
    return status;
}

// --- One triangle of the rest

// Its border as nodes, counter-clockwise from corner 0, with their shares of the corners.
static jali_status walk_around(jali_context *ctx, joining *j, int32_t t, int32_t *count, int32_t **node,
                               double (**share)[3])
{
    jali_status status;
    int32_t pieces[3], total = 0;
    for (int k = 0; k < 3; k++) total += pieces[k] = pieces_of_side(j, 4 * t + (k + 2) % 3);
    TRY(ARENA(ctx, *node, total));
    TRY(ARENA(ctx, *share, total));
    *count = 0;
    for (int k = 0; k < 3; k++) { // side k + 2 runs from corner k to corner k + 1
        int32_t side = 4 * t + (k + 2) % 3;
        TRY(room_on_side(ctx, j, side, pieces[k]));
        for (int32_t i = 0; i < pieces[k]; i++) {
            double *here = (*share)[*count];
            here[k] = 1 - (double)i / pieces[k];
            here[(k + 1) % 3] = (double)i / pieces[k];
            here[(k + 2) % 3] = 0;
            int32_t *place = i == 0 ? &j->vertex[triangle_of(j, t)[k]] : node_on_side(j, side, i, pieces[k]),
                    made;
            if (*place < 0) {
                TRY(add_mixed(ctx, j, triangle_of(j, t), here, &made));
                *place = made;
            }
            (*node)[(*count)++] = *place;
        }
    }
done:
    return status;
}

// The corners of a triangle on a lattice of its own, and the length of a unit.
static double lay_flat(const joining *j, int32_t t, double corner[3][2])
{
    const double(*vertex)[3] = (const double(*)[3])j->s->shell->outer.mesh.vertex;
    const int32_t *v = triangle_of(j, t);
    double d[3]; // squared, opposite each corner
    for (int k = 0; k < 3; k++) {
        d[k] = 0;
        for (int i = 0; i < 3; i++) {
            double step = vertex[v[(k + 2) % 3]][i] - vertex[v[(k + 1) % 3]][i];
            d[k] += step * step;
        }
    }
    double unit = sqrt(MAX(MAX(d[0], d[1]), d[2])) / FACE_UNITS, base = sqrt(d[2]);
    double x = (d[2] + d[1] - d[0]) / (2 * base), y = sqrt(MAX(d[1] - x * x, 0));
    corner[0][0] = corner[0][1] = corner[1][1] = 0;
    corner[1][0] = base / unit;
    corner[2][0] = x / unit;
    corner[2][1] = y / unit;
    return unit;
}

typedef struct face_mesh {
    int32_t count; // points of the border
    drawing drawing;
    triangulation plane;
    refinement fine;
} face_mesh;

static jali_status refine_face(jali_context *ctx, const joining *j, int32_t t, const double (*share)[3],
                               double corner[3][2], face_mesh *m)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t(*point)[2], *home, astray;
    double unit = lay_flat(j, t, corner);
    m->drawing.scale = 1;
    TRY(ARENA(ctx, point, m->count));
    TRY(ARENA(ctx, home, m->count));
    for (int32_t i = 0; i < m->count; i++)
        for (int k = 0; k < 2; k++)
            point[i][k] = (int32_t)lrint(share[i][0] * corner[0][k] + share[i][1] * corner[1][k] +
                                         share[i][2] * corner[2][k]);
    TRY(add_polygon(ctx, &m->drawing, (const int32_t(*)[2])point, m->count, EDGE_CONTOUR));
    TRY(triangulate_drawing(ctx, &m->drawing, 0, unit, &m->plane, home));
    m->fine =
        (refinement){.plane = &m->plane, .fixed = EDGE_CONTOUR, .least = 0.25 * j->s->length.coarsest / unit};
    TRY(ALLOCATE(ctx, m->fine.inside, m->plane.triangle_count + 1));
    m->fine.inside_capacity = (size_t)m->plane.triangle_count + 1;
    TRY(label_tones(ctx, &m->plane, EDGE_CONTOUR, m->fine.inside));
    TRY(refinement_begin(ctx, &m->fine, &astray));
    for (int32_t p = 0; p < m->plane.point_count; p++) m->fine.size[p] = j->s->length.coarsest / unit;
    TRY(refine_triangles(ctx, &m->fine));
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status add_face_mesh(jali_context *ctx, joining *j, int32_t t, const int32_t *border_node,
                                 double corner[3][2], const face_mesh *m)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int32_t *node;
    TRY(ARENA(ctx, node, m->plane.point_count + 1));
    memcpy(node, border_node, (size_t)m->count * sizeof *node);
    double base = corner[1][0], height = corner[2][1];
    for (int32_t p = m->count; p < m->plane.point_count; p++) {
        double share[3];
        share[2] = m->plane.point[p][1] / height;
        share[1] = (m->plane.point[p][0] - share[2] * corner[2][0]) / base;
        share[0] = 1 - share[1] - share[2];
        TRY(add_mixed(ctx, j, triangle_of(j, t), share, &node[p]));
    }
    for (int32_t i = 0; i < m->plane.triangle_count; i++) {
        const int32_t *c = m->plane.corner + 4 * i;
        if (m->fine.inside[i]) TRY(add_triangle(ctx, j, node[c[0]], node[c[1]], node[c[2]]));
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

static jali_status add_face(jali_context *ctx, joining *j, int32_t t)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    face_mesh m = {0};
    int32_t *node;
    double(*share)[3], corner[3][2];
    TRY(walk_around(ctx, j, t, &m.count, &node, &share));
    if (m.count == 3)
        TRY(add_triangle(ctx, j, node[0], node[1], node[2]));
    else {
        TRY(refine_face(ctx, j, t, (const double(*)[3])share, corner, &m));
        TRY(add_face_mesh(ctx, j, t, node, corner, &m));
    }
done:
    refinement_free(ctx, &m.fine);
    triangulation_free(ctx, &m.plane);
    drawing_free(ctx, &m.drawing);
    arena_rewind(ctx, mark);
    return status;
}

// --- The whole

static void mark_open_sides(joining *j, int32_t t)
{
    for (int32_t side = 4 * t; side < 4 * t + 3; side++) {
        int32_t beside = j->s->outer.beside[side], pieces = pieces_of_side(j, side);
        if (beside != NO_SIDE && is_solid(j->s->shell, beside >> 2)) continue;
        uint8_t bit = beside == NO_SIDE ? JALI_BORDER_RIM : JALI_BORDER_VOID;
        const int32_t *corner = j->s->outer.corner;
        j->sheet->border[j->vertex[corner[next_side(side)]]] |= bit;
        j->sheet->border[j->vertex[corner[last_side(side)]]] |= bit;
        for (int32_t k = 1; k < pieces; k++) j->sheet->border[*node_on_side(j, side, k, pieces)] |= bit;
    }
}

// Let triangles use the nodes that stay, and drop the others.
static jali_status merge_nodes(jali_context *ctx, joining *j, int32_t patch_nodes)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    jali_sheet *sheet = j->sheet;
    int32_t *now, kept = 0, triangles = 0;
    TRY(ARENA(ctx, now, sheet->node_count + 1));
    for (int32_t i = 0; i < sheet->node_count; i++) {
        if (i < patch_nodes && j->same_as[i] != i) {
            sheet->border[now[j->same_as[i]]] |= sheet->border[i];
            now[i] = now[j->same_as[i]];
            continue;
        }
        now[i] = kept;
        memmove(sheet->node[kept], sheet->node[i], sizeof *sheet->node);
        memmove(sheet->at[kept], sheet->at[i], sizeof *sheet->at);
        sheet->thickness_mm[kept] = sheet->thickness_mm[i];
        sheet->border[kept++] = sheet->border[i];
    }
    sheet->node_count = kept;
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        int32_t *to = sheet->triangle[triangles];
        for (int k = 0; k < 3; k++) to[k] = now[sheet->triangle[t][k]];
        triangles += to[0] != to[1] && to[1] != to[2] && to[2] != to[0];
    }
    sheet->triangle_count = triangles;
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status join_rest(jali_context *ctx, const shell_sheet *s, const int32_t *node_at, jali_sheet *sheet)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const jali_mesh *outer = &s->shell->outer.mesh;
    int32_t patch_nodes = sheet->node_count;
    size_t nodes = (size_t)patch_nodes;
    joining j = {.s = s,
                 .sheet = sheet,
                 .node_room = nodes,
                 .thickness_room = nodes,
                 .border_room = nodes,
                 .at_room = nodes,
                 .triangle_room = (size_t)sheet->triangle_count};
    TRY(ARENA(ctx, j.covered, outer->triangle_count + 1));
    TRY(ARENA(ctx, j.vertex, outer->vertex_count + 1));
    TRY(ARENA(ctx, j.edge, 4 * (size_t)outer->triangle_count + 1));
    TRY(ARENA(ctx, j.same_as, patch_nodes + 1));
    memset(j.covered, 0, (size_t)outer->triangle_count);
    for (int32_t f = 0; f < s->patch->face_count; f++) j.covered[s->patch->face[f]] = 1;
    for (int32_t v = 0; v < outer->vertex_count; v++) j.vertex[v] = -1;
    for (int32_t i = 0; i < 4 * outer->triangle_count; i++) j.edge[i] = -1;
    for (int32_t i = 0; i < patch_nodes; i++) j.same_as[i] = i;
    TRY(name_border(ctx, &j, node_at));
    for (int32_t t = 0; t < outer->triangle_count; t++) {
        if (t % 4096 == 0) TRY(step(ctx, "mesh", 0.95));
        if (j.covered[t] || !is_solid(s->shell, t)) continue;
        TRY(add_face(ctx, &j, t));
        mark_open_sides(&j, t);
    }
    TRY(merge_nodes(ctx, &j, patch_nodes));
done:
    release(ctx, j.list);
    arena_rewind(ctx, mark);
    return status;
}
