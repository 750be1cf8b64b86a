// From places of a chart to the middle of a wall: the triangle of the patch there, and its corners on both
// skins.
//
// How:     a grid of cells lists the triangles of the patch. Within a triangle the map is affine, or
// projective by
//          the patch's weights, as in carve/pierce.c. Places that rounding put outside take the nearest
//          triangle.
// Checked: tests/test_sheet.c.
#include "sheet/chart_lift.h"
#include "base/vector.h"

#include <math.h>

// A facet of size h on a curve of radius R under a wall of t is too stiff when h^2 > R t / 2.
static const double CURVED_SIZE = 0.5;
// How far beyond its triangle a place may lie, as a share of the triangle.
static const double ASTRAY = 0.05;

void chart_lift_free(jali_context *ctx, chart_lift *l)
{
    release(ctx, l->most);
    release(ctx, l->first);
    release(ctx, l->face);
    *l = (chart_lift){0};
}

// --- Curvature

// Normals at vertices, weighted by area.
static void add_normals(const jali_mesh *mesh, double (*normal)[3])
{
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->triangle[t];
        double u[3], w[3];
        subtract(mesh->vertex[v[1]], mesh->vertex[v[0]], u);
        subtract(mesh->vertex[v[2]], mesh->vertex[v[0]], w);
        double cross[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) normal[v[i]][k] += cross[k];
    }
}

// From how much the normals turn along each edge.
static jali_status find_curvature(jali_context *ctx, chart_lift *l)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    const jali_mesh *mesh = &l->shell->outer.mesh;
    double(*normal)[3];
    TRY(ARENA(ctx, normal, mesh->vertex_count + 1));
    memset(normal, 0, ((size_t)mesh->vertex_count + 1) * sizeof *normal);
    add_normals(mesh, normal);
    TRY(ALLOCATE(ctx, l->most, mesh->vertex_count + 1));
    for (int32_t v = 0; v < mesh->vertex_count; v++) l->most[v] = INFINITY;
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        int32_t a = mesh->triangle[i / 3][i % 3], b = mesh->triangle[i / 3][(i + 1) % 3];
        double edge[3], wall[3];
        subtract(mesh->vertex[b], mesh->vertex[a], edge);
        subtract(mesh->vertex[a], l->shell->inner[a], wall);
        double lengths = sqrt(dot(normal[a], normal[a]) * dot(normal[b], normal[b]));
        double turn = lengths > 0 ? acos(fmin(fmax(dot(normal[a], normal[b]) / lengths, -1), 1)) : 0;
        if (turn < 1e-6) continue;
        double radius = sqrt(dot(edge, edge)) / turn,
               size = sqrt(CURVED_SIZE * radius * sqrt(dot(wall, wall)));
        size = MAX(size, l->finest_mm);
        l->most[a] = MIN(l->most[a], size);
        l->most[b] = MIN(l->most[b], size);
    }
done:
    arena_rewind(ctx, mark);
    return status;
}

// --- The grid

static int32_t cell_of(const chart_lift *l, double at, int axis)
{
    double index = floor((at - l->low[axis]) / l->cell);
    return (int32_t)MIN(MAX(index, 0), (axis == 0 ? l->columns : l->rows) - 1);
}

// The cells that the box of face f meets: columns box[0] .. box[1], rows box[2] .. box[3].
static void box_of(const chart_lift *l, int32_t f, int32_t box[4])
{
    for (int axis = 0; axis < 2; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < 3; k++) {
            double x = (double)l->scale * l->patch->point[l->patch->corner[f][k]][axis];
            low = MIN(low, x);
            high = MAX(high, x);
        }
        box[2 * axis] = cell_of(l, low - 1, axis);
        box[2 * axis + 1] = cell_of(l, high + 1, axis);
    }
}

static void lay_cells(chart_lift *l)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int32_t f = 0; f < l->patch->face_count; f++)
        for (int i = 0; i < 6; i++) {
            double x = (double)l->scale * l->patch->point[l->patch->corner[f][i / 2]][i % 2];
            low[i % 2] = MIN(low[i % 2], x);
            high[i % 2] = MAX(high[i % 2], x);
        }
    double width = high[0] - low[0] + 1, height = high[1] - low[1] + 1;
    l->cell = (int32_t)ceil(sqrt(width * height / (2.0 * l->patch->face_count + 1)));
    l->cell = MAX(l->cell, (int32_t)ceil(MAX(width, height) / 4096));
    for (int k = 0; k < 2; k++) l->low[k] = (int32_t)low[k];
    l->columns = (int32_t)(width / l->cell) + 1;
    l->rows = (int32_t)(height / l->cell) + 1;
}

