#!/usr/bin/env bash
# Installs what is missing, builds the release preset and runs every test:
# scripts/test.sh [ctest options]. Says what it does, on a terminal how far it is; shows a failure in full.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

nuvo_install "${nuvo_packages[@]}"
nuvo_build release

cd "$nuvo_root"
log=build/release/test.log
status=0
nuvo_watch "Testing, about $((360 / $(nproc) / 60 + 1)) minutes" "$log" \
    ctest --preset release -j "$(nproc)" "$@" || status=$?
if [ $status -ne 0 ]; then
    grep -vE '^ +Start |^ *[0-9]+/[0-9]+ Test .* Passed ' "$log"
    exit $status
fi
grep -E '^[0-9]+% tests passed|^Total Test time' "$log"
