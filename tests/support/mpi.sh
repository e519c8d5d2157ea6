# mpi.sh: where there is MPI, tests/whole/mpi*.t run it, after tap.sh; elsewhere they are skipped.
# shellcheck shell=bash
if ! command -v mpirun >/dev/null || ! command -v nsd-step-mpi >/dev/null; then
    echo "1..0 # SKIP there is no MPI: packages openmpi-bin, libopenmpi-dev, libtrilinos-zoltan-dev"
    exit 0
fi
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
export ASAN_OPTIONS=detect_leaks=0:$ASAN_OPTIONS # MPI's own
