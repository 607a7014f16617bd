#!/usr/bin/env bash
# Lines and branches that the tests run, by folder: scripts/coverage.sh [room]... (rooms of tests/,
# default: all that are quick). clang's counters of source regions; one instruction set. The files with most
# branches not taken follow, and build/coverage/lines.txt shows each line with its count.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

rooms=("$@")
[ $# -gt 0 ] || rooms=(math geometry octree scene image render app property cli)
nuvo_install "${nuvo_packages[@]}" clang libclang-rt-dev llvm
build=$nuvo_root/build/coverage
nuvo_quietly cmake -S "$nuvo_root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_CXX_COMPILER=clang++ "-DCMAKE_CXX_FLAGS=-O1 -DNDEBUG -fprofile-instr-generate -fcoverage-mapping" \
    -DNUVO_DISABLED_TARGETS='HWY_SSSE3|HWY_SSE4|HWY_AVX2|HWY_AVX3|HWY_AVX3_DL'
nuvo_watch_quietly "Building with counters" ninja -C "$build" nuvo testfile_generator "${rooms[@]/%/_tests}"

rm -rf "$build/counts"
mkdir "$build/counts"
export LLVM_PROFILE_FILE=$build/counts/%p-%m.profraw
objects=()
for room in "${rooms[@]}"; do
    # A test of speed may fail here; what it ran counts all the same.
    "$build/tests/${room}_tests" --gtest_brief=1 >"$build/$room.log" 2>&1 || echo "$room: see $build/$room.log"
    objects+=(-object "$build/tests/${room}_tests")
done
find "$build/counts" -name '*.profraw' >"$build/counts/list"
llvm-profdata merge -sparse -f "$build/counts/list" -o "$build/all.profdata"
rm -rf "$build/counts"
what=("$build/nuvo" "${objects[@]}" -instr-profile "$build/all.profdata" "$nuvo_root/src" "$nuvo_root/include")
llvm-cov export -summary-only "${what[@]}" >"$build/summary.json"
llvm-cov show -show-branches=count -show-instantiations=false "${what[@]}" >"$build/lines.txt" 2>/dev/null

python3 - "$build/summary.json" "$nuvo_root" <<'PYTHON'
import collections, json, os, sys
files = json.load(open(sys.argv[1]))["data"][0]["files"]
folders = collections.defaultdict(lambda: [0, 0, 0, 0])
missing = []
for file in files:
    name = os.path.relpath(file["filename"], sys.argv[2])
    if not name.startswith(("src/", "include/")):
        continue
    part = "/".join(p for p in name.split("/")[:-1] if p not in ("src", "include", "nuvo"))
    if part.startswith("render/fast"):
        part = "render/fast"
    counts = [file["summary"][kind][what] for kind in ("lines", "branches") for what in ("covered", "count")]
    folders[part] = [a + b for a, b in zip(folders[part], counts)]
    missing.append((counts[3] - counts[2], counts[1] - counts[0], name))
print("| folder | lines | branches |\n|---|---|---|")
def cell(covered, count):
    return f"{covered} of {count}, {100 * covered / max(count, 1):.1f} %"
for part, c in sorted(folders.items()):
    print(f"| {part} | {cell(c[0], c[1])} | {cell(c[2], c[3])} |")
print("\nfiles with most branches not taken (branches, lines):")
for branches, lines, name in sorted(missing, reverse=True)[:25]:
    print(f"{branches:5} {lines:5}  {name}")
PYTHON
