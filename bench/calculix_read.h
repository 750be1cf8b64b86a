// What CalculiX wrote, at the nodes of a sheet.
#ifndef BENCH_CALCULIX_READ_H
#define BENCH_CALCULIX_READ_H

#include "calculix.h"

#include <stdio.h>

/// Displacements and stresses of a .frd file. Its nodes are told by where they are, as shells are turned into
/// solids with numbers of their own: a level is a z, a node of the sheet a place in the plane.
calculix_answer calculix_read(FILE *f, const jali_sheet *sheet);

#endif
