#!/usr/bin/env python3
"""Changes single places of the code and sees whether the tests notice.

usage: scripts/mutate.py [--room=geometry|octree|fast|bounds] [--mutants=N] [--seed=S] [--build=FOLDER] [--jobs=N]

Draws N places (60) of a room's files with seed S (1), makes one change at each (a comparison, a sign, a constant,
an error bound taken away, a statement left out) in a copy of the sources, compiles what the file is part of, links
the room's tests with it in place of the library's own, and runs them until one fails or the time is up. The room
`bounds` is those lines of the fast room that have to do with error bounds. Needs the room's tests built in FOLDER
(build/release). A change that does not compile is drawn again. Survivors are listed; docs/reliability.md answers them.
"""
import argparse
import concurrent.futures
import json
import pathlib
import random
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What asks for the bounds of a folder of the fast room.
NEAR = {"camera": "CameraBounds.*:ConicBounds.*:PixelBounds.*:FastBoxes.*", "primary": "CameraBounds.*:ConicBounds.*:FastBoxes.*",
        "light": "LightBounds.*:LightBuffer.*:WantedItems.*:ShadowPlanes.*",
        "rays": "LeafBounds.*:RayBounds.*:PairRoots.*:SingleRays.*", "scene": "BallMap.*:OctantTests.*:FastScene.*:TriangleChunkTest.*",
        "shading": "ShadingBounds.*:ColorBounds.*:VectorMath.*:FastShading.*",
        "shadow": "SegmentBounds.*:LightBounds.*:ShadowPlanes.*:*FastShadows*:BackFaces.*",
        "tile": "SegmentBounds.*:*FastShadows*:FastBoxes.*", "simd": "*Bounds.*:VectorMath.*", "frame": "*FastShadows*"}
ROOMS = {  # the files, and the test programs that run one after the other
    "geometry": (["src/geometry/*.cpp"], [["geometry_tests", "--gtest_filter=-Placements/*"],
                                          ["geometry_tests", "--gtest_filter=Placements/*"], ["property_tests"]]),
    "octree": (["src/octree/*.cpp"], [["octree_tests"], ["property_tests"]]),
    "fast": (["src/render/fast/scene/*.cpp", "src/render/fast/primary/*.cpp", "src/render/fast/shadow/*.cpp",
              "src/render/fast/tile/*.cpp"], [["render_tests"], ["fuzz_tests"]]),
    "bounds": (["src/render/fast/**/*.cpp", "src/render/fast/**/*.h"],
               [["render_tests", "--gtest_filter={near}"], ["render_tests", "--gtest_filter=Fast.*:FastFaults.*"]]),
}
ONLY = {"bounds": re.compile(r"Roundoff|gamma\(|roundings\(|Underflow|[eE]rror|[sS]lack|margin|kSmallest")}
SWAPS = {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ", " && ": " || ",
         " || ": " && ", " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ",
         "std::min(": "std::max(", "std::max(": "std::min(", "true": "false", "false": "true", "++": "--"}
SWAP = re.compile("|".join(r"\b" + k + r"\b" if k.isalpha() else re.escape(k) for k in SWAPS))
BOUND = re.compile(r"\b(gamma(?:_of<\w+>)?|roundings)\(([^()]+)\)")
NUMBER = re.compile(r"(?<![\w.<])\d+(?![\w.>])")
STATEMENT = re.compile(r"^\s*(?:[\w.\->\[\]]+\(.*\);|[\w.\->\[\]]+ [-+*|&]?= .*;|continue;|break;|return;)$")


def places(path, only=None):
    """All changes of a file: (line number, new line)."""
    found = []
    for number, line in enumerate(path.read_text().split("\n")):
        code = line.split("//")[0]
        if only and not only.search(code):
            continue
        if not code.strip() or re.match(r"\s*(#|static_assert|using|namespace|template|NUVO_|HWY_|\"|\*|/\*)", code):
            continue
        def add(match, text):
            found.append((number, line[:match.start()] + text + line[match.end():]))
        for match in SWAP.finditer(code):
            add(match, SWAPS[match.group()])
        for match in BOUND.finditer(code):
            add(match, f"{match[1]}(0)")
        for match in NUMBER.finditer(BOUND.sub(lambda m: " " * len(m[0]), code)):
            add(match, str(int(match[0]) + 1))
        if STATEMENT.match(code):
            found.append((number, ""))
    return found


