// Edits by hand as values: freed, taken along with their picture, made of bridges.
//
// A picture is cropped, then turned clockwise, then mirrored; so are points, by one affine map whose linear
// part is a scale and a symmetry of the square. The way back is its inverse. Checked: tests/test_edits.c.
#include <jali/edits.h>
#include "base/base.h"

#include <math.h>

static const double SAME_SHAPE = 0.01; // how far the scales of width and height may be apart

void jali_edits_free(jali_context *ctx, jali_edits *edits)
{
    release(ctx, edits->edit);
    release(ctx, edits->point);
    *edits = (jali_edits){0};
}

/// x' = m[0][0] x + m[0][1] y + m[0][2], likewise y'.
typedef struct affine {
    double m[2][3];
} affine;

// First `a`, then `b`.
static affine then(const affine *a, const affine *b)
{
    affine both = {0};
    for (int i = 0; i < 2; i++) {
        both.m[i][2] = b->m[i][2];
        for (int k = 0; k < 3; k++)
            for (int j = 0; j < 2; j++) both.m[i][k] += b->m[i][j] * a->m[j][k];
    }
    return both;
}

static void move_point(const affine *a, double p[2])
{
    double x = p[0], y = p[1];
    for (int i = 0; i < 2; i++) p[i] = a->m[i][0] * x + a->m[i][1] * y + a->m[i][2];
}

// The linear parts here are symmetries of the square, scaled: the inverse is the transpose over the square of
// the scale.
static affine inverse(const affine *a)
{
    affine back = {0};
    double scale2 = a->m[0][0] * a->m[0][0] + a->m[1][0] * a->m[1][0];
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) back.m[i][k] = a->m[k][i] / scale2;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) back.m[i][2] -= back.m[i][k] * a->m[k][2];
    return back;
}

// From the file's pixels to those of the picture as it was read.
//   out  size   of that picture
static affine way_in(const jali_read_options *read, const int32_t file_px[2], double size[2])
{
    static const affine turn[4] = {{{{1, 0, 0}, {0, 1, 0}}},
                                   {{{0, -1, 0}, {1, 0, 0}}},
                                   {{{-1, 0, 0}, {0, -1, 0}}},
                                   {{{0, 1, 0}, {-1, 0, 0}}}};
    const int32_t *crop = read->crop_px;
    bool cropped = crop[2] > 0;
    double width = cropped ? crop[2] : file_px[0], height = cropped ? crop[3] : file_px[1];
    affine in = {{{1, 0, cropped ? -crop[0] : 0}, {0, 1, cropped ? -crop[1] : 0}}};
    affine turned = turn[read->quarter_turns & 3];
    double corner[2] = {width, height};
    move_point(&turned, corner);
    for (int i = 0; i < 2; i++) { // back to where x and y are not negative
        turned.m[i][2] = corner[i] < 0 ? -corner[i] : 0;
        size[i] = fabs(corner[i]);
    }
    in = then(&in, &turned);
    if (read->mirror) {
        affine mirrored = {{{-1, 0, size[0]}, {0, 1, 0}}};
        in = then(&in, &mirrored);
    }
    return in;
}

static void move_edits(const affine *by, double scale, jali_edits *edits)
{
    for (int32_t i = 0; i < edits->point_count; i++) move_point(by, edits->point[i]);
    for (int32_t i = 0; i < edits->count; i++) edits->edit[i].width *= scale;
}

jali_status jali_edits_follow(jali_context *ctx, const jali_read_options *given, const int32_t file_px[2],
                              jali_edits *edits)
{
    jali_read_options read = given ? *given : jali_read_defaults();
    double across = file_px[0] / edits->size[0], down = file_px[1] / edits->size[1];
    if (edits->count == 0) return JALI_OK;
    if (!(fabs(across - down) <= SAME_SHAPE * MAX(across, down) + 1.0 / MIN(edits->size[0], edits->size[1])))
        return fail(ctx, JALI_BAD_INPUT,
                    "the edits were made for a picture of %g x %g; this one is %d x %d px, of another shape",
                    edits->size[0], edits->size[1], file_px[0], file_px[1]);
    affine to_file = {{{across, 0, 0}, {0, down, 0}}}, in = way_in(&read, file_px, edits->size);
    affine whole = then(&to_file, &in);
    move_edits(&whole, (across + down) / 2, edits);
    return JALI_OK;
}

