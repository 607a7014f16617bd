"""Tables of nuvo beside its peers, from the results of scripts/bench_peers.sh.

Reads DIR/raw/*.json, writes DIR/peers.json and DIR/peers.md and, with --docs FILE, puts each table
into that file between its marks <!-- table NAME --> and <!-- end -->. Standard library only.
"""

import argparse
import json
import math
import pathlib
import platform
import random
import re
import statistics
import sys

SCENES = ("teapot", "trianglemesh", "both", "concentric", "clumped", "octahedra1e5", "spheres1e6")
TITLES = {"teapot": "teapot, 25,440 triangles", "trianglemesh": "test 1, 5,824 triangles",
          "both": "test 2, 8,000 triangles", "concentric": "test 3, 5,985 spheres",
          "clumped": "test 4, 25,600 triangles",
          "octahedra1e5": "100,000 octahedra, 800,000 triangles", "spheres1e6": "1,000,000 spheres"}
PEOPLE = {"terrain": "terrain", "interior": "interior", "city-street": "city from the street",
          "city-above": "city from above", "assembly": "assembly of cars", "molecule": "molecule",
          "floor-10": "ball on a floor 10 times as wide", "floor-1000": "10^3 times",
          "floor-100000": "10^5 times", "floor-1000000": "10^6 times"}
# Thesis 5.8: seconds of a frame, generation included, non-uniform octree, i5-2500K.
PUBLISHED = {"teapot": 213.912, "trianglemesh": 9.899, "both": 12.533, "concentric": 8.382,
             "clumped": 14.386}
INSTRUCTION_SETS = ("avx512", "avx2", "sse4.2", "sse2")
RESAMPLES = 2000


def interval(values):
    """Median and the percentile bootstrap's 95 % interval of it. Deterministic."""
    generator = random.Random(1)
    medians = sorted(statistics.median(generator.choices(values, k=len(values)))
                     for _ in range(RESAMPLES))
    return (statistics.median(values), medians[int(0.025 * RESAMPLES)],
            medians[int(0.975 * RESAMPLES) - 1])


def milliseconds(figure):
    """A median as text; figures are the measuring program's, in seconds."""
    if figure is None:
        return "-"
    value = 1000 * figure["median"]
    return f"{value:.1f}" if value < 100 else f"{value:,.0f}"


def with_interval(figure):
    if figure is None:
        return "-"
    low, high = 1000 * figure["low"], 1000 * figure["high"]
    digits = 1 if figure["median"] < 0.1 else 0
    return f"{1000 * figure['median']:,.{digits}f} ({low:,.{digits}f} .. {high:,.{digits}f})"


def ratio(slow, fast):
    """How many times as fast as `slow` is `fast`: of what was measured in the same round."""
    if slow is None or fast is None:
        return "-"
    pairs = list(zip(slow["samples"], fast["samples"]))
    if any(b <= 0 for _, b in pairs):
        return "-"
    middle, low, high = interval([a / b for a, b in pairs])
    return f"**{middle:.2f}** ({low:.2f} .. {high:.2f})"


def first_pictures(side):
    """What the first picture takes after the build, of each round."""
    build, scratch = side["build"]["samples"], side["scratch"]["samples"]
    return {"samples": [both - built for both, built in zip(scratch, build)]}


def table(head, rows):
    if not rows:
        return "Not measured.\n"
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def ours(result, octree_type):
    for samples in result.get("ours", []):
        if samples["type"] == octree_type:
            return samples
    return None


def mode_text(survey):
    def packet(width, coherent):
        return f"{width}{' coherent' if coherent and width > 1 else ''}"
    return (packet(survey["primary_width"], survey["primary_coherent"]) + " / " +
            packet(survey["shadow_width"], survey["shadow_coherent"]))


