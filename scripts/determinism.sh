#!/usr/bin/env bash
# The same scene gives the same picture, octree, figures and answers to rays, byte by byte, whatever the
# run, threads, instruction set, locale, time zone, folder, compiler and processor: one line each, exit status 1
# where one differs. docs/reliability.md holds results.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/determinism.sh [flag]...
  --quick          what needs no other build
  --runs=N         runs of the first row (100)
  --program=FILE   the program (build/release/nuvo, built if none is given)
  --beside=FILE    another build to hold beside it; any number of times
  -h               this list
Other builds, each with one wide instruction set and the portable one: clang, debug by g++ and by clang.
ARM64 is among them where scripts/arm64.sh has made build/arm64/nuvo.
TEXT
}

quick= runs=100 nuvo= builds=()
while [ $# -gt 0 ]; do
    case $1 in
        --quick) quick=yes ;;
        --runs=*) runs=${1#*=} ;;
        --program=*) nuvo=$(realpath -- "${1#*=}") ;;
        --beside=*) builds+=("${1#*=}=$(realpath -- "${1#*=}")") ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; echo "determinism.sh: unknown flag $1" >&2; exit 2 ;;
    esac
    shift
done
[[ $runs =~ ^[1-9][0-9]*$ ]] || { echo "determinism.sh: --runs=$runs: must be a number" >&2; exit 2; }
if [ -z "$nuvo" ]; then
    nuvo_install "${nuvo_packages[@]}"
    nuvo_build release nuvo
    nuvo=$nuvo_root/build/release/nuvo
fi

# other_build NAME TYPE COMPILER: adds NAME=PROGRAM to the list of builds.
other_build() {
    local build=$nuvo_root/build/$1
    nuvo_quietly cmake -S "$nuvo_root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="$2" -DCMAKE_CXX_COMPILER="$3" \
        -DNUVO_TESTS=OFF -DNUVO_DISABLED_TARGETS='HWY_SSSE3|HWY_SSE4|HWY_AVX2|HWY_AVX3_DL'
    nuvo_watch_quietly "Building $1" ninja -C "$build" nuvo
    builds+=("$3, $2=$build/nuvo")
}
if [ -z "$quick" ]; then
    nuvo_install clang
    other_build same-clang-release Release clang++
    other_build same-g++-debug Debug g++
    other_build same-clang-debug Debug clang++
    if [ -x "$nuvo_root/build/arm64/nuvo" ] && command -v qemu-aarch64-static >/dev/null; then
        builds+=("ARM64 under qemu=qemu-aarch64-static $nuvo_root/build/arm64/nuvo")
    else
        echo "ARM64: left out, scripts/arm64.sh has not made build/arm64/nuvo"
    fi
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for locale in de_DE ar_EG; do
    localedef -i $locale -f UTF-8 "$work/$locale.UTF-8" 2>/dev/null || true
done

python3 - "$nuvo_root" "$work" "$runs" "$nuvo" "${builds[@]}" <<'PYTHON'
import hashlib, json, os, pathlib, random, shutil, subprocess, sys

root, work, runs, program = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
SCENES = ["both", "clumped", "concentric", "figure25", "icosphere", "showcase"]
PROFILES = {"exact": [], "exact, non-uniform": ["--type=nonuniform"],
            "thesis": ["--profile=thesis", "--type=nonuniform"], "fast": ["--profile=fast"]}
OUTPUTS = {"picture": "a.bmp", "octree": "octree.json", "counts": "figures.json", "rays": "answers.txt"}
COLUMNS = [*OUTPUTS, "left to big integers"]
# What the clock, the machine and the command line say; all else in the figures must be equal.
NOT_FIGURES = {"provenance", "peak_memory_bytes", "picture", "octree_file", "threads", "isa", "memory",
               "kept_bytes", "exact"}


def stage(folder):
    """A working folder with the scenes and 200 rays."""
    folder.mkdir(parents=True)
    for scene in SCENES:
        shutil.copy(root / "testfiles" / f"{scene}.x3d", folder)
    numbers = random.Random(7)
    with open(folder / "rays.txt", "w") as file:
        for _ in range(200):
            print(*(f"{numbers.uniform(-9, 9):.6g}" for _ in range(3)),
                  *(f"{numbers.uniform(-1, 1):.6g}" for _ in range(3)), file=file)
    return folder


def figures(text):
    """The figures without times and what NOT_FIGURES names."""
    def kept(value):
        if isinstance(value, dict):
            return {k: kept(v) for k, v in value.items() if k not in NOT_FIGURES and not k.endswith("_seconds")}
        return value
    return json.dumps(kept(json.loads(text)), sort_keys=True).encode()


def results(command, scene, flags, folder, environment):
    """Digest of each output of the two runs that make them: a render, and rays."""
    for name in OUTPUTS.values():
        (folder / name).unlink(missing_ok=True)
    common = [*command.split(), f"{scene}.x3d", "--quiet", *flags]
    for more in (["--rep=1", "--res=96,60", "--out=a.bmp", "--octree=octree.json", "--json=figures.json"],
                 ["--rays=rays.txt", "--out=answers.txt"]):
        run = subprocess.run(common + more, cwd=folder, env=environment, capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{' '.join(common + more)}: exit code {run.returncode}: {run.stderr}")
    digests = {}
    for what, name in OUTPUTS.items():
        data = (folder / name).read_bytes()
        digests[what] = hashlib.sha256(figures(data) if what == "counts" else data).hexdigest()
    predicates = json.loads((folder / OUTPUTS["counts"]).read_bytes()).get("predicates", {})
    return digests | {COLUMNS[-1]: predicates.get("exact")}


plain = {"PATH": os.environ["PATH"], "LC_ALL": "C", "TZ": "UTC"}
home = stage(work / "one")
expected = {(s, p): results(program, s, f, home, plain) for s in SCENES for p, f in PROFILES.items()}
print("| what changes | runs | " + " | ".join(COLUMNS) + " |\n|---|---|" + "---|" * len(COLUMNS))
is_same = True


def row(what, variants, profiles=PROFILES, may_differ=()):
    """One line: each variant is (command, flags, folder, environment)."""
    global is_same
    differing = {output: [] for output in COLUMNS if output not in may_differ}
    count = 0
    for command, flags, folder, environment in variants:
        for scene in SCENES:
            for profile in profiles:
                count += 1
                got = results(command, scene, PROFILES[profile] + flags, folder, environment)
                for output in differing:
                    if got[output] != expected[scene, profile][output]:
                        differing[output].append(f"{scene}, {profile} {' '.join(flags)}")
    cells = ["same" if not d else f"DIFFERS {len(d)} times, e.g. {d[0]}" for d in differing.values()]
    cells += ["not held" for _ in may_differ]
    is_same = is_same and not any(differing.values())
    print(f"| {what} | {count} | " + " | ".join(cells) + " |", flush=True)


def has_isa(isa):
    return subprocess.run([program, "both.x3d", "--res=1,1", "--rep=1", "--profile=fast", f"--isa={isa}", "--quiet",
                           "--out=a.bmp"], cwd=home, env=plain, capture_output=True).returncode == 0


row("nothing", [(program, [], home, plain)] * max(1, -(-runs // len(SCENES) // len(PROFILES))))
row("threads 1 to 8", [(program, [f"--threads={n}"], home, plain) for n in range(1, 9)], ["fast"])
isas = [isa for isa in ("avx512", "avx2", "sse4", "sse2", "neon") if has_isa(isa)]
row("instruction sets " + ", ".join(isas), [(program, [f"--isa={isa}"], home, plain) for isa in isas], ["fast"])
locales = [name for name in ("de_DE.UTF-8", "ar_EG.UTF-8") if (work / name).is_dir()]
if locales:
    row("locales " + ", ".join(locales), [
        (program, [], home, plain | {"LC_ALL": name, "LANG": name, "LOCPATH": str(work)}) for name in locales])
else:
    print("locales: left out, none can be made here (localedef)")
row("time zones", [(program, [], home, plain | {"TZ": zone}) for zone in ("Pacific/Kiritimati", "NST3:30NDT")])
row("working folders", [(program, [], stage(work / "another folder" / "ö"), plain)])
row("environment, 100 kB of it", [(program, [], home, plain | {"FILL": "x" * 100_000})])
for build in sys.argv[5:]:
    name, command = build.split("=", 1)
    # Before big integers long double is asked, which is wider there.
    row(name, [(command, [], home, plain)], may_differ=COLUMNS[-1:] if name.startswith("ARM64") else ())
sys.exit(0 if is_same else 1)
PYTHON
