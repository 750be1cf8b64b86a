// Corners by node, triangles across sides, and fans: corners that smooth sides join around a node.
//
// How:     A side is a crease when the normals differ by more than 30 degrees, a step when the thicknesses
//          differ by more than a tenth: across either the stress of one side says nothing of the other.
// Checked: tests/test_recover.c.
#include "structure/fans.h"

static const double CREASE = 0.86602540378443865; // cosine of 30 degrees
static const double STEP = 1.1;                   // ratio of thicknesses

void fans_free(jali_context *ctx, fans *f)
{
    release(ctx, f->first);
    release(ctx, f->corner);
    release(ctx, f->beside);
    release(ctx, f->smooth);
    release(ctx, f->fan);
    release(ctx, f->first_fan);
    *f = (fans){0};
}

static void list_corners(const jali_sheet *sheet, fans *f)
{
    for (int32_t c = 0; c < 3 * sheet->triangle_count; c++) f->first[sheet->triangle[c / 3][c % 3] + 1]++;
    for (int32_t n = 0; n < f->node_count; n++) f->first[n + 1] += f->first[n];
    // Filled from the end, each start moves down to its own place.
    for (int32_t c = 3 * sheet->triangle_count; c-- > 0;)
        f->corner[--f->first[sheet->triangle[c / 3][c % 3] + 1]] = c;
    memmove(f->first, f->first + 1, (size_t)f->node_count * sizeof *f->first);
    f->first[f->node_count] = 3 * sheet->triangle_count;
}

static int32_t across(const jali_sheet *sheet, const fans *f, int32_t t, int32_t a, int32_t b)
{
    int32_t found = -1;
    for (int32_t i = f->first[a]; i < f->first[a + 1]; i++) {
        int32_t other = f->corner[i] / 3;
        const int32_t *n = sheet->triangle[other];
        if (other == t || (n[0] != b && n[1] != b && n[2] != b)) continue;
        if (found >= 0) return -1;
        found = other;
    }
    return found;
}

int32_t triangle_across(const jali_sheet *sheet, const fans *f, int32_t t, int i)
{
    int32_t known = f->beside[3 * t + i];
    return known == NOT_SOUGHT ? across(sheet, f, t, sheet->triangle[t][i], sheet->triangle[t][(i + 1) % 3])
                               : known;
}

void mark_around(const jali_sheet *sheet, const uint8_t *from, uint8_t *to)
{
    memset(to, 0, (size_t)sheet->node_count);
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        const int32_t *n = sheet->triangle[t];
        if (from[n[0]] | from[n[1]] | from[n[2]]) to[n[0]] = to[n[1]] = to[n[2]] = 1;
    }
}

// What the passes over blocks of triangles or nodes share.
typedef struct fan_job {
    const jali_sheet *sheet;
    const double (*normal)[3];
    const double *thickness;
    const uint8_t *wanted, *around; // [node_count] around: they and their neighbours; NULL: all
    fans *f;
} fan_job;

// Is a side of the triangle of any fan that is wanted, or next to one?
static bool is_near(const fan_job *job, int32_t t)
{
    const int32_t *n = job->sheet->triangle[t];
    return !job->around || job->around[n[0]] || job->around[n[1]] || job->around[n[2]];
}

enum { BLOCK = 1024 };

static void join_sides(void *shared, int32_t block)
{
    const fan_job *job = shared;
    const jali_sheet *sheet = job->sheet;
    for (int32_t t = block * BLOCK; t < MIN((block + 1) * BLOCK, sheet->triangle_count); t++)
        for (int i = 0; i < 3; i++) {
            if (!is_near(job, t)) {
                job->f->beside[3 * t + i] = NOT_SOUGHT;
                continue;
            }
            int32_t o = across(sheet, job->f, t, sheet->triangle[t][i], sheet->triangle[t][(i + 1) % 3]);
            job->f->beside[3 * t + i] = o;
            if (o < 0) continue;
            const double *n = job->normal[t], *m = job->normal[o];
            double along = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
            double thick = MAX(job->thickness[t], job->thickness[o]),
                   thin = MIN(job->thickness[t], job->thickness[o]);
            job->f->smooth[3 * t + i] = along >= CREASE && thick <= STEP * thin;
        }
}

