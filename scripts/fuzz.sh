#!/usr/bin/env bash
# Random scenes and rays through every pipeline, which must agree to the byte, and random bytes to
# the loader, --rays and the command line: scripts/fuzz.sh MINUTES [SEED]. Without a SEED one is
# chosen; it is printed. Findings are made small and left in fuzz-results/SEED; the exit status is 1
# where there are any. Three quarters of the time are for scenes, on every core.
# --no-bytes leaves libFuzzer out, which needs clang.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

bytes=yes words=()
for argument in "$@"; do
    case $argument in
        --no-bytes) bytes=no ;;
        -*) echo "fuzz.sh: no flag $argument" >&2; exit 2 ;;
        *) words+=("$argument") ;;
    esac
done
minutes=${words[0]:-} seed=${words[1]:-$((RANDOM * 32768 + RANDOM))}
[[ $minutes =~ ^[1-9][0-9]*$ && $seed =~ ^[0-9]+$ && ${#words[@]} -le 2 ]] ||
    { echo "usage: scripts/fuzz.sh [--no-bytes] MINUTES [SEED]" >&2; exit 2; }
[ $bytes = no ] || nuvo_check_proc "--no-bytes"
seconds=$((minutes * 60))
results=$nuvo_root/fuzz-results/$seed
mkdir -p "$results"
echo "seed $seed, results in $results"

nuvo_install "${nuvo_packages[@]}"
nuvo_build release scene_fuzz
status=0
scene_seconds=$seconds
[ $bytes = no ] || scene_seconds=$((seconds * 3 / 4))
"$nuvo_root/build/release/tests/scene_fuzz" --minutes="$(awk "BEGIN { print $scene_seconds / 60 }")" \
    --seed="$seed" --jobs="$(nproc)" --results="$results" || status=1
[ $bytes = yes ] || exit $status

nuvo_install clang libclang-rt-dev # its sanitizers and libFuzzer
nuvo_build fuzz fuzz_scene fuzz_rays fuzz_options
for target in scene rays options; do
    log=$results/$target.log
    mkdir -p "$results/corpus-$target"
    # The first folder takes what is new. A finding ends the run and is left as a file.
    if "$nuvo_root/build/fuzz/tests/fuzz_$target" -seed=$((seed % 4294967295 + 1)) \
        -max_total_time=$((seconds / 12)) -max_len=20000 -timeout=10 -rss_limit_mb=3000 \
        -print_final_stats=1 -artifact_prefix="$results/$target-" "$results/corpus-$target" \
        "$nuvo_root/tests/fuzz/corpus/$target" >"$log" 2>&1; then
        echo "$target bytes: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions, nothing found"
    else
        echo "$target bytes: a finding, see $log"
        status=1
    fi
done
exit $status
