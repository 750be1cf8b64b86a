// CalculiX as a peer.
#ifndef BENCH_CALCULIX_H
#define BENCH_CALCULIX_H

#include <jali/sheet.h>

typedef struct calculix_answer {
    double seconds, displacement_mm; // CPU time; the largest one. NAN: it did not run
} calculix_answer;

bool calculix_there(void);

/// The sheet under pressure along -z, clamped at JALI_BORDER_RIM; of one thickness.
calculix_answer calculix_run(const jali_sheet *sheet, double e_mpa, double nu, double pressure_mpa, bool six);

#endif
