// Gathering a mesh; polygons become triangles.
//
// Limits:  a polygon is seen along its normal (Newell's), so one that is folded over itself there is refused.
// Checked: tests/test_readers.c: concave polygons of every turn, a spiral, a bow tie.
#include "mesh/gather.h"

#include <math.h>

enum { MOST_CONCAVE = 500 }; // cutting ears is cubic in the worst case

void gather_free(jali_context *ctx, gathering *g)
{
    release(ctx, g->vertex);
    release(ctx, g->texture);
    release(ctx, g->triangle);
    release(ctx, g->corner);
    release(ctx, g->left);
    *g = (gathering){0};
}

static jali_status check_points(jali_context *ctx, const gathering *g, size_t count)
{
    if (count < 3 * (size_t)g->file->opt.max_triangles) return JALI_OK;
    return fail(ctx, JALI_LIMIT, "%s has more vertices than %d triangles can use", g->file->name,
                g->file->opt.max_triangles);
}

jali_status gather_vertex(jali_context *ctx, gathering *g, const double point[3])
{
    jali_status status;
    TRY(check_points(ctx, g, g->vertex_count));
    TRY(GROW(ctx, g->vertex, g->vertex_capacity, g->vertex_count + 1));
    memcpy(g->vertex[g->vertex_count++], point, sizeof *g->vertex);
done:
    return status;
}

jali_status gather_texture(jali_context *ctx, gathering *g, const double point[2])
{
    jali_status status;
    TRY(check_points(ctx, g, g->texture_count));
    TRY(GROW(ctx, g->texture, g->texture_capacity, g->texture_count + 1));
    memcpy(g->texture[g->texture_count++], point, sizeof *g->texture);
done:
    return status;
}

jali_status gather_corner(jali_context *ctx, gathering *g, int32_t vertex, int32_t texture)
{
    jali_status status;
    TRY(GROW(ctx, g->corner, g->corner_capacity, g->corner_count + 1));
    TRY(GROW(ctx, g->left, g->left_capacity, g->corner_count + 1));
    g->corner[g->corner_count++] = (gathered_corner){vertex, texture};
done:
    return status;
}

// ---- splitting a polygon ----

// The polygon in its plane: axes i, j such that it turns counter-clockwise.
typedef struct flat_polygon {
    const gathering *g;
    int i, j;
} flat_polygon;

static flat_polygon flatten(const gathering *g)
{
    double normal[3] = {0};
    for (size_t c = 0; c < g->corner_count; c++) {
        const double *a = g->vertex[g->corner[c].vertex];
        const double *b = g->vertex[g->corner[(c + 1) % g->corner_count].vertex];
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            normal[k] += (a[i] - b[i]) * (a[j] + b[j]);
        }
    }
    int dropped = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(normal[k]) > fabs(normal[dropped])) dropped = k;
    int i = (dropped + 1) % 3, j = (dropped + 2) % 3;
    return normal[dropped] >= 0 ? (flat_polygon){g, i, j} : (flat_polygon){g, j, i};
}

static double turn(const flat_polygon *p, int32_t a, int32_t b, int32_t c)
{
    const gathering *g = p->g;
    const double *u = g->vertex[g->corner[a].vertex], *v = g->vertex[g->corner[b].vertex];
    const double *w = g->vertex[g->corner[c].vertex];
    return (v[p->i] - u[p->i]) * (w[p->j] - u[p->j]) - (v[p->j] - u[p->j]) * (w[p->i] - u[p->i]);
}

static bool fan_fits(const flat_polygon *p)
{
    int32_t count = (int32_t)p->g->corner_count;
    for (int32_t c = 1; c + 1 < count; c++)
        if (turn(p, 0, c, c + 1) < 0) return false;
    return true;
}

// May the corner at place c of `left` be cut off? A flat one may when `flat` is wanted.
static bool is_ear(const flat_polygon *p, const int32_t *left, int32_t count, int32_t c, bool flat)
{
    int32_t before = left[(c + count - 1) % count], here = left[c], after = left[(c + 1) % count];
    double bend = turn(p, before, here, after);
    if (flat ? bend != 0 : bend <= 0) return false;
    for (int32_t i = 0; i < count && !flat; i++) {
        int32_t other = left[i], vertex = p->g->corner[other].vertex;
        if (vertex == p->g->corner[before].vertex || vertex == p->g->corner[here].vertex ||
            vertex == p->g->corner[after].vertex)
            continue;
        if (turn(p, before, here, other) >= 0 && turn(p, here, after, other) >= 0 &&
            turn(p, after, before, other) >= 0)
            return false;
    }
    return true;
}

