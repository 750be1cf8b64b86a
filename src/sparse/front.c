// Dense work on one front.
//
// Large fronts are cut into tiles by their own size, never by the number of threads, so that every sum has
// one order.
//
// Limits:  BLAS must be asked for one thread and must be safe to call from several (OpenBLAS is).
// Checked: tests/test_solver.c.
#include "sparse/front.h"

#include "sparse/blas.h"

enum { TILE = 256 };

static const double ONE = 1, MINUS = -1, NONE = 0;

typedef struct tiling {
    const front *f;
    int32_t from, width; // the pivots that are being taken away
    int32_t ending;      // columns of the panel end here
    double beta;
} tiling;

static void run(jali_context *ctx, int32_t count, void (*work)(void *, int32_t), void *shared)
{
    if (ctx) {
        parallel(ctx, count, work, shared);
    } else {
        for (int32_t i = 0; i < count; i++) work(shared, i);
    }
}

static double *at(const front *f, int32_t row, int32_t column)
{
    return f->panel + (size_t)column * (size_t)(f->pivots + f->height) + row;
}

// L21 = A21 L11^-T, a tile of rows.
static void solve_rows(void *shared, int32_t index)
{
    const tiling *t = shared;
    int lead = t->f->pivots + t->f->height, first = t->from + t->width + index * TILE;
    int rows = MIN(TILE, lead - first);
    dtrsm_("R", "L", "T", "N", &rows, &t->width, &ONE, at(t->f, t->from, t->from), &lead,
           at(t->f, first, t->from), &lead);
}

// C = beta C - A B^T for a tile of the lower half; on the diagonal only its lower half.
static void take_away(int rows, int columns, int inner, const double *a, const double *b, int lead,
                      double beta, double *c, int lead_c)
{
    if (a == b)
        dsyrk_("L", "N", &columns, &inner, &MINUS, a, &lead, &beta, c, &lead_c);
    else
        dgemm_("N", "T", &rows, &columns, &inner, &MINUS, a, &lead, b, &lead, &beta, c, &lead_c);
}

// Columns of the panel right of the pivots: a tile of columns, with the rows below.
static void update_panel(void *shared, int32_t index)
{
    const tiling *t = shared;
    const front *f = t->f;
    int lead = f->pivots + f->height, column = t->from + t->width + index * TILE;
    int columns = MIN(TILE, f->pivots - column), below = column + columns, rows = lead - below;
    const double *a = at(f, column, t->from);
    take_away(columns, columns, t->width, a, a, lead, 1, at(f, column, column), lead);
    if (rows > 0)
        take_away(rows, columns, t->width, at(f, below, t->from), a, lead, 1, at(f, below, column), lead);
}

// Tiles of the lower half are counted by rows: 0, then 1 2, then 3 4 5.
static void update_rest(void *shared, int32_t index)
{
    const tiling *t = shared;
    const front *f = t->f;
    int32_t i = 0, j = index;
    while (j > i) j -= ++i;
    int lead = f->pivots + f->height, row = i * TILE, column = j * TILE;
    int rows = MIN(TILE, f->height - row), columns = MIN(TILE, f->height - column);
    take_away(rows, columns, f->pivots, at(f, f->pivots + row, 0), at(f, f->pivots + column, 0), lead,
              t->beta, f->rest + (size_t)column * (size_t)f->height + row, f->height);
}

int32_t front_eliminate(jali_context *ctx, const front *f, bool fresh)
{
    int lead = f->pivots + f->height, info;
    tiling t = {.f = f, .beta = fresh ? NONE : ONE};
    for (t.from = 0; t.from < f->pivots; t.from += t.width) {
        t.width = MIN(TILE, f->pivots - t.from);
        dpotrf_("L", &t.width, at(f, t.from, t.from), &lead, &info);
        if (info != 0) return t.from + info - 1;
        int32_t below = lead - t.from - t.width, right = f->pivots - t.from - t.width;
        run(ctx, (below + TILE - 1) / TILE, solve_rows, &t);
        run(ctx, (right + TILE - 1) / TILE, update_panel, &t);
    }
    int32_t tiles = (f->height + TILE - 1) / TILE;
    run(ctx, tiles * (tiles + 1) / 2, update_rest, &t);
    return -1;
}

int32_t match_rows(const elimination *e, int32_t child, int32_t parent, row_run *run_of)
{
    int32_t count = 0, from = 0, first = e->first[parent], end = e->first[parent + 1];
    int64_t q = e->row[parent];
    int32_t past = pivots_of(e, parent); // where the parent's row q is, in unknowns
    for (int64_t k = e->row[child]; k < e->row[child + 1]; k++) {
        int32_t position = e->below[k], width = e->start[position + 1] - e->start[position], to;
        if (position < end) {
            to = e->start[position] - e->start[first];
        } else {
            for (; e->below[q] != position; q++) past += e->start[e->below[q] + 1] - e->start[e->below[q]];
            to = past;
        }
        if (count > 0 && run_of[count - 1].to + run_of[count - 1].count == to)
            run_of[count - 1].count += width;
        else
            run_of[count++] = (row_run){from, to, width};
        from += width;
    }
    return count;
}

VECTORISED static void add(int32_t count, const double *from, double *to)
{
    for (int32_t i = 0; i < count; i++) to[i] += from[i];
}

void front_add(const front *f, const double *left, int32_t left_height, const row_run *run_of,
               int32_t run_count, int32_t index)
{
    const row_run *own = &run_of[index];
    for (int32_t c = 0; c < own->count; c++) {
        int32_t column = own->to + c;
        const double *from = left + (size_t)(own->from + c) * (size_t)left_height;
        bool in_panel = column < f->pivots;
        int32_t shift = in_panel ? 0 : f->pivots; // the rest begins at row and column `pivots`
        double *to = in_panel ? at(f, 0, column) : f->rest + (size_t)(column - shift) * (size_t)f->height;
        add(own->count - c, from + own->from + c, to + column - shift);
        for (int32_t r = index + 1; r < run_count; r++)
            add(run_of[r].count, from + run_of[r].from, to + run_of[r].to - shift);
    }
}
