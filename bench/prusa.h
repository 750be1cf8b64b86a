// PrusaSlicer as a witness: what it would lay or expose of a plate. For bench/slicer.c.
#ifndef BENCH_PRUSA_H
#define BENCH_PRUSA_H

#include <jali/jali.h>

typedef enum prusa_process { PRUSA_FDM, PRUSA_CLASSIC, PRUSA_SLA, PRUSA_PROCESSES } prusa_process;

/// As the tables name it.
const char *prusa_name(prusa_process process);

/// Slice a plate 1 mm thick and read what comes out.
///   in     plate       [parts], on one bed as they lie; 1 or 2, one for SLA
///          folder      for files in passing; it exists
///          pixel_mm    of the drawing of G-code
///          seconds     after so many the slicer is ended
///   out    took        seconds of its processor time
/// False when there is no slicer, or it failed or was ended; a sentence is on stderr.
bool prusa_print(jali_context *ctx, prusa_process process, const jali_mesh *plate, int parts,
                 const char *folder, double pixel_mm, double seconds, jali_print *print, double *took);

#endif
