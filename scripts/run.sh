#!/usr/bin/env bash
# Installs what is missing, builds the program for this machine and renders: scripts/run.sh [scene]
# [nuvo flags]. Without a scene it renders the picture of the README. What the user did not choose is
# chosen for speed: the fast profile on all cores, once. Works from any folder; paths are the caller's.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

# Sets `options` to what is added to the user's arguments.
choose_options() {
    local argument flag scene=no answers=no profile=fast threads=no rep=no asks=no
    for argument in "$@"; do
        flag=${argument#-}
        flag=${flag#-}
        case $argument in
            -*) ;;
            *)  if [ -f "$argument" ] || [ -f "$argument.x3d" ]; then scene=yes; fi
                continue ;;
        esac
        case ${flag%%=*} in
            file) scene=yes ;;
            profile) profile=${flag#profile=} ;;
            threads) threads=yes ;;
            rep) rep=yes ;;
            h | help | version) asks=yes ;;
            # What the fast profile decides by itself, and commands that it does not know.
            tracer | midpoint | costs | max-objects | leaves | walk | step | precision | bias | \
                back-faces | showoctree | study | describe | pixel) answers=yes ;;
        esac
    done
    options=()
    [ $asks = no ] || return 0
    [ $scene = yes ] || options+=("--file=$nuvo_root/testfiles/showcase")
    [ $answers = no ] || return 0
    [[ " $* " == *[\ -]profile[=\ ]* ]] || options+=(--profile=fast)
    if [ "$profile" = fast ] && [ $threads = no ]; then options+=(--threads=0); fi
    [ $rep = yes ] || options+=(--rep=1)
}

main() {
    nuvo_install "${nuvo_packages[@]}"
    nuvo_build native nuvo
    local options
    choose_options "$@"
    [ ${#options[@]} -eq 0 ] || echo "Rendering: nuvo ${options[*]} $*" >&2
    exec "$nuvo_root/build/native/nuvo" "${options[@]}" "$@"
}

# The test sources this file.
[ "${BASH_SOURCE[0]}" != "$0" ] || main "$@"
