// Which connectors are worth their pixels.
//
// A connector with deformations B u and stiffnesses S changes the displacements by -K^-1 B^T (S^-1 + B K^-1
// B^T)^-1 B u, so a stress with the gradient c by -(B a)^T (S^-1 + F)^-1 (B u), where a = K^-1 c comes from
// one solution a hot spot and F = B K^-1 B^T from the inverse's entries at the connector's ends: exact, and
// nothing is solved for a connector. What one connector does to the others' B u, B a and F is the same
// formula once more. Candidates come through the sieve. Checked: tests/test_reinforce.c: against a new
// factor.
#include "reinforce/rank.h"
#include "reinforce/sieve.h"

#include <math.h>
#include <stdlib.h>

/// Connectors laid and candidates; mode j of connector i is row 6 i + j.
typedef struct table {
    int32_t count, laid, rows;
    const beam *beam;  // [count]
    double *f;         // [rows * rows] B K^-1 B^T
    double *moved;     // [rows] B u
    double *influence; // [MOST_HOTSPOTS * rows] B a
    double *felt;      // [BEAM_MODES * rows] scratch: what laying one does to each row
    double stress_mpa[MOST_HOTSPOTS];
    int32_t hotspots;
} table;

static void table_free(jali_context *ctx, table *t)
{
    release(ctx, t->f);
    release(ctx, t->moved);
    release(ctx, t->influence);
    release(ctx, t->felt);
}

static int by_number(const void *a, const void *b)
{
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return x < y ? -1 : x > y;
}

