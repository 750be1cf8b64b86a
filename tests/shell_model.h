// Small shell models for tests and benches: grids bent into shape, held, loaded and solved, with any element.
// The assembly is plain and its own, the solver is the library's.
#ifndef TESTS_SHELL_MODEL_H
#define TESTS_SHELL_MODEL_H

#include "structure/element.h"
#include "structure/recover.h"
#include "sparse/solver.h"

#include <math.h>
#include <stdlib.h>

enum { HOLD_X = 1, HOLD_Y = 2, HOLD_Z = 4, HOLD_RX = 8, HOLD_RY = 16, HOLD_RZ = 32, HOLD_ALL = 63 };

typedef void stiffness_of(const double node[3][3], const facet_material *made_of, double k[18][18]);

typedef struct shell_model {
    int32_t node_count, triangle_count;
    double (*node)[3], (*place)[2]; // in space; in the grid, 0 .. 1
    int32_t (*triangle)[3];
    uint8_t *held;              // [node_count] HOLD_...
    double (*load)[6], (*u)[6]; // forces and moments; what they do
    facet_material made_of;
    stiffness_of *element; // facet_stiffness unless another is to be tried
} shell_model;

static inline void *zeros(size_t count, size_t size)
{
    void *block = calloc(count ? count : 1, size);
    if (!block) abort();
    return block;
}

static inline shell_model model_of(int32_t nodes, int32_t triangles, facet_material made_of)
{
    shell_model m = {.node_count = nodes, .triangle_count = triangles, .made_of = made_of};
    m.node = zeros((size_t)nodes, sizeof *m.node);
    m.place = zeros((size_t)nodes, sizeof *m.place);
    m.triangle = zeros((size_t)triangles, sizeof *m.triangle);
    m.held = zeros((size_t)nodes, sizeof *m.held);
    m.load = zeros((size_t)nodes, sizeof *m.load);
    m.u = zeros((size_t)nodes, sizeof *m.u);
    m.element = facet_stiffness;
    return m;
}

static inline void model_free(shell_model *m)
{
    free(m->node), free(m->place), free(m->triangle), free(m->held), free(m->load), free(m->u);
    *m = (shell_model){0};
}

/// Which diagonal cuts the cells of a grid.
typedef enum diagonal { RISING, FALLING, CROSSED } diagonal;

/// A grid of nx by ny cells, node (i, j) at i + j (nx + 1) and (i / nx, j / ny), all in its plane.
static inline shell_model grid_model(int32_t nx, int32_t ny, diagonal cut, facet_material made_of)
{
    shell_model m = model_of((nx + 1) * (ny + 1), 2 * nx * ny, made_of);
    for (int32_t j = 0, n = 0; j <= ny; j++)
        for (int32_t i = 0; i <= nx; i++, n++) {
            m.place[n][0] = m.node[n][0] = (double)i / nx;
            m.place[n][1] = m.node[n][1] = (double)j / ny;
        }
    for (int32_t j = 0, t = 0; j < ny; j++)
        for (int32_t i = 0; i < nx; i++) {
            int32_t a = i + j * (nx + 1), b = a + 1, c = a + nx + 1, d = c + 1;
            bool rising = cut == RISING || (cut == CROSSED && (i + j) % 2 == 0);
            int32_t cell[2][3] = {{a, b, rising ? d : c}, {rising ? a : b, d, c}};
            memcpy(m.triangle[t++], cell[0], sizeof cell[0]);
            memcpy(m.triangle[t++], cell[1], sizeof cell[1]);
        }
    return m;
}

