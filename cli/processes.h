// Several processes: which program runs, and which of them speaks.
#ifndef CLI_PROCESSES_H
#define CLI_PROCESSES_H

#include "options.h"

/// `--solver petsc` is the work of jali-mpi, the same program over the other solver: PETSc and MPI are
/// neither loaded nor started for anything else. Becomes it where that is asked for. In jali-mpi all
/// processes but the first fall silent.
///   out    sentence  what is wrong, when false comes back
bool right_program(const verb *v, int argc, char **argv, char sentence[SENTENCE_BYTES]);

#endif
