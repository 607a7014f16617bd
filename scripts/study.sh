#!/usr/bin/env bash
# Speed against error of the thesis' test scenes: nuvo --study of each, and the plot of one.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/study.sh [flag]... [scene]...
  --rep=N     rounds of each scene (5; the teapot 3 at most: the thesis profile tests every triangle)
  --res=W,H   size of the pictures (480,270)
  --out=DIR   where the results go (results/ in the project)
  -h          this list
Scenes are names in testfiles/ (trianglemesh both concentric clumped teapot). Leaves
study-SCENE.json and study-SCENE.txt, and study-SCENE.png where matplotlib is installed.
TEXT
}

fail() {
    echo "study.sh: $1" >&2
    exit 2
}

rep=5 resolution=480,270 out=$nuvo_root/results
scenes=()
while [ $# -gt 0 ]; do
    case $1 in
        --rep | --res | --out)
            [ $# -ge 2 ] || fail "$1 needs a value"
            set -- "$1=$2" "${@:3}"
            continue ;;
        --rep=*) rep=${1#*=} ;;
        --res=*) resolution=${1#*=} ;;
        --out=*) out=${1#*=} ;;
        -h | --help) usage; exit 0 ;;
        -*) usage >&2; fail "unknown flag $1" ;;
        *) scenes+=("$1") ;;
    esac
    shift
done
[[ $rep =~ ^[1-9][0-9]{0,5}$ ]] || fail "--rep=$rep: must be a whole number from 1 on"
[[ $resolution =~ ^[0-9]+,[0-9]+$ ]] || fail "--res=$resolution: must be W,H"
[ -n "$out" ] || fail "--out needs a folder"
[ ${#scenes[@]} -gt 0 ] || scenes=(trianglemesh both concentric clumped teapot)

nuvo_install "${nuvo_packages[@]}"
nuvo_build release nuvo
mkdir -p "$out"

for scene in "${scenes[@]}"; do
    rounds=$rep
    [ "$scene" != teapot ] || rounds=$((rep < 3 ? rep : 3))
    "$nuvo_root/build/release/nuvo" "--file=$nuvo_root/testfiles/$scene.x3d" --rep="$rounds" \
        --res="$resolution" "--study=$out/study-$scene.json" | tee "$out/study-$scene.txt"
    echo
    if python3 -c 'import matplotlib' 2>/dev/null; then
        python3 "$nuvo_root/scripts/report/plot_study.py" "$out/study-$scene.json" \
            --out "$out/study-$scene.png"
    fi
done