jali_status jali_edits_repeat(jali_context *ctx, const jali_edits *edits, int32_t copies, jali_edits *row)
{
    jali_status status;
    *row = (jali_edits){.size = {edits->size[0] * copies, edits->size[1]}};
    if (MAX(edits->point_count, edits->count) > INT32_MAX / copies)
        return fail(ctx, JALI_LIMIT, "%d points of edits on %d copies are too many", edits->point_count,
                    copies);
    TRY(ALLOCATE(ctx, row->edit, (size_t)edits->count * (size_t)copies));
    TRY(ALLOCATE(ctx, row->point, (size_t)edits->point_count * (size_t)copies));
    for (int32_t copy = 0; copy < copies; copy++) {
        for (int32_t i = 0; i < edits->count; i++) {
            row->edit[row->count] = edits->edit[i];
            row->edit[row->count++].first += copy * edits->point_count;
        }
        for (int32_t i = 0; i < edits->point_count; i++, row->point_count++) {
            row->point[row->point_count][0] = edits->point[i][0] + copy * edits->size[0];
            row->point[row->point_count][1] = edits->point[i][1];
        }
    }
done:
    if (status != JALI_OK) jali_edits_free(ctx, row);
    return status;
}

// From pixels of the grid, at their centres, to those of the picture as it was read.
static affine way_off_grid(const jali_chart *chart, const jali_picture *picture, int32_t copies)
{
    int32_t margin = chart->margin_px;
    double across = (double)picture->width_px * copies / (chart->width_px - 2 * margin),
           down = (double)picture->height_px / (chart->height_px - 2 * margin);
    return (affine){{{across, 0, (0.5 - margin) * across}, {0, down, (0.5 - margin) * down}}};
}

jali_status jali_edits_of_bridges(jali_context *ctx, const jali_bridges *bridges, const jali_chart *chart,
                                  int32_t width_px, const jali_picture *picture,
                                  const jali_read_options *given, int32_t copies, jali_edits *edits)
{
    jali_status status;
    jali_read_options read = given ? *given : jali_read_defaults();
    bool across = read.quarter_turns % 2 == 1, cropped = read.crop_px[2] > 0;
    int32_t file_px[2] = {cropped  ? picture->file_px[0]
                          : across ? picture->height_px
                                   : picture->width_px,
                          cropped  ? picture->file_px[1]
                          : across ? picture->width_px
                                   : picture->height_px};
    double size[2];
    affine grid = way_off_grid(chart, picture, copies), in = way_in(&read, file_px, size), out = inverse(&in);
    *edits = (jali_edits){.size = {file_px[0], file_px[1]}};
    TRY(ALLOCATE(ctx, edits->edit, bridges->count));
    TRY(ALLOCATE(ctx, edits->point, 2 * (size_t)bridges->count + (size_t)bridges->via_count));
    for (int32_t i = 0; i < bridges->count; i++) {
        const jali_bridge *b = &bridges->bridge[i];
        int32_t ends[2][2];
        if (b->from[0] * grid.m[0][0] + grid.m[0][2] >= picture->width_px && copies > 1) continue;
        edits->edit[edits->count++] = (jali_edit){.kind = JALI_EDIT_BRIDGE,
                                                  .width = width_px * grid.m[0][0],
                                                  .first = edits->point_count,
                                                  .count = b->via_count + 2};
        for (int32_t leg = 0; jali_bridge_leg(bridges, i, leg, ends[0], ends[1]); leg++)
            for (int32_t end = leg > 0; end < 2; end++) {
                double *point = edits->point[edits->point_count++];
                for (int k = 0; k < 2; k++) point[k] = ends[end][k];
                move_point(&grid, point);
                move_point(&out, point);
            }
    }
done:
    if (status != JALI_OK) jali_edits_free(ctx, edits);
    return status;
}
