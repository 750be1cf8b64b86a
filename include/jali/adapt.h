// Adapt: make the details of both tones wide enough for the printer.
#ifndef JALI_ADAPT_H
#define JALI_ADAPT_H

#include <jali/bitmap.h>
#include <jali/bridges.h>
#include <jali/chart.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_shape { JALI_SHAPE_DISC, JALI_SHAPE_SQUARE } jali_shape;

typedef struct jali_adapt_options {
    jali_shape shape;        // of the structuring elements; default disc, the paper's is the square
    int32_t solid_px;        // omega_w: narrowest solid that is left alone, 1 .. 4096
    int32_t void_px;         // omega_b: narrowest void that is left alone, 1 .. 4096
    int32_t epsilon_px;      // a detail whose medial axis has more pixels than this is type B, else C
    bool isolated_matters;   // a detail that touches no larger area of its own tone is type B whatever its
                             // length
    bool outside_solid;      // what surrounds the picture
    const jali_chart *chart; // with a metric: the lengths here are on the surface, in units of the flat
                             // pixel, and the elements vary over the picture (docs/metric.md); discs only.
                             // NULL (default): flat
    const struct jali_elements *elements; // what jali_elements_create made of these very options, so that
                                          // each call need not again. NULL (default): it does
    int32_t growth_px; // omega_c: what the printer adds to a solid's width, plus 1; odd; < 0: it takes away
                       // (default 1)
    // What was laid down by hand (jali/edits.h); NULL (default): nothing
    const jali_bitmap *fixed;  // pixels that prune and finish leave as `kept` has them
    const jali_bitmap *kept;   // their tones
    const jali_bitmap *closed; // black pixels that no stroke of a bridge covers
    // jali_adapt_print alone:
    double axis_worth_white; // what a lost pixel of a detail's axis weighs, as a share of the narrowest
                             // width, 0 to
    double axis_worth_black; // 100: 0 = only the count of wrong pixels matters; more keeps more fine detail
                             // of that tone and draws it wider, at the price of wrong pixels. Default 0.22
                             // and 0.27: over 24 runs both tones then keep the same share (docs/adapt.md)
} jali_adapt_options;

JALI_API jali_adapt_options jali_adapt_defaults(void);

/// The elements of the widths, to be shared by all calls with the same options, one call at a time: they
/// remember what the last ones found, and a picture that differs little is looked at where it does.
typedef struct jali_elements jali_elements;

/// Prepare the elements for pictures of a size.
///   fails  JALI_NO_MEMORY, JALI_BAD_VALUE (widths; a metric that is none)
///   cost   up to 10 bitmaps of that size as they are used
JALI_API jali_status jali_elements_create(jali_context *ctx, const jali_adapt_options *opt, int32_t width_px,
                                          int32_t height_px, jali_elements **elements);
JALI_API void jali_elements_free(jali_context *ctx, jali_elements *elements);

enum { JALI_TYPE_A, JALI_TYPE_B, JALI_TYPE_C, JALI_TYPES };

/// The details of one tone: what an opening removes (Eqs. 2 and 3), sorted by section 4.3.
typedef struct jali_details {
    jali_bitmap type[JALI_TYPES]; // pixels of the details of each type
    int32_t count[JALI_TYPES];    // how many connected details
} jali_details;

JALI_API void jali_details_free(jali_context *ctx, jali_details *details);

/// Find and sort the details of one tone. A: its boundary in the other tone has more than one connected part.
/// B: one part, but a medial axis longer than epsilon. C: the rest, tips mostly, and the corners of a plate
/// without a frame, which no disc reaches.
///   in     picture   carries a margin of at least the element's size where its surroundings matter
///          white     which tone
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_BAD_VALUE
JALI_API jali_status jali_adapt_details(jali_context *ctx, const jali_bitmap *picture, bool white,
                                        const jali_adapt_options *opt, jali_details *details);

/// Conflict pixels (Eq. 4) between the details of types A and B: white ones with a black one within a window
/// omega_w wide, black ones with a white one within a window omega_b wide.
///   out    conflict  a new bitmap
///          regions   8-connected groups
JALI_API jali_status jali_adapt_conflicts(jali_context *ctx, const jali_details *white,
                                          const jali_details *black, const jali_adapt_options *opt,
                                          jali_bitmap *conflict, int32_t *regions);