static void add_triangle(gathering *g, int32_t a, int32_t b, int32_t c)
{
    const gathered_corner triangle[3] = {g->corner[a], g->corner[b], g->corner[c]};
    memcpy(g->triangle[g->triangle_count++], triangle, sizeof triangle);
}

// False when no ear is left: the polygon crosses itself.
static bool cut_ears(const flat_polygon *p, gathering *g)
{
    int32_t count = (int32_t)g->corner_count, *left = g->left;
    for (int32_t c = 0; c < count; c++) left[c] = c;
    while (count > 3) {
        int32_t ear = -1;
        for (int flat = 0; flat < 2 && ear < 0; flat++)
            for (int32_t c = 0; c < count && ear < 0; c++)
                if (is_ear(p, left, count, c, flat)) ear = c;
        if (ear < 0) return false;
        add_triangle(g, left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]);
        memmove(left + ear, left + ear + 1, (size_t)(--count - ear) * sizeof *left);
    }
    add_triangle(g, left[0], left[1], left[2]);
    return turn(p, left[0], left[1], left[2]) >= 0;
}

static jali_status refuse_polygon(jali_context *ctx, const gathering *g, int64_t line, int64_t number,
                                  const char *why)
{
    if (line > 0)
        return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: the face of %zu corners %s; split it into triangles",
                    g->file->name, (long long)line, g->corner_count, why);
    return fail(ctx, JALI_BAD_INPUT, "%s: face %lld, of %zu corners, %s; split it into triangles",
                g->file->name, (long long)number, g->corner_count, why);
}

jali_status gather_polygon(jali_context *ctx, gathering *g, int64_t line, int64_t number)
{
    jali_status status = JALI_OK;
    size_t triangles = g->corner_count < 3 ? 0 : g->corner_count - 2;
    if (triangles == 0) goto done;
    if (g->triangle_count + triangles > (size_t)g->file->opt.max_triangles)
        TRY(fail(ctx, JALI_LIMIT, "%s has more than the limit of %d triangles", g->file->name,
                 g->file->opt.max_triangles));
    TRY(GROW(ctx, g->triangle, g->triangle_capacity, g->triangle_count + triangles));
    flat_polygon p = {g, 0, 1};
    if (triangles > 1) p = flatten(g);
    if (triangles == 1 || fan_fits(&p)) {
        for (int32_t c = 1; c + 1 < (int32_t)g->corner_count; c++) add_triangle(g, 0, c, c + 1);
    } else if (g->corner_count > MOST_CONCAVE) {
        TRY(refuse_polygon(ctx, g, line, number, "is concave, with more than 500 corners"));
    } else if (!cut_ears(&p, g)) {
        TRY(refuse_polygon(ctx, g, line, number, "crosses itself"));
    }
done:
    g->corner_count = 0;
    return status;
}

jali_status gather_finish(jali_context *ctx, const gathering *g, jali_mesh *mesh, double (**uv)[3][2])
{
    jali_status status;
    bool textured = uv && g->texture_count > 0;
    if (uv) *uv = NULL;
    if (g->triangle_count == 0) TRY(fail(ctx, JALI_BAD_INPUT, "%s holds no triangles", g->file->name));
    for (size_t t = 0; t < g->triangle_count; t++)
        for (int k = 0; k < 3; k++) textured &= g->triangle[t][k].texture >= 0;
    TRY(mesh_create(ctx, (int32_t)g->vertex_count, (int32_t)g->triangle_count, mesh));
    memcpy(mesh->vertex, g->vertex, g->vertex_count * sizeof *g->vertex);
    if (textured) TRY(ALLOCATE(ctx, *uv, g->triangle_count));
    for (size_t t = 0; t < g->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const gathered_corner *corner = &g->triangle[t][k];
            mesh->triangle[t][k] = corner->vertex;
            if (textured) memcpy((*uv)[t][k], g->texture[corner->texture], sizeof *g->texture);
        }
done:
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    return status;
}