class Report:
    def __init__(self, results, octree_type):
        self.results = results
        self.type = octree_type

    def frames(self, without_ours=False):
        """(scene, camera, result) in the order of the tables."""
        for scene in SCENES:
            for camera in ("far", "near"):
                result = self.results.get(f"frame-{scene}-{camera}")
                if result is not None and (without_ours or "ours" in result):
                    yield scene, camera, result

    def table_frames(self):
        rows = []
        for scene, camera, result in self.frames():
            mine, theirs = ours(result, self.type), result["embree"]
            rows.append([TITLES[scene], camera, mode_text(result["embree_survey"]),
                         with_interval(theirs["frame"]), with_interval(mine["frame"]),
                         ratio(theirs["frame"], mine["frame"]),
                         ratio(theirs["scratch"], mine["scratch"]),
                         f"{result['differing_pixels']:,} / {result['visibly_differing_pixels']:,}",
                         result.get("pixels_unlike_exact", "-")])
        return table(["scene", "camera", "Embree's rays a call: primary / shadow",
                      "Embree, ms", "nuvo, ms", "times as fast", "with a build from scratch",
                      "pixels unlike Embree's: at all / visibly",
                      "unlike the exact profile's"], rows)

    def table_people(self):
        rows = []
        for name, title in PEOPLE.items():
            result = self.results.get(f"people-{name}")
            if result is None or "ours" not in result:
                continue
            mine, theirs = ours(result, "measured"), result["embree"]
            rays = result.get("rays")
            price = result.get("exactness")
            primitives = result["triangles"] + result["spheres"]
            rows.append([title, f"{primitives:,}", with_interval(theirs["frame"]),
                         with_interval(mine["frame"]), ratio(theirs["frame"], mine["frame"]),
                         ratio(theirs["scratch"], mine["scratch"]),
                         ratio(first_pictures(theirs), first_pictures(mine)),
                         ratio(rays["embree"], rays["ours_measured"]) if rays else "-",
                         ratio(price["exact"], price["plain"]) if price else "-",
                         f"{mine['table_bytes'] / primitives:.0f}",
                         result.get("pixels_unlike_exact", "-")])
        return table(["scene", "primitives", "Embree, ms", "nuvo, ms", "frame: times as fast",
                      "with a build from scratch", "first picture", "single rays",
                      "price of exactness",
                      "tables of a frame, bytes a primitive", "pixels unlike the exact profile's"],
                     rows)

    def table_stages(self):
        rows = []
        for scene, camera, result in self.frames():
            mine, theirs = ours(result, self.type), result["embree"]
            primary, trace, frame = (1000 * theirs[key]["median"]
                                     for key in ("primary", "trace", "frame"))
            row = [TITLES[scene], camera, f"{primary:.1f}", f"{trace - primary:.1f}",
                   f"{frame - trace:.1f}"]
            # nuvo's clocks of stages run on while another program has the processor: shares only.
            stages = [mine[key]["median"] for key in ("tables", "primary", "shadow", "shading")]
            scale = 1000 * mine["frame"]["median"] / (sum(stages) or 1)
            row += [f"{scale * stage:.1f}" for stage in stages]
            rows.append(row)
        return table(["scene", "camera", "Embree: primary", "shadow", "shading",
                      "nuvo: tables", "primary", "shadow", "shading"], rows)

    def table_builds(self):
        rows = []
        for scene, camera, result in self.frames():
            if camera != "far":
                continue
            count = result["triangles"] + result["spheres"]
            survey = result["embree_survey"]["least_seconds"]
            row = [TITLES[scene], with_interval(result["embree"]["build"]),
                   f"{1000 * survey['build, quality low']:.1f} / "
                   f"{1000 * survey['build, quality high']:.1f}"]
            for name in ("uniform", "nonuniform"):
                mine = ours(result, name)
                row.append(with_interval(mine["build"]) if mine else "-")
            row.append(f"{result['embree']['structure_bytes'] / count:.1f}")
            for name in ("uniform", "nonuniform"):
                mine = ours(result, name)
                row.append(f"{mine['structure_bytes'] / count:.1f}" if mine else "-")
            mine = ours(result, self.type)
            row.append(f"{mine['table_bytes'] / count:.1f}")
            rows.append(row)
        return table(["scene", "Embree's build, ms", "low / high quality", "nuvo uniform, ms",
                      "nonuniform, ms", "Embree, bytes a primitive", "uniform", "nonuniform",
                      "tables of a frame"], rows)

    def table_types(self):
        rows = []
        for scene, camera, result in self.frames():
            both = [ours(result, name) for name in ("uniform", "nonuniform")]
            if None in both:
                continue
            rows.append([TITLES[scene], camera] + [with_interval(s["frame"]) for s in both] +
                        [with_interval(s["scratch"]) for s in both])
        return table(["scene", "camera", "frame, uniform, ms", "nonuniform", "with build, uniform",
                      "nonuniform"], rows)

    def table_growth(self):
        rows = []
        for count in (125, 1250, 12500, 125000, 1250000):
            result = self.results.get(f"growth-{count}")
            if result is None:
                continue
            mine, theirs = ours(result, self.type), result["embree"]
            triangles = result["triangles"]
            rows.append([f"{triangles:,}", milliseconds(theirs["build"]),
                         milliseconds(mine["build"]),
                         f"{1e9 * theirs['build']['median'] / triangles / math.log2(triangles):.1f}",
                         f"{1e9 * mine['build']['median'] / triangles / math.log2(triangles):.1f}",
                         milliseconds(theirs["frame"]), milliseconds(mine["frame"]),
                         ratio(theirs["frame"], mine["frame"]),
                         ratio(theirs["scratch"], mine["scratch"]),
                         f"{theirs['structure_bytes'] / triangles:.1f}",
                         f"{mine['structure_bytes'] / triangles:.1f}"])
        return table(["triangles", "Embree's build, ms", "nuvo's", "Embree, ns per n log2 n",
                      "nuvo", "Embree's frame, ms", "nuvo's", "times as fast",
                      "with a build from scratch", "Embree, bytes a triangle", "nuvo"], rows)

    def table_rays(self):
        rows = []
        named = [(TITLES[s], r) for s, c, r in self.frames() if c == "far"]
        named += [(f"{r['triangles']:,} triangles", r) for n, r in sorted(
            self.results.items(), key=lambda item: item[1].get("triangles", 0))
            if n.startswith("growth-")]
        for title, result in named:
            rays = result.get("rays")
            if rays is None:
                continue
            mine = rays.get(f"ours_{self.type}")
            millions = [rays["rays"] / figure["median"] / 1e6 for figure in (rays["embree"], mine)]
            rows.append([title, f"{100 * rays['hits'] / rays['rays']:.0f} %", f"{millions[0]:.2f}",
                         f"{millions[1]:.2f}", ratio(rays["embree"], mine),
                         f"{rays['differing']:,} of {rays['rays']:,}"])
        return table(["scene", "hit something", "rtcIntersect1, million rays a second", "nuvo",
                      "times as fast", "answers unlike Embree's"], rows)

    def table_exactness(self):
        rows = []
        for scene, camera, result in self.frames():
            price = result.get("exactness")
            if price is not None:
                rows.append([TITLES[scene], camera, with_interval(price["plain"]),
                             with_interval(price["exact"]), ratio(price["exact"], price["plain"]),
                             f"{price['differing_pixels']:,}"])
        return table(["scene", "camera", "redo stages off, ms", "on, ms", "on / off",
                      "pixels that they change"], rows)

    def table_threads(self):
        rows = []
        for scene, camera, result in self.frames():
            figures = result.get("threads")
            if figures is not None:
                rows.append([TITLES[scene], with_interval(figures["ours_1"]),
                             with_interval(figures["ours_2"]),
                             ratio(figures["ours_1"], figures["ours_2"]),
                             ratio(figures["ours_build_1"], figures["ours_build_2"]),
                             ratio(figures["embree_1"], figures["embree_2"]),
                             "yes" if figures["same_bytes"] else "NO"])
        return table(["scene, far", "one thread, wall ms", "two", "frame: times as fast",
                      "build", "Embree's frame", "same bytes"], rows)

    def table_isa(self):
        rows = []
        for scene in SCENES:
            for isa in INSTRUCTION_SETS:
                result = self.results.get(f"isa-{isa}-{scene}")
                if result is None:
                    continue
                mine, theirs = ours(result, self.type), result["embree"]
                rows.append([TITLES[scene], isa, mode_text(result["embree_survey"]),
                             with_interval(theirs["frame"]), with_interval(mine["frame"]),
                             ratio(theirs["frame"], mine["frame"]),
                             result.get("pixels_unlike_exact", "-")])
        return table(["scene, far", "instruction set", "Embree's rays a call", "Embree, ms",
                      "nuvo, ms", "times as fast", "pixels unlike the exact profile's"], rows)

    def table_povray(self):
        rows = []
        for scene in SCENES:
            result = self.results.get(f"povray-{scene}-far")
            if result is None:
                continue
            cells = [TITLES[scene]]
            for clock in ("cpu", "wall"):
                theirs, mine = result["povray"][clock], result["nuvo"][clock]
                middle, low, high = interval([a / b for a, b in zip(theirs, mine)])
                cells += [f"{statistics.median(theirs):.2f}", f"{statistics.median(mine):.3f}",
                          f"**{middle:.1f}** ({low:.1f} .. {high:.1f})"]
            rows.append(cells)
        return table(["scene, far", "POV-Ray, CPU s", "nuvo", "times as fast", "POV-Ray, wall s",
                      "nuvo", "times as fast"], rows)

    def table_thesis(self):
        rows = []
        for scene, camera, result in self.frames():
            if camera == "far" and scene in PUBLISHED:
                mine = ours(result, self.type)["scratch"]
                rows.append([TITLES[scene], f"{PUBLISHED[scene]:.1f}",
                             f"{mine['median']:.4f}", f"{PUBLISHED[scene] / mine['median']:,.0f}"])
        return table(["scene", "thesis, s", "nuvo, s", "times as fast"], rows)

    def table_survey(self):
        """Embree asked in every way: least milliseconds of a few tries."""
        columns = [f"primary: {mode}" for mode in ("16 rays, coherent", "16 rays",
                                                   "8 rays, coherent", "1 ray")]
        columns += [f"whole frame, shadows: {mode}" for mode in
                    ("16 rays, coherent", "16 rays", "8 rays, coherent", "8 rays", "1 ray")]
        columns += [f"whole frame, quality {name}" for name in ("low", "medium", "high")]
        columns += ["built-in spheres, primary: 16 rays, coherent"]
        rows = []
        for scene, camera, result in self.frames(without_ours=True):
            least = result["embree_survey"]["least_seconds"]
            cells = [f"{1000 * least[name]:.1f}" if name in least else "-" for name in columns]
            rows.append([TITLES[scene], camera] + cells)
        return table(["scene", "camera"] + columns, rows)

    def table_kernels(self):
        rows = []
        for row in self.results.get("kernels", {}).get("benchmarks", []):
            scale = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[row["time_unit"]]
            time = row["cpu_time"] * scale
            items = row.get("items_per_second")
            rows.append([f"`{row['name']}`", f"{time:,.0f}",
                         f"{1e9 / items:,.1f}" if items else "-"])
        return table(["kernel", "ns a call", "ns an item"], rows)

    def tables(self):
        prefix = "table_"
        return {name[len(prefix):]: getattr(self, name)() for name in dir(type(self))
                if name.startswith(prefix)}


