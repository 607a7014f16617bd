#!/usr/bin/env bash
# The study of midpoints: every figure of docs/midpoint-study.md.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/study_midpoints.sh [flag]...
  --quick       smaller pictures and fewer rounds: under ten minutes on two cores
  --out=DIR     where the results go (results/midpoints in the project)
  --build=DIR   a build tree with NUVO_STUDY=ON (build/study, which is made if need be)
  --docs        put tables and plots into docs/
  -h            this list
Leaves runs/*.json, tables.md and plots as SVG.
TEXT
}

fail() {
    echo "study_midpoints.sh: $1" >&2
    exit 2
}

resolution=480,270 rounds=7 rays=20000 count=1000 voxels=1000 floors='8 30 125 600 2500' docs=
out=$nuvo_root/results/midpoints build=
for argument in "$@"; do
    case $argument in
        --quick) resolution=240,135 rounds=3 rays=5000 voxels=400 floors='30 600' ;;
        --out=*) out=${argument#*=} ;;
        --build=*) build=${argument#*=} ;;
        --docs) docs=1 ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; fail "unknown flag $argument" ;;
    esac
done
[ -n "$out" ] || fail "--out needs a folder"
if [ -z "$build" ]; then
    nuvo_install "${nuvo_packages[@]}"
    nuvo_build study nuvo_study testfile_generator
    build=$nuvo_root/build/study
fi
program=$build/study/nuvo_study generator=$build/testfile_generator
for file in "$program" "$generator"; do [ -x "$file" ] || fail "$file: is not there"; done
mkdir -p "$out/scenes" "$out/runs"

# Chosen on: the author's four and the teapot. All others are held out.
scenes=(trianglemesh both concentric clumped teapot)
for scene in "${scenes[@]}"; do cp "$nuvo_root/testfiles/$scene.x3d" "$out/scenes/"; done
for family in aisles drift stadium sticks sizes; do
    for seed in 0 1 2 3 4; do
        "$generator" $family --count=$count --seed=$seed --out="$out/scenes/$family-$seed.x3d"
        scenes+=("$family-$seed")
    done
done
# A ball on ever wider floors: the stadium as a mesh.
for width in $floors; do
    "$generator" floor --count=$width --out="$out/scenes/floor-$width.x3d"
    scenes+=("floor-$width")
done
"$generator" terrain --count=20000 --out="$out/scenes/terrain.x3d"
"$generator" assembly --count=1 --out="$out/scenes/assembly.x3d"
scenes+=(terrain assembly)

measure() {  # SETTING SCENE [option]...
    local setting=$1 scene=$2
    shift 2
    "$program" --file="$out/scenes/$scene.x3d" --res=$resolution --rays=$rays "$@" \
        >"$out/runs/$scene.$setting.json.tmp"
    mv "$out/runs/$scene.$setting.json.tmp" "$out/runs/$scene.$setting.json"
}

timed=spatial,median,published,mlsl-lds-sbplx,octree-r,eq19-voxel,sweep,eight-child,look-ahead,hybrid,pruned
for scene in "${scenes[@]}"; do
    echo "$scene"
    case $scene in floor-* | *-[0134]) ;; *)
        # Counts of every method, alone, and how far each is from the optimum.
        measure alone "$scene" --rounds=0 --gap=$voxels ;;
    esac
    # As the program builds, timed, beside the other structures.
    case $scene in floor-*) times=1 ;; *) times=$rounds ;; esac
    measure program "$scene" --in-program --rounds=$times --methods=$timed --others
done
for scene in trianglemesh both concentric clumped; do
    measure thesis "$scene" --rounds=0 --leaves=shapes --costs=thesis
    measure shapes "$scene" --rounds=0 --leaves=shapes
done

python3 "$nuvo_root/scripts/report/midpoints.py" "$out" ${docs:+--docs "$nuvo_root/docs"}
