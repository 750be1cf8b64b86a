// Tiles of one metric each, from a chart's knots.
//
// Method:  the metric between knots is interpolated, taken at a tile's centre, and its logarithm rounded:
//          places that differ by less than 1.6 % in length are one kind. Tiles are as small as it takes for
//          the metric to change little within one. What both leave is measured at the tiles' corners (slack),
//          so that widths can be made safe by it; an identity leaves none.
// Checked: tests/test_metric.c.
#include "raster/field.h"
#include "base/base.h"

#include <math.h>

enum { LEAST_TILE_PX = 4, MOST_TILE_PX = 64, MOST_KINDS = 60000 };

static const double FIRST_STEP = 1.0 / 64; // of the logarithm's entries
static const double CHANGE_IN_TILE = 0.04; // of a length, from side to side
static const double MOST_STRETCH = 1000;

// How a bitmap shows the chart's grid.
typedef struct view {
    double left_px, top_px, scale;
} view;

// The logarithm of the stretch, a symmetric matrix (xx, xy, yy): half the metric's logarithm.
typedef struct log_stretch {
    double l[3];
} log_stretch;

// A function of the metric's eigenvalues: the symmetric matrix with the same eigenvectors.
static void of_eigenvalues(const double m[3], double (*function)(double), double out[3])
{
    double mean = (m[0] + m[2]) / 2, half = (m[0] - m[2]) / 2, apart = hypot(half, m[1]);
    double high = function(mean + apart), low = function(mean - apart);
    double cos2 = apart > 0 ? half / apart : 1, sin2 = apart > 0 ? m[1] / apart : 0;
    out[0] = (high + low) / 2 + (high - low) / 2 * cos2;
    out[1] = (high - low) / 2 * sin2;
    out[2] = (high + low) / 2 - (high - low) / 2 * cos2;
}

static double half_log(double x)
{
    return log(x) / 2;
}

static double double_exp(double x)
{
    return exp(2 * x);
}

// The largest share by which a length differs between the two.
static double norm_of_difference(const log_stretch *a, const log_stretch *b)
{
    double xx = a->l[0] - b->l[0], xy = a->l[1] - b->l[1], yy = a->l[2] - b->l[2];
    return fabs(xx + yy) / 2 + hypot((xx - yy) / 2, xy);
}

static jali_status check_knot(jali_context *ctx, const jali_chart *chart, int64_t knot)
{
    const float *g = chart->metric[knot];
    double mean = ((double)g[0] + g[2]) / 2, apart = hypot(((double)g[0] - g[2]) / 2, g[1]);
    double most = MOST_STRETCH * MOST_STRETCH;
    if (mean - apart >= 1 / most && mean + apart <= most) return JALI_OK;
    return fail(ctx, JALI_BAD_VALUE,
                "the metric at knot (%d, %d) is (%g, %g, %g): lengths stretched %g to %g times are accepted",
                (int32_t)(knot % chart->metric_columns), (int32_t)(knot / chart->metric_columns),
                (double)g[0], (double)g[1], (double)g[2], 1 / MOST_STRETCH, MOST_STRETCH);
}

double most_stretch_of(const jali_chart *chart)
{
    double most = 1;
    int64_t knots = chart && chart->metric ? (int64_t)chart->metric_columns * chart->metric_rows : 0;
    for (int64_t i = 0; i < knots; i++) {
        const float *g = chart->metric[i];
        most = fmax(most, ((double)g[0] + g[2]) / 2 + hypot(((double)g[0] - g[2]) / 2, g[1]));
    }
    return sqrt(most);
}

// The metric at a place in the chart's pixels, between the centres of the four nearest knots' cells.
static void metric_between(const jali_chart *chart, double x, double y, double g[3])
{
    double u = fmin(fmax(x / chart->metric_step_px - 0.5, 0), chart->metric_columns - 1);
    double v = fmin(fmax(y / chart->metric_step_px - 0.5, 0), chart->metric_rows - 1);
    int32_t i = MIN((int32_t)u, MAX(chart->metric_columns - 2, 0)),
            j = MIN((int32_t)v, MAX(chart->metric_rows - 2, 0));
    int64_t right = chart->metric_columns > 1, down = chart->metric_rows > 1 ? chart->metric_columns : 0;
    const float(*at)[3] = (const float(*)[3])chart->metric + (int64_t)j * chart->metric_columns + i;
    for (int32_t k = 0; k < 3; k++) {
        double upper = at[0][k] + (u - i) * (at[right][k] - at[0][k]);
        double lower = at[down][k] + (u - i) * (at[down + right][k] - at[down][k]);
        g[k] = upper + (v - j) * (lower - upper);
    }
}

