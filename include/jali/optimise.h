// Optimise: the image method whole, Algorithms 1 and 3 over the stages connect, compensate and adapt.
#ifndef JALI_OPTIMISE_H
#define JALI_OPTIMISE_H

#include <jali/adapt.h>
#include <jali/bridges.h>
#include <jali/chart.h>
#include <jali/edits.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct jali_optimise_options {
    double phi_e_mm;       // how much wider a solid bar prints than drawn; < 0: narrower, a kerf (0.1)
    double phi_s_mm;       // narrowest solid that prints, > 0 (0.3)
    double phi_v_mm;       // narrowest void that prints, > 0 (0.5)
    double epsilon_mm;     // a thin tip longer than this counts as a feature, >= 0 (4)
    bool paper;            // the paper's method: square elements, Table 1's kernels, its rounds
    int32_t kernels_px[3]; // omega_c, omega_w, omega_b; 0 (default) = from the three figures above
    int32_t most_rounds;   // of Algorithm 3, >= 1 (8); recall gains nothing after 6 to 8
    double detail;         // weight of fine detail against wrong pixels, 0 to 100; times jali_adapt_options'
                           // axis_worth of both tones (1)
    bool mark_bridges;     // keep bridge_mask (false)
    const jali_edits *edits; // what was laid down by hand, after jali_edits_follow: bridges drawn, places
                             // where none may run, regions that stay as they are; NULL (default): nothing
    bool details; // keep the details and conflicts for overlays and counts (costs a third more time)
} jali_optimise_options;

JALI_API jali_optimise_options jali_optimise_defaults(void);

/// What one round of adaption found.
typedef struct jali_round {
    int32_t white[JALI_TYPES], black[JALI_TYPES]; // details of each type
    int32_t conflicts;                            // regions
} jali_round;

/// What came of the edits by hand.
typedef struct jali_edited {
    int32_t count[JALI_EDIT_KINDS]; // of each kind
    int32_t left_out; // parts that no bridge may reach: taken off, the mask is one piece without them
    int32_t loose;    // parts that no bridge may reach and that are locked or drawn: they stay
    int32_t left_out_at[2], loose_at[2]; // a pixel of the first of them
    int32_t locked_details;              // of the residual's types A and B, those that touch what is locked
} jali_edited;

typedef struct jali_optimised {
    jali_bitmap mask; // what to carve: one 4-connected piece, nothing below the widths; what is locked by
                      // hand may break either
    int32_t kernels_px[3]; // omega_c, omega_w, omega_b as used
    int32_t bridges, pieces_dropped;
    int64_t bridge_pixels;
    int32_t round_count;
    jali_round *round;   // [round_count]
    jali_round residual; // details left in the mask: types A and B are zero, but for what is locked
    jali_bridges laid;   // the bridges that the finish laid and what strengthens it, with the pixels of each;
                         // those that made none white are left out, and so are drawn ones
    jali_edited edited;
    bool cycled; // the paper's rounds came back to an earlier picture and were stopped
    // With `details`, for overlays; bridge_mask with `mark_bridges` alone as well:
    jali_details white, black; // of the first round
    jali_bitmap conflict;
    jali_bitmap bridge_mask; // pixels that the bridges of the result made white
} jali_optimised;

JALI_API void jali_optimised_free(jali_context *ctx, jali_optimised *result);

/// omega_c, omega_w, omega_b as in Table 1, from phi in mm and the pixel in mm (docs/conventions.md).
JALI_API void jali_paper_kernels(double phi_e_mm, double phi_s_mm, double phi_v_mm, double pixel_mm,
                                 int32_t kernels_px[3]);

/// Optimise a drawing for the printer.
///   in     drawing   on the chart's working grid, margin included
///          opt       NULL means the defaults
///   out    result    free with jali_optimised_free
///   fails  JALI_NO_RESULT (nothing of the picture is wide enough to print), JALI_BAD_VALUE, JALI_NO_MEMORY,
///          JALI_CANCELLED, JALI_LIMIT
JALI_API jali_status jali_optimise(jali_context *ctx, const jali_bitmap *drawing, const jali_chart *chart,
                                   const jali_optimise_options *opt, jali_optimised *result);

/// Where no more bridges may run for what was forbidden or locked by hand.
///   in     opt       as the mask was made with
///   out    blocked   on the mask's grid; an empty bitmap when there are no edits
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_optimise_blocked(jali_context *ctx, const jali_chart *chart,
                                           const jali_optimise_options *opt, const jali_optimised *result,
                                           jali_bitmap *blocked);

/// Lay more bridges into a result's mask, by the same rules: as wide as the printer needs, and what voids
/// beside them become too narrow is filled.
///   in     bridges   straight; from and to are pixels of the mask
///          opt       as the mask was made with; a bridge that would cross what is forbidden is not laid
///   inout  result    mask, residual, laid, bridges, bridge_pixels, bridge_mask; the mask only ever gains
///   solid fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_CANCELLED, JALI_LIMIT; the mask may then have gained
///   some of it
JALI_API jali_status jali_optimise_add(jali_context *ctx, const jali_bridges *bridges,
                                       const jali_chart *chart, const jali_optimise_options *opt,
                                       jali_optimised *result);

/// Mend a mask that something else has drawn, by the finish's rules: thin solid is taken off, pieces are
/// joined as wide as the printer needs, voids that are too narrow are filled.
///   in     opt       as jali_optimise; what is locked stays as the mask has it
///   inout  mask
///   out    residual  details left: types A and B are zero
///   fails  as jali_optimise; the mask is then in between
JALI_API jali_status jali_optimise_mend(jali_context *ctx, const jali_chart *chart,
                                        const jali_optimise_options *opt, jali_bitmap *mask,
                                        jali_round *residual);

#ifdef __cplusplus
}
#endif
#endif
