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

// The other triangle that has both ends of a side; -1 when there is none, or more than one.
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

static void join_sides(const jali_sheet *sheet, const double (*normal)[3], const double *thickness, fans *f)
{
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            int32_t o = across(sheet, f, t, sheet->triangle[t][i], sheet->triangle[t][(i + 1) % 3]);
            f->beside[3 * t + i] = o;
            if (o < 0) continue;
            double along =
                normal[t][0] * normal[o][0] + normal[t][1] * normal[o][1] + normal[t][2] * normal[o][2];
            double thick = MAX(thickness[t], thickness[o]), thin = MIN(thickness[t], thickness[o]);
            f->smooth[3 * t + i] = along >= CREASE && thick <= STEP * thin;
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

static void number_fans(const jali_sheet *sheet, fans *f)
{
    for (int32_t c = 0; c < 3 * sheet->triangle_count; c++) f->fan[c] = -1;
    for (int32_t n = 0; n < f->node_count; n++) {
        f->first_fan[n] = f->fan_count;
        for (int32_t i = f->first[n]; i < f->first[n + 1]; i++)
            if (f->fan[f->corner[i]] < 0) mark_fan(sheet, f, f->corner[i], f->fan_count++);
    }
    f->first_fan[f->node_count] = f->fan_count;
}

jali_status fans_of(jali_context *ctx, const jali_sheet *sheet, const double (*normal)[3],
                    const double *thickness, fans *f)
{
    jali_status status;
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
    join_sides(sheet, normal, thickness, f);
    number_fans(sheet, f);
done:
    if (status != JALI_OK) fans_free(ctx, f);
    return status;
}
