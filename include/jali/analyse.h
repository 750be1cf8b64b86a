// Analyse: what a load does to a pierced wall, by shell finite elements on its sheet.
#ifndef JALI_ANALYSE_H
#define JALI_ANALYSE_H

#include <jali/sheet.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What the wall is made of: linear, elastic, the same in all directions.
typedef struct jali_material {
    const char *name;
    double e_mpa;         // Young's modulus
    double nu;            // Poisson's ratio, > -1, < 0.5
    double density_g_cm3; // for its own weight
    double limit_mpa;     // the largest stress to allow (von Mises)
    const char *source;   // of the figures
} jali_material;

/// The materials that are built in; the first one is the default.
JALI_API const jali_material *jali_material_list(int32_t *count);
/// One of them by its name in any case; NULL when there is none.
JALI_API const jali_material *jali_material_find(const char *name);

/// What holds the wall: all six unknowns there are zero.
typedef enum jali_support {
    JALI_SUPPORT_PICTURE, // the picture's boundary (the paper); the frame plays no part
    JALI_SUPPORT_RIM,     // the outline of a plate, the open borders of a surface
    JALI_SUPPORT_BASE     // what lies lowest along z, to 1 % of the height: the edge an object stands on
} jali_support;

/// Loads; those that are not zero act together.
typedef struct jali_load {
    double force_n;      // pressed evenly against the outer side, in total over the solid of the sheet; or
    double pressure_mpa; // the same as force by area. Either may pull (< 0)
    double weight;       // its own weight, times this; 0 (default) = none
    double gravity[3];   // where weight pulls to, any length; zeros (default): -z
    double push_n;       // on a spot, against the normal there
    double push_at_mm[3];
    double pinch_n;       // on two spots that lie outermost on a line through the middle, towards each other
    double pinch_axis[3]; // of that line; zeros (default): x
    double spot_mm;       // radius of a push and of a pinch's two; 3 (default), a fingertip, > 0
} jali_load;

typedef struct jali_analyse_options {
    jali_material material; // default: the first of the list
    jali_support support;   // default: the picture's boundary
    jali_load load;         // default: none
    double phi_s_mm;        // narrowest solid feature: stresses are means over discs half as wide; > 0 (0.3)
    bool rough;             // for a search: solutions to 1e-8, stresses only where they are large (false)
} jali_analyse_options;

JALI_API jali_analyse_options jali_analyse_defaults(void);

/// A largest value and where.
typedef struct jali_peak {
    double value;
    int32_t node;
    double at_mm[3];
} jali_peak;

/// What a load does. {0} is valid and empty. Stresses are von Mises, of the outer face, the inner face or the
/// middle, whichever is largest (docs/analyse.md).
typedef struct jali_analysis {
    int32_t node_count;
    double (*displacement)[6]; // [node_count] mm along x, y, z; rad about x, y, z
    float (*face_mpa)[3];      // [node_count] von Mises at the outer face, in the middle, at the inner face
    float (*principal_mpa)[2]; // [node_count] largest and smallest principal stress of both faces
    float *raw_mpa;            // [node_count] the largest of the three; has no limit in a sharp inner corner
    float *mean_mpa;           // [node_count] its mean over a disc of diameter phi_s / 2: what counts
    jali_peak stress, raw_stress, moved; // largest mean, largest raw (MPa), largest displacement (mm)
    double area_mm2;                     // of the sheet
    double pressure_mpa;                 // as applied
    double residual;                     // |K u - f| / |f|; NAN when it was not asked for (rough)
    struct jali_stiffness *stiffness;    // factorised, for what comes after
} jali_analysis;

JALI_API void jali_analysis_free(jali_context *ctx, jali_analysis *analysis);
/// Give back the stiffness alone, which is most of the memory.
JALI_API void jali_stiffness_drop(jali_context *ctx, jali_analysis *analysis);

/// Displacements and stresses of a sheet under a load.
///   in     sheet     kept by the result: it must outlive it
///          opt       NULL means the defaults
///   out    analysis  free with jali_analysis_free
///   fails  JALI_BAD_VALUE (a figure that is no number or out of range, no load), JALI_NO_RESULT (nothing
///   holds
///          the sheet, or a part of it: where is in the message), JALI_LIMIT, JALI_CANCELLED, JALI_NO_MEMORY
///   cost   10 us and 2.9 kB an unknown (6 a node); flat sheets under pressure: 7.5 us and 1.7 kB (3 a node)
JALI_API jali_status jali_analyse(jali_context *ctx, const jali_sheet *sheet, const jali_analyse_options *opt,
                                  jali_analysis *analysis);

/// The same sheet again, after its thickness changed: what depends on the pattern alone is kept.
///   inout  analysis   has its stiffness still; empty on failure
///   fails  as jali_analyse
JALI_API jali_status jali_analyse_again(jali_context *ctx, const jali_sheet *sheet, jali_analysis *analysis);

#ifdef __cplusplus
}
#endif
#endif
