#!/usr/bin/env bash
# Checks the directions of #include between the rooms, how many files the fast tracer's folders
# hold, and that each third-party library is included in exactly one .cpp (Highway, which kernels
# are written in, in src/render/fast only):
# scripts/check_layers.sh [root of the project]
set -euo pipefail
cd -- "${1:-$(dirname -- "${BASH_SOURCE[0]}")/..}"

# A room and what it may see beside itself. octree sees only math.
declare -A may_see=(
    [math]=""
    [geometry]="math"
    [octree]="math"
    [image]="math"
    [scene]="math geometry"
    [render]="math geometry octree image scene"
    [app]="math geometry octree image scene render"
)
# The folders of the fast tracer, lowest first: each sees itself and those before it.
fast_folders=(simd scene tile camera primary light shadow shading rays frame)
most_files=15  # in one of them
# A library's headers and the one room that may include them.
libraries=(
    "boost/property_tree scene"
    "nlopt octree"
    "boost/chrono app"
    "boost/program_options app"
    "zlib scene"
    "png image"
    "geos_c scene"
)
include='^[[:space:]]*#[[:space:]]*include[[:space:]]*'
faults=0

fault() {
    echo "$1"
    faults=$((faults + 1))
}

for room in $(ls include/nuvo src | grep -v : | sort -u); do
    if [ -z "${may_see[$room]+known}" ]; then
        fault "$room: a room that scripts/check_layers.sh does not know"
        continue
    fi
    for folder in "include/nuvo/$room" "src/$room"; do
        [ -d "$folder" ] || continue
        while IFS=: read -r file line text; do
            [ -n "$file" ] || continue
            seen=$(sed -E 's|.*"nuvo/([^/"]+)/.*|\1|' <<<"$text")
            case " $room ${may_see[$room]} " in
                *" $seen "*) ;;
                *) fault "$file:$line: $room must not include $seen" ;;
            esac
        done <<<"$(grep -rnE "$include\"nuvo/" "$folder" || true)"
        # Not through the back door of another room's private headers either.
        while IFS=: read -r file line _; do
            [ -z "$file" ] || fault "$file:$line: includes by a path with .."
        done <<<"$(grep -rnE "$include\"[^\"]*\.\./" "$folder" || true)"
    done
done

below=""
for folder in "${fast_folders[@]}"; do
    below+=" $folder"
    [ -d "src/render/fast/$folder" ] || continue
    files=$(find "src/render/fast/$folder" -type f | wc -l)
    [ "$files" -le $most_files ] ||
        fault "src/render/fast/$folder: $files files, more than $most_files"
    while IFS=: read -r file line text; do
        [ -n "$file" ] || continue
        seen=$(sed -E 's|.*"fast/([^/"]+)/.*|\1|' <<<"$text")
        case "$below " in
            *" $seen "*) ;;
            *) fault "$file:$line: src/render/fast/$folder must not include $seen" ;;
        esac
    done <<<"$(grep -rnE "$include\"fast/" "src/render/fast/$folder" || true)"
done

for entry in "${libraries[@]}"; do
    read -r header room <<<"$entry"
    users=()
    for file in $(grep -rlE "$include<$header[/.]" include src main.cpp | sort); do users+=("$file"); done
    case ${#users[@]} in
        1)
            case ${users[0]} in
                "src/$room/"*.cpp) ;;
                *) fault "${users[0]}: <$header> belongs in a .cpp of src/$room" ;;
            esac ;;
        *) fault "<$header> must be included in exactly one .cpp, not ${#users[@]}: ${users[*]}" ;;
    esac
done

while IFS=: read -r file line _; do
    case $file in
        "" | src/render/fast/*) ;;
        *) fault "$file:$line: <hwy> belongs in src/render/fast" ;;
    esac
done <<<"$(grep -rnE "$include<hwy/" include src main.cpp || true)"

known=$(printf '%s\n' "${libraries[@]}" | cut -d' ' -f1 | paste -sd'|')
while IFS=: read -r file line text; do
    [ -z "$file" ] ||
        fault "$file:$line: a third-party header that scripts/check_layers.sh does not know: $text"
done <<<"$(grep -rnE "$include<(boost|nlopt|nlohmann|zlib|geos|gtest|gmock|png|tbb)" include src main.cpp |
    grep -vE "<($known)[/.]" || true)"

[ $faults -eq 0 ] || exit 1
