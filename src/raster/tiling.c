// Tiles of one metric each, from a chart's knots.
//
// Method:  the logarithm of the metric is interpolated between the knots, taken at a tile's centre and
//          rounded: places that differ by less than 1.6 % in length are one kind. Tiles are so small that
//          lengths change little within nearly all of them. What both leave is measured at each tile's
//          corners (slack) and sorts tiles into kinds as well, so that widths can be made safe by it, and
//          are made no safer elsewhere. An identity leaves none.
// Source:  log-Euclidean means: Arsigny, Fillard, Pennec, Ayache, "Log-Euclidean metrics for fast and
//          simple calculus on diffusion tensors", 2006.
// Checked: tests/test_metric.c.
#include "raster/field.h"
#include "base/base.h"

#include <math.h>

enum { LEAST_TILE_PX = 4, MOST_TILE_PX = 64, MOST_KINDS = 60000 };

static const double FIRST_STEP = 1.0 / 64;  // of the logarithm's entries
static const double SLACK_STEP = 1.0 / 128; // kinds with slack are told apart by so much
static const double CHANGE_IN_TILE = 0.06;  // of a length, from side to side ...
static const double SHARE_ABOVE =
    0.02; // ... but for so many of the knots: edges between flat faces are sharp
static const double MOST_STRETCH = 1000;

// The logarithm of the stretch, a symmetric matrix (xx, xy, yy): half the metric's logarithm.
typedef struct log_stretch {
    double l[3];
} log_stretch;