class Tester:
    def __init__(self, build, programs, seconds):
        self.build, self.seconds = build, seconds
        self.compile = {re.search(r" -o (\S+)", c["command"])[1]: c["command"]
                        for c in json.loads((build / "compile_commands.json").read_text())}
        self.objects = {}  # by a source or header: the library's and the tests' objects that it is part of
        rooms = "|".join(re.escape(f"tests/CMakeFiles/{words[0]}.dir/") for words in programs)
        wanted = re.compile(f"CMakeFiles/nuvo_lib.dir/|{rooms}")
        deps = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], check=True, capture_output=True, text=True)
        for line in deps.stdout.splitlines():
            if ": #deps" in line:
                output = line.split(":")[0]
            elif line.startswith(" ") and wanted.match(output):
                self.objects.setdefault((build / line.strip()).resolve(), []).append(output)
        self.tests = []
        for words in programs:
            commands = subprocess.run(["ninja", "-C", str(build), "-t", "commands", f"tests/{words[0]}"],
                                      check=True, capture_output=True, text=True).stdout.splitlines()
            link = next(c for c in reversed(commands) if f"-o tests/{words[0]} " in c)
            link = link[link.index("&& ") + 3:].rsplit(" && ", 1)[0] if link.startswith(": &&") else link
            self.tests.append((link, words))

    def link(self, command, objects, folder, path):
        command[command.index("-o") + 1] = f"{folder}/tests"
        # A test's own objects give way, the library's come before it.
        command = [objects.get(word, word) for word in command]
        place = command.index("-o")
        command[place:place] = [o for output, o in objects.items() if output.startswith("CMakeFiles")]
        done = subprocess.run(command, cwd=self.build, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{path}: {done.stderr[-500:]}")

    def judge(self, path, number, line):
        """"killed by X", "survived" or "does not compile"."""
        with tempfile.TemporaryDirectory() as folder:
            for part in ("src", "include"):
                shutil.copytree(ROOT / part, pathlib.Path(folder, part))
            lines = path.read_text().split("\n")
            lines[number] = line
            pathlib.Path(folder, path.relative_to(ROOT)).write_text("\n".join(lines))
            objects = {}
            for output in self.objects.get(path, []):
                words = [re.sub(f"^(-I)?{ROOT}/(src|include)", rf"\g<1>{folder}/\2", w)
                         for w in shlex.split(self.compile[output]) if "ccache" not in w]
                objects[output] = f"{folder}/{len(objects)}.o"
                words[words.index("-o") + 1] = objects[output]
                if subprocess.run(words + ["-w", "-O1"], cwd=self.build, capture_output=True).returncode != 0:
                    return "does not compile"
            linked = None
            for link, program in self.tests:
                if linked != program[0]:
                    self.link(shlex.split(link), objects, folder, path)
                    linked = program[0]
                filters = [word.replace("{near}", NEAR.get(path.parent.name, "")) for word in program[1:]]
                run = subprocess.run([f"{folder}/tests", "--gtest_fail_fast", "--gtest_brief=1", *filters],
                                     cwd=folder, capture_output=True, text=True, preexec_fn=lambda: resource.setrlimit(
                                         resource.RLIMIT_CPU, (self.seconds, self.seconds)))
                if run.returncode in (-signal.SIGKILL, -signal.SIGXCPU):
                    return f"killed by {program[0]}: no end"
                if run.returncode != 0:
                    failed = re.search(r"\[  FAILED  \] (\S+)", run.stdout)
                    return f"killed by {failed[1] if failed else program[0] + ': a crash'}"
        return "survived"


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1][7:])
    parser.add_argument("--room", choices=ROOMS, default="octree")
    parser.add_argument("--mutants", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seconds", type=int, default=600, help="of processor time that a run of tests may take")
    arguments = parser.parse_args()
    files, programs = ROOMS[arguments.room]
    all_places = [(path, *place) for pattern in files for path in sorted(ROOT.glob(pattern))
                  for place in places(path, ONLY.get(arguments.room))]
    random.Random(arguments.seed).shuffle(all_places)
    tester = Tester(arguments.build.resolve(), programs, arguments.seconds)
    print(f"{arguments.room}: {len(all_places)} places, seed {arguments.seed}")
    begin, ends, survivors = time.process_time(), [], []

    def judge(place):
        result = tester.judge(*place)
        path, number, line = place
        print(f"{result}: {path.relative_to(ROOT)}:{number + 1}: {line.strip() or '(left out)'}", flush=True)
        return place, result

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        while all_places and len(ends) < arguments.mutants:
            batch = [all_places.pop(0) for _ in range(min(len(all_places), arguments.mutants - len(ends)))]
            for place, result in pool.map(judge, batch):
                if result != "does not compile":
                    ends.append(result)
                if result == "survived":
                    survivors.append(place)
    killed = len(ends) - len(survivors)
    print(f"{arguments.room}: {killed} of {len(ends)} killed ({100 * killed / len(ends):.0f} %); survivors:")
    for path, number, line in survivors:
        print(f"{path.relative_to(ROOT)}:{number + 1}\n  - {path.read_text().splitlines()[number].strip()}\n"
              f"  + {line.strip() or '(left out)'}")


if __name__ == "__main__":
    main()