// The largest share by which lengths change from one of the chart's pixels to the next.
static jali_status steepest(jali_context *ctx, const jali_chart *chart, double *change)
{
    jali_status status = JALI_OK;
    *change = 0;
    for (int32_t j = 0; j < chart->metric_rows; j++)
        for (int32_t i = 0; i < chart->metric_columns; i++) {
            int64_t knot = (int64_t)j * chart->metric_columns + i;
            log_stretch here, before;
            double g[3];
            TRY(check_knot(ctx, chart, knot));
            for (int32_t k = 0; k < 3; k++) g[k] = chart->metric[knot][k];
            of_eigenvalues(g, half_log, here.l);
            for (int32_t way = 0; way < 2; way++) {
                if (way ? j == 0 : i == 0) continue;
                for (int32_t k = 0; k < 3; k++)
                    g[k] = chart->metric[knot - (way ? chart->metric_columns : 1)][k];
                of_eigenvalues(g, half_log, before.l);
                *change = fmax(*change, norm_of_difference(&here, &before) / chart->metric_step_px);
            }
        }
done:
    return status;
}

// --- Kinds: a hash table from rounded logarithms to their numbers

typedef struct kind_table {
    int32_t slots;         // a power of two
    int32_t *slot;         // [slots], kind + 1; 0 = free
    int32_t (*rounded)[3]; // [MOST_KINDS]
    double *slack;         // [MOST_KINDS]
} kind_table;

// The number of a rounded logarithm, a new one if need be; -1 when there are too many.
static int32_t kind_of(kind_table *table, tiling *t, const int32_t rounded[3])
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (int32_t k = 0; k < 3; k++) hash = (hash ^ (uint32_t)rounded[k]) * UINT64_C(1099511628211);
    int32_t at = (int32_t)((hash ^ hash >> 32) & (uint64_t)(table->slots - 1));
    for (; table->slot[at]; at = (at + 1) & (table->slots - 1))
        if (memcmp(table->rounded[table->slot[at] - 1], rounded, 3 * sizeof *rounded) == 0)
            return table->slot[at] - 1;
    if (t->kinds == MOST_KINDS) return -1;
    memcpy(table->rounded[t->kinds], rounded, 3 * sizeof *rounded);
    table->slot[at] = ++t->kinds;
    return t->kinds - 1;
}

// The logarithm at a place of the bitmap.
static log_stretch logarithm_at(const jali_chart *chart, const view *v, double x, double y)
{
    double g[3];
    log_stretch l;
    metric_between(chart, (x - v->left_px) / v->scale, (y - v->top_px) / v->scale, g);
    of_eigenvalues(g, half_log, l.l);
    return l;
}

// Give each tile its kind, logarithms rounded to multiples of `step`; what a kind's tiles differ from it at
// their corners is its slack. False when there are too many kinds.
//   in   corner   scratch [2][columns + 1]: of the corners above and below a row of tiles
static bool sort_tiles(const jali_chart *chart, const view *v, double step, kind_table *table,
                       log_stretch *corner, tiling *t)
{
    int32_t n = t->columns + 1;
    memset(table->slot, 0, (size_t)table->slots * sizeof *table->slot);
    memset(table->slack, 0, MOST_KINDS * sizeof *table->slack);
    t->kinds = 0;
    for (int32_t i = 0; i < n; i++) corner[i] = logarithm_at(chart, v, i * t->tile_px, 0);
    for (int32_t j = 0; j < t->rows; j++) {
        log_stretch *above = corner + (j % 2) * n, *below = corner + (1 - j % 2) * n;
        for (int32_t i = 0; i < n; i++)
            below[i] = logarithm_at(chart, v, i * t->tile_px, (j + 1) * t->tile_px);
        for (int32_t i = 0; i < t->columns; i++) {
            log_stretch centre = logarithm_at(chart, v, (i + 0.5) * t->tile_px, (j + 0.5) * t->tile_px), kept;
            int32_t rounded[3];
            for (int32_t k = 0; k < 3; k++) {
                rounded[k] = (int32_t)floor(centre.l[k] / step + 0.5);
                kept.l[k] = rounded[k] * step;
            }
            int32_t kind = kind_of(table, t, rounded);
            if (kind < 0) return false;
            t->kind[(int64_t)j * t->columns + i] = (uint16_t)kind;
            double *slack = &table->slack[kind];
            for (int32_t k = 0; k < 2; k++)
                *slack = fmax(*slack, fmax(norm_of_difference(&above[i + k], &kept),
                                           norm_of_difference(&below[i + k], &kept)));
        }
    }
    return true;
}

