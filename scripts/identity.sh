#!/usr/bin/env bash
# The fast profile against the exact one, byte by byte, through the program: every scene of
# testfiles with every instruction set of the machine, both octrees and several numbers of threads,
# and -compare=brute against the serial tracer and brute force. One line a scene; exit status 1 where a
# picture differs.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/identity.sh [flag]... [scene]...
  --res=W,H     size of the pictures (240,135)
  --threads=... numbers of threads, separated by commas (1,2,7)
  -h            this list
Scenes are files; none given: all of testfiles.
TEXT
}

fail() {
    echo "identity.sh: $1" >&2
    exit 2
}

resolution=240,135 threads=1,2,7
scenes=()
while [ $# -gt 0 ]; do
    case $1 in
        --res | --threads)
            [ $# -ge 2 ] || fail "$1 needs a value"
            set -- "$1=$2" "${@:3}"
            continue ;;
        --res=*) resolution=${1#*=} ;;
        --threads=*) threads=${1#*=} ;;
        -h | --help) usage; exit 0 ;;
        -*) usage >&2; fail "unknown flag $1" ;;
        *) scenes+=("$1") ;;
    esac
    shift
done
[[ $resolution =~ ^[0-9]+,[0-9]+$ ]] || fail "--res=$resolution: must be W,H"
[[ $threads =~ ^[0-9]+(,[0-9]+)*$ ]] || fail "--threads=$threads: must be numbers and commas"
IFS=, read -ra threads <<<"$threads"
[ ${#scenes[@]} -gt 0 ] ||
    mapfile -t scenes < <(find "$nuvo_root/testfiles" -name '*.x3d' | sort)

nuvo_install "${nuvo_packages[@]}"
nuvo_build release nuvo
nuvo=$nuvo_root/build/release/nuvo
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The instruction sets that the program's table lists and this machine has.
instruction_sets=()
for isa in $("$nuvo" -h | sed -n 's/^ *--isa=//p' | tr '|' ' '); do
    "$nuvo" --file="${scenes[0]}" --res=1,1 --rep=1 --profile=fast --isa="$isa" --quiet \
        --out="$work/probe.bmp" 2>/dev/null && instruction_sets+=("$isa")
done
[ ${#instruction_sets[@]} -gt 0 ] || fail "the program renders with no instruction set"
echo "instruction sets ${instruction_sets[*]}; threads ${threads[*]}; $resolution pixels"

# picture NAME FLAG...: renders the scene.
picture() {
    "$nuvo" --file="$scene" --res="$resolution" --rep=1 --quiet --out="$work/$1.bmp" "${@:2}" \
        2>/dev/null
}

status=0
for scene in "${scenes[@]}"; do
    faults=() pictures=0
    rm -f "$work"/*.bmp
    picture exact --profile=exact || faults+=("--profile=exact gave no picture")
    for isa in "${instruction_sets[@]}"; do
        for type in uniform nonuniform; do
            for count in "${threads[@]}"; do
                flags=(--isa="$isa" --type="$type" --threads="$count")
                pictures=$((pictures + 1))
                picture fast --profile=fast "${flags[@]}" &&
                    cmp -s "$work/exact.bmp" "$work/fast.bmp" || faults+=("${flags[*]}")
            done
        done
    done
    picture compare -compare=brute --profile=fast || faults+=("-compare=brute")
    if [ ${#faults[@]} -eq 0 ]; then
        printf '%-44s %d pictures and -compare=brute: 0 differing pixels\n' "${scene#"$nuvo_root"/}" \
            "$pictures"
    else
        printf '%-44s DIFFERS: %s\n' "${scene#"$nuvo_root"/}" "$(IFS=';'; echo "${faults[*]}")"
        status=1
    fi
done
exit $status
