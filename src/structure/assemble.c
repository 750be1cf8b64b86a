// The stiffness of a sheet, assembled by rows.
//
// Nodes are taken in runs along a Morton curve. A run's rows belong to it alone: it computes every triangle
// that touches its nodes, those on its fringe once more than needed (4 % of them at 4096 nodes a run), and
// adds what falls into its own rows. So threads share nothing, and each sum has one order however many there
// are.
//
// Checked: tests/test_structure.c: against a dense elimination, over seeds; every allocation refused once.
#include "structure/assemble.h"

#include <math.h>

enum { RUN = 4096 };

typedef struct assembly {
    structure *s;
    int32_t from, to; // the places whose rows are this process's
    int32_t *first;   // [node_count + 1] triangles of the node at a place: at[first[p]] .. at[first[p+1]-1]
    int32_t *at;      // [3 * triangle_count]
} assembly;

// Which rows are this process's, and the triangles around each node, ascending.
static jali_status list_triangles(jali_context *ctx, assembly *a)
{
    jali_status status;
    const jali_sheet *sheet = a->s->sheet;
    const int32_t *place = a->s->place;
    solver_share(sheet->node_count, &a->from, &a->to);
    TRY(ARENA(ctx, a->first, sheet->node_count + 2));
    TRY(ARENA(ctx, a->at, 3 * (size_t)sheet->triangle_count));
    memset(a->first, 0, ((size_t)sheet->node_count + 2) * sizeof *a->first);
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int k = 0; k < 3; k++) a->first[place[sheet->triangle[t][k]] + 2]++;
    for (int32_t p = 0; p < sheet->node_count; p++) a->first[p + 2] += a->first[p + 1];
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int k = 0; k < 3; k++) a->at[a->first[place[sheet->triangle[t][k]] + 1]++] = t;
done:
    return status;
}

// The places up to p that share a triangle with it, ascending and each once; returns how many.
static int32_t row_pattern(const assembly *a, int32_t p, int32_t *column)
{
    const structure *s = a->s;
    int32_t count = 0;
    column[count++] = p;
    for (int32_t i = a->first[p]; i < a->first[p + 1]; i++)
        for (int k = 0; k < 3; k++) {
            int32_t other = s->place[s->sheet->triangle[a->at[i]][k]], to = count;
            while (to > 0 && column[to - 1] > other) to--;
            if (other >= p || (to > 0 && column[to - 1] == other)) continue;
            memmove(column + to + 1, column + to, (size_t)(count - to) * sizeof *column);
            column[to] = other;
            count++;
        }
    return count;
}

// The columns of a run of rows, each where there is room for two of every triangle and itself.
typedef struct patterning {
    const assembly *a;
    int32_t *column; // [6 * triangle_count + node_count]
    int32_t *count;  // [node_count]
} patterning;

static int32_t *columns_of(const patterning *w, int32_t p)
{
    return w->column + 2 * (size_t)w->a->first[p] + (size_t)p;
}

static void find_pattern(void *shared, int32_t run)
{
    const patterning *w = shared;
    for (int32_t p = run * RUN; p < MIN((run + 1) * RUN, w->a->s->sheet->node_count); p++)
        w->count[p] = row_pattern(w->a, p, columns_of(w, p));
}

static void keep_pattern(void *shared, int32_t run)
{
    const patterning *w = shared;
    const block_matrix *k = &w->a->s->k;
    for (int32_t p = run * RUN; p < MIN((run + 1) * RUN, k->node_count); p++)
        memcpy(k->column + k->row[p], columns_of(w, p), (size_t)w->count[p] * sizeof *k->column);
}

static jali_status lay_pattern(jali_context *ctx, assembly *a)
{
    jali_status status;
    structure *s = a->s;
    block_matrix *k = &s->k;
    int32_t count = s->sheet->node_count, runs = (count + RUN - 1) / RUN;
    patterning w = {.a = a};
    uint8_t *width;
    k->node_count = count;
    TRY(ARENA(ctx, w.column, 6 * (size_t)s->sheet->triangle_count + (size_t)count));
    TRY(ARENA(ctx, w.count, count));
    TRY(ARENA(ctx, width, count));
    TRY(ALLOCATE(ctx, k->row, count + 1));
    parallel(ctx, runs, find_pattern, &w);
    k->row[0] = 0;
    for (int32_t p = 0; p < count; p++) {
        k->row[p + 1] = k->row[p] + w.count[p];
        width[p] = (uint8_t)__builtin_popcount(s->active[s->node[p]]);
    }
    TRY(ALLOCATE(ctx, k->column, k->row[count]));
    parallel(ctx, runs, keep_pattern, &w);
    TRY(block_matrix_lay(ctx, k, width));
done:
    return status;
}