static jali_status note_kinds(jali_context *ctx, const kind_table *table, double step, tiling *t)
{
    jali_status status;
    TRY(ALLOCATE(ctx, t->metric, t->kinds));
    TRY(ALLOCATE(ctx, t->slack, t->kinds));
    for (int32_t kind = 0; kind < t->kinds; kind++) {
        double l[3];
        for (int32_t k = 0; k < 3; k++) l[k] = table->rounded[kind][k] * step;
        of_eigenvalues(l, double_exp, t->metric[kind]);
        t->slack[kind] = table->slack[kind];
        t->most_stretch = fmax(t->most_stretch, exp((l[0] + l[2]) / 2 + hypot((l[0] - l[2]) / 2, l[1])));
    }
done:
    return status;
}

jali_status tiling_create(jali_context *ctx, const jali_chart *chart, int32_t width_px, int32_t height_px,
                          double left_px, double top_px, double scale, tiling *t)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    kind_table table = {.slots = 1 << 17};
    log_stretch *corner;
    view v = {left_px, top_px, scale};
    double change, step_size = FIRST_STEP;
    *t = (tiling){.width_px = width_px, .height_px = height_px, .most_stretch = 1};
    if (!chart || !chart->metric) return JALI_OK;
    if (chart->metric_columns < 1 || chart->metric_rows < 1 || chart->metric_step_px < 1)
        return fail(ctx, JALI_BAD_VALUE,
                    "a metric of %d x %d knots every %d px; at least one of each is accepted",
                    chart->metric_columns, chart->metric_rows, chart->metric_step_px);
    TRY(steepest(ctx, chart, &change));
    t->tile_px = MOST_TILE_PX;
    while (t->tile_px > LEAST_TILE_PX && change / scale * t->tile_px > CHANGE_IN_TILE) t->tile_px /= 2;
    t->columns = (width_px + t->tile_px - 1) / t->tile_px;
    t->rows = (height_px + t->tile_px - 1) / t->tile_px;
    TRY(ALLOCATE(ctx, t->kind, (int64_t)t->columns * t->rows));
    TRY(ARENA(ctx, table.slot, table.slots));
    TRY(ARENA(ctx, table.rounded, MOST_KINDS));
    TRY(ARENA(ctx, table.slack, MOST_KINDS));
    TRY(ARENA(ctx, corner, 2 * ((int64_t)t->columns + 1)));
    while (!sort_tiles(chart, &v, step_size, &table, corner, t)) step_size *= 2;
    TRY(note_kinds(ctx, &table, step_size, t));
done:
    if (status != JALI_OK) tiling_free(ctx, t);
    arena_rewind(ctx, mark);
    return status;
}

void tiling_free(jali_context *ctx, tiling *t)
{
    release(ctx, t->kind);
    release(ctx, t->metric);
    release(ctx, t->slack);
    *t = (tiling){0};
}

bool is_flat(const tiling *t)
{
    return t->kind == NULL;
}

const double *metric_at(const tiling *t, int32_t x, int32_t y)
{
    static const double identity[3] = {1, 0, 1};
    if (is_flat(t)) return identity;
    int32_t i = MIN(MAX(x, 0) / t->tile_px, t->columns - 1), j = MIN(MAX(y, 0) / t->tile_px, t->rows - 1);
    return t->metric[t->kind[(int64_t)j * t->columns + i]];
}