// A function of the metric's eigenvalues: the symmetric matrix with the same eigenvectors.
static void of_eigenvalues(const double m[3], double (*function)(double), double out[3])
{
    double mean = (m[0] + m[2]) / 2, half = (m[0] - m[2]) / 2, apart = sqrt(half * half + m[1] * m[1]);
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

// The squared stretches in the most and the least stretched direction.
static void squared_stretches(const float g[3], double squared[2])
{
    double mean = ((double)g[0] + g[2]) / 2, half = ((double)g[0] - g[2]) / 2;
    double apart = sqrt(half * half + (double)g[1] * g[1]);
    squared[0] = mean + apart;
    squared[1] = mean - apart;
}

// The largest share by which a length differs between the two.
static double norm_of_difference(const log_stretch *a, const log_stretch *b)
{
    double xx = a->l[0] - b->l[0], xy = a->l[1] - b->l[1], yy = a->l[2] - b->l[2];
    return fabs(xx + yy) / 2 + sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
}

double most_stretch_of(const jali_chart *chart)
{
    double most = 1, squared[2];
    int64_t knots = chart && chart->metric ? (int64_t)chart->metric_columns * chart->metric_rows : 0;
    for (int64_t i = 0; i < knots; i++) {
        squared_stretches(chart->metric[i], squared);
        most = MAX(most, squared[0]);
    }
    return sqrt(most);
}

// --- Knots

// A chart's knots, as a bitmap shows them.
typedef struct view {
    const jali_chart *chart;
    double left_px, top_px, scale;
    int32_t columns, rows;
    log_stretch *knot; // [rows * columns]
} view;

static jali_status take_logarithms(jali_context *ctx, view *v)
{
    const jali_chart *chart = v->chart;
    const double most = MOST_STRETCH * MOST_STRETCH;
    for (int32_t i = 0; i < v->columns * v->rows; i++) {
        const float *g = chart->metric[i];
        double squared[2];
        squared_stretches(g, squared);
        if (!(squared[1] >= 1 / most && squared[0] <= most))
            return fail(
                ctx, JALI_BAD_VALUE,
                "the metric at knot (%d, %d) is (%g, %g, %g): lengths stretched %g to %g times are accepted",
                i % v->columns, i / v->columns, (double)g[0], (double)g[1], (double)g[2], 1 / MOST_STRETCH,
                MOST_STRETCH);
        of_eigenvalues((double[3]){g[0], g[1], g[2]}, half_log, v->knot[i].l);
    }
    return JALI_OK;
}

// The logarithm at a place of the bitmap, between the centres of the four nearest knots' squares.
static log_stretch logarithm_at(const view *v, double x, double y)
{
    double u = (x - v->left_px) / v->scale / v->chart->metric_step_px - 0.5;
    double w = (y - v->top_px) / v->scale / v->chart->metric_step_px - 0.5;
    u = MIN(MAX(u, 0), v->columns - 1);
    w = MIN(MAX(w, 0), v->rows - 1);
    int32_t i = MIN((int32_t)u, MAX(v->columns - 2, 0)), j = MIN((int32_t)w, MAX(v->rows - 2, 0));
    const log_stretch *upper = v->knot + j * v->columns + i, *lower = upper + (v->rows > 1 ? v->columns : 0);
    int32_t right = v->columns > 1;
    log_stretch between;
    for (int32_t k = 0; k < 3; k++) {
        double above = upper->l[k] + (u - i) * (upper[right].l[k] - upper->l[k]);
        double below = lower->l[k] + (u - i) * (lower[right].l[k] - lower->l[k]);
        between.l[k] = above + (w - j) * (below - above);
    }
    return between;
}

// The largest tiles in which lengths change little, but for a small share of the places.
static int32_t choose_tile(const view *v)
{
    int64_t pairs = 0, above[8] = {0}; // knots between which tiles of MOST_TILE_PX >> i change too much
    double per_px = 1 / (v->chart->metric_step_px * v->scale);
    for (int32_t j = 0; j < v->rows; j++)
        for (int32_t i = 0; i < v->columns; i++)
            for (int32_t way = 0; way < 2; way++) {
                if (way ? j == 0 : i == 0) continue;
                const log_stretch *here = v->knot + j * v->columns + i;
                double change = per_px * norm_of_difference(here, here - (way ? v->columns : 1));
                for (int32_t k = 0; change * (MOST_TILE_PX >> k) > CHANGE_IN_TILE && k < 8; k++) above[k]++;
                pairs++;
            }
    int32_t k = 0;
    while (MOST_TILE_PX >> k > LEAST_TILE_PX && (double)above[k] > SHARE_ABOVE * (double)pairs) k++;
    return MOST_TILE_PX >> k;
}

// --- Kinds: a hash table from rounded logarithms and slacks to their numbers

typedef struct kind_key {
    int32_t l[3], slack;
} kind_key;

typedef struct kind_table {
    int32_t slots; // a power of two
    int32_t *slot; // [slots], kind + 1; 0 = free
    kind_key *key; // [MOST_KINDS]
    double *slack; // [MOST_KINDS]
} kind_table;

// The number of a key, a new one if need be; -1 when there are too many.
static int32_t kind_of(kind_table *table, tiling *t, const kind_key *key)
{
    uint64_t hash = UINT64_C(14695981039346656037) ^ (uint32_t)key->slack;
    for (int32_t k = 0; k < 3; k++) hash = (hash ^ (uint32_t)key->l[k]) * UINT64_C(1099511628211);
    int32_t at = (int32_t)((hash ^ hash >> 32) & (uint64_t)(table->slots - 1));
    for (; table->slot[at]; at = (at + 1) & (table->slots - 1))
        if (memcmp(&table->key[table->slot[at] - 1], key, sizeof *key) == 0) return table->slot[at] - 1;
    if (t->kinds == MOST_KINDS) return -1;
    table->key[t->kinds] = *key;
    table->slack[t->kinds] = 0;
    table->slot[at] = ++t->kinds;
    return t->kinds - 1;
}

// Give each tile its kind, logarithms rounded to multiples of `step`. False when there are too many kinds.
//   in   corner   scratch [2][columns + 1]: of the corners above and below a row of tiles
static bool sort_tiles(const view *v, double step, kind_table *table, log_stretch *corner, tiling *t)
{
    int32_t n = t->columns + 1, px = t->tile_px;
    memset(table->slot, 0, (size_t)table->slots * sizeof *table->slot);
    t->kinds = 0;
    for (int32_t i = 0; i < n; i++) corner[i] = logarithm_at(v, i * px, 0);
    for (int32_t j = 0; j < t->rows; j++) {
        log_stretch *above = corner + (j % 2) * n, *below = corner + (1 - j % 2) * n;
        for (int32_t i = 0; i < n; i++) below[i] = logarithm_at(v, i * px, (j + 1) * px);
        for (int32_t i = 0; i < t->columns; i++) {
            log_stretch centre = logarithm_at(v, (i + 0.5) * px, (j + 0.5) * px), kept;
            double slack = 0;
            kind_key key;
            for (int32_t k = 0; k < 3; k++) {
                key.l[k] = (int32_t)floor(centre.l[k] / step + 0.5);
                kept.l[k] = key.l[k] * step;
            }
            for (int32_t k = 0; k < 2; k++) {
                slack = MAX(slack, norm_of_difference(&above[i + k], &kept));
                slack = MAX(slack, norm_of_difference(&below[i + k], &kept));
            }
            key.slack = (int32_t)(slack / SLACK_STEP);
            int32_t kind = kind_of(table, t, &key);
            if (kind < 0) return false;
            t->kind[(int64_t)j * t->columns + i] = (uint16_t)kind;
            table->slack[kind] = MAX(table->slack[kind], slack);
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
        for (int32_t k = 0; k < 3; k++) l[k] = table->key[kind].l[k] * step;
        of_eigenvalues(l, double_exp, t->metric[kind]);
        t->slack[kind] = table->slack[kind];
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
    double step_size = FIRST_STEP;
    *t = (tiling){.width_px = width_px, .height_px = height_px, .most_stretch = most_stretch_of(chart)};
    if (!chart || !chart->metric) return JALI_OK;
    view v = {chart, left_px, top_px, scale, chart->metric_columns, chart->metric_rows, NULL};
    if (v.columns < 1 || v.rows < 1 || chart->metric_step_px < 1 || (int64_t)v.columns * v.rows > INT32_MAX)
        return fail(ctx, JALI_BAD_VALUE,
                    "a metric of %d x %d knots every %d px; at least one of each is accepted", v.columns,
                    v.rows, chart->metric_step_px);
    TRY(ARENA(ctx, v.knot, (int64_t)v.columns * v.rows));
    TRY(take_logarithms(ctx, &v));
    t->tile_px = choose_tile(&v);
    t->columns = (width_px + t->tile_px - 1) / t->tile_px;
    t->rows = (height_px + t->tile_px - 1) / t->tile_px;
    TRY(ALLOCATE(ctx, t->kind, (int64_t)t->columns * t->rows));
    TRY(ARENA(ctx, table.slot, table.slots));
    TRY(ARENA(ctx, table.key, MOST_KINDS));
    TRY(ARENA(ctx, table.slack, MOST_KINDS));
    TRY(ARENA(ctx, corner, 2 * ((int64_t)t->columns + 1)));
    while (!sort_tiles(&v, step_size, &table, corner, t)) step_size *= 2;
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
