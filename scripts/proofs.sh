#!/usr/bin/env bash
# Proves the error bounds of proofs/*.g with Gappa; with --mutate also finds the least constants.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/proofs.sh [--mutate] [proof]...
  --mutate    change each constant by its step until its proof fails; it must fail within 100 steps
  -h          this list
Proofs are names in proofs/, without .g (all). A row each: the section of docs/numerics.md, the
proof, whether it holds; with --mutate a row for each constant, in the code and the least that can
be proved. Exit status 1 when a proof fails, or does not fail with a lesser constant.
TEXT
}

fail() {
    echo "proofs.sh: $1" >&2
    exit 2
}

# Whether Gappa proves the script on standard input. Second-order terms ask for more than its 60
# bits.
proves() { timeout 60 gappa -Eprecision=300 >/dev/null 2>&1; }

# "name value step" of each constant that a proof marks.
constants() {
    sed -nE 's/^([a-z_]+) = ([0-9]+);  # constant, step (-?1): .*$/\1 \2 \3/p' "$1"
}

# The last value, by steps from the code's own, with which the proof holds; none: it never fails.
least() {
    local file=$1 name=$2 value=$3 step=$4 i
    for ((i = 1; i <= 100; i++)); do
        if ! sed -E "s/^$name = $value;/$name = $((value + i * step));/" "$file" | proves; then
            echo $((value + (i - 1) * step))
            return
        fi
    done
}

mutate=false
names=()
for argument in "$@"; do
    case $argument in
        --mutate) mutate=true ;;
        -h | --help) usage; exit 0 ;;
        -*) usage >&2; fail "unknown flag $argument" ;;
        *) names+=("$argument") ;;
    esac
done
cd "$nuvo_root"
if [ ${#names[@]} -eq 0 ]; then
    for file in proofs/*.g; do names+=("$(basename "$file" .g)"); done
fi
for name in "${names[@]}"; do [ -f "proofs/$name.g" ] || fail "there is no proofs/$name.g"; done
command -v gappa >/dev/null || nuvo_install gappa

failures=0
if $mutate; then
    echo "| section | proof | constant | in the code | least | result |"
    echo "|---|---|---|---|---|---|"
else
    echo "| section | proof | result |"
    echo "|---|---|---|"
fi
for name in "${names[@]}"; do
    file=proofs/$name.g
    section=$(sed -nE 's/^# \[numerics: ([^]]+)\].*/\1/p' "$file" | head -n 1)
    result=proved
    proves <"$file" || result=FAILED
    [ $result = proved ] || failures=$((failures + 1))
    if ! $mutate; then
        echo "| $section | $name | $result |"
        continue
    fi
    while read -r constant value step; do
        lowest=
        [ $result = FAILED ] || lowest=$(least "$file" "$constant" "$value" "$step")
        row=$result
        if [ $result = proved ] && [ -z "$lowest" ]; then
            row="NEVER FAILS"
            failures=$((failures + 1))
        fi
        echo "| $section | $name | $constant | $value | ${lowest:--} | $row |"
    done <<<"$(constants "$file")"
done
[ $failures -eq 0 ] || { echo "$failures failed" >&2; exit 1; }
