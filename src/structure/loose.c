// Pieces of a sheet that supports do not hold.
//
// A piece holds still when no rigid motion of it leaves all held unknowns at rest: the Gram matrix of the
// motions, seen at the held unknowns, must have full rank. Motions turn about the piece's middle and are
// scaled by its size, so that the test has no unit.
//
// Limits:  a piece that hangs on its neighbour by a single node counts as joined: a node passes on moments.
// Checked: tests/test_structure.c.
#include "structure/assemble.h"
#include "base/sets.h"

#include <math.h>

// Supports closer to a line than this part of the piece's size do not stop its turning.
static const double LEAST_PIVOT = 1e-10;

typedef struct piece {
    int32_t nodes, supported;
    double middle[3], low[3], high[3]; // mm
    double size_mm;
    double gram[NODE_UNKNOWNS][NODE_UNKNOWNS];
} piece;

// How the motions move one unknown of a node; motions 0 .. 2 shift along x, y, z, 3 .. 5 turn about them.
static void motions_at(const piece *p, const double place[3], int unknown, double m[NODE_UNKNOWNS])
{
    for (int k = 0; k < NODE_UNKNOWNS; k++) m[k] = k == unknown;
    if (unknown >= 3) return; // turning by 1/size radians, in units of 1/size
    int next = (unknown + 1) % 3, last = (unknown + 2) % 3;
    m[3 + next] = (place[last] - p->middle[last]) / p->size_mm;
    m[3 + last] = -(place[next] - p->middle[next]) / p->size_mm;
}

// The rank of a Gram matrix over the motions in question: Cholesky with the largest pivot first.
static int rank_of(double g[NODE_UNKNOWNS][NODE_UNKNOWNS], int which)
{
    bool used[NODE_UNKNOWNS];
    double scale = 0;
    for (int k = 0; k < NODE_UNKNOWNS; k++) {
        used[k] = !(which >> k & 1);
        if (!used[k]) scale += g[k][k];
    }
    for (int rank = 0;; rank++) {
        int p = -1;
        for (int k = 0; k < NODE_UNKNOWNS; k++)
            if (!used[k] && (p < 0 || g[k][k] > g[p][p])) p = k;
        if (p < 0 || !(g[p][p] > LEAST_PIVOT * scale)) return rank;
        used[p] = true;
        for (int i = 0; i < NODE_UNKNOWNS; i++)
            for (int k = 0; k < NODE_UNKNOWNS; k++)
                if (!used[i] && !used[k]) g[i][k] -= g[i][p] * g[p][k] / g[p][p];
    }
}

static void join_nodes(const jali_sheet *sheet, int32_t *piece_of)
{
    for (int32_t i = 0; i < sheet->node_count; i++) piece_of[i] = i;
    for (int32_t t = 0; t < sheet->triangle_count; t++)
        for (int k = 1; k < 3; k++) unite(piece_of, sheet->triangle[t][0], sheet->triangle[t][k]);
}

// Turn roots into the numbers of pieces, in the order of their first nodes.
static int32_t number_pieces(int32_t node_count, int32_t *piece_of)
{
    int32_t pieces = 0;
    for (int32_t i = 0; i < node_count; i++) piece_of[i] = root_of(piece_of, i);
    for (int32_t i = 0; i < node_count; i++)
        piece_of[i] = piece_of[i] == i ? pieces++ : piece_of[piece_of[i]];
    return pieces;
}

static void measure(const jali_sheet *sheet, const int32_t *piece_of, int32_t count, piece *pieces)
{
    for (int32_t i = 0; i < count; i++)
        pieces[i] = (piece){.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (int32_t i = 0; i < sheet->node_count; i++) {
        piece *p = &pieces[piece_of[i]];
        p->nodes++;
        for (int k = 0; k < 3; k++) {
            p->low[k] = MIN(p->low[k], sheet->node[i][k]);
            p->high[k] = MAX(p->high[k], sheet->node[i][k]);
        }
    }
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            pieces[i].middle[k] = 0.5 * (pieces[i].low[k] + pieces[i].high[k]);
            pieces[i].size_mm = MAX(pieces[i].size_mm, pieces[i].high[k] - pieces[i].low[k]);
        }
}

static void gather_supports(const jali_sheet *sheet, const uint8_t *held, int which, const int32_t *piece_of,
                            piece *pieces)
{
    for (int32_t i = 0; i < sheet->node_count; i++) {
        piece *p = &pieces[piece_of[i]];
        p->supported += (held[i] & which) != 0;
        for (int unknown = 0; unknown < NODE_UNKNOWNS; unknown++) {
            double m[NODE_UNKNOWNS];
            if (!(held[i] & which & 1 << unknown) || p->nodes == 1) continue;
            motions_at(p, sheet->node[i], unknown, m);
            for (int r = 0; r < NODE_UNKNOWNS; r++)
                for (int c = 0; c < NODE_UNKNOWNS; c++) p->gram[r][c] += m[r] * m[c];
        }
    }
}

jali_status pieces_are_held(jali_context *ctx, const jali_sheet *sheet, const uint8_t *held,
                            bool bending_only)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    int which = bending_only ? BENDING : HELD_ALL, wanted = __builtin_popcount((unsigned)which);
    int32_t *piece_of;
    piece *pieces;
    TRY(ARENA(ctx, piece_of, sheet->node_count));
    join_nodes(sheet, piece_of);
    int32_t count = number_pieces(sheet->node_count, piece_of);
    TRY(ARENA(ctx, pieces, count));
    measure(sheet, piece_of, count, pieces);
    gather_supports(sheet, held, which, piece_of, pieces);
    for (int32_t i = 0; i < count; i++) {
        piece *p = &pieces[i];
        int rank = p->nodes > 1 ? rank_of(p->gram, which) : wanted; // a node alone is in no triangle
        if (rank == wanted) continue;
        status = fail(
            ctx, JALI_NO_RESULT,
            "nothing holds the piece around (%.1f, %.1f, %.1f) mm, %.1f mm large: %d of its %d nodes are "
            "supported, which leaves %d of %d rigid motions free",
            p->middle[0], p->middle[1], p->middle[2], p->size_mm, p->supported, p->nodes, wanted - rank,
            wanted);
        goto done;
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
