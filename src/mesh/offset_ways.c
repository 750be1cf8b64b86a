// The way of each vertex: where the planes of its faces meet when they are all moved by 1.
//
// n . way = 1 for each face around, weighted by the face's angle there. Across a crease or at a corner that
// fixes two or three directions; along a smooth surface all normals are nearly one, and the others are free.
// So the least squares are damped. First towards the mean of the neighbours' ways: free directions follow the
// neighbours, and the inner skin makes room beside a crease as if it were elastic. Then towards the step
// before (iterated Tikhonov): a direction that the faces fix well is reached to (damping / (damping +
// eigenvalue))^steps, and the free ones stay.
//
// Checked: tests/test_offset.c: cubes, wedges, spheres, rims.
#include "mesh/offset_ways.h"
#include "base/vector.h"

#include <math.h>

static const double damping = 0.02; // of the trace; a cube's corner (eigenvalues 1/3) is met to 2e-4
static const double longest_way = 2;
enum { STEPS = 3, ROUNDS = 20, REPAIRS = 64 };

typedef struct fit {
    double a[6], b[3], weight; // sums of w n n^T (xx, xy, xz, yy, yz, zz), w n and w
} fit;

static double unit_normal(const jali_mesh *mesh, int32_t t, double n[3])
{
    const double *a = mesh->vertex[mesh->triangle[t][0]], *b = mesh->vertex[mesh->triangle[t][1]];
    const double *c = mesh->vertex[mesh->triangle[t][2]];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
    }
    double length = sqrt(dot(n, n));
    for (int k = 0; k < 3; k++) n[k] /= length;
    return length;
}

static double angle_of(const jali_mesh *mesh, int32_t t, int corner)
{
    const int32_t *v = mesh->triangle[t];
    double u[3], w[3], square = 0, twice_area[3];
    for (int k = 0; k < 3; k++) {
        u[k] = mesh->vertex[v[(corner + 1) % 3]][k] - mesh->vertex[v[corner]][k];
        w[k] = mesh->vertex[v[(corner + 2) % 3]][k] - mesh->vertex[v[corner]][k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        twice_area[k] = u[i] * w[j] - u[j] * w[i];
        square += twice_area[k] * twice_area[k];
    }
    return atan2(sqrt(square), dot(u, w));
}

static void add_faces(const jali_mesh *mesh, double (*normal)[3], fit *fits)
{
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        double *n = normal[t];
        unit_normal(mesh, t, n);
        for (int c = 0; c < 3; c++) {
            fit *f = &fits[mesh->triangle[t][c]];
            double w = angle_of(mesh, t, c);
            for (int i = 0, at = 0; i < 3; i++) {
                for (int j = i; j < 3; j++) f->a[at++] += w * n[i] * n[j];
                f->b[i] += w * n[i];
            }
            f->weight += w;
        }
    }
}

// Solve (A + more I + stiff p p^T) x = y for a symmetric A, by its inverse's determinants.
static void solve(const double a[6], double more, const double p[3], double stiff, const double y[3],
                  double x[3])
{
    double m[3][3] = {{a[0] + more, a[1], a[2]}, {a[1], a[3] + more, a[4]}, {a[2], a[4], a[5] + more}};
    double minor[3][3], determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) m[i][j] += stiff * p[i] * p[j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            minor[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
        }
    for (int j = 0; j < 3; j++) determinant += m[0][j] * minor[0][j];
    for (int i = 0; i < 3; i++) x[i] = dot(minor[i], y) / determinant;
}

static void scale_to(double length, double v[3])
{
    double now = sqrt(dot(v, v));
    for (int k = 0; k < 3 && now > 0; k++) v[k] *= length / now;
}

