#!/usr/bin/env bash
# setup.sh run|check|wall|reference|site|all: see that what nsd needs is there; install it where that is allowed, else name
# the line that does.
set -euo pipefail

# run: the build and the demonstration; check: what the tests of make check need, and small packages that some skip
# without; all: make check-all
run=(build-essential pkg-config libhdf5-dev hdf5-tools libgsl-dev libjansson-dev zlib1g-dev libdeflate-dev libpng-dev
    libcairo2-dev libsuitesparse-dev libqhull-dev jq gnuplot-nox)
wall=("${run[@]}" python3-h5py python3-scipy)
reference=("${wall[@]}" liggghts)
site=("${run[@]}" mandoc cmark-gfm python3)
check=("${wall[@]}" "${site[@]:${#run[@]}}" python3-numpy python3-jsonschema perl libfclib-dev opencl-c-headers parallel time)
all=("${check[@]}" shellcheck cppcheck clang libomp-dev libclang-rt-dev
    clang-tidy clang-format gcovr mmdebstrap
    openmpi-bin libopenmpi-dev libhdf5-openmpi-dev libtrilinos-zoltan-dev
    debhelper lintian valgrind zsh python3-vtk9 python3-ase python3-mdanalysis python3-gsd python3-sklearn liggghts
    pocl-opencl-icd ocl-icd-libopencl1 ffmpeg chromium chromium-driver python3-selenium pngquant)

case "${1:-run}" in
run) packages=("${run[@]}") ;;
wall) packages=("${wall[@]}") ;;
reference) packages=("${reference[@]}") ;;
site) packages=("${site[@]}") ;;
check) packages=("${check[@]}") ;;
all) packages=("${all[@]}") ;;
*) echo "usage: setup.sh run|check|wall|reference|site|all" >&2; exit 64 ;;
esac

if ! command -v dpkg-query >/dev/null; then
    echo "setup: not a Debian system; nsd needs what Debian calls: ${packages[*]}" >&2
    exit 0
fi

missing=()
for p in "${packages[@]}"; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$p" 2>/dev/null || true)
    [ "$state" = installed ] || missing+=("$p")
done
[ ${#missing[@]} -gt 0 ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
    echo "setup: installing ${missing[*]}" >&2
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
else
    echo "setup: packages are missing; as root: apt-get install ${missing[*]}" >&2
    exit 69
fi
