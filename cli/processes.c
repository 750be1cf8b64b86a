// From jali to jali-mpi, and who of several processes speaks.
//
// How:     jali-mpi lies beside jali in the build tree, in libexec once installed; mpirun starts jali, each
// of
//          its processes becomes jali-mpi before it has looked at anything else, and MPI sees no difference.
// Checked: mpi/cli.sh; tests/test_cli.c: without jali-mpi.
#include "processes.h"
#include "beside.h"
#include "sparse/solver.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static bool asks_for_petsc(int argc, char **argv)
{
    bool asks = false;
    for (int i = 2; i < argc && strcmp(argv[i], "--") != 0; i++) {
        if (strncmp(argv[i], "--solver=", 9) == 0)
            asks = strcmp(argv[i] + 9, "petsc") == 0;
        else if (strcmp(argv[i], "--solver") == 0 && i + 1 < argc)
            asks = strcmp(argv[++i], "petsc") == 0;
    }
    return asks;
}

// Comes back only when there is no such program.
static void become(char **argv)
{
    char path[PATH_MAX];
    setenv("OPENBLAS_NUM_THREADS", "1", 0); // processes share the processors already
    setenv("OMP_NUM_THREADS", "1", 0);
    for (int32_t place = 0; path_beside(place, "jali-mpi", path); place++) execv(path, argv);
}

bool right_program(const verb *v, int argc, char **argv, char sentence[SENTENCE_BYTES])
{
    bool asked = (v->groups & GROUP_SOLVER) && asks_for_petsc(argc, argv);
    bool here = strcmp(solver_name(), "petsc") == 0;
    if (asked && here && !solver_leads())
        (void)!(freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr));
    if (asked && !here) become(argv);
    if (asked && !here)
        snprintf(sentence, SENTENCE_BYTES, "this jali was built without PETSc; --solver direct is there");
    else if (here && !asked)
        snprintf(sentence, SENTENCE_BYTES, "jali-mpi is for \"jali analyse --solver petsc\" alone");
    return asked == here;
}