// One damped step of the least squares from `towards`, which may be `way`. `rim` is the normal of the plane
// to stay in, or zero.
static void step_way(const fit *f, const double rim[3], const double towards[3], double way[3])
{
    static const double hold =
        100; // of the trace: what is left across the rim's plane is taken off at the end
    double stiff = dot(rim, rim) > 0 ? hold * f->weight : 0, more = damping * f->weight, y[3];
    for (int k = 0; k < 3; k++) y[k] = f->b[k] + more * towards[k];
    solve(f->a, more, rim, stiff, y, way);
    double across = dot(way, rim);
    for (int k = 0; k < 3; k++) way[k] -= across * rim[k];
}

static void first_way(const fit *f, const double rim[3], double way[3])
{
    double across = dot(f->b, rim);
    for (int k = 0; k < 3; k++) way[k] = f->b[k] - across * rim[k];
    scale_to(1, way);
    for (int step = 0; step < STEPS; step++) step_way(f, rim, way, way);
}

// The sum of the neighbours' ways and their number, edges of two triangles counting twice.
static void add_neighbours(const jali_mesh *mesh, const double (*way)[3], double (*sum)[4])
{
    memset(sum, 0, (size_t)mesh->vertex_count * sizeof *sum);
    for (int32_t side = 0; side < 3 * mesh->triangle_count; side++) {
        int32_t a = mesh->triangle[side / 3][side % 3], b = mesh->triangle[side / 3][(side + 1) % 3];
        for (int k = 0; k < 3; k++) {
            sum[a][k] += way[b][k];
            sum[b][k] += way[a][k];
        }
        sum[a][3]++;
        sum[b][3]++;
    }
}

static void find_ways(const jali_mesh *mesh, const fit *fits, const double (*rim)[3], double (*sum)[4],
                      double (*way)[3])
{
    for (int32_t v = 0; v < mesh->vertex_count; v++) first_way(&fits[v], rim[v], way[v]);
    for (int round = 0; round < ROUNDS; round++) {
        add_neighbours(mesh, (const double(*)[3])way, sum);
        for (int32_t v = 0; v < mesh->vertex_count; v++) {
            for (int k = 0; k < 3 && sum[v][3] > 0; k++) sum[v][k] /= sum[v][3];
            step_way(&fits[v], rim[v], sum[v], way[v]);
        }
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        for (int step = 0; step < STEPS; step++) step_way(&fits[v], rim[v], way[v], way[v]);
        if (dot(way[v], way[v]) > longest_way * longest_way) scale_to(longest_way, way[v]);
    }
}

// ---- rims ----

// Follow a rim from `start` until it closes: its length and the normal of its area. False when it does not
// close.
static bool measure_rim(const jali_mesh *mesh, const int32_t *next, int32_t start, int32_t *count,
                        double normal[3])
{
    const double *origin = mesh->vertex[start];
    int32_t v = start;
    memset(normal, 0, 3 * sizeof *normal);
    for (*count = 0; next[v] >= 0 && *count < mesh->vertex_count; v = next[v], ++*count) {
        const double *a = mesh->vertex[v], *b = mesh->vertex[next[v]];
        if (v == start && *count > 0) return true;
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            normal[k] += (a[i] - origin[i]) * (b[j] - origin[j]) - (a[j] - origin[j]) * (b[i] - origin[i]);
        }
    }
    return v == start && *count > 0;
}

// Each closed rim that lies in a plane which the surface meets at 30 degrees at least (nearer to it the way
// would be longer than it may): its vertices get the plane's normal, all others zero.
static void find_flat_rims(const jali_mesh *mesh, const int32_t *twin, const fit *fits, int32_t *next,
                           double (*rim)[3])
{
    memset(rim, 0, (size_t)mesh->vertex_count * sizeof *rim);
    for (int32_t v = 0; v < mesh->vertex_count; v++) next[v] = -1;
    for (int32_t side = 0; side < 3 * mesh->triangle_count; side++)
        if (twin[side] == TWIN_OPEN)
            next[mesh->triangle[side / 3][side % 3]] = mesh->triangle[side / 3][(side + 1) % 3];
    for (int32_t start = 0; start < mesh->vertex_count; start++) {
        double normal[3], least = INFINITY, most = -INFINITY;
        int32_t count;
        if (next[start] < 0) continue;
        bool flat = measure_rim(mesh, next, start, &count, normal);
        double size = sqrt(sqrt(dot(normal, normal)));
        scale_to(1, normal);
        for (int32_t i = 0, v = start; i < count; i++, v = next[v]) {
            least = MIN(least, dot(mesh->vertex[v], normal));
            most = MAX(most, dot(mesh->vertex[v], normal));
            double along = dot(fits[v].b, normal);
            flat &= dot(fits[v].b, fits[v].b) - along * along >= 0.25 * dot(fits[v].b, fits[v].b);
        }
        flat &= most - least <= 1e-6 * size;
        for (int32_t i = 0, v = start, after; i < count; i++, v = after) {
            after = next[v];
            next[v] = -1;
            if (flat) memcpy(rim[v], normal, sizeof normal);
        }
    }
}

