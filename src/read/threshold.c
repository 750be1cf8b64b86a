// Which grey is white: a fixed level, Otsu's, or one that follows the light.
//
// Source:  N. Otsu, A threshold selection method from gray-level histograms, 1979; J. Sauvola and
//          M. Pietikainen, Adaptive document image binarization, 2000.
// Differs: Otsu's level is taken halfway between the means of its two parts: the same split, but in the
// middle
//          of an empty stretch of the histogram, where anti-aliased edges belong. Sauvola's result is kept as
//          a distance in grey levels, so that edges keep their place between pixels; and what is darker than
//          a third of Otsu's level stays black, or the dark clothes of a portrait would be hollow.
// Checked: tests/test_read.c.
#include "read/read.h"

#include <math.h>

enum {
    LEVELS = 256,
    MIDDLE = 128,
    BAND_PX = 1 << 20,
    MOST_BANDS = 512,
    SMALLEST_WINDOW = 15,
    MOST_WINDOW = 4001
};

typedef struct histogram {
    uint64_t count[LEVELS];
} histogram;

jali_threshold_options jali_threshold_defaults(void)
{
    return (jali_threshold_options){.method = JALI_THRESHOLD_AUTO, .level = MIDDLE, .contrast = 0.2};
}

// Four tables, so that a run of one level does not wait for its own last count.
static void count_levels(const uint8_t *grey, int64_t size, histogram *h)
{
    uint32_t part[4][LEVELS] = {0};
    int64_t i = 0;
    for (; i + 4 <= size; i += 4)
        for (int32_t k = 0; k < 4; k++) part[k][grey[i + k]]++;
    for (; i < size; i++) part[0][grey[i]]++;
    for (int32_t v = 0; v < LEVELS; v++)
        h->count[v] = (uint64_t)part[0][v] + part[1][v] + part[2][v] + part[3][v];
}

typedef struct counting {
    const jali_picture *picture;
    histogram *band; // [bands]
    int64_t band_px;
} counting;

static void count_band(void *shared, int32_t index)
{
    counting *job = shared;
    int64_t size = (int64_t)job->picture->width_px * job->picture->height_px, first = index * job->band_px;
    count_levels(job->picture->grey + first, MIN(job->band_px, size - first), &job->band[index]);
}

static jali_status count_picture(jali_context *ctx, const jali_picture *picture, histogram *total)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int64_t size = (int64_t)picture->width_px * picture->height_px;
    counting job = {picture, NULL, MAX(BAND_PX, (size + MOST_BANDS - 1) / MOST_BANDS)};
    int32_t bands = (int32_t)((size + job.band_px - 1) / job.band_px);
    *total = (histogram){0};
    TRY(ARENA(ctx, job.band, bands));
    parallel(ctx, bands, count_band, &job);
    for (int32_t b = 0; b < bands; b++)
        for (int32_t v = 0; v < LEVELS; v++) total->count[v] += job.band[b].count[v];
done:
    arena_rewind(ctx, mark);
    return status;
}

// The split with the largest variance between its parts, then the level halfway between their means.
static int32_t otsu(const histogram *h)
{
    double all = 0, all_sum = 0, count = 0, sum = 0, best = -1, level = MIDDLE;
    for (int32_t v = 0; v < LEVELS; v++) {
        all += (double)h->count[v];
        all_sum += (double)h->count[v] * v;
    }
    for (int32_t v = 0; v < LEVELS - 1; v++) {
        count += (double)h->count[v];
        sum += (double)h->count[v] * v;
        if (count == 0 || count == all) continue;
        double dark = sum / count, light = (all_sum - sum) / (all - count);
        double variance = count * (all - count) * (light - dark) * (light - dark);
        if (variance > best) {
            best = variance;
            level = ceil((dark + light) / 2);
        }
    }
    return (int32_t)level;
}

static jali_status check_two_tones(jali_context *ctx, const histogram *h, int32_t level)
{
    int32_t darkest = 0, lightest = LEVELS - 1;
    while (darkest < lightest && h->count[darkest] == 0) darkest++;
    while (lightest > darkest && h->count[lightest] == 0) lightest--;
    if (darkest == lightest)
        return fail(ctx, JALI_BAD_INPUT, "the picture is all %s: every pixel has grey level %d",
                    darkest >= MIDDLE ? "white" : "black", darkest);
    if (level > darkest && level <= lightest) return JALI_OK;
    return fail(ctx, JALI_BAD_INPUT,
                "the picture is all %s at threshold %d; at %d .. %d it would show something",
                level <= darkest ? "white" : "black", level, darkest + 1, lightest);
}

// Sums over the window around each pixel of a row come from the sums of its columns; the columns lose their
// top row and win a bottom row from one row to the next.
typedef struct local_job {
    const jali_picture *from;
    uint8_t *to;
    uint32_t *column_sum, *column_square; // [bands * width]
    int32_t radius, rows_a_band;
    double contrast, darkest; // below darkest a pixel is black whatever is around it
} local_job;

static void add_row(const uint8_t *grey, int32_t width, uint32_t sign, uint32_t *sum, uint32_t *square)
{
    for (int32_t x = 0; x < width; x++) {
        sum[x] += sign * grey[x];
        square[x] += sign * grey[x] * grey[x];
    }
}

static uint8_t distance_from_local(const local_job *job, uint8_t grey, double count, double sum,
                                   double square)
{
    double mean = sum / count, variance = square / count - mean * mean;
    double deviation = variance > 0 ? sqrt(variance) : 0;
    double level = MAX(mean * (1 + job->contrast * (deviation / MIDDLE - 1)), job->darkest);
    double distance = floor(MIDDLE + grey - level);
    return (uint8_t)(distance < 0 ? 0 : distance > 255 ? 255 : distance);
}