static int32_t index_of(const int32_t *sorted, int32_t count, int32_t row)
{
    int32_t low = 0, high = count;
    while (low + 1 < high) {
        int32_t middle = (low + high) / 2;
        if (sorted[middle] <= row)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Every unknown that some beam ends on, ascending, each once.
static int32_t ends_of(const structure *s, const table *t, int32_t *row)
{
    int32_t count = 0, kept = 0;
    for (int32_t i = 0; i < t->count; i++)
        for (int32_t n = 0; n < BEAM_NODES; n++)
            for (int bit = 0; bit < 6; bit++) {
                int32_t r = unknown_at(s, t->beam[i].node[n], bit);
                if (r >= 0) row[count++] = r;
            }
    qsort(row, (size_t)count, sizeof *row, by_number);
    for (int32_t i = 0; i < count; i++)
        if (i == 0 || row[i] != row[i - 1]) row[kept++] = row[i];
    return kept;
}

enum { MOST_WEIGHTS = BEAM_NODES * 6 };

// A beam's mode as a sum over unknowns at its ends.
typedef struct mode_weights {
    int32_t count, at[MOST_WEIGHTS]; // places among the rows
    double weight[MOST_WEIGHTS];
} mode_weights;

static void weigh_mode(const structure *s, const beam *b, int m, const int32_t *row, int32_t row_count,
                       mode_weights *w)
{
    w->count = 0;
    for (int32_t n = 0; n < BEAM_NODES; n++)
        for (int bit = 0; bit < 6; bit++) {
            int32_t r = unknown_at(s, b->node[n], bit);
            if (r < 0 || b->weight[m][n][bit] == 0) continue;
            w->at[w->count] = index_of(row, row_count, r);
            w->weight[w->count++] = b->weight[m][n][bit];
        }
}

typedef struct flexibility_job {
    table *t;
    const mode_weights *mode; // [rows]; none where a beam has fewer modes
    const double *inverse;    // [count * count]
    size_t count;
} flexibility_job;

// A row of F up to the diagonal, and its mirror.
static void fill_row(void *shared, int32_t p)
{
    const flexibility_job *job = shared;
    const mode_weights *mine = &job->mode[p];
    table *t = job->t;
    for (int32_t q = 0; q <= p; q++) {
        const mode_weights *yours = &job->mode[q];
        double sum = 0;
        for (int32_t i = 0; i < mine->count; i++) {
            const double *from = job->inverse + (size_t)mine->at[i] * job->count;
            for (int32_t j = 0; j < yours->count; j++)
                sum += mine->weight[i] * yours->weight[j] * from[yours->at[j]];
        }
        t->f[p * t->rows + q] = t->f[q * t->rows + p] = sum;
    }
}

static jali_status fill_flexibility(jali_context *ctx, structure *s, table *t)
{
    jali_status status;
    int32_t *row = NULL;
    double *inverse = NULL;
    mode_weights *mode = NULL;
    TRY(ALLOCATE(ctx, row, (size_t)t->count * MOST_WEIGHTS));
    int32_t count = ends_of(s, t, row);
    TRY(ALLOCATE(ctx, inverse, (size_t)count * (size_t)count));
    TRY(ALLOCATE_CLEARED(ctx, mode, t->rows));
    TRY(solver_inverse(ctx, s->solver, count, row, count, row, inverse));
    for (int32_t p = 0; p < t->rows; p++) {
        const beam *b = &t->beam[p / BEAM_MODES];
        if (p % BEAM_MODES < b->mode_count) weigh_mode(s, b, p % BEAM_MODES, row, count, &mode[p]);
    }
    parallel(ctx, t->rows, fill_row, &(flexibility_job){t, mode, inverse, (size_t)count});
done:
    release(ctx, row);
    release(ctx, inverse);
    release(ctx, mode);
    return status;
}

// y = (S^-1 + F)^-1 x for one connector: at most six unknowns, symmetric and positive definite.
static void solve_small(const table *t, int32_t i, const double *x, double *y)
{
    int n = t->beam[i].mode_count;
    double l[BEAM_MODES][BEAM_MODES];
    for (int r = 0; r < n; r++)
        for (int c = 0; c <= r; c++) {
            double sum = t->f[(6 * i + r) * t->rows + 6 * i + c];
            if (r == c) sum += 1 / t->beam[i].stiffness[r];
            for (int k = 0; k < c; k++) sum -= l[r][k] * l[c][k];
            l[r][c] = r == c ? sqrt(fmax(sum, 1e-300)) : sum / l[c][c];
        }
    for (int r = 0; r < n; r++) {
        y[r] = x[r];
        for (int k = 0; k < r; k++) y[r] -= l[r][k] * y[k];
        y[r] /= l[r][r];
    }
    for (int r = n - 1; r >= 0; r--) {
        for (int k = r + 1; k < n; k++) y[r] -= l[k][r] * y[k];
        y[r] /= l[r][r];
    }
}

// What a connector would take off a hot spot.
static double relief_of(const table *t, int32_t i, int32_t hotspot)
{
    double y[BEAM_MODES], sum = 0;
    solve_small(t, i, t->moved + 6 * i, y);
    for (int m = 0; m < t->beam[i].mode_count; m++) sum += t->influence[hotspot * t->rows + 6 * i + m] * y[m];
    return sum;
}

// The stress inside a connector itself, at most.
static double own_stress(const table *t, int32_t i)
{
    double y[BEAM_MODES], sum = 0;
    solve_small(t, i, t->moved + 6 * i, y);
    for (int m = 0; m < t->beam[i].mode_count; m++) sum += fabs(y[m]) * t->beam[i].stress[m];
    return sum;
}

// What a connector takes from F outside its own rows and columns.
static void take_from_flexibility(table *t, int32_t i)
{
    int n = t->beam[i].mode_count;
    double y[BEAM_MODES], column[BEAM_MODES];
    for (int32_t q = 0; q < t->rows; q++) {
        for (int m = 0; m < n; m++) column[m] = t->f[(6 * i + m) * t->rows + q];
        solve_small(t, i, column, y);
        for (int m = 0; m < n; m++) t->felt[m * t->rows + q] = q / 6 == i ? 0 : y[m];
    }
    for (int32_t p = 0; p < t->rows; p++) {
        double *row = t->f + p * t->rows;
        if (p / 6 == i) continue;
        memcpy(column, row + 6 * i, sizeof column);
        for (int m = 0; m < n; m++) {
            const double *felt = t->felt + m * t->rows;
            for (int32_t q = 0; column[m] != 0 && q < t->rows; q++) row[q] -= column[m] * felt[q];
        }
    }
}

// Lay a connector: what it does to F, and, unless the displacements know of it already, to them and the
// stresses.
static void lay(table *t, int32_t i, bool known)
{
    int n = t->beam[i].mode_count;
    double y[BEAM_MODES];
    if (!known) {
        for (int32_t h = 0; h < t->hotspots; h++) t->stress_mpa[h] -= relief_of(t, i, h);
        for (int32_t h = 0; h < t->hotspots; h++) {
            double *a = t->influence + h * t->rows;
            solve_small(t, i, a + 6 * i, y);
            for (int32_t p = 0; p < t->rows; p++)
                if (p / 6 != i)
                    for (int m = 0; m < n; m++) a[p] -= t->f[p * t->rows + 6 * i + m] * y[m];
        }
        solve_small(t, i, t->moved + 6 * i, y);
        for (int32_t p = 0; p < t->rows; p++)
            if (p / 6 != i)
                for (int m = 0; m < n; m++) t->moved[p] -= t->f[p * t->rows + 6 * i + m] * y[m];
    }
    take_from_flexibility(t, i);
}

static int32_t highest(const table *t)
{
    int32_t best = 0;
    for (int32_t h = 1; h < t->hotspots; h++)
        if (t->stress_mpa[h] > t->stress_mpa[best]) best = h;
    return best;
}

// Would it be about as bad itself as the highest hot spot is now, or push another one well above that? (A
// little more is let pass: the next connector of the round sees to that one.)
static bool harms(const table *t, int32_t i, int32_t hot)
{
    const double a_little = 1.1;
    if (own_stress(t, i) > 0.9 * t->stress_mpa[hot]) return true;
    for (int32_t h = 0; h < t->hotspots; h++)
        if (h != hot && t->stress_mpa[h] - relief_of(t, i, h) > a_little * t->stress_mpa[hot]) return true;
    return false;
}

// The connector that takes most off the highest hot spot a pixel, of those that take off at least a quarter
// of what the best does; -1 when that is less than 1 %.
static int32_t best_connector(const table *t, const span *candidate, const uint8_t *out,
                              const rank_options *opt)
{
    int32_t hot = highest(t), best = -1;
    double most = 0, worth = 0;
    for (int32_t i = t->laid; i < t->count; i++)
        if (!out[i] && !harms(t, i, hot)) most = fmax(most, relief_of(t, i, hot));
    if (most < 0.01 * t->stress_mpa[hot]) return -1;
    for (int32_t i = t->laid; i < t->count; i++) {
        if (out[i] || harms(t, i, hot)) continue;
        double relief = relief_of(t, i, hot), a_pixel = relief / visible_pixels(&candidate[i - t->laid], opt);
        if (relief < 0.25 * most || a_pixel <= worth) continue;
        worth = a_pixel;
        best = i;
    }
    return best;
}

static void choose(const jali_sheet *sheet, table *t, const span *candidate, uint8_t *out,
                   const rank_options *opt, span *chosen, int32_t *count)
{
    for (int32_t i = 0; i < t->laid; i++) lay(t, i, true);
    while (*count < opt->most && t->stress_mpa[highest(t)] > opt->limit_mpa) {
        int32_t best = best_connector(t, candidate, out, opt);
        if (best < 0) break;
        lay(t, best, false);
        const span *s = &candidate[best - t->laid];
        chosen[(*count)++] = *s;
        for (int32_t i = t->laid; i < t->count; i++)
            if (spans_apart(sheet, s, &candidate[i - t->laid]) <
                (s->width_mm + candidate[i - t->laid].width_mm) / 2 + opt->apart_mm)
                out[i] = 1;
    }
}

jali_status rank_spans(jali_context *ctx, structure *s, const jali_sheet *sheet, const borders *loops,
                       const spans *all, const beam *laid, int32_t laid_count, const jali_material *material,
                       const outlook *now, const rank_options *opt, span *chosen, int32_t *count)
{
    jali_status status;
    int32_t sieved;
    span candidate[SIEVED];
    table t = {.laid = laid_count, .hotspots = now->hotspot_count};
    beam *beams = NULL;
    uint8_t *out = NULL;
    *count = 0;
    if (now->hotspot_count == 0) return JALI_OK;
    TRY(sieve_spans(ctx, sheet, loops, all, material, s->bending_only, now, opt, candidate, &sieved));
    t.count = laid_count + sieved;
    t.rows = BEAM_MODES * t.count;
    if (sieved == 0) goto done;
    TRY(ALLOCATE(ctx, beams, t.count));
    TRY(ALLOCATE_CLEARED(ctx, out, t.count));
    TRY(ALLOCATE_CLEARED(ctx, t.f, (size_t)t.rows * (size_t)t.rows));
    TRY(ALLOCATE_CLEARED(ctx, t.moved, t.rows));
    TRY(ALLOCATE_CLEARED(ctx, t.influence, (size_t)MOST_HOTSPOTS * (size_t)t.rows));
    TRY(ALLOCATE(ctx, t.felt, BEAM_MODES * (size_t)t.rows));
    t.beam = beams;
    for (int32_t i = 0; i < t.count; i++) {
        if (i < laid_count)
            beams[i] = laid[i];
        else
            beam_along(sheet, loops, &candidate[i - laid_count], material, s->bending_only, &beams[i]);
        beam_deformation(&beams[i], now->u, t.moved + BEAM_MODES * i);
        for (int32_t h = 0; h < t.hotspots; h++)
            beam_deformation(&beams[i], now->adjoint[h], t.influence + h * t.rows + BEAM_MODES * i);
    }
    memcpy(t.stress_mpa, now->stress_mpa, sizeof t.stress_mpa);
    TRY(fill_flexibility(ctx, s, &t));
    choose(sheet, &t, candidate, out, opt, chosen, count);
done:
    release(ctx, beams);
    release(ctx, out);
    table_free(ctx, &t);
    return status;
}