/// One round of Algorithm 3 after the connecting (lines 4 to 7): each conflict region goes to the tone that
/// holds more of it (Eq. 5; ties to white), the other details of types A and B grow by 3 x 3.
///   in,out picture
JALI_API jali_status jali_adapt_round(jali_context *ctx, const jali_details *white, const jali_details *black,
                                      const jali_bitmap *conflict, jali_bitmap *picture);

typedef struct jali_stamp_report {
    int64_t tried, white, black; // places looked at, discs of each tone that stayed
} jali_stamp_report;

/// The default in place of rounds: a print of discs that differs least from the drawing. (A few spots where
/// discs of the two tones meet stay thinner; the finish mends them.) Begins with the opening and closing;
/// then at each lost detail a disc of its tone is set, with all that this closes or cuts off around it, when
/// that lowers
///     wrong pixels + axis_worth * width * lost pixels of the details' axes, tone by tone.
/// The sum is a whole number and falls with each disc that stays, so the search ends.
///   in     drawing   what the print should look like, margin included
///   out    print     a new bitmap: how the print comes out, growth included (jali_compensate gives the mask)
///   fails  JALI_NO_MEMORY, JALI_CANCELLED, JALI_BAD_VALUE
JALI_API jali_status jali_adapt_print(jali_context *ctx, const jali_bitmap *drawing,
                                      const jali_adapt_options *opt, jali_bitmap *print,
                                      jali_stamp_report *report);

/// Smooth the edges of a print wherever the discs of both tones still fit afterwards: the input's pixel
/// stairs go.
///   in,out print
JALI_API jali_status jali_adapt_smooth(jali_context *ctx, const jali_adapt_options *opt, jali_bitmap *print);

/// Remove the pieces of a print that are not worth their bridges. The bridges that would join the pieces make
/// a tree; of the trees that hold the largest piece, the one is kept that gains most: what its pieces save in
/// wrong pixels and lost axes less what its bridges cost (the prize-collecting problem, exact on a tree).
///   in     bridges   what jali_connect gives for this print
///          opt       a piece with a white pixel that is fixed stays
///   in,out print
///   out    dropped   pieces removed
JALI_API jali_status jali_adapt_prune(jali_context *ctx, const jali_bitmap *drawing,
                                      const jali_bridges *bridges, const jali_adapt_options *opt,
                                      jali_bitmap *print, int32_t *dropped);

/// The finish, in two halves between which the cores are joined: mend the solid that is thinner than solid_px
/// and give the cores, the places where the element fits. Where two cores are apart, the solid between them
/// is a neck thinner than that, or nothing.
///   in     thicken   what is too thin is painted over (true) or taken off (false, for the first round)
///   out    cores     a new bitmap
JALI_API jali_status jali_adapt_cores(jali_context *ctx, const jali_adapt_options *opt, bool thicken,
                                      jali_bitmap *mask, jali_bitmap *cores);

/// Paint the bridges between cores solid_px wide, then fill voids narrower than void_px.
///   inout  bridges   `pixels` of each
JALI_API jali_status jali_adapt_lay(jali_context *ctx, jali_bridges *bridges, const jali_adapt_options *opt,
                                    jali_bitmap *mask);

/// Paint bridges as wide as the printer needs in the mask (solid_px), or as they come out in the print.
///   inout  bridges   `pixels` of each
JALI_API jali_status jali_adapt_strokes(jali_context *ctx, jali_bridges *bridges,
                                        const jali_adapt_options *opt, bool in_print, jali_bitmap *dst);

/// Where a bridge may not run, because its stroke would cover a black pixel that is closed.
///   in     picture   a mask, or a print
///   out    blocked   a new bitmap, for jali_connect
JALI_API jali_status jali_adapt_blocked(jali_context *ctx, const jali_adapt_options *opt, bool in_print,
                                        const jali_bitmap *picture, jali_bitmap *blocked);

/// Take some cores off a mask, with all around them that the others do not need.
JALI_API jali_status jali_adapt_take_off(jali_context *ctx, const jali_bitmap *off, const jali_bitmap *others,
                                         const jali_adapt_options *opt, jali_bitmap *mask);

#ifdef __cplusplus
}
#endif
#endif
