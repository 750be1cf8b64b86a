// Meshes as values: create, validate, weld, free.
#include "mesh/mesh.h"

#include <math.h>

jali_status mesh_create(jali_context *ctx, int32_t vertex_count, int32_t triangle_count, jali_mesh *mesh)
{
    jali_status status;
    *mesh = (jali_mesh){.vertex_count = vertex_count, .triangle_count = triangle_count};
    TRY(ALLOCATE(ctx, mesh->vertex, vertex_count));
    TRY(ALLOCATE(ctx, mesh->triangle, triangle_count));
done:
    if (status != JALI_OK) jali_mesh_free(ctx, mesh);
    return status;
}

void jali_mesh_free(jali_context *ctx, jali_mesh *mesh)
{
    release(ctx, mesh->vertex);
    release(ctx, mesh->triangle);
    *mesh = (jali_mesh){0};
}

jali_status mesh_validate(jali_context *ctx, const jali_mesh *mesh)
{
    // Half-edges are numbered 3 t + k in 32 bits.
    if (mesh->triangle_count > INT32_MAX / 3)
        return fail(ctx, JALI_LIMIT, "%d triangles are more than the %d accepted", mesh->triangle_count,
                    INT32_MAX / 3);
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int32_t k = 0; k < 3; k++)
            if (!isfinite(mesh->vertex[i][k]))
                return fail(ctx, JALI_BAD_INPUT, "coordinate %c of vertex %d is not a finite number", 'x' + k,
                            i);
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int32_t k = 0; k < 3; k++)
            if (mesh->triangle[t][k] < 0 || mesh->triangle[t][k] >= mesh->vertex_count)
                return fail(ctx, JALI_BAD_INPUT, "triangle %d names vertex %d; there are %d, counted from 0",
                            t, mesh->triangle[t][k], mesh->vertex_count);
    return JALI_OK;
}

int32_t mesh_round(jali_mesh *mesh)
{
    enum { BITS = 24, LEAST_EXPONENT = -60 };
    double farthest = 0;
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) farthest = MAX(farthest, fabs(mesh->vertex[i][k]));
    int exponent;
    frexp(farthest, &exponent); // farthest < 2^exponent, and rounding up may reach it: still a float32
    exponent = MAX(exponent - BITS, LEAST_EXPONENT);
    double unit = ldexp(1, exponent);
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) mesh->vertex[i][k] = rint(mesh->vertex[i][k] / unit) * unit + 0.0;
    return exponent;
}

static uint64_t place_hash(const double point[3])
{
    uint64_t hash = 0;
    for (int32_t k = 0; k < 3; k++) {
        double value = point[k] + 0.0; // -0 becomes 0
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 29;
    }
    return hash;
}

static bool same_place(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

jali_status weld_points(jali_context *ctx, int32_t count, const double (*point)[3], int32_t *first,
                        int32_t *distinct)
{
    size_t slots = 16;
    while (slots < 2 * (size_t)count) slots *= 2;
    int32_t *table; // [slots], index + 1, 0 = free
    jali_status status = ALLOCATE_CLEARED(ctx, table, slots);
    if (status != JALI_OK) return status;
    int32_t places = 0;
    for (int32_t i = 0; i < count; i++) {
        size_t slot = place_hash(point[i]) & (slots - 1);
        while (table[slot] && !same_place(point[table[slot] - 1], point[i])) slot = (slot + 1) & (slots - 1);
        if (!table[slot]) {
            table[slot] = i + 1;
            places++;
        }
        first[i] = table[slot] - 1;
    }
    if (distinct) *distinct = places;
    release(ctx, table);
    return JALI_OK;
}
