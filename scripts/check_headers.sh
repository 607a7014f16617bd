#!/usr/bin/env bash
# Checks that each header compiles alone, with the warnings of a build: scripts/check_headers.sh
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$nuvo_root"

flags=(-std=c++20 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
    -fsyntax-only -x c++ -I include -I src/render -I tests
    -DNUVO_SOURCE_DIR=\"\" -DNUVO_PROGRAM=\"\" -DNUVO_GENERATOR=\"\")
faults=0
for header in $(find include src testfileGenerator -name '*.h' | sort); do
    "${CXX:-c++}" "${flags[@]}" -I "$(dirname "$header")" -include "$header" /dev/null || faults=$((faults + 1))
done
[ $faults -eq 0 ] || { echo "$faults headers do not compile alone"; exit 1; }
