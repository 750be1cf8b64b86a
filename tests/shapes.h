// Meshes for tests: boxes, a tetrahedron, a torus, a pierced plate; added together, moved, turned inside out.
#ifndef TESTS_SHAPES_H
#define TESTS_SHAPES_H

#include "testing.h"
#include "mesh/mesh.h"

#include <math.h>

static inline jali_mesh shape(int32_t vertices, const double (*vertex)[3], int32_t triangles,
                              const int32_t (*triangle)[3])
{
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, vertices, triangles, &mesh));
    if (vertices) memcpy(mesh.vertex, vertex, (size_t)vertices * sizeof *vertex);
    if (triangles) memcpy(mesh.triangle, triangle, (size_t)triangles * sizeof *triangle);
    return mesh;
}

/// Corner i of the box has x high for bit 0, y for bit 1, z for bit 2.
static inline jali_mesh box_shape(double x0, double y0, double z0, double x1, double y1, double z1)
{
    static const int32_t triangle[12][3] = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    double vertex[8][3];
    for (int i = 0; i < 8; i++) {
        vertex[i][0] = i & 1 ? x1 : x0;
        vertex[i][1] = i & 2 ? y1 : y0;
        vertex[i][2] = i & 4 ? z1 : z0;
    }
    return shape(8, (const double(*)[3])vertex, 12, triangle);
}

static inline jali_mesh tetrahedron(void)
{
    static const double vertex[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const int32_t triangle[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return shape(4, vertex, 4, triangle);
}

/// around x along quads, radii 3 and 1.
static inline jali_mesh torus(int32_t around, int32_t along)
{
    const double turn = 6.283185307179586;
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, around * along, 2 * around * along, &mesh));
    for (int32_t i = 0; i < around; i++)
        for (int32_t j = 0; j < along; j++) {
            double a = turn * i / around, b = turn * j / along, r = 3 + cos(b);
            int32_t here = i * along + j, right = (i + 1) % around * along + j;
            int32_t up = i * along + (j + 1) % along, both = (i + 1) % around * along + (j + 1) % along;
            double at[3] = {r * cos(a), r * sin(a), sin(b)};
            memcpy(mesh.vertex[here], at, sizeof at);
            memcpy(mesh.triangle[2 * here], (int32_t[3]){here, right, both}, sizeof *mesh.triangle);
            memcpy(mesh.triangle[2 * here + 1], (int32_t[3]){here, both, up}, sizeof *mesh.triangle);
        }
    return mesh;
}

/// Both, the second behind the first; frees them.
static inline jali_mesh together(jali_mesh a, jali_mesh b)
{
    jali_mesh sum;
    CHECK_OK(mesh_create(ctx, a.vertex_count + b.vertex_count, a.triangle_count + b.triangle_count, &sum));
    memcpy(sum.vertex, a.vertex, (size_t)a.vertex_count * sizeof *a.vertex);
    memcpy(sum.vertex + a.vertex_count, b.vertex, (size_t)b.vertex_count * sizeof *b.vertex);
    memcpy(sum.triangle, a.triangle, (size_t)a.triangle_count * sizeof *a.triangle);
    for (int32_t t = 0; t < b.triangle_count; t++)
        for (int k = 0; k < 3; k++) sum.triangle[a.triangle_count + t][k] = b.triangle[t][k] + a.vertex_count;
    jali_mesh_free(ctx, &a);
    jali_mesh_free(ctx, &b);
    return sum;
}

static inline void flip_triangle(jali_mesh *mesh, int32_t t)
{
    int32_t swap = mesh->triangle[t][1];
    mesh->triangle[t][1] = mesh->triangle[t][2];
    mesh->triangle[t][2] = swap;
}

static inline jali_mesh inside_out(jali_mesh mesh)
{
    for (int32_t t = 0; t < mesh.triangle_count; t++) flip_triangle(&mesh, t);
    return mesh;
}

// One square of a pierced plate: bottom and top, and a wall wherever the neighbour is not solid.
static inline int32_t add_cell(jali_mesh *mesh, int32_t at, const int32_t corner[2][4], const bool wall[4])
{
    static const int order[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int half = 0; half < 2; half++)
        for (int k = 0; k < 3; k++) {
            mesh->triangle[at + half][k] = corner[0][order[half][2 - k]];
            mesh->triangle[at + 2 + half][k] = corner[1][order[half][k]];
        }
    at += 4;
    for (int side = 0; side < 4; side++) {
        if (!wall[side]) continue;
        int32_t a = corner[0][side], b = corner[0][(side + 1) % 4];
        int32_t c = corner[1][(side + 1) % 4], d = corner[1][side];
        memcpy(mesh->triangle[at++], (int32_t[3]){a, b, c}, sizeof *mesh->triangle);
        memcpy(mesh->triangle[at++], (int32_t[3]){a, c, d}, sizeof *mesh->triangle);
    }
    return at;
}

/// A plate of n x n square cells of `cell_mm`, 4 mm thick; cells with odd x and y are holes. Vertices inside
/// are moved within the lattice of 2^-10 mm by `seed` (0: not at all), so that its flat faces are no regular
/// grid.
static inline jali_mesh pierced_plate(int32_t n, double cell_mm, uint64_t seed)
{
    int32_t side = n + 1, holes = (n / 2) * (n / 2);
    jali_mesh mesh;
    CHECK_OK(mesh_create(ctx, 2 * side * side, 4 * (n * n - holes) + 8 * n + 8 * holes, &mesh));
    for (int32_t y = 0; y < side; y++)
        for (int32_t x = 0; x < side; x++) {
            double dx = 0, dy = 0;
            if (seed && x && y && x < n && y < n) {
                dx = ((double)(next_random(&seed) >> 56) - 128) / 1024 * cell_mm;
                dy = ((double)(next_random(&seed) >> 56) - 128) / 1024 * cell_mm;
            }
            for (int level = 0; level < 2; level++) {
                double at[3] = {x * cell_mm + dx, y * cell_mm + dy, 4.0 * level};
                memcpy(mesh.vertex[level * side * side + y * side + x], at, sizeof at);
            }
        }
    int32_t at = 0;
    for (int32_t y = 0; y < n; y++)
        for (int32_t x = 0; x < n; x++) {
            if (x & y & 1) continue;
            int32_t corner[2][4];
            for (int level = 0; level < 2; level++)
                for (int k = 0; k < 4; k++)
                    corner[level][k] = level * side * side + (y + (k >> 1)) * side + x + ((k + 1) >> 1 & 1);
            bool odd_x = x & 1, odd_y = y & 1;
            bool wall[4] = {y == 0 || (odd_x && y >= 1 && !odd_y && y - 1 < n),
                            x == n - 1 || (odd_y && !odd_x), y == n - 1 || (odd_x && !odd_y),
                            x == 0 || (odd_y && !odd_x)};
            at = add_cell(&mesh, at, (const int32_t(*)[4])corner, wall);
        }
    CHECK_INT(at, mesh.triangle_count);
    return mesh;
}

#endif