static jali_status fill_cells(jali_context *ctx, chart_lift *l)
{
    jali_status status;
    int32_t cells = l->columns * l->rows;
    TRY(ALLOCATE_CLEARED(ctx, l->first, cells + 2));
    for (int pass = 0; pass < 2;
         pass++) { // count, then list; first[c + 1] runs from the beginning of c to its end
        for (int32_t f = 0; f < l->patch->face_count; f++) {
            int32_t box[4];
            if (!is_solid(l->shell, l->patch->face[f])) continue;
            box_of(l, f, box);
            for (int32_t row = box[2]; row <= box[3]; row++)
                for (int32_t column = box[0]; column <= box[1]; column++) {
                    int32_t c = row * l->columns + column;
                    if (pass == 0)
                        l->first[c + 2]++;
                    else
                        l->face[l->first[c + 1]++] = f;
                }
        }
        if (pass == 1) break;
        int64_t total = 0;
        for (int32_t c = 0; c < cells; c++) {
            total += l->first[c + 2];
            if (total > INT32_MAX / 2)
                return fail(ctx, JALI_LIMIT, "the surface has too many triangles in the picture");
            l->first[c + 2] = (int32_t)total;
        }
        TRY(ALLOCATE(ctx, l->face, total + 1));
    }
done:
    return status;
}

jali_status chart_lift_create(jali_context *ctx, const jali_patch *patch, const jali_shell *shell,
                              int32_t scale, double step, double finest_mm, chart_lift *l)
{
    jali_status status;
    *l = (chart_lift){.patch = patch, .shell = shell, .scale = scale, .step = step, .finest_mm = finest_mm};
    if (patch->face_count == 0) return fail(ctx, JALI_NO_RESULT, "the picture covers nothing of the surface");
    lay_cells(l);
    TRY(fill_cells(ctx, l));
    TRY(find_curvature(ctx, l));
done:
    if (status != JALI_OK) chart_lift_free(ctx, l);
    return status;
}

// --- Lifting

// Shares of a face's corners at a place, by area on the chart.
static void shares_in_face(const chart_lift *l, int32_t f, double x, double y, double share[3])
{
    const int32_t *corner = l->patch->corner[f], (*point)[2] = (const int32_t(*)[2])l->patch->point;
    double sum = 0, at[2] = {x / l->scale, y / l->scale};
    for (int k = 0; k < 3; k++) {
        const int32_t *a = point[corner[(k + 1) % 3]], *b = point[corner[(k + 2) % 3]];
        share[k] = (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
        sum += share[k];
    }
    for (int k = 0; k < 3; k++) share[k] /= sum;
}

static int32_t face_at(const chart_lift *l, const int32_t at[2], double share[3])
{
    int32_t c = cell_of(l, at[1], 1) * l->columns + cell_of(l, at[0], 0), nearest = -1;
    double best = -ASTRAY, trial[3];
    for (int32_t i = l->first[c]; i < l->first[c + 1] && best < 0; i++) {
        shares_in_face(l, l->face[i], at[0], at[1], trial);
        double least = MIN(MIN(trial[0], trial[1]), trial[2]);
        if (!(least > best)) continue;
        best = least;
        nearest = l->face[i];
        memcpy(share, trial, sizeof trial);
    }
    return nearest;
}

// Shares on the chart become shares in space.
static void add_perspective(const chart_lift *l, int32_t f, double share[3])
{
    double sum = 0;
    if (!l->patch->weight) return;
    for (int k = 0; k < 3; k++) sum += share[k] *= l->patch->weight[l->patch->corner[f][k]];
    for (int k = 0; k < 3; k++) share[k] /= sum;
}

static void mix(const chart_lift *l, int32_t f, const double share[3], double outer_share, double place[3])
{
    for (int k = 0; k < 3; k++) place[k] = 0;
    for (int i = 0; i < 3; i++) {
        int32_t v = l->patch->vertex[l->patch->corner[f][i]];
        for (int k = 0; k < 3; k++)
            place[k] += share[i] * (outer_share * l->shell->outer.mesh.vertex[v][k] +
                                    (1 - outer_share) * l->shell->inner[v][k]);
    }
}

bool lift_to_wall(const chart_lift *l, const int32_t at[2], double place[3], double *thickness_mm)
{
    double share[3], outer[3], inner[3], wall[3];
    int32_t f = face_at(l, at, share);
    if (f < 0) return false;
    add_perspective(l, f, share);
    mix(l, f, share, 0.5, place);
    if (!thickness_mm) return true;
    mix(l, f, share, 1, outer);
    mix(l, f, share, 0, inner);
    subtract(outer, inner, wall);
    *thickness_mm = sqrt(dot(wall, wall));
    return true;
}

bool lift_spot(void *shared, const int32_t at[2], spot *to, double *most)
{
    const chart_lift *l = shared;
    double share[3], slope[2][3];
    int32_t f = face_at(l, at, share);
    if (f < 0) return false;
    add_perspective(l, f, share);
    mix(l, f, share, 0.5, to->place);
    for (int axis = 0; axis < 2; axis++) {
        double end[2][3];
        for (int i = 0; i < 2; i++) {
            double x[2] = {at[0], at[1]}, there[3];
            x[axis] += i ? l->step : -l->step;
            shares_in_face(l, f, x[0], x[1], there);
            add_perspective(l, f, there);
            mix(l, f, there, 0.5, end[i]);
        }
        subtract(end[1], end[0], slope[axis]);
    }
    double square = 0.25 / (l->step * l->step);
    to->metric[0] = square * dot(slope[0], slope[0]);
    to->metric[1] = square * dot(slope[0], slope[1]);
    to->metric[2] = square * dot(slope[1], slope[1]);
    *most = INFINITY;
    for (int k = 0; k < 3; k++) *most = MIN(*most, l->most[l->patch->vertex[l->patch->corner[f][k]]]);
    return true;
}
