#!/usr/bin/env bash
# What a change costs: a base beside the head on small scenes, by exact counts of instructions
# (valgrind) and by processor time, both programs in turn. Exit status 1 where the head executes more
# than was allowed.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/bench_guard.sh BASE [flag]...
  BASE         a commit, which is built below build/guard, or a program
  --head=FILE  the program to judge (build/release/nuvo, which is built)
  --rounds=N   runs of each program for the median of processor times (9)
  --most=R     allowed instructions, head / base (1.02)
  -h           this list
TEXT
}

fail() {
    echo "bench_guard.sh: $1" >&2
    exit 2
}

base='' head='' rounds=9 most=1.02
while [ $# -gt 0 ]; do
    case $1 in
        --head=*) head=${1#*=} ;;
        --rounds=*) rounds=${1#*=} ;;
        --most=*) most=${1#*=} ;;
        -h | --help) usage; exit 0 ;;
        -*) usage >&2; fail "unknown flag $1" ;;
        *) [ -z "$base" ] || fail "one BASE"; base=$1 ;;
    esac
    shift
done
[ -n "$base" ] || { usage >&2; exit 2; }
[[ $rounds =~ ^[1-9][0-9]{0,2}$ ]] || fail "--rounds=$rounds: must be a whole number from 1 on"
[[ $most =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "--most=$most: must be a number"

commit=
[ -x "$base" ] || commit=$(git -C "$nuvo_root" rev-parse --verify --quiet "$base^{commit}") ||
    fail "$base: neither a program nor a commit"

nuvo_install "${nuvo_packages[@]}" valgrind git
if [ -z "$head" ]; then
    nuvo_build release nuvo
    head=$nuvo_root/build/release/nuvo
fi
[ -x "$head" ] || fail "$head: no program"
if [ -n "$commit" ]; then
    guard=$nuvo_root/build/guard/${commit:0:12}
    if [ ! -d "$guard/source" ]; then
        mkdir -p "$guard/new"
        git -C "$nuvo_root" archive "$commit" | tar -x -C "$guard/new"
        mv "$guard/new" "$guard/source"
    fi
    (cd "$guard/source" &&
        nuvo_quietly cmake --preset release -B "$guard/build" -DNUVO_TESTS=OFF)
    nuvo_watch_quietly "building $base" ninja -C "$guard/build" nuvo
    base=$guard/build/nuvo
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Scene and flags; pictures small, since valgrind is fifty times as slow.
cases=(
    "teapot --describe"
    "both --profile=exact --res=64,36 --rep=1"
    "teapot --profile=fast --res=320,180 --rep=1"
    "concentric --profile=fast --res=320,180 --rep=1"
    "clumped --profile=fast --type=nonuniform --res=160,90 --rep=1"
)

run() { # run PROGRAM SCENE [flag]...
    local program=$1 scene=$2
    shift 2
    local options=("--file=$nuvo_root/testfiles/$scene" "$@")
    [[ " $* " == *" --describe "* ]] || options+=("--out=$work/picture.bmp")
    "${before[@]}" "$program" "${options[@]}" >/dev/null
}
instructions() {
    local before=(valgrind --tool=callgrind --callgrind-out-file=/dev/null)
    run "$@" 2>&1 | awk '/Collected/ { print $NF }'
}
milliseconds() {
    local before=() TIMEFORMAT='%3U %3S'
    { time run "$@" 2>/dev/null; } 2>&1 | awk '{ print 1000 * ($1 + $2) }'
}
median() { sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

status=0
printf '%-62s %14s %14s %6s   %7s %7s %6s\n' case 'instructions' head ratio ms head ratio
for words in "${cases[@]}"; do
    read -ra one <<<"$words"
    counted=("$(instructions "$base" "${one[@]}")" "$(instructions "$head" "${one[@]}")")
    : >"$work/base"
    : >"$work/head"
    : >"$work/ratio"
    for ((i = 0; i < rounds; ++i)); do
        first=$(milliseconds "$base" "${one[@]}")
        second=$(milliseconds "$head" "${one[@]}")
        echo "$first" >>"$work/base"
        echo "$second" >>"$work/head"
        awk "BEGIN { print $second / ($first > 0 ? $first : 1) }" >>"$work/ratio"
    done
    printf '%-62s %14s %14s %6.3f   %7.1f %7.1f %6.2f\n' "$words" "${counted[@]}" \
        "$(awk "BEGIN { print ${counted[1]} / ${counted[0]} }")" \
        "$(median <"$work/base")" "$(median <"$work/head")" "$(median <"$work/ratio")"
    awk "BEGIN { exit !(${counted[1]} > $most * ${counted[0]}) }" && status=1
done
[ $status -eq 0 ] || echo "bench_guard.sh: more than $most times the base's instructions" >&2
exit $status