// ---- ways that leave a face on the wrong side ----

// Move the way towards the normals it fails, in turn, until it leaves all faces behind: as a perceptron
// learns.
static void repair(const double (*normal)[3], const int32_t *face, int32_t faces, double way[3])
{
    static const double enough = 0.1;
    for (int32_t i = 0; i < REPAIRS; i++) {
        int32_t worst = 0;
        for (int32_t f = 1; f < faces; f++)
            if (dot(normal[face[f]], way) < dot(normal[face[worst]], way)) worst = f;
        double reached = dot(normal[face[worst]], way);
        if (reached >= enough) return;
        for (int k = 0; k < 3; k++) way[k] += (1.5 * enough - reached) * normal[face[worst]][k];
        if (dot(way, way) > longest_way * longest_way) scale_to(longest_way, way);
    }
}

static jali_status repair_ways(jali_context *ctx, const jali_mesh *mesh, const double (*normal)[3],
                               const double (*rim)[3], double (*way)[3])
{
    jali_status status;
    int32_t *start = NULL, *face = NULL;
    TRY(ALLOCATE_CLEARED(ctx, start, (size_t)mesh->vertex_count + 1));
    TRY(ALLOCATE(ctx, face, 3 * (size_t)mesh->triangle_count));
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) start[mesh->triangle[i / 3][i % 3]]++;
    for (int32_t v = 1; v <= mesh->vertex_count; v++) start[v] += start[v - 1];
    for (int32_t i = 3 * mesh->triangle_count - 1; i >= 0; i--)
        face[--start[mesh->triangle[i / 3][i % 3]]] = i / 3;
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        if (dot(rim[v], rim[v]) == 0) repair(normal, face + start[v], start[v + 1] - start[v], way[v]);
done:
    release(ctx, start);
    release(ctx, face);
    return status;
}

jali_status offset_ways(jali_context *ctx, const jali_mesh *mesh, const int32_t *twin, double (*way)[3],
                        float *kept)
{
    jali_status status;
    fit *fits = NULL;
    double(*normal)[3] = NULL, (*rim)[3] = NULL, (*sum)[4] = NULL;
    int32_t *next = NULL;
    TRY(ALLOCATE_CLEARED(ctx, fits, mesh->vertex_count));
    TRY(ALLOCATE(ctx, normal, mesh->triangle_count));
    TRY(ALLOCATE(ctx, rim, mesh->vertex_count));
    TRY(ALLOCATE(ctx, next, mesh->vertex_count));
    TRY(ALLOCATE(ctx, sum, mesh->vertex_count));
    add_faces(mesh, normal, fits);
    find_flat_rims(mesh, twin, fits, next, rim);
    find_ways(mesh, fits, (const double(*)[3])rim, sum, way);
    TRY(repair_ways(ctx, mesh, (const double(*)[3])normal, (const double(*)[3])rim, way));
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        kept[v] = fits[v].weight > 0 ? (float)MIN(dot(fits[v].b, way[v]) / fits[v].weight, 1) : 1;
done:
    release(ctx, fits);
    release(ctx, normal);
    release(ctx, rim);
    release(ctx, next);
    release(ctx, sum);
    return status;
}