// Give the corner, and those that smooth sides join to it around its node, the number of a fan: turn one way
// until a side that joins nothing, then the other way.
static void mark_fan(const jali_sheet *sheet, fans *f, int32_t corner, int32_t number)
{
    int32_t node = sheet->triangle[corner / 3][corner % 3];
    f->fan[corner] = number;
    for (int way = 0; way < 2; way++)
        for (int32_t c = corner;;) {
            int32_t side = c / 3 * 3 + (c % 3 + (way ? 0 : 2)) % 3, next = f->beside[side], i = 0;
            if (next < 0 || !f->smooth[side]) break;
            while (sheet->triangle[next][i] != node) i++;
            c = 3 * next + i;
            if (f->fan[c] >= 0) break;
            f->fan[c] = number;
        }
}

// Around each node from 0 on; how many there are stands at the next node's first.
static void mark_fans(void *shared, int32_t block)
{
    const fan_job *job = shared;
    fans *f = job->f;
    for (int32_t n = block * BLOCK; n < MIN((block + 1) * BLOCK, f->node_count); n++) {
        int32_t count = 0;
        if (job->wanted && !job->wanted[n]) {
            for (int32_t i = f->first[n]; i < f->first[n + 1]; i++) f->fan[f->corner[i]] = 0;
            f->first_fan[n + 1] = f->first[n] < f->first[n + 1];
            continue;
        }
        for (int32_t i = f->first[n]; i < f->first[n + 1]; i++) f->fan[f->corner[i]] = -1;
        for (int32_t i = f->first[n]; i < f->first[n + 1]; i++)
            if (f->fan[f->corner[i]] < 0) mark_fan(job->sheet, f, f->corner[i], count++);
        f->first_fan[n + 1] = count;
    }
}

static void shift_fans(void *shared, int32_t block)
{
    fans *f = ((const fan_job *)shared)->f;
    for (int32_t n = block * BLOCK; n < MIN((block + 1) * BLOCK, f->node_count); n++)
        for (int32_t i = f->first[n]; i < f->first[n + 1]; i++) f->fan[f->corner[i]] += f->first_fan[n];
}

static void number_fans(jali_context *ctx, fan_job *job)
{
    fans *f = job->f;
    int32_t blocks = (f->node_count + BLOCK - 1) / BLOCK;
    parallel(ctx, blocks, mark_fans, job);
    f->first_fan[0] = 0;
    for (int32_t n = 0; n < f->node_count; n++) f->first_fan[n + 1] += f->first_fan[n];
    f->fan_count = f->first_fan[f->node_count];
    parallel(ctx, blocks, shift_fans, job);
}

jali_status fans_of(jali_context *ctx, const jali_sheet *sheet, const double (*normal)[3],
                    const double *thickness, const uint8_t *wanted, fans *f)
{
    jali_status status;
    uint8_t *around = NULL;
    *f = (fans){.node_count = sheet->node_count};
    if (sheet->triangle_count > INT32_MAX / 3)
        return fail(ctx, JALI_LIMIT, "a sheet of %d triangles; at most %d fit", sheet->triangle_count,
                    INT32_MAX / 3);
    size_t corners = 3 * (size_t)sheet->triangle_count, nodes = (size_t)sheet->node_count;
    TRY(ALLOCATE_CLEARED(ctx, f->first, nodes + 2));
    TRY(ALLOCATE(ctx, f->corner, corners));
    TRY(ALLOCATE(ctx, f->beside, corners));
    TRY(ALLOCATE_CLEARED(ctx, f->smooth, corners));
    TRY(ALLOCATE(ctx, f->fan, corners));
    TRY(ALLOCATE(ctx, f->first_fan, nodes + 1));
    list_corners(sheet, f);
    if (wanted) {
        TRY(ALLOCATE(ctx, around, nodes));
        mark_around(sheet, wanted, around);
    }
    fan_job job = {sheet, normal, thickness, wanted, around, f};
    parallel(ctx, (sheet->triangle_count + BLOCK - 1) / BLOCK, join_sides, &job);
    number_fans(ctx, &job);
done:
    release(ctx, around);
    if (status != JALI_OK) fans_free(ctx, f);
    return status;
}
