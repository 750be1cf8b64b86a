// Bridges on a structure that is factored already: joined and withdrawn without a new factor. Internal.
//
// A bridge is a small strip of triangles between nodes of the sheet. Its own nodes are condensed away, which
// leaves a stiffness S and a load g at its end nodes; with F = P^T K^-1 P for the end nodes' unknowns the
// displacements of the joined structure there are y = (I + F S)^-1 (P^T u + F g), and elsewhere K x = f + P
// (g - S y).
#ifndef STRUCTURE_ATTACH_H
#define STRUCTURE_ATTACH_H

#include "structure/condense.h"

/// The system that couples the bridges: M = I + F S, factored.
typedef struct coupling {
    double *matrix; // [rank][rank]
    int32_t *pivot; // [rank]
} coupling;

/// {0} is not valid: begin with attachments_begin. The structure must live as long, and keep its factor.
typedef struct attachments {
    structure *s;
    int32_t case_count;
    int32_t next_name;
    size_t count, kept, capacity;
    condensed *bridge; // [kept] the first `count` are attached, the others withdrawn
    int32_t rank;      // unknowns at the ends of all bridges, also of those withdrawn since
    int32_t *row;      // [rank] ascending
    double *f;         // [rank][rank] K^-1 there
    coupling coupled;  // of those attached,
    bool stands;       // unless one came or went since
    double residual;   // of the last solution, as structure's
    bool rough;        // set by the owner: a search, for which solutions without refinement (1e-8) do
} attachments;

/// Bridges that are worth a new factor: above this rank the correction costs more (FACTS: about 500).
enum { RANK_WORTH_A_FACTOR = 500 };

void attachments_begin(attachments *a, structure *s, int32_t case_count);
void attachments_free(jali_context *ctx, attachments *a);

/// Add a bridge; it is copied.
///   out    name   for withdraw and own_displacements
///   fails  JALI_NO_RESULT (its own nodes do not hold together), JALI_NO_MEMORY, JALI_LIMIT
///   cost   O(own^3)
jali_status attach(jali_context *ctx, attachments *a, const bridge *b, int32_t *name);

/// Take a bridge back, and attach it again: it stays condensed meanwhile. A name that is not there is
/// ignored.
void withdraw(attachments *a, int32_t name);
void attach_again(attachments *a, int32_t name);

/// Displacements of the structure with all its bridges.
///   in     load     [count][node_count] on the sheet
///          base     [count][node_count] displacements under these loads without bridges (structure_solve)
///          loaded   the bridges carry their loads too; count is then the number of load cases. false: for
///          unit and
///                   adjoint loads, which are not refined
///   out    u        [count][node_count]
///   cost   a solution a load case, and F for ends that are new
jali_status attached_solve(jali_context *ctx, attachments *a, int32_t count,
                           const double (*load)[NODE_UNKNOWNS], const double (*base)[NODE_UNKNOWNS],
                           bool loaded, double (*u)[NODE_UNKNOWNS]);

/// Displacements of a bridge's own nodes.
///   in     of_case   the load case that u belongs to; -1: the bridge carries nothing
///          u         [node_count] from attached_solve
///   out    own       [own_count of the bridge]
void own_displacements(const attachments *a, int32_t name, int32_t of_case, const double (*u)[NODE_UNKNOWNS],
                       double (*own)[NODE_UNKNOWNS]);

/// What candidates would change in a linear functional c.u, each alone, without solving.
///   in     of_case  the load case that u belongs to; the candidates carry it too
///          u        [node_count] now, with the bridges that are attached
///          adjoint  [node_count] attached_solve of the loads c, not loaded
///   out    change   [count] of c.u
///   fails  as attach
///   cost   F for the candidates' ends together
jali_status bridges_worth(jali_context *ctx, attachments *a, int32_t count, const bridge *candidate,
                          int32_t of_case, const double (*u)[NODE_UNKNOWNS],
                          const double (*adjoint)[NODE_UNKNOWNS], double *change);

// What attach.c and worth.c share.

/// Bring F up to the bridges that are there, and couple them, unless they are.
///   out    m   the attachments' own, as long as none comes or goes
jali_status couple(jali_context *ctx, attachments *a, coupling *m);

/// Sort, and keep each once; returns how many stay.
int32_t sort_rows(int32_t count, int32_t *row);

/// Where a row stands in a sorted list; -1: not in it.
int32_t index_of(int32_t count, const int32_t *row, int32_t wanted);

#endif
