// What the cases of bench/ share.
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include <jali/jali.h>

/// A picture on its way through the pipeline: what each case starts from.
typedef struct subject {
    const char *name;
    jali_options opt;
    jali_bytes png; // the file
    jali_picture picture;
    jali_chart chart;
    jali_bitmap drawing;         // on the working grid
    jali_bitmap scratch, result; // of the drawing's size, for the operators
    // For the cases after optimise:
    jali_bitmap mask;
    jali_contours contours; // of the plate
    jali_contours outline;  // of the picture alone
    jali_mesh mesh;
} subject;

/// On which grid a case is measured: the default's, or the input's own pixels.
enum { ON_WORKING = 1, ON_INPUT = 2 };

/// One thing to measure.
typedef struct bench_case {
    const char *name;
    jali_status (*run)(jali_context *ctx, subject *s, int32_t size); // once; frees what it makes
    double (*peer)(subject *s, int32_t size, int32_t runs);          // ms of another library, or NULL
    int32_t size;                                                    // handed to both
    uint32_t grids;
    bool solid; // needs mask, contours and mesh
} bench_case;

extern const bench_case bench_cases[];
extern const int32_t bench_case_count;

/// Milliseconds of a steady clock.
double now_ms(void);
/// The median of `count` times, which it sorts.
double median(double *ms, int32_t count);

// Leptonica, when it was found at configure time; -1 otherwise.
double peer_opening(subject *s, int32_t size, int32_t runs);
double peer_and(subject *s, int32_t size, int32_t runs);
double peer_components(subject *s, int32_t size, int32_t runs);

#endif
