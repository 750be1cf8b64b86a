// The exact Euclidean distance to the nearest pixel of a tone.
//
// Source:  Meijster, Roerdink, Hesselink, "A general algorithm for computing distance transforms in linear
// time",
//          2000: distances along columns, then along each row the lower envelope of parabolas, all in whole
//          numbers.
// Threads: bands of columns, then bands of rows; each writes to places of its own.
// Checked: tests/test_raster.c against all pairs of pixels.
#include "raster/raster.h"
#include "base/base.h"

enum { BANDS = 32 };

typedef struct distance_job {
    const jali_bitmap *a;
    bool white;
    int32_t *squared; // [rows * width]: first the distance along the column, then the squared one
    int32_t first_row, rows;
    int32_t *scratch; // [BANDS][3 * width]: sources of the envelope, where each begins, a row of columns'
                      // distances
} distance_job;

static void band_of(int32_t band, int32_t count, int32_t *first, int32_t *end)
{
    *first = (int32_t)((int64_t)count * band / BANDS);
    *end = (int32_t)((int64_t)count * (band + 1) / BANDS);
}

// Rows to the nearest pixel above, then below, for columns x0 .. x1-1; DISTANCE_NONE in a column without one.
static void along_columns(void *shared, int32_t band)
{
    const distance_job *job = shared;
    const jali_bitmap *a = job->a;
    int32_t width = a->width_px, last = job->first_row + job->rows - 1, x0, x1;
    band_of(band, width, &x0, &x1);
    if (x0 == x1) return;
    int32_t *above = job->scratch + x0, *row = NULL; // one column each; bands own their part
    for (int32_t x = x0; x < x1; x++) above[x - x0] = DISTANCE_NONE;
    for (int32_t y = 0; y <= last; y++) {
        row = y >= job->first_row ? job->squared + (int64_t)(y - job->first_row) * width : NULL;
        for (int32_t x = x0; x < x1; x++) {
            int32_t *d = &above[x - x0];
            *d = jali_bitmap_get(a, x, y) == job->white ? 0 : *d == DISTANCE_NONE ? DISTANCE_NONE : *d + 1;
            if (row) row[x] = *d;
        }
    }
    for (int32_t x = x0; x < x1; x++) above[x - x0] = DISTANCE_NONE;
    for (int32_t y = a->height_px - 1; y >= job->first_row; y--) {
        row = y <= last ? job->squared + (int64_t)(y - job->first_row) * width : NULL;
        for (int32_t x = x0; x < x1; x++) {
            int32_t *d = &above[x - x0];
            *d = jali_bitmap_get(a, x, y) == job->white ? 0 : *d == DISTANCE_NONE ? DISTANCE_NONE : *d + 1;
            if (row) row[x] = MIN(row[x], *d);
        }
    }
}

static int64_t parabola(int64_t x, int64_t source, int64_t column_distance)
{
    return (x - source) * (x - source) + column_distance * column_distance;
}

// The first column from which on the parabola of `right` is not above that of `left`.
static int64_t passed_at(int64_t left, int64_t left_distance, int64_t right, int64_t right_distance)
{
    int64_t twice =
        right * right - left * left + right_distance * right_distance - left_distance * left_distance;
    int64_t step = 2 * (right - left);
    return twice >= 0 ? (twice + step - 1) / step : -(-twice / step); // rounded up
}

static void along_row(int32_t *row, int32_t width, int32_t *source, int32_t *begin, int32_t *column_distance)
{
    int32_t count = 0;
    memcpy(column_distance, row, (size_t)width * sizeof *row);
    for (int32_t x = 0; x < width; x++) {
        if (column_distance[x] == DISTANCE_NONE) continue;
        int64_t from = 0;
        while (count > 0) {
            from = passed_at(source[count - 1], column_distance[source[count - 1]], x, column_distance[x]);
            if (from > begin[count - 1]) break;
            from = 0;
            count--;
        }
        if (from >= width) continue;
        source[count] = x;
        begin[count++] = (int32_t)from;
    }
    if (count == 0) return;
    for (int32_t x = 0, k = 0; x < width; x++) {
        while (k + 1 < count && begin[k + 1] <= x) k++;
        row[x] = (int32_t)MIN(parabola(x, source[k], column_distance[source[k]]), DISTANCE_NONE - 1);
    }
}

static void along_rows(void *shared, int32_t band)
{
    const distance_job *job = shared;
    int32_t width = job->a->width_px, y0, y1;
    int32_t *scratch = job->scratch + (int64_t)band * 3 * width;
    band_of(band, job->rows, &y0, &y1);
    for (int32_t y = y0; y < y1; y++)
        along_row(job->squared + (int64_t)y * width, width, scratch, scratch + width,
                  scratch + 2 * (int64_t)width);
}

jali_status squared_distances(jali_context *ctx, const jali_bitmap *a, bool white, int32_t first_row,
                              int32_t rows, int32_t *squared)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    distance_job job = {a, white, squared, first_row, rows, NULL};
    if (rows == 0 || a->width_px == 0) return JALI_OK;
    TRY(ARENA(ctx, job.scratch, (int64_t)BANDS * 3 * a->width_px));
    parallel(ctx, BANDS, along_columns, &job);
    parallel(ctx, BANDS, along_rows, &job);
done:
    arena_rewind(ctx, mark);
    return status;
}
