#!/usr/bin/env bash
# Builds the program for ARM64 with Debian's cross compiler and holds its pictures, drawn under qemu,
# against those of this machine's program, byte by byte: scripts/arm64.sh [--program=FILE] [scene]...
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

here=
if [[ ${1:-} == --program=* ]]; then here=$(realpath -- "${1#*=}"); shift; fi
libraries=(libboost-dev libboost-chrono-dev libboost-program-options-dev libnlopt-cxx-dev libpng-dev
    zlib1g-dev libhwy-dev libgeos-c1v5) # libgeos-dev is of one architecture only
if ! dpkg --print-foreign-architectures | grep -qx arm64; then
    echo "Please allow ARM64 packages as root: dpkg --add-architecture arm64" >&2
    exit 1
fi
nuvo_install "${nuvo_packages[@]}" g++-aarch64-linux-gnu qemu-user-static
nuvo_install "${libraries[@]/%/:arm64}"
if [ -z "$here" ]; then
    nuvo_build native nuvo
    here=$nuvo_root/build/native/nuvo
fi

build=$nuvo_root/build/arm64
triple=aarch64-linux-gnu
nuvo_quietly cmake -S "$nuvo_root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DNUVO_TESTS=OFF -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
    -DCMAKE_CXX_COMPILER=$triple-g++ -DCMAKE_LIBRARY_ARCHITECTURE=$triple \
    -DCMAKE_FIND_ROOT_PATH=/usr/$triple -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
    -DGEOS_C_LIBRARY=/usr/lib/$triple/libgeos_c.so.1 -DGEOS_C_INCLUDE_DIR=/usr/include \
    -DBoost_DIR=/usr/lib/$triple/cmake/Boost-1.74.0 -DNLopt_DIR=/usr/lib/$triple/cmake/nlopt
nuvo_watch_quietly "Building for ARM64" ninja -C "$build" nuvo

scenes=("$@")
[ $# -gt 0 ] || scenes=(showcase both concentric clumped icosphere)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
differing=0
for scene in "${scenes[@]}"; do
    for profile in exact fast thesis; do
        flags=("--file=$nuvo_root/testfiles/$scene" "--profile=$profile" --rep=1 --res=160,90 --quiet)
        "$here" "${flags[@]}" "--out=$work/here.bmp" 2>/dev/null
        qemu-aarch64-static "$build/nuvo" "${flags[@]}" "--out=$work/arm64.bmp" 2>/dev/null
        if cmp -s "$work/here.bmp" "$work/arm64.bmp"; then
            echo "same $scene $profile"
        else
            echo "DIFFERS $scene $profile"
            differing=$((differing + 1))
        fi
    done
done
[ $differing -eq 0 ]
