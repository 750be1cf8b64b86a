#!/bin/sh
# The distributed solver against the sequential one, on 1 and 2 processes, flat and curved, by factor and by multigrid.
#
#     test.sh PLATE_SEQ PLATE_MPI [CELLS]
set -eu
seq=$1 mpi=$2 cells=${3:-64}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
for radius in 0 60; do
    "$seq" write "$work/u" "$cells" $radius
    for processes in 1 2; do
        for method in direct multigrid; do
            echo "radius $radius, $processes processes, $method"
            PETSC_OPTIONS="-jali_solver $method" mpirun --oversubscribe -np $processes "$mpi" compare "$work/u" "$cells" $radius
        done
    done
done
