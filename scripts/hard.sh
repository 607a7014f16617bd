#!/usr/bin/env bash
# Hard rays and pictures against exact arithmetic: scripts/hard.sh [--rays N] [--seed S]
# [--class NAME] [--fast] [--solid] | --leaks N | --pictures | --scenes N | --lit N | --list. The exit status is 1 where
# anything is wrong.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

# A flag and its value may stand apart.
flags=()
while [ $# -gt 0 ]; do
    case $1 in
        --rays | --seed | --class | --leaks | --scenes | --lit | --threads | --precision)
            [ $# -ge 2 ] || { echo "hard.sh: $1 needs a value" >&2; exit 2; }
            flags+=("$1=$2")
            shift 2 ;;
        *)
            flags+=("$1")
            shift ;;
    esac
done

nuvo_install "${nuvo_packages[@]}"
nuvo_build release hard_cases
exec "$nuvo_root/build/release/tests/hard_cases" "${flags[@]}"
