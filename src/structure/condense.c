// A bridge as its end nodes feel it: its own nodes are eliminated.
//
// With the unknowns split into ends (e) and own (o): X = Koo^-1 Koe, S = Kee - Keo X, g = fe - X^T fo, and
// the own ones follow as uo = Koo^-1 fo - X ue.
//
// Checked: tests/test_attach.c.
#include "structure/condense.h"

#include "sparse/dense.h"

void condensed_free(jali_context *ctx, condensed *c)
{
    release(ctx, c->row);
    release(ctx, c->at);
    release(ctx, c->end);
    release(ctx, c->stiffness);
    release(ctx, c->follow);
    release(ctx, c->load);
    release(ctx, c->own_load);
    *c = (condensed){0};
}

// A bridge's unknowns, own ones first: ends that are held have none.
typedef struct split {
    const structure *s;
    const bridge *b;
    int32_t own, all; // unknowns: 0 .. own-1, then those of the ends
    int32_t *number;  // [nodes * node_width] -1: held
    double *k;        // [all][all]
} split;

static void number_unknowns(split *w, condensed *c)
{
    int width = node_width(w->s), first = first_bit(w->s);
    const bridge *b = w->b;
    w->own = w->all = b->own_count * width;
    for (int32_t i = 0; i < w->own; i++) w->number[b->end_count * width + i] = i;
    for (int32_t i = 0; i < b->end_count * width; i++) {
        int32_t node = b->end[i / width], bit = i % width + first, row = unknown_at(w->s, node, bit);
        w->number[i] = row < 0 ? -1 : w->all++;
        if (row < 0) continue;
        c->row[c->rank] = row;
        c->end[c->rank][0] = node;
        c->end[c->rank++][1] = bit;
    }
}

static void corner_of(const split *w, int32_t local, double place[3], double *thickness_mm)
{
    const bridge *b = w->b;
    const jali_sheet *sheet = w->s->sheet;
    bool end = local < b->end_count;
    int32_t i = end ? b->end[local] : local - b->end_count;
    memcpy(place, end ? sheet->node[i] : b->own[i], 3 * sizeof *place);
    *thickness_mm += (end ? sheet->thickness_mm[i] : b->thickness_mm[i]) / 3;
}

static void assemble_bridge(split *w)
{
    int width = node_width(w->s);
    memset(w->k, 0, (size_t)w->all * (size_t)w->all * sizeof *w->k);
    for (int32_t t = 0; t < w->b->triangle_count; t++) {
        const int32_t *corner = w->b->triangle[t];
        double node[3][3], thickness_mm = 0, element[18 * 18];
        for (int i = 0; i < 3; i++) corner_of(w, corner[i], node[i], &thickness_mm);
        element_stiffness(w->s, (const double(*)[3])node, thickness_mm, element);
        for (int i = 0; i < 3 * width; i++)
            for (int j = 0; j < 3 * width; j++) {
                int32_t r = w->number[corner[i / width] * width + i % width];
                int32_t c = w->number[corner[j / width] * width + j % width];
                if (r >= 0 && c >= 0)
                    w->k[(size_t)r * (size_t)w->all + (size_t)c] += element[i * 3 * width + j];
            }
    }
}

// Koo apart, factored; X = Koo^-1 Koe in c->follow; S in c->stiffness.
static bool eliminate(const split *w, condensed *c, double *own)
{
    size_t all = (size_t)w->all, n = (size_t)w->own, m = (size_t)c->rank;
    for (size_t i = 0; i < n; i++) {
        memcpy(own + i * n, w->k + i * all, n * sizeof *own);
        memcpy(c->follow + i * m, w->k + i * all + n, m * sizeof *own);
    }
    if (!cholesky(w->own, own)) return false;
    cholesky_solve(w->own, own, c->rank, c->follow);
    for (size_t i = 0; i < m; i++) memcpy(c->stiffness + i * m, w->k + (n + i) * all + n, m * sizeof *own);
    for (size_t i = 0; i < n * m; i++) c->follow[i] = -c->follow[i];
    add_product(c->rank, w->own, c->rank, w->k + n * all, all, c->follow, m, c->stiffness, m);
    return true;
}

// Bring one load case to the ends; what the own nodes do under it stays in c->own_load.
static void condense_load(const split *w, condensed *c, int32_t of_case, const double *own)
{
    int width = node_width(w->s);
    int32_t nodes = w->b->end_count + w->b->own_count;
    double *g = c->load + (size_t)of_case * (size_t)c->rank;
    double *stay = c->own_load + (size_t)of_case * (size_t)w->own;
    for (int32_t i = 0; w->b->load && i < nodes * width; i++) {
        double f = w->b->load[of_case * nodes + i / width][i % width + first_bit(w->s)];
        int32_t at = w->number[i];
        if (at >= 0) *(at < w->own ? &stay[at] : &g[at - w->own]) = f;
    }
    add_product(1, w->own, c->rank, stay, (size_t)w->own, c->follow, (size_t)c->rank, g, (size_t)c->rank);
    cholesky_solve(w->own, own, 1, stay);
}

jali_status condense(jali_context *ctx, const structure *s, const bridge *b, int32_t case_count, condensed *c)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    size_t width = (size_t)node_width(s), nodes = (size_t)b->end_count + (size_t)b->own_count;
    split w = {.s = s, .b = b};
    double *own;
    *c = (condensed){0};
    if (nodes > 4096) {
        status =
            fail(ctx, JALI_LIMIT, "a bridge of %zu nodes is too large to be condensed (most: 4096)", nodes);
        goto done;
    }
    TRY(ALLOCATE(ctx, c->row, (size_t)b->end_count * width));
    TRY(ALLOCATE(ctx, c->at, (size_t)b->end_count * width));
    TRY(ALLOCATE(ctx, c->end, (size_t)b->end_count * width));
    TRY(ARENA(ctx, w.number, nodes * width));
    number_unknowns(&w, c);
    c->own_unknowns = w.own;
    TRY(ARENA(ctx, w.k, (size_t)w.all * (size_t)w.all));
    TRY(ARENA(ctx, own, (size_t)w.own * (size_t)w.own));
    TRY(ALLOCATE(ctx, c->stiffness, (size_t)c->rank * (size_t)c->rank));
    TRY(ALLOCATE(ctx, c->follow, (size_t)w.own * (size_t)c->rank));
    TRY(ALLOCATE_CLEARED(ctx, c->load, (size_t)case_count * (size_t)c->rank));
    TRY(ALLOCATE_CLEARED(ctx, c->own_load, (size_t)case_count * (size_t)w.own));
    assemble_bridge(&w);
    if (!eliminate(&w, c, own)) {
        const double *at = s->sheet->node[b->end[0]];
        status = fail(ctx, JALI_NO_RESULT, "a bridge near (%.2f, %.2f, %.2f) mm does not hold together",
                      at[0], at[1], at[2]);
        goto done;
    }
    for (int32_t k = 0; k < case_count; k++) condense_load(&w, c, k, own);
done:
    arena_rewind(ctx, mark);
    if (status != JALI_OK) condensed_free(ctx, c);
    return status;
}
