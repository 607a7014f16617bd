#!/usr/bin/env bash
# The thesis' octree tests [thesis 5.7-5.8]: four scenes, both octree types, two profiles, and the
# published figures beside ours, each time with the error of its picture. Leaves results.json, results.csv, the
# raw reports and, where Python has what it takes, index.html in a folder.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/alltests.sh [flag]...
  --rep=N     repetitions of each scene and type (100, as the thesis)
  --quick     3 repetitions
  --base      the teapot, too: 15 repetitions where the others have 100, and in proportion
  --no-look   neither planes and octrees of each scene nor the study of speed against error
  --res=W,H   size of the pictures (1920,1080, as the thesis)
  --out=DIR   where the results go (results/ in the project)
  -h          this list
TEXT
}

fail() {
    echo "alltests.sh: $1" >&2
    exit 2
}

rep=100 base=no look=yes resolution=1920,1080 out=$nuvo_root/results
while [ $# -gt 0 ]; do
    case $1 in
        --rep | --res | --out)
            [ $# -ge 2 ] || fail "$1 needs a value"
            set -- "$1=$2" "${@:3}"
            continue ;;
        --rep=*) rep=${1#*=} ;;
        --res=*) resolution=${1#*=} ;;
        --out=*) out=${1#*=} ;;
        --quick) rep=3 ;;
        --no-look) look=no ;;
        --base) base=yes ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; fail "unknown flag $1" ;;
    esac
    shift
done
[[ $rep =~ ^[1-9][0-9]{0,5}$ ]] || fail "--rep=$rep: must be a whole number from 1 on"
[[ $resolution =~ ^[0-9]+,[0-9]+$ ]] || fail "--res=$resolution: must be W,H"
[ -n "$out" ] || fail "--out needs a folder"
command -v python3 >/dev/null ||
    fail "python3 makes the tables and is not installed (apt-get install python3)"

nuvo_install "${nuvo_packages[@]}"
nuvo_build release nuvo
mkdir -p "$out/raw" "$out/look"
out=$(cd -- "$out" && pwd)
rm -rf "$out"/raw/*.json "$out"/look/* "$out"/study-*.json

settings=("thesis --profile=thesis" "exact --profile=exact")
scenes=(trianglemesh both concentric clumped)
[ $base = no ] || scenes=(teapot "${scenes[@]}")

# A higher priority where it is allowed, as the thesis. [thesis 5.7.1]
priority=()
[ -n "$(nice -n -10 true 2>&1)" ] || priority=(nice -n -10)

# measure SETTING SCENE TYPE ROUND REPETITIONS: one process and its report; the first round tells
# the error, too.
measure() {
    local name flags
    read -r name flags <<<"$1"
    [ "$4" != 0 ] || flags+=" --error"
    # shellcheck disable=SC2086 # the flags are words
    "${priority[@]}" "$nuvo_root/build/release/nuvo" "--file=$nuvo_root/testfiles/$2.x3d" \
        --type="$3" --rep="$5" --res="$resolution" $flags --out=/dev/null --quiet \
        --json="$out/raw/$name-$2-$3-$4.json"
}

# The repetitions are spread over rounds in which the types alternate, first one ahead and then the
# other, so that a machine that slows down does so for both. Each round counts once more than it
# times, so the teapot, whose single pass takes minutes, has one round.
for scene in "${scenes[@]}"; do
    for setting in "${settings[@]}"; do
        total=$rep
        rounds=$((total < 10 ? total : 10))
        if [ "$scene" = teapot ]; then
            total=$(((rep * 15 + 99) / 100))
            rounds=1
        fi
        for ((round = 0; round < rounds; ++round)); do
            [ ! -t 2 ] || printf '\r%-60s' "$scene ${setting%% *} $((round + 1))/$rounds" >&2
            share=$(((total * (round + 1)) / rounds - (total * round) / rounds))
            types=(uniform nonuniform)
            ((round % 2 == 0)) || types=(nonuniform uniform)
            for type in "${types[@]}"; do
                measure "$setting" "$scene" "$type" "$round" "$share"
            done
        done
    done
done
# What the pictures cost and what the octrees look like, the dearest rays of each, the thesis
# profile's picture and what is right of it, and speed against error: for the page.
look_at() {
    local scene=$1 type=$2 name=$out/look/$1-$2
    local flags=("--file=$nuvo_root/testfiles/$scene.x3d" --type="$type" --res=384,216 --rep=1 --quiet)
    "$nuvo" "${flags[@]}" --planes="$name" --octree="$name-octree.json" --out="$name.png" \
        --json="$name.json"
    python3 "$nuvo_root/scripts/report/trace_rays.py" 20 "$name" "$out/look/rays/$scene-$type.json" \
        "$nuvo" "${flags[@]}"
    "$nuvo" "${flags[@]}" --profile=thesis --out="$name-thesis.bmp"
    "$nuvo" "${flags[@]}" --defaults=thesis --back-faces=draw --out="$name-right.bmp"
}
nuvo=$nuvo_root/build/release/nuvo
if [ $look = yes ]; then
    for scene in "${scenes[@]}"; do
        [ "$scene" != teapot ] || continue
        [ ! -t 2 ] || printf '\r%-60s' "$scene: planes and octrees" >&2
        for type in uniform nonuniform; do look_at "$scene" $type; done 2>/dev/null
    done
    [ ! -t 2 ] || printf '\r%-60s' "both: speed against error" >&2
    "$nuvo" "--file=$nuvo_root/testfiles/both.x3d" --type=nonuniform --res=192,108 \
        --rep=$((rep < 5 ? rep : 5)) --quiet "--study=$out/study-both.json"
fi
[ ! -t 2 ] || printf '\r%-60s\r' "" >&2

commit=$(git -C "$nuvo_root" rev-parse --short HEAD 2>/dev/null || echo unknown)
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$nuvo_root/build/release/CMakeCache.txt")
python3 "$nuvo_root/scripts/report/tables.py" "$out" --commit "$commit" \
    --compiler "$("$compiler" --version | head -n 1)" --priority "${priority[*]:-default}"
"$nuvo_root/scripts/report.sh" "$out" || true  # says what is missing
