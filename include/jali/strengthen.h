// Strengthen: analyse a pierced wall and lay connectors until it holds.
#ifndef JALI_STRENGTHEN_H
#define JALI_STRENGTHEN_H

#include <jali/analyse.h>
#include <jali/carve.h>
#include <jali/optimise.h>
#include <jali/reinforce.h>
#include <jali/trace.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_strengthen_options {
    jali_analyse_options analyse;     // load, support, material
    jali_reinforce_options reinforce; // its limit, phi_s and phi_v are those of the material and the printer
    int32_t across;                   // elements across the narrowest solid, 1 .. 16 (4)
    bool advise;                      // when it does not hold: say what would (default true)
    bool refine;                      // say how much half as many elements across change it (default true)
} jali_strengthen_options;

JALI_API jali_strengthen_options jali_strengthen_defaults(void);

/// What the picture is carved through: a plate, or a shell before this picture is pierced.
typedef struct jali_wall {
    const jali_carve_options *plate; // or NULL and:
    const jali_shell *shell;
    const jali_patch *patch;
} jali_wall;

typedef struct jali_strength_round {
    double stress_mpa, raw_stress_mpa, moved_mm;
    int32_t connectors, nodes;
} jali_strength_round;

/// What would do, each alone; 0 = nothing in reach would (a hundred times as thick), NULL = no material of
/// the list.
typedef struct jali_advice {
    double load_share;    // of the load that it bears as it is
    double thickness_mm;  // the wall that would bear it
    const char *material; // of the list: the weakest that would
    double unpierced_mpa; // largest stress of the wall without the picture
} jali_advice;

/// {0} is valid and empty.
typedef struct jali_strength {
    double limit_mpa;
    bool sound;         // the largest stress is within the limit
    bool helpless;      // the last search found no connector that helps
    int32_t connectors; // laid
    int32_t round_count;
    jali_strength_round *round; // [round_count] the first as it came, the last as it is
    double change_mpa;          // of the largest stress from half as many elements across; NAN = not asked
    jali_advice advice;         // when it is not sound
    jali_sheet sheet;           // of the result
    jali_analysis analysis;
    jali_sheet sheet_before; // before any connector; empty when none was laid
    jali_analysis before;
} jali_strength;

JALI_API void jali_strength_free(jali_context *ctx, jali_strength *s);

/// Section 5 of the paper: analyse, find connectors, draw them into the mask by the printer's rules, and
/// again until the largest stress is within the limit or nothing helps.
///   in     optimise   as the mask was made with
///   inout  optimised  its mask gets the connectors
///          outline    the mask's contours (jali_trace)
///   out    s          free with jali_strength_free
///   fails  as jali_analyse and what makes the contours
JALI_API jali_status jali_strengthen(jali_context *ctx, const jali_chart *chart, const jali_wall *wall,
                                     const jali_optimise_options *optimise, const jali_trace_options *trace,
                                     const jali_strengthen_options *opt, jali_optimised *optimised,
                                     jali_contours *outline, jali_strength *s);

#ifdef __cplusplus
}
#endif
#endif
