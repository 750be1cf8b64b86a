// A small picture of a mesh: from above and a little from the front, lit from the upper left.
//
// Triangles are drawn into a depth buffer of four by four samples a pixel and box-filtered. A plate shows its
// top light, its walls darker, the background through its holes with the shadow of the rim.
//
// Limits:  samples are drawn from the one side that faces the eye; a mesh with a flipped face shows a hole
//          there.
#include <jali/write.h>

#include "mesh/mesh.h"

#include <math.h>

enum { SAMPLES = 4 }; // a side

typedef struct view {
    double axis[3][3]; // right, up, towards the eye
    double centre[3];  // of the mesh, along the axes
    double scale;      // samples per mm
    int32_t side;      // samples
} view;

typedef struct sample {
    float depth;   // along the eye's axis; -INFINITY: background
    uint8_t light; // 0 .. 255
} sample;

// A flat thing lying down is seen from above, tipped back by 35 degrees and turned by 20.
static view view_of(const jali_mesh *mesh, int32_t side)
{
    const double tip = 0.61, turn = -0.35;
    view v = {.side = side};
    const double right[3] = {cos(turn), sin(turn), 0};
    const double up[3] = {-sin(turn) * cos(tip), cos(turn) * cos(tip), sin(tip)};
    for (int k = 0; k < 3; k++) {
        v.axis[0][k] = right[k];
        v.axis[1][k] = up[k];
        v.axis[2][k] = right[(k + 1) % 3] * up[(k + 2) % 3] - right[(k + 2) % 3] * up[(k + 1) % 3];
    }
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, extent = 0;
    for (int32_t i = 0; i < mesh->vertex_count; i++)
        for (int a = 0; a < 3; a++) {
            double along = 0;
            for (int k = 0; k < 3; k++) along += v.axis[a][k] * mesh->vertex[i][k];
            low[a] = MIN(low[a], along);
            high[a] = MAX(high[a], along);
        }
    for (int a = 0; a < 3; a++) v.centre[a] = mesh->vertex_count ? 0.5 * (low[a] + high[a]) : 0;
    for (int a = 0; a < 2; a++) extent = MAX(extent, mesh->vertex_count ? high[a] - low[a] : 0);
    v.scale = extent > 0 ? 0.92 * side / extent : 1;
    return v;
}

static void project(const view *v, const double p[3], double at[3])
{
    for (int a = 0; a < 3; a++) {
        at[a] = -v->centre[a];
        for (int k = 0; k < 3; k++) at[a] += v->axis[a][k] * p[k];
        at[a] *= v->scale;
    }
    at[0] = 0.5 * v->side + at[0];
    at[1] = 0.5 * v->side - at[1]; // rows run down
}

// Lambert's law with one lamp and some light from everywhere.
static uint8_t light_on(const double a[3], const double b[3], const double c[3])
{
    static const double lamp[3] = {-0.42, 0.28, 0.863}; // from the left, behind and above; unit length
    double u[3], v[3], n[3], length = 0, cosine = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    for (int k = 0; k < 3; k++) {
        n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        length += n[k] * n[k];
        cosine += n[k] * lamp[k];
    }
    if (length > 0) cosine /= sqrt(length);
    return (uint8_t)(70 + 185 * MAX(cosine, 0));
}

// Where on this row `at` + x * `slope` is not negative, cut out of low .. high.
static void cut(double at, double slope, int32_t *low, int32_t *high)
{
    if (slope > 0)
        *low = MAX(*low, (int32_t)MIN(ceil(-at / slope), (double)*high + 1));
    else if (slope < 0)
        *high = MIN(*high, (int32_t)MAX(floor(-at / slope), (double)*low - 1));
    else if (at < 0)
        *high = *low - 1;
}

