#!/usr/bin/env bash
# nuvo beside Embree and POV-Ray, one thread: builds the preset "bench", writes the scenes, measures
# scene by scene and makes tables of it.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/bench_peers.sh [part]... [flag]...
Parts (all unless some are given):
  --scenes[=LIST]  frames, builds, single rays, price of exactness and threads of the thesis' scenes,
                   far and near; LIST: of teapot trianglemesh both concentric clumped, with commas
  --people         scenes like those people render, about 10^6 triangles each: terrain, interior, city from
                   the street and from above, assembly; a molecule; a ball on floors 10 to 10^6 times as wide
  --large          100,000 octahedra (800,000 triangles) and 1,000,000 spheres, far and near
  --growth         10^3 to 10^7 triangles
  --isa            every instruction set
  --povray         whole commands beside povray +WT1
  --kernels        Google Benchmark's view of the kernels
Flags:
  --quick          fewer rounds, nothing above 100,000 primitives
  --rounds=N       interleaved rounds of each scene (15; large scenes a third)
  --out=DIR        where scenes and results go (results/peers in the project)
  --docs           put the tables into docs/performance.md
  -h, --help       this text
Embree 4 is taken where it is installed (CMAKE_PREFIX_PATH=DIR in the environment tells where), 3.13 else.
TEXT
}

fail() {
    echo "bench_peers.sh: $1" >&2
    exit 2
}

out=$nuvo_root/results/peers rounds=15 quick=0 docs=0
scenes=(teapot trianglemesh both concentric clumped)
parts=()
while [ $# -gt 0 ]; do
    case $1 in
        --scenes=*)
            IFS=, read -ra scenes <<<"${1#*=}"
            parts+=(scenes) ;;
        --scenes | --people | --large | --growth | --isa | --povray | --kernels) parts+=("${1#--}") ;;
        --quick) quick=1 ;;
        --docs) docs=1 ;;
        --rounds=*) rounds=${1#*=} ;;
        --out=*) out=${1#*=} ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; fail "unknown flag $1" ;;
    esac
    shift
done
[[ $rounds =~ ^[1-9][0-9]{0,3}$ ]] || fail "--rounds=$rounds: must be a whole number from 1 on"
[ -n "$out" ] || fail "--out needs a folder"
[ ${#parts[@]} -gt 0 ] || parts=(scenes people large growth isa povray kernels)
[ $quick -eq 0 ] || rounds=$((rounds < 5 ? rounds : 5))
few=$(((rounds + 2) / 3))

nuvo_install "${nuvo_packages[@]}" libembree-dev libbenchmark-dev povray
nuvo_build bench
mkdir -p "$out/scenes" "$out/raw"
build=$nuvo_root/build/bench

# A scene of the generator, written once: scene FILE NAME [option]...; prints the path.
scene() {
    local file=$out/scenes/$1.x3d
    shift
    [ -s "$file" ] || "$build/testfile_generator" "$@" --out="$file"
    echo "$file"
}

# measure RESULT SCENE [option]...: one process, so that a peer that aborts takes nothing with it.
measure() {
    local result=$out/raw/$1.json file=$2
    shift 2
    echo "$(basename "$result" .json)" >&2
    if ! "$build/bench/nuvo_peers" --scene="$file" --json="$result.new" "$@"; then
        rm -f "$result.new"
        echo "  not measured" >&2
        return 0
    fi
    mv "$result.new" "$result"
}

run_scenes() {
    local name camera
    for name in "${scenes[@]}"; do
        measure "frame-$name-far" "$(scene "$name-far" "$name" --camera=far)" --rounds="$rounds"
        measure "frame-$name-near" "$(scene "$name-near" "$name" --camera=near)" \
            --rounds="$rounds" --parts=frame,check,exactness
    done
}

# people NAME SCENE [option]...: a scene of the part --people.
people() {
    local name=$1
    measure "people-$name" "$(scene "people-$name" "${@:2}")" --rounds=$few \
        --type=measured --parts=frame,check,rays,exactness
}

run_people() {
    local width large=1
    [ $quick -eq 0 ] || large=10
    people terrain terrain --count=$((1000000 / large))
    people interior interior --count=$((70 / large))
    people city-street city --count=$((90000 / large)) --camera=near
    people city-above city --count=$((90000 / large))
    people assembly assembly --count=$((36 / large))
    people molecule molecule --count=$((47681 / large))
    for width in 10 1000 100000 1000000; do people floor-$width floor --count=$width; done
}

run_large() {
    local camera
    [ $quick -eq 0 ] || return 0
    for camera in far near; do
        measure "frame-octahedra1e5-$camera" \
            "$(scene "octahedra1e5-$camera" octahedra --count=100000 --camera=$camera)" \
            --rounds=$few --parts=frame,check,rays,exactness
        measure "frame-spheres1e6-$camera" \
            "$(scene "spheres1e6-$camera" spheres --count=1000000 --camera=$camera)" \
            --rounds=$few --parts=frame,check,rays,exactness
    done
}

run_growth() {
    local count most=1250000 times
    [ $quick -eq 0 ] || most=12500
    for count in 125 1250 12500 125000 1250000; do
        [ $count -le $most ] || continue
        times=$few
        [ $count -lt 1250000 ] || times=1
        measure "growth-$count" "$(scene "octahedra-$count" octahedra --count=$count)" \
            --rounds="$times" --parts=frame,rays
        # Half a gigabyte of text is quickly written again.
        [ $count -lt 1250000 ] || rm -f "$out/scenes/octahedra-$count.x3d"
    done
}

run_isa() {
    local name isa
    for isa in avx512 avx2 sse4.2 sse2; do
        for name in "${scenes[@]}"; do
            measure "isa-$isa-$name" "$(scene "$name-far" "$name" --camera=far)" --isa=$isa \
                --rounds="$few" --parts=frame,check
        done
    done
}

run_povray() {
    local name file
    for name in "${scenes[@]}"; do
        file=$(scene "$name-far" "$name" --camera=far)
        echo "povray-$name-far" >&2
        "$build/bench/nuvo_peers" --scene="$file" --pov="$out/scenes/$name-far.pov"
        python3 "$nuvo_root/scripts/report/time_commands.py" --rounds="$few" \
            --json="$out/raw/povray-$name-far.json" \
            --command nuvo "$build/nuvo" "--file=$file" --profile=fast --rep=1 --quiet \
            "--out=$out/scenes/$name-nuvo.bmp" \
            --command povray povray +WT1 +W1920 +H1080 -D -GA -A +FB File_Gamma=1 "+I$out/scenes/$name-far.pov" \
            "+O$out/scenes/$name-povray.bmp"
    done
}

run_kernels() {
    echo kernels >&2
    (cd "$nuvo_root" &&
        "$build/bench/nuvo_kernels" --benchmark_min_time=0.2 --benchmark_out="$out/raw/kernels.json" \
            --benchmark_out_format=json --benchmark_format=console >"$out/kernels.txt")
}

for part in "${parts[@]}"; do "run_$part"; done

report=(python3 "$nuvo_root/scripts/report/peers.py" "$out"
    --commit "$(git -C "$nuvo_root" describe --always --dirty 2>/dev/null || echo unknown)"
    --compiler "$(c++ --version | head -1)")
[ $docs -eq 0 ] || report+=(--docs "$nuvo_root/docs/performance.md")
"${report[@]}"