void element_stiffness(const structure *s, const double node[3][3], double thickness_mm, double *k)
{
    facet_material made_of = s->made_of;
    double flat[3][2];
    made_of.thickness_mm = thickness_mm;
    if (!s->bending_only) {
        facet_stiffness(node, &made_of, (double(*)[18])k);
        return;
    }
    for (int i = 0; i < 3; i++) memcpy(flat[i], node[i], sizeof flat[i]);
    plate_stiffness((const double(*)[2])flat, &made_of, (double(*)[9])k);
}

static void stiffness(const structure *s, int32_t t, double *k)
{
    const jali_sheet *sheet = s->sheet;
    double node[3][3], thickness_mm = 0;
    for (int i = 0; i < 3; i++) {
        int32_t n = sheet->triangle[t][i];
        memcpy(node[i], sheet->node[n], sizeof node[i]);
        thickness_mm += sheet->thickness_mm[n] / 3;
    }
    element_stiffness(s, (const double(*)[3])node, thickness_mm, k);
}

static double *block_of(const block_matrix *k, int32_t row, int32_t column)
{
    int64_t b = k->row[row];
    while (k->column[b] != column) b++;
    return k->value + k->entry[b];
}

// Add the 6 x 6 or 3 x 3 part of an element's matrix that couples its corners i and c.
static void add_block(const structure *s, const double *element, int width, int i, int c, uint8_t active_row,
                      uint8_t active_column, bool diagonal, double *block)
{
    int shift = s->bending_only ? 2 : 0;
    for (int r = 0; r < width; r++) {
        if (!(active_row >> (r + shift) & 1)) continue;
        const double *from = element + (width * i + r) * 3 * width + width * c;
        for (int q = 0; q < (diagonal ? r + 1 : width); q++)
            if (active_column >> (q + shift) & 1) *block++ += from[q];
    }
}

static void add_element(const structure *s, int32_t t, int32_t from, int32_t to)
{
    double element[18 * 18];
    int width = s->bending_only ? 3 : NODE_UNKNOWNS;
    const int32_t *corner = s->sheet->triangle[t];
    stiffness(s, t, element);
    for (int i = 0; i < 3; i++) {
        int32_t row = s->place[corner[i]];
        if (row < from || row >= to) continue;
        for (int c = 0; c < 3; c++) {
            int32_t column = s->place[corner[c]];
            if (column > row) continue;
            add_block(s, element, width, i, c, s->active[corner[i]], s->active[corner[c]], row == column,
                      block_of(&s->k, row, column));
        }
    }
}

// Rows of one run of nodes. A triangle is met at each of its nodes, and added at the first one of the run.
static void assemble_run(void *shared, int32_t run)
{
    const assembly *a = shared;
    const structure *s = a->s;
    int32_t from = a->from + run * RUN, to = MIN(from + RUN, a->to);
    int64_t begin = s->k.entry[s->k.row[from]], end = s->k.entry[s->k.row[to]];
    memset(s->k.value + begin, 0, (size_t)(end - begin) * sizeof *s->k.value);
    for (int32_t p = from; p < to; p++)
        for (int32_t i = a->first[p]; i < a->first[p + 1]; i++) {
            const int32_t *corner = s->sheet->triangle[a->at[i]];
            bool met = false;
            for (int k = 0; k < 3; k++) met |= s->place[corner[k]] >= from && s->place[corner[k]] < p;
            if (!met) add_element(s, a->at[i], from, to);
        }
}