// Fill the samples whose centres lie within the triangle and that are nearest so far.
static void draw_triangle(const double p[3][3], uint8_t light, int32_t side, sample *buffer)
{
    double ux = p[1][0] - p[0][0], uy = p[1][1] - p[0][1], vx = p[2][0] - p[0][0], vy = p[2][1] - p[0][1];
    double area = ux * vy - uy * vx; // rows run down: negative when the triangle faces the eye
    if (!(area < 0)) return;
    double y0 = MIN(p[0][1], MIN(p[1][1], p[2][1])), y1 = MAX(p[0][1], MAX(p[1][1], p[2][1]));
    int32_t top = (int32_t)MAX(ceil(y0 - 0.5), 0), bottom = (int32_t)MIN(floor(y1 - 0.5), side - 1);
    double s_slope = vy / area, t_slope = -uy / area; // of the barycentric coordinates along the row
    for (int32_t y = top; y <= bottom; y++) {
        double px = 0.5 - p[0][0], py = y + 0.5 - p[0][1];
        double s = (px * vy - py * vx) / area, t = (ux * py - uy * px) / area;
        int32_t left = 0, right = side - 1;
        cut(s, s_slope, &left, &right);
        cut(t, t_slope, &left, &right);
        cut(1 - s - t, -s_slope - t_slope, &left, &right);
        double rise = s_slope * (p[1][2] - p[0][2]) + t_slope * (p[2][2] - p[0][2]);
        double depth = p[0][2] + s * (p[1][2] - p[0][2]) + t * (p[2][2] - p[0][2]);
        sample *row = buffer + (size_t)y * (size_t)side;
        for (int32_t x = left; x <= right; x++)
            if ((float)(depth + x * rise) > row[x].depth) row[x] = (sample){(float)(depth + x * rise), light};
    }
}

static void filter(const sample *buffer, int32_t size_px, uint8_t *rgb)
{
    static const double wood[3] = {0.97, 0.90, 0.78}; // of the light, by channel
    static const double behind[3] = {52, 58, 68};     // what shows through the holes
    int32_t side = size_px * SAMPLES;
    for (int32_t y = 0; y < size_px; y++)
        for (int32_t x = 0; x < size_px; x++) {
            double sum[3] = {0};
            for (int32_t i = 0; i < SAMPLES * SAMPLES; i++) {
                const sample *s = &buffer[(size_t)(y * SAMPLES + i / SAMPLES) * (size_t)side +
                                          (size_t)(x * SAMPLES + i % SAMPLES)];
                for (int k = 0; k < 3; k++) sum[k] += s->depth > -INFINITY ? s->light * wood[k] : behind[k];
            }
            for (int k = 0; k < 3; k++)
                rgb[3 * (y * size_px + x) + k] = (uint8_t)(sum[k] / (SAMPLES * SAMPLES) + 0.5);
        }
}

jali_status jali_thumbnail(jali_context *ctx, const jali_mesh *mesh, int32_t size_px, uint8_t *rgb)
{
    jali_status status;
    sample *buffer = NULL;
    if (size_px < 16 || size_px > 1024)
        return fail(ctx, JALI_BAD_VALUE, "a thumbnail of %d px is outside 16 .. 1024 px", size_px);
    int32_t side = size_px * SAMPLES;
    TRY(step(ctx, "write", 0));
    TRY(mesh_validate(ctx, mesh));
    TRY(ALLOCATE(ctx, buffer, (size_t)side * (size_t)side));
    for (int32_t i = 0; i < side * side; i++) buffer[i] = (sample){-INFINITY, 0};
    view v = view_of(mesh, side);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const double *corner[3];
        double at[3][3];
        for (int i = 0; i < 3; i++) {
            corner[i] = mesh->vertex[mesh->triangle[t][i]];
            project(&v, corner[i], at[i]);
        }
        draw_triangle((const double(*)[3])at, light_on(corner[0], corner[1], corner[2]), side, buffer);
    }
    filter(buffer, size_px, rgb);
done:
    release(ctx, buffer);
    return status;
}
