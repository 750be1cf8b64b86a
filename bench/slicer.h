// What the parts of bench/slicer.c share.
#ifndef BENCH_SLICER_H
#define BENCH_SLICER_H

#include <jali/jali.h>

enum { FRAME_MM = 2 }; // of the plates

typedef struct witness {
    double seconds; // a limit
    const char *maps;
    bool own;        // plates made for the slicer as well
    bool halves;     // of connected plates, by FDM
    bool sla;        // alone
    double voids_mm; // phi_v that the plates are made for
    bool exact;      // phi_v of the print without the slicer's slack
    char folder[64];
} witness;

/// False when it failed; the sentence is on stderr.
bool tell(jali_context *ctx, jali_status status);

/// A plate of what is solid in `mask`, with a frame.
jali_status carve_mask(jali_context *ctx, const jali_bitmap *mask, const jali_chart *chart, jali_mesh *mesh);

/// White where `a` is set; `margin` pixels of it are left out all around.
jali_status grey_of(jali_context *ctx, const jali_bitmap *a, int32_t margin, jali_picture *grey);

/// What the slicer makes of bars 0.05 to 1 mm wide, as a table; an exit status.
int run_bars(jali_context *ctx, const witness *w);

#endif