static void local_row(const local_job *job, const uint32_t *column_sum, const uint32_t *column_square,
                      int32_t rows, const uint8_t *grey, uint8_t *to)
{
    int32_t width = job->from->width_px, radius = job->radius;
    uint64_t sum = 0, square = 0;
    for (int32_t x = 0; x < MIN(radius, width); x++) sum += column_sum[x], square += column_square[x];
    for (int32_t x = 0; x < width; x++) {
        if (x + radius < width) sum += column_sum[x + radius], square += column_square[x + radius];
        if (x > radius) sum -= column_sum[x - radius - 1], square -= column_square[x - radius - 1];
        double count = (double)rows * (MIN(x + radius, width - 1) - MAX(x - radius, 0) + 1);
        to[x] = distance_from_local(job, grey[x], count, (double)sum, (double)square);
    }
}

static void local_band(void *shared, int32_t index)
{
    local_job *job = shared;
    int64_t width = job->from->width_px;
    int32_t height = job->from->height_px, radius = job->radius;
    const uint8_t *grey = job->from->grey;
    uint32_t *sum = job->column_sum + index * width, *square = job->column_square + index * width;
    int32_t first = index * job->rows_a_band, last = MIN(first + job->rows_a_band, height);
    memset(sum, 0, (size_t)width * sizeof *sum);
    memset(square, 0, (size_t)width * sizeof *square);
    for (int64_t y = MAX(first - radius, 0); y < MIN(first + radius, height); y++)
        add_row(grey + y * width, (int32_t)width, 1, sum, square);
    for (int64_t y = first; y < last; y++) {
        if (y + radius < height) add_row(grey + (y + radius) * width, (int32_t)width, 1, sum, square);
        if (y - radius - 1 >= MAX(first - radius, 0))
            add_row(grey + (y - radius - 1) * width, (int32_t)width, UINT32_MAX, sum, square);
        int32_t rows = (int32_t)(MIN(y + radius, height - 1) - MAX(y - radius, 0) + 1);
        local_row(job, sum, square, rows, grey + y * width, job->to + y * width);
    }
}

static jali_status local(jali_context *ctx, jali_picture *picture, const jali_threshold_options *opt,
                         int32_t otsu_level)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int64_t width = picture->width_px, height = picture->height_px;
    int32_t window = opt->window_px ? opt->window_px : (int32_t)MAX(MIN(width, height) / 16, SMALLEST_WINDOW);
    local_job job = {.from = picture, .radius = MIN(window, MOST_WINDOW) / 2, .contrast = opt->contrast};
    job.darkest = otsu_level / 3.0;
    job.rows_a_band = MAX(4 * job.radius, 64);
    int32_t bands = (int32_t)((height + job.rows_a_band - 1) / job.rows_a_band);
    TRY(ARENA(ctx, job.column_sum, bands * width));
    TRY(ARENA(ctx, job.column_square, bands * width));
    TRY(ALLOCATE(ctx, job.to, width * height));
    parallel(ctx, bands, local_band, &job);
    release(ctx, picture->grey);
    picture->grey = job.to;
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_count_levels(jali_context *ctx, const jali_picture *picture, jali_levels *levels)
{
    histogram h;
    int32_t used = 0;
    *levels = (jali_levels){0};
    jali_status status = count_picture(ctx, picture, &h);
    if (status != JALI_OK) return status;
    memcpy(levels->count, h.count, sizeof h.count);
    for (int32_t v = 0; v < LEVELS; v++) used += h.count[v] > 0;
    levels->automatic = used > 1 ? otsu(&h) : 0;
    return JALI_OK;
}

static jali_status check_options(jali_context *ctx, const jali_threshold_options *opt)
{
    if (opt->method == JALI_THRESHOLD_FIXED && (opt->level < 0 || opt->level > 255))
        return fail(ctx, JALI_BAD_VALUE, "the threshold must be 0 .. 255, not %d", opt->level);
    if (opt->method == JALI_THRESHOLD_LOCAL && opt->window_px != 0 &&
        (opt->window_px < 3 || opt->window_px > MOST_WINDOW))
        return fail(ctx, JALI_BAD_VALUE, "the threshold's window must be 3 .. %d px, not %d", MOST_WINDOW,
                    opt->window_px);
    if (opt->method == JALI_THRESHOLD_LOCAL && !(opt->contrast >= 0 && opt->contrast <= 1))
        return fail(ctx, JALI_BAD_VALUE, "the threshold's contrast must be 0 .. 1, not %g", opt->contrast);
    return JALI_OK;
}

jali_status jali_threshold(jali_context *ctx, jali_picture *picture, const jali_threshold_options *given,
                           int32_t *threshold)
{
    jali_status status;
    jali_threshold_options opt = given ? *given : jali_threshold_defaults();
    histogram levels;
    *threshold = MIDDLE;
    TRY(check_options(ctx, &opt));
    TRY(count_picture(ctx, picture, &levels));
    if (opt.method == JALI_THRESHOLD_LOCAL) {
        TRY(local(ctx, picture, &opt, otsu(&levels)));
        TRY(count_picture(ctx, picture, &levels));
    }
    if (opt.method == JALI_THRESHOLD_FIXED) *threshold = opt.level;
    if (opt.method == JALI_THRESHOLD_AUTO) *threshold = otsu(&levels);
    TRY(check_two_tones(ctx, &levels, *threshold));
    status = step(ctx, "threshold", 1);
done:
    return status;
}
