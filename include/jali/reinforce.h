// Reinforce: connectors across voids that take the load off a pierced wall.
#ifndef JALI_REINFORCE_H
#define JALI_REINFORCE_H

#include <jali/analyse.h>
#include <jali/bitmap.h>
#include <jali/bridges.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_reinforcing {
    JALI_REINFORCE_BEST,  // the connectors that relieve the largest stress most per visible pixel
    JALI_REINFORCE_PAPER, // from the most displaced region to its closest neighbouring part, one a round
    JALI_REINFORCE_NONE
} jali_reinforcing;

typedef struct jali_reinforce_options {
    jali_reinforcing rule;
    double limit_mpa;           // the largest stress (mean, see jali_analysis) to allow, > 0 (10)
    double phi_s_mm;            // width of a connector, > 0 (0.3)
    double phi_v_mm;            // narrowest void between two of them, > 0 (0.5)
    double longest_mm;          // the longest connector; 0 (default) = a third of the picture's shorter side
    const jali_bitmap *blocked; // pixels of the mask over which no connector may run; NULL (default): none
    int32_t most_at_once;       // connectors a round, 1 .. 64 (16)
    int32_t most_rounds;        // 1 .. 1000 (16)
} jali_reinforce_options;

JALI_API jali_reinforce_options jali_reinforce_defaults(void);

/// What a round came to.
typedef struct jali_reinforce_round {
    double stress_mpa, raw_stress_mpa, moved_mm; // largest, with the connectors so far
    int32_t connectors;                          // that are there
} jali_reinforce_round;

/// {0} is valid and empty.
typedef struct jali_reinforcement {
    jali_bridges bridges; // connectors to lay, as strokes of width phi_s
    int32_t connectors;   // one may need several strokes side by side
    int32_t withdrawn;    // that turned out useless
    int32_t round_count;
    jali_reinforce_round *round; // [round_count]
    bool helpless;               // no connector that fits would relieve the largest stress by 1 %
} jali_reinforcement;

JALI_API void jali_reinforcement_free(jali_context *ctx, jali_reinforcement *r);

/// Find connectors until the largest stress is within the limit, or none helps, or the rounds are over. Each
/// round costs a fifth of an analysis: connectors are attached to the factorised stiffness.
///   in     sheet     with its analysis
///          mask      of the picture the sheet was made from
///          opt       NULL means the defaults
///   inout  analysis  its stiffness carries the connectors afterwards
///   fails  JALI_BAD_VALUE, JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
JALI_API jali_status jali_reinforce(jali_context *ctx, const jali_sheet *sheet, const jali_bitmap *mask,
                                    const jali_chart *chart, const jali_reinforce_options *opt,
                                    jali_analysis *analysis, jali_reinforcement *r);

#ifdef __cplusplus
}
#endif
#endif
