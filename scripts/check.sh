#!/usr/bin/env bash
# Every gate in one command: format, layers, headers alone, warnings as errors, sanitizers (memory,
# undefined behaviour, threads), clang-tidy, tests.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

nuvo_check_proc
nuvo_install "${nuvo_packages[@]}" clang clang-format clang-tidy libclang-rt-dev
cd "$nuvo_root"

echo "format"
find include src tests testfileGenerator bench study main.cpp -name '*.h' -o -name '*.cpp' | sort |
    xargs clang-format --dry-run -Werror

echo "layers"
scripts/check_layers.sh

echo "headers"
scripts/check_headers.sh

for preset in dev sanitize; do
    echo "$preset"
    nuvo_build "$preset"
    nuvo_quietly ctest --preset "$preset" -j "$(nproc)"
done

# What starts threads: the fast tracer, its loops, and whole runs of the program.
echo "thread"
nuvo_build thread render_tests math_tests
for room in math render; do nuvo_quietly "build/thread/tests/${room}_tests" \
    --gtest_filter='*Parallel*:*Thread*:*Fast*:*LightBuffer*'; done

echo "tidy"
nuvo_build tidy

echo "release"
scripts/test.sh
