// Carved plates for the comparison with solids: samples, files, and plates drilled or sawn by rows.
#ifndef BENCH_PLATES_H
#define BENCH_PLATES_H

#include <jali/jali.h>

typedef struct carved_options {
    const char *picture; // a sample, a file (with a '/' or '.'), "drilled" or "lattice"
    int32_t rows;        // of holes, when drilled or a lattice
    double width_mm;     // of the picture; 0: rows of holes phi_v wide with phi_s between them
    double phi_s_mm, phi_v_mm;
} carved_options;

/// A picture through the whole pipeline: the contours of its plate, its chart.
jali_status carved_plate(jali_context *ctx, const carved_options *o, jali_result *result);

#endif
