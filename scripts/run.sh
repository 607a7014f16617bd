#!/usr/bin/env bash
# Installs what is missing, builds the release program and renders: scripts/run.sh [nuvo flags].
# Without --file it renders a scene of the thesis. Works from any folder; paths are the caller's.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

nuvo_install "${nuvo_packages[@]}"
nuvo_build release nuvo

names_scene=no
for argument in "$@"; do
    case $argument in
        -file | -file=* | --file | --file=* | -h | -help | --help | -version | --version)
            names_scene=yes ;;
    esac
done
scene=()
[ $names_scene = yes ] || scene=("--file=$nuvo_root/testfiles/appendixE")
exec "$nuvo_root/build/release/nuvo" "${scene[@]}" "$@"
