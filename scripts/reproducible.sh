#!/usr/bin/env bash
# The same commit built in two folders gives the same program, byte by byte: scripts/reproducible.sh
# [cmake option]..., such as -DNUVO_DISABLED_TARGETS='HWY_SSE4|HWY_AVX2' for a shorter build. Compiles
# everything twice, without a compiler cache. Exit status 1 where the programs differ.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

case ${1:-} in
    -h | --help) sed -n '2,4s/^# //p' "${BASH_SOURCE[0]}"; exit 0 ;;
esac
nuvo_install "${nuvo_packages[@]}"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export CCACHE_DISABLE=1
commit=$(git -C "$nuvo_root" rev-parse HEAD)
for folder in one "a longer name of a folder"; do
    git clone -q "$nuvo_root" "$scratch/$folder/nuvo"
    git -C "$scratch/$folder/nuvo" checkout -q --detach "$commit"  # there may be another by now
    (
        cd "$scratch/$folder/nuvo"
        nuvo_quietly cmake --preset release "$@"
        nuvo_quietly ninja -C build/release nuvo
    )
done
cd "$scratch"
sha256sum one/nuvo/build/release/nuvo "a longer name of a folder/nuvo/build/release/nuvo"
cmp one/nuvo/build/release/nuvo "a longer name of a folder/nuvo/build/release/nuvo"
echo "the same program"