/// A quarter of a disc of radius 1 in rings: place is (radius, angle / 90 degrees).
static inline shell_model fan_model(int32_t rings, facet_material made_of)
{
    shell_model m = model_of((rings + 1) * (rings + 2) / 2, rings * rings, made_of);
    for (int32_t r = 0, n = 0, t = 0; r <= rings; r++)
        for (int32_t j = 0; j <= r; j++, n++) {
            m.place[n][0] = (double)r / rings;
            m.place[n][1] = r ? (double)j / r : 0;
            m.node[n][0] = m.place[n][0] * cos(m.place[n][1] * M_PI / 2);
            m.node[n][1] = m.place[n][0] * sin(m.place[n][1] * M_PI / 2);
            if (r == rings) continue;
            int32_t own[3] = {n, n + r + 1, n + r + 2}, beside[3] = {n, n + r + 2, n + 1};
            memcpy(m.triangle[t++], own, sizeof own);
            if (j < r) memcpy(m.triangle[t++], beside, sizeof beside);
        }
    return m;
}

static inline void hold(shell_model *m, int axis, double at, int what)
{
    for (int32_t n = 0; n < m->node_count; n++)
        if (fabs(m->place[n][axis] - at) < 1e-12) m->held[n] |= (uint8_t)what;
}

/// The node at a place of the grid.
static inline int32_t node_at(const shell_model *m, double s, double t)
{
    int32_t best = 0;
    double least = INFINITY;
    for (int32_t n = 0; n < m->node_count; n++) {
        double d = hypot(m->place[n][0] - s, m->place[n][1] - t);
        if (d < least) least = d, best = n;
    }
    return best;
}

static inline void corners_of(const shell_model *m, int32_t t, double at[3][3])
{
    for (int i = 0; i < 3; i++) memcpy(at[i], m->node[m->triangle[t][i]], sizeof at[i]);
}

/// Twice the area, as a vector along the normal.
static inline void area_vector(const shell_model *m, int32_t t, double v[3])
{
    double at[3][3];
    corners_of(m, t, at);
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        v[k] = (at[1][a] - at[0][a]) * (at[2][b] - at[0][b]) - (at[1][b] - at[0][b]) * (at[2][a] - at[0][a]);
    }
}

/// A pressure along the normals, or a load of `along` an area when that is given.
static inline void load_area(shell_model *m, double pressure, const double along[3])
{
    for (int32_t t = 0; t < m->triangle_count; t++) {
        double v[3];
        area_vector(m, t, v);
        double area = 0.5 * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                m->load[m->triangle[t][i]][k] += along ? area / 3 * along[k] : pressure / 6 * v[k];
    }
}

/// Spread a force, and a moment, over the side of a grid where place[axis] = at, by length.
static inline void load_edge(shell_model *m, int axis, double at, const double force[6])
{
    double whole = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t t = 0; t < m->triangle_count; t++)
            for (int i = 0; i < 3; i++) {
                int32_t a = m->triangle[t][i], b = m->triangle[t][(i + 1) % 3];
                if (fabs(m->place[a][axis] - at) > 1e-12 || fabs(m->place[b][axis] - at) > 1e-12) continue;
                double length = hypot(hypot(m->node[a][0] - m->node[b][0], m->node[a][1] - m->node[b][1]),
                                      m->node[a][2] - m->node[b][2]);
                if (pass == 0) whole += length;
                for (int k = 0; pass == 1 && k < 6; k++) {
                    m->load[a][k] += 0.5 * length / whole * force[k];
                    m->load[b][k] += 0.5 * length / whole * force[k];
                }
            }
}