// Every unknown must resist: a triangle without area or thickness, or of no material, leaves a 0 or a NaN.
static jali_status resists(jali_context *ctx, const assembly *a)
{
    const structure *s = a->s;
    const block_matrix *k = &s->k;
    for (int32_t p = a->from; p < a->to; p++) {
        const double *own = k->value + k->entry[k->row[p + 1] - 1], *place = s->sheet->node[s->node[p]];
        for (int32_t i = 0; i < k->first[p + 1] - k->first[p]; own += ++i + 1)
            if (!(*own > 0 && *own < INFINITY))
                return fail(ctx, JALI_NO_RESULT,
                            "the sheet near (%.2f, %.2f, %.2f) mm has a stiffness of %g N/mm", place[0],
                            place[1], place[2], *own);
    }
    return JALI_OK;
}

static jali_status factor(jali_context *ctx, structure *s)
{
    int32_t weak, p = 0;
    jali_status status = solver_factor(ctx, s->solver, &weak);
    if (status != JALI_NO_RESULT || weak < 0) return status;
    while (s->k.first[p + 1] <= weak) p++;
    const double *place = s->sheet->node[s->node[p]];
    return fail(ctx, JALI_NO_RESULT, "the sheet near (%.2f, %.2f, %.2f) mm is not held", place[0], place[1],
                place[2]);
}

static jali_status fill_rows(jali_context *ctx, void *of_assembly)
{
    jali_status status;
    assembly *a = of_assembly;
    TRY(step(ctx, "assemble", 0));
    parallel(ctx, (a->to - a->from + RUN - 1) / RUN, assemble_run, a);
    TRY(step(ctx, "assemble", 1));
done:
    return status;
}

// Nodes that no triangle uses have no unknowns.
static void choose_unknowns(structure *s, const uint8_t *held)
{
    const jali_sheet *sheet = s->sheet;
    memset(s->active, 0, (size_t)sheet->node_count);
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            int32_t n = sheet->triangle[t][k];
            s->active[n] = (uint8_t)((s->bending_only ? BENDING : HELD_ALL) & ~held[n]);
        }
}

static jali_status open_solver(jali_context *ctx, void *of_structure)
{
    jali_status status;
    structure *s = of_structure;
    arena_mark mark = arena_here(ctx);
    double(*place)[3];
    TRY(ARENA(ctx, place, s->sheet->node_count));
    for (int32_t p = 0; p < s->sheet->node_count; p++)
        memcpy(place[p], s->sheet->node[s->node[p]], sizeof *place);
    TRY(solver_open(ctx, &s->k, (const double(*)[3])place, &s->solver));
done:
    arena_rewind(ctx, mark);
    return status;
}

jali_status structure_create(jali_context *ctx, const jali_sheet *sheet, const facet_material *base,
                             const uint8_t *held, bool bending_only, structure *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    assembly a = {.s = s};
    *s = (structure){.sheet = sheet, .made_of = *base, .bending_only = bending_only};
    TRY(pieces_are_held(ctx, sheet, held, bending_only));
    TRY(ALLOCATE(ctx, s->active, sheet->node_count));
    TRY(ALLOCATE(ctx, s->place, sheet->node_count));
    TRY(ALLOCATE(ctx, s->node, sheet->node_count));
    choose_unknowns(s, held);
    TRY(morton_order(ctx, sheet->node_count, (const double(*)[3])sheet->node, s->node));
    for (int32_t p = 0; p < sheet->node_count; p++) s->place[s->node[p]] = p;
    TRY(list_triangles(ctx, &a));
    TRY(lay_pattern(ctx, &a));
    TRY(do_both(ctx, open_solver, s, fill_rows, &a)); // the order goes by the pattern alone
    TRY(solver_agree(ctx, resists(ctx, &a)));
    arena_rewind(ctx, mark); // before the factor takes its memory
    TRY(factor(ctx, s));
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) structure_free(ctx, s);
    return status;
}

jali_status structure_refactor(jali_context *ctx, structure *s)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    assembly a = {.s = s};
    TRY(list_triangles(ctx, &a));
    TRY(fill_rows(ctx, &a));
    TRY(solver_agree(ctx, resists(ctx, &a)));
    arena_rewind(ctx, mark);
    TRY(factor(ctx, s));
done:
    arena_rewind(ctx, mark);
    return status;
}

void structure_free(jali_context *ctx, structure *s)
{
    solver_close(ctx, s->solver);
    block_matrix_free(ctx, &s->k);
    release(ctx, s->active);
    release(ctx, s->place);
    release(ctx, s->node);
    *s = (structure){0};
}
