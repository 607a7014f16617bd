#!/usr/bin/env bash
# Counts intersection tests and voxel searches as the thesis did [thesis 5.7.1]: as calls of the
# functions that do them, by valgrind's callgrind, in a build that keeps these calls. They must
# equal the counts of --counters, call for call.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/callgrind.sh [flag]... [scene]...
  --res=W,H   size of the pictures (96,54)
  -h          this list
Scenes are names in testfiles/ (trianglemesh both concentric clumped). Exit code 1 where callgrind
and the counters disagree.
TEXT
}

resolution=96,54 scenes=()
while [ $# -gt 0 ]; do
    case $1 in
        --res=*) resolution=${1#*=} ;;
        -h | --help) usage; exit 0 ;;
        -*) usage >&2; echo "callgrind.sh: unknown flag $1" >&2; exit 2 ;;
        *) scenes+=("$1") ;;
    esac
    shift
done
[[ $resolution =~ ^[0-9]+,[0-9]+$ ]] || { echo "callgrind.sh: --res=W,H" >&2; exit 2; }
[ ${#scenes[@]} -gt 0 ] || scenes=(trianglemesh both concentric clumped)

nuvo_install "${nuvo_packages[@]}" valgrind
build=$nuvo_root/build/callgrind
# Nothing is inlined, so that every call is one; the tile tracer is not asked and built once only.
nuvo_quietly cmake -S "$nuvo_root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE="-O1 -fno-inline -DNDEBUG" -DNUVO_TESTS=OFF \
    '-DNUVO_DISABLED_TARGETS=HWY_SSSE3|HWY_SSE4|HWY_AVX2|HWY_AVX3|HWY_AVX3_DL'
nuvo_quietly ninja -C "$build" nuvo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# calls FILE PATTERN: how often functions whose name matches were called, without their lambdas.
calls() {
    awk -v pattern="$2" '
        /^c?fn=/ {
            line = $0
            sub(/^c?fn=/, "", line)
            id = line
            sub(/ .*/, "", id)
            if (index(line, " ")) names[id] = substr(line, index(line, " ") + 1)
            if ($0 ~ /^cfn=/) callee = id
        }
        /^calls=/ {
            count = substr($1, 7)
            if (names[callee] ~ pattern && names[callee] !~ /lambda/) sum += count
        }
        END { print sum + 0 }' "$1"
}

status=0
for scene in "${scenes[@]}"; do
    for type in uniform nonuniform; do
        flags=("--file=$nuvo_root/testfiles/$scene.x3d" --profile=thesis --type=$type --rep=1
            --res="$resolution" --out=/dev/null --quiet)
        "$build/nuvo" "${flags[@]}" --json="$work/counts.json" 2>/dev/null
        valgrind --tool=callgrind --callgrind-out-file="$work/out" "$build/nuvo" "${flags[@]}" \
            2>"$work/log" || { cat "$work/log" >&2; exit 1; }
        counted=$(tr -d ' \n' <"$work/counts.json" |
            sed -E 's/.*"intersection_tests":([0-9]+),"voxel_searches":([0-9]+).*/\1 \2/')
        # One call of the kernel for one ray and one item of a leaf; one call of next.
        called="$(calls "$work/out" '^nuvo::PlainKernel<float>::(closest|shadow_t)\(') $(
            calls "$work/out" '^nuvo::NudgedWalk<float, nuvo::HashLocator>::next\(')"
        verdict=equal
        [ "$counted" = "$called" ] || verdict=DIFFERENT status=1
        printf '%-14s %-11s counters %s, callgrind %s: %s\n' "$scene" "$type" "$counted" \
            "$called" "$verdict"
    done
done
exit $status