static inline int ascending(const void *a, const void *b)
{
    int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

// Each node's neighbours of lower number, and itself, as the rows of a matrix.
static inline jali_status lay_rows(jali_context *with, const shell_model *m, block_matrix *a)
{
    jali_status status;
    int32_t *count = zeros((size_t)m->node_count + 1, sizeof *count);
    TRY(ALLOCATE_CLEARED(with, a->row, m->node_count + 1));
    TRY(ALLOCATE(with, a->column, 9 * (size_t)m->triangle_count));
    for (int32_t c = 0; c < 9 * m->triangle_count; c++) {
        const int32_t *n = m->triangle[c / 9];
        a->row[n[c % 9 / 3] + 1] += n[c % 3] <= n[c % 9 / 3];
    }
    for (int32_t n = 0; n < m->node_count; n++) a->row[n + 1] += a->row[n];
    for (int32_t c = 0; c < 9 * m->triangle_count; c++) {
        int32_t own = m->triangle[c / 9][c % 9 / 3], other = m->triangle[c / 9][c % 3];
        if (other <= own) a->column[a->row[own] + count[own]++] = other;
    }
    int64_t kept = 0;
    for (int32_t n = 0; n < m->node_count; n++) { // sort, and drop what comes twice
        int64_t begin = a->row[n];
        a->row[n] = kept;
        qsort(a->column + begin, (size_t)count[n], sizeof *a->column, ascending);
        for (int64_t i = begin; i < begin + count[n]; i++)
            if (i == begin || a->column[i] != a->column[i - 1]) a->column[kept++] = a->column[i];
    }
    a->row[m->node_count] = kept;
done:
    free(count);
    return status;
}

// Add an element's block of two nodes, without what is held.
static inline void add_block(const shell_model *m, block_matrix *a, int32_t row, int32_t column,
                             const double k[18][18], int i, int j)
{
    int64_t count = a->row[row + 1] - a->row[row];
    int32_t *found = bsearch(&column, a->column + a->row[row], (size_t)count, sizeof column, ascending);
    double *to = a->value + a->entry[found - a->column];
    for (int p = 0; p < 6; p++)
        for (int q = 0; q < (row == column ? p + 1 : 6); q++)
            if (!(m->held[row] >> p & 1) && !(m->held[column] >> q & 1)) *to++ += k[6 * i + p][6 * j + q];
}

/// Solve for m->u.
static inline jali_status solve_model(jali_context *with, shell_model *m)
{
    jali_status status;
    block_matrix a = {.node_count = m->node_count};
    solver *s = NULL;
    uint8_t *width = zeros((size_t)m->node_count, sizeof *width);
    double *x = zeros(6 * (size_t)m->node_count, sizeof *x);
    int32_t weak;
    for (int32_t n = 0; n < m->node_count; n++) width[n] = (uint8_t)(6 - __builtin_popcount(m->held[n]));
    TRY(lay_rows(with, m, &a));
    TRY(block_matrix_lay(with, &a, width));
    memset(a.value, 0, (size_t)a.entry[a.row[m->node_count]] * sizeof *a.value);
    for (int32_t t = 0; t < m->triangle_count; t++) {
        double at[3][3], k[18][18];
        const int32_t *n = m->triangle[t];
        corners_of(m, t, at);
        m->element((const double(*)[3])at, &m->made_of, k);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                if (n[j] <= n[i]) add_block(m, &a, n[i], n[j], (const double(*)[18])k, i, j);
    }
    for (int32_t n = 0, at = 0; n < m->node_count; n++)
        for (int k = 0; k < 6; k++)
            if (!(m->held[n] >> k & 1)) x[at++] = m->load[n][k];
    TRY(solver_open(with, &a, (const double(*)[3])m->node, &s));
    TRY(solver_factor(with, s, &weak));
    TRY(solver_solve(with, s, 1, x));
    for (int32_t n = 0, at = 0; n < m->node_count; n++)
        for (int k = 0; k < 6; k++) m->u[n][k] = m->held[n] >> k & 1 ? 0 : x[at++];
done:
    solver_close(with, s);
    block_matrix_free(with, &a);
    free(width);
    free(x);
    return status;
}

/// The model as a sheet; its thickness is freed by the caller, the rest is the model's.
static inline jali_sheet model_sheet(const shell_model *m)
{
    jali_sheet sheet = {.node_count = m->node_count, .triangle_count = m->triangle_count};
    sheet.node = m->node;
    sheet.triangle = m->triangle;
    sheet.thickness_mm = zeros((size_t)m->node_count, sizeof *sheet.thickness_mm);
    for (int32_t n = 0; n < m->node_count; n++) sheet.thickness_mm[n] = m->made_of.thickness_mm;
    return sheet;
}

#endif