def load(folder):
    return {path.stem: json.loads(path.read_text(encoding="utf-8"))
            for path in sorted((folder / "raw").glob("*.json"))}


def processor_text():
    """The model's name and the widest vectors it has."""
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8") if pathlib.Path(
        "/proc/cpuinfo").exists() else ""
    name = re.search(r"model name\s*: (.*)", text)
    flags = re.search(r"flags\s*: (.*)", text)
    flags = set(flags.group(1).split()) if flags else set()
    vectors = next((v for v in ("avx512f", "avx2", "sse4_2") if v in flags), "sse2")
    return f"{name.group(1).strip() if name else platform.machine()} ({vectors})"


def put_into(path, tables):
    """Replaces what stands between <!-- table NAME --> and the next <!-- end -->."""
    text = path.read_text(encoding="utf-8")
    for name, content in tables.items():
        mark = f"<!-- table {name} -->"
        pattern = re.escape(mark) + r".*?<!-- end -->"
        text = re.sub(pattern, lambda _: f"{mark}\n{content}<!-- end -->", text, flags=re.DOTALL)
    path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--type", default="uniform", help="the octree that stands for nuvo")
    parser.add_argument("--commit", default="unknown")
    parser.add_argument("--compiler", default="unknown")
    parser.add_argument("--docs", type=pathlib.Path)
    arguments = parser.parse_args()

    results = load(arguments.folder)
    if not results:
        sys.exit(f"peers.py: {arguments.folder / 'raw'}: no results")
    environment = {"commit": arguments.commit, "compiler": arguments.compiler,
                   "processor": processor_text(), "type": arguments.type}
    versions = {result["embree_survey"].get("version", "of a version not noted")
                for result in results.values() if "embree_survey" in result}
    if versions:
        environment["embree"] = ", ".join(sorted(versions))
    tables = {"machine": "".join(f"- {key}: {value}\n" for key, value in environment.items())}
    tables.update(Report(results, arguments.type).tables())
    text = "\n".join(f"## {name}\n\n{content}" for name, content in tables.items())
    (arguments.folder / "peers.md").write_text(text, encoding="utf-8")
    document = {"environment": environment, "results": results}
    (arguments.folder / "peers.json").write_text(
        json.dumps(document, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if arguments.docs is not None:
        put_into(arguments.docs, tables)
    print(text)


if __name__ == "__main__":
    main()
