// Binary STL: 80 bytes of header, a count, 50 bytes a triangle, little endian.
#include <jali/write.h>

#include "base/bytes.h"
#include "mesh/mesh.h"

#include <math.h>

enum { HEADER_BYTES = 84, RECORD_BYTES = 50, BLOCK = 8192 };

typedef struct stl_job {
    const jali_mesh *mesh;
    uint8_t *record; // [triangle_count * RECORD_BYTES]
} stl_job;

static void put_whole(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> 8 * i);
}

static void put_float(uint8_t *to, double value)
{
    float f = (float)value;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    put_whole(to, bits);
}

// The unit normal, zero when there is none: readers are told to work it out then.
static void facet_normal(const double a[3], const double b[3], const double c[3], double n[3])
{
    double u[3], v[3], length = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    for (int k = 0; k < 3; k++) {
        n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        length += n[k] * n[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++) n[k] = length > 0 ? n[k] / length + 0.0 : 0;
}

static void write_block(void *shared, int32_t index)
{
    stl_job *job = shared;
    const jali_mesh *mesh = job->mesh;
    int32_t end = MIN((index + 1) * BLOCK, mesh->triangle_count);
    for (int32_t t = index * BLOCK; t < end; t++) {
        uint8_t *to = job->record + (size_t)t * RECORD_BYTES;
        const double *corner[3];
        double n[3];
        for (int i = 0; i < 3; i++) corner[i] = mesh->vertex[mesh->triangle[t][i]];
        facet_normal(corner[0], corner[1], corner[2], n);
        for (int k = 0; k < 3; k++) put_float(to + 4 * k, n[k]);
        for (int i = 0; i < 9; i++) put_float(to + 12 + 4 * i, corner[i / 3][i % 3]);
        to[48] = to[49] = 0;
    }
}

jali_status jali_write_stl(jali_context *ctx, const jali_mesh *mesh, jali_bytes *bytes)
{
    // Not beginning with "solid", so that no reader takes it for text.
    static const char title[] = "jali: binary STL, millimetres";
    size_t size = HEADER_BYTES + (size_t)mesh->triangle_count * RECORD_BYTES;
    jali_status status = mesh_validate(ctx, mesh);
    if (status == JALI_OK) status = bytes_reserve(ctx, bytes, size);
    if (status != JALI_OK) return status;
    uint8_t *header = bytes->data + bytes->size;
    memset(header, 0, HEADER_BYTES);
    memcpy(header, title, sizeof title);
    put_whole(header + 80, (uint32_t)mesh->triangle_count);
    stl_job job = {mesh, header + HEADER_BYTES};
    parallel(ctx, (mesh->triangle_count + BLOCK - 1) / BLOCK, write_block, &job);
    bytes->size += size;
    return step(ctx, "write", 1);
}
