// jali: from a picture to a printable pierced plate or vessel. This header brings all others.
//
//     jali_context *ctx;
//     jali_context_create(NULL, &ctx);
//     jali_picture picture;
//     jali_result result;
//     jali_options opt = jali_defaults();
//     if (jali_read(ctx, "lion.png", NULL, &picture) == JALI_OK &&
//         jali_make(ctx, &picture, &opt, &result) == JALI_OK) { ... result.mesh ... }
//     else puts(jali_message(ctx));
#ifndef JALI_JALI_H
#define JALI_JALI_H

#include <jali/adapt.h>
#include <jali/analyse.h>
#include <jali/around.h>
#include <jali/base.h>
#include <jali/bitmap.h>
#include <jali/board.h>
#include <jali/bridges.h>
#include <jali/bytes.h>
#include <jali/calibrate.h>
#include <jali/carve.h>
#include <jali/chart.h>
#include <jali/check.h>
#include <jali/compare.h>
#include <jali/compensate.h>
#include <jali/connect.h>
#include <jali/contours.h>
#include <jali/edits.h>
#include <jali/lower.h>
#include <jali/map.h>
#include <jali/mesh.h>
#include <jali/model.h>
#include <jali/nudge.h>
#include <jali/optimise.h>
#include <jali/place.h>
#include <jali/png.h>
#include <jali/predict.h>
#include <jali/printer.h>
#include <jali/read.h>
#include <jali/reinforce.h>
#include <jali/render.h>
#include <jali/sample.h>
#include <jali/sheet.h>
#include <jali/shell.h>
#include <jali/strengthen.h>
#include <jali/surface.h>
#include <jali/trace.h>
#include <jali/write.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The stages of a run, in order; names are those of folders, JSON keys and benches.
enum {
    JALI_STAGE_THRESHOLD,
    JALI_STAGE_PLACE,
    JALI_STAGE_OPTIMISE,
    JALI_STAGE_NUDGE,
    JALI_STAGE_PREDICT,
    JALI_STAGE_TRACE,
    JALI_STAGE_STRENGTHEN,
    JALI_STAGE_CARVE,
    JALI_STAGE_CHECK,
    JALI_STAGES
};
JALI_API const char *jali_stage_name(int32_t stage);

typedef struct jali_options {
    jali_threshold_options threshold;
    jali_place_options place; // size, working pixel, frame
    jali_printer printer;     // when it has a name, its figures are those of the whole run. Default: none
    jali_optimise_options optimise; // its phi_e, phi_s, phi_v and paper count for place and predict as well
    int32_t nudge_rounds; // move the mask's edges until the print comes nearest to the picture (jali_nudge),
                          // at most so many rounds; 0 (default) = not
    jali_trace_options trace;
    jali_carve_options carve;
    int32_t repeat; // so many copies of the picture side by side, each of place's size, 1 .. 1000; 0 = 1
    bool around;    // the picture, or its copies, go once around the surface and meet at the back without a
                    // bar (default false); then they have no size of their own
    double backing_mm; // on surfaces: a film at the inner skin that stays in the voids; 0 (default) = none
    double bridge_depth_mm; // height of the bridges that join parts, from the hidden side (a plate's z = 0, a
                            // surface's inner skin); 0 (default) = as high as the rest
    bool predict;           // say what input, connected only and result come out as (default true)
    bool recall;            // with the share of fine detail that survives (default true; slower)
    bool solid;             // trace and carve too (default true); false = the image stages alone
    bool check;             // check the mesh (default true)
    bool structure;         // analyse and reinforce; needs `solid` (default false)
    jali_strengthen_options strengthen;
} jali_options;

/// The defaults of all stages, with a frame of 2 mm.
JALI_API jali_options jali_defaults(void);

/// Everything a run made. {0} is valid and empty.
typedef struct jali_result {
    int32_t threshold;    // grey level at and above which a pixel is white
    jali_bitmap input;    // the picture in black and white, its own resolution
    int32_t input_pieces; // white components, 4-connected
    jali_chart chart;
    jali_placed placed;       // on a surface: where
    double wall_mm;           // on a surface: the thinnest wall under the picture, between the skins at its
                              // vertices; less than phi_s is not printable
    jali_optimised optimised; // the mask and how it came about
    jali_nudge_report nudge;  // when asked for
    // What comes out of the printer, when predicted: of the input as it is, connected only, and of the
    // result.
    jali_prediction input_print, connected_print, result_print;
    jali_lost lost;         // what the last of them does not show; with `recall` and optimise's `details`
    jali_contours contours; // of the plate: picture, frame, hanging hole
    jali_mesh mesh;
    jali_check_report check;
    // Promises (docs/conventions.md); each says what was looked at, not what was hoped.
    bool one_piece, printable, closed;
    jali_strength strength; // when `structure` was asked for; its `sound` is the fourth promise
    double seconds[JALI_STAGES];
} jali_result;

JALI_API void jali_result_free(jali_context *ctx, jali_result *result);

/// An object with pictures pierced through it. {0} is valid and empty.
typedef struct jali_object {
    jali_shell_report wall;
    jali_mesh mesh;
    jali_check_report check;
    bool one_piece, closed;
    double seconds[JALI_STAGES]; // of what its pictures share
} jali_object;

JALI_API void jali_object_free(jali_context *ctx, jali_object *object);

/// Pictures on one surface, each with options of its own; no two may overlap.
///   in     opt       [count]
///          wall      NULL means the defaults
///   inout  surface   taken: empty afterwards
///          picture   [count] rewritten by a local threshold only
///   out    result    [count] all but mesh and check; free each with jali_result_free
///          object    free with jali_object_free
///   fails  whatever a stage fails with
JALI_API jali_status jali_make_on(jali_context *ctx, jali_surface *surface, const jali_shell_options *wall,
                                  jali_picture *picture, const jali_options *opt, int32_t count,
                                  jali_result *result, jali_object *object);

/// How a run with these options is predicted: by its printer, or by the three figures of `optimise`.
/// picture_mm is 0 and the chart flat.
JALI_API jali_predict_options jali_prediction_options(const jali_options *opt);

/// What the printer makes of a picture as it is, of place's size on a plate: nothing connected, nothing
/// adapted.
///   in     opt       NULL means the defaults; `threshold`, `printer`, `place`, `recall` and the figures of
///                    `optimise` count
///   inout  picture   rewritten by a local threshold only
///   out    result    threshold, input, input_pieces and input_print; free with jali_result_free
///   fails  JALI_BAD_VALUE, JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
JALI_API jali_status jali_predict_picture(jali_context *ctx, jali_picture *picture, const jali_options *opt,
                                          jali_result *result);

/// The whole pipeline on a picture, as a plate.
///   in     opt       NULL means the defaults
///   inout  picture   rewritten by a local threshold only
///   out    result    free with jali_result_free
///   fails  whatever a stage fails with; a promise that is not kept is no failure: see the result
JALI_API jali_status jali_make(jali_context *ctx, jali_picture *picture, const jali_options *opt,
                               jali_result *result);

#ifdef __cplusplus
}
#endif
#include <jali/smallest.h>

#endif
