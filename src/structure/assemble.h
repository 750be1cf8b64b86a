// A structure: the sheet's stiffness, assembled, held and factored; displacements under any loads. Internal.
//
// Each node has six unknowns (element.h), a bit each: bit 0 .. 2 displacement along x, y, z, bit 3 .. 5
// rotation. Unknowns that are held are not in the system at all.
#ifndef STRUCTURE_ASSEMBLE_H
#define STRUCTURE_ASSEMBLE_H

#include "structure/element.h"
#include "sparse/solver.h"

#include <jali/sheet.h>

enum {
    NODE_UNKNOWNS = 6,
    HELD_ALL = 63,
    HELD_IN_PLACE = 7,   // a hinge: the place is held, the slope is not
    BENDING = 4 + 8 + 16 // the unknowns of a flat plate under transverse load: w, rotation about x and y
};

/// Above such a residual |f - K u| / |f| one step of refinement follows. A good factor's is what rounding K u
/// leaves, 1.2e-10 on 170 k nodes and 2.8e-10 on 420 k; refinement, which costs as much as the solution,
/// takes no more than a third off that.
static const double GOOD_RESIDUAL = 1e-9;

/// {0} is valid and empty. The sheet must live as long.
typedef struct structure {
    const jali_sheet *sheet;
    facet_material made_of; // the thickness is each triangle's own
    bool bending_only;
    uint8_t *active; // [node_count] bits of the unknowns that are in the system
    int32_t *place;  // [node_count] where a node stands in the system
    int32_t *node;   // [node_count] which node stands there
    block_matrix k;
    solver *solver;
    double residual; // the largest |f - K u| / |f| of the last solution
} structure;

/// Assemble and factor.
///   in     base           thickness_mm is not looked at
///          held           [node_count] bits of the unknowns that supports hold
///          bending_only   the sheet is flat and loads act across it: three unknowns a node
///   out    s              free with structure_free; also on failure
///   fails  JALI_NO_RESULT (a piece that supports do not hold, with its place), JALI_LIMIT, JALI_NO_MEMORY,
///          JALI_CANCELLED
///   cost   O(n^1.5) time, O(n log n) memory
jali_status structure_create(jali_context *ctx, const jali_sheet *sheet, const facet_material *base,
                             const uint8_t *held, bool bending_only, structure *s);

/// Assemble and factor again, after the sheet's thickness or the material changed.
jali_status structure_refactor(jali_context *ctx, structure *s);

/// Displacements under loads. Held unknowns take no load and stay 0.
///   in     load   [count][node_count] forces (N) and moments (N mm)
///   out    u      [count][node_count]; may be the array of the loads
jali_status structure_solve(jali_context *ctx, structure *s, int32_t count,
                            const double (*load)[NODE_UNKNOWNS], double (*u)[NODE_UNKNOWNS]);

/// The same for unit and adjoint loads, which only rank: no refinement, so each costs a third.
jali_status structure_influence(jali_context *ctx, structure *s, int32_t count,
                                const double (*load)[NODE_UNKNOWNS], double (*u)[NODE_UNKNOWNS]);

void structure_free(jali_context *ctx, structure *s);

/// The unknowns a node has in this structure, from bit 0 or from bit 2 on.
static inline int node_width(const structure *s)
{
    return s->bending_only ? 3 : NODE_UNKNOWNS;
}

static inline int first_bit(const structure *s)
{
    return s->bending_only ? 2 : 0;
}

/// Stiffness of a triangle of the structure's material: [3 * node_width][3 * node_width].
void element_stiffness(const structure *s, const double node[3][3], double thickness_mm, double *k);

/// The row of a node's unknown in the system; -1 when it is held.
static inline int32_t unknown_at(const structure *s, int32_t node, int bit)
{
    if (!(s->active[node] >> bit & 1)) return -1;
    return s->k.first[s->place[node]] + __builtin_popcount(s->active[node] & ((1u << bit) - 1));
}

/// Between nodes' and system's order: one right side. What is held is dropped, and comes back as 0.
void gather_unknowns(const structure *s, const double (*of_node)[NODE_UNKNOWNS], double *x);
void scatter_unknowns(const structure *s, const double *x, double (*of_node)[NODE_UNKNOWNS]);
/// The Euclidean length of a right side or a residual.
double length_of_unknowns(const double *x, int32_t count);

/// Number the nodes along a Morton curve through their places, so that neighbours in the sheet are neighbours
/// in memory.
///   out    node   [count] which node comes as the i-th
jali_status morton_order(jali_context *ctx, int32_t count, const double (*place)[3], int32_t *node);

/// Look for pieces that supports leave loose: a piece must lose all its rigid motions.
///   in     active   [node_count] unknowns that are free; of a plate's only those of BENDING count
///   fails  JALI_NO_RESULT: the piece's place and size, how many motions are left
jali_status pieces_are_held(jali_context *ctx, const jali_sheet *sheet, const uint8_t *held,
                            bool bending_only);

#endif
