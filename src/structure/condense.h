// Bridges, condensed to their ends. Internal.
#ifndef STRUCTURE_CONDENSE_H
#define STRUCTURE_CONDENSE_H

#include "structure/assemble.h"

/// A bridge as it is drawn. Nodes are numbered through: its ends, then its own. Memory is the caller's.
typedef struct bridge {
    int32_t end_count, own_count, triangle_count;
    const int32_t *end;           // [end_count] nodes of the sheet, each once
    const double (*own)[3];       // [own_count] mm
    const double *thickness_mm;   // [own_count]
    const int32_t (*triangle)[3]; // [triangle_count]
    const double (
        *load)[NODE_UNKNOWNS]; // [case_count][end_count + own_count] what it carries itself; NULL: nothing
} bridge;

/// A bridge as the structure feels it. {0} is valid and empty.
typedef struct condensed {
    int32_t name; // whatever the owner calls it
    int32_t rank, own_unknowns;
    int32_t *row;      // [rank] unknowns of the structure
    int32_t (*end)[2]; // [rank] the same as nodes of the sheet, and bits
    int32_t *at;       // [rank] where these stand in its owner's list
    double *stiffness; // [rank][rank] S
    double *follow;    // [own_unknowns][rank] how its own nodes follow its ends
    double *load;      // [case_count][rank] g
    double *own_load;  // [case_count][own_unknowns] displacement of its own nodes while the ends stay
} condensed;

/// Eliminate a bridge's own nodes.
///   fails  JALI_NO_RESULT (they do not hold together), JALI_LIMIT, JALI_NO_MEMORY
///   cost   O(own^3)
jali_status condense(jali_context *ctx, const structure *s, const bridge *b, int32_t case_count,
                     condensed *c);
void condensed_free(jali_context *ctx, condensed *c);

#endif
