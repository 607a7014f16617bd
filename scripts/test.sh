#!/usr/bin/env bash
# Installs what is missing, builds the release preset and runs every test:
# scripts/test.sh [ctest options]. Quiet when all is well; a failure is shown in full.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

nuvo_install "${nuvo_packages[@]}"
nuvo_build release

cd "$nuvo_root"
log=build/release/test.log
status=0
ctest --preset release -j "$(nproc)" "$@" >"$log" 2>&1 || status=$?
if [ $status -ne 0 ]; then
    grep -vE '^ +Start |^ *[0-9]+/[0-9]+ Test .* Passed ' "$log"
    exit $status
fi
grep -E '^[0-9]+% tests passed|^Total Test time' "$log"
