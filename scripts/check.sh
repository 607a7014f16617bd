#!/usr/bin/env bash
# Every gate in one command: format, layers, warnings as errors, sanitizers, tests.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

nuvo_install "${nuvo_packages[@]}" clang-format
cd "$nuvo_root"

echo "format"
find include src tests testfileGenerator main.cpp -name '*.h' -o -name '*.cpp' | sort |
    xargs clang-format --dry-run -Werror

echo "layers"
scripts/check_layers.sh

for preset in dev sanitize; do
    echo "$preset"
    nuvo_build "$preset"
    nuvo_quietly ctest --preset "$preset" -j "$(nproc)"
done

echo "release"
scripts/test.sh
